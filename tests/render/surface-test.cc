// Surfaces with textures and of many triangles look as they do from near, at the cost of what is
// seen.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <memory>

#include "picture-tools.h"
#include "render/mesh-levels.h"

namespace tw::test {
namespace {

// A square of 2 m across the y axis with four colours: red and green above, blue and yellow below,
// seen from -y; yellow lets through.
std::shared_ptr<SurfaceMesh> four_colors() {
  auto surface = std::make_shared<SurfaceMesh>();
  const float corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const auto& [x, z] : corners) {
    SurfaceMesh::Vertex v;
    v.position = {x, 0, z};
    v.normal = {0, -1, 0};
    v.place = {0.5f * (1 + x), 0.5f * (1 - z)};
    surface->vertices.push_back(v);
  }
  surface->indices = {0, 1, 2, 0, 2, 3};
  surface->patches = {{0, 6, 0}};
  Texture texture{64, 64, {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool left = x < 32, above = y < 32;
      for (const int byte : {left && above ? 255 : 0, !left && above ? 255 : 0,
                             left && !above ? 255 : 0, left || above ? 255 : 0})
        texture.rgba.push_back(static_cast<std::uint8_t>(byte));
    }
  surface->textures.push_back(texture);
  surface->colored = true;
  surface->radius = std::sqrt(2.0);
  return surface;
}

DrawScene scene_of(std::shared_ptr<const SurfaceMesh> mesh, std::optional<Vec3> color = {}) {
  DrawScene scene;
  DrawBody body;
  body.shape = make_sphere(0.1);
  body.visual = std::make_shared<const Visual>(Visual{{nullptr, std::move(mesh), Pose{}, color}});
  scene.bodies.push_back(body);
  scene.camera.eye = Vec3(0, -6, 0);
  scene.camera.target = Vec3(0, 0, 0);
  scene.light.direction = {0, 1, -1};
  scene.sky.fog = 0;
  return scene;
}

struct Seen {
  int red, green, blue;
};

Seen at(Renderer& renderer, const Image& image, const Vec3& point) {
  const auto place = renderer.view().project(point);
  EXPECT_TRUE(place);
  const int x = static_cast<int>(place->x()), y = static_cast<int>(place->y());
  return {red(image, x, y), green(image, x, y), blue(image, x, y)};
}

TEST(Surface, a_texture_lies_the_right_way_up_from_both_sides) {
  TW_SKIP_WITHOUT_OPENGL();
  for (const double side : {-1.0, 1.0}) {
    DrawScene scene = scene_of(four_colors());
    scene.camera.eye->y() = 6 * side;
    scene.light.direction.y() = -side;
    Renderer renderer(small_settings(), scene);
    const Image image = renderer.draw(frame_at(0));
    const Seen upper_left = at(renderer, image, {-0.5, 0, 0.5}),
               upper_right = at(renderer, image, {0.5, 0, 0.5}),
               lower_left = at(renderer, image, {-0.5, 0, -0.5});
    EXPECT_GT(upper_left.red, 60 + std::max(upper_left.green, upper_left.blue));
    EXPECT_GT(upper_right.green, 60 + std::max(upper_right.red, upper_right.blue));
    EXPECT_GT(lower_left.blue, 60 + std::max(lower_left.red, lower_left.green));
  }
}

TEST(Surface, what_is_transparent_in_a_texture_is_a_hole) {
  TW_SKIP_WITHOUT_OPENGL();
  const DrawScene scene = scene_of(four_colors());
  DrawScene nothing = scene;
  nothing.bodies.clear();
  const Image sky = Renderer(small_settings(), nothing).draw(frame_at(0));
  Renderer renderer(small_settings(), scene);
  const Image image = renderer.draw(frame_at(0));
  const Vec3 place(0.5, 0, -0.5);
  const Seen hole = at(renderer, image, place), behind = at(renderer, sky, place);
  EXPECT_EQ(hole.red, behind.red);
  EXPECT_EQ(hole.blue, behind.blue);
}

TEST(Surface, a_color_tints_a_texture) {
  TW_SKIP_WITHOUT_OPENGL();
  Renderer renderer(small_settings(), scene_of(four_colors(), Vec3(0, 1, 1)));
  const Image image = renderer.draw(frame_at(0));
  EXPECT_LT(at(renderer, image, {-0.5, 0, 0.5}).red, 60);
  EXPECT_GT(at(renderer, image, {0.5, 0, 0.5}).green, 100);
}

// A ball of radius 1: a cube of 12 rows^2 triangles, blown up; each has vertices of its own, as
// files often have.
Mesh fine_ball(int rows) {
  Mesh mesh;
  const auto add = [&](int axis, int side, int i, int j) {
    Eigen::Vector3d p;
    p[axis] = side;
    p[(axis + 1) % 3] = std::tan(pi / 4 * (2.0 * i / rows - 1)) * side;
    p[(axis + 2) % 3] = std::tan(pi / 4 * (2.0 * j / rows - 1));
    // what is the same point of two faces is so to the bit
    const Eigen::Vector3f place =
        (1e6 * p.normalized()).array().round().matrix().cast<float>() / 1e6f;
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back({place, place});
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1})
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < rows; ++j)
          for (const auto& [di, dj] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
            add(axis, side, i + di, j + dj);
  return mesh;
}

TEST(MeshLevels, coarser_ones_are_within_their_errors) {
  Mesh mesh = fine_ball(60);
  const auto count = static_cast<std::uint32_t>(mesh.indices.size());
  const std::vector<MeshLevel> levels = add_levels(mesh, {0, count, -1});
  ASSERT_GE(levels.size(), 4u);
  for (std::size_t l = 1; l < levels.size(); ++l) {
    const MeshLevel& level = levels[l];
    EXPECT_LE(level.count, 0.75 * levels[l - 1].count);
    EXPECT_GT(level.error, levels[l - 1].error);
    EXPECT_LT(level.error, 0.02);
    for (std::uint32_t i = level.first; i < level.first + level.count; i += 3) {
      Eigen::Vector3f middle = Eigen::Vector3f::Zero();
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Mesh::Vertex& v = mesh.vertices.at(mesh.indices.at(i + k));
        EXPECT_NEAR(v.position.norm(), 1, 1e-5);
        EXPECT_GT(v.normal.dot(v.position), 0.76);
        middle += v.position / 3;
      }
      // what is measured is how far corners are from planes, and small to begin with
      EXPECT_GT(middle.norm(), 1 - 2 * level.error - 1e-3);
    }
  }
}

TEST(MeshLevels, few_triangles_have_none) {
  Mesh mesh = fine_ball(15);
  const std::size_t vertices = mesh.vertices.size();
  const auto count = static_cast<std::uint32_t>(mesh.indices.size());
  EXPECT_EQ(add_levels(mesh, {0, count, -1}).size(), 1u);
  EXPECT_EQ(mesh.vertices.size(), vertices);
}

TEST(MeshLevels, what_is_painted_has_none) {
  Mesh mesh = fine_ball(60);
  const auto count = static_cast<std::uint32_t>(mesh.indices.size());
  EXPECT_EQ(add_levels(mesh, {0, count, 0}).size(), 1u);
  mesh.vertices[mesh.indices[7]].tint = {1, 0, 0};
  EXPECT_EQ(add_levels(mesh, {0, count, -1}).size(), 1u);
}

TEST(MeshLevels, a_distant_surface_looks_as_all_of_its_triangles_do) {
  TW_SKIP_WITHOUT_OPENGL();
  const Mesh ball = fine_ball(60);
  const auto surface_of = [&](std::uint32_t pieces) {
    auto surface = std::make_shared<SurfaceMesh>();
    for (const Mesh::Vertex& v : ball.vertices) surface->vertices.push_back({v.position, v.normal});
    surface->indices = ball.indices;
    // small patches have no levels
    const auto all = static_cast<std::uint32_t>(ball.indices.size());
    for (std::uint32_t i = 0; i < all; i += all / pieces)
      surface->patches.push_back({i, std::min(all / pieces, all - i), -1});
    surface->closed = true;
    for (const Mesh::Vertex& v : ball.vertices) surface->bounds.add(v.position.cast<double>());
    surface->radius = 1;
    return surface;
  };
  const Image coarse = Renderer(small_settings(), scene_of(surface_of(1))).draw(frame_at(0));
  const Image fine = Renderer(small_settings(), scene_of(surface_of(60))).draw(frame_at(0));
  int different = 0;
  for (std::size_t i = 0; i < fine.rgb.size(); ++i)
    different += std::abs(int(fine.rgb[i]) - int(coarse.rgb[i])) > 8;
  EXPECT_NE(coarse.rgb, fine.rgb);
  EXPECT_LT(different, 0.002 * static_cast<double>(fine.rgb.size()));
}

}  // namespace
}  // namespace tw::test
