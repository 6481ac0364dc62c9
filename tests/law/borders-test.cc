// Edges that slide and turn over the border of a face: what crosses there wanders along both.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/stability-scenes.h"
#include "support/stability.h"

namespace tw::test {
namespace {

struct Passage {
  double deepest = 0;  // m
  double rise = 0;     // of the energy, over all that there is
  double loss = 0;     // since the blow as it came down
};

// Runs the world to `steps` steps of `step` s; what is lost counts from `blow` s on.
Passage watch(World& world, double step, int steps, double blow) {
  Passage result;
  double lowest = world.total_energy(), after_blow = 0;
  for (int i = 1; i <= steps; ++i) {
    world.advance(step * i);
    StabilityOutcome outcome;
    measure_depths(world, outcome);
    result.deepest = std::max(result.deepest, outcome.deepest);
    const double energy = world.total_energy();
    if (step * i <= blow) after_blow = energy;
    result.rise = std::max(result.rise, (energy - lowest) / energy);
    result.loss = (after_blow - energy) / energy;
    lowest = std::min(lowest, energy);
  }
  return result;
}

// A tetrahedron of 3 m comes down with a horizontal edge on the end of a box of `parts` boxes in a
// row, at 10 m/s and 2.8 rad/s about the vertical, without friction: the edge dips beyond the end
// by up to 1.6 degrees.  At last it leaves over the box's corner.
Passage pass(int parts, double accuracy) {
  World world;
  world.set_gravity(Vec3(0, 0, -9.81));
  world.set_accuracy(accuracy);
  set_contact_for_all(world, 0, 0);
  std::vector<ShapePtr> row;
  const double length = 20.0 / parts;
  for (int i = 0; i < parts; ++i)
    row.push_back(place_shape(make_box({2, length, 10}),
                              {Vec3(0, length * (i + 0.5) - 10, 0), Quat::Identity()}));
  BodyDef box =
      body_of(parts > 1 ? make_union(row) : make_box({2, 20, 10}), {-5, 5.764208, 5}, Vec3::Zero());
  box.fixed = true;
  world.add_body(box);
  BodyDef def =
      body_of(make_hull({{1.5, 1.5, 1.5}, {1.5, -1.5, -1.5}, {-1.5, 1.5, -1.5}, {-1.5, -1.5, 1.5}}),
              {-3.4497236, -1.5985475, 11.7}, {-5.9998209, -8.6425903, -0.59172855});
  def.angular_velocity = {0, 0, 2.7689304};
  world.add_body(def);
  return watch(world, 0.005, 70, 0.16);
}

TEST(Borders, an_edge_that_turns_over_one_is_held) {
  for (const int parts : {1, 5})
    for (const double accuracy : {1e-4, 1e-6}) {
      const Passage passage = pass(parts, accuracy);
      EXPECT_LT(passage.deepest, 1.2e-3) << parts << " " << accuracy;
      EXPECT_LT(passage.rise, 2e-4) << parts << " " << accuracy;
      EXPECT_LT(passage.loss, 1e-3) << parts << " " << accuracy;
    }
}

// A U of three bars falls on a cross of three bars: their edges slide along each other at 3 m/s
// while both turn at 12 rad/s.  As points of planes that are fixed in the bodies where they cross
// is found deeper at each check.
TEST(Borders, edges_that_cross_and_turn_gain_nothing) {
  const auto bar = [](const Vec3& edges, const Vec3& position) {
    return place_shape(make_box(edges), {position, Quat::Identity()});
  };
  const double t = 0.1;
  const ShapePtr u = make_union({bar({0.5, t, t}, {0, 0, 0}), bar({t, t, 0.4}, {-0.2, 0, 0.25}),
                                 bar({t, t, 0.4}, {0.2, 0, 0.25})});
  const ShapePtr cross = make_union(
      {bar({0.5, t, t}, {0, 0, 0}), bar({t, 0.5, t}, {0, 0, 0}), bar({t, t, 0.5}, {0, 0, 0})});
  World world;
  world.set_gravity(Vec3(0, 0, -9.81));
  set_contact_for_all(world, 0, 0);
  BodyDef floor;
  floor.shape = make_half_space({0, 0, 1}, 0);
  floor.fixed = true;
  world.add_body(floor);
  BodyDef lower = body_of(cross, {-0.3375168, -0.3877755, 0.2020726}, Vec3::Zero());
  lower.orientation = Quat(0.2279924, -0.2307120, -0.3976140, -0.8583092).normalized();
  world.add_body(lower);
  BodyDef upper = body_of(u, {-0.2038726, -0.2143934, 0.6612713}, {0, 0, -6.55308});
  upper.orientation = Quat(0.5213694, 0.7721465, -0.3414216, 0.1240764).normalized();
  world.add_body(upper);
  const Passage passage = watch(world, 5e-4, 300, 0);
  EXPECT_LT(passage.deepest, 2e-4);
  EXPECT_LT(passage.rise, 1e-3);
}

}  // namespace
}  // namespace tw::test
