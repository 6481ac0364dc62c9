// The passes of a frame.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "base/error.h"
#include "render/grain.h"
#include "render/hud.h"
#include "render/shaders.h"

namespace tw {

namespace {

// EXT_texture_sRGB_decode
constexpr GLenum texture_srgb_decode = 0x8A48;
constexpr GLint skip_decode = 0x8A4A;

constexpr double farthest_pose = 1e12;  // m; beyond, products overflow single precision
constexpr int landscape_parts = 100;    // fixed hulls, from which on they are taken for ground
constexpr double ground_reach = 4000;   // of an unbounded plane, in distances of the target

bool drawable(const Pose& pose) {
  return is_finite(pose.p) && is_finite(pose.q) && pose.p.cwiseAbs().maxCoeff() <= farthest_pose;
}

// 1, 2 or 5 times a power of ten, nearest below.
double round_size(double size) {
  const double power = std::pow(10.0, std::floor(std::log10(size)));
  return size >= 5 * power ? 5 * power : size >= 2 * power ? 2 * power : power;
}

double within_four(double x) { return std::fmod(x, 4.0); }

std::string define(const char* name, int value) {
  return std::string("#define ") + name + " " + std::to_string(value) + "\n";
}

// Points spread evenly over a disc, on a spiral by the golden angle, for EACH_POINT of the shader.
std::string spiral_points(int count) {
  if (count == 0) return "";
  std::string text = "#define EACH_POINT(look)";
  for (int i = 0; i < count; ++i) {
    const double angle = 2.39996 * i, share = (i + 0.5) / count;
    char point[80];
    std::snprintf(point, sizeof point, " look(%.6f, %.6f, %.6f)", std::cos(angle), std::sin(angle),
                  share);
    text += point;
  }
  return text + "\n";
}

Ball ball_around(const DrawBody& body, const Pose& pose) { return {pose.p, radius_of(body)}; }

double median_radius(const std::vector<DrawBody>& bodies) {
  std::vector<double> radii;
  for (const DrawBody& body : bodies)
    if (has_bounds(body) && !body.fixed) radii.push_back(radius_of(body));
  if (radii.empty()) return 0.5;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

}  // namespace

struct Renderer::Programs {
  const GlApi& gl;
  const Effort effort;
  GlProgram mesh, sphere, ground, mesh_shadow, sphere_shadow, light, sky, fxaa, average;
  // made when a scene first has a grain, a texture
  std::optional<GlProgram> light_with_grain, textured;

  Programs(const GlApi& api, const Effort& pays)
      : gl(api),
        effort(pays),
        mesh(gl, shaders::mesh_vertex, shaders::mesh_fragment, shaders::surface_preamble),
        sphere(gl, shaders::sphere_vertex, shaders::sphere_fragment, shaders::surface_preamble),
        ground(gl, shaders::ground_vertex, shaders::ground_fragment, shaders::surface_preamble),
        mesh_shadow(gl, shaders::mesh_shadow_vertex, shaders::mesh_shadow_fragment),
        sphere_shadow(gl, shaders::sphere_shadow_vertex, shaders::sphere_shadow_fragment),
        light(make_light("")),
        sky(gl, shaders::picture_vertex, shaders::light_fragment,
            "#define SKY\n#define SOFTNESS 1\n"),
        fxaa(gl, shaders::picture_vertex, shaders::fxaa_fragment),
        average(gl, shaders::picture_vertex, shaders::average_fragment) {}

  GlProgram make_light(const std::string& definitions) const {
    return {gl, shaders::picture_vertex, shaders::light_fragment,
            definitions + define("SOFTNESS", effort.softness) + define("SAMPLES", effort.samples) +
                spiral_points(effort.overhead_taps)};
  }
  const GlProgram& light_for(double grain) {
    if (grain == 0) return light;
    if (!light_with_grain) light_with_grain = make_light("#define GRAIN\n");
    return *light_with_grain;
  }
  const GlProgram& for_textures() {
    if (textured) return *textured;
    std::string preamble = "#define TEXTURED\n";
    preamble += shaders::surface_preamble;
    textured = GlProgram(gl, shaders::mesh_vertex, shaders::mesh_fragment, preamble);
    return *textured;
  }
};

Renderer::Effort Renderer::effort_of(Quality quality) {
  switch (quality) {
    case Quality::draft: return {1024, 1, 16, 0, 1, false, false};
    case Quality::normal: break;
    case Quality::best: return {4096, 5, 2048, 6, 2, false, true};
  }
  return {2048, 3, 1024, 8, 1, true, true};
}

Renderer::Renderer(const RenderSettings& settings, const DrawScene& scene)
    : settings_((check_size(settings.size, settings.quality), settings)),
      effort_(effort_of(settings.quality)),
      scene_(scene),
      context_(gl_library().open_context()),
      gl_(&context_->gl()),
      programs_(std::make_unique<Programs>(*gl_, effort_)),
      bodies_(*gl_),
      sun_map_(*gl_, effort_.shadow_side, ShadowMap::LookUp::comparison),
      overhead_map_(*gl_, effort_.overhead_side, ShadowMap::LookUp::depth) {
  check_scene(scene);
  make_targets();
  scene_.bodies.clear();
  for (const DrawBody& body : scene.bodies) register_body(body);
  first_bounds_ = scene_bounds(scene_.bodies, poses_);
  body_size_ = median_radius(scene_.bodies);
  gl_->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

Renderer::~Renderer() = default;

void Renderer::make_targets() {
  surface_width_ = effort_.samples * settings_.size.width;
  surface_height_ = effort_.samples * settings_.size.height;
  const auto make = [&](GLint format) {
    return make_texture(*gl_, format, surface_width_, surface_height_);
  };
  color_ = make(GL_SRGB8_ALPHA8);
  normal_ = make(GL_RG16);
  depth_ = make(GL_DEPTH_COMPONENT32F);
  surface_buffer_ = make_framebuffer(*gl_, color_, normal_, depth_);
  lit_ = make(GL_SRGB8_ALPHA8);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // FXAA works on the bytes as they are; the mean of samples is one of light
  if (effort_.fxaa) gl_->TexParameteri(GL_TEXTURE_2D, texture_srgb_decode, skip_decode);
  lit_buffer_ = make_framebuffer(*gl_, lit_, 0, depth_);
  final_buffer_ = lit_buffer_;
  if (effort_.fxaa || effort_.samples > 1) {
    final_ = make_texture(*gl_, GL_SRGB8_ALPHA8, settings_.size.width, settings_.size.height);
    final_buffer_ = make_framebuffer(*gl_, final_, 0, 0);
  }
  if (effort_.grain) grain_ = make_grain_texture(*gl_);
  gl_->GenSamplers(1, &unfiltered_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl_->SamplerParameteri(unfiltered_, filter, GL_NEAREST);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl_->SamplerParameteri(unfiltered_, axis, GL_CLAMP_TO_EDGE);
  if (effort_.fxaa) gl_->SamplerParameteri(unfiltered_, texture_srgb_decode, skip_decode);
  gl_->GenVertexArrays(1, &empty_array_);
  gl_->GenVertexArrays(1, &ground_array_);
  gl_->BindVertexArray(ground_array_);
  gl_->GenBuffers(1, &ground_buffer_);
  gl_->BindBuffer(GL_ARRAY_BUFFER, ground_buffer_);
  gl_->EnableVertexAttribArray(0);
  gl_->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void Renderer::register_body(const DrawBody& body) {
  if (body.color) check_color(*body.color, "color");
  bodies_.add_body(body, scene_.bodies.size());
  scene_.bodies.push_back(body);
  poses_.push_back(body.pose);
}

void Renderer::set_poses(const DrawFrame& frame) {
  for (const DrawBody& body : frame.added) register_body(body);
  TW_ASSERT(frame.poses.size() <= scene_.bodies.size(), "more poses than bodies");
  std::copy(frame.poses.begin(), frame.poses.end(), poses_.begin());
  if (frame.removed) removed_.clear();
  removed_.resize(poses_.size(), false);
  if (frame.removed)
    for (const std::size_t body : *frame.removed) removed_[body] = true;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    Pose& pose = poses_[i];
    if (!removed_[i]) {
      if (drawable(pose)) continue;
      ++skipped_poses_;
    }
    pose.p.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

void Renderer::set_view(double time) {
  Vec3 displacement = Vec3::Zero();
  if (scene_.camera.follow) {
    const std::size_t body = *scene_.camera.follow;
    displacement = poses_[body].p - scene_.camera.follow_from.value_or(scene_.bodies[body].pose.p);
    // a lost body is not followed
    if (!is_finite(displacement)) displacement.setZero();
  }
  view_ = make_view(scene_.camera, scene_.camera.in_view.value_or(first_bounds_), settings_.size,
                    displacement, time);
  projection_ = projection_of(view_);
  cell_size_ = round_size(view_.focus_distance / 8);
}

void Renderer::fit_shadows() {
  std::vector<Ball> casters;
  for (std::size_t i = 0; i < poses_.size(); ++i)
    if (has_bounds(scene_.bodies[i]) && is_finite(poses_[i].p))
      casters.push_back(ball_around(scene_.bodies[i], poses_[i]));
  const Vec3 target = view_.eye + view_.focus_distance * view_.forward;
  const double reach = 5 * view_.focus_distance;
  sun_map_.fit(scene_.light.direction, casters, target, reach);
  overhead_map_.fit(-Vec3::UnitZ(), casters, target, reach);
}

void Renderer::draw_surfaces() {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, surface_buffer_);
  gl_->Viewport(0, 0, surface_width_, surface_height_);
  gl_->Enable(GL_FRAMEBUFFER_SRGB);
  gl_->Enable(GL_DEPTH_TEST);
  gl_->DepthFunc(GL_GREATER);
  gl_->ClearDepth(0);
  gl_->ClearColor(0, 0, 0, 0);
  gl_->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_bodies();
  draw_grounds();
}

void Renderer::draw_bodies() {
  programs_->mesh.use();
  programs_->mesh.set("projection", projection_);
  bodies_.draw_meshes(BodyDrawer::Which::plain);
  if (bodies_.has_textures()) {
    const GlProgram& textured = programs_->for_textures();
    textured.use();
    textured.set("projection", projection_);
    textured.set("surface_map", 0);
    bodies_.draw_meshes(BodyDrawer::Which::textured);
  }
  programs_->sphere.use();
  programs_->sphere.set("projection", projection_);
  programs_->sphere.set("forward", view_.forward);
  programs_->sphere.set("near_distance", view_.near_distance);
  bodies_.draw_spheres();
}

void Renderer::set_rays(const GlProgram& program) const {
  program.set("ray_middle", view_.forward);
  program.set("ray_right", Vec3(view_.tan_half_fov * view_.aspect * view_.right));
  program.set("ray_up", Vec3(view_.tan_half_fov * view_.up));
}

void Renderer::draw_grounds() {
  const Vec3 target = view_.eye + view_.focus_distance * view_.forward;
  const auto polygons =
      half_space_polygons(scene_.bodies, poses_, target, ground_reach * view_.focus_distance);
  if (polygons.empty()) return;
  programs_->ground.use();
  programs_->ground.set("projection", projection_);
  programs_->ground.set("pixel_share", 1.0 / surface_width_, 1.0 / surface_height_);
  set_rays(programs_->ground);
  for (const HalfSpacePolygon& polygon : polygons) draw_ground(polygon);
}

void Renderer::draw_ground(const HalfSpacePolygon& polygon) {
  const double height = polygon.normal.dot(polygon.origin - view_.eye);
  // seen from inside the solid
  if (height >= 0) return;
  std::vector<Eigen::Vector3f> corners;
  for (const Vec3& corner : polygon.corners) corners.push_back((corner - view_.eye).cast<float>());

  const GlProgram& program = programs_->ground;
  const DrawBody& body = scene_.bodies[polygon.body];
  program.set("normal", polygon.normal);
  program.set("height", height);
  program.set("color", linear_color(body.color.value_or(default_color(polygon.body, true))));
  program.set("cell_u", Vec3(polygon.u / cell_size_));
  program.set("cell_v", Vec3(polygon.v / cell_size_));
  // checks repeat after two cells: single precision needs no more of the eye's place
  const Vec3 place = (view_.eye - polygon.origin) / cell_size_;
  program.set("cell_origin", std::fmod(place.dot(polygon.u), 2.0),
              std::fmod(place.dot(polygon.v), 2.0));
  gl_->BindVertexArray(ground_array_);
  gl_->BindBuffer(GL_ARRAY_BUFFER, ground_buffer_);
  gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof corners[0]),
                  corners.data(), GL_STREAM_DRAW);
  gl_->DrawArrays(GL_TRIANGLE_FAN, 0, static_cast<GLsizei>(corners.size()));
}

void Renderer::light_picture() {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, lit_buffer_);
  gl_->BindVertexArray(empty_array_);
  // By depth alone llvmpipe skips blocks of pixels that are sky or are not, before it computes
  // anything; branches and `discard` don't save it that.  Depth is read in the same pass, but
  // nobody writes it.
  gl_->DepthMask(GL_FALSE);
  const GlProgram &light = programs_->light_for(grain()), &sky = programs_->sky;
  for (const GlProgram* program : {&light, &sky}) {
    gl_->DepthFunc(program == &light ? GL_LESS : GL_EQUAL);
    set_light(*program);
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl_->DepthMask(GL_TRUE);
  gl_->Disable(GL_DEPTH_TEST);
}

double Renderer::grain() const {
  if (!effort_.grain) return 0;
  return scene_.sky.grain.value_or(bodies_.grainy_parts() >= landscape_parts ? 1 : 0);
}

void Renderer::set_light(const GlProgram& program) const {
  program.use();
  set_rays(program);
  const GLuint textures[] = {color_, normal_, depth_, sun_map_.texture(), overhead_map_.texture(),
                             grain_};
  const char* const names[] = {"color_map", "normal_map",   "depth_map",
                               "sun_map",   "overhead_map", "grain_map"};
  for (int i = 0; i < 6; ++i) {
    gl_->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    gl_->BindTexture(GL_TEXTURE_2D, textures[i]);
    program.set(names[i], i);
  }
  gl_->ActiveTexture(GL_TEXTURE0);
  program.set("to_sun_map", sun_map_.to_texture(view_.eye));
  program.set("to_overhead_map", overhead_map_.to_texture(view_.eye));
  program.set("sun_texel", sun_map_.texel());
  program.set("sun_map_share", sun_map_.texel_share());
  program.set("overhead_texel", overhead_map_.texel());
  const double occlusion_radius = std::max(1.6 * body_size_, 3 * overhead_map_.texel());
  program.set("occlusion_radius", occlusion_radius);
  program.set("overhead_depth", overhead_map_.depth() / occlusion_radius);
  // the grain repeats after four tiles: single precision needs no more of the eye's place
  const double tile = 4 * cell_size_;
  program.set("grain_origin", Vec3((view_.eye / tile).unaryExpr(&within_four)));
  program.set("grain_scale", 1 / tile);
  program.set("grain_strength", grain());
  program.set("grain_level",
              std::log2(2 * view_.tan_half_fov / surface_height_ * grain_side / tile));
  program.set("near_distance", view_.near_distance);
  program.set("to_sun", Vec3(-scene_.light.direction.normalized()));
  program.set("sun_color", linear_color(scene_.light.color));
  program.set("zenith", linear_color(scene_.sky.zenith));
  program.set("horizon", linear_color(scene_.sky.horizon));
  program.set("ground", linear_color(scene_.sky.ground));
  program.set("fog", scene_.sky.fog.value_or(0.04 / view_.focus_distance));
}

void Renderer::smooth_edges() {
  if (final_buffer_ == lit_buffer_) return;
  gl_->BindFramebuffer(GL_FRAMEBUFFER, final_buffer_);
  gl_->Viewport(0, 0, settings_.size.width, settings_.size.height);
  if (effort_.fxaa) gl_->Disable(GL_FRAMEBUFFER_SRGB);
  const GlProgram& program = effort_.fxaa ? programs_->fxaa : programs_->average;
  program.use();
  for (const GLenum unit : {0u, 1u}) {
    gl_->ActiveTexture(GL_TEXTURE0 + unit);
    gl_->BindTexture(GL_TEXTURE_2D, lit_);
  }
  gl_->BindSampler(1, unfiltered_);
  program.set("picture", 0);
  program.set("pixels", 1);
  program.set("pixel_share", 1.0 / settings_.size.width, 1.0 / settings_.size.height);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->BindSampler(1, 0);
}

Image Renderer::read_picture() const {
  Image image{settings_.size.width, settings_.size.height, {}};
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  image.rgb.resize(row * static_cast<std::size_t>(image.height));
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_->ReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  // GL's rows run from the bottom
  for (int y = 0; y < image.height / 2; ++y)
    std::swap_ranges(image.pixel(0, y), image.pixel(0, y) + row,
                     image.pixel(0, image.height - 1 - y));
  return image;
}

DepthPicture Renderer::read_depth() const {
  DepthPicture picture{surface_width_, surface_height_, {}};
  picture.depth.resize(static_cast<std::size_t>(surface_width_) *
                       static_cast<std::size_t>(surface_height_));
  gl_->BindFramebuffer(GL_FRAMEBUFFER, surface_buffer_);
  gl_->ReadPixels(0, 0, surface_width_, surface_height_, GL_DEPTH_COMPONENT, GL_FLOAT,
                  picture.depth.data());
  return picture;
}

void Renderer::finish_hud(Image& image, const DrawFrame& frame) const {
  if (!settings_.hud) return;
  draw_hud(image, {frame.time, frame.hud, settings_.footer, view_.pixels_per_metre()});
}

void Renderer::set_looks(const DrawFrame& frame) {
  if (frame.camera) {
    check_camera(*frame.camera, scene_.bodies.size() + frame.added.size());
    scene_.camera = *frame.camera;
  }
  if (frame.light) {
    check_light(*frame.light);
    scene_.light = *frame.light;
  }
  if (frame.sky) {
    check_sky(*frame.sky);
    scene_.sky = *frame.sky;
  }
}

Image Renderer::draw(const DrawFrame& frame) {
  set_looks(frame);
  set_poses(frame);
  set_view(frame.time);
  bodies_.place(poses_, view_.eye, 2 * view_.tan_half_fov / surface_height_);
  fit_shadows();
  sun_map_.draw(bodies_, programs_->mesh_shadow, programs_->sphere_shadow, view_.eye);
  if (effort_.overhead_taps > 0)
    overhead_map_.draw(bodies_, programs_->mesh_shadow, programs_->sphere_shadow, view_.eye);
  draw_surfaces();
  light_picture();
  smooth_edges();
  Image image = read_picture();
  if (!frame.contacts.empty())
    draw_contacts(image, frame.contacts, view_, read_depth(), 2 * body_size_);
  TW_REQUIRE(gl_->GetError() == GL_NO_ERROR, "drawing failed: OpenGL ran out of memory");
  finish_hud(image, frame);
  return image;
}

}  // namespace tw
