// Brick, bounce, billiard and gas against their exact results.
//
// Tolerances: an event-driven run has rounding errors alone, multiplied by the motion's own
// sensitivity; each limit is stated at the test.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "support/case-file.h"

namespace tw::test {
namespace {

// Greatest distance to the table's positions, m.
double worst_position(const World& world, const std::vector<std::vector<double>>& exact) {
  double worst = 0;
  for (const auto& row : exact) {
    const BodyState s = world.state(static_cast<BodyId>(row[0]));
    worst = std::max(worst, (s.position - Vec3(row[1], row[2], row[3])).norm());
  }
  return worst;
}

double gas_error(const std::string& name) {
  World world;
  const Case c = read_case(name);
  fill(world, c);
  world.advance(c.duration);
  return worst_position(world, read_rows(name + ".exact.txt"));
}

TEST(ExactCases, brick_tumbles_to_1e_12) {
  World world;
  const Case c = read_case("brick");
  fill(world, c);
  world.advance(c.duration);
  const auto e = read_rows("brick.exact.txt").at(0);
  const BodyState s = world.state(0);
  EXPECT_LT((s.position - Vec3(e[0], e[1], e[2])).norm(), 1e-12 * 287);
  // the angle between attitudes: 2 |vec(q q_exact*)|
  const Quat q(e[3], e[4], e[5], e[6]);
  EXPECT_LT(2 * (s.orientation * q.conjugate()).vec().norm(), 1e-12);
}

TEST(ExactCases, ball_bounces_at_the_exact_times) {
  World world;
  const Case c = read_case("bounce");
  fill(world, c);
  std::vector<double> times;
  world.add_collision_observer([&](const Collision& struck) { times.push_back(struck.time); });
  world.advance(c.duration);
  const auto rows = read_rows("bounce.exact.txt");
  const auto& e = rows.at(0);
  EXPECT_NEAR(world.state(1).position.z(), e[0], 1e-12);
  ASSERT_EQ(times.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(times[i], e[i + 1], 1e-13) << "impact " << i;
}

TEST(ExactCases, billiard_break_ends_where_it_must) {
  World world;
  const Case c = read_case("billiard");
  fill(world, c);
  long collisions = 0;
  world.add_collision_observer([&](const Collision&) { ++collisions; });
  world.advance(c.duration);
  EXPECT_EQ(collisions, 23);
  EXPECT_LT(worst_position(world, read_rows("billiard.exact.txt")), 1e-12);
}

// The gas doubles an error at every few collisions: 1e-16 becomes 1e-12 in 2 s.
TEST(ExactCases, gas_of_100_never_diverges) { EXPECT_LT(gas_error("gas-100"), 1e-10); }

TEST(ExactCases, gas_of_200_never_diverges) { EXPECT_LT(gas_error("gas-200"), 1e-9); }

}  // namespace
}  // namespace tw::test
