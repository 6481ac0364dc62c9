// Meshes close, face outwards and have unit normals.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/mesh.h"

#include "picture-tools.h"

namespace tw::test {
namespace {

// Six times the volume inside the triangles is the sum of a . (b x c).
double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      return Vec3(mesh.vertices[mesh.indices[i + k]].position.cast<double>());
    };
    sum += corner(0).dot(corner(1).cross(corner(2)));
  }
  return sum / 6;
}

void expect_outward_unit_normals(const Mesh& mesh) {
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.normal.norm(), 1, 1e-6);
    EXPECT_GT(vertex.normal.dot(vertex.position), 0);
  }
}

TEST(Mesh, a_box_has_its_volume_and_flat_or_rounded_normals) {
  const Polyhedron box = Polyhedron::box({1, 2, 3});
  const Mesh facets = facet_mesh(box), smooth = smooth_mesh(box);
  EXPECT_EQ(facets.indices.size(), 36u);
  EXPECT_NEAR(volume(facets), 48, 1e-5);
  EXPECT_NEAR(volume(smooth), 48, 1e-5);
  expect_outward_unit_normals(facets);
  expect_outward_unit_normals(smooth);
  EXPECT_EQ(facets.vertices[0].normal.cwiseAbs().maxCoeff(), 1);
  // three right angles meet at every corner: the mean points along the diagonal
  const Eigen::Vector3f n = smooth.vertices[0].normal.cwiseAbs();
  EXPECT_NEAR(n.minCoeff(), n.maxCoeff(), 1e-6);
}

TEST(Mesh, a_facet_sphere_is_nearly_a_ball) {
  const Mesh sphere = facet_sphere_mesh();
  EXPECT_EQ(sphere.indices.size(), 3u * 320u);
  EXPECT_NEAR(volume(sphere), 4 * pi / 3, 0.04 * 4 * pi / 3);
  expect_outward_unit_normals(sphere);
}

TEST(Mesh, a_cylinder_has_48_facets_and_its_caps_are_flat) {
  for (bool smooth : {false, true}) {
    const Mesh cylinder = frustum_mesh(1, smooth);
    // two triangles a facet, and one of either cap
    EXPECT_EQ(cylinder.indices.size(), 3u * 4 * 48);
    EXPECT_NEAR(volume(cylinder), 2 * 24 * std::sin(2 * pi / 48), 1e-5);
    expect_outward_unit_normals(cylinder);
    for (const Mesh::Vertex& vertex : cylinder.vertices)
      EXPECT_TRUE(vertex.normal.z() == 0 || std::abs(vertex.normal.z()) == 1);
  }
}

// As much less than the solid as 48 sides and 24 steps from pole to pole leave out.
TEST(Mesh, balls_cones_and_capsules_have_their_volumes) {
  const Mesh ball = ball_mesh();
  EXPECT_NEAR(volume(ball), 4 * pi / 3, 0.01 * 4 * pi / 3);
  expect_outward_unit_normals(ball);
  for (bool smooth : {false, true}) {
    const Mesh cone = frustum_mesh(0, smooth);
    EXPECT_NEAR(volume(cone), 2.0 / 3 * 24 * std::sin(2 * pi / 48), 1e-5);
    expect_outward_unit_normals(cone);
    const Mesh capsule = capsule_mesh(0.5, 1, smooth);
    const double exact = pi * (0.5 + 0.5 / 3);
    EXPECT_NEAR(volume(capsule), exact, 0.01 * exact);
    expect_outward_unit_normals(capsule);
  }
}

// Seen from below, too: a shell as thick as the ground is deep, closed, so that its volume does not
// ask for the origin.
TEST(Mesh, height_fields_are_closed_below) {
  const HeightField field({0, 1, 0, 0.5, 0, 2}, 3, 1, 1);
  for (bool smooth : {false, true}) {
    Mesh mesh = height_field_mesh(field, smooth);
    EXPECT_NEAR(volume(mesh), 2 * field.depth(), 1e-5);
    for (Mesh::Vertex& vertex : mesh.vertices) vertex.position += Eigen::Vector3f(3, -5, 7);
    EXPECT_NEAR(volume(mesh), 2 * field.depth(), 1e-4);
  }
}

// Whether smooth or not, top, underside and rim: of each vertex, the colour of the point of the
// grid that is nearest in the plane.
TEST(Mesh, height_fields_have_the_colors_of_their_points) {
  const std::vector<Vec3> colors = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 1, 0}, {1, 1, 1}};
  const HeightField field({0, 1, 0, 0.5, 0, 2}, 3, 1, 1, colors), plain({0, 1, 0, 2}, 2, 1, 1);
  for (bool smooth : {false, true}) {
    for (const Mesh::Vertex& vertex : height_field_mesh(field, smooth).vertices) {
      const auto column = static_cast<std::size_t>(std::lround(vertex.position.x() + 1));
      const auto row = static_cast<std::size_t>(std::lround(vertex.position.y() + 0.5f));
      // 0 and 1 are the same in light
      EXPECT_EQ(Vec3(vertex.tint.cast<double>()), colors[3 * row + column]);
    }
    for (const Mesh::Vertex& vertex : height_field_mesh(plain, smooth).vertices)
      EXPECT_EQ(vertex.tint, Eigen::Vector3f::Ones());
  }
}

}  // namespace
}  // namespace tw::test
