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
};

// A tetrahedron of 3 m comes down with a horizontal edge on the end of a box of `parts` boxes in a
// row, at 10 m/s and 2.8 rad/s about the vertical, without friction: the edge dips beyond the end
// by up to 1.6 degrees.
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
  BodyDef box = body_of(parts > 1 ? make_union(row) : make_box({2, 20, 10}), {-5, 5.764208, 5}, {});
  box.fixed = true;
  world.add_body(box);
  BodyDef def =
      body_of(make_hull({{1.5, 1.5, 1.5}, {1.5, -1.5, -1.5}, {-1.5, 1.5, -1.5}, {-1.5, -1.5, 1.5}}),
              {-3.4497236, -1.5985475, 11.7}, {-5.9998209, -8.6425903, -0.59172855});
  def.angular_velocity = {0, 0, 2.7689304};
  world.add_body(def);
  Passage result;
  double lowest = world.total_energy();
  for (int i = 1; i <= 70; ++i) {
    world.advance(0.005 * i);
    StabilityOutcome outcome;
    measure_depths(world, outcome);
    result.deepest = std::max(result.deepest, outcome.deepest);
    const double energy = world.total_energy();
    result.rise = std::max(result.rise, (energy - lowest) / world.total_energy());
    lowest = std::min(lowest, energy);
  }
  return result;
}

TEST(Borders, an_edge_that_turns_over_one_is_held) {
  for (const int parts : {1, 5})
    for (const double accuracy : {1e-4, 1e-6}) {
      const Passage passage = pass(parts, accuracy);
      EXPECT_LT(passage.deepest, 1.2e-3) << parts << " " << accuracy;
      EXPECT_LT(passage.rise, 2e-4) << parts << " " << accuracy;
    }
}

}  // namespace
}  // namespace tw::test
