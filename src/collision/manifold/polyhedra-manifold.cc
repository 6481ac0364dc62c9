// Contact manifolds of two polyhedra, and of a polyhedron and a half-space.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "collision/manifold/face-contact.h"
#include "collision/manifold/manifold-parts.h"
#include "collision/seams/seam-pair.h"

namespace tw {

namespace {

struct AlignedFace {
  int number = -1;
  double cosine = -2;
};

// The face at the feature that is most along the unit direction.
AlignedFace aligned_face(const Polyhedron& p, const CoreFeature& feature, const Vec3& direction) {
  if (feature.face >= 0) return {feature.face, p.face(feature.face).normal.dot(direction)};
  AlignedFace best;
  const auto look_at = [&](int face) {
    const double cosine = p.face(face).normal.dot(direction);
    if (cosine > best.cosine) best = {face, cosine};
  };
  // a face at one end of an edge has nothing of the rest of it
  if (feature.count == 2)
    for (const Polyhedron::Link& link : p.links(feature.vertex[0])) {
      if (link.vertex != feature.vertex[1]) continue;
      const Polyhedron::Edge& edge = p.edges()[static_cast<std::size_t>(link.edge)];
      look_at(edge.left);
      look_at(edge.right);
      return best;
    }
  for (int i = 0; i < feature.count; ++i)
    look_at(p.face_at_vertex(feature.vertex[static_cast<std::size_t>(i)], direction));
  return best;
}

bool prefers_b(const Polyhedron::Face& a, const Polyhedron::Face& b, ReferenceChoice choice) {
  if (choice == ReferenceChoice::larger) return b.area > patch::clearly_larger * a.area;
  return choice == ReferenceChoice::of_b;
}

std::uint64_t feature_key(const CoreFeature& f) {
  std::uint64_t key = static_cast<std::uint64_t>(f.count);
  for (int i = 0; i < f.count; ++i)
    key = key << 20 | static_cast<std::uint64_t>(f.vertex[static_cast<std::size_t>(i)]);
  return key;
}

// From end to end of the edge that is the feature; 0 where it is none.
Vec3 ends_of(const Polyhedron& p, const CoreFeature& feature) {
  if (feature.count == 2)
    for (const Polyhedron::Link& link : p.links(feature.vertex[0]))
      if (link.vertex == feature.vertex[1])
        return p.vertex(link.vertex) - p.vertex(feature.vertex[0]);
  return Vec3::Zero();
}

// The nearest features alone: two edges, or a plane through the point of A.
void add_corners(const CorePair& cores, const NearestFeatures& near, int pair,
                 std::vector<ManifoldPoint>& out) {
  ManifoldPoint p;
  p.normal = cores.world_a.R * near.normal;
  p.core_point = cores.world_a * near.point_b;
  p.gap = near.distance;
  p.reference_point = p.core_point - p.gap * p.normal;
  p.pair = pair;
  p.follow_lines(cores.world_a.R * ends_of(cores.a, near.a),
                 cores.world_a.R * (cores.b_in_a.R * ends_of(cores.b, near.b)));
  const std::uint64_t face = static_cast<std::uint64_t>(std::max(near.a.face, near.b.face) + 1);
  p.feature =
      feature_name(pair, FeatureMode::corners, {feature_key(near.a), feature_key(near.b), face});
  out.push_back(p);
}

// An edge at a nearest feature that lies across the axis.
struct LevelEdge {
  int number = -1;
  Vec3 tail, along;  // along: a unit; both in the frame of A
  double length = 0;
};

// The edge that is the feature, or those that end in it.
void level_edges(const Polyhedron& p, const CoreFeature& feature, const Frame& in_a,
                 const Vec3& axis, std::vector<LevelEdge>& out) {
  out.clear();
  if (feature.count < 1 || feature.count > 2) return;
  for (const Polyhedron::Link& link : p.links(feature.vertex[0])) {
    if (feature.count == 2 && link.vertex != feature.vertex[1]) continue;
    const Polyhedron::Edge& edge = p.edges()[static_cast<std::size_t>(link.edge)];
    const Vec3 tail = in_a * p.vertex(edge.tail), ends = in_a * p.vertex(edge.head) - tail;
    const double length = ends.norm();
    if (std::abs(ends.dot(axis)) > patch::aligned_sine * length) continue;
    out.push_back({link.edge, tail, ends / length, length});
  }
}

// How far, along the unit axis, a point lies over the two faces of an edge.
double height_over(const Polyhedron& p, int edge, const Vec3& point, const Vec3& axis) {
  const Polyhedron::Edge& e = p.edges()[static_cast<std::size_t>(edge)];
  double height = -1e300;
  for (const int f : {e.left, e.right}) {
    const Polyhedron::Face& face = p.face(f);
    const double cosine = face.normal.dot(axis);
    if (cosine > 0) height = std::max(height, (face.normal.dot(point) - face.offset) / cosine);
  }
  return height;
}

// Edges that lie along each other, as those at the top of two cards that lean on each other: a
// point at either end of what they share, or they would turn about a single one.
bool add_edges(const CorePair& cores, const NearestFeatures& near, double reach, int pair,
               std::vector<ManifoldPoint>& out) {
  thread_local std::vector<LevelEdge> edges_a, edges_b;
  level_edges(cores.a, near.a, Frame(), near.normal, edges_a);
  if (edges_a.empty()) return false;
  level_edges(cores.b, near.b, cores.b_in_a, near.normal, edges_b);
  const LevelEdge *a = nullptr, *b = nullptr;
  double least = patch::aligned_sine;
  for (const LevelEdge& of_a : edges_a)
    for (const LevelEdge& of_b : edges_b) {
      const double sine = of_a.along.cross(of_b.along).norm();
      if (sine >= least) continue;
      least = sine;
      a = &of_a;
      b = &of_b;
    }
  if (!a) return false;

  const double turn = a->along.dot(b->along) < 0 ? -1 : 1;
  const double start = (b->tail - a->tail).dot(a->along), end = start + turn * b->length;
  const double from = std::max(0.0, std::min(start, end));
  const double to = std::min(a->length, std::max(start, end));
  const double size = cores.a.radius() + cores.b.radius();
  const double near_at = (near.point_a - a->tail).dot(a->along), slack = coincident_ratio * size;
  if (!(to - from > slack) || near_at < from - slack || near_at > to + slack) return false;
  const Frame a_in_b = cores.a_in_b();
  const Vec3 down = -(a_in_b.R * near.normal);
  double deepest = 1e300;
  const std::size_t before = out.size();
  thread_local std::vector<FacePoint> higher;
  higher.clear();
  for (const double at : {from, to}) {
    const Vec3 on_a = a->tail + at * a->along;
    const Vec3 on_b = b->tail + turn * (at - start) * b->along;
    ManifoldPoint p;
    p.gap = std::min(height_over(cores.a, a->number, on_b, near.normal),
                     height_over(cores.b, b->number, a_in_b * on_a, down));
    deepest = std::min(deepest, p.gap);
    if (p.gap > reach) {
      higher.push_back({cores.world_a * on_b, p.gap});
      continue;
    }
    p.normal = cores.world_a.R * near.normal;
    p.core_point = cores.world_a * on_b;
    p.reference_point = p.core_point - p.gap * p.normal;
    p.pair = pair;
    p.feature = feature_name(pair, FeatureMode::along_edges,
                             {static_cast<std::uint64_t>(a->number),
                              static_cast<std::uint64_t>(b->number), at == from ? 0U : 1U});
    out.push_back(p);
  }
  lie_on_each_other(1, patch::aligned_sine, higher, before, out);
  return deepest <=
         near.distance + patch::missed_ratio * std::abs(near.distance) + patch::missed_floor * size;
}

// An edge of a face; in the frame of the reference.
struct Border {
  Vec3 normal, inward;  // of the face; square to the edge
};

// The incident edge that the name of a crossing holds.
Border incident_border(const Polyhedron& incident, int face_number, const Frame& placed,
                       std::uint64_t key) {
  const int low = static_cast<int>(key >> 40 & 0xfffff),
            high = static_cast<int>(key >> 20 & 0xfffff);
  const Polyhedron::Face& face = incident.face(face_number);
  int side = face.first;
  for (int i = face.first; i < face.first + face.count; ++i) {
    const Polyhedron::Edge& edge =
        incident.edges()[static_cast<std::size_t>(incident.side(i).edge)];
    if (std::min(edge.tail, edge.head) == low && std::max(edge.tail, edge.head) == high) side = i;
  }
  return {placed.R * face.normal, placed.R * incident.side(side).inward};
}

// Whether no neighbour goes on beyond the border, at a point of it (world): its normals lean
// outward then, by as much as `normal` leans to either way.
bool is_exposed(const Border& border, const Frame& world, const Vec3& point, const Vec3& normal,
                bool on_a, const SeamPair& seam) {
  const double sine = std::abs(normal.dot(border.inward));
  const Vec3 outward = std::sqrt(1 - sine * sine) * border.normal - sine * border.inward;
  return !seam.buries(on_a, point, world.R * (on_a ? outward : Vec3(-outward)), seam::same_angle);
}

// How much of a lean of the normal counts, by its sine.
double share_of(double lean) {
  return std::clamp((lean - seam::least_lean) / (seam::full_lean - seam::least_lean), 0.0, 1.0);
}

// A crossing wanders along both the edge and the border: the normal stands on both, so that no
// sliding parts the two or pushes them together.  Left as it is, with the face's normal, where
// that is too far off, or one of the two is none because a neighbour goes on beyond it.
void stand_on_edges(const Border& border, const Border& edge, const Frame& world,
                    const SeamPair* seam, ManifoldPoint& p) {
  const Vec3 along = border.normal.cross(border.inward),
             edge_along = edge.normal.cross(edge.inward);
  const Vec3 across = along.cross(edge_along).normalized();
  const Vec3 normal = across.dot(border.normal) < 0 ? Vec3(-across) : across;
  const double lean = normal.dot(border.inward);
  if (!(std::abs(lean) <= seam::along_edge)) return;
  const double share = share_of(std::abs(lean));
  if (share == 0) return;
  const bool on_a = p.reference_is_a;
  if (seam && !(is_exposed(border, world, p.reference_point, normal, on_a, *seam) &&
                is_exposed(edge, world, p.core_point, -normal, !on_a, *seam)))
    return;
  const double sine = share * lean;
  const Vec3 leaning = sine * border.inward + std::sqrt(1 - sine * sine) * border.normal;
  p.gap *= leaning.dot(border.normal);
  p.normal = world.R * leaning;
  p.reference_point = p.core_point - p.gap * p.normal;
}

// A corner of the reference face presses on the incident face: along the normal of that, or what
// slides would rise or sink with every step aside.
void stand_on_face(const Vec3& face_normal, const Vec3& incident_normal, const Frame& world,
                   const SeamPair* seam, ManifoldPoint& p) {
  const double cosine = -incident_normal.dot(face_normal);
  const Vec3 aside = -incident_normal - cosine * face_normal;
  const double lean = aside.norm();
  if (!(lean <= seam::along_edge && cosine > 0)) return;
  const double share = share_of(lean);
  if (share == 0) return;
  const bool on_a = p.reference_is_a;
  if (seam)
    for (const double to : {-1.0, 1.0}) {
      const Vec3 outward = world.R * (cosine * face_normal + to * aside);
      if (seam->buries(on_a, p.reference_point, on_a ? outward : Vec3(-outward), seam::same_angle))
        return;
    }
  const double sine = share * lean;
  const Vec3 leaning = world.R * (std::sqrt(1 - sine * sine) * face_normal + share * aside);
  std::swap(p.core_point, p.reference_point);
  p.gap *= leaning.dot(p.normal);
  p.normal = -leaning;
  p.reference_is_a = !p.reference_is_a;
}

// A face of one as reference; `reference_is_a` says of which.
void add_face(const CorePair& cores, bool reference_is_a, int face, int incident_face,
              const NearestFeatures& near, double reach, int pair, const SeamPair* seam,
              std::vector<ManifoldPoint>& out) {
  thread_local std::vector<FacePoint> points;
  const Polyhedron& reference = reference_is_a ? cores.a : cores.b;
  const Polyhedron& incident = reference_is_a ? cores.b : cores.a;
  const Frame placed = reference_is_a ? cores.b_in_a : cores.a_in_b();
  const Frame world = reference_is_a ? cores.world_a : cores.world_a * cores.b_in_a;
  thread_local std::vector<FacePoint> higher;
  face_contact(reference, face, incident, placed, incident_face, reach, patch::most_points, points,
               higher);

  // what the face does not show of the distance, its features do
  const std::size_t before = out.size();
  double least = 1e300;
  for (const FacePoint& p : points) least = std::min(least, p.gap);
  const double allowed = patch::missed_ratio * std::abs(near.distance) +
                         patch::missed_floor * (cores.a.radius() + cores.b.radius());
  if (!(least <= near.distance + allowed)) {
    thin_face_points(points, patch::most_points - 1, reach);
    add_corners(cores, near, pair, out);
  }

  for (const FacePoint& found : points) {
    ManifoldPoint p;
    p.reference_is_a = reference_is_a;
    const Vec3& face_normal = reference.face(found.face).normal;
    p.normal = world.R * face_normal;
    p.pair = pair;
    p.core_point = world * found.point;
    p.gap = found.gap;
    p.reference_point = p.core_point - found.gap * p.normal;
    p.feature = feature_name(pair, FeatureMode::face,
                             {static_cast<std::uint64_t>(found.face),
                              static_cast<std::uint64_t>(reference_is_a), found.key});
    if (found.key >> 60 == edge_crossing)
      stand_on_edges({face_normal, reference.side(static_cast<int>(found.key & 0xfffff)).inward},
                     incident_border(incident, found.incident, placed, found.key), world, seam, p);
    if (found.key >> 60 == face_corner)
      stand_on_face(face_normal, placed.R * incident.face(found.incident).normal, world, seam, p);
    out.push_back(p);
  }
  for (FacePoint& p : higher) p.point = world * p.point;
  // either face may be the reference
  const Vec3 axis = reference_is_a ? near.normal : cores.b_in_a.R.transpose() * near.normal;
  const Vec3 incident_normal = placed.R * incident.face(incident_face).normal;
  const double sine =
      std::min(axis.cross(reference.face(face).normal).norm(), axis.cross(incident_normal).norm());
  lie_on_each_other(1 - sine / patch::aligned_sine, patch::aligned_sine, higher, before, out);
}

}  // namespace

void features_manifold(const CorePair& cores, const NearestFeatures& near, double reach,
                       ReferenceChoice choice, int pair, const SeamPair* seam,
                       std::vector<ManifoldPoint>& out) {
  const Vec3 down = -(cores.b_in_a.R.transpose() * near.normal);
  const AlignedFace face_a = aligned_face(cores.a, near.a, near.normal);
  const AlignedFace face_b = aligned_face(cores.b, near.b, down);
  const bool of_a = face_a.cosine >= patch::aligned;
  const bool of_b = face_b.cosine >= patch::aligned;
  if (!of_a && !of_b) {
    if (!add_edges(cores, near, reach, pair, out)) add_corners(cores, near, pair, out);
    return;
  }
  const bool reference_is_a = of_a && !(of_b && prefers_b(cores.a.face(face_a.number),
                                                          cores.b.face(face_b.number), choice));
  add_face(cores, reference_is_a, reference_is_a ? face_a.number : face_b.number,
           reference_is_a ? face_b.number : face_a.number, near, reach, pair, seam, out);
}

void polyhedra_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                        const Frame& frame_b, double reach, ReferenceChoice choice, int pair,
                        std::vector<ManifoldPoint>& out) {
  const CorePair cores(a, frame_a, b, frame_b);
  const NearestFeatures near = nearest_features(cores.a, cores.b, cores.b_in_a, reach);
  if (near.distance <= reach) features_manifold(cores, near, reach, choice, pair, nullptr, out);
}

void half_space_manifold(const ConvexPart& half_space, const Frame& frame_h,
                         const ConvexPart& polyhedron, const Frame& frame_p, double reach,
                         bool reference_is_a, int pair, std::vector<ManifoldPoint>& out) {
  thread_local std::vector<FacePoint> points;
  const Frame world = polyhedron.in(frame_p);
  ManifoldPoint p;
  p.reference_is_a = reference_is_a;
  p.normal = frame_h.R * half_space.normal;
  p.pair = pair;
  thread_local std::vector<FacePoint> higher;
  points.clear();
  higher.clear();
  const std::size_t before = out.size();
  const int count = static_cast<int>(polyhedron.core->vertices().size());
  for (int v = 0; v < count; ++v) {
    const Vec3 point = world * polyhedron.core->vertex(v);
    const double gap = p.normal.dot(point - frame_h.p) - half_space.offset;
    if (gap <= reach)
      points.push_back({point, gap, static_cast<std::uint64_t>(v)});
    else
      higher.push_back({point, gap});
  }
  thin_face_points(points, patch::most_points, reach);
  for (const FacePoint& found : points) {
    p.core_point = found.point;
    p.gap = found.gap;
    p.reference_point = found.point - found.gap * p.normal;
    p.feature = feature_name(pair, FeatureMode::half_space, {found.key, 0, 0});
    out.push_back(p);
  }
  lie_on_each_other(1, patch::aligned_sine, higher, before, out);
}

}  // namespace tw
