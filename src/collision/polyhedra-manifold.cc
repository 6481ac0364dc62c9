// Contact manifolds of two polyhedra, and of a polyhedron and a half-space.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "collision/face-contact.h"
#include "collision/manifold-parts.h"

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
  for (int i = 0; i < feature.count; ++i) {
    const int f = p.face_at_vertex(feature.vertex[static_cast<std::size_t>(i)], direction);
    const double cosine = p.face(f).normal.dot(direction);
    if (cosine > best.cosine) best = {f, cosine};
  }
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

// The nearest features alone: a plane through the point of A.
void add_corners(const CorePair& cores, const NearestFeatures& near, int pair,
                 std::vector<ManifoldPoint>& out) {
  ManifoldPoint p;
  p.normal = cores.world_a.R * near.normal;
  p.core_point = cores.world_a * near.point_b;
  p.gap = near.distance;
  p.reference_point = p.core_point - p.gap * p.normal;
  p.pair = pair;
  const std::uint64_t face = static_cast<std::uint64_t>(std::max(near.a.face, near.b.face) + 1);
  p.feature =
      feature_name(pair, FeatureMode::corners, {feature_key(near.a), feature_key(near.b), face});
  out.push_back(p);
}

// The direction of the incident edge that the name of a crossing holds.
Vec3 incident_edge(const Polyhedron& incident, const Frame& placed, std::uint64_t key) {
  const Vec3 ends = incident.vertex(static_cast<int>(key >> 20 & 0xfffff)) -
                    incident.vertex(static_cast<int>(key >> 40 & 0xfffff));
  return placed.R * ends.normalized();
}

// `p` as a point of the face's border on the edge that its name holds.
void follow_edge(const Polyhedron& incident, const Frame& placed, const Vec3& face_normal,
                 const Frame& world, std::uint64_t key, ManifoldPoint& p) {
  const Vec3 edge = incident_edge(incident, placed, key);
  const double sine = edge.dot(face_normal);
  if (std::abs(sine) > seam::along_edge) return;
  const Vec3 normal = world.R * (face_normal - sine * edge).normalized();
  std::swap(p.core_point, p.reference_point);
  p.gap *= normal.dot(p.normal);
  p.normal = -normal;
  p.reference_is_a = !p.reference_is_a;
}

// Where both bodies move, a crossing may wander along either edge: the normal stands on both, so
// that no sliding parts the two or pushes them together.
void stand_on_edges(const Polyhedron& reference, int face, const Polyhedron& incident,
                    const Frame& placed, const Frame& world, std::uint64_t key, ManifoldPoint& p) {
  const Vec3& face_normal = reference.face(face).normal;
  const Vec3 border = face_normal.cross(reference.side(static_cast<int>(key & 0xfffff)).inward);
  const Vec3 across = border.cross(incident_edge(incident, placed, key));
  const double length = across.norm(), cosine = across.dot(face_normal) / length;
  if (!(cosine * cosine >= 1 - seam::along_edge * seam::along_edge)) return;
  const Vec3 normal = (cosine > 0 ? 1 / length : -1 / length) * across;
  p.gap *= std::abs(cosine);
  p.normal = world.R * normal;
  p.reference_point = p.core_point - p.gap * p.normal;
}

// Where both bodies move, a corner of the reference face presses on the incident face: along the
// normal of that, or what slides would rise or sink with every step aside.
void stand_on_face(const Vec3& incident_normal, ManifoldPoint& p) {
  std::swap(p.core_point, p.reference_point);
  p.gap *= -incident_normal.dot(p.normal);
  p.normal = incident_normal;
  p.reference_is_a = !p.reference_is_a;
}

// A face of one as reference; `reference_is_a` says of which, `edges_stay` that the other one is
// ground, `both_move` that neither is.
void add_face(const CorePair& cores, bool reference_is_a, bool edges_stay, bool both_move, int face,
              int incident_face, const NearestFeatures& near, double reach, int pair,
              std::vector<ManifoldPoint>& out) {
  thread_local std::vector<FacePoint> points;
  const Polyhedron& reference = reference_is_a ? cores.a : cores.b;
  const Polyhedron& incident = reference_is_a ? cores.b : cores.a;
  const Frame placed = reference_is_a ? cores.b_in_a : cores.a_in_b();
  const Frame world = reference_is_a ? cores.world_a : cores.world_a * cores.b_in_a;
  face_contact(reference, face, incident, placed, incident_face, reach, patch::most_points, points);

  // what the face does not show of the distance, its features do
  double least = 1e300;
  for (const FacePoint& p : points) least = std::min(least, p.gap);
  const double allowed = patch::missed_ratio * std::abs(near.distance) +
                         patch::missed_floor * (cores.a.radius() + cores.b.radius());
  if (!(least <= near.distance + allowed)) {
    thin_face_points(points, patch::most_points - 1);
    add_corners(cores, near, pair, out);
  }

  for (const FacePoint& found : points) {
    ManifoldPoint p;
    p.reference_is_a = reference_is_a;
    p.normal = world.R * reference.face(face).normal;
    p.pair = pair;
    p.core_point = world * found.point;
    p.gap = found.gap;
    p.reference_point = p.core_point - found.gap * p.normal;
    p.feature = feature_name(
        pair, FeatureMode::face,
        {static_cast<std::uint64_t>(face), static_cast<std::uint64_t>(reference_is_a), found.key});
    if (found.key >> 60 == edge_crossing) {
      if (edges_stay)
        follow_edge(incident, placed, reference.face(face).normal, world, found.key, p);
      if (both_move) stand_on_edges(reference, face, incident, placed, world, found.key, p);
    }
    if (found.key >> 60 == face_corner && both_move)
      stand_on_face(world.R * (placed.R * incident.face(incident_face).normal), p);
    out.push_back(p);
  }
}

}  // namespace

void features_manifold(const CorePair& cores, const NearestFeatures& near, double reach,
                       ReferenceChoice choice, int pair, std::vector<ManifoldPoint>& out) {
  const Vec3 down = -(cores.b_in_a.R.transpose() * near.normal);
  const AlignedFace face_a = aligned_face(cores.a, near.a, near.normal);
  const AlignedFace face_b = aligned_face(cores.b, near.b, down);
  const bool of_a = face_a.cosine >= patch::aligned;
  const bool of_b = face_b.cosine >= patch::aligned;
  if (!of_a && !of_b) return add_corners(cores, near, pair, out);
  const bool reference_is_a = of_a && !(of_b && prefers_b(cores.a.face(face_a.number),
                                                          cores.b.face(face_b.number), choice));
  const bool edges_stay =
      choice == (reference_is_a ? ReferenceChoice::of_b : ReferenceChoice::of_a);
  const bool both_move = choice == ReferenceChoice::larger;
  add_face(cores, reference_is_a, edges_stay, both_move,
           reference_is_a ? face_a.number : face_b.number,
           reference_is_a ? face_b.number : face_a.number, near, reach, pair, out);
}

void polyhedra_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                        const Frame& frame_b, double reach, ReferenceChoice choice, int pair,
                        std::vector<ManifoldPoint>& out) {
  const CorePair cores(a, frame_a, b, frame_b);
  const NearestFeatures near = nearest_features(cores.a, cores.b, cores.b_in_a, reach);
  if (near.distance <= reach) features_manifold(cores, near, reach, choice, pair, out);
}

void half_space_manifold(const ConvexPart& half_space, const Frame& frame_h,
                         const ConvexPart& polyhedron, const Frame& frame_p, double reach,
                         bool reference_is_a, int pair, std::vector<ManifoldPoint>& out) {
  thread_local std::vector<FacePoint> points;
  const Frame world = frame_p * polyhedron.placement;
  ManifoldPoint p;
  p.reference_is_a = reference_is_a;
  p.normal = frame_h.R * half_space.normal;
  p.pair = pair;
  points.clear();
  const int count = static_cast<int>(polyhedron.core->vertices().size());
  for (int v = 0; v < count; ++v) {
    const Vec3 point = world * polyhedron.core->vertex(v);
    const double gap = p.normal.dot(point - frame_h.p) - half_space.offset;
    if (gap <= reach) points.push_back({point, gap, static_cast<std::uint64_t>(v)});
  }
  thin_face_points(points, patch::most_points);
  for (const FacePoint& found : points) {
    p.core_point = found.point;
    p.gap = found.gap;
    p.reference_point = found.point - found.gap * p.normal;
    p.feature = feature_name(pair, FeatureMode::half_space, {found.key, 0, 0});
    out.push_back(p);
  }
}

}  // namespace tw
