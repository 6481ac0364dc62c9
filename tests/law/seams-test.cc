// Seams: bodies that cross the joints of a floor of many pieces move as on one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/schedule.h"

namespace tw::test {
namespace {

// A floor 8 m long of `tiles` boxes, and a body that crosses it at 3 m/s for a second.
BodyState cross(int tiles, bool one_union, const ShapePtr& shape, double friction,
                const Vec3& spin) {
  World world;
  set_contact_for_all(world, 0.2, friction);
  const double length = 8.0 / tiles;
  std::vector<ShapePtr> parts;
  for (int i = 0; i < tiles; ++i) {
    BodyDef tile;
    tile.shape = make_box({length, 4, 1});
    tile.position = Vec3(-0.5 + length * (i + 0.5), 0, -0.5);
    tile.fixed = true;
    Pose pose;
    pose.p = tile.position;
    parts.push_back(place_shape(tile.shape, pose));
    if (!one_union) world.add_body(tile);
  }
  if (one_union) {
    BodyDef floor;
    floor.shape = make_union(parts);
    floor.fixed = true;
    world.add_body(floor);
  }
  const BodyId id = world.add_body(body_of(shape, {0, 0, 0.1}, {3, 0, 0}, spin));
  world.advance(1);
  return world.state(id);
}

struct Crosser {
  const char* name;
  ShapePtr shape;
  double friction;
  Vec3 spin;
};

std::vector<Crosser> crossers() {
  return {{"box", make_box({0.3, 0.25, 0.2}), 0, Vec3::Zero()},
          {"box with friction", make_box({0.3, 0.25, 0.2}), 0.1, Vec3::Zero()},
          {"sliding ball", make_sphere(0.1), 0, Vec3::Zero()},
          {"rolling ball", make_sphere(0.1), 0.5, {0, 30, 0}}};
}

TEST(Seams, forty_are_crossed_as_none) {
  for (const Crosser& c : crossers()) {
    const BodyState plain = cross(1, false, c.shape, c.friction, c.spin);
    const BodyState seamed = cross(40, false, c.shape, c.friction, c.spin);
    EXPECT_LT((seamed.position - plain.position).norm(), 1e-5) << c.name;
    EXPECT_LT((seamed.velocity - plain.velocity).norm(), 1e-4) << c.name;
  }
}

TEST(Seams, of_a_union_are_crossed_as_none) {
  for (const Crosser& c : crossers()) {
    const BodyState plain = cross(1, false, c.shape, c.friction, c.spin);
    const BodyState seamed = cross(40, true, c.shape, c.friction, c.spin);
    EXPECT_LT((seamed.position - plain.position).norm(), 1e-5) << c.name;
  }
}

}  // namespace
}  // namespace tw::test
