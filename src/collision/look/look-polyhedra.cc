// Looks at two polyhedra, from where the last one ended.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/look/look-polyhedra.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/hash.h"
#include "collision/distance/axis-climb.h"
#include "collision/distance/gjk.h"
#include "collision/distance/nearest-features.h"
#include "collision/distance/part-pairs.h"
#include "collision/look/look-face.h"

namespace tw {

namespace {

class PolyhedraLook {
 public:
  PolyhedraLook(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                const Frame& frame_b, double reach, ReferenceChoice choice, PairMemory& memory,
                PartLook& look)
      : part_a_(a),
        part_b_(b),
        cores_(a, frame_a, b, frame_b),
        reach_(reach),
        choice_(choice),
        memory_(memory),
        look_(look) {}
  void look();

 private:
  bool is_apart_along_axis();
  bool lies_on_known_face();
  void measure(LeastAxis& axis) const;
  void find_axis();
  void sink(const LeastAxis& axis);
  void add_points();
  void add_nearest();
  bool takes_face_of_a(double along_a, double along_b) const;
  void use_face(bool of_a);
  LookPoint placed(bool reference_is_a, const Vec3& normal, double offset, const Vec3& core) const;
  Vec3 against() const { return -(cores_.b_in_a.R.transpose() * near_.normal); }
  double tolerance() const {
    return patch::missed_ratio * std::abs(near_.distance) + stepping::missed_look * cores_.size();
  }

  const ConvexPart &part_a_, &part_b_;
  CorePair cores_;
  double reach_;
  ReferenceChoice choice_;
  PairMemory& memory_;
  PartLook& look_;
  NearestFeatures near_;
  double face_lowest_ = 0;  // m: the least gap of the points on a face
};

// The number that names what is nearest of both.
std::uint64_t nearest_name(const CoreFeature& a, const CoreFeature& b) {
  Hasher hasher;
  for (const CoreFeature* feature : {&a, &b}) {
    hasher.add(static_cast<std::uint64_t>(feature->count));
    for (int i = 0; i < feature->count; ++i)
      hasher.add(static_cast<std::uint64_t>(feature->vertex[static_cast<std::size_t>(i)]));
    hasher.add(static_cast<std::uint64_t>(feature->face + 1));
  }
  return hasher.value();
}

LookPoint PolyhedraLook::placed(bool reference_is_a, const Vec3& normal, double offset,
                                const Vec3& core) const {
  const Frame& of_reference = (reference_is_a ? part_a_ : part_b_).placement();
  LookPoint point;
  point.reference_is_a = reference_is_a;
  point.normal = of_reference.R * normal;
  point.offset = offset + point.normal.dot(of_reference.p);
  point.core = (reference_is_a ? part_b_ : part_a_).placement() * core;
  return point;
}

bool PolyhedraLook::is_apart_along_axis() {
  const Vec3& n = memory_.axis;
  if (n == Vec3::Zero()) return false;
  const Frame& placed = cores_.b_in_a;
  memory_.support_a = cores_.a.support(n, memory_.support_a);
  memory_.support_b = cores_.b.support(-(placed.R.transpose() * n), memory_.support_b);
  look_.distance = n.dot(placed * cores_.b.vertex(memory_.support_b)) -
                   n.dot(cores_.a.vertex(memory_.support_a));
  return look_.distance > reach_;
}

// Measures the face along which they were sunk last.
void PolyhedraLook::measure(LeastAxis& axis) const {
  const Frame& placed = cores_.b_in_a;
  if (axis.kind == AxisKind::face_a) {
    const Polyhedron::Face& face = cores_.a.face(axis.feature_a);
    axis.normal = face.normal;
    axis.feature_b = cores_.b.support(-(placed.R.transpose() * face.normal), axis.feature_b);
    axis.distance = face.normal.dot(placed * cores_.b.vertex(axis.feature_b)) - face.offset;
  } else {
    const Polyhedron::Face& face = cores_.b.face(axis.feature_b);
    axis.normal = -(placed.R * face.normal);
    axis.feature_a = cores_.a.support(axis.normal, axis.feature_a);
    axis.distance = face.normal.dot(placed.to_local(cores_.a.vertex(axis.feature_a))) - face.offset;
  }
}

bool PolyhedraLook::lies_on_known_face() {
  if (!memory_.is_sunk || memory_.least.kind == AxisKind::edges) return false;
  LeastAxis axis = memory_.least;
  measure(axis);
  const double size = std::min(cores_.a.radius(), cores_.b.radius());
  if (!(axis.distance <= 0 && axis.distance > -stepping::sunk_a_little * size)) return false;
  sink(axis);
  use_face(axis.kind == AxisKind::face_a);
  return face_lowest_ <= near_.distance + tolerance();
}

void PolyhedraLook::sink(const LeastAxis& axis) {
  memory_.is_sunk = true;
  memory_.least = axis;
  near_ = nearest_on_axis(cores_.a, cores_.b, cores_.b_in_a, axis);
}

void PolyhedraLook::find_axis() {
  const double touch = touch_ratio * cores_.size();
  if (memory_.is_sunk) {
    LeastAxis known = memory_.least;
    const bool is_edges = known.kind == AxisKind::edges;
    if (!is_edges) measure(known);
    const LeastAxis axis =
        least_axis(cores_.a, cores_.b, cores_.b_in_a, 0, is_edges ? nullptr : &known);
    if (axis.distance <= 0) return sink(axis);
    memory_.simplex.count = 0;
  }
  const CoreDistance core = core_distance(cores_.a, cores_.b, cores_.b_in_a, &memory_.simplex);
  if (!core.overlap && core.distance > touch) {
    memory_.is_sunk = false;
    near_ = nearest_of_simplex(core, memory_.simplex);
    return;
  }
  memory_.simplex.count = 0;
  const Climb climb = climb_to_axis(cores_.a, cores_.b, cores_.b_in_a);
  if (climb.end == ClimbEnd::proven) return sink(climb.axis);
  sink(least_axis(cores_.a, cores_.b, cores_.b_in_a, 0,
                  climb.end == ClimbEnd::local ? &climb.axis : nullptr));
}

// The points on one face of the reference, into `look`.
void PolyhedraLook::use_face(bool of_a) {
  thread_local FaceLook face;
  const Polyhedron& reference = of_a ? cores_.a : cores_.b;
  const Polyhedron& incident = of_a ? cores_.b : cores_.a;
  const Frame placed_other = of_a ? cores_.b_in_a : cores_.a_in_b();
  int& number = of_a ? memory_.face_a : memory_.face_b;
  int& other = of_a ? memory_.face_b : memory_.face_a;
  if (const int known = of_a ? near_.a.face : near_.b.face; known >= 0) number = known;
  const Polyhedron::Face& plane = reference.face(number);
  const Vec3 down = -(placed_other.R.transpose() * plane.normal);
  if (other < 0) other = incident.face_at_vertex(incident.support(down, 0), down);
  other = face_along(incident, down, other);
  look_at_face(reference, number, incident, placed_other, other, reach_, face);
  look_.count = 0;
  look_.on_face = face.of_vertices;
  look_.room = face.room;
  face_lowest_ = face.lowest;
  for (const FacePoint& p : face.points) {
    const bool is_vertex = p.key >> 60 == vertex_point;
    const Vec3 core =
        is_vertex ? incident.vertex(static_cast<int>(p.key)) : placed_other.to_local(p.point);
    LookPoint point = placed(of_a, plane.normal, plane.offset, core);
    point.gap = p.gap;
    point.feature = mix64(p.key + (static_cast<std::uint64_t>(number) << 48)) ^ (of_a ? 0 : 1);
    look_.add(point);
  }
}

bool PolyhedraLook::takes_face_of_a(double along_a, double along_b) const {
  const bool a_is_along = along_a >= patch::aligned, b_is_along = along_b >= patch::aligned;
  if (a_is_along != b_is_along) return a_is_along;
  if (choice_ != ReferenceChoice::larger) return choice_ == ReferenceChoice::of_a;
  return cores_.b.face(memory_.face_b).area <=
         patch::clearly_larger * cores_.a.face(memory_.face_a).area;
}

// The nearest features alone: the plane between them, as the one of A.
void PolyhedraLook::add_nearest() {
  const Vec3& n = near_.normal;
  LookPoint point = placed(true, n, n.dot(near_.point_a), cores_.b_in_a.to_local(near_.point_b));
  point.gap = near_.distance;
  point.feature = nearest_name(near_.a, near_.b);
  look_.add(point);
  look_.on_face = false;
}

void PolyhedraLook::add_points() {
  const Vec3& n = near_.normal;
  const Vec3 down = against();
  if (memory_.face_a < 0) memory_.face_a = cores_.a.face_at_vertex(cores_.a.support(n, 0), n);
  if (memory_.face_b < 0) memory_.face_b = cores_.b.face_at_vertex(cores_.b.support(down, 0), down);
  memory_.face_a = face_along(cores_.a, n, memory_.face_a);
  memory_.face_b = face_along(cores_.b, down, memory_.face_b);
  const double along_a = cores_.a.face(memory_.face_a).normal.dot(n);
  const double along_b = cores_.b.face(memory_.face_b).normal.dot(down);
  if (std::max(along_a, along_b) >= patch::aligned) {
    use_face(takes_face_of_a(along_a, along_b));
    if (face_lowest_ <= near_.distance + tolerance()) return;
  }
  add_nearest();
}

void PolyhedraLook::look() {
  if (is_apart_along_axis()) {
    look_.axis = cores_.world_a.R * memory_.axis;
    return;
  }
  if (!lies_on_known_face()) {
    look_.count = 0;
    find_axis();
    if (near_.distance <= reach_) add_points();
  }
  memory_.axis = near_.normal;
  look_.axis = cores_.world_a.R * near_.normal;
  look_.distance = near_.distance;
}

}  // namespace

void look_at_polyhedra(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                       const Frame& frame_b, double reach, ReferenceChoice choice,
                       PairMemory& memory, PartLook& look) {
  PolyhedraLook(a, frame_a, b, frame_b, reach, choice, memory, look).look();
}

}  // namespace tw
