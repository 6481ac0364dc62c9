// What is to be drawn: plain data that the simulation writes and the renderer only reads.
//
// Frames and units: world frame, metres, radians, seconds, z up.  Colours are sRGB, 0..1.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geometry/shape.h"
#include "geometry/visual.h"
#include "math/aabb.h"
#include "math/vec.h"
#include "render/hud.h"

namespace tw {

// A body is known by its index in the order of registration.
struct DrawBody {
  ShapePtr shape;              // null: nothing to see but the visual
  VisualPtr visual;            // null: that of the shape
  Pose pose;                   // where it is as long as no frame says otherwise
  std::optional<Vec3> color;   // absent: default_color()
  std::optional<bool> smooth;  // absent: spheres are smooth, all else has facets
  bool fixed = false;          // only for the default colour
  bool visible = true;
  std::string name;  // for messages
};

// What is absent is chosen so that the scene is in view.
struct Camera {
  std::optional<Vec3> eye, target;
  Vec3 up = Vec3::UnitZ();
  double fov = 0.7;  // vertical, radians, inside (0, pi)
  // Eye and target move with this body, by its displacement from `follow_from`; absent: from the
  // position of its registration.
  std::optional<std::size_t> follow;
  std::optional<Vec3> follow_from;
  // Rate at which the eye goes round the target about `up`, counter-clockwise as seen from above,
  // from where it is at time 0, rad/s.
  double turn = 0;
  // What is to be in view where eye or target are absent; absent: the scene as registered.
  std::optional<Aabb> in_view;
};

struct Light {
  Vec3 direction{-0.75, 0.35, -1.0};  // in which the light flies; any length but zero
  Vec3 color{1.0, 0.97, 0.91};
};

struct Sky {
  Vec3 zenith{0.33, 0.53, 0.80};
  Vec3 horizon{0.80, 0.86, 0.92};
  Vec3 ground{0.48, 0.51, 0.55};  // seen below the horizon where there is no ground
  // Share of the light lost per metre.  Absent: 1/25 of the camera's distance from its target.
  std::optional<double> fog;
  // How rough ground and rocks look, fixed bodies of hulls: 0..1.  Absent: 1 in a landscape, which
  // has a hundred of them, else 0.
  std::optional<double> grain;
};

struct DrawScene {
  std::vector<DrawBody> bodies;
  Camera camera;
  Light light;
  Sky sky;
};

// A line over the picture, its middle at `point`.
struct DrawContact {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // unit
  double length = 0;            // m
  bool slipping = false;        // else it sticks: another colour
};

struct DrawFrame {
  double time = 0;
  std::vector<Pose> poses;      // by body; bodies past its end keep the pose they had
  std::vector<DrawBody> added;  // registered before this frame is drawn
  // Bodies that are not seen from this frame on, others are; absent: as before.
  std::optional<std::vector<std::size_t>> removed;
  std::optional<Camera> camera;  // from this frame on; so are light and sky
  std::optional<Light> light;
  std::optional<Sky> sky;
  std::vector<HudLine> hud;           // lines below the time, UTF-8 (Latin-1 is drawn)
  std::vector<DrawContact> contacts;  // drawn over the picture
};

enum class Quality {
  draft,   // hard shadows, jagged edges
  normal,  // soft shadows, ambient occlusion, edges smoothed by FXAA
  best     // the same, softer, with four samples per pixel
};

// Whether there is something of it to see that has bounds; then these, and the radius of a ball
// about the origin of its frame.
bool has_bounds(const DrawBody& body);
Aabb bounds_of(const DrawBody& body, const Frame& frame);
double radius_of(const DrawBody& body);

// Width and height of the picture, each 1..16384.
struct ImageSize {
  int width = 1280, height = 720;
};

// A pleasant colour, the same for the same index at any time; fixed bodies are a grey beige.
Vec3 default_color(std::size_t body, bool fixed);

// From sRGB, as users give colours, to light that adds up.
Vec3 linear_color(const Vec3& srgb);

// Raise UserError with the value and what was expected.
void check_color(const Vec3& color, const char* what);
void check_camera(const Camera& camera, std::size_t body_count);
void check_light(const Light& light);
void check_sky(const Sky& sky);
// Camera, light, sky and the colours of bodies.
void check_scene(const DrawScene& scene);
// Also refuses sizes whose buffers would be larger than about 2 GB at this quality.
void check_size(const ImageSize& size, Quality quality);

}  // namespace tw
