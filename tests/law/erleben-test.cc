// Sharp bodies on sharp ground: K. Erleben, "Methodology for assessing mesh-based contact point
// methods" (ACM Transactions on Graphics 37, 2018), with the sizes of the scenes of Rigid-IPC
// (Ferguson et al. 2021, fixtures/3D/unit-tests/erleben).  y is up; spikes and wedges, 1 m wide and
// 3 m high, point down and begin 0.1 mm above what they stand on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "geometry/polyhedron.h"
#include "kernel/world/callback.h"
#include "support/known-fault.h"
#include "support/stability.h"

namespace tw::test {
namespace {

using Vec2 = Eigen::Vector2d;

using Corners = std::vector<Vec3>;

constexpr double above = 1e-4;  // m

ShapePtr spike() {
  return make_hull({{.5, 0, -.5}, {.5, 0, .5}, {-.5, 0, .5}, {-.5, 0, -.5}, {0, 3, 0}});
}
ShapePtr wedge() {
  return make_hull({{.5, 0, 1}, {-.5, 0, 1}, {0, 3, 1}, {.5, 0, -1}, {-.5, 0, -1}, {0, 3, -1}});
}
ShapePtr cliff() {
  Corners corners;
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) {
      corners.emplace_back(0.75 * x, -0.5, 0.75 * z);
      corners.emplace_back(0.5 * x, 0.5, 0.5 * z);
    }
  return make_hull(corners);
}

// A plate of 2 x 1 x 2 m with a groove along z, 0.5 m deep, in four prisms that abut.
ShapePtr crack() {
  const auto prism = [](const std::vector<Vec2>& outline) {
    Corners corners;
    for (const Vec2& p : outline)
      for (const double z : {-2.0, 2.0}) corners.emplace_back(p.x(), p.y(), z);
    return make_hull(corners);
  };
  std::vector<ShapePtr> parts;
  for (const double side : {-1.0, 1.0}) {
    parts.push_back(prism({{side, -.5}, {.5 * side, -.5}, {side, .5}, {.5 * side, .5}}));
    parts.push_back(prism({{.5 * side, -.5}, {0, -.5}, {0, 0}, {.5 * side, .5}}));
  }
  return make_union(parts);
}

// The same with a pyramid in place of the groove: four slopes of 45 degrees and the rim around.
ShapePtr hole() {
  const Vec2 turns[] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  std::vector<ShapePtr> parts;
  for (int i = 0; i < 4; ++i) {
    const Vec2 from = turns[i], to = turns[(i + 1) % 4];
    Corners slope = {{0, 0, 0}, {0, -.5, 0}}, rim;
    for (const Vec2& c : {from, to})
      for (const double y : {-.5, .5}) {
        slope.emplace_back(.5 * c.x(), y, .5 * c.y());
        rim.emplace_back(.5 * c.x(), y, .5 * c.y());
        rim.emplace_back(c.x(), y, c.y());
      }
    parts.push_back(make_hull(slope));
    parts.push_back(make_hull(rim));
  }
  return make_union(parts);
}

// The upper side of a block of 2 m in triangles of no regular pattern, each a prism.
ShapePtr internal_edges() {
  const std::vector<Vec2> at = {{-1, 1}, {-1, -1}, {1, 1}, {1, -1},   {-1, 0},
                                {0, -1}, {1, 0},   {0, 1}, {-.5, .5}, {.5, .5}};
  const int triangles[][3] = {{0, 7, 8}, {7, 2, 9}, {1, 4, 5}, {3, 5, 6}, {2, 6, 9},
                              {8, 4, 0}, {6, 5, 9}, {9, 5, 7}, {8, 7, 5}, {4, 8, 5}};
  std::vector<ShapePtr> parts;
  for (const auto& triangle : triangles) {
    Corners corners;
    for (const int i : triangle)
      for (const double y : {-.5, .5}) {
        const Vec2& c = at[static_cast<std::size_t>(i)];
        corners.emplace_back(c.x(), y, c.y());
      }
    parts.push_back(make_hull(corners));
  }
  return make_union(parts);
}

// Ten tiles side by side.
ShapePtr plane() {
  std::vector<ShapePtr> tiles;
  for (int i = 0; i < 10; ++i)
    tiles.push_back(place_shape(make_box({1, 1, 10}), {Vec3(-4.5 + i, -0.5, 0), Quat::Identity()}));
  return make_union(tiles);
}

struct ErlebenCase {
  ShapePtr body, ground;
  Vec3 position, ground_position;
  Vec3 velocity = Vec3::Zero();
  double duration = 1.25;  // s
  double gravity = 9.8;
  Vec3 force = Vec3::Zero();
  // of a place over the ground, m; without it the ground is convex
  std::function<double(const Vec3&)> height = {};
  double middle = 0;  // m: height of the body's centre of mass, in its frame
};

// Upside down: the tip is at the lower end.
const Quat turned = Quat(0, 0, 0, 1);

struct Result {
  double rise = 0;  // of the energy, less what the force does, over the weight times 1 m
  BodyState end;
};

// Nothing gets deeper than a fiftieth of its width.
Result run(const ErlebenCase& c, const Quat& orientation, double friction) {
  World world;
  set_contact_for_all(world, 0, friction);
  world.set_gravity(Vec3(0, -c.gravity, 0));
  BodyDef ground = body_of(c.ground, c.ground_position, Vec3::Zero());
  ground.fixed = true;
  world.add_body(ground);
  BodyDef def = body_of(c.body, c.position, c.velocity);
  def.orientation = orientation;
  const BodyId id = world.add_body(def);
  world.edit(id, [&](StateView& view) { view.set_applied_force(c.force); });

  const auto work = [&](const BodyState& s) {
    return c.force.dot(s.orientation * Vec3(0, c.middle, 0) + s.position);
  };
  StabilityOutcome outcome;
  double lowest = world.total_energy() - work(world.state(id)), rise = 0;
  for (int i = 1; i <= 250; ++i) {
    world.advance(c.duration * i / 250);
    const BodyState s = world.state(id);
    const double energy = world.total_energy() - work(s);
    rise = std::max(rise, energy - lowest);
    lowest = std::min(lowest, energy);
    if (!c.height) measure_depths(world, outcome);
    if (!c.height) continue;
    for (const Vec3& corner : c.body->parts()[0].core->vertices()) {
      const double depth = -c.height(s.orientation * corner + s.position - c.ground_position);
      outcome.deepest_share = std::max(outcome.deepest_share, depth / c.body->least_width());
    }
  }
  EXPECT_LT(outcome.deepest_share, 0.02) << "friction " << friction;
  return {rise / (world.body(id).mass * 9.8), world.state(id)};
}

// With friction and without; returns the end with friction.
BodyState expect_held(const ErlebenCase& c, const Quat& orientation = turned) {
  BodyState end;
  for (const double friction : {0.0, 0.5}) {
    const Result result = run(c, orientation, friction);
    EXPECT_LT(result.rise, 1e-3) << "friction " << friction;
    end = result.end;
  }
  return end;
}

// Over the grooved plate and the one with the pit; beside them there is nothing.
double over_crack(const Vec3& p) {
  if (std::abs(p.x()) > 1 || std::abs(p.z()) > 2 || p.y() < -0.4) return 1;
  return p.y() - std::min(std::abs(p.x()), 0.5);
}
double over_hole(const Vec3& p) {
  const double out = std::max(std::abs(p.x()), std::abs(p.z()));
  return out > 1 || p.y() < -0.4 ? 1 : p.y() - std::min(out, 0.5);
}

// One slips off the other; no seam takes part.
TEST(Erleben, spikes_and_wedges_on_each_other) {
  const ShapePtr bodies[] = {spike(), spike(), wedge()}, grounds[] = {spike(), wedge(), wedge()};
  for (int i = 0; i < 3; ++i) expect_held({bodies[i], grounds[i], {0, 3 + above, 0}, {0, -3, 0}});
}

// Tip down in the middle of a plate, moving along x.
ErlebenCase into(const ShapePtr& body, const ShapePtr& plate,
                 const std::function<double(const Vec3&)>& height, double duration, double speed) {
  ErlebenCase c{body, plate, {0, 2 + above, 0}, {0, -1, 0}, {speed, 0, 0}, duration};
  c.height = height;
  return c;
}

TEST(Erleben, a_spike_in_a_crack) {
  ErlebenCase pushed = into(spike(), crack(), over_crack, 0.9, 1);
  pushed.force = {1, 0, 0};
  pushed.middle = 0.75;
  expect_held(pushed);
  // upright it stays on its tip as long as rounding lets it
  const BodyState end = expect_held(into(spike(), crack(), over_crack, 0.5, 0));
  EXPECT_NEAR(end.position.y(), 2, 1e-3);
}

TEST(Erleben, a_wedge_in_a_crack) {
  ErlebenCase pushed = into(wedge(), crack(), over_crack, 0.9, 1);
  pushed.force = {10, 0, 0};
  pushed.middle = 1;
  expect_held(pushed);
}

TEST(Erleben, a_spike_in_a_hole) { expect_held(into(spike(), hole(), over_hole, 0.9, 1)); }

TEST(Erleben, sliding_spikes_and_wedges_feel_no_seams) {
  for (const ShapePtr& body : {spike(), wedge()}) {
    const ErlebenCase c{body, plane(), {-4.9, 2 + above, 0}, {0, -1, 0}, {10, 0, 0}, 0.9, 0};
    const BodyState end = expect_held(c);
    EXPECT_LT((end.velocity - c.velocity).norm(), 1e-12);
    EXPECT_LT((end.position - c.position - 0.9 * c.velocity).norm(), 1e-12);
  }
}

BodyState cube_on(const ShapePtr& ground) {
  const auto top = [](const Vec3& p) { return p.y() - 0.5; };
  const ErlebenCase c{make_box({1, 1, 1}), ground, {0, 0.05, 0}, {0, -1, 0}, Vec3::Zero(), 2.5, 9.8,
                      Vec3::Zero(),        top};
  return expect_held(c, Quat::Identity());
}

TEST(Erleben, cubes_rest_on_cliff_edges_and_on_internal_edges) {
  const BodyState on_cliff = cube_on(cliff()), on_edges = cube_on(internal_edges());
  for (const BodyState& end : {on_cliff, on_edges}) {
    EXPECT_NEAR(end.position.y(), 0, 1e-3);
    EXPECT_EQ(end.velocity, Vec3::Zero());
  }
  EXPECT_LT(on_cliff.position.norm(), 1e-3);
  // it moves aside as it lands; why is not known
  EXPECT_KNOWN_FAULT(on_edges.position.norm(), 1e-3, 0.0173);
}

// A pit of four walls that stand on a floor.  A tip that was in a wall, 1e-4 m over its bottom
// face, was thought to leave it by the floor's top, which the wall stands on: it slid on through
// the wall.
TEST(Erleben, a_spike_in_a_pit_with_a_floor_stays_out_of_the_walls) {
  const Corners tip = {
      {.25, 1.5, .25}, {.25, 1.5, -.25}, {-.25, 1.5, .25}, {-.25, 1.5, -.25}, {0, 0, 0}};
  struct Start {
    double x, z, speed, slope;
  };
  for (const Start& start : {Start{0.034, 0.026, 0.5, 2},
                             {0.01, 0, 0.1, 2},
                             {0.02, 0.03, 0.3, 4},
                             {0.05, -0.02, 1, 1},
                             {0.1, 0.02, 0.8, 1}})
    for (const bool one_union : {true, false}) {
      std::vector<ShapePtr> parts = {
          place_shape(make_box({3, 0.5, 3}), {{0, -0.25, 0}, Quat::Identity()})};
      std::vector<std::pair<Vec3, double>> slopes;
      for (int i = 0; i < 4; ++i) {
        const auto at = [&](double radius, double height, int turn) {
          const double angle = pi / 2 * turn;
          return Vec3(radius * std::cos(angle), height, radius * std::sin(angle));
        };
        const double rim = 0.5 / start.slope;
        parts.push_back(make_hull({Vec3::Zero(), at(1.5, 0, i), at(1.5, 0, i + 1), at(rim, 0.5, i),
                                   at(rim, 0.5, i + 1), at(1.5, 0.5, i), at(1.5, 0.5, i + 1)}));
      }
      World world;
      world.set_gravity({0, -9.8, 0});
      set_contact_for_all(world, 0, 0);
      for (const ShapePtr& shape : one_union ? std::vector<ShapePtr>{make_union(parts)} : parts) {
        BodyDef def;
        def.shape = shape;
        def.fixed = true;
        world.add_body(def);
      }
      world.add_body(body_of(make_hull(tip), {start.x, 0.3, start.z}, {start.speed, 0, 0}));
      for (int k = 1; k <= 60; ++k) {
        world.advance(0.025 * k);
        StabilityOutcome outcome;
        measure_depths(world, outcome);
        ASSERT_LT(outcome.deepest, 4e-3) << start.x << " " << one_union << " at " << world.time();
      }
    }
}

}  // namespace
}  // namespace tw::test
