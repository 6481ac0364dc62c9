// What is seen of mesh files has the colours and textures of their materials.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/surface-file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "support/temporary-folder.h"

namespace tw {
namespace {

namespace fs = std::filesystem;

// A folder for a test: meshes/ in it is where meshes are.
class SurfaceFile : public ::testing::Test {
 protected:
  SurfaceFile() {
    fs::create_directories(root_ / "meshes");
    fs::create_directories(root_ / "materials/textures");
    put("meshes/a.obj", R"(mtllib a.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 2 0 0
v 3 0 0
v 2 1 0
vt 0.25 0.75
vt 1 0
vt 0 0
usemtl picture
f 1/1 2/2 3/3
usemtl plain
f 4/1 5/2 6/3
)");
  }

  void put(const std::string& name, const std::string& text) const {
    std::ofstream(root_ / name, std::ios::binary) << text;
  }
  void put_material(const std::string& texture) const {
    put("meshes/a.mtl",
        "newmtl picture\nKd 1 0.5 0\nmap_Kd " + texture + "\nnewmtl plain\nKd 0 0 1\n");
  }
  std::shared_ptr<const SurfaceMesh> read(bool strict = false) {
    Mending mending(strict);
    auto surface = read_surface(root_ / "meshes/a.obj", Vec3::Ones(), false, mending);
    notes_ = mending.take_notes();
    return surface;
  }

  const test::TemporaryFolder root_;
  std::vector<std::string> notes_;
};

// A portable pixmap of one colour.
std::string picture(int width, int height, char red) {
  std::string text = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (int i = 0; i < width * height; ++i) text += {red, 0, 0};
  return text;
}

TEST_F(SurfaceFile, a_texture_lies_where_the_mesh_says) {
  put_material("a.ppm");
  put("meshes/a.ppm", picture(3, 2, 100));
  const auto surface = read();
  EXPECT_TRUE(notes_.empty());
  ASSERT_EQ(surface->textures.size(), 1u);
  const Texture& texture = surface->textures[0];
  EXPECT_EQ(texture.width, 3);
  EXPECT_EQ(texture.height, 2);
  ASSERT_EQ(texture.rgba.size(), 24u);
  EXPECT_EQ(texture.rgba[0], 100);
  EXPECT_EQ(texture.rgba[3], 255);
  ASSERT_EQ(surface->patches.size(), 2u);
  EXPECT_EQ(surface->patches[0].texture, 0);
  EXPECT_EQ(surface->patches[1].texture, -1);
  EXPECT_EQ(surface->patches[1].first, 3u);
  EXPECT_EQ(surface->patches[1].count, 3u);
  // OBJ counts v upwards
  const SurfaceMesh::Vertex& corner = surface->vertices.at(surface->indices.at(0));
  EXPECT_EQ(corner.position, Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(corner.place, Eigen::Vector2f(0.25f, 0.25f));
  EXPECT_EQ(corner.color, Eigen::Vector3f(1, 1, 1));
  EXPECT_EQ(surface->vertices.at(surface->indices.at(3)).color, Eigen::Vector3f(0, 0, 1));
  EXPECT_FALSE(surface->closed);
}

TEST_F(SurfaceFile, textures_are_looked_for_where_robots_have_them) {
  for (const char* named : {"..\\elsewhere\\b.ppm", "/elsewhere/b.ppm", "b.ppm"}) {
    put_material(named);
    for (const char* place : {"meshes/b.ppm", "materials/textures/b.ppm"}) {
      put(place, picture(1, 1, 50));
      EXPECT_EQ(read()->textures.size(), 1u) << named << " in " << place;
      fs::remove(root_ / place);
    }
  }
}

TEST_F(SurfaceFile, a_texture_that_is_missing_or_broken_is_told_and_its_colour_is_there) {
  put_material("gone.png");
  auto surface = read();
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_NE(notes_[0].find("a.obj: the texture gone.png is missing; "), std::string::npos)
      << notes_[0];
  EXPECT_TRUE(surface->textures.empty());
  EXPECT_EQ(surface->vertices.at(surface->indices.at(0)).color, Eigen::Vector3f(1, 0.5f, 0));
  EXPECT_THROW(read(true), UserError);

  put("meshes/gone.png", "no picture");
  surface = read();
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_NE(notes_[0].find("gone.png cannot be read"), std::string::npos) << notes_[0];
}

TEST_F(SurfaceFile, a_large_texture_is_made_smaller) {
  put_material("a.ppm");
  put("meshes/a.ppm", picture(4096, 6, 80));
  const auto surface = read();
  ASSERT_EQ(surface->textures.size(), 1u);
  EXPECT_EQ(surface->textures[0].width, 2048);
  EXPECT_EQ(surface->textures[0].height, 3);
  EXPECT_EQ(surface->textures[0].rgba.at(4 * 3000), 80);
}

}  // namespace
}  // namespace tw
