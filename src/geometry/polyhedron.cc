// Convex polyhedra: construction, validation and support queries.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/polyhedron.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <utility>

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "base/error.h"

namespace tw {

namespace {

// up to this many vertices a vectorised scan beats hill climbing
constexpr std::size_t scan_limit = 32;

// faces may bend by this much of the size: what Qhull merges as coplanar
constexpr double convexity_tolerance = 1e-12;

// Newell's normal of a polygon: twice its area along its unit normal, relative to one corner so
// that a distant origin costs no digits.
Vec3 newell_normal(const std::vector<Vec3>& vertices, const std::vector<int>& polygon) {
  const Vec3& origin = vertices[static_cast<std::size_t>(polygon[0])];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (vertices[static_cast<std::size_t>(polygon[i])] - origin)
               .cross(vertices[static_cast<std::size_t>(polygon[i + 1])] - origin);
  return sum;
}

// Fills compressed rows: `row_of(k)` is the row of item k, `value_of(k)` its value.
template <class Value, class RowOf, class ValueOf>
void fill_rows(std::size_t rows, std::size_t items, RowOf row_of, ValueOf value_of,
               std::vector<int>& first, std::vector<Value>& values) {
  first.assign(rows + 1, 0);
  for (std::size_t k = 0; k < items; ++k) ++first[static_cast<std::size_t>(row_of(k)) + 1];
  for (std::size_t r = 0; r < rows; ++r) first[r + 1] += first[r];
  values.resize(items);
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < items; ++k)
    values[static_cast<std::size_t>(next[static_cast<std::size_t>(row_of(k))]++)] = value_of(k);
}

// Numbers of items in groups of four: all first numbers, all second ones and so on; padded with the
// last.
template <class NumberOf>
std::vector<double> in_lanes(std::size_t items, int numbers, NumberOf number_of) {
  std::vector<double> lanes;
  for (std::size_t first = 0; first < items; first += 4)
    for (int k = 0; k < numbers; ++k)
      for (std::size_t lane = 0; lane < 4; ++lane)
        lanes.push_back(number_of(std::min(first + lane, items - 1), k));
  return lanes;
}

using Lanes = double __attribute__((vector_size(32)));
using Numbers = long long __attribute__((vector_size(32)));

Lanes load(const double* data) {
  Lanes lanes;
  std::memcpy(&lanes, data, sizeof lanes);
  return lanes;
}

// Bit k: whether lane k of what a comparison yields is true.
unsigned bits(const Numbers& mask) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#else
  unsigned all = 0;
  for (unsigned lane = 0; lane < 4; ++lane) all |= mask[lane] != 0 ? 1u << lane : 0u;
  return all;
#endif
}

// The greatest of many numbers seen four at a time, and the least item that has it.
struct Greatest {
  Lanes best = {-1e300, -1e300, -1e300, -1e300};
  Numbers best_group = {0, 0, 0, 0};

  void see(long long group, const Lanes& values) {
    const Numbers better = values > best;
    best = better ? values : best;
    const Numbers here = {group, group, group, group};
    best_group = better ? here : best_group;
  }
  double value(std::size_t items, int& item) const {
    const double top = std::max(std::max(best[0], best[1]), std::max(best[2], best[3]));
    const Lanes tops = {top, top, top, top};
    long long groups[4], first = static_cast<long long>(items) - 1;
    std::memcpy(groups, &best_group, sizeof groups);
    for (unsigned have = bits(best == tops); have != 0; have &= have - 1) {
      const int lane = std::countr_zero(have);
      first = std::min(first, 4 * groups[lane] + lane);
    }
    item = static_cast<int>(first);
    return top;
  }
};

}  // namespace

Polyhedron::Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces)
    : vertices_(std::move(vertices)) {
  set_faces(faces);
  set_sides();
  set_edges();
  set_links();
  set_lanes();
  set_bounds();
  validate();
}

Polyhedron Polyhedron::box(const Vec3& half_edges) {
  Polyhedron box;
  const Aabb bounds{-half_edges, half_edges};
  for (int i = 0; i < 8; ++i) box.vertices_.push_back(bounds.corner(i));
  box.set_faces({{0, 4, 6, 2},
                 {1, 3, 7, 5},  // x
                 {0, 1, 5, 4},
                 {2, 6, 7, 3},  // y
                 {0, 2, 3, 1},
                 {4, 5, 7, 6}});  // z
  // the normals are the axes, without rounding
  for (int f = 0; f < 6; ++f) {
    Face& face = box.faces_[static_cast<std::size_t>(f)];
    face.normal = (f % 2 == 0 ? -1 : 1) * Vec3::Unit(f / 2);
    face.offset = half_edges[f / 2];
  }
  box.is_box_ = true;
  box.set_sides();
  box.set_edges();
  box.set_links();
  box.set_lanes();
  box.set_bounds();
  box.validate();
  return box;
}

void Polyhedron::set_faces(const std::vector<std::vector<int>>& faces) {
  for (const std::vector<int>& polygon : faces) {
    TW_REQUIRE(polygon.size() >= 3, "a face of a polyhedron has fewer than 3 corners");
    Face face;
    face.first = static_cast<int>(corners_.size());
    face.count = static_cast<int>(polygon.size());
    corners_.insert(corners_.end(), polygon.begin(), polygon.end());
    const Vec3 area = newell_normal(vertices_, polygon);
    TW_REQUIRE(area.norm() > 0, "a face of a polyhedron has no area");
    face.normal = area.normalized();
    face.area = 0.5 * area.norm();
    // the plane passes through the outermost corner: no corner is outside
    face.offset = face.normal.dot(vertex(polygon[0]));
    for (int corner_vertex : polygon)
      face.offset = std::max(face.offset, face.normal.dot(vertex(corner_vertex)));
    faces_.push_back(face);
  }
}

void Polyhedron::set_sides() {
  for (const Face& face : faces_)
    for (int i = 0; i < face.count; ++i) {
      const Vec3& tail = vertex(corner(face.first + i));
      const Vec3& head = vertex(corner(face.first + (i + 1) % face.count));
      const Vec3 inward = face.normal.cross(head - tail).normalized();
      sides_.push_back({inward, inward.dot(tail), 0});
    }
}

void Polyhedron::set_edges() {
  // a directed side tail -> head belongs to the face on its left
  std::map<std::pair<int, int>, int> face_of_side;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (int i = 0; i < faces_[f].count; ++i) {
      const int tail = corner(faces_[f].first + i);
      const int head = corner(faces_[f].first + (i + 1) % faces_[f].count);
      const bool fresh = face_of_side.emplace(std::pair(tail, head), static_cast<int>(f)).second;
      TW_REQUIRE(fresh, "the faces of a polyhedron overlap");
    }
  for (const auto& [side, face] : face_of_side) {
    const auto other = face_of_side.find({side.second, side.first});
    TW_REQUIRE(other != face_of_side.end(), "the faces of a polyhedron leave a hole");
    if (side.first < side.second) edges_.push_back({side.first, side.second, face, other->second});
  }
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for (int f : {edges_[e].left, edges_[e].right}) {
      const Face& polygon = face(f);
      const int start = f == edges_[e].left ? edges_[e].tail : edges_[e].head;
      for (int i = polygon.first; i < polygon.first + polygon.count; ++i)
        if (corner(i) == start) sides_[static_cast<std::size_t>(i)].edge = static_cast<int>(e);
    }
}

void Polyhedron::set_links() {
  // items 2e and 2e+1 are the two directions of edge e
  fill_rows(
      vertices_.size(), 2 * edges_.size(),
      [this](std::size_t k) { return k % 2 == 0 ? edges_[k / 2].tail : edges_[k / 2].head; },
      [this](std::size_t k) {
        return Link{k % 2 == 0 ? edges_[k / 2].head : edges_[k / 2].tail, static_cast<int>(k / 2)};
      },
      first_link_, links_);
  std::vector<int> face_of_corner;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    face_of_corner.insert(face_of_corner.end(), static_cast<std::size_t>(faces_[f].count),
                          static_cast<int>(f));
  fill_rows(
      vertices_.size(), corners_.size(), [this](std::size_t k) { return corners_[k]; },
      [&face_of_corner](std::size_t k) { return face_of_corner[k]; }, first_vertex_face_,
      vertex_faces_);
}

void Polyhedron::set_bounds() {
  for (const Vec3& v : vertices_) bounds_.add(v);
  // the middle of the box may lie outside (a corner cut off a cube); the mean of the corners can't
  int face = 0;
  center_ = bounds_.center();
  if (!(face_separation(center_, face) < 0)) {
    center_.setZero();
    for (const Vec3& v : vertices_) center_ += v / static_cast<double>(vertices_.size());
  }
  inner_radius_ = std::max(0.0, -face_separation(center_, face));
  for (const Vec3& v : vertices_) radius_ = std::max(radius_, (v - center_).norm());
}

void Polyhedron::set_lanes() {
  scans_ = vertices_.size() <= scan_limit;
  if (scans_)
    lanes_ =
        in_lanes(vertices_.size(), 3, [this](std::size_t i, int k) { return vertices_[i][k]; });
  plane_lanes_ = in_lanes(faces_.size(), 4, [this](std::size_t i, int k) {
    return k < 3 ? faces_[i].normal[k] : faces_[i].offset;
  });
}

void Polyhedron::validate() const {
  // Euler's formula for one closed surface without handles
  TW_REQUIRE(vertices_.size() + faces_.size() == edges_.size() + 2,
             "the faces of a polyhedron do not close to one surface");
  for (const Face& f : faces_)
    for (const Vec3& v : vertices_)
      TW_REQUIRE(f.normal.dot(v - vertex(corner(f.first))) <= convexity_tolerance * radius_,
                 "a polyhedron is not convex");
}

int Polyhedron::scan(const Vec3& direction) const {
  const double dx = direction.x();
  const double dy = direction.y();
  const double dz = direction.z();
  Greatest greatest;
  const double* data = lanes_.data();
  const long long groups = static_cast<long long>(lanes_.size() / 12);
  for (long long g = 0; g < groups; ++g, data += 12)
    greatest.see(g, dx * load(data) + dy * load(data + 4) + dz * load(data + 8));
  int item = 0;
  greatest.value(vertices_.size(), item);
  return item;
}

int Polyhedron::climb(const Vec3& direction, int start) const {
  // a linear function on a convex solid has no other local maximum than the global one
  int here = start;
  double height = direction.dot(vertex(here));
  for (bool moved = true; moved;) {
    moved = false;
    for (const Link& link : links(here)) {
      const int next = link.vertex;
      const double next_height = direction.dot(vertex(next));
      if (next_height > height) {
        height = next_height;
        here = next;
        moved = true;
      }
    }
  }
  return here;
}

double Polyhedron::face_separation(const Vec3& point, int& best_face) const {
  const double x = point.x();
  const double y = point.y();
  const double z = point.z();
  Greatest greatest;
  const double* data = plane_lanes_.data();
  const long long groups = static_cast<long long>(plane_lanes_.size() / 16);
  for (long long g = 0; g < groups; ++g, data += 16)
    greatest.see(g, load(data) * x + load(data + 4) * y + load(data + 8) * z - load(data + 12));
  return greatest.value(faces_.size(), best_face);
}

void Polyhedron::faces_under(const Vec3& point, double height, std::vector<int>& out) const {
  const double x = point.x();
  const double y = point.y();
  const double z = point.z();
  const Lanes least = {height, height, height, height};
  const int count = static_cast<int>(faces_.size());
  const double* data = plane_lanes_.data();
  for (int face = 0; face < count; face += 4, data += 16) {
    const Lanes heights =
        load(data) * x + load(data + 4) * y + load(data + 8) * z - load(data + 12);
    for (unsigned over = bits(heights >= least); over != 0; over &= over - 1)
      if (const int number = face + std::countr_zero(over); number < count) out.push_back(number);
  }
}

int Polyhedron::face_at_vertex(int vertex, const Vec3& direction) const {
  const auto v = static_cast<std::size_t>(vertex);
  int best = vertex_faces_[static_cast<std::size_t>(first_vertex_face_[v])];
  double best_value = face(best).normal.dot(direction);
  for (int k = first_vertex_face_[v] + 1; k < first_vertex_face_[v + 1]; ++k) {
    const int f = vertex_faces_[static_cast<std::size_t>(k)];
    const double value = face(f).normal.dot(direction);
    if (value > best_value) {
      best_value = value;
      best = f;
    }
  }
  return best;
}

}  // namespace tw
