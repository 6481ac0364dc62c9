// Height fields as ground: like a plane where they are one, like slabs of the same triangles where
// they are none.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/height-field.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/random.h"
#include "support/crossers.h"
#include "support/stability-scenes.h"

namespace tw::test {
namespace {

using Heights = std::function<double(double x, double y)>;

// Cells of `spacing` over 8 by 8 m.
ShapePtr field_of(const Heights& height, double spacing) {
  const auto cells = static_cast<int>(std::lround(8 / spacing));
  std::vector<double> heights;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) heights.push_back(height(i * spacing - 4, j * spacing - 4));
  return make_height_field(heights, static_cast<std::size_t>(cells) + 1, spacing, spacing);
}

void add_ground(World& world, const ShapePtr& shape) {
  BodyDef ground;
  ground.shape = shape;
  ground.fixed = true;
  world.add_body(ground);
}

// After a second at 3 m/s over the ground.
BodyState cross(const ShapePtr& ground, const Crosser& c) {
  World world;
  set_contact_for_all(world, 0.2, c.friction);
  add_ground(world, ground);
  const BodyId id = world.add_body(body_of(c.shape, {-2, 0.06, 0.1 + 1e-5}, {3, 0.4, 0}, c.spin));
  world.advance(1);
  return world.state(id);
}

// Cells in one plane; cells bent by a nanometre, each two triangles; and both in turn, so that long
// edges meet many short ones.  As its points go from triangle to triangle, a box rocks by some
// micrometres, more where these end at once.
TEST(HeightField, flat_ground_is_crossed_as_a_plane) {
  Random random(1);
  const auto bent = [&] { return random.real(0, 1e-9); };
  struct {
    ShapePtr shape;
    double way, speed;
  } const grounds[] = {
      {field_of([](double, double) { return 0.0; }, 0.1), 1e-5, 2e-4},
      {field_of([&](double, double) { return bent(); }, 0.1), 1e-5, 2e-4},
      {field_of([&](double x, double) { return std::sin(5 * x) > 0 ? bent() : 0; }, 0.1), 3e-5,
       5e-3},
  };
  ASSERT_FALSE(grounds[0].shape->height_field()->exists(2));
  ASSERT_TRUE(grounds[1].shape->height_field()->exists(1));
  for (const Crosser& c : crossers()) {
    const BodyState plain = cross(make_half_space(Vec3::UnitZ(), 0), c);
    for (const auto& ground : grounds) {
      const BodyState seamed = cross(ground.shape, c);
      const auto which = &ground - grounds;
      EXPECT_LT((seamed.position - plain.position).norm(), ground.way) << c.name << which;
      EXPECT_LT((seamed.velocity - plain.velocity).norm(), ground.speed) << c.name << which;
    }
  }
}

// Hills; the same ground as a slab a triangle.
double hills(double x, double y) {
  return 0.3 * std::sin(1.3 * x + 0.4) * std::cos(0.9 * y) + 0.1 * x + 0.05 * std::sin(5 * x * y);
}

// Its parts as hulls: one body each, or a union.
void add_slabs(World& world, const HeightField& field, bool one_body) {
  std::vector<ShapePtr> slabs;
  for (std::size_t i = 0; i < field.part_count(); ++i) {
    if (!field.exists(i)) continue;
    std::vector<Vec3> points = field.top(i);
    double lowest = points[0].z();
    for (const Vec3& p : points) lowest = std::min(lowest, p.z());
    for (std::size_t k = 0, count = points.size(); k < count; ++k)
      points.push_back({points[k].x(), points[k].y(), lowest - field.depth()});
    slabs.push_back(make_hull(points));
  }
  if (one_body) return add_ground(world, make_union(slabs));
  for (const ShapePtr& slab : slabs) add_ground(world, slab);
}

// On one body of other convex parts the motion is the same but for rounding; where a body strikes
// two slabs at once, each of these takes its own impulse.
TEST(HeightField, hills_are_rolled_over_as_slabs_of_the_same_triangles) {
  const ShapePtr ground = field_of(hills, 0.4);
  const std::vector<ShapePtr> shapes{make_sphere(0.2), make_box({0.3, 0.25, 0.2}),
                                     make_capsule(0.1, 0.3), make_ellipsoid({0.2, 0.15, 0.1})};
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const auto end = [&](const std::function<void(World&)>& add) {
      World world;
      set_contact_for_all(world, 0.3, 0.4);
      add(world);
      const BodyId id = world.add_body(body_of(shapes[s], {1.2, 0.13, 0.8}, {0, 0, 0}));
      world.advance(0.8);
      return world.state(id);
    };
    const HeightField& field = *ground->height_field();
    const BodyState on_field = end([&](World& world) { add_ground(world, ground); });
    const BodyState on_union = end([&](World& world) { add_slabs(world, field, true); });
    const BodyState on_slabs = end([&](World& world) { add_slabs(world, field, false); });
    EXPECT_LT((on_field.position - on_union.position).norm(), 1e-6) << s;
    EXPECT_LT((on_field.velocity - on_union.velocity).norm(), 1e-5) << s;
    EXPECT_LT((on_field.position - on_slabs.position).norm(), 2e-3) << s;
    EXPECT_LT((on_field.velocity - on_slabs.velocity).norm(), 2e-2) << s;
  }
}

// Cells that stand against each other are one ground: nothing is pressed by the walls between them,
// which all stand upright, on ground that falls away steeply.
TEST(HeightField, walls_between_cells_press_nothing) {
  std::vector<double> heights;
  for (int j = -10; j <= 10; ++j)
    for (int i = -10; i <= 10; ++i)
      heights.push_back(0.05 * (0.02 * (i * i + j * j) + std::sin(1.7 * (i + 10) * (j + 10))));
  const ShapePtr ground = make_height_field(heights, 21, 0.17, 0.17);
  Random random(59);
  for (int seed = 0; seed < 60; ++seed) {
    World world;
    set_contact_for_all(world, 0.3, 0.5);
    add_ground(world, ground);
    BodyDef def = body_of(make_cone(0.1, 0.2),
                          Vec3(random.real(-0.5, 0.5), random.real(-0.5, 0.5), 0.5), Vec3::Zero());
    def.orientation = random_attitude(random);
    const BodyId id = world.add_body(def);
    const double start = world.total_energy();
    for (int k = 1; k <= 150; ++k) {
      world.advance(0.01 * k);
      ASSERT_LT(world.total_energy(), start + 1e-6);
      for (const ContactReading& contact : world.contacts_of(id, world.time()))
        ASSERT_TRUE(contact.force == 0 || std::abs(contact.normal.z()) > 1e-9)
            << seed << " at " << world.time() << " by " << contact.force << " N";
    }
  }
}

// Rest on rough ground: nothing sinks in, nothing moves.  (Without resistance drums roll on in
// their hollows.)
TEST(HeightField, bodies_come_to_rest_on_rough_ground) {
  World world;
  ContactSettings settings;
  settings.restitution = 0.2;
  settings.friction = 0.6;
  settings.rolling_friction = 2e-3;
  world.set_contact({}, {}, settings);
  const auto bowl = [](double x, double y) {
    return 0.15 * (x * x + y * y) + 0.05 * std::sin(9 * x) * std::sin(8 * y);
  };
  const ShapePtr ground = field_of(bowl, 0.25);
  add_ground(world, ground);
  const std::vector<ShapePtr> shapes{
      make_box({0.3, 0.25, 0.2}), make_cylinder(0.12, 0.3),
      make_hull({{0.2, 0, 0}, {-0.2, 0.1, 0}, {0, 0.2, 0.1}, {0, -0.1, 0.2}, {0, -0.1, -0.2}}),
      make_box({0.5, 0.5, 0.1})};
  std::vector<BodyId> ids;
  for (std::size_t i = 0; i < 12; ++i)
    ids.push_back(world.add_body(
        body_of(shapes[i % shapes.size()],
                {0.7 * static_cast<double>(i % 4) - 1, 0.8 * static_cast<double>(i / 4) - 0.8, 1.4},
                {0, 0, 0}, {0.3, 0.2, 0.1})));
  world.advance(8);
  for (const BodyId id : ids) {
    const BodyState state = world.state(id);
    EXPECT_LT(state.velocity.norm(), 1e-6) << id;
    const Frame frame(Pose{state.position, state.orientation});
    EXPECT_GT(signed_distance(*world.body(id).shape, frame, *ground, Frame()), -2e-3) << id;
  }
}

// A ball and a cube of 1 cm at 1000 m/s, straight down and nearly along the ground.
TEST(HeightField, nothing_is_shot_through_it) {
  const ShapePtr ground = field_of(hills, 0.2);
  for (const ShapePtr& shape : {make_sphere(0.005), make_box(Vec3::Constant(0.01))})
    for (const Vec3& velocity : {Vec3(0, 0, -1000), Vec3(995, 0, -100), Vec3(0, 999.9, -10)}) {
      World world;
      set_contact_for_all(world, 0.5, 0);
      add_ground(world, ground);
      const Vec3 from = Vec3(0.03, 0.04, hills(0.03, 0.04)) - 3e-3 * velocity;
      const BodyId id = world.add_body(body_of(shape, from, velocity, {300, 500, 100}));
      world.advance(6e-3);
      const Vec3 at = world.state(id).position;
      // beyond the edge there is no ground
      if (std::max(std::abs(at.x()), std::abs(at.y())) > 3.9) continue;
      EXPECT_GT(at.z(), hills(at.x(), at.y()) - 0.02) << velocity.transpose();
    }
}

// A field that moves carries what lies on it.
TEST(HeightField, a_shaken_tray_carries_a_box) {
  World world;
  set_contact_for_all(world, 0, 0.8);
  BodyDef tray;
  tray.shape =
      field_of([](double x, double y) { return 0.02 * std::sin(3 * x) * std::sin(2 * y); }, 0.5);
  tray.motion =
      make_keyframes({{0, {0, 0, 0}, {}}, {1, {0.2, 0, 0.1}, {}}, {2, {0, 0, 0}, {}}}, true);
  const BodyId id = world.add_body(tray);
  const BodyId box =
      world.add_body(body_of(make_box({0.6, 0.5, 0.2}), {0.1, 0.1, 0.15}, {0, 0, 0}));
  world.advance(0.4);
  const Vec3 before = world.state(box).position - world.state(id).position;
  world.advance(2);
  const Vec3 after = world.state(box).position - world.state(id).position;
  EXPECT_LT((after - before).norm(), 5e-3);
}

}  // namespace
}  // namespace tw::test
