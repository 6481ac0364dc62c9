// From a Camera to what the renderer needs: axes, field of view, and where points fall.
//
// Frames: axes of the view in the world: right, up, forward.  The renderer works with positions
// relative to the eye, subtracted in double precision, so that a scene far from the origin is as
// sharp as any other.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>

#include "math/aabb.h"
#include "render/draw-list.h"

namespace tw {

struct View {
  Vec3 eye = Vec3::Zero();
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitZ(), forward = Vec3::UnitY();
  double tan_half_fov = 0.5;     // vertical
  double aspect = 1;             // width over height
  double focus_distance = 1;     // from the eye to the target, m
  double near_distance = 0.001;  // nothing nearer is drawn, m
  int height = 1;                // of the picture, pixels

  // Pixel (from the left, from the top) on which a world point falls; nullopt behind the eye.
  std::optional<Eigen::Vector2d> project(const Vec3& point) const;
  // Pixels per metre at the distance of the target.
  double pixels_per_metre() const;
};

// Eye-relative world to clip space, for ClipControl(ZERO_TO_ONE): reversed depth with an infinite
// far plane, near_distance over the distance along the view.
Eigen::Matrix4f projection_of(const View& view);

// Bounds of the visible bodies that are bounded, and of rooms that half-spaces enclose; a cube of
// 2 m about the origin where there is nothing.
Aabb scene_bounds(std::span<const DrawBody> bodies, std::span<const Pose> poses);

// The view that a camera gives at a time.  `displacement` is that of the followed body.  What the
// camera leaves open is chosen to show `bounds`, from all sides where the camera goes round. Raises
// UserError where eye and target coincide.
View make_view(const Camera& camera, const Aabb& bounds, const ImageSize& size,
               const Vec3& displacement, double time);

}  // namespace tw
