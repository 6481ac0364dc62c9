// Levels by meshoptimizer.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/mesh-levels.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>

namespace tw {

namespace {

constexpr std::size_t few = 3 * 4000;  // indices
constexpr double worthwhile = 0.75;    // of the indices of the level before
constexpr float smooth = 0.766f;       // cosine of 40 degrees: between normals

using Indices = std::vector<std::uint32_t>;

// Rows of numbers by what they belong to, as `of_each` says of each number.
struct Rows {
  Indices first, members;

  Rows(const Indices& of_each, std::size_t count) : first(count + 1, 0), members(of_each.size()) {
    for (const std::uint32_t row : of_each) ++first[row + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    Indices next(first.begin(), first.end() - 1);
    for (std::uint32_t i = 0; i < of_each.size(); ++i) members[next[of_each[i]]++] = i;
  }
  std::span<const std::uint32_t> operator[](std::uint32_t row) const {
    return std::span(members).subspan(first[row], first[row + 1] - first[row]);
  }
};

// Vertices at one place as one, so that edges may collapse where normals differ.
class Places {
 public:
  explicit Places(std::span<const Mesh::Vertex> vertices)
      : vertices_(vertices), place_of_(places_of(vertices)) {
    positions_.resize(1 + *std::max_element(place_of_.begin(), place_of_.end()));
    for (std::size_t v = 0; v < vertices.size(); ++v)
      positions_[place_of_[v]] = vertices[v].position;
    at_place_.emplace(place_of_, positions_.size());
  }

  std::uint32_t of_vertex(std::uint32_t vertex) const { return place_of_[vertex]; }
  // What errors are shares of, m.
  double size() const {
    return meshopt_simplifyScale(positions_[0].data(), positions_.size(), sizeof positions_[0]);
  }
  // Fewer of these triangles of places, `wanted` indices where that can be, and how far they are.
  Indices simplified(const Indices& triangles, std::size_t wanted, float& error) const {
    Indices fewer(triangles.size());
    fewer.resize(meshopt_simplify(fewer.data(), triangles.data(), triangles.size(),
                                  positions_[0].data(), positions_.size(), sizeof positions_[0],
                                  wanted, 1.f, 0, &error));
    return fewer;
  }
  // Of each corner of triangles of places a vertex.  Its normal is the mean of those of the
  // triangles there that go on smoothly, by their areas: that of the mesh may be of a rounded edge
  // that is not there any more.  But of a triangle that turns away from the mesh, as collapsing
  // leaves some, thin ones, it is the mesh's.
  std::vector<Mesh::Vertex> corners(const Indices& triangles) const {
    std::vector<Eigen::Vector3f> area, unit;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
      const Eigen::Vector3f& a = positions_[triangles[i]];
      area.push_back((positions_[triangles[i + 1]] - a).cross(positions_[triangles[i + 2]] - a));
      unit.push_back(area.back().normalized());
    }
    const Rows around(triangles, positions_.size());
    std::vector<Mesh::Vertex> corners;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Eigen::Vector3f& facing = unit[i / 3];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const std::uint32_t corner : around[triangles[i]])
        if (unit[corner / 3].dot(facing) >= smooth) sum += area[corner / 3];
      const auto there = (*at_place_)[triangles[i]];
      const auto nearest =
          std::max_element(there.begin(), there.end(), [&](std::uint32_t u, std::uint32_t v) {
            return vertices_[u].normal.dot(facing) < vertices_[v].normal.dot(facing);
          });
      corners.push_back(vertices_[*nearest]);
      const Eigen::Vector3f normal = sum.normalized();
      if (normal.dot(corners.back().normal) >= smooth) corners.back().normal = normal;
    }
    return corners;
  }

 private:
  static Indices places_of(std::span<const Mesh::Vertex> vertices) {
    Indices places(vertices.size());
    // compared as bytes: there is to be one 0 only
    std::vector<Eigen::Vector3f> positions;
    for (const Mesh::Vertex& v : vertices) positions.push_back(v.position.array() + 0.f);
    meshopt_generateVertexRemap(places.data(), nullptr, positions.size(), positions.data(),
                                positions.size(), sizeof positions[0]);
    return places;
  }

  std::span<const Mesh::Vertex> vertices_;
  Indices place_of_;  // of each vertex
  std::vector<Eigen::Vector3f> positions_;
  std::optional<Rows> at_place_;  // the vertices
};

// Adds triangles with these corners.
void append(const std::vector<Mesh::Vertex>& corners, Mesh& mesh) {
  Indices number(corners.size());
  const std::size_t different = meshopt_generateVertexRemap(
      number.data(), nullptr, corners.size(), corners.data(), corners.size(), sizeof corners[0]);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.resize(first + different);
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.vertices[first + number[i]] = corners[i];
  meshopt_optimizeVertexCache(number.data(), number.data(), number.size(), different);
  for (const std::uint32_t corner : number) mesh.indices.push_back(first + corner);
}

bool has_one_tint(const Mesh& mesh, const SurfaceMesh::Patch& patch) {
  const auto begin = mesh.indices.begin() + patch.first;
  const Eigen::Vector3f& tint = mesh.vertices[*begin].tint;
  return std::all_of(begin, begin + patch.count,
                     [&](std::uint32_t index) { return mesh.vertices[index].tint == tint; });
}

}  // namespace

std::vector<MeshLevel> add_levels(Mesh& mesh, const SurfaceMesh::Patch& patch) {
  const auto [first, count, texture] = patch;
  std::vector<MeshLevel> levels{{first, count, 0}};
  // edges collapse by places alone: what is painted would be smeared
  if (count <= few || texture >= 0 || !has_one_tint(mesh, patch)) return levels;
  const auto begin = mesh.indices.begin() + first, end = begin + count;
  const auto [least, most] = std::minmax_element(begin, end);
  const std::uint32_t base = *least;
  // a copy: vertices are added
  const std::vector<Mesh::Vertex> own(mesh.vertices.begin() + base,
                                      mesh.vertices.begin() + *most + 1);
  const Places places(own);
  Indices all;
  for (auto index = begin; index != end; ++index) all.push_back(places.of_vertex(*index - base));
  const double size = places.size();
  for (std::size_t wanted = all.size() / 2; wanted > few / 4; wanted /= 2) {
    float error = 0;
    const Indices fewer = places.simplified(all, wanted, error);
    if (fewer.empty() || double(fewer.size()) > worthwhile * levels.back().count) break;
    levels.push_back({static_cast<std::uint32_t>(mesh.indices.size()),
                      static_cast<std::uint32_t>(fewer.size()), size * error});
    append(places.corners(fewer), mesh);
  }
  return levels;
}

}  // namespace tw
