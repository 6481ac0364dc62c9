// Parts beneath the polygons of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/mesh-ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "geometry/hull.h"

namespace tw {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
// of walls, tangents: in deeper crevices a wedge is left free, of sharper ridges little is left
constexpr double most_outward = 2, most_inward = 1e3;
// in widths of polygons
constexpr double widths_deep = 2;
// of its polygon's area, that a part has at its bottom
constexpr double least_bottom = 0.1;
// in widths of its polygon: thinner parts would have no sides to speak of
constexpr double least_depth = 1e-3;

// What is left of a convex polygon where normal.x >= offset.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
  std::vector<Vec3> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = normal.dot(p) - offset, b = normal.dot(q) - offset;
    if (a >= 0) left.push_back(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) left.emplace_back(p + (q - p) * (a / (a - b)));
  }
  return left;
}

double area(const std::vector<Vec3>& polygon) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return 0.5 * twice.norm();
}

Aabb bounds(const std::vector<Vec3>& points) {
  Aabb box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

}  // namespace

MeshGround::MeshGround(MeshFaces faces)
    : LazyParts(faces.faces.size()),
      faces_(std::move(faces)),
      depths_(faces_.faces.size()),
      upright_(faces_.faces.size()) {
  set_faces_at_points();
  const std::size_t count = faces_.faces.size();
  std::vector<double> areas;
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    areas.push_back(area(top(i)));
    boxes.push_back(bounds(top(i)));
  }
  const PartTree tops(boxes);
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<double> sorted = areas;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count / 2),
                   sorted.end());
  const double median_width = std::sqrt(sorted[count / 2]);
  std::vector<double> solid(count, unlimited);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<Wall> sides = walls(i);
    const double most = widths_deep * std::max(median_width, std::sqrt(areas[i]));
    const double free = depth_until_walls_meet(i, sides, most);
    const double found = depth_until_a_surface(i, sides, 2 * free, tops);
    if (found < 2 * free) solid[i] = found;
    depths_[i] = std::min(free, 0.5 * found);
    const double least =
        std::max(std::min(least_depth * std::sqrt(areas[i]), 0.5 * found), 4 * faces_.tolerance);
    upright_[i] = depths_[i] < least;
    depths_[i] = std::max(depths_[i], least);
    for (const Vec3& p : bottom(i, sides)) boxes[i].add(p);
  }
  set_boxes(boxes);

  std::vector<std::size_t> thinnest(count);
  std::iota(thinnest.begin(), thinnest.end(), std::size_t{0});
  std::sort(thinnest.begin(), thinnest.end(), [&](std::size_t i, std::size_t j) {
    return solid[i] < solid[j] || (solid[i] == solid[j] && i < j);
  });
  double thinner = 0;
  for (const std::size_t i : thinnest) {
    thickness_ = solid[i];
    thinner += areas[i];
    if (thinner >= 0.01 * all) break;
  }
}

void MeshGround::set_faces_at_points() {
  first_face_.assign(faces_.points.size() + 1, 0);
  for (const MeshFace& face : faces_.faces)
    for (const std::uint32_t corner : face.corners) ++first_face_[corner + 1];
  std::partial_sum(first_face_.begin(), first_face_.end(), first_face_.begin());
  faces_at_.resize(first_face_.back());
  std::vector<std::uint32_t> next(first_face_.begin(), first_face_.end() - 1);
  for (std::uint32_t i = 0; i < faces_.faces.size(); ++i)
    for (const std::uint32_t corner : faces_.faces[i].corners) faces_at_[next[corner]++] = i;
}

std::vector<std::uint32_t> MeshGround::around(std::size_t number) const {
  std::vector<std::uint32_t> all;
  for (const std::uint32_t corner : faces_.faces[number].corners)
    for (std::uint32_t k = first_face_[corner]; k < first_face_[corner + 1]; ++k)
      if (faces_at_[k] != number) all.push_back(faces_at_[k]);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

bool MeshGround::is_open() const {
  return std::any_of(faces_.faces.begin(), faces_.faces.end(), [](const MeshFace& face) {
    return std::find(face.neighbours.begin(), face.neighbours.end(), MeshFace::none) !=
           face.neighbours.end();
  });
}

std::vector<Vec3> MeshGround::top(std::size_t number) const {
  const MeshFace& face = faces_.faces[number];
  std::vector<Vec3> corners;
  for (const std::uint32_t i : face.corners) {
    const Vec3& p = faces_.points[i];
    corners.emplace_back(p - (face.normal.dot(p) - face.offset) * face.normal);
  }
  return corners;
}

// Beside a neighbour with the normal m the wall holds the side and n + m; into the polygon, d
// beneath it, that goes by -d (m.inward) / (1 + n.m), the tangent of half the angle.
std::vector<MeshGround::Wall> MeshGround::walls(std::size_t number) const {
  const MeshFace& face = faces_.faces[number];
  const std::vector<Vec3> corners = top(number);
  std::vector<Wall> all;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& p = corners[i];
    const Vec3 along = corners[(i + 1) % corners.size()] - p;
    if (!(along.norm() > faces_.tolerance)) continue;
    Wall wall;
    wall.inward = face.normal.cross(along).normalized();
    wall.offset = wall.inward.dot(p);
    if (face.neighbours[i] != MeshFace::none) {
      const Vec3& other = faces_.faces[static_cast<std::size_t>(face.neighbours[i])].normal;
      const double into = -other.dot(wall.inward), half = 1 + face.normal.dot(other);
      // folded back it is a sheet
      if (half > 0 && into <= most_inward * half)
        wall.slope = std::max(into / half, -most_outward);
      else
        wall.slope = most_inward;
    }
    all.push_back(wall);
  }
  add_walls_at_points(number, all);
  return all;
}

// Of a face with a corner in common that comes in between the walls, a plane through that corner
// parts what is nearer to either: depths under both planes are the same there.  At a point q of the
// polygon's plane, d beneath it, the depth under the other one is o - m.q + d (n.m); so with the
// part t of -m along the polygon's plane t.q >= (n.m) (n.q) - o + d (1 - n.m).
void MeshGround::add_walls_at_points(std::size_t number, std::vector<Wall>& walls) const {
  const MeshFace& face = faces_.faces[number];
  const std::size_t sides = walls.size();
  const auto over = [&](const Wall& wall, const Vec3& p) {
    return (wall.inward + wall.slope * face.normal).dot(p) -
           (wall.offset + wall.slope * face.offset);
  };
  for (const std::uint32_t i : around(number)) {
    const MeshFace& other = faces_.faces[i];
    if (std::find(face.neighbours.begin(), face.neighbours.end(), static_cast<std::int32_t>(i)) !=
        face.neighbours.end())
      continue;
    const auto none_over = [&](const auto& height) {
      return std::all_of(other.corners.begin(), other.corners.end(), [&](std::uint32_t corner) {
        return height(faces_.points[corner]) <= faces_.tolerance;
      });
    };
    if (none_over([&](const Vec3& p) { return face.offset - face.normal.dot(p); })) continue;
    bool apart = false;
    for (std::size_t k = 0; k < sides && !apart; ++k)
      apart = none_over([&](const Vec3& p) { return over(walls[k], p); });
    const double along = face.normal.dot(other.normal);
    const Vec3 tangent = along * face.normal - other.normal;
    const double length = tangent.norm();
    if (apart || !(length > 1e-6)) continue;
    Wall wall;
    wall.inward = tangent / length;
    wall.offset = (along * face.offset - other.offset) / length;
    wall.slope = std::min((1 - along) / length, most_inward);
    // where the polygon itself is beyond the other plane that is no ridge
    const std::vector<Vec3> corners = top(number);
    if (std::all_of(corners.begin(), corners.end(), [&](const Vec3& p) {
          return wall.inward.dot(p) >= wall.offset - faces_.tolerance;
        }))
      walls.push_back(wall);
  }
}

std::vector<Vec3> MeshGround::section(std::size_t number, const std::vector<Wall>& walls,
                                      double depth) const {
  const Vec3& n = normal(number);
  std::vector<Vec3> polygon = top(number);
  // a square that holds what the walls may leave
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : polygon) middle += p / static_cast<double>(polygon.size());
  double reach = 0;
  for (const Vec3& p : polygon) reach = std::max(reach, (p - middle).norm());
  reach = 2 * reach + 4 * most_outward * depth;
  const Vec3 x = walls.front().inward, y = n.cross(x);
  polygon = {middle - reach * (x + y), middle + reach * (x - y), middle + reach * (x + y),
             middle - reach * (x - y)};
  for (const Wall& wall : walls)
    polygon = cut(polygon, wall.inward, wall.offset + depth * wall.slope);
  for (Vec3& p : polygon) p -= depth * n;
  return polygon;
}

double MeshGround::depth_until_walls_meet(std::size_t number, const std::vector<Wall>& walls,
                                          double most) const {
  const double enough = least_bottom * area(top(number));
  for (int halved = 0; halved < 40; ++halved, most *= 0.5)
    if (area(section(number, walls, most)) >= enough) return most;
  return most;
}

// Of what comes between the walls of the part, the highest point beneath the polygon.
double MeshGround::depth_until_a_surface(std::size_t number, const std::vector<Wall>& walls,
                                         double most, const PartTree& tops) const {
  const MeshFace& face = faces_.faces[number];
  Aabb place = bounds(top(number));
  for (const Vec3& p : section(number, walls, most)) place.add(p);
  for (const Vec3& p : top(number)) place.add(p - most * face.normal);
  double least = most;
  const std::vector<std::uint32_t> near = around(number);
  tops.overlapping(place, [&](std::uint32_t i) {
    if (i == number || std::binary_search(near.begin(), near.end(), i)) return;
    std::vector<Vec3> within = cut(top(i), -face.normal, faces_.tolerance - face.offset);
    for (const Wall& wall : walls) {
      // inward.x >= offset + depth slope, where depth = face.offset - n.x
      if (within.empty()) return;
      within = cut(within, wall.inward + wall.slope * face.normal,
                   wall.offset + wall.slope * face.offset + faces_.tolerance);
    }
    for (const Vec3& p : within) least = std::min(least, face.offset - face.normal.dot(p));
  });
  return least;
}

std::vector<Vec3> MeshGround::bottom(std::size_t number, std::vector<Wall> walls) const {
  if (upright_[number]) {
    // those of the polygon's own sides come first
    walls.resize(std::min(walls.size(), faces_.faces[number].corners.size()));
    for (Wall& wall : walls) wall.slope = 0;
  }
  std::vector<Vec3> corners = section(number, walls, depths_[number]);
  if (corners.size() >= 3) return corners;
  corners = top(number);
  for (Vec3& p : corners) p -= depths_[number] * normal(number);
  return corners;
}

ConvexPart MeshGround::make_part(std::size_t number) const {
  std::vector<Vec3> points = top(number);
  for (const Vec3& p : bottom(number, walls(number))) points.push_back(p);
  // short coordinates
  const Vec3 middle = bounds(points).center();
  for (Vec3& p : points) p -= middle;
  try {
    return part_about(middle, std::make_shared<const Polyhedron>(convex_hull(points)));
  } catch (const UserError&) {
    // a few points that are one, to all purposes: a grain beneath them
    const Vec3 beneath = top(number).front() - 2 * faces_.tolerance * normal(number);
    return part_about(beneath, std::make_shared<const Polyhedron>(
                                   Polyhedron::box(Vec3::Constant(faces_.tolerance))));
  }
}

}  // namespace tw
