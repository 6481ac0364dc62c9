// Unions of several bars or prisms that hold each other where their parts meet: links of a chain in
// each other's corners, wedges in grooves that are shorter than they are.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/random.h"
#include "support/stability-scenes.h"

namespace tw::test {
namespace {

constexpr double bar = 0.02, half_length = 0.1;  // m, of a link

ShapePtr link() {
  const auto at = [](const Vec3& edges, const Vec3& p) {
    return place_shape(make_box(edges), {p, Quat::Identity()});
  };
  const double end = half_length - 0.5 * bar;
  return make_union({at({2 * half_length, bar, bar}, {0, 0, 0.05}),
                     at({2 * half_length, bar, bar}, {0, 0, -0.05}),
                     at({bar, bar, 0.1}, {end, 0, 0}), at({bar, bar, 0.1}, {-end, 0, 0})});
}

// A chain of twelve links, the first one fixed, falls from the horizontal and cracks like a whip.
// The inner ends of two links that are taut stand a bar apart: twice half a length less a bar each.
TEST(Unions, links_of_a_chain_hold_each_other) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  for (int i = 0; i < 12; ++i) {
    BodyDef def = body_of(link(), {0.159 * i, 0, 2}, Vec3::Zero());
    def.fixed = i == 0;
    if (i % 2) def.orientation = rotation_by(Vec3(0.5 * pi, 0, 0));
    world.add_body(def);
  }
  const double taut = 2 * (half_length - bar);
  for (int frame = 1; frame <= 45; ++frame) {
    world.advance(0.05 * frame);
    for (BodyId i = 1; i < 12; ++i) {
      const double apart = (world.state(i).position - world.state(i - 1).position).norm();
      // corner in corner they reach somewhat farther than straight
      EXPECT_LT(apart, taut + 0.5 * bar) << "link " << i << " at " << world.time() << " s";
    }
  }
  EXPECT_LT(number_of(world.statistics(), "max_penetration"), 0.01 * bar);
}

// A prism along y with this outline in x and z.
ShapePtr prism(double length, const std::vector<Eigen::Vector2d>& outline) {
  std::vector<Vec3> corners;
  for (const Eigen::Vector2d& p : outline)
    for (const double y : {-0.5 * length, 0.5 * length}) corners.emplace_back(p.x(), y, p.y());
  return make_hull(corners);
}

// Fifty grooves of two prisms each, 2 m long, and in each a wedge that is longer: neither goes
// through where the two prisms meet.
TEST(Unions, wedges_are_held_by_shorter_grooves) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const double groove = random.real(0.3, 1.2), depth = 2, width = depth * std::tan(groove);
    const double wedge = random.real(0.2, 1.3), half = std::tan(wedge), x = 40 * i;
    std::vector<ShapePtr> sides;
    for (const double s : {-1.0, 1.0})
      sides.push_back(prism(
          2,
          {{0, 0}, {s * width, depth}, {s * (width + 1), depth}, {s * (width + 1), -1}, {0, -1}}));
    BodyDef ground = body_of(make_union(sides), {x, 0, 0}, Vec3::Zero());
    ground.fixed = true;
    world.add_body(ground);
    // a wide one lies on the rims
    const double start = 0.1 + std::max(0.0, 1.1 * (half / std::tan(groove) - 1));
    BodyDef def =
        body_of(prism(random.real(2.2, 4), {{0, 0}, {half, 1}, {-half, 1}}),
                {x + random.real(-0.05, 0.05), random.real(-0.1, 0.1), 0.8 + start}, Vec3::Zero());
    const Vec3 axis(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    def.orientation = rotation_by(random.real(0, 0.15) * axis);
    world.add_body(def);
  }
  world.advance(2);
  // 2 % of the narrowest; what comes down on one slope is held there by its drag (8.4 mm, else 5)
  EXPECT_LT(number_of(world.statistics(), "max_penetration"), 0.01);
}

// An L of two square bars that share a corner: their soles lie in one plane, and the corners that
// are lifted as it rocks were taken for buried by one another.  So stiffness went to the others at
// once, and it never came to rest.
TEST(Unions, soles_in_one_plane_come_to_rest) {
  const ShapePtr foot = make_box({0.29, 0.05, 0.05});
  const ShapePtr leg =
      place_shape(make_box({0.05, 0.05, 0.25}), Pose{{-0.12, 0, 0.1}, Quat::Identity()});
  for (const double tilt : {0.05, -0.05, 0.3}) {
    World world;
    set_contact_for_all(world, 0.3, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def =
        body_of(make_union({foot, leg}), {0, 0, 0.026 + 0.025 * std::abs(tilt)}, {0, 0, 0});
    def.orientation = rotation_by({tilt, 0, 0});
    const BodyId id = world.add_body(def);
    world.advance(8);
    EXPECT_LT(world.state(id).velocity.norm(), 1e-9) << tilt;
    EXPECT_LT(world.state(id).angular_velocity.norm(), 1e-9) << tilt;
  }
}

}  // namespace
}  // namespace tw::test
