// A picture of the scene's depth as a direction of light sees it: for the sun's shadows, and from
// straight above for how much of the sky a place sees.
//
// Frames: axes of the map: right, up, along (in which the light flies).  The map covers the bodies
// near the camera's target; its side grows in steps and its middle moves by whole texels, so that
// edges of shadows don't swim from frame to frame.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "render/body-drawer.h"
#include "render/view.h"

namespace tw {

// What throws a shadow, for the choice of the map's limits; world frame.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

class ShadowMap {
 public:
  // Look-ups compare with depths and blend the answers, or give the nearest depth.
  enum class LookUp { comparison, depth };

  // `side` in texels.
  ShadowMap(const GlApi& gl, int side, LookUp look_up);

  // Light flies along `direction` (any length but zero).  Casters farther than `reach` from the
  // target are left out.
  void fit(const Vec3& direction, std::span<const Ball> casters, const Vec3& target, double reach);
  void draw(const BodyDrawer& bodies, const GlProgram& mesh_program,
            const GlProgram& sphere_program, const Vec3& eye) const;

  GLuint texture() const { return texture_; }
  double texel() const { return 2 * half_side_ / side_; }  // m
  double depth() const { return last_ - first_; }          // from 0 to 1 in the map, m
  double texel_share() const { return 1.0 / side_; }
  // From eye-relative world coordinates to the texture's, depth in z, all 0..1.
  Matrix4f to_texture(const Vec3& eye) const;

 private:
  Matrix4f to_clip(const Vec3& eye) const;

  const GlApi* gl_;
  int side_;
  GLuint texture_ = 0, framebuffer_ = 0;
  Vec3 right_ = Vec3::UnitX(), up_ = Vec3::UnitY(), along_ = -Vec3::UnitZ();
  // the middle across and the limits along, in the map's axes, world origin
  double middle_right_ = 0, middle_up_ = 0, half_side_ = 1, first_ = -1, last_ = 1;
};

}  // namespace tw
