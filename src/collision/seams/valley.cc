// Valleys; see the header.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/seams/valley.h"

#include <algorithm>
#include <cmath>
#include <iterator>

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
                const Vec3& middle, const Frame& world,
                const std::vector<SeamNeighbour>& neighbours, double farthest, double size) {
  const double height = face.normal.dot(point) - face.offset, slack = seam::same_point * size;
  const double over = face.normal.dot(middle) - face.offset;
  const Vec3 foot = point - height * face.normal;
  if (over <= 0 || over_face(part, face, foot, 0)) return false;
  const Vec3 border = nearest_on_face(part, face, foot);
  if ((border - foot).norm() > farthest) return false;

  // Whether beyond each side, as seen from that place on the border, a neighbour is above the face:
  // to the left and to the right of straight beyond, at two places each, for one may be on a wall
  // between two neighbours; over a slit up to where the body is seen, but not straight up, as the
  // walls of what stands on the face may be.
  const double probe = seam::probe * size;
  const auto is_beneath = [&](const Vec3& from, const Polyhedron::Side& side, double aside,
                              double most) {
    const Vec3 beyond = aside * face.normal.cross(side.inward) - side.inward;
    for (const double rise : seam::rises) {
      if (rise > most) break;
      const Vec3 there = from + probe * (std::cos(rise) * beyond + std::sin(rise) * face.normal);
      if (held(neighbours, world * there, seam::buried_margin * size)) return true;
    }
    return false;
  };
  const auto ends_beneath = [&](const Vec3& from, bool is_slit) {
    for (int i = 0; i < face.count; ++i) {
      const Polyhedron::Side& side = part.side(face.first + i);
      if (side.inward.dot(foot) >= side.offset) continue;
      const double most = is_slit ? std::atan2(over, side.offset - side.inward.dot(middle)) : 0;
      for (const double sign : {-1.0, 1.0})
        if (!is_beneath(from, side, 0.3 * sign, most) && !is_beneath(from, side, 0.2 * sign, most))
          return false;
    }
    return true;
  };
  if (held(neighbours, world * foot, -slack) &&
      (height >= -slack || held(neighbours, world * point, -slack)) && ends_beneath(border, false))
    return true;

  // a slit: nothing is between its border and the point, nor where the body goes through the plane
  const auto is_open = [&](const Vec3& from, const Vec3& to) {
    return std::none_of(std::begin(seam::between), std::end(seam::between), [&](double share) {
      return held(neighbours, world * Vec3(from + share * (to - from)), seam::flush * size);
    });
  };
  if (!is_open(border, point)) return false;
  const Vec3 through =
      height < 0 ? Vec3(point + height / (height - over) * (middle - point)) : foot;
  if (over_face(part, face, through, 0)) return ends_beneath(border, true);
  const Vec3 near = nearest_on_face(part, face, through);
  return (near - through).norm() <= farthest && is_open(near, through) && ends_beneath(near, true);
}

}  // namespace tw
