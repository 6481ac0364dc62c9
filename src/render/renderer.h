// Draws frames of one scene into pictures in memory.
//
// Passes: two shadow maps (sun; straight above), surfaces (colour, normal, depth), light with fog
// where there is a surface, sky where there is none, smoothing of edges; then, in memory, contacts
// and the HUD.  Light is computed once per pixel, not per triangle, since llvmpipe shades whole
// blocks of pixels for each triangle.  Depth
// is reversed (1 at the near plane, 0 at infinity) in 32-bit floats: two planes 2 cm apart stay
// apart at 5 km.
//
// The thread that makes a Renderer is the only one that may use it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/body-drawer.h"
#include "render/contact-overlay.h"
#include "render/draw-list.h"
#include "render/gl-context.h"
#include "render/half-space-polygon.h"
#include "render/image.h"
#include "render/shadow-map.h"

namespace tw {

struct RenderSettings {
  ImageSize size;
  Quality quality = Quality::normal;
  bool hud = true;
  std::string footer;  // at the lower right
};

class Renderer {
 public:
  // Raises UserError on sizes, cameras, lights and skies that make no sense, and where OpenGL
  // cannot be had.
  Renderer(const RenderSettings& settings, const DrawScene& scene);
  ~Renderer();

  // The picture of a frame.  Bodies whose pose is not finite (or farther than 1e12 m) are left
  // out and counted.
  Image draw(const DrawFrame& frame);

  // The view of the frame drawn last.
  const View& view() const { return view_; }
  long skipped_poses() const { return skipped_poses_; }
  std::string description() const { return context_->description(); }

 private:
  struct Programs;
  // what each quality pays for
  struct Effort {
    int shadow_side, softness, overhead_side, overhead_taps, samples;
    bool fxaa, grain;
  };
  static Effort effort_of(Quality quality);

  void make_targets();
  void register_body(const DrawBody& body);
  void set_looks(const DrawFrame& frame);
  void set_poses(const DrawFrame& frame);
  void set_view(double time);
  void fit_shadows();
  void draw_surfaces();
  void draw_bodies();
  void draw_grounds();
  void draw_ground(const HalfSpacePolygon& polygon);
  void light_picture();
  double grain() const;
  void set_light(const GlProgram& program) const;
  void smooth_edges();
  void set_rays(const GlProgram& program) const;
  Image read_picture() const;
  DepthPicture read_depth() const;
  void finish_hud(Image& image, const DrawFrame& frame) const;

  RenderSettings settings_;
  Effort effort_;
  DrawScene scene_;
  std::unique_ptr<GlContext> context_;
  const GlApi* gl_;
  std::unique_ptr<Programs> programs_;
  BodyDrawer bodies_;
  ShadowMap sun_map_, overhead_map_;
  std::vector<Pose> poses_;
  std::vector<bool> removed_;  // bodies that are not seen any more
  View view_;
  Matrix4f projection_ = Matrix4f::Identity();
  Aabb first_bounds_;     // of the scene as registered: what cameras are fitted to
  double cell_size_ = 1;  // of the checks on half-spaces, m
  double body_size_ = 1;  // median radius, m
  long skipped_poses_ = 0;
  int surface_width_ = 0, surface_height_ = 0;
  GLuint color_ = 0, normal_ = 0, depth_ = 0, lit_ = 0, final_ = 0;
  GLuint surface_buffer_ = 0, lit_buffer_ = 0, final_buffer_ = 0;
  GLuint grain_ = 0;
  GLuint unfiltered_ = 0;  // a sampler
  GLuint empty_array_ = 0, ground_array_ = 0, ground_buffer_ = 0;
};

}  // namespace tw
