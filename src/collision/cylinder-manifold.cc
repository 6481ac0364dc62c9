// Contact manifolds of cylinders.
//
// Which features meet is read off the axis of least distance: along a cap's normal the cap does,
// square to the axis the side does, else the rim.  What crosses runs along both (group-arc.h): a
// side or an edge and another side are two lines, with a rim they are a line and a circle.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "base/constants.h"
#include "collision/cylinder-plane.h"
#include "collision/cylinder-point.h"
#include "collision/face-contact.h"
#include "collision/separation.h"

namespace tw {

namespace {

// The pair as one sees it who stands on `reference`; the normal is from there to the other.
struct View {
  const ConvexPart& reference;
  const Frame& reference_frame;
  const ConvexPart& other;
  const Frame& other_frame;
  bool reference_is_a;
  Vec3 normal, on_reference, on_other;
  double distance, reach;
  int pair;

  ManifoldPoint point() const {
    ManifoldPoint p;
    p.reference_is_a = reference_is_a;
    p.normal = normal;
    p.pair = pair;
    return p;
  }
};

// The face of a polyhedron that the normal is next to, as ground; false where there is none.
bool face_ground(const View& v, Ground& ground) {
  const Frame world = v.reference_frame * v.reference.placement;
  const Polyhedron& core = *v.reference.core;
  const Vec3 local = world.R.transpose() * v.normal;
  const int number = core.face_at_vertex(core.support(local, 0), local);
  const Polyhedron::Face& face = core.face(number);
  if (face.normal.dot(local) < patch::aligned_round) return false;
  ground.normal = world.R * face.normal;
  ground.point = world * (face.offset * face.normal);
  ground.name = static_cast<std::uint64_t>(number);
  for (int i = face.first; i < face.first + face.count; ++i) {
    const Vec3 inward = world.R * core.side(i).inward;
    ground.sides.push_back({inward, core.side(i).offset + inward.dot(world.p), 0});
  }
  return true;
}

// The cap of a cylinder that the normal is next to.
bool cap_ground(const View& v, Ground& ground) {
  const PlacedCylinder c(v.reference, v.reference_frame);
  const double along = c.axis.dot(v.normal);
  if (std::abs(along) < patch::aligned_round) return false;
  ground.normal = along < 0 ? Vec3(-c.axis) : c.axis;
  ground.point = c.center + c.half_length * ground.normal;
  ground.name = along < 0 ? 1001 : 1000;
  const Vec3 beside = c.axis.cross(c.across);
  for (int k = 0; k < patch::disc_sides; ++k) {
    const double angle = 2 * pi * k / patch::disc_sides;
    const Vec3 inward = -(std::cos(angle) * c.across + std::sin(angle) * beside);
    ground.sides.push_back({inward, inward.dot(c.center) - c.radius, 0});
  }
  return true;
}

// The witnesses alone; a rim keeps rolling on its ball.
void add_witness(const View& v, std::vector<ManifoldPoint>& out) {
  ManifoldPoint p = v.point();
  p.gap = v.distance;
  p.reference_point = v.on_reference;
  p.core_point = v.on_other;
  if (v.other.kind == PartKind::cylinder) {
    Vec3 down;
    p.radius = PlacedCylinder(v.other, v.other_frame).rolling_radius(v.normal, down);
    p.core_point += p.radius * v.normal;
  }
  p.feature = feature_name(v.pair, FeatureMode::corners, {0, 0, 0});
  out.push_back(p);
}

void add_on_ground(const View& v, const Ground& ground, std::vector<ManifoldPoint>& out) {
  const std::size_t from = out.size();
  const PlacedCylinder cylinder(v.other, v.other_frame);
  cylinder_on_ground(cylinder, ground, v.reach, v.point(), out);
  double least = 1e300;
  for (std::size_t i = from; i < out.size(); ++i) least = std::min(least, out[i].gap);
  const double allowed =
      patch::missed_ratio * std::abs(v.distance) + patch::missed_floor_round * cylinder.radius;
  if (least <= v.distance + allowed) return;
  if (out.size() - from == patch::most_points) out.pop_back();
  add_witness(v, out);
}

// A cap as reference and a polyhedron: its edges, cut off at the rim.
void add_on_cap(const View& v, const Ground& cap, std::vector<ManifoldPoint>& out) {
  thread_local std::vector<FacePoint> points;
  points.clear();
  const PlacedCylinder c(v.reference, v.reference_frame);
  const Frame world = v.other_frame * v.other.placement;
  const Polyhedron& core = *v.other.core;
  const double near = 1e-6 * c.radius;
  const auto add = [&](const Vec3& point, std::uint64_t key) {
    const double gap = cap.normal.dot(point - cap.point);
    if (gap > v.reach) return;
    for (const FacePoint& old : points)
      if ((old.point - point).squaredNorm() < near * near) return;
    points.push_back({point, gap, key});
  };
  for (std::size_t e = 0; e < core.edges().size(); ++e) {
    const Vec3 tail = world * core.vertex(core.edges()[e].tail) - c.center;
    const Vec3 along = world * core.vertex(core.edges()[e].head) - c.center - tail;
    // |x'| <= r for x = tail + t along, ' the part square to the axis
    const Vec3 start = tail - c.axis * c.axis.dot(tail);
    const Vec3 rate = along - c.axis * c.axis.dot(along);
    const double square = rate.squaredNorm();
    const double half = start.dot(rate);
    const double rest = start.squaredNorm() - c.radius * c.radius;
    const double disc = half * half - square * rest;
    if (disc < 0 || (!(square > 0) && rest > 0)) continue;
    const double root = std::sqrt(disc);
    const double from = square > 0 ? std::max(0.0, (-half - root) / square) : 0;
    const double to = square > 0 ? std::min(1.0, (-half + root) / square) : 1;
    if (from > to) continue;
    const auto& edge = core.edges()[e];
    const auto name = [&](double t, bool first) {
      if (t == 0) return static_cast<std::uint64_t>(edge.tail);
      if (t == 1) return static_cast<std::uint64_t>(edge.head);
      return (2 * static_cast<std::uint64_t>(e) + (first ? 1 : 2)) << 20;
    };
    add(c.center + tail + from * along, name(from, true));
    add(c.center + tail + to * along, name(to, false));
  }
  thin_face_points(points, patch::most_points);
  ManifoldPoint p = v.point();
  p.normal = cap.normal;
  for (const FacePoint& found : points) {
    p.gap = found.gap;
    p.core_point = found.point;
    p.reference_point = found.point - found.gap * cap.normal;
    p.feature = feature_name(v.pair, FeatureMode::face, {cap.name, found.key, 0});
    out.push_back(p);
  }
  if (points.empty()) add_witness(v, out);
}

// A cylinder's axis and the line of a segment of the other, `tail` + t `along`, where they cross
// well within both and the normal stands on both; false where they do not.
bool add_crossing(const View& v, const Vec3& tail, const Vec3& along, double radius,
                  std::vector<ManifoldPoint>& out) {
  const PlacedCylinder c(v.reference, v.reference_frame);
  const double length = along.norm();
  const Vec3 other = along / length;
  const Vec3 across = c.axis.cross(other);
  const double sine = across.norm();
  if (!(sine >= patch::crossing)) return false;
  const double cosine = across.dot(v.normal) / sine;
  if (std::abs(cosine) < patch::aligned_round) return false;
  ManifoldPoint p = v.point();
  p.kind = ReferenceFeature::crossing;
  p.normal = (cosine < 0 ? -1 : 1) / sine * across;
  p.direction = c.axis;
  p.other_direction = other;
  p.reference_radius = c.radius;
  p.radius = radius;
  // the points of either line that are nearest to the other one
  const Vec3 apart = tail - c.center;
  const double on_other = -apart.dot(p.normal.cross(c.axis)) / other.dot(p.normal.cross(c.axis));
  const double on_axis = apart.dot(p.normal.cross(other)) / c.axis.dot(p.normal.cross(other));
  if (std::abs(on_axis) >= c.half_length || on_other <= 0 || on_other >= length) return false;
  p.core_point = tail + on_other * other;
  p.reference_point = c.center + on_axis * c.axis;
  p.gap = p.normal.dot(p.core_point - p.reference_point) - c.radius - radius;
  p.feature = feature_name(v.pair, FeatureMode::side, {3, 0, 0});
  if (p.gap <= v.reach) out.push_back(p);
  return true;
}

// A segment of the reference, from `tail` along `along` with a radius, and a rim of the cylinder
// that stands on it as the other; false where they do not cross well within the segment, or where
// the normal is not square to both.
bool add_rim(const View& v, const Vec3& tail, const Vec3& along, double radius,
             std::vector<ManifoldPoint>& out) {
  const PlacedCylinder c(v.other, v.other_frame);
  const double length = along.norm();
  const Vec3 line = along / length;
  ManifoldPoint p = v.point();
  p.kind = ReferenceFeature::rim;
  const double up = c.axis.dot(v.on_other - c.center);
  p.other_direction = c.axis;
  p.rim_center = c.center + (up < 0 ? -c.half_length : c.half_length) * c.axis;
  p.rim = c.radius;
  const Vec3 from_axis = v.on_other - p.rim_center;
  const Vec3 out_of_axis = from_axis - c.axis * c.axis.dot(from_axis);
  const double reach = out_of_axis.norm();
  if (std::abs(reach - c.radius) > patch::level * c.radius ||
      (from_axis - out_of_axis).norm() > patch::level * c.radius)
    return false;
  const Vec3 radial = out_of_axis / reach;
  const Vec3 across = line.cross(c.axis.cross(radial));
  const double sine = across.norm();
  if (!(sine >= patch::crossing)) return false;
  const double cosine = across.dot(v.normal) / sine;
  if (std::abs(cosine) < patch::aligned_round) return false;
  p.normal = (cosine < 0 ? -1 : 1) / sine * across;
  // outside the cylinder's side, and not almost flat on it: then the point on the rim that a small
  // turn makes the nearest is far off
  if (std::abs(p.normal.dot(c.axis)) < patch::level || p.normal.dot(radial) > -patch::crossing)
    return false;
  p.direction = line;
  p.reference_radius = radius;
  p.core_point = p.rim_center + c.radius * radial;
  const double at = line.dot(p.core_point - tail);
  if (at <= 0 || at >= length) return false;
  p.reference_point = tail + at * line;
  p.gap = p.normal.dot(p.core_point - p.reference_point) - radius;
  p.feature = feature_name(v.pair, FeatureMode::rim, {up < 0 ? 1u : 0u, 2, 0});
  if (p.gap <= v.reach) out.push_back(p);
  return true;
}

// A cylinder's axis as reference line, and a segment of the other: from `tail` along `along` with a
// radius.  Nearly parallel ones meet at the two ends of what they share, others at the witness.
void add_on_side(const View& v, const Vec3& tail, const Vec3& along, double radius,
                 std::vector<ManifoldPoint>& out) {
  const PlacedCylinder c(v.reference, v.reference_frame);
  ManifoldPoint p = v.point();
  p.kind = ReferenceFeature::line;
  p.direction = c.axis;
  p.reference_radius = c.radius;
  p.radius = radius;
  const auto add = [&](const Vec3& core, std::uint64_t end) {
    const Vec3 from_axis = core - c.center;
    const Vec3 out_of_axis = from_axis - c.axis * c.axis.dot(from_axis);
    const double height = out_of_axis.norm();
    if (!(height > 0)) return;
    p.gap = height - c.radius - radius;
    if (p.gap > v.reach) return;
    p.normal = out_of_axis / height;
    p.core_point = core;
    p.reference_point = core - out_of_axis;
    p.feature = feature_name(v.pair, FeatureMode::side, {end, 0, 0});
    out.push_back(p);
  };
  const std::size_t from = out.size();
  const double rate = along.dot(c.axis);
  if (along.cross(c.axis).norm() < patch::level * along.norm()) {
    const double start = (tail - c.center).dot(c.axis);
    double t0 = (-c.half_length - start) / rate;
    double t1 = (c.half_length - start) / rate;
    if (t0 > t1) std::swap(t0, t1);
    t0 = std::max(t0, 0.0);
    t1 = std::min(t1, 1.0);
    if (t0 <= t1) {
      add(tail + t0 * along, 1);
      if (t1 > t0) add(tail + t1 * along, 2);
    }
  }
  if (out.size() == from) add(v.on_other + radius * v.normal, 0);
}

// The edge of a polyhedron, from its vertex farthest against the normal, that holds the witness;
// zero where none does within 0.2 degrees.
void witness_edge(const View& v, Vec3& tail, Vec3& along) {
  const Frame world = v.other_frame * v.other.placement;
  const Polyhedron& core = *v.other.core;
  const int vertex = core.support(-(world.R.transpose() * v.normal), 0);
  tail = world * core.vertex(vertex);
  along.setZero();
  double best = patch::level;
  for (const Polyhedron::Link& link : core.links(vertex)) {
    const Vec3 edge = world * core.vertex(link.vertex) - tail;
    const double off = edge.cross(v.on_other - tail).norm() / edge.squaredNorm();
    if (off >= best || std::abs(edge.dot(v.normal)) > patch::level * edge.norm()) continue;
    best = off;
    along = edge;
  }
}

// The edge of a polyhedron, from its vertex farthest against the normal, that lies most along the
// axis and square to the normal; zero where there is none within 0.2 degrees.
void level_edge(const View& v, Vec3& tail, Vec3& along) {
  const Frame world = v.other_frame * v.other.placement;
  const Polyhedron& core = *v.other.core;
  const Vec3 axis = PlacedCylinder(v.reference, v.reference_frame).axis;
  const int vertex = core.support(-(world.R.transpose() * v.normal), 0);
  tail = world * core.vertex(vertex);
  along.setZero();
  double best = patch::level;
  for (const Polyhedron::Link& link : core.links(vertex)) {
    const Vec3 edge = world * core.vertex(link.vertex) - tail;
    const double off = edge.cross(axis).norm() / edge.norm();
    if (off >= best || std::abs(edge.dot(v.normal)) > patch::level * edge.norm()) continue;
    best = off;
    along = edge;
  }
}

bool is_level(const ConvexPart& part, const Frame& frame, const Vec3& normal) {
  return std::abs(PlacedCylinder(part, frame).axis.dot(normal)) < patch::level;
}

void polyhedron_and_cylinder(const View& of_polyhedron, const View& of_cylinder,
                             std::vector<ManifoldPoint>& out) {
  Ground ground;
  if (face_ground(of_polyhedron, ground)) return add_on_ground(of_polyhedron, ground, out);
  if (cap_ground(of_cylinder, ground)) return add_on_cap(of_cylinder, ground, out);
  Vec3 tail, along;
  witness_edge(of_cylinder, tail, along);
  if (!is_level(of_cylinder.reference, of_cylinder.reference_frame, of_cylinder.normal)) {
    if (!along.isZero(0) && add_rim(of_polyhedron, tail, along, 0, out)) return;
    return add_witness(of_polyhedron, out);
  }
  if (!along.isZero(0) && add_crossing(of_cylinder, tail, along, 0, out)) return;
  level_edge(of_cylinder, tail, along);
  if (along.isZero(0)) along = of_cylinder.normal;  // no part of it is along the axis
  add_on_side(of_cylinder, tail, along, 0, out);
}

void two_cylinders(const View& of_a, const View& of_b, std::vector<ManifoldPoint>& out) {
  Ground cap_a, cap_b;
  const bool on_a = cap_ground(of_a, cap_a);
  const bool on_b = cap_ground(of_b, cap_b);
  // the wider cap carries
  if (on_a && !(on_b && of_b.reference.radius > of_a.reference.radius))
    return add_on_ground(of_a, cap_a, out);
  if (on_b) return add_on_ground(of_b, cap_b, out);
  const bool side_a = is_level(of_a.reference, of_a.reference_frame, of_a.normal);
  const bool side_b = is_level(of_b.reference, of_b.reference_frame, of_b.normal);
  if (side_a && side_b) {
    const PlacedCylinder b(of_a.other, of_a.other_frame);
    const Vec3 tail = b.center - b.half_length * b.axis, along = 2 * b.half_length * b.axis;
    if (add_crossing(of_a, tail, along, b.radius, out)) return;
    return add_on_side(of_a, tail, along, b.radius, out);
  }
  // a side and a rim, or two rims
  for (const auto& [is_side, view] : {std::pair(side_a, &of_a), std::pair(side_b, &of_b)}) {
    if (!is_side) continue;
    const PlacedCylinder c(view->reference, view->reference_frame);
    if (add_rim(*view, c.center - c.half_length * c.axis, 2 * c.half_length * c.axis, c.radius,
                out))
      return;
    return add_on_side(*view, view->on_other, view->normal, 0, out);
  }
  add_witness(of_a, out);
}

void cylinder_and_sphere(const ConvexPart& cylinder, const Frame& frame_c, const ConvexPart& sphere,
                         const Frame& frame_s, double reach, bool reference_is_a, int pair,
                         std::vector<ManifoldPoint>& out) {
  const PlacedCylinder c(cylinder, frame_c);
  const Frame world = frame_c * cylinder.placement;
  ManifoldPoint p;
  p.core_point = frame_s * sphere.placement.p;
  const NearestOnCylinder near =
      nearest_on_cylinder(c.radius, c.half_length, world.to_local(p.core_point));
  p.gap = near.distance - sphere.radius;
  if (p.gap > reach) return;
  p.reference_is_a = reference_is_a;
  p.radius = sphere.radius;
  p.normal = world.R * near.normal;
  p.reference_point = world * near.point;
  p.pair = pair;
  FeatureMode mode = FeatureMode::face;
  if (near.feature == CylinderFeature::side) {
    mode = FeatureMode::side;
    p.kind = ReferenceFeature::line;
    p.direction = c.axis;
    p.reference_radius = c.radius;
    p.reference_point -= c.radius * p.normal;
  } else if (near.feature == CylinderFeature::rim) {
    mode = FeatureMode::rim;
    p.kind = ReferenceFeature::point;
  }
  p.feature = feature_name(pair, mode, {p.normal.dot(c.axis) < 0 ? 1u : 0u, 0, 0});
  out.push_back(p);
}

void half_space_and_cylinder(const ConvexPart& half_space, const Frame& frame_h,
                             const ConvexPart& cylinder, const Frame& frame_c, double reach,
                             bool reference_is_a, int pair, std::vector<ManifoldPoint>& out) {
  Ground ground;
  ground.normal = frame_h.R * half_space.normal;
  ground.point = frame_h.p + half_space.offset * ground.normal;
  ManifoldPoint p;
  p.reference_is_a = reference_is_a;
  p.pair = pair;
  cylinder_on_ground(PlacedCylinder(cylinder, frame_c), ground, reach, p, out);
}

}  // namespace

void round_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                    const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                    std::vector<ManifoldPoint>& out) {
  const View of_a{
      a,     frame_a, b, frame_b, true, near.normal, near.point_a, near.point_b, near.distance,
      reach, pair};
  const View of_b{
      b,     frame_b, a, frame_a, false, -near.normal, near.point_b, near.point_a, near.distance,
      reach, pair};
  if (a.kind == PartKind::polyhedron) return polyhedron_and_cylinder(of_a, of_b, out);
  if (b.kind == PartKind::polyhedron) return polyhedron_and_cylinder(of_b, of_a, out);
  two_cylinders(of_a, of_b, out);
}

void cylinder_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                       const Frame& frame_b, double reach, int pair,
                       std::vector<ManifoldPoint>& out) {
  if (a.kind == PartKind::half_space)
    return half_space_and_cylinder(a, frame_a, b, frame_b, reach, true, pair, out);
  if (b.kind == PartKind::half_space)
    return half_space_and_cylinder(b, frame_b, a, frame_a, reach, false, pair, out);
  if (b.kind == PartKind::sphere)
    return cylinder_and_sphere(a, frame_a, b, frame_b, reach, true, pair, out);
  if (a.kind == PartKind::sphere)
    return cylinder_and_sphere(b, frame_b, a, frame_a, reach, false, pair, out);
  const Separation s = part_separation(a, frame_a, b, frame_b, nullptr);
  if (s.distance > reach) return;
  round_manifold(a, frame_a, b, frame_b, {s.distance, s.normal, s.point_a, s.point_b}, reach, pair,
                 out);
}

}  // namespace tw
