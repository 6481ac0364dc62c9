// Valleys; see the header.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/seams/valley.h"

#include <algorithm>

#include "base/constants.h"
#include "collision/manifold-parts.h"
#include "collision/nearest-to-point.h"

namespace tw {

namespace {

// Whether a neighbour holds the point (world) and `depth` (m) around it.
bool held(const std::vector<SeamNeighbour>& neighbours, const Vec3& point, double depth) {
  return std::any_of(neighbours.begin(), neighbours.end(),
                     [&](const SeamNeighbour& q) { return height_over(q, point) <= -depth; });
}

}  // namespace

bool goes_on_to(const Polyhedron& part, const Polyhedron::Face& face, const Vec3& point,
                const Frame& world, const std::vector<SeamNeighbour>& neighbours, double farthest,
                double size) {
  const double height = face.normal.dot(point) - face.offset, slack = seam::same_point * size;
  const Vec3 foot = point - height * face.normal;
  if (over_face(part, face, foot, 0)) return false;
  const Vec3 border = nearest_on_face(part, face, foot);
  if ((border - foot).norm() > farthest) return false;
  if (!held(neighbours, world * foot, -slack)) return false;
  if (height < -slack && !held(neighbours, world * point, -slack)) return false;

  // to the left and to the right of straight beyond, at two places each, for one may be on a wall
  // between two neighbours
  const double probe = seam::probe * size;
  const auto is_beneath = [&](const Polyhedron::Side& side, double aside) {
    const Vec3 beyond = aside * face.normal.cross(side.inward) - side.inward;
    return held(neighbours, world * Vec3(border + probe * beyond), seam::buried_margin * size);
  };
  for (int i = 0; i < face.count; ++i) {
    const Polyhedron::Side& side = part.side(face.first + i);
    if (side.inward.dot(foot) >= side.offset) continue;
    for (const double sign : {-1.0, 1.0})
      if (!is_beneath(side, 0.3 * sign) && !is_beneath(side, 0.2 * sign)) return false;
  }
  return true;
}

}  // namespace tw
