// Triangles to convex polygons.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/mesh-faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/interruption.h"
#include "base/limits.h"
#include "math/aabb.h"

namespace tw {
namespace {

constexpr double same = 1e-7;  // relative to the size

// ---- points ----

// For each point of triangles the first one as near as that.
std::vector<std::uint32_t> first_at_place(const std::vector<Vec3>& points,
                                          const std::vector<MeshTriangle>& triangles,
                                          double tolerance) {
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t h = 0;
      for (const std::int64_t k : cell)
        h = (h ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u + (h >> 29);
      return h;
    }
  };
  const double size = 2 * tolerance;
  std::unordered_multimap<Cell, std::uint32_t, Hash> cells;
  cells.reserve(points.size());
  std::vector<bool> used(points.size(), false);
  for (const MeshTriangle& t : triangles)
    for (const std::uint32_t corner : t) used[corner] = true;
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!used[i]) continue;
    Cell at;
    for (int k = 0; k < 3; ++k)
      at[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(points[i][k] / size));
    first[i] = i;
    for (int n = 0; n < 27; ++n) {
      const Cell near{at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
      const auto [begin, end] = cells.equal_range(near);
      for (auto other = begin; other != end; ++other)
        if ((points[other->second] - points[i]).norm() <= tolerance)
          first[i] = std::min(first[i], other->second);
    }
    if (first[i] == i) cells.emplace(at, i);
  }
  return first;
}

// ---- triangles ----

class Triangles {
 public:
  Triangles(const std::vector<Vec3>& points, double tolerance, MeshFaults& faults)
      : points_(points), tolerance_(tolerance), faults_(faults) {}

  void add(const MeshTriangle& t) {
    const Vec3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const Vec3 square = (b - a).cross(c - a);
    if (!(square.norm() > tolerance_ * longest)) return static_cast<void>(++faults_.thin);
    MeshTriangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    const auto [found, fresh] = seen_.emplace(sorted, all_.size());
    if (fresh) return all_.push_back(t);
    ++faults_.doubled;
    const MeshTriangle& first = all_[found->second];
    const auto at = std::find(first.begin(), first.end(), t[0]) - first.begin();
    if (first[static_cast<std::size_t>(at + 1) % 3] != t[1]) ++faults_.back_to_back;
  }

  // Where neighbours face different ways, the fewer of what hangs together are turned.
  void face_one_way() {
    find_neighbours();
    std::vector<int> way(all_.size(), 0);
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (way[i] == 0) face_one_way_from(i, way);
    find_neighbours();
  }

  const std::vector<MeshTriangle>& all() const { return all_; }
  std::int32_t neighbour(std::size_t triangle, std::size_t side) const {
    return neighbours_[triangle][side];
  }
  void count_sides() {
    for (const auto& [ends, owners] : sides_) {
      if (owners.size() == 1) ++faults_.open_sides;
      if (owners.size() > 2) ++faults_.crowded_sides;
    }
  }

 private:
  struct Owner {
    std::uint32_t triangle;
    std::uint8_t side;
  };

  void find_neighbours() {
    sides_.clear();
    neighbours_.assign(all_.size(), {MeshFace::none, MeshFace::none, MeshFace::none});
    for (std::uint32_t i = 0; i < all_.size(); ++i)
      for (std::uint8_t k = 0; k < 3; ++k) {
        const std::uint32_t a = all_[i][k], b = all_[i][(k + 1u) % 3u];
        sides_[std::minmax(a, b)].push_back({i, k});
      }
    for (const auto& [ends, owners] : sides_) {
      if (owners.size() != 2) continue;
      neighbours_[owners[0].triangle][owners[0].side] =
          static_cast<std::int32_t>(owners[1].triangle);
      neighbours_[owners[1].triangle][owners[1].side] =
          static_cast<std::int32_t>(owners[0].triangle);
    }
  }

  // Whether the neighbour beyond a side runs along it in the other direction.
  bool agrees(std::size_t triangle, std::size_t side) const {
    const std::uint32_t a = all_[triangle][side], b = all_[triangle][(side + 1) % 3];
    const MeshTriangle& other = all_[static_cast<std::size_t>(neighbour(triangle, side))];
    for (std::size_t k = 0; k < 3; ++k)
      if (other[k] == a && other[(k + 1) % 3] == b) return false;
    return true;
  }

  void face_one_way_from(std::size_t start, std::vector<int>& way) {
    std::vector<std::size_t> piece{start};
    way[start] = 1;
    std::size_t backward = 0;
    for (std::size_t n = 0; n < piece.size(); ++n) {
      const std::size_t i = piece[n];
      for (std::size_t k = 0; k < 3; ++k) {
        if (neighbour(i, k) == MeshFace::none) continue;
        const auto other = static_cast<std::size_t>(neighbour(i, k));
        if (way[other] != 0) continue;
        way[other] = agrees(i, k) ? way[i] : -way[i];
        if (way[other] < 0) ++backward;
        piece.push_back(other);
      }
    }
    const int wrong = 2 * backward > piece.size() ? 1 : -1;
    for (const std::size_t i : piece)
      if (way[i] == wrong) {
        std::swap(all_[i][1], all_[i][2]);
        ++faults_.turned;
      }
  }

  const std::vector<Vec3>& points_;
  const double tolerance_;
  MeshFaults& faults_;
  std::vector<MeshTriangle> all_;
  std::map<MeshTriangle, std::size_t> seen_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Owner>> sides_;
  std::vector<std::array<std::int32_t, 3>> neighbours_;
};

// ---- faces ----

// Joins faces side by side, pair after pair, where what becomes of them is flat and convex.
class Joining {
 public:
  explicit Joining(MeshFaces& mesh) : mesh_(mesh), into_(mesh.faces.size()) {
    std::iota(into_.begin(), into_.end(), std::int32_t{0});
  }

  void join_all() {
    for (bool again = true; again;) {
      again = false;
      for (std::int32_t i = 0; i < static_cast<std::int32_t>(into_.size()); ++i) {
        raise_if_interrupted();
        while (into_[static_cast<std::size_t>(i)] == i && join_with_one(i)) again = true;
      }
    }
    compress();
  }

 private:
  MeshFace& face(std::int32_t i) { return mesh_.faces[static_cast<std::size_t>(i)]; }
  std::int32_t find(std::int32_t i) {
    if (i == MeshFace::none) return i;
    while (into_[static_cast<std::size_t>(i)] != i) {
      std::int32_t& next = into_[static_cast<std::size_t>(i)];
      i = next = into_[static_cast<std::size_t>(next)];
    }
    return i;
  }
  const Vec3& point(std::uint32_t i) const { return mesh_.points[i]; }

  // The one beyond the longest side where that can be.
  bool join_with_one(std::int32_t i) {
    MeshFace best;
    std::int32_t with = MeshFace::none;
    double longest = 0;
    const std::size_t count = face(i).corners.size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::int32_t j = find(face(i).neighbours[k]);
      if (j == MeshFace::none || j == i) continue;
      const double length =
          (point(face(i).corners[(k + 1) % count]) - point(face(i).corners[k])).norm();
      if (length <= longest || !flat_together(face(i), face(j))) continue;
      MeshFace both = united(face(i), k, face(j));
      if (!is_convex(both)) continue;
      best = std::move(both);
      with = j;
      longest = length;
    }
    if (with == MeshFace::none) return false;
    face(i) = std::move(best);
    into_[static_cast<std::size_t>(with)] = i;
    face(with) = {};
    return true;
  }

  bool flat_together(const MeshFace& a, const MeshFace& b) const {
    if (a.normal.dot(b.normal) <= 0) return false;
    const auto lies_in = [&](const MeshFace& plane, const MeshFace& other) {
      return std::all_of(other.corners.begin(), other.corners.end(), [&](std::uint32_t corner) {
        return std::abs(plane.normal.dot(point(corner)) - plane.offset) <= mesh_.tolerance;
      });
    };
    return lies_in(a, b) && lies_in(b, a);
  }

  // Side k of a is one of b's; a's plane.
  MeshFace united(const MeshFace& a, std::size_t k, const MeshFace& b) const {
    const std::size_t na = a.corners.size(), nb = b.corners.size();
    const std::uint32_t from = a.corners[k];
    const auto found = std::find(b.corners.begin(), b.corners.end(), from);
    MeshFace both;
    both.normal = a.normal;
    both.offset = a.offset;
    if (found == b.corners.end()) return both;
    const auto start = static_cast<std::size_t>(found - b.corners.begin());
    if (b.corners[(start + nb - 1) % nb] != a.corners[(k + 1) % na]) return both;
    const auto add = [&both](const MeshFace& of, std::size_t corner) {
      both.corners.push_back(of.corners[corner]);
      both.neighbours.push_back(of.neighbours[corner]);
    };
    // b's sides from the corner on, all but the last, which is the common one; then a's
    for (std::size_t i = 0; i + 1 < nb; ++i) add(b, (start + i) % nb);
    for (std::size_t i = 1; i < na; ++i) add(a, (k + i) % na);
    remove_spikes(both);
    return both;
  }

  // There and back along what was a common side, too.
  static void remove_spikes(MeshFace& face) {
    for (bool again = true; again && face.corners.size() > 2;) {
      again = false;
      const std::size_t n = face.corners.size();
      for (std::size_t i = 0; i < n; ++i)
        if (face.corners[i] == face.corners[(i + 2) % n]) {
          // corner i, its tip i + 1 and i again: the sides of both go
          std::size_t one = (i + 1) % n, two = i;
          if (one < two) std::swap(one, two);
          for (const std::size_t gone : {one, two}) {
            face.corners.erase(face.corners.begin() + static_cast<std::ptrdiff_t>(gone));
            face.neighbours.erase(face.neighbours.begin() + static_cast<std::ptrdiff_t>(gone));
          }
          again = true;
          break;
        }
    }
  }

  // No corner lies farther inside the hull of all than points that are one.
  bool is_convex(const MeshFace& face) const {
    return face.corners.size() >= 3 && turns_one_way(face) && is_near_its_hull(face);
  }

  bool is_near_its_hull(const MeshFace& face) const {
    const std::size_t n = face.corners.size();
    const auto at = [&](std::size_t i) -> const Vec3& { return point(face.corners[i % n]); };
    // how far b is on the right of the line from a to c
    const auto outside = [&](std::size_t a, std::size_t b, std::size_t c) {
      const Vec3 way = at(c) - at(a);
      return face.normal.dot((at(b) - at(a)).cross(way)) / way.norm();
    };
    std::size_t first = 0;  // the corner farthest from the first one is one of the hull
    for (std::size_t i = 1; i < n; ++i)
      if ((at(i) - at(0)).squaredNorm() > (at(first) - at(0)).squaredNorm()) first = i;
    std::vector<std::size_t> hull{first};
    for (std::size_t i = first + 1; i <= first + n; ++i) {
      while (hull.size() > 1 && !(outside(hull[hull.size() - 2], hull.back(), i) > 0))
        hull.pop_back();
      hull.push_back(i);
    }
    for (std::size_t k = 0; k + 1 < hull.size(); ++k)
      for (std::size_t i = hull[k] + 1; i < hull[k + 1]; ++i)
        if (!(outside(hull[k], i, hull[k + 1]) >= -mesh_.tolerance)) return false;
    return true;
  }

  bool turns_one_way(const MeshFace& face) const {
    const std::size_t n = face.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3& a = point(face.corners[i]);
      const Vec3& b = point(face.corners[(i + 1) % n]);
      const Vec3& c = point(face.corners[(i + 2) % n]);
      const Vec3 ab = b - a, bc = c - b;
      // how far b stands out over the line from a to c
      const double out = face.normal.dot(ab.cross(bc)) / (ab + bc).norm();
      if (!(out >= -mesh_.tolerance) || !(ab.dot(bc) > 0 || out > mesh_.tolerance)) return false;
    }
    return true;
  }

  void compress() {
    std::vector<std::int32_t> number(into_.size(), MeshFace::none);
    std::int32_t count = 0;
    for (std::size_t i = 0; i < into_.size(); ++i)
      if (into_[i] == static_cast<std::int32_t>(i)) number[i] = count++;
    std::vector<MeshFace> kept;
    for (std::size_t i = 0; i < into_.size(); ++i) {
      if (number[i] == MeshFace::none) continue;
      kept.push_back(std::move(mesh_.faces[i]));
      for (std::int32_t& neighbour : kept.back().neighbours)
        if (neighbour != MeshFace::none)
          neighbour = number[static_cast<std::size_t>(find(neighbour))];
    }
    mesh_.faces = std::move(kept);
  }

  MeshFaces& mesh_;
  std::vector<std::int32_t> into_;  // the face that has taken this one up; itself: none has
};

}  // namespace

MeshFaces mesh_faces(const std::vector<Vec3>& points, const std::vector<MeshTriangle>& triangles,
                     MeshFaults& faults) {
  faults = {};
  MeshFaces mesh;
  Aabb box;
  for (const MeshTriangle& t : triangles)
    for (const std::uint32_t corner : t) box.add(points[corner]);
  const std::string none = "a mesh has no triangle with an area among its " +
                           std::to_string(triangles.size()) + "; expected some that make a surface";
  const double size = triangles.empty() ? 0 : 0.5 * box.size().maxCoeff();
  TW_REQUIRE(size >= least_length, none);
  // what rounding makes of coordinates, too
  const double largest = std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
  mesh.tolerance = same * size + 8e-16 * largest;
  const std::vector<std::uint32_t> first = first_at_place(points, triangles, mesh.tolerance);
  Triangles cleaned(points, mesh.tolerance, faults);
  for (const MeshTriangle& t : triangles) cleaned.add({first[t[0]], first[t[1]], first[t[2]]});
  TW_REQUIRE(!cleaned.all().empty(), none);
  cleaned.face_one_way();
  cleaned.count_sides();

  mesh.points = points;
  for (std::size_t i = 0; i < cleaned.all().size(); ++i) {
    const MeshTriangle& t = cleaned.all()[i];
    MeshFace face;
    face.corners.assign(t.begin(), t.end());
    for (std::size_t k = 0; k < 3; ++k) face.neighbours.push_back(cleaned.neighbour(i, k));
    face.normal = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).normalized();
    face.offset = face.normal.dot((points[t[0]] + points[t[1]] + points[t[2]]) / 3);
    mesh.faces.push_back(std::move(face));
  }
  Joining(mesh).join_all();
  return mesh;
}

}  // namespace tw
