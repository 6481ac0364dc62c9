// Pictures show what is there, where it is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/renderer.h"

#include <cmath>
#include <limits>

#include "picture-tools.h"

namespace tw::test {
namespace {

TEST(Renderer, a_body_has_its_colour_where_it_projects_to) {
  TW_SKIP_WITHOUT_OPENGL();
  DrawScene scene = ball_over_ground();
  scene.bodies.push_back(make_body(make_box({0.6, 0.6, 0.6}), {1.4, 0, 1}, {0.1, 0.8, 0.1}));
  Renderer renderer(small_settings(), scene);
  const Image image = renderer.draw(frame_at(0));
  const auto ball = renderer.view().project({0, 0, 1.5});
  const auto box = renderer.view().project({1.4, 0, 1});
  ASSERT_TRUE(ball && box);
  EXPECT_TRUE(is_reddish(image, static_cast<int>(ball->x()), static_cast<int>(ball->y())));
  const int x = static_cast<int>(box->x()), y = static_cast<int>(box->y());
  EXPECT_GT(green(image, x, y), 30 + std::max(red(image, x, y), blue(image, x, y)));
}

TEST(Renderer, a_sphere_covers_the_area_of_its_cone_of_sight) {
  TW_SKIP_WITHOUT_OPENGL();
  DrawScene scene;
  scene.bodies.push_back(make_body(make_sphere(0.5), {0, 0, 0}, {0.9, 0.1, 0.1}));
  scene.camera.eye = Vec3(0, -3, 0);
  scene.camera.target = Vec3(0, 0, 0);
  DrawScene nothing = scene;
  nothing.bodies.clear();
  const Image empty = Renderer(small_settings(), nothing).draw(frame_at(0));
  for (const bool smooth : {true, false}) {
    scene.bodies[0].smooth = smooth;
    Renderer renderer(small_settings(), scene);
    const Image image = renderer.draw(frame_at(0));
    int covered = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        covered += red(image, x, y) != red(empty, x, y) || blue(image, x, y) != blue(empty, x, y);
    // the cone of half angle asin(r/d) cuts the picture in a circle of radius tan(asin(r/d))
    const double pixels = 0.5 * image.height / renderer.view().tan_half_fov;
    const double radius = pixels * std::tan(std::asin(0.5 / 3));
    const double area = pi * radius * radius;
    EXPECT_NEAR(covered, area, smooth ? 0.005 * area : 0.03 * area);
  }
}

TEST(Renderer, the_shadow_falls_along_the_light) {
  TW_SKIP_WITHOUT_OPENGL();
  DrawScene scene = ball_over_ground();
  scene.light.direction = {1, 0, -1};
  for (const Quality quality : {Quality::draft, Quality::normal}) {
    Renderer renderer(small_settings(quality), scene);
    const Image image = renderer.draw(frame_at(0));
    // the ball's centre is 1.5 m up: at 45 degrees its shadow lies 1.5 m aside
    const auto shadow = renderer.view().project({1.5, 0, 0});
    const auto other_side = renderer.view().project({-1.5, 0, 0});
    ASSERT_TRUE(shadow && other_side);
    const int dark =
        brightness(image, static_cast<int>(shadow->x()), static_cast<int>(shadow->y()));
    const int light =
        brightness(image, static_cast<int>(other_side->x()), static_cast<int>(other_side->y()));
    EXPECT_LT(dark, 0.7 * light);
  }
}

TEST(Renderer, what_is_nearer_hides_what_is_behind_even_1000_m_away) {
  TW_SKIP_WITHOUT_OPENGL();
  DrawScene scene;
  // two plates 10 cm apart, the red one nearer
  scene.bodies.push_back(make_body(make_box({400, 0.01, 400}), {0, 1000, 0}, {0.9, 0.1, 0.1}));
  scene.bodies.push_back(make_body(make_box({400, 0.01, 400}), {0, 1000.1, 0}, {0.1, 0.1, 0.9}));
  scene.camera.eye = Vec3(0, 0, 0);
  scene.camera.target = Vec3(0, 100, 0);
  scene.sky.fog = 0;
  scene.light.direction = {0, 1, -0.5};
  const Image image = Renderer(small_settings(), scene).draw(frame_at(0));
  for (int y = 40; y < 80; ++y)
    for (int x = 50; x < 110; ++x) ASSERT_TRUE(is_reddish(image, x, y)) << x << " " << y;
}

TEST(Renderer, bodies_far_from_the_origin_look_the_same) {
  TW_SKIP_WITHOUT_OPENGL();
  const Vec3 far(3e6, -2e6, 0);
  DrawScene scene = ball_over_ground();
  const Image near_image = Renderer(small_settings(), scene).draw(frame_at(0));
  for (DrawBody& body : scene.bodies) body.pose.p += far;
  *scene.camera.eye += far;
  *scene.camera.target += far;
  const Image far_image = Renderer(small_settings(), scene).draw(frame_at(0));
  long different = 0;
  for (std::size_t i = 0; i < near_image.rgb.size(); ++i)
    different += std::abs(near_image.rgb[i] - far_image.rgb[i]) > 8;
  EXPECT_LT(different, 0.01 * static_cast<double>(near_image.rgb.size()));
}

TEST(Renderer, a_pose_that_is_not_finite_is_left_out_and_counted) {
  TW_SKIP_WITHOUT_OPENGL();
  Renderer renderer(small_settings(), ball_over_ground());
  DrawFrame frame = frame_at(0);
  frame.poses.resize(2);
  frame.poses[0].p = {0, std::numeric_limits<double>::quiet_NaN(), 1};
  const Image image = renderer.draw(frame);
  EXPECT_EQ(renderer.skipped_poses(), 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) ASSERT_FALSE(is_reddish(image, x, y));
  frame.poses[0].p = {0, 0, 1e300};
  renderer.draw(frame);
  EXPECT_EQ(renderer.skipped_poses(), 2);
  // back where it can be seen
  frame.poses[0].p = {0, 0, 1.5};
  const Image again = renderer.draw(frame);
  const auto ball = renderer.view().project({0, 0, 1.5});
  EXPECT_TRUE(is_reddish(again, static_cast<int>(ball->x()), static_cast<int>(ball->y())));
}

// The spread of brightness over the middle of a picture of one plate.
double spread_on_plate(ShapePtr shape, bool fixed, std::optional<double> grain = 1) {
  DrawScene scene;
  scene.bodies.push_back(make_body(std::move(shape), {0, 0, 0}, {0.5, 0.5, 0.5}, fixed));
  scene.sky.grain = grain;
  scene.camera.eye = Vec3(0, -0.1, 4);
  scene.camera.target = Vec3(0, 0, 0);
  const Image image = Renderer(small_settings(Quality::normal), scene).draw(frame_at(0));
  double sum = 0, squares = 0, count = 0;
  for (int y = 30; y < 90; ++y)
    for (int x = 40; x < 120; ++x, ++count) {
      sum += brightness(image, x, y);
      squares += brightness(image, x, y) * brightness(image, x, y);
    }
  return std::sqrt(squares / count - (sum / count) * (sum / count)) / (sum / count);
}

TEST(Renderer, hulls_that_stand_fixed_have_a_grain_and_others_have_not) {
  TW_SKIP_WITHOUT_OPENGL();
  const auto hull = [] {
    return make_hull({{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}, {0, 0, -1}});
  };
  EXPECT_GT(spread_on_plate(hull(), true), 0.04);
  EXPECT_LT(spread_on_plate(hull(), false), 0.03);
  EXPECT_LT(spread_on_plate(hull(), true, std::nullopt), 0.03);
  EXPECT_LT(spread_on_plate(make_box({8, 8, 0.1}), true), 0.03);
  // all parts of a body or none: what is seen here is its box
  const ShapePtr below = make_hull({{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {0, 0, -3}});
  EXPECT_GT(spread_on_plate(make_union({make_box({8, 8, 0.1}), below}), true), 0.04);
  EXPECT_LT(spread_on_plate(make_union({make_box({8, 8, 0.1}), below}), false), 0.03);
}

TEST(Renderer, camera_light_and_sky_can_change_between_frames) {
  TW_SKIP_WITHOUT_OPENGL();
  Renderer renderer(small_settings(), ball_over_ground());
  const auto place = [&] { return renderer.view().project({0, 0, 1.5}); };
  Image image = renderer.draw(frame_at(0));
  EXPECT_TRUE(is_reddish(image, static_cast<int>(place()->x()), static_cast<int>(place()->y())));
  DrawFrame frame = frame_at(1);
  frame.camera = Camera();
  frame.camera->eye = Vec3(0, -6, 3);
  frame.camera->target = Vec3(0, 0, 9);
  frame.light = Light();
  frame.light->color = {0, 0, 0};
  frame.sky = Sky();
  frame.sky->zenith = frame.sky->horizon = {0.1, 0.8, 0.1};
  image = renderer.draw(frame);
  EXPECT_GT(green(image, 80, 20), 60 + std::max(red(image, 80, 20), blue(image, 80, 20)));
  // and stay so
  EXPECT_EQ(hash_of(renderer.draw(frame_at(1))), hash_of(image));
  frame.light->direction.setZero();
  EXPECT_TRUE(contains(user_error_of([&] { renderer.draw(frame); }), "direction is zero"));
}

TEST(Renderer, a_camera_that_follows_keeps_the_body_in_its_place) {
  TW_SKIP_WITHOUT_OPENGL();
  DrawScene scene = ball_over_ground();
  scene.camera.follow = 0;
  Renderer renderer(small_settings(), scene);
  renderer.draw(frame_at(0));
  const auto before = renderer.view().project({0, 0, 1.5});
  DrawFrame frame = frame_at(1);
  frame.poses = {{{7, 3, 4}, Quat::Identity()}};
  const Image image = renderer.draw(frame);
  const auto after = renderer.view().project({7, 3, 4});
  ASSERT_TRUE(before && after);
  EXPECT_LT((*after - *before).norm(), 1e-9);
  EXPECT_TRUE(is_reddish(image, static_cast<int>(after->x()), static_cast<int>(after->y())));
}

TEST(Renderer, bodies_can_be_added_and_hidden) {
  TW_SKIP_WITHOUT_OPENGL();
  DrawScene scene = ball_over_ground();
  scene.bodies[0].visible = false;
  Renderer renderer(small_settings(), scene);
  Image image = renderer.draw(frame_at(0));
  const auto place = renderer.view().project({0, 0, 1.5});
  const int x = static_cast<int>(place->x()), y = static_cast<int>(place->y());
  EXPECT_FALSE(is_reddish(image, x, y));
  DrawFrame frame = frame_at(1);
  frame.added.push_back(make_body(make_box({1, 1, 1}), {0, 0, 1.5}, {0.9, 0.1, 0.1}));
  image = renderer.draw(frame);
  EXPECT_TRUE(is_reddish(image, x, y));
}

TEST(Renderer, best_quality_shows_the_same_scene) {
  TW_SKIP_WITHOUT_OPENGL();
  const DrawScene scene = ball_over_ground();
  const Image normal = Renderer(small_settings(Quality::normal), scene).draw(frame_at(0));
  const Image best = Renderer(small_settings(Quality::best), scene).draw(frame_at(0));
  double difference = 0;
  for (std::size_t i = 0; i < normal.rgb.size(); ++i)
    difference += std::abs(normal.rgb[i] - best.rgb[i]);
  EXPECT_LT(difference / static_cast<double>(normal.rgb.size()), 3);
}

TEST(Renderer, an_empty_scene_is_sky) {
  TW_SKIP_WITHOUT_OPENGL();
  const Image image = Renderer(small_settings(), DrawScene()).draw(frame_at(0));
  EXPECT_GT(blue(image, 80, 2), 100);
}

}  // namespace
}  // namespace tw::test
