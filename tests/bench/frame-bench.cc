// What a frame costs: 300 rocks over a mountainside of 524 pieces, and two bodies, at 1280x720:
// a table of doc/performance.md.
//
// The first row is the least that such a frame can cost: the same surfaces in one colour, nothing
// else, read back.  CPU time of all threads; frames after the first, whose shaders are compiled.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>

#ifdef TW_RENDER
#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "bench/bench-table.h"
#include "render/png.h"
#include "render/renderer.h"
#include "render/view.h"

namespace tw::bench {
namespace {

double process_cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The least cost of `frames` calls, ms each.
template <class Work>
double milliseconds(int frames, Work work) {
  double best = 1e300;
  for (int i = 0; i < frames; ++i) {
    const double start = process_cpu_seconds();
    work(i);
    best = std::min(best, process_cpu_seconds() - start);
  }
  return 1e3 * best;
}

// ---- scenes ----

using Random = std::mt19937;
double uniform(Random& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / static_cast<double>(Random::max());
}

double ground_height(double x, double y) {
  return 0.45 * y + 0.03 * x * x + 1.1 * std::sin(0.7 * x + 0.3 * y) * std::cos(0.5 * y);
}

DrawBody make_body(ShapePtr shape, const Vec3& position, const Vec3& color, bool fixed) {
  DrawBody body;
  body.shape = std::move(shape);
  body.pose.p = position;
  body.color = color;
  body.fixed = fixed;
  return body;
}

ShapePtr make_rock(Random& random, double size) {
  std::vector<Vec3> points;
  for (int i = 0; i < 18; ++i) {
    const Vec3 p(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    points.push_back(size * p.normalized());
  }
  return make_hull(points);
}

void add_slab(DrawScene& scene, const Vec3& a, const Vec3& b, const Vec3& c, double tone) {
  const Vec3 middle = (a + b + c) / 3, down(0, 0, -3);
  std::vector<Vec3> points;
  for (const Vec3& p : {a, b, c}) points.insert(points.end(), {p - middle, p - middle + down});
  scene.bodies.push_back(
      make_body(make_hull(points), middle, {tone, 0.9 * tone, 0.7 * tone}, true));
}

DrawScene mountainside() {
  DrawScene scene;
  Random random(2000);
  const auto corner = [](int i, int j) {
    const double x = 3.2 * (i - 8) + 0.6 * std::sin(3 * i + j), y = 4.2 * j - 10;
    return Vec3(x, y, ground_height(x, y));
  };
  // 16 x 16 cells of two triangles, and boulders up to 524
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) {
      add_slab(scene, corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
               uniform(random, 0.4, 0.7));
      add_slab(scene, corner(i, j), corner(i + 1, j + 1), corner(i, j + 1),
               uniform(random, 0.4, 0.7));
    }
  for (int k = 0; k < 312; ++k) {
    const bool fixed = k < 12;
    const double x = uniform(random, -6, 6), y = uniform(random, -8, 30);
    const double size = fixed ? uniform(random, 0.8, 1.6) : uniform(random, 0.25, 0.7);
    const double tone = uniform(random, 0.35, 0.75);
    scene.bodies.push_back(make_body(make_rock(random, size),
                                     {x, y, ground_height(x, y) + 0.5 * size}, {tone, tone, tone},
                                     fixed));
  }
  scene.camera.eye = Vec3(7.5, -29, 8);
  scene.camera.target = Vec3(0.3, 6, 6);
  scene.camera.fov = 0.9;
  return scene;
}

DrawScene two_bodies() {
  DrawScene scene;
  scene.bodies.push_back(make_body(make_box({4, 4, 0.2}), {0, 0, -0.1}, {0.8, 0.8, 0.8}, true));
  scene.bodies.push_back(make_body(make_sphere(0.1), {0, 0, 0.6}, {0.9, 0.3, 0.2}, false));
  return scene;
}

// ---- the least ----

const char* const flat_fragment = R"(
flat in vec4 surface_color;
layout(location = 0) out vec4 out_color;
void main() { out_color = surface_color; }
)";
const char* const flat_vertex = R"(
uniform mat4 projection;
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 row_x;
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
layout(location = 5) in vec4 color;
flat out vec4 surface_color;
void main() {
  vec4 p = vec4(position, 1);
  gl_Position = projection * vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1);
  surface_color = color;
}
)";

double least_cost(const DrawScene& scene, ImageSize size) {
  const auto context = gl_library().open_context();
  const GlApi& gl = context->gl();
  const GlProgram program(gl, flat_vertex, flat_fragment);
  const GLuint color = make_texture(gl, GL_RGBA8, size.width, size.height);
  const GLuint depth = make_texture(gl, GL_DEPTH_COMPONENT32F, size.width, size.height);
  const GLuint buffer = make_framebuffer(gl, color, 0, depth);
  BodyDrawer bodies(gl);
  std::vector<Pose> poses;
  for (const DrawBody& body : scene.bodies) {
    bodies.add_body(body, poses.size());
    poses.push_back(body.pose);
  }
  const View view =
      make_view(scene.camera, scene_bounds(scene.bodies, poses), size, Vec3::Zero(), 0);
  Image image{size.width, size.height,
              std::vector<std::uint8_t>(3 * static_cast<std::size_t>(size.width) *
                                        static_cast<std::size_t>(size.height))};
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  return milliseconds(12, [&](int) {
    bodies.place(poses, view.eye, 2 * view.tan_half_fov / size.height);
    gl.BindFramebuffer(GL_FRAMEBUFFER, buffer);
    gl.Viewport(0, 0, size.width, size.height);
    gl.Enable(GL_DEPTH_TEST);
    gl.Enable(GL_CULL_FACE);
    gl.DepthFunc(GL_GREATER);
    gl.ClearDepth(0);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    program.use();
    program.set("projection", projection_of(view));
    bodies.draw_meshes(BodyDrawer::Which::all);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  });
}

// ---- the table ----

constexpr ImageSize size{1280, 720};

double frame_cost(const DrawScene& scene, Quality quality, Image& last) {
  RenderSettings settings;
  settings.size = size;
  settings.quality = quality;
  Renderer renderer(settings, scene);
  return milliseconds(quality == Quality::best ? 5 : 12, [&](int i) {
    DrawFrame frame;
    frame.time = 0.01 * i;
    // what moves, moves
    for (const DrawBody& body : scene.bodies) {
      frame.poses.push_back(body.pose);
      if (!body.fixed) frame.poses.back().p.z() += 0.01 * i;
    }
    last = renderer.draw(frame);
  });
}

void print_table() {
  const DrawScene mountain = mountainside(), two = two_bodies();
  Table table("frames", "ms of CPU a frame, 1280x720 | 824 hulls | two bodies");
  const auto row = [&](const char* name, double large, double small) {
    table.row("%s | %.0f | %.0f", name, large, small);
  };
  row("surfaces in one colour, nothing else", least_cost(mountain, size), least_cost(two, size));
  Image large, small;
  for (const auto& [name, quality] :
       {std::pair("draft", Quality::draft), std::pair("normal", Quality::normal),
        std::pair("best", Quality::best)})
    row(name, frame_cost(mountain, quality, large), frame_cost(two, quality, small));
  row("PNG of a best one", milliseconds(12, [&](int) { encode_png(large); }),
      milliseconds(12, [&](int) { encode_png(small); }));
}

}  // namespace
}  // namespace tw::bench

int main() { tw::bench::print_table(); }

#else
int main() { std::printf("built without drawing\n"); }
#endif
