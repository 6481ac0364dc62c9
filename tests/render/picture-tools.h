// What the tests of drawing share: small scenes, and questions about pictures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "render/renderer.h"
#include "support/temporary-folder.h"

namespace tw::test {

// Ends the test as skipped where this machine cannot draw.
#define TW_SKIP_WITHOUT_OPENGL()           \
  try {                                    \
    ::tw::gl_library();                    \
  } catch (const ::tw::UserError& error) { \
    GTEST_SKIP() << error.what();          \
  }

inline RenderSettings small_settings(Quality quality = Quality::draft) {
  RenderSettings settings;
  settings.size = {160, 120};
  settings.quality = quality;
  settings.hud = false;
  return settings;
}

inline DrawBody make_body(ShapePtr shape, const Vec3& position, const Vec3& color,
                          bool fixed = false) {
  DrawBody body;
  body.shape = std::move(shape);
  body.pose.p = position;
  body.color = color;
  body.fixed = fixed;
  return body;
}

inline DrawFrame frame_at(double time) {
  DrawFrame frame;
  frame.time = time;
  return frame;
}

// A red ball of radius 0.5, 1 m above a white ground; light from straight above, no fog.
inline DrawScene ball_over_ground() {
  DrawScene scene;
  scene.bodies.push_back(make_body(make_sphere(0.5), {0, 0, 1.5}, {0.9, 0.1, 0.1}));
  scene.bodies.push_back(
      make_body(make_half_space({0, 0, 1}, 0), {0, 0, 0}, {0.9, 0.9, 0.9}, true));
  scene.camera.eye = Vec3(0, -6, 3);
  scene.camera.target = Vec3(0, 0, 0.8);
  scene.light.direction = {0, 0, -1};
  scene.sky.fog = 0;
  return scene;
}

inline int red(const Image& image, int x, int y) { return image.pixel(x, y)[0]; }
inline int green(const Image& image, int x, int y) { return image.pixel(x, y)[1]; }
inline int blue(const Image& image, int x, int y) { return image.pixel(x, y)[2]; }
inline int brightness(const Image& image, int x, int y) {
  return red(image, x, y) + green(image, x, y) + blue(image, x, y);
}
inline bool is_reddish(const Image& image, int x, int y) {
  return red(image, x, y) > 40 + std::max(green(image, x, y), blue(image, x, y));
}

// FNV-1a.
inline std::uint64_t hash_of(const Image& image) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : image.rgb) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

// The message of the UserError that `action` raises; "" where it raises none.
template <class Action>
std::string user_error_of(Action action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace tw::test
