// Cavities, and what is told of a decomposition.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/solid-pieces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "import/convex-pieces.h"
#include "math/aabb.h"

namespace tw {
namespace {

Aabb bounds_of(const MeshObject& object, const std::vector<Vec3>& points) {
  Aabb bounds;
  for (const auto& triangle : object.triangles)
    for (const std::size_t corner : triangle) bounds.add(points[corner]);
  return bounds;
}

// How often a closed surface goes round a point: the solid angles of its triangles.
// Source: A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed.
// Eng. 30 (1983), eq. 8.
double winding_number(const MeshObject& object, const std::vector<Vec3>& points, const Vec3& at) {
  double angle = 0;
  for (const auto& triangle : object.triangles) {
    const Vec3 a = points[triangle[0]] - at, b = points[triangle[1]] - at,
               c = points[triangle[2]] - at;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * pi);
}

// "3.2 % larger"
std::string change_of(double volume, double from) {
  const double percent = 100 * (volume / from - 1);
  if (!(std::abs(percent) >= 0.01)) return "of the same volume";
  const double tenths = std::round(10 * std::abs(percent));
  const std::string amount = tenths < 1
                                 ? "less than 0.1"
                                 : std::to_string(static_cast<long>(tenths / 10)) + "." +
                                       std::to_string(static_cast<long>(std::fmod(tenths, 10)));
  return "with a volume " + amount + " % " + (percent > 0 ? "larger" : "smaller");
}

}  // namespace

bool is_closed(const std::vector<std::array<std::size_t, 3>>& triangles) {
  std::vector<std::pair<std::size_t, std::size_t>> sides, reversed;
  for (const auto& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = triangle[k], b = triangle[(k + 1) % 3];
      if (a == b) continue;
      sides.emplace_back(a, b);
      reversed.emplace_back(b, a);
    }
  std::sort(sides.begin(), sides.end());
  std::sort(reversed.begin(), reversed.end());
  return sides == reversed;
}

double volume_within(const MeshObject& object, const std::vector<Vec3>& points) {
  const Vec3& middle = points[object.triangles.front()[0]];
  double volume = 0;
  for (const auto& [a, b, c] : object.triangles)
    volume += (points[a] - middle).dot((points[b] - middle).cross(points[c] - middle)) / 6;
  return volume;
}

std::vector<std::optional<std::size_t>> hosts_of_cavities(const std::vector<MeshObject>& parts,
                                                          const std::vector<Vec3>& points) {
  std::vector<std::optional<std::size_t>> hosts(parts.size());
  if (parts.size() == 1) return hosts;
  std::vector<Aabb> bounds;
  std::vector<double> volume;
  std::vector<std::size_t> order;  // of what is closed, the largest first
  for (std::size_t i = 0; i < parts.size(); ++i) {
    bounds.push_back(bounds_of(parts[i], points));
    volume.push_back(volume_within(parts[i], points));
    if (is_closed(parts[i].triangles)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::abs(volume[i]) > std::abs(volume[j]);
  });
  for (std::size_t n = 0; n < order.size(); ++n) {
    const std::size_t i = order[n];
    const Vec3& corner = points[parts[i].triangles.front()[0]];
    for (std::size_t k = n; k-- > 0;) {
      const std::size_t j = order[k];
      if (!bounds[j].contains(bounds[i].lo) || !bounds[j].contains(bounds[i].hi)) continue;
      if (std::abs(winding_number(parts[j], points, corner)) < 0.5) continue;
      if (!hosts[j] && (volume[i] < 0) != (volume[j] < 0)) hosts[i] = j;
      break;
    }
  }
  return hosts;
}

ShapePtr decomposed(const std::string& what, std::size_t part, const std::vector<MeshObject>& parts,
                    const std::vector<Vec3>& points,
                    const std::vector<std::optional<std::size_t>>& hosts, std::size_t most,
                    Mending& mending) {
  std::vector<ClosedSurface> surfaces{{parts[part].triangles, false}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (hosts[i] == part) surfaces.push_back({parts[i].triangles, true});
  const ConvexPieces result = convex_pieces(what, points, surfaces, most);
  if (result.holes > 0)
    mending.mend(what + " has ", several(result.holes, "hole"),
                 result.holes == 1 ? "it is closed" : "they are closed", "a closed surface");
  std::size_t given = 0;
  for (const ClosedSurface& surface : surfaces) given += surface.triangles.size();
  std::string told = what + " is " + several(result.pieces, "convex piece");
  if (surfaces.size() > 1)
    told += " with " +
            (surfaces.size() == 2 ? "a cavity" : std::to_string(surfaces.size() - 1) + " cavities");
  if (result.triangles < given)
    told += ", made of " + std::to_string(result.triangles) + " of " + several(given, "triangle");
  mending.tell(told + ", " + change_of(result.shape->mass_properties().volume, result.volume));
  return result.shape;
}

}  // namespace tw
