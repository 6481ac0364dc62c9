// What cannot be drawn is refused with the value and what was expected.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/draw-list.h"

#include <limits>
#include <set>

#include "picture-tools.h"

namespace tw::test {
namespace {

std::string size_error(int width, int height, Quality quality = Quality::normal) {
  return user_error_of([&] { check_size({width, height}, quality); });
}

TEST(DrawList, sizes_from_1_to_16384_are_allowed) {
  EXPECT_EQ(size_error(1, 1), "");
  EXPECT_EQ(size_error(16384, 1), "");
  EXPECT_EQ(size_error(3840, 2160, Quality::best), "");
  EXPECT_TRUE(contains(size_error(0, 720), "size is 0x720; expected width and height from 1"));
  EXPECT_TRUE(contains(size_error(1280, -1), "1280x-1"));
  EXPECT_TRUE(contains(size_error(16385, 10), "16385x10"));
}

TEST(DrawList, sizes_that_need_too_much_memory_are_refused) {
  EXPECT_TRUE(contains(size_error(16384, 16384), "too large"));
  EXPECT_EQ(size_error(8000, 8000), "");
  EXPECT_TRUE(contains(size_error(8000, 8000, Quality::best), "too large for quality best"));
  EXPECT_TRUE(contains(size_error(16384, 2, Quality::best), "too large"));
}

TEST(DrawList, cameras_lights_and_skies_are_checked) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Camera camera;
  EXPECT_EQ(user_error_of([&] { check_camera(camera, 0); }), "");
  camera.fov = 4;
  EXPECT_TRUE(contains(user_error_of([&] { check_camera(camera, 0); }), "fov is 4"));
  camera = Camera();
  camera.eye = camera.target = Vec3(1, 2, 3);
  EXPECT_TRUE(contains(user_error_of([&] { check_camera(camera, 0); }), "#(1 2 3)"));
  camera = Camera();
  camera.eye = Vec3(1, nan, 3);
  EXPECT_TRUE(contains(user_error_of([&] { check_camera(camera, 0); }), "NaN"));
  camera = Camera();
  camera.follow = 2;
  EXPECT_TRUE(contains(user_error_of([&] { check_camera(camera, 2); }), "no body 2"));
  Light light;
  light.direction.setZero();
  EXPECT_TRUE(contains(user_error_of([&] { check_light(light); }), "direction is zero"));
  Sky sky;
  sky.horizon = Vec3(1, 2, 0);
  EXPECT_TRUE(contains(user_error_of([&] { check_sky(sky); }), "from 0 to 1"));
  sky = Sky();
  sky.fog = -1;
  EXPECT_TRUE(contains(user_error_of([&] { check_sky(sky); }), "fog is -1"));
}

TEST(DrawList, default_colours_are_valid_and_neighbours_differ) {
  for (std::size_t body = 0; body < 30; ++body) {
    const Vec3 color = default_color(body, false);
    EXPECT_NO_THROW(check_color(color, "color"));
    EXPECT_EQ(color, default_color(body, false));
    EXPECT_GT((color - default_color(body + 1, false)).norm(), 0.2);
    EXPECT_GT((color - default_color(body, true)).norm(), 0.2);
  }
}

}  // namespace
}  // namespace tw::test
