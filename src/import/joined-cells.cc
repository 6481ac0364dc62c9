// Joining cells two by two.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/joined-cells.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/interruption.h"
#include "geometry/hull.h"
#include "geometry/mass-properties.h"

namespace tw {
namespace {

bool is_inside(const Polyhedron& hull, const Vec3& point) {
  return std::all_of(hull.faces().begin(), hull.faces().end(), [&](const Polyhedron::Face& face) {
    return face.normal.dot(point) < face.offset;
  });
}

// A place on the solid's surface.
struct Sample {
  Vec3 point, normal;  // outwards, unit
};

// How far a polyhedron that holds it goes on beyond the surface there, along its normal.
double height_over(const Sample& sample, const Polyhedron& hull) {
  double height = std::numeric_limits<double>::infinity();
  for (const Polyhedron::Face& face : hull.faces()) {
    const double slope = face.normal.dot(sample.normal);
    if (slope > 1e-9)
      height = std::min(height, (face.offset - face.normal.dot(sample.point)) / slope);
  }
  return height;
}

struct Piece {
  Polyhedron hull;
  std::vector<Sample> surface;  // places of the solid's surface that are its cells'
  double volume = 0;            // of its hull
  int version = 0;
  bool gone = false;
};

class Joining {
 public:
  Joining(const std::vector<Polyhedron>& cells, double height) : height_(height) {
    Aabb bounds;
    for (const Polyhedron& cell : cells) bounds.add(cell.bounds());
    near_ = 1e-6 * bounds.size().norm();
    for (std::size_t i = 0; i < cells.size(); ++i)
      pieces_.push_back(
          {cells[i], surface_of(cells, i), polyhedron_mass(cells[i]).volume, 0, false});
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (std::size_t j = i + 1; j < pieces_.size(); ++j) look_at(i, j);
    while (!pairs_.empty()) {
      const Pair pair = pairs_.top();
      pairs_.pop();
      const Piece &a = pieces_[pair.i], &b = pieces_[pair.j];
      if (!a.gone && !b.gone && a.version == pair.version_i && b.version == pair.version_j)
        join(pair.i, pair.j);
    }
  }

  std::vector<Polyhedron> hulls() const {
    std::vector<Polyhedron> hulls;
    for (const Piece& piece : pieces_)
      if (!piece.gone) hulls.push_back(piece.hull);
    return hulls;
  }

 private:
  struct Pair {
    double more;  // volume
    std::size_t i, j;
    int version_i, version_j;
    bool operator<(const Pair& other) const {
      return std::tuple(more, i, j) > std::tuple(other.more, other.i, other.j);
    }
  };

  bool are_near(const Aabb& a, Aabb b) const {
    b.grow(near_);
    return a.overlaps(b);
  }

  // Places on a cell's faces that no other cell lies behind.
  std::vector<Sample> surface_of(const std::vector<Polyhedron>& cells, std::size_t cell) const {
    raise_if_interrupted();
    const Polyhedron& hull = cells[cell];
    std::vector<std::size_t> beside;
    for (std::size_t other = 0; other < cells.size(); ++other)
      if (other != cell && are_near(hull.bounds(), cells[other].bounds())) beside.push_back(other);
    std::vector<Sample> samples;
    const auto add = [&](const Vec3& point, const Vec3& normal) {
      const Vec3 behind = point + 2 * near_ * normal;
      for (const std::size_t other : beside)
        if (is_inside(cells[other], behind)) return;
      samples.push_back({point, normal});
    };
    for (const Polyhedron::Face& face : hull.faces())
      for (int k = 1; k + 1 < face.count; ++k) {
        const Vec3 &a = hull.vertex(hull.corner(face.first)),
                   &b = hull.vertex(hull.corner(face.first + k)),
                   &c = hull.vertex(hull.corner(face.first + k + 1));
        const Vec3 middle = (a + b + c) / 3;
        add(middle, face.normal);
        for (const Vec3* corner : {&a, &b, &c}) add(0.5 * (middle + *corner), face.normal);
      }
    return samples;
  }

  static std::optional<Polyhedron> hull_of(const Piece& a, const Piece& b) {
    std::vector<Vec3> points = a.hull.vertices();
    points.insert(points.end(), b.hull.vertices().begin(), b.hull.vertices().end());
    try {
      return convex_hull(points);
    } catch (const UserError&) {
      return std::nullopt;
    }
  }

  void look_at(std::size_t i, std::size_t j) {
    raise_if_interrupted();
    const Piece &a = pieces_[i], &b = pieces_[j];
    if (!are_near(a.hull.bounds(), b.hull.bounds())) return;
    const std::optional<Polyhedron> both = hull_of(a, b);
    if (!both) return;
    for (const Piece* piece : {&a, &b})
      for (const Sample& sample : piece->surface)
        if (height_over(sample, *both) > height_) return;
    pairs_.push({polyhedron_mass(*both).volume - a.volume - b.volume, i, j, a.version, b.version});
  }

  void join(std::size_t i, std::size_t j) {
    Piece &kept = pieces_[i], &other = pieces_[j];
    kept.hull = *hull_of(kept, other);
    kept.surface.insert(kept.surface.end(), other.surface.begin(), other.surface.end());
    kept.volume = polyhedron_mass(kept.hull).volume;
    ++kept.version;
    other.gone = true;
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (k != i && !pieces_[k].gone) look_at(std::min(i, k), std::max(i, k));
  }

  std::vector<Piece> pieces_;
  std::priority_queue<Pair> pairs_;
  double height_, near_ = 0;
};

}  // namespace

std::vector<Polyhedron> joined_cells(const std::vector<Polyhedron>& cells, double height) {
  return Joining(cells, height).hulls();
}

}  // namespace tw
