// Views: looking at a target, and fitting a scene into the picture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/half-space-polygon.h"

namespace tw {

namespace {

void point_axes(View& view, const Vec3& forward, const Vec3& up) {
  view.forward = forward.normalized();
  Vec3 right = view.forward.cross(up.normalized());
  // looking along `up`: any direction across will do
  if (right.norm() < 1e-6)
    right = view.forward.cross(std::abs(view.forward.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX());
  view.right = right.normalized();
  view.up = view.right.cross(view.forward);
}

// The least distance from `center` at which all corners of the box are inside the picture:
// |x| <= (D + z) tan(fov/2), x across and z along the direction of view from the centre.
double distance_to_fit(const View& view, const Aabb& box, const Vec3& center) {
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 d = box.corner(corner) - center;
    const double across = std::abs(d.dot(view.right)) / (view.tan_half_fov * view.aspect);
    const double upward = std::abs(d.dot(view.up)) / view.tan_half_fov;
    distance = std::max(distance, std::max(across, upward) - d.dot(view.forward));
  }
  return distance;
}

// How far across the view the middle of the box's picture lies from `center`, at its distance.
Vec3 off_middle(const View& view, const Aabb& box, const Vec3& center, double distance) {
  Eigen::Array2d lo = Eigen::Array2d::Constant(1e300), hi = -lo;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 d = box.corner(corner) - center;
    const Eigen::Array2d at = Eigen::Array2d(d.dot(view.right), d.dot(view.up)) * distance /
                              (distance + d.dot(view.forward));
    lo = lo.min(at);
    hi = hi.max(at);
  }
  const Eigen::Array2d middle = 0.5 * (lo + hi);
  return middle.x() * view.right + middle.y() * view.up;
}

// Places the eye so that the box fills the picture, with some air around it.
void fit_box(View& view, const Aabb& box, Vec3 center, bool may_shift) {
  for (int round = 0; may_shift && round < 4; ++round)
    center += off_middle(view, box, center, 1.1 * distance_to_fit(view, box, center));
  view.focus_distance = std::max(1.06 * distance_to_fit(view, box, center), 1e-3);
  view.eye = center - view.focus_distance * view.forward;
}

// The upright box that holds a box turned about its upright middle line.
Aabb turned_box(const Aabb& box) {
  const Vec3 half = 0.5 * box.size();
  const double radius = half.head<2>().norm();
  Aabb turned;
  turned.add(box.center() - Vec3(radius, radius, half.z()));
  turned.add(box.center() + Vec3(radius, radius, half.z()));
  return turned;
}

void turn_about_target(View& view, const Vec3& up, double angle) {
  const Eigen::AngleAxisd turn(std::remainder(angle, 2 * pi), up.normalized());
  const Vec3 target = view.eye + view.focus_distance * view.forward;
  view.eye = target + turn * (view.eye - target);
  for (Vec3* axis : {&view.right, &view.up, &view.forward}) *axis = turn * *axis;
}

}  // namespace

// x f/aspect, y f, near, z along the view, with f = 1/tan(fov/2).
Eigen::Matrix4f projection_of(const View& view) {
  const double f = 1 / view.tan_half_fov;
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
  p.row(0).head<3>() = f / view.aspect * view.right.transpose();
  p.row(1).head<3>() = f * view.up.transpose();
  p(2, 3) = view.near_distance;
  p.row(3).head<3>() = view.forward.transpose();
  return p.cast<float>();
}

std::optional<Eigen::Vector2d> View::project(const Vec3& point) const {
  const Vec3 d = point - eye;
  const double depth = d.dot(forward);
  if (!(depth > near_distance)) return std::nullopt;
  const double scale = 0.5 * height / (depth * tan_half_fov);
  return Eigen::Vector2d(0.5 * height * aspect + scale * d.dot(right),
                         0.5 * height - scale * d.dot(up));
}

double View::pixels_per_metre() const { return 0.5 * height / (focus_distance * tan_half_fov); }

Aabb scene_bounds(std::span<const DrawBody> bodies, std::span<const Pose> poses) {
  Aabb bounds;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const DrawBody& body = bodies[i];
    if (!has_bounds(body)) continue;
    if (!is_finite(poses[i].p) || !is_finite(poses[i].q)) continue;
    bounds.add(bounds_of(body, Frame(poses[i])));
  }
  add_enclosed_room(bodies, poses, bounds);
  if (bounds.empty()) {
    bounds.add(Vec3::Constant(-1));
    bounds.add(Vec3::Constant(1));
  }
  return bounds;
}

View make_view(const Camera& camera, const Aabb& all_bounds, const ImageSize& size,
               const Vec3& displacement, double time) {
  const Aabb bounds = camera.turn == 0 ? all_bounds : turned_box(all_bounds);
  View view;
  view.tan_half_fov = std::tan(0.5 * camera.fov);
  view.aspect = static_cast<double>(size.width) / size.height;
  view.height = size.height;

  const Vec3 target = camera.target.value_or(bounds.center());
  if (camera.eye) {
    point_axes(view, target - *camera.eye, camera.up);
    view.focus_distance = (target - *camera.eye).norm();
    view.eye = *camera.eye;
  } else {
    // from the front, a little from the right and above
    point_axes(view, Vec3(-0.45, 1, -0.42), camera.up);
    fit_box(view, bounds, target, !camera.target);
  }
  TW_REQUIRE(view.focus_distance > 0, "camera: eye and target coincide");
  if (camera.turn != 0) turn_about_target(view, camera.up, camera.turn * time);
  view.eye += displacement;
  view.near_distance = 1e-3 * view.focus_distance;
  return view;
}

}  // namespace tw
