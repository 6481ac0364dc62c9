// Meshes of polyhedra, spheres and cylinders.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tw {

namespace {

// the triangles of a convex polygon whose vertices are first, first + 1 ...
void add_fan(Mesh& mesh, std::uint32_t first, int count) {
  for (int i = 1; i + 1 < count; ++i) {
    const auto second = first + static_cast<std::uint32_t>(i);
    mesh.indices.insert(mesh.indices.end(), {first, second, second + 1});
  }
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

struct Triangle {
  Vec3 a, b, c;
};

std::vector<Triangle> icosahedron() {
  // corners (+-1, 0, +-phi) and their cyclic permutations, on the unit sphere
  const double phi = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vec3> v;
  for (int axis = 0; axis < 3; ++axis)
    for (int signs = 0; signs < 4; ++signs) {
      Vec3 corner = Vec3::Zero();
      corner[axis] = (signs & 1) ? 1 : -1;
      corner[(axis + 2) % 3] = (signs & 2) ? phi : -phi;
      v.push_back(corner.normalized());
    }
  // faces: all triples at the edge's distance, turned outwards
  const double edge = 2 / std::sqrt(1 + phi * phi);
  const auto adjacent = [&](const Vec3& x, const Vec3& y) {
    return std::abs((x - y).norm() - edge) < 1e-9;
  };
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = i + 1; j < v.size(); ++j)
      for (std::size_t k = j + 1; k < v.size(); ++k)
        if (adjacent(v[i], v[j]) && adjacent(v[j], v[k]) && adjacent(v[i], v[k])) {
          const bool outwards = v[i].cross(v[j]).dot(v[k]) > 0;
          triangles.push_back({v[i], outwards ? v[j] : v[k], outwards ? v[k] : v[j]});
        }
  return triangles;
}

std::vector<Triangle> split(const std::vector<Triangle>& triangles) {
  std::vector<Triangle> finer;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace

Mesh facet_mesh(const Polyhedron& polyhedron) {
  Mesh mesh;
  for (const Polyhedron::Face& face : polyhedron.faces()) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < face.count; ++i)
      mesh.vertices.push_back({polyhedron.vertex(polyhedron.corner(face.first + i)).cast<float>(),
                               face.normal.cast<float>()});
    add_fan(mesh, first, face.count);
  }
  return mesh;
}

Mesh smooth_mesh(const Polyhedron& polyhedron) {
  std::vector<Vec3> normals(polyhedron.vertices().size(), Vec3::Zero());
  for (const Polyhedron::Face& face : polyhedron.faces())
    for (int i = 0; i < face.count; ++i) {
      const int here = polyhedron.corner(face.first + i);
      const Vec3& x = polyhedron.vertex(here);
      const Vec3& next = polyhedron.vertex(polyhedron.corner(face.first + (i + 1) % face.count));
      const Vec3& previous =
          polyhedron.vertex(polyhedron.corner(face.first + (i + face.count - 1) % face.count));
      normals[static_cast<std::size_t>(here)] +=
          angle_between(next - x, previous - x) * face.normal;
    }
  Mesh mesh = facet_mesh(polyhedron);
  std::size_t at = 0;
  for (const Polyhedron::Face& face : polyhedron.faces())
    for (int i = 0; i < face.count; ++i, ++at)
      mesh.vertices[at].normal =
          normals[static_cast<std::size_t>(polyhedron.corner(face.first + i))]
              .normalized()
              .cast<float>();
  return mesh;
}

Mesh facet_sphere_mesh() {
  Mesh mesh;
  for (const auto& [a, b, c] : split(split(icosahedron()))) {
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized().cast<float>();
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& corner : {a, b, c}) mesh.vertices.push_back({corner.cast<float>(), normal});
    add_fan(mesh, first, 3);
  }
  return mesh;
}

Mesh cylinder_mesh(bool smooth) {
  constexpr int facets = 48;
  const auto rim = [](double k) {
    const double angle = 2 * pi * k / facets;
    return Vec3(std::cos(angle), std::sin(angle), 0);
  };
  Mesh mesh;
  const auto add_corner = [&mesh](const Vec3& position, const Vec3& normal) {
    mesh.vertices.push_back({position.cast<float>(), normal.cast<float>()});
  };
  for (int k = 0; k < facets; ++k) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 here = rim(k);
    const Vec3 next = rim(k + 1);
    const Vec3 middle = rim(k + 0.5);
    add_corner(here - Vec3::UnitZ(), smooth ? here : middle);
    add_corner(next - Vec3::UnitZ(), smooth ? next : middle);
    add_corner(next + Vec3::UnitZ(), smooth ? next : middle);
    add_corner(here + Vec3::UnitZ(), smooth ? here : middle);
    add_fan(mesh, first, 4);
  }
  for (double side : {-1.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    // counter-clockwise from outside
    for (int k = 0; k < facets; ++k)
      add_corner(rim(side * k) + side * Vec3::UnitZ(), side * Vec3::UnitZ());
    add_fan(mesh, first, facets);
  }
  return mesh;
}

}  // namespace tw
