// Ghost contacts at the seams of fixed bodies and of unions.
//
// For convex Q and a point p of Q, n is a normal of Q at p exactly where p is the nearest point of
// Q to p + seam::probe n.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "collision/distance/ellipsoid-point.h"
#include "collision/distance/frustum-point.h"
#include "collision/distance/nearest-to-point.h"
#include "collision/manifold/manifold-parts.h"
#include "collision/seams/seams.h"

namespace tw {

namespace {

struct Nearest {
  Vec3 point;       // of the part; the query itself where that is inside
  double distance;  // signed
  Vec3 outward;     // unit, away from the part
};

Nearest nearest_of(const SeamNeighbour& q, const Vec3& point) {
  const ConvexPart& part = *q.part;
  if (part.kind == PartKind::half_space) {
    const Vec3 normal = q.frame.R * part.normal;
    const double height = normal.dot(point - q.frame.p) - part.offset;
    return {height > 0 ? Vec3(point - height * normal) : point, height, normal};
  }
  const Frame world = part.in(q.frame);
  if (part.kind == PartKind::sphere) {
    const Vec3 out = point - world.p;
    const double length = out.norm();
    const Vec3 outward = length > 0 ? Vec3(out / length) : Vec3(Vec3::UnitZ());
    if (length <= part.radius) return {point, length - part.radius, outward};
    return {world.p + part.radius * outward, length - part.radius, outward};
  }
  const auto nearest = [&](const auto& near) -> Nearest {
    return {near.distance > 0 ? Vec3(world * near.point) : point, near.distance,
            world.R * near.normal};
  };
  if (part.kind == PartKind::frustum)
    return nearest(nearest_on_frustum(part, world.to_local(point)));
  if (part.kind == PartKind::ellipsoid)
    return nearest(nearest_on_ellipsoid(part.semi_axes, world.to_local(point)));
  return nearest(nearest_to_point(*part.core, world.to_local(point)));
}

// How far outside a face plane of a polyhedron the point is at most, m; of others nothing.
double beyond_planes(const SeamNeighbour& q, const Vec3& point) {
  if (q.part->kind != PartKind::polyhedron) return -std::numeric_limits<double>::infinity();
  int face = 0;
  return q.part->core->face_separation(q.part->in(q.frame).to_local(point), face);
}

// Of the part's surface where it is round, m, or `most`: of an ellipsoid's ends and of what is
// about an axis.
double sharpest_radius(const ConvexPart& part, double most) {
  if (part.kind == PartKind::sphere) return std::min(most, part.radius);
  if (part.kind == PartKind::ellipsoid) {
    const double least = part.semi_axes.minCoeff();
    return std::min(most, least * least / part.semi_axes.maxCoeff());
  }
  return part.margin > 0 ? std::min(most, part.margin) : most;
}

// Whether a neighbour that holds the point has no such normal there, by more than angle() (rad;
// asked where one holds it).  Where round parts meet flush, as a cylinder and a ball of its radius,
// the one is over the other by r turn^2/2 before their normals differ by `turn`: it is its own
// surface there, however near the other is.
template <class Angle>
bool denied_beyond(const Angle& angle, const Vec3& point, const Vec3& normal,
                   const std::vector<SeamNeighbour>& neighbours, double size) {
  for (const SeamNeighbour& q : neighbours) {
    const Vec3 center = q.frame * q.part->bound_center;
    const double near = q.part->bound_radius + seam::same_point * size;
    if ((center - point).squaredNorm() > near * near) continue;
    if (beyond_planes(q, point) > seam::same_point * size) continue;
    const Nearest here = nearest_of(q, point);
    if (here.distance > seam::same_point * size) continue;
    if (here.distance < -seam::same_point * size) return true;
    const Nearest foot = nearest_of(q, point + seam::probe * size * normal);
    const double over = std::max(here.distance, 0.0);
    const double turn =
        angle() + seam::flush_turn * std::sqrt(over / sharpest_radius(*q.part, 0.5 * size));
    const double allowed = turn * seam::probe * size + std::abs(here.distance);
    if ((foot.point - here.point).norm() > allowed) return true;
  }
  return false;
}

bool denied(const Vec3& point, const Vec3& normal, const std::vector<SeamNeighbour>& neighbours,
            double size, double angle) {
  return denied_beyond([angle] { return angle; }, point, normal, neighbours, size);
}

// The number of the face with this normal (part's frame), or -1.
int face_with(const Polyhedron& core, const Vec3& normal) {
  for (std::size_t f = 0; f < core.faces().size(); ++f)
    if (core.faces()[f].normal.dot(normal) > seam::same_normal) return static_cast<int>(f);
  return -1;
}

// The middle of a face's corners.
Vec3 middle_of(const Polyhedron& core, const Polyhedron::Face& face) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < face.count; ++i) sum += core.vertex(core.corner(face.first + i));
  return sum / face.count;
}

// Points a probe's length away along the edges that hold the point and have the normal (part's
// frame).
std::vector<Vec3> along_edges(const Polyhedron& core, const Vec3& point, const Vec3& normal,
                              double size) {
  std::vector<Vec3> points;
  for (const Polyhedron::Edge& edge : core.edges()) {
    const Vec3& tail = core.vertex(edge.tail);
    const Vec3 along = core.vertex(edge.head) - tail;
    const double length = along.norm(), at = (point - tail).dot(along) / length;
    const Vec3 direction = along / length;
    const double margin = seam::buried_margin * size;
    if ((tail + at * direction - point).norm() > margin || at < -margin || at > length + margin)
      continue;
    if (std::abs(direction.dot(normal)) > seam::face_angle) continue;
    for (const double s : {at - seam::probe * size, at + seam::probe * size})
      if (s > 0 && s < length) points.push_back(tail + s * direction);
  }
  return points;
}

// Whether a round part comes out of its neighbours near a point of its surface that they
// hold, with nearly this normal: the two make a valley there, and what presses in it is a little
// way inside both.
bool comes_out_beside(const ConvexPart& part, const Frame& frame, const Vec3& point,
                      const Vec3& normal, const std::vector<SeamNeighbour>& neighbours, double size,
                      double angle) {
  const SeamNeighbour self{&part, frame};
  Vec3 at = point, outward = normal;
  for (int step = 0; step < seam::most_around; ++step) {
    const SeamNeighbour* holder = nullptr;
    Nearest held{Vec3::Zero(), seam::same_point * size, Vec3::Zero()};
    for (const SeamNeighbour& q : neighbours) {
      const Nearest here = nearest_of(q, at);
      if (!(here.distance <= held.distance)) continue;
      held = here;
      holder = &q;
    }
    if (!holder) return !denied(at, outward, neighbours, size, angle);
    const Vec3 along = held.outward - outward.dot(held.outward) * outward;
    const double sine = along.norm();
    if (!(sine > seam::valley)) return false;
    const double farther = std::max(-held.distance, 0.0) + 0.1 * seam::probe * size;
    at += farther / (sine * sine) * along;
    if ((at - point).norm() > seam::sunk * size) return false;
    const Nearest back = nearest_of(self, at);
    at -= back.distance * back.outward;
    outward = back.outward;
    if (outward.dot(normal) < seam::same_side) return false;
  }
  return false;
}

}  // namespace

double height_over(const SeamNeighbour& part, const Vec3& point) {
  return nearest_of(part, point).distance;
}

bool holds(const SeamNeighbour& part, const Vec3& point, double depth) {
  // inside a polyhedron the nearest face plane says so, and outside one that it is far beyond
  if (part.part->kind == PartKind::polyhedron) {
    const double out = beyond_planes(part, point);
    if (out > std::max(-depth, 0.0) * (1 + 1e-9)) return false;
    if (out <= std::min(-depth, 0.0)) return true;
  }
  return height_over(part, point) <= -depth;
}

bool buried_edge(const ConvexPart& part, const Frame& frame, const Vec3& point, const Vec3& normal,
                 const std::vector<SeamNeighbour>& neighbours, double size, double angle,
                 double depth) {
  if (neighbours.empty()) return false;
  if (part.kind != PartKind::polyhedron)
    return denied(point, normal, neighbours, size, angle) &&
           !comes_out_beside(part, frame, point, normal, neighbours, size, angle);
  const Frame world = part.in(frame);
  const Polyhedron& core = *part.core;
  const int number = face_with(core, world.R.transpose() * normal);
  if (number < 0) {
    // a corner that is higher than others of its part has not this normal itself: what denies it no
    // more than the part does, as one whose face lies in the same plane, does not bury it
    const SeamNeighbour self{&part, frame};
    double more = -1;  // as far as the part itself turns from it
    const auto own_angle = [&] {
      if (more < 0) {
        const Vec3 here = nearest_of(self, point).point;
        const Vec3 foot = nearest_of(self, point + seam::probe * size * normal).point;
        more = (foot - here).norm() / (seam::probe * size);
      }
      return angle + more;
    };
    if (!denied_beyond(own_angle, point, normal, neighbours, size)) return false;
    // along an edge that dives into a neighbour the two make a valley: what presses there is a
    // little way inside both
    for (const Vec3& beside :
         along_edges(core, world.to_local(point), world.R.transpose() * normal, size))
      if (!denied_beyond(own_angle, world * beside, normal, neighbours, size)) return false;
    return true;
  }
  // far inside a face: bodies don't sink so deep that it could be an inner wall
  const Polyhedron::Face& face = core.face(number);
  const Vec3 local = world.to_local(point);
  if (over_face(core, face, local, -seam::sunk * size)) return false;
  const Vec3 foot = nearest_on_face(core, face, local);
  if (!denied(world * foot, normal, neighbours, size, angle)) return false;
  // an inner wall is denied all around; the face may be pointed there
  const Vec3 middle = middle_of(core, face) - foot;
  const Vec3 inward = foot + std::min(1.0, seam::probe * size / middle.norm()) * middle;
  if (!denied(world * inward, normal, neighbours, size, angle)) return false;
  const Vec3 u = core.side(face.first).inward;
  const Vec3 v = face.normal.cross(u);
  // what is deep in one wall of a corner may be as deep in the others
  const double widest = std::clamp(seam::corner * depth, seam::probe * size, seam::sunk * size);
  constexpr int directions = 8;
  for (double around = seam::probe * size; around <= widest; around *= 2)
    for (int i = 0; i < directions; ++i) {
      const double turn = 2 * pi * i / directions;
      const Vec3 beside = foot + around * (std::cos(turn) * u + std::sin(turn) * v);
      if (!over_face(core, face, beside, 0)) continue;
      if (!denied(world * beside, normal, neighbours, size, angle)) return false;
    }
  return true;
}

}  // namespace tw
