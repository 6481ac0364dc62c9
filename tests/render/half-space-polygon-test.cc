// Half-spaces cut each other to the walls of rooms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/half-space-polygon.h"

#include "picture-tools.h"

namespace tw::test {
namespace {

// the walls of the room [-1, 1] x [-2, 2] x [0, 3], seen from inside
std::vector<DrawBody> room() {
  std::vector<DrawBody> walls;
  const auto add = [&](const Vec3& normal, double offset) {
    walls.push_back(make_body(make_half_space(normal, offset), Vec3::Zero(), {1, 1, 1}, true));
  };
  add({1, 0, 0}, -1);
  add({-1, 0, 0}, -1);
  add({0, 1, 0}, -2);
  add({0, -1, 0}, -2);
  add({0, 0, 1}, 0);
  add({0, 0, -1}, -3);
  return walls;
}

double area(const HalfSpacePolygon& polygon) {
  Vec3 sum = Vec3::Zero();
  const auto& c = polygon.corners;
  for (std::size_t i = 0; i < c.size(); ++i) sum += c[i].cross(c[(i + 1) % c.size()]);
  return 0.5 * sum.dot(polygon.normal);
}

TEST(HalfSpacePolygon, a_lone_face_is_a_large_square_seen_counter_clockwise) {
  const std::vector<DrawBody> bodies = {
      make_body(make_half_space({0, 0.6, 0.8}, 2), {0, 0, 1}, {1, 1, 1}, true)};
  const std::vector<Pose> poses = {bodies[0].pose};
  const auto polygons = half_space_polygons(bodies, poses, Vec3::Zero(), 100);
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_NEAR(area(polygons[0]), 200 * 200, 1e-6);
  for (const Vec3& corner : polygons[0].corners)
    EXPECT_NEAR(polygons[0].normal.dot(corner), 2 + 0.8, 1e-9);
}

TEST(HalfSpacePolygon, six_of_them_enclose_a_room) {
  const std::vector<DrawBody> walls = room();
  const std::vector<Pose> poses(walls.size());
  const auto polygons = half_space_polygons(walls, poses, {0, 0, 1}, 1000);
  ASSERT_EQ(polygons.size(), 6u);
  const double areas[] = {12, 12, 6, 6, 8, 8};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(polygons[i].corners.size(), 4u);
    EXPECT_NEAR(area(polygons[i]), areas[i], 1e-9);
  }
  Aabb bounds;
  add_enclosed_room(walls, poses, bounds);
  EXPECT_LT((bounds.lo - Vec3(-1, -2, 0)).norm(), 1e-6);
  EXPECT_LT((bounds.hi - Vec3(1, 2, 3)).norm(), 1e-6);
}

TEST(HalfSpacePolygon, a_hidden_wall_cuts_but_is_not_seen) {
  std::vector<DrawBody> walls = room();
  walls[5].visible = false;
  const auto polygons =
      half_space_polygons(walls, std::vector<Pose>(walls.size()), {0, 0, 1}, 1000);
  ASSERT_EQ(polygons.size(), 5u);
  EXPECT_NEAR(area(polygons[0]), 12, 1e-9);
}

TEST(HalfSpacePolygon, open_ground_encloses_nothing) {
  const std::vector<DrawBody> ground = {
      make_body(make_half_space({0, 0, 1}, 0), Vec3::Zero(), {1, 1, 1}, true)};
  Aabb bounds;
  add_enclosed_room(ground, std::vector<Pose>(1), bounds);
  EXPECT_TRUE(bounds.empty());
}

}  // namespace
}  // namespace tw::test
