// Gases without a table against the dedicated event-driven program.
//
// Tolerance: a gas multiplies errors; after 2 s two programs that differ by rounding alone are
// 1e-11 m apart, two that miss one impact about a metre.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "../bench/event-driven-md.h"
#include "support/case-file.h"

namespace tw::test {
namespace {

constexpr double duration = 2;  // s

void fill(World& world, const bench::Gas& gas) {
  world.set_gravity(Vec3::Zero());
  ContactSettings elastic;
  elastic.restitution = 1;
  elastic.friction = 0;
  world.set_contact({}, {}, elastic);
  for (std::size_t i = 0; i < gas.position.size(); ++i) {
    BodyDef def;
    def.shape = make_sphere(gas.radius);
    def.position = gas.position[i];
    def.velocity = gas.velocity[i];
    world.add_body(def);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true}) {
      BodyDef def;
      def.shape = make_half_space((far ? -1 : 1) * Vec3::Unit(axis), far ? -gas.side : 0);
      def.fixed = true;
      world.add_body(def);
    }
}

TEST(EventDrivenMd, agrees_with_the_exact_tables_to_1e_11) {
  for (const std::string name : {"gas-100", "gas-200"}) {
    const Case c = read_case(name);
    bench::Gas gas;
    gas.side = 10;
    gas.radius = 0.25;
    for (const BodyDef& def : c.bodies) {
      if (def.fixed) continue;
      gas.position.push_back(def.position);
      gas.velocity.push_back(def.velocity);
    }
    bench::EventDrivenMd md(gas);
    md.advance(c.duration);
    for (const auto& row : read_rows(name + ".exact.txt")) {
      const int i = static_cast<int>(row[0]);
      EXPECT_LT((md.position(i) - Vec3(row[1], row[2], row[3])).norm(), 1e-11) << name << " " << i;
    }
  }
}

TEST(Gas, of_400_and_1600_agrees_with_the_event_driven_program_to_1e_9) {
  for (const int count : {400, 1600}) {
    const bench::Gas gas = bench::make_gas(count);
    bench::EventDrivenMd md(gas);
    md.advance(duration);
    World world;
    fill(world, gas);
    long collisions = 0;
    world.add_collision_observer([&](const Collision&) { ++collisions; });
    world.advance(duration);

    EXPECT_EQ(collisions, md.pair_collisions() + md.wall_collisions());
    double apart = 0;
    for (int i = 0; i < count; ++i)
      apart =
          std::max(apart, (world.state(static_cast<BodyId>(i)).position - md.position(i)).norm());
    EXPECT_LT(apart, 1e-9) << count;
  }
}

TEST(Gas, keeps_fewer_than_300_states_over_10_000_collisions) {
  World world;
  fill(world, bench::make_gas(200));
  world.advance(60);
  std::int64_t peak = 0, collisions = 0;
  for (const auto& [name, value] : world.statistics()) {
    if (name == "peak_states") peak = std::get<std::int64_t>(value);
    if (name == "collisions") collisions = std::get<std::int64_t>(value);
  }
  EXPECT_GT(collisions, 9000);
  EXPECT_LT(peak, 300);  // 206 bodies
}

}  // namespace
}  // namespace tw::test
