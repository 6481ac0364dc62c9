// Meshes of polyhedra and of what is round.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/mesh.h"

#include <algorithm>
#include <cmath>

#include "render/draw-list.h"

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

Mesh mesh_ground_mesh(const MeshGround& ground, bool smooth) {
  const MeshFaces& faces = ground.faces();
  std::vector<Vec3> normals;
  if (smooth) {
    normals.assign(faces.points.size(), Vec3::Zero());
    for (const MeshFace& face : faces.faces)
      for (std::size_t i = 0, n = face.corners.size(); i < n; ++i) {
        const Vec3& x = faces.points[face.corners[i]];
        const Vec3 &next = faces.points[face.corners[(i + 1) % n]],
                   &previous = faces.points[face.corners[(i + n - 1) % n]];
        normals[face.corners[i]] += angle_between(next - x, previous - x) * face.normal;
      }
  }
  Mesh mesh;
  mesh.closed = !ground.is_open();
  for (const MeshFace& face : faces.faces) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t corner : face.corners) {
      const Vec3 normal = smooth ? Vec3(normals[corner].normalized()) : face.normal;
      mesh.vertices.push_back({faces.points[corner].cast<float>(), normal.cast<float>()});
    }
    add_fan(mesh, first, static_cast<int>(face.corners.size()));
  }
  return mesh;
}

Mesh surface_mesh(const SurfaceMesh& surface, bool tinted) {
  Mesh mesh;
  for (const SurfaceMesh::Vertex& v : surface.vertices) {
    mesh.vertices.push_back({v.position, v.normal});
    mesh.vertices.back().place = v.place;
    if (tinted) mesh.vertices.back().tint = linear_color(v.color.cast<double>()).cast<float>();
  }
  mesh.indices = surface.indices;
  mesh.closed = surface.closed;
  return mesh;
}

namespace {

// The mesh of a height field, side by side.
class HeightFieldMesh {
 public:
  explicit HeightFieldMesh(const HeightField& field)
      : field_(field), rows_(field.rows()), columns_(field.columns()) {}

  void add_smooth_top() {
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t column = 0; column < columns_; ++column)
        add(row * columns_ + column, field_.corner(row, column), slope_normal(row, column));
    each_cell([&](std::size_t a, std::size_t d) {
      for (const std::size_t i : {a, a + 1, d + 1, a, d + 1, d}) add_index(i);
    });
  }
  // Cell by cell: parts of many cells would leave cracks beside small ones, and one colour.
  void add_facets() {
    each_cell([&](std::size_t a, std::size_t d) {
      add_facet(a, a + 1, d + 1);
      add_facet(a, d + 1, d);
    });
  }
  // As deep below the top everywhere as the ground reaches below its lowest corners.
  void add_underside() {
    const std::size_t first = mesh_.vertices.size();
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t column = 0; column < columns_; ++column)
        add(row * columns_ + column, field_.corner(row, column) + down_,
            -slope_normal(row, column));
    each_cell([&](std::size_t a, std::size_t d) {
      for (const std::size_t i : {a, d + 1, a + 1, a, d, d + 1}) add_index(first + i);
    });
  }
  // From one corner of the grid to the next.
  void add_rim() {
    const std::size_t last_row = (rows_ - 1) * columns_;
    for (std::size_t i = 0; i + 1 < columns_; ++i) {
      add_wall(i, i + 1);
      add_wall(last_row + i + 1, last_row + i);
    }
    for (std::size_t i = 0; i < last_row; i += columns_) {
      add_wall(i + columns_, i);
      add_wall(i + columns_ - 1, i + 2 * columns_ - 1);
    }
  }
  Mesh take() { return std::move(mesh_); }

 private:
  // Calls visit(a, d) for two corners of each cell, of which d is a row after a.
  template <class Visit>
  void each_cell(Visit&& visit) const {
    for (std::size_t row = 0; row + 1 < rows_; ++row)
      for (std::size_t column = 0; column + 1 < columns_; ++column)
        visit(row * columns_ + column, (row + 1) * columns_ + column);
  }
  // By differences over the neighbours, one-sided at the rim.
  Vec3 slope_normal(std::size_t row, std::size_t column) const {
    const auto before = [](std::size_t i) { return i == 0 ? i : i - 1; };
    const Vec3 along_x =
        field_.corner(row, std::min(column + 1, columns_ - 1)) - field_.corner(row, before(column));
    const Vec3 along_y =
        field_.corner(std::min(row + 1, rows_ - 1), column) - field_.corner(before(row), column);
    return along_x.cross(along_y).normalized();
  }
  // At a point of the grid, or below it.
  void add(std::size_t point, const Vec3& place, const Vec3& normal) {
    mesh_.vertices.push_back({place.cast<float>(), normal.cast<float>()});
    if (field_.has_colors())
      mesh_.vertices.back().tint = linear_color(field_.color(point)).cast<float>();
  }
  void add_index(std::size_t i) { mesh_.indices.push_back(static_cast<std::uint32_t>(i)); }
  void add_facet(std::size_t a, std::size_t b, std::size_t c) {
    const Vec3 p = field_.corner(a), q = field_.corner(b), r = field_.corner(c);
    const Vec3 normal = (q - p).cross(r - p).normalized();
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    add(a, p, normal);
    add(b, q, normal);
    add(c, r, normal);
    add_fan(mesh_, first, 3);
  }
  void add_wall(std::size_t from, std::size_t to) {
    const Vec3 p = field_.corner(from), q = field_.corner(to);
    const Vec3 outward = (q - p).cross(Vec3::UnitZ()).normalized();
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    add(from, p, outward);
    add(from, p + down_, outward);
    add(to, q + down_, outward);
    add(to, q, outward);
    add_fan(mesh_, first, 4);
  }

  const HeightField& field_;
  const std::size_t rows_, columns_;
  const Vec3 down_ = -field_.depth() * Vec3::UnitZ();
  Mesh mesh_;
};

}  // namespace

Mesh height_field_mesh(const HeightField& field, bool smooth) {
  HeightFieldMesh mesh(field);
  if (smooth)
    mesh.add_smooth_top();
  else
    mesh.add_facets();
  mesh.add_underside();
  mesh.add_rim();
  return mesh.take();
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

namespace {

// A line from (radius, height) to another with the normals at its ends, to be turned about z.
struct Band {
  double radius[2], height[2];
  double out[2], up[2];
};

// A band whose normal is the same all along: that of the line, on its right.
Band straight(double radius, double height, double next_radius, double next_height) {
  const double along = next_radius - radius, rise = next_height - height;
  const double length = std::hypot(along, rise), out = rise / length, up = -along / length;
  return {{radius, next_radius}, {height, next_height}, {out, out}, {up, up}};
}

// A quarter of a circle about (0, middle), as bands: from the pole to the equator, or back.
void add_quarter(std::vector<Band>& profile, double radius, double middle, bool lower) {
  constexpr int steps = 12;
  const auto at = [&](int k) { return 0.5 * pi * (k / double(steps) - (lower ? 1 : 0)); };
  for (int k = 0; k < steps; ++k) {
    const double a = at(k), b = at(k + 1);
    const double ra = lower && k == 0 ? 0 : std::cos(a),
                 rb = !lower && k + 1 == steps ? 0 : std::cos(b);
    profile.push_back({{radius * ra, radius * rb},
                       {middle + radius * std::sin(a), middle + radius * std::sin(b)},
                       {ra, rb},
                       {std::sin(a), std::sin(b)}});
  }
}

// From the lower end of the axis to the upper one.  Facets have the normal of their middle.
Mesh turned_mesh(const std::vector<Band>& profile, bool smooth) {
  constexpr int facets = 48;
  Mesh mesh;
  for (int k = 0; k < facets; ++k)
    for (const Band& band : profile) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto add = [&](int column, std::size_t end) {
        const double angle = 2 * pi * column / facets;
        const double facing = smooth ? angle : 2 * pi * (k + 0.5) / facets;
        const double out = smooth ? band.out[end] : 0.5 * (band.out[0] + band.out[1]);
        const double up = smooth ? band.up[end] : 0.5 * (band.up[0] + band.up[1]);
        const Vec3 position(band.radius[end] * std::cos(angle), band.radius[end] * std::sin(angle),
                            band.height[end]);
        const Vec3 normal(out * std::cos(facing), out * std::sin(facing), up);
        mesh.vertices.push_back({position.cast<float>(), normal.normalized().cast<float>()});
      };
      // counter-clockwise from outside; a triangle at the axis
      add(k, 0);
      if (band.radius[0] > 0) add(k + 1, 0);
      if (band.radius[1] > 0) add(k + 1, 1);
      add(k, 1);
      add_fan(mesh, first, static_cast<int>(mesh.vertices.size() - first));
    }
  return mesh;
}

}  // namespace

Mesh ball_mesh() {
  std::vector<Band> profile;
  add_quarter(profile, 1, 0, true);
  add_quarter(profile, 1, 0, false);
  return turned_mesh(profile, true);
}

Mesh frustum_mesh(double top_radius, bool smooth) {
  std::vector<Band> profile{straight(0, -1, 1, -1), straight(1, -1, top_radius, 1)};
  if (top_radius > 0) profile.push_back(straight(top_radius, 1, 0, 1));
  return turned_mesh(profile, smooth);
}

Mesh capsule_mesh(double radius, double half_length, bool smooth) {
  std::vector<Band> profile;
  add_quarter(profile, radius, -half_length, true);
  profile.push_back(straight(radius, -half_length, radius, half_length));
  add_quarter(profile, radius, half_length, false);
  return turned_mesh(profile, smooth);
}

}  // namespace tw
