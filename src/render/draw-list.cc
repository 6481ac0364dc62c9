// Default colours, and checks of what users ask to be drawn.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/draw-list.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace tw {

namespace {

double linear_channel(double c) {
  // IEC 61966-2-1
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::string show_vector(const Vec3& v) {
  return "#(" + show(v.x()) + " " + show(v.y()) + " " + show(v.z()) + ")";
}

void check_finite(const Vec3& v, const char* what) {
  TW_REQUIRE(is_finite(v),
             std::string(what) + " is " + show_vector(v) + "; expected three finite numbers");
}

}  // namespace

namespace {

bool is_bounded(const VisualPart& part) {
  return part.mesh ? !part.mesh->bounds.empty() : part.shape->bounded();
}

}  // namespace

bool has_bounds(const DrawBody& body) {
  if (!body.visible) return false;
  if (!body.visual) return body.shape && body.shape->bounded();
  return std::any_of(body.visual->begin(), body.visual->end(), is_bounded);
}

Aabb bounds_of(const DrawBody& body, const Frame& frame) {
  if (!body.visual) return body.shape->bounds(frame);
  Aabb box;
  for (const VisualPart& part : *body.visual) {
    if (!is_bounded(part)) continue;
    const Frame at = frame * Frame(part.pose);
    if (part.shape) box.add(part.shape->bounds(at));
    for (int corner = 0; part.mesh && corner < 8; ++corner)
      box.add(at * part.mesh->bounds.corner(corner));
  }
  return box;
}

double radius_of(const DrawBody& body) {
  if (!body.visual) return body.shape->radius_about_origin();
  double radius = 0;
  for (const VisualPart& part : *body.visual)
    if (is_bounded(part))
      radius =
          std::max(radius, part.pose.p.norm() +
                               (part.mesh ? part.mesh->radius : part.shape->radius_about_origin()));
  return radius;
}

Vec3 default_color(std::size_t body, bool fixed) {
  if (fixed) return {0.78, 0.76, 0.72};
  // muted hues, neighbours far apart
  static const std::array<Vec3, 10> palette = {Vec3(0.85, 0.37, 0.28), Vec3(0.25, 0.53, 0.74),
                                               Vec3(0.93, 0.69, 0.26), Vec3(0.36, 0.65, 0.45),
                                               Vec3(0.56, 0.42, 0.67), Vec3(0.90, 0.53, 0.27),
                                               Vec3(0.29, 0.66, 0.69), Vec3(0.83, 0.47, 0.58),
                                               Vec3(0.62, 0.68, 0.29), Vec3(0.43, 0.47, 0.60)};
  return palette[body % palette.size()];
}

Vec3 linear_color(const Vec3& srgb) { return srgb.unaryExpr(&linear_channel); }

void check_color(const Vec3& color, const char* what) {
  TW_REQUIRE(is_finite(color) && color.minCoeff() >= 0 && color.maxCoeff() <= 1,
             std::string(what) + " is " + show_vector(color) +
                 "; expected red, green and blue from 0 to 1");
}

void check_camera(const Camera& camera, std::size_t body_count) {
  if (camera.eye) check_finite(*camera.eye, "camera: eye");
  if (camera.target) check_finite(*camera.target, "camera: target");
  check_finite(camera.up, "camera: up");
  TW_REQUIRE(camera.up.norm() > 0, "camera: up is zero; expected a direction");
  TW_REQUIRE(camera.fov > 0 && camera.fov < pi,
             "camera: fov is " + show(camera.fov) + "; expected an angle between 0 and pi radians");
  TW_REQUIRE(std::isfinite(camera.turn),
             "camera: turn is " + show(camera.turn) + "; expected a rate in radians per second");
  TW_REQUIRE(!camera.eye || !camera.target || *camera.eye != *camera.target,
             "camera: eye and target are both " + show_vector(*camera.eye) +
                 "; expected two different points");
  TW_REQUIRE(!camera.follow || *camera.follow < body_count,
             "camera: there is no body " + std::to_string(*camera.follow) + " to follow");
}

void check_light(const Light& light) {
  check_finite(light.direction, "light: direction");
  TW_REQUIRE(light.direction.norm() > 0, "light: direction is zero; expected a direction");
  check_color(light.color, "light: color");
}

void check_sky(const Sky& sky) {
  check_color(sky.zenith, "sky: zenith");
  check_color(sky.horizon, "sky: horizon");
  check_color(sky.ground, "sky: ground");
  TW_REQUIRE(!sky.fog || (std::isfinite(*sky.fog) && *sky.fog >= 0),
             "sky: fog is " + show(*sky.fog) +
                 "; expected the share of light lost per metre, not negative");
  TW_REQUIRE(!sky.grain || (*sky.grain >= 0 && *sky.grain <= 1),
             "sky: grain is " + show(*sky.grain) + "; expected a number from 0 to 1");
}

void check_scene(const DrawScene& scene) {
  check_camera(scene.camera, scene.bodies.size());
  check_light(scene.light);
  check_sky(scene.sky);
  for (const DrawBody& body : scene.bodies)
    if (body.color) check_color(*body.color, "color");
}

void check_size(const ImageSize& size, Quality quality) {
  const std::string text = std::to_string(size.width) + "x" + std::to_string(size.height);
  TW_REQUIRE(size.width >= 1 && size.height >= 1 && size.width <= 16384 && size.height <= 16384,
             "size is " + text + "; expected width and height from 1 to 16384 pixels");
  // about 28 bytes of buffers for every sample
  const double samples = (quality == Quality::best ? 4.0 : 1.0) * size.width * size.height;
  const bool sides_fit = quality != Quality::best || (size.width <= 8192 && size.height <= 8192);
  TW_REQUIRE(samples <= 72e6 && sides_fit,
             "size is " + text + "; too large for quality " +
                 (quality == Quality::best ? "best" : "draft or normal") + ", expected at most " +
                 (quality == Quality::best ? "18" : "72") + " million pixels");
}

}  // namespace tw
