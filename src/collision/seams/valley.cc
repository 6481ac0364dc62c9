// Valleys; see the header.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/seams/valley.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/constants.h"
#include "collision/distance/nearest-to-point.h"
#include "collision/manifold/manifold-parts.h"

namespace tw {

namespace {

// Whether a neighbour holds the place (world) and `depth` (m) around it.
bool hold(const std::vector<SeamNeighbour>& neighbours, const Vec3& place, double depth) {
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const SeamNeighbour& q) {
    const double farthest = q.part->bound_radius - depth;
    return (q.frame * q.part->bound_center - place).squaredNorm() <=
               farthest * farthest * (1 + 1e-9) &&
           holds(q, place, depth);
  });
}

// What a face goes on by beyond the sides that a point is beyond.
struct Beyond {
  const Polyhedron& part;
  const Polyhedron::Face& face;
  const Frame& world;
  const std::vector<SeamNeighbour>& neighbours;
  double size;
  Vec3 point, middle;
  double height = face.normal.dot(point) - face.offset;  // m
  Vec3 foot = point - height * face.normal;
  double over = face.normal.dot(middle) - face.offset;  // of the middle, m

  // Whether the foot is, or the point under the face is before the wall beneath that side: where
  // that leans in under the face, the foot may be on the face.
  bool is_beyond(const Polyhedron::Side& side) const {
    if (side.inward.dot(foot) < side.offset) return true;
    if (height >= 0) return false;
    const Polyhedron::Edge& edge = part.edges()[static_cast<std::size_t>(side.edge)];
    const Polyhedron::Face& left = part.face(edge.left);
    const Polyhedron::Face& wall = &left == &face ? part.face(edge.right) : left;
    return wall.normal.dot(point) > wall.offset;
  }

  // The place on the border nearest to the foot, of the sides that it is beyond; false: none.
  bool find_border(Vec3& border) const {
    if (!over_face(part, face, foot, 0)) {
      border = nearest_on_face(part, face, foot);
      return true;
    }
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < face.count; ++i) {
      const Polyhedron::Side& side = part.side(face.first + i);
      const double within = side.inward.dot(foot) - side.offset;
      if (within >= least || !is_beyond(side)) continue;
      least = within;
      border = nearest_on_face(part, face, foot - within * side.inward);
    }
    return std::isfinite(least);
  }

  // Whether a neighbour holds the place and `depth` (m) around it.
  bool is_held(const Vec3& place, double depth) const {
    return hold(neighbours, world * place, depth);
  }

  // Whether none is between the two: they are on both sides of a slit, or in it.  What the body is
  // pressed into beside the slit, as the wall where it ends, is not between.
  bool is_open(const Vec3& from, const Vec3& to) const {
    return std::none_of(std::begin(seam::between), std::end(seam::between), [&](double share) {
      return is_held(from + share * (to - from), seam::low * size);
    });
  }

  // Whether the face is open beside the border: an inner wall, whose neighbour stands against it,
  // is no slope.
  bool is_slope(const Vec3& border) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < face.count; ++i) sum += part.vertex(part.corner(face.first + i));
    const Vec3 inward = sum / face.count - border;
    const double probe = seam::probe * size;
    return !is_held(border + probe * (inward.normalized() + seam::crack * face.normal), 0);
  }

  // How far aside the border is looked at, m.
  double widest(double depth) const {
    return std::clamp(seam::corner * depth, seam::probe * size, seam::sunk * size);
  }

  // The place on the border nearest to `from` where the face is a slope: in a corner another wall
  // stands before it, no farther than what is `depth` (m) deep in this one may be in that.
  bool find_slope(const Vec3& from, double depth, Vec3& border) const {
    border = from;
    if (is_slope(border)) return true;
    for (double aside = seam::probe * size; aside <= widest(depth); aside *= 2)
      for (int i = 0; i < face.count; ++i) {
        const Polyhedron::Side& side = part.side(face.first + i);
        if (!is_beyond(side)) continue;
        for (const double sign : {-1.0, 1.0}) {
          border = from + sign * aside * face.normal.cross(side.inward);
          if (over_face(part, face, border, seam::same_point * size) && is_slope(border))
            return true;
        }
      }
    return false;
  }

  // Whether `away` (m) beyond the side, as seen from that place on the border, a neighbour is above
  // the face: straight beyond but for `aside`, and up to an angle of `most`, rad.
  bool is_beneath(const Vec3& border, const Polyhedron::Side& side, const Vec3& aside, double away,
                  double most) const {
    const Vec3 beyond = aside - away * side.inward;
    for (const double rise : seam::rises) {
      if (rise > most) break;
      const Vec3 there = border + std::cos(rise) * beyond + away * std::sin(rise) * face.normal;
      if (is_held(there, seam::buried_margin * size)) return true;
    }
    return false;
  }

  // Whether the face is open straight in from a place on the side, or towards its middle where it
  // is pointed.
  bool is_slope_at(const Polyhedron::Side& side, const Vec3& border) const {
    const Vec3 inward = border + seam::probe * size * side.inward;
    if (!over_face(part, face, inward, 0)) return is_slope(border);
    return !is_held(inward + seam::crack * seam::probe * size * face.normal, 0);
  }

  // A place on the i-th side and how far it is looked at to the left and to the right, m.
  struct OnSide {
    Vec3 place, aside;
  };

  // The one nearest to `from` that is not beyond the side's ends or behind a wall that stands
  // before the face, no farther than find_slope looks.
  bool find_on_side(int i, const Vec3& from, double depth, OnSide& found) const {
    const Polyhedron::Side& side = part.side(face.first + i);
    const Vec3& tail = part.vertex(part.corner(face.first + i));
    const Vec3& head = part.vertex(part.corner(face.first + (i + 1) % face.count));
    const double length = (head - tail).norm(), at = (head - tail).dot(from - tail) / length;
    const Vec3 along = (head - tail) / length;
    const double aside = std::min(seam::aside * seam::probe * size, 0.5 * length);
    found.aside = aside * along;
    const auto is_here = [&](double s) {
      found.place = tail + std::clamp(s, aside, length - aside) * along;
      return is_slope_at(side, found.place - found.aside) &&
             is_slope_at(side, found.place + found.aside);
    };
    if (is_here(at)) return true;
    for (double farther = seam::probe * size; farther <= widest(depth); farther *= 2)
      if (is_here(at - farther) || is_here(at + farther)) return true;
    return false;
  }

  // Whether each of the sides that it is beyond, as seen from the place on it nearest to
  // `from`, is beneath a neighbour, to the left and to the right, at two places each, for one may
  // be on a wall between two neighbours, and nearer by, for in a corner walls may end at a slant;
  // over a slit up to where the body is seen, but not straight up, as the walls of what stands on
  // the face may be.
  bool ends_beneath(const Vec3& from, double depth, bool is_slit) const {
    for (int i = 0; i < face.count; ++i) {
      const Polyhedron::Side& side = part.side(face.first + i);
      if (!is_beyond(side)) continue;
      const double most = is_slit ? std::atan2(over, side.offset - side.inward.dot(middle)) : 0;
      OnSide border;
      if (!find_on_side(i, from, depth, border)) return false;
      const double probe = seam::probe * size;
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 aside = sign * border.aside, nearer = 2.0 / 3 * aside;
        if (!is_beneath(border.place, side, aside, probe, most) &&
            !is_beneath(border.place, side, nearer, probe, most) &&
            !is_beneath(border.place, side, nearer, 0.1 * probe, most))
          return false;
      }
    }
    return true;
  }
};

}  // namespace

bool goes_on_to(const Polyhedron& part, const Polyhedron::Face& face, const Vec3& point,
                const Vec3& middle, const Frame& world,
                const std::vector<SeamNeighbour>& neighbours, double farthest, double size) {
  const Beyond beyond{part, face, world, neighbours, size, point, middle};
  const Vec3& foot = beyond.foot;
  const double height = beyond.height, slack = seam::same_point * size;
  Vec3 nearest, border;
  if (beyond.over <= 0 || !beyond.find_border(nearest)) return false;
  if ((nearest - foot).norm() > farthest) return false;
  if (!beyond.find_slope(nearest, -height, border)) return false;
  // where the foot is on the face, what a neighbour holds beneath it is looked at as under the face
  if (!over_face(part, face, foot, 0) && beyond.is_held(foot, -slack) &&
      (height >= -slack || beyond.is_held(point, -slack)) &&
      beyond.ends_beneath(nearest, -height, false))
    return true;

  // a slit: nothing is between its border and the point, nor where the body goes through the plane
  if (!beyond.is_open(border, point)) return false;
  const Vec3 through =
      height < 0 ? Vec3(point + height / (height - beyond.over) * (middle - point)) : foot;
  if (over_face(part, face, through, 0)) return beyond.ends_beneath(nearest, -height, true);
  const Vec3 near = nearest_on_face(part, face, through);
  return (near - through).norm() <= farthest && beyond.is_open(near, through) &&
         beyond.ends_beneath(near, -height, true);
}

GroundEdge::GroundEdge(const Polyhedron& part, std::size_t edge, double share, const Frame& world,
                       const std::vector<SeamNeighbour>& neighbours, double size)
    : world_(world), neighbours_(neighbours), size_(size) {
  const Polyhedron::Edge& e = part.edges()[edge];
  const Vec3 &tail = part.vertex(e.tail), &head = part.vertex(e.head);
  place_ = tail + share * (head - tail);
  along_ = (head - tail).normalized();
  normal_[0] = part.face(e.left).normal;
  normal_[1] = part.face(e.right).normal;
  const double cosine = normal_[0].dot(normal_[1]);
  for (const int i : {0, 1}) into_[i] = (cosine * normal_[i] - normal_[1 - i]).normalized();
}

bool GroundEdge::is_held(const Vec3& offset, double depth) const {
  return hold(neighbours_, world_ * (place_ + offset), depth);
}

bool GroundEdge::is_open(int towards) const {
  // from farther, over cracks, and from near by, as the ground may fall away steeply; at its end
  // the edge may be within the neighbour a little
  for (const double share : {1.0, 0.1, 0.01}) {
    if (towards != 0 && share < 0.1) break;
    for (const int i : {0, 1}) {
      const Vec3 beside = into_[i] + towards * along_ + seam::crack * normal_[i];
      if (is_held(share * seam::probe * size_ * beside, 0)) return false;
    }
  }
  return true;
}

bool GroundEdge::goes_on(int towards) const {
  for (const int i : {0, 1})
    for (const double rise : seam::rises)
      for (const double aside : {0.3, 0.2}) {
        const Vec3 beyond = std::cos(rise) * towards * along_ + std::sin(rise) * normal_[i];
        if (is_held(seam::probe * size_ * (beyond + aside * into_[i]), seam::buried_margin * size_))
          return true;
      }
  return false;
}

}  // namespace tw
