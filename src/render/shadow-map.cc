// Fitting and drawing shadow maps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/shadow-map.h"

#include <algorithm>
#include <cmath>

namespace tw {

ShadowMap::ShadowMap(const GlApi& gl, int side, LookUp look_up) : gl_(&gl), side_(side) {
  texture_ = make_texture(gl, GL_DEPTH_COMPONENT32F, side, side);
  framebuffer_ = make_framebuffer(gl, 0, 0, texture_);
  if (look_up == LookUp::depth) return;
  // a look-up compares four texels and blends the answers
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

void ShadowMap::fit(const Vec3& direction, std::span<const Ball> casters, const Vec3& target,
                    double reach) {
  along_ = direction.normalized();
  right_ = along_.cross(std::abs(along_.z()) < 0.99 ? Vec3::UnitZ() : Vec3::UnitY()).normalized();
  up_ = right_.cross(along_);

  // limits in the map's axes, no farther than `reach` from the target
  Mat3 axes;
  axes << right_.transpose(), up_.transpose(), along_.transpose();
  const Vec3 middle = axes * target;
  Vec3 lo = middle, hi = middle;
  bool any = false;
  for (const Ball& ball : casters) {
    const Vec3 center = axes * ball.center;
    if ((center - middle).head<2>().norm() > reach + ball.radius) continue;
    const Vec3 size = Vec3::Constant(ball.radius);
    lo = any ? Vec3(lo.cwiseMin(center - size)) : Vec3(center - size);
    hi = any ? Vec3(hi.cwiseMax(center + size)) : Vec3(center + size);
    any = true;
  }
  const Vec3 least = middle - Vec3::Constant(reach), most = middle + Vec3::Constant(reach);
  lo = lo.cwiseMax(least).cwiseMin(most);
  hi = hi.cwiseMax(least).cwiseMin(most);

  // sides in steps of 2^(1/4), the middle at whole texels
  const double wanted = std::max({0.5 * (hi.x() - lo.x()), 0.5 * (hi.y() - lo.y()), 1e-6 * reach});
  half_side_ = std::exp2(0.25 * std::ceil(4 * std::log2(1.02 * wanted)));
  middle_right_ = std::round(0.5 * (lo.x() + hi.x()) / texel()) * texel();
  middle_up_ = std::round(0.5 * (lo.y() + hi.y()) / texel()) * texel();
  const double margin = 0.01 * (hi.z() - lo.z()) + 1e-6 * reach;
  first_ = lo.z() - margin;
  last_ = hi.z() + margin;
}

// clip.x = (right.x - middle)/half side, likewise y; clip.z = (along.x - first)/(last - first).
Matrix4f ShadowMap::to_clip(const Vec3& eye) const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.row(0) << right_.transpose() / half_side_, (right_.dot(eye) - middle_right_) / half_side_;
  m.row(1) << up_.transpose() / half_side_, (up_.dot(eye) - middle_up_) / half_side_;
  m.row(2) << along_.transpose() / depth(), (along_.dot(eye) - first_) / depth();
  return m.cast<float>();
}

Matrix4f ShadowMap::to_texture(const Vec3& eye) const {
  Matrix4f half = Matrix4f::Identity();
  half(0, 0) = half(1, 1) = half(0, 3) = half(1, 3) = 0.5f;
  return half * to_clip(eye);
}

void ShadowMap::draw(const BodyDrawer& bodies, const GlProgram& mesh_program,
                     const GlProgram& sphere_program, const Vec3& eye) const {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_->Viewport(0, 0, side_, side_);
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_LESS);
  gl_->ClearDepth(1);
  gl_->Clear(GL_DEPTH_BUFFER_BIT);
  // what lies before the first limit is drawn at it
  gl_->Enable(GL_DEPTH_CLAMP);
  // the outermost texels stay infinitely deep: what lies beyond the edge is lit
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(1, 1, side_ - 2, side_ - 2);
  gl_->Enable(GL_POLYGON_OFFSET_FILL);
  gl_->PolygonOffset(1.5f, 2.0f);
  const Matrix4f projection = to_clip(eye);
  mesh_program.use();
  mesh_program.set("projection", projection);
  bodies.draw_meshes(BodyDrawer::Which::all);
  gl_->Disable(GL_POLYGON_OFFSET_FILL);
  sphere_program.use();
  sphere_program.set("projection", projection);
  sphere_program.set("light_right", right_);
  sphere_program.set("light_up", up_);
  bodies.draw_spheres();
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_DEPTH_CLAMP);
}

}  // namespace tw
