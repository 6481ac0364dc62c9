// Cameras look where they are told to, or at the whole scene.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/view.h"

#include "picture-tools.h"

namespace tw::test {
namespace {

Aabb box_of(const Vec3& lo, const Vec3& hi) {
  Aabb box;
  box.add(lo);
  box.add(hi);
  return box;
}

TEST(View, the_target_is_in_the_middle_and_up_is_up) {
  Camera camera;
  camera.eye = Vec3(3, -4, 2);
  camera.target = Vec3(0, 1, 1);
  const View view = make_view(camera, box_of({-1, -1, -1}, {1, 1, 1}), {640, 480}, Vec3::Zero(), 0);
  const auto middle = view.project({0, 1, 1});
  ASSERT_TRUE(middle);
  EXPECT_LT((*middle - Eigen::Vector2d(320, 240)).norm(), 1e-9);
  EXPECT_LT(view.project({0, 1, 1.5})->y(), 240);
  EXPECT_FALSE(view.project({6, -9, 3}));
}

TEST(View, half_the_field_of_view_reaches_the_upper_edge) {
  Camera camera;
  camera.eye = Vec3(0, -2, 0);
  camera.target = Vec3(0, 0, 0);
  camera.fov = 0.8;
  const View view = make_view(camera, Aabb(), {300, 200}, Vec3::Zero(), 0);
  EXPECT_NEAR(view.project({0, 0, 2 * std::tan(0.4)})->y(), 0, 1e-9);
  EXPECT_NEAR(view.project({2 * std::tan(0.4) * 1.5, 0, 0})->x(), 300, 1e-9);
}

TEST(View, looking_straight_down_is_possible) {
  Camera camera;
  camera.eye = Vec3(0, 0, 5);
  camera.target = Vec3(0, 0, 0);
  const View view = make_view(camera, Aabb(), {100, 100}, Vec3::Zero(), 0);
  EXPECT_NEAR(view.right.norm(), 1, 1e-12);
  EXPECT_NEAR(view.right.cross(view.up).dot(view.forward), -1, 1e-12);
}

TEST(View, without_eye_and_target_the_whole_box_is_in_the_picture) {
  const Aabb box = box_of({-3, 1, 0}, {5, 2, 9});
  for (const ImageSize size : {ImageSize{1280, 720}, ImageSize{100, 400}}) {
    const View view = make_view(Camera(), box, size, Vec3::Zero(), 0);
    double widest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = view.project({(corner & 1) ? box.hi.x() : box.lo.x(),
                                    (corner & 2) ? box.hi.y() : box.lo.y(),
                                    (corner & 4) ? box.hi.z() : box.lo.z()});
      ASSERT_TRUE(at);
      EXPECT_GT(at->minCoeff(), 0);
      EXPECT_LT(at->x(), size.width);
      EXPECT_LT(at->y(), size.height);
      widest = std::max({widest, std::abs(2 * at->x() / size.width - 1),
                         std::abs(2 * at->y() / size.height - 1)});
    }
    // and fills most of it
    EXPECT_GT(widest, 0.75);
  }
}

TEST(View, a_turning_eye_goes_round_the_target_counter_clockwise) {
  Camera camera;
  camera.eye = Vec3(3, 0, 2);
  camera.target = Vec3(0, 0, 1);
  camera.turn = 0.5;
  const View view = make_view(camera, Aabb(), {300, 200}, Vec3(0, 0, 7), pi);
  EXPECT_LT((view.eye - Vec3(0, 3, 9)).norm(), 1e-12);
  EXPECT_LT((*view.project({0, 0, 8}) - Eigen::Vector2d(150, 100)).norm(), 1e-9);
  EXPECT_LT(view.project({0, 0, 8.5})->y(), 100);
}

TEST(View, a_turning_camera_without_eye_shows_the_box_from_all_sides) {
  const Aabb box = box_of({-3, 1, 0}, {5, 2, 4});
  Camera camera;
  camera.turn = 1;
  for (int i = 0; i < 12; ++i) {
    const View view = make_view(camera, box, {400, 300}, Vec3::Zero(), 0.5 * i);
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = view.project({(corner & 1) ? box.hi.x() : box.lo.x(),
                                    (corner & 2) ? box.hi.y() : box.lo.y(),
                                    (corner & 4) ? box.hi.z() : box.lo.z()});
      ASSERT_TRUE(at);
      EXPECT_GT(at->minCoeff(), 0);
      EXPECT_LT(at->x(), 400);
      EXPECT_LT(at->y(), 300);
    }
  }
}

TEST(View, scene_bounds_hold_all_that_is_visible_and_bounded) {
  std::vector<DrawBody> bodies = {make_body(make_sphere(1), {2, 0, 0}, {1, 1, 1}),
                                  make_body(make_sphere(1), {50, 0, 0}, {1, 1, 1}),
                                  make_body(make_half_space({0, 0, 1}, 0), {0, 0, 0}, {1, 1, 1})};
  bodies[1].visible = false;
  const std::vector<Pose> poses = {bodies[0].pose, bodies[1].pose, bodies[2].pose};
  const Aabb bounds = scene_bounds(bodies, poses);
  EXPECT_EQ(bounds.lo, Vec3(1, -1, -1));
  EXPECT_EQ(bounds.hi, Vec3(3, 1, 1));
}

TEST(View, an_empty_scene_has_bounds_too) { EXPECT_EQ(scene_bounds({}, {}).size(), Vec3(2, 2, 2)); }

}  // namespace
}  // namespace tw::test
