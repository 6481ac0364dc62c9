// Contact manifolds of frustums: cylinders, cones, capsules.
//
// Which features meet is read off the axis of least distance: along a cap's normal the cap does,
// along that of the side the side does, else a rim, or an end without one: a tip or the round end
// of a capsule, which are balls.  What crosses runs along both (group-arc.h): a side or an edge and
// another side are two lines, with a rim they are a line and a circle.
//
// The side of a cone is that of the cylinder that osculates it where it touches: its axis is
// parallel to the generatrix there.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <tuple>

#include "base/constants.h"
#include "collision/distance/frustum-point.h"
#include "collision/distance/separation.h"
#include "collision/manifold/face-contact.h"
#include "collision/manifold/frustum-plane.h"

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
  const Frame world = v.reference.in(v.reference_frame);
  const Polyhedron& core = *v.reference.core;
  const Vec3 local = world.R.transpose() * v.normal;
  const int number = core.face_at_vertex(core.support(local, 0), local);
  const Polyhedron::Face& face = core.face(number);
  if (face.normal.dot(local) < patch::aligned_round) return false;
  ground.normal = world.R * face.normal;
  ground.point = world * (face.offset * face.normal);
  ground.name = static_cast<std::uint64_t>(number);
  ground.parallel = 1 - face.normal.cross(local).norm() / patch::level;
  for (int i = face.first; i < face.first + face.count; ++i) {
    const Vec3 inward = world.R * core.side(i).inward;
    ground.sides.push_back({inward, core.side(i).offset + inward.dot(world.p), 0});
  }
  return true;
}

// The side of a frustum where a point of it is, as a cylinder: unit axis, middle.
struct SideLine {
  Vec3 center, axis;
  double radius, half_length;

  Vec3 tail() const { return center - half_length * axis; }
  Vec3 along() const { return 2 * half_length * axis; }
};

SideLine side_line(const ConvexPart& part, const Frame& frame, const Vec3& point) {
  const PlacedFrustum c(part, frame);
  if (!narrows(part)) return {c.center, c.axis, c.bottom_radius + c.margin, c.half_length};
  const Vec3 from_axis = point - c.center - c.axis * c.axis.dot(point - c.center);
  const double height = from_axis.norm();
  const Vec3 out = height > 0 ? Vec3(from_axis / height) : c.across;
  const SideNormal side(part);
  const Vec3 bottom = c.end(false) + c.bottom_radius * out, top = c.end(true) + c.top_radius * out;
  const double radius = c.radius_at(point) / side.across;
  return {0.5 * (bottom + top) - radius * (side.across * out + side.along * c.axis),
          (top - bottom).normalized(), radius + c.margin, 0.5 * (top - bottom).norm()};
}

// Whether the normal (unit, outward) is square to the side where the point is.
bool is_level(const ConvexPart& part, const Frame& frame, const Vec3& point, const Vec3& normal) {
  return std::abs(side_line(part, frame, point).axis.dot(normal)) < patch::level;
}

// The end without a rim that the point belongs to, if it does, as a ball.
bool end_ball(const ConvexPart& part, const Frame& frame, const Vec3& point, ConvexPart& ball) {
  const PlacedFrustum c(part, frame);
  const bool top = c.axis.dot(point - c.center) > 0;
  if (c.end_radius(top) > 0) return false;
  ball.radius = part.margin;
  ball.place({Mat3::Identity(),
              part.placement() * Vec3(0, 0, top ? part.half_length : -part.half_length)});
  return true;
}

// The cap of a frustum that the normal is next to.
bool cap_ground(const View& v, Ground& ground) {
  const PlacedFrustum c(v.reference, v.reference_frame);
  const double along = c.axis.dot(v.normal);
  const double radius = c.end_radius(along > 0);
  if (!(radius > 0) || std::abs(along) < patch::aligned_round) return false;
  ground.normal = along < 0 ? Vec3(-c.axis) : c.axis;
  ground.point = c.center + c.half_length * ground.normal;
  ground.name = along < 0 ? 1001 : 1000;
  ground.parallel = 1 - c.axis.cross(v.normal).norm() / patch::level;
  const Vec3 beside = c.axis.cross(c.across);
  for (int k = 0; k < patch::disc_sides; ++k) {
    const double angle = 2 * pi * k / patch::disc_sides;
    const Vec3 inward = -(std::cos(angle) * c.across + std::sin(angle) * beside);
    ground.sides.push_back({inward, inward.dot(c.center) - radius, 0});
  }
  return true;
}

// The witnesses alone; a rim keeps rolling on its ball.
void add_witness(const View& v, std::vector<ManifoldPoint>& out) {
  ManifoldPoint p = v.point();
  p.gap = v.distance;
  p.reference_point = v.on_reference;
  p.core_point = v.on_other;
  if (v.other.kind == PartKind::frustum) {
    const PlacedFrustum c(v.other, v.other_frame);
    p.radius = c.rolling_radius(c.radius_at(v.on_other), c.tilt(v.normal));
    p.core_point += p.radius * v.normal;
  }
  p.feature = feature_name(v.pair, FeatureMode::corners, {0, 0, 0});
  out.push_back(p);
}

void add_on_ground(const View& v, const Ground& ground, std::vector<ManifoldPoint>& out) {
  const std::size_t from = out.size();
  const PlacedFrustum frustum(v.other, v.other_frame);
  frustum_on_ground(frustum, ground, v.reach, v.point(), out);
  double least = 1e300;
  for (std::size_t i = from; i < out.size(); ++i) least = std::min(least, out[i].gap);
  const double allowed =
      patch::missed_ratio * std::abs(v.distance) + patch::missed_floor_round * frustum.widest();
  if (least <= v.distance + allowed) return;
  if (out.size() - from == patch::most_points) out.pop_back();
  add_witness(v, out);
}

// A cap as reference and a polyhedron: its edges, cut off at the rim.
void add_on_cap(const View& v, const Ground& cap, std::vector<ManifoldPoint>& out) {
  thread_local std::vector<FacePoint> points, higher;
  points.clear();
  higher.clear();
  const PlacedFrustum c(v.reference, v.reference_frame);
  const double radius = c.end_radius(cap.normal.dot(c.axis) > 0);
  const Frame world = v.other.in(v.other_frame);
  const Polyhedron& core = *v.other.core;
  const double near = 1e-6 * radius;
  // what is this much beyond the reach lies flat with nothing on the cap
  const double steep = 2.1 * patch::aligned_sine * radius;
  const auto add = [&](const Vec3& point, std::uint64_t key) {
    const double gap = cap.normal.dot(point - cap.point);
    std::vector<FacePoint>& found = gap > v.reach ? higher : points;
    // nor does it matter how often it is there
    if (gap <= v.reach + steep)
      for (const FacePoint& old : found)
        if ((old.point - point).squaredNorm() < near * near) return;
    found.push_back({point, gap, key});
  };
  for (std::size_t e = 0; e < core.edges().size(); ++e) {
    const Vec3 tail = world * core.vertex(core.edges()[e].tail) - c.center;
    const Vec3 along = world * core.vertex(core.edges()[e].head) - c.center - tail;
    // |x'| <= r for x = tail + t along, ' the part square to the axis
    const Vec3 start = tail - c.axis * c.axis.dot(tail);
    const Vec3 rate = along - c.axis * c.axis.dot(along);
    const double square = rate.squaredNorm();
    const double half = start.dot(rate);
    const double rest = start.squaredNorm() - radius * radius;
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
  thin_face_points(points, patch::most_points, v.reach);
  ManifoldPoint p = v.point();
  p.normal = cap.normal;
  for (const FacePoint& found : points) {
    p.gap = found.gap;
    p.core_point = found.point;
    p.reference_point = found.point - found.gap * cap.normal;
    p.feature = feature_name(v.pair, FeatureMode::face, {cap.name, found.key, 0});
    out.push_back(p);
  }
  lie_on_each_other(cap.parallel, patch::aligned_sine, higher, out.size() - points.size(), out);
  if (points.empty()) add_witness(v, out);
}

// The axis of a frustum's side and the line of a segment of the other, `tail` + t `along`, where
// they cross well within both and the normal stands on both; false where they do not.
bool add_crossing(const View& v, const Vec3& tail, const Vec3& along, double radius,
                  std::vector<ManifoldPoint>& out) {
  const SideLine c = side_line(v.reference, v.reference_frame, v.on_reference);
  const double length = along.norm();
  const Vec3 other = along / length;
  const Vec3 across = c.axis.cross(other);
  const double sine = across.norm();
  if (!(sine >= patch::crossing)) return false;
  const double cosine = across.dot(v.normal) / sine;
  if (std::abs(cosine) < patch::aligned_round) return false;
  ManifoldPoint p = v.point();
  p.kind = ContactFeature::crossing;
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

// A segment of the reference, from `tail` along `along` with a radius, and a rim of the frustum
// that stands on it as the other; false where they do not cross well within the segment, or where
// the normal is not square to both.
bool add_rim(const View& v, const Vec3& tail, const Vec3& along, double radius,
             std::vector<ManifoldPoint>& out) {
  const PlacedFrustum c(v.other, v.other_frame);
  const double length = along.norm();
  const Vec3 line = along / length;
  ManifoldPoint p = v.point();
  p.kind = ContactFeature::rim;
  const double up = c.axis.dot(v.on_other - c.center);
  p.other_direction = c.axis;
  p.rim_center = c.end(!(up < 0));
  p.rim = c.end_radius(!(up < 0));
  const Vec3 from_axis = v.on_other - p.rim_center;
  const Vec3 out_of_axis = from_axis - c.axis * c.axis.dot(from_axis);
  const double reach = out_of_axis.norm();
  if (std::abs(reach - p.rim) > patch::level * p.rim ||
      (from_axis - out_of_axis).norm() > patch::level * p.rim)
    return false;
  const Vec3 radial = out_of_axis / reach;
  const Vec3 across = line.cross(c.axis.cross(radial));
  const double sine = across.norm();
  if (!(sine >= patch::crossing)) return false;
  const double cosine = across.dot(v.normal) / sine;
  if (std::abs(cosine) < patch::aligned_round) return false;
  p.normal = (cosine < 0 ? -1 : 1) / sine * across;
  // neither on the frustum's side nor flat on its end: there an edge is better seen as it stands,
  // while a side, whose normal turns as it rolls, is so almost to the last
  const double flat = radius > 0 ? patch::level : patch::crossing;
  if (std::abs(p.normal.dot(c.axis)) < patch::level || p.normal.dot(radial) > -flat) return false;
  p.direction = line;
  p.reference_radius = radius;
  p.core_point = p.rim_center + p.rim * radial;
  const double at = line.dot(p.core_point - tail);
  if (at <= 0 || at >= length) return false;
  p.reference_point = tail + at * line;
  p.gap = p.normal.dot(p.core_point - p.reference_point) - radius;
  p.feature = feature_name(v.pair, FeatureMode::rim, {up < 0 ? 1u : 0u, 2, 0});
  if (p.gap <= v.reach) out.push_back(p);
  return true;
}

// Of a segment, tail + t along, what lies on a side from t0 to t1: the part over which it comes no
// farther from the axis than `allowed` beyond the nearest there.  Its distance from the axis grows
// from where they cross, by s^2 sine^2/2h, h the height of the one over the other.  False, and as
// it was, where that is too small a part for its ends to hold more than its middle would.
bool keep_near_crossing(const SideLine& c, const Vec3& tail, const Vec3& along, double height,
                        double allowed, double& t0, double& t1) {
  const Vec3 apart = tail - c.center;
  const Vec3 off = along - c.axis * along.dot(c.axis);
  const double square = off.squaredNorm();
  const double crossing = -off.dot(apart - c.axis * apart.dot(c.axis)) / square;
  const double nearest = std::clamp(crossing, t0, t1) - crossing;
  const double width = std::sqrt(nearest * nearest + 2 * height * allowed / square);
  const double from = std::max(t0, crossing - width), to = std::min(t1, crossing + width);
  if (!(to - from >= patch::least_line * (t1 - t0))) return false;
  t0 = from;
  t1 = to;
  return true;
}

// The axis of a frustum's side as reference line, and a segment of the other: from `tail` along
// `along` with a radius.  Nearly parallel ones meet at the two ends of what they share, flat ones
// as far as points between them would not be much deeper; others at the witness.
void add_on_side(const View& v, const Vec3& tail, const Vec3& along, double radius,
                 std::vector<ManifoldPoint>& out) {
  const SideLine c = side_line(v.reference, v.reference_frame, v.on_reference);
  ManifoldPoint p = v.point();
  p.kind = ContactFeature::line;
  p.direction = c.axis;
  p.reference_radius = c.radius;
  p.radius = radius;
  thread_local std::vector<FacePoint> higher;
  higher.clear();
  const auto add = [&](const Vec3& core, std::uint64_t end) {
    const Vec3 from_axis = core - c.center;
    const Vec3 out_of_axis = from_axis - c.axis * c.axis.dot(from_axis);
    const double height = out_of_axis.norm();
    if (!(height > 0)) return;
    p.gap = height - c.radius - radius;
    if (p.gap > v.reach) {
      higher.push_back({core, p.gap});
      return;
    }
    p.normal = out_of_axis / height;
    p.core_point = core;
    p.reference_point = core - out_of_axis;
    p.feature = feature_name(v.pair, FeatureMode::side, {end, 0, 0});
    out.push_back(p);
  };
  const std::size_t from = out.size();
  const double rate = along.dot(c.axis);
  const double sine = along.cross(c.axis).norm() / along.norm();
  if (sine < patch::crossing) {
    const double start = (tail - c.center).dot(c.axis);
    double t0 = (-c.half_length - start) / rate;
    double t1 = (c.half_length - start) / rate;
    if (t0 > t1) std::swap(t0, t1);
    t0 = std::max(t0, 0.0);
    t1 = std::min(t1, 1.0);
    const double round = c.radius + radius;
    if (t0 <= t1 &&
        (sine < patch::level ||
         keep_near_crossing(c, tail, along, round, patch::missed_along * round, t0, t1))) {
      add(tail + t0 * along, 1);
      if (t1 > t0) add(tail + t1 * along, 2);
      // what is askew by more than this is seen as it stands
      lie_on_each_other(1, patch::level, higher, from, out);
    }
  }
  if (out.size() == from) add(v.on_other + radius * v.normal, 0);
}

// The edge of a polyhedron, from its vertex farthest against the normal, that holds the witness;
// zero where none does within 0.2 degrees.
void witness_edge(const View& v, Vec3& tail, Vec3& along) {
  const Frame world = v.other.in(v.other_frame);
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
// axis, within 6 degrees, and square to the normal within 0.2; zero where there is none.
void level_edge(const View& v, Vec3& tail, Vec3& along) {
  const Frame world = v.other.in(v.other_frame);
  const Polyhedron& core = *v.other.core;
  const Vec3 axis = side_line(v.reference, v.reference_frame, v.on_reference).axis;
  const int vertex = core.support(-(world.R.transpose() * v.normal), 0);
  tail = world * core.vertex(vertex);
  along.setZero();
  double best = patch::crossing;
  for (const Polyhedron::Link& link : core.links(vertex)) {
    const Vec3 edge = world * core.vertex(link.vertex) - tail;
    const double off = edge.cross(axis).norm() / edge.norm();
    if (off >= best || std::abs(edge.dot(v.normal)) > patch::level * edge.norm()) continue;
    best = off;
    along = edge;
  }
}

void polyhedron_and_frustum(const View& of_polyhedron, const View& of_frustum,
                            std::vector<ManifoldPoint>& out) {
  const ConvexPart& frustum = of_frustum.reference;
  const Frame& frame = of_frustum.reference_frame;
  Ground ground;
  if (face_ground(of_polyhedron, ground)) return add_on_ground(of_polyhedron, ground, out);
  if (cap_ground(of_frustum, ground)) return add_on_cap(of_frustum, ground, out);
  Vec3 tail, along;
  witness_edge(of_frustum, tail, along);
  if (!is_level(frustum, frame, of_frustum.on_reference, of_frustum.normal)) {
    ConvexPart ball;
    if (end_ball(frustum, frame, of_frustum.on_reference, ball)) {
      return polyhedron_sphere_manifold(of_polyhedron.reference, of_polyhedron.reference_frame,
                                        ball, frame, of_polyhedron.reach,
                                        of_polyhedron.reference_is_a, of_polyhedron.pair, out);
    }
    if (!along.isZero(0) && add_rim(of_polyhedron, tail, along, 0, out)) return;
    return add_witness(of_polyhedron, out);
  }
  if (!along.isZero(0) && add_crossing(of_frustum, tail, along, 0, out)) return;
  level_edge(of_frustum, tail, along);
  if (along.isZero(0)) along = of_frustum.normal;  // no part of it is along the axis
  add_on_side(of_frustum, tail, along, 0, out);
}

void frustum_and_sphere(const ConvexPart& frustum, const Frame& frame_f, const ConvexPart& sphere,
                        const Frame& frame_s, double reach, bool reference_is_a, int pair,
                        std::vector<ManifoldPoint>& out) {
  const Frame world = frustum.in(frame_f);
  ManifoldPoint p;
  p.core_point = frame_s * sphere.placement().p;
  const NearestOnFrustum near = nearest_on_frustum(frustum, world.to_local(p.core_point));
  p.gap = near.distance - sphere.radius;
  if (p.gap > reach) return;
  p.reference_is_a = reference_is_a;
  p.radius = sphere.radius;
  p.normal = world.R * near.normal;
  p.reference_point = world * near.point;
  p.pair = pair;
  FeatureMode mode = FeatureMode::face;
  if (near.feature == FrustumFeature::side) {
    const SideLine side = side_line(frustum, frame_f, p.reference_point);
    mode = FeatureMode::side;
    p.kind = ContactFeature::line;
    p.direction = side.axis;
    p.reference_radius = side.radius;
    p.reference_point -= side.radius * p.normal;
  } else if (near.feature == FrustumFeature::rim) {
    // the rim keeps rolling on its ball
    mode = FeatureMode::rim;
    p.kind = ContactFeature::point;
    const PlacedFrustum c(frustum, frame_f);
    const Vec3 core = world * near.core;
    const double rolling = c.rolling_radius(c.radius_at(core), c.tilt(-p.normal));
    p.reference_radius = rolling;
    p.reference_point = core - (rolling - frustum.margin) * p.normal;
  }
  const bool down = p.normal.dot(world.R.col(2)) < 0;
  p.feature = feature_name(pair, mode, {down ? 1u : 0u, 0, 0});
  out.push_back(p);
}

// Neither on its side nor on a cap: rims, tips and round ends.
void two_ends(const View& of_a, const View& of_b, std::vector<ManifoldPoint>& out) {
  ConvexPart ball_a, ball_b;
  const bool round_a = end_ball(of_a.reference, of_a.reference_frame, of_a.on_reference, ball_a);
  const bool round_b = end_ball(of_b.reference, of_b.reference_frame, of_b.on_reference, ball_b);
  if (round_a && round_b && ball_a.radius + ball_b.radius > 0)
    return spheres_manifold(ball_a, of_a.reference_frame, ball_b, of_b.reference_frame, of_a.reach,
                            of_a.pair, out);
  for (const auto& [is_ball, ball, rim] :
       {std::tuple(round_a, &ball_a, &of_b), std::tuple(round_b, &ball_b, &of_a)}) {
    if (!is_ball) continue;
    return frustum_and_sphere(rim->reference, rim->reference_frame, *ball, rim->other_frame,
                              rim->reach, rim->reference_is_a, rim->pair, out);
  }
  add_witness(of_a, out);
}

void two_frustums(const View& of_a, const View& of_b, std::vector<ManifoldPoint>& out) {
  Ground cap_a, cap_b;
  const bool on_a = cap_ground(of_a, cap_a);
  const bool on_b = cap_ground(of_b, cap_b);
  // the wider cap carries
  if (on_a && !(on_b && of_b.reference.radius > of_a.reference.radius))
    return add_on_ground(of_a, cap_a, out);
  if (on_b) return add_on_ground(of_b, cap_b, out);
  const auto level = [](const View& v) {
    return is_level(v.reference, v.reference_frame, v.on_reference, v.normal);
  };
  const bool side_a = level(of_a), side_b = level(of_b);
  if (side_a && side_b) {
    const SideLine b = side_line(of_a.other, of_a.other_frame, of_a.on_other);
    if (add_crossing(of_a, b.tail(), b.along(), b.radius, out)) return;
    return add_on_side(of_a, b.tail(), b.along(), b.radius, out);
  }
  // a side, and a rim or an end without one
  for (const auto& [is_side, view] : {std::pair(side_a, &of_a), std::pair(side_b, &of_b)}) {
    if (!is_side) continue;
    const SideLine c = side_line(view->reference, view->reference_frame, view->on_reference);
    ConvexPart ball;
    if (end_ball(view->other, view->other_frame, view->on_other, ball))
      return add_on_side(*view, view->on_other, view->normal, ball.radius, out);
    if (add_rim(*view, c.tail(), c.along(), c.radius, out)) return;
    return add_on_side(*view, view->on_other, view->normal, 0, out);
  }
  two_ends(of_a, of_b, out);
}

void half_space_and_frustum(const ConvexPart& half_space, const Frame& frame_h,
                            const ConvexPart& frustum, const Frame& frame_f, double reach,
                            bool reference_is_a, int pair, std::vector<ManifoldPoint>& out) {
  Ground ground;
  ground.normal = frame_h.R * half_space.normal;
  ground.point = frame_h.p + half_space.offset * ground.normal;
  ManifoldPoint p;
  p.reference_is_a = reference_is_a;
  p.pair = pair;
  frustum_on_ground(PlacedFrustum(frustum, frame_f), ground, reach, p, out);
}

}  // namespace

void frustum_manifold_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                         const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                         std::vector<ManifoldPoint>& out) {
  const View of_a{
      a,     frame_a, b, frame_b, true, near.normal, near.point_a, near.point_b, near.distance,
      reach, pair};
  const View of_b{
      b,     frame_b, a, frame_a, false, -near.normal, near.point_b, near.point_a, near.distance,
      reach, pair};
  const std::size_t from = out.size();
  if (a.kind == PartKind::polyhedron)
    polyhedron_and_frustum(of_a, of_b, out);
  else if (b.kind == PartKind::polyhedron)
    polyhedron_and_frustum(of_b, of_a, out);
  else
    two_frustums(of_a, of_b, out);
  const auto is_cone = [](const ConvexPart& part) {
    return part.kind == PartKind::frustum && narrows(part);
  };
  if (!is_cone(a) && !is_cone(b)) return;
  // what is nearest to a tip inside the other one, or across a cone that is hardly thicker than the
  // two are deep, may push elsewhere than the axis of least depth does
  for (std::size_t i = from; i < out.size(); ++i) {
    const Vec3 normal = out[i].reference_is_a ? out[i].normal : Vec3(-out[i].normal);
    if (normal.dot(near.normal) > patch::aligned) continue;
    out.resize(from);
    return add_witness(of_a, out);
  }
}

void frustum_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                      const Frame& frame_b, double reach, int pair,
                      std::vector<ManifoldPoint>& out) {
  if (a.kind == PartKind::half_space)
    return half_space_and_frustum(a, frame_a, b, frame_b, reach, true, pair, out);
  if (b.kind == PartKind::half_space)
    return half_space_and_frustum(b, frame_b, a, frame_a, reach, false, pair, out);
  if (b.kind == PartKind::sphere)
    return frustum_and_sphere(a, frame_a, b, frame_b, reach, true, pair, out);
  if (a.kind == PartKind::sphere)
    return frustum_and_sphere(b, frame_b, a, frame_a, reach, false, pair, out);
  const Separation s = part_separation(a, frame_a, b, frame_b, nullptr);
  if (s.distance > reach) return;
  frustum_manifold_at(a, frame_a, b, frame_b, {s.distance, s.normal, s.point_a, s.point_b}, reach,
                      pair, out);
}

}  // namespace tw
