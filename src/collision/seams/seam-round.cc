// A frustum or an ellipsoid at a seam.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "collision/distance/separation.h"
#include "collision/seams/seam-pair.h"
#include "collision/seams/seams.h"
#include "collision/seams/valley.h"

namespace tw {

namespace {

bool buries(const SeamPair& seam, bool on_a, const RoundDistance& near) {
  return seam.buries(on_a, on_a ? near.point_a : near.point_b, near.normal, seam::same_angle);
}

// Of points along a buried axis, leaves what is exposed elsewhere on that side.
void keep_exposed(const SeamPair& seam, bool on_a, std::size_t from,
                  std::vector<ManifoldPoint>& out) {
  const auto first_new = out.begin() + static_cast<std::ptrdiff_t>(from);
  out.erase(
      std::remove_if(first_new, out.end(), [&](const auto& p) { return p.reference_is_a != on_a; }),
      out.end());
  seam.remove_ghosts(from, seam::same_angle, out);
}

// Whether the part of a (or of b) or a neighbour of it holds a point of the other body.
bool holds(const SeamPair& seam, bool of_a, const Vec3& point) {
  const auto held_by = [&](const SeamNeighbour& q) {
    return tw::holds(q, point, -seam::same_point * seam.size);
  };
  const std::vector<SeamNeighbour>& others = seam.neighbours(of_a);
  return held_by({of_a ? &seam.first() : &seam.second(), (of_a ? seam.a : seam.b).frame}) ||
         std::any_of(others.begin(), others.end(), held_by);
}

// Where a round part of the other side lies over or under what a face goes on by beneath its
// neighbours: its points on that plane (valley.h).
void add_in_valleys(const SeamPair& seam, bool of_a, std::size_t from,
                    std::vector<ManifoldPoint>& out) {
  const SeamSide &side = of_a ? seam.a : seam.b, &round_side = of_a ? seam.b : seam.a;
  const ConvexPart& part = of_a ? seam.first() : seam.second();
  const ConvexPart& round = of_a ? seam.second() : seam.first();
  if (part.kind != PartKind::polyhedron || !side.has_seams) return;
  const Polyhedron& core = *part.core;
  const Frame world = part.in(side.frame);
  const SupportCore support(round, round.in(round_side.frame));
  const Vec3 middle = world.to_local(support.center());
  const double same_place = seam::buried_margin * seam.size;
  const auto is_known = [&](const Vec3& point, double gap) {
    return std::any_of(out.begin() + static_cast<std::ptrdiff_t>(from), out.end(), [&](auto& p) {
      const Vec3 there = p.core_point - p.radius * p.normal;
      return p.gap <= gap + same_place && (there - point).norm() <= same_place;
    });
  };
  thread_local std::vector<ManifoldPoint> points;
  for (std::size_t f = 0; f < core.faces().size(); ++f) {
    const Polyhedron::Face& face = core.faces()[f];
    if (face.normal.dot(middle) <= face.offset) continue;
    const Vec3 lowest = world.to_local(support.support(world.R * Vec3(-face.normal))) -
                        support.margin * face.normal;
    const double height = face.normal.dot(lowest) - face.offset;
    if (height < -seam::sunk * seam.size || height > seam.reach) continue;
    const auto goes_on = [&](const Vec3& point) {
      return goes_on_to(core, face, point, middle, world, seam.neighbours(of_a), seam.farthest(),
                        seam.size);
    };
    if (!goes_on(lowest) || is_known(world * lowest, height)) continue;
    ConvexPart plane;
    plane.kind = PartKind::half_space;
    plane.normal = face.normal;
    plane.offset = face.offset;
    points.clear();
    if (of_a)
      part_manifold(plane, world, round, round_side.frame, seam.reach, seam.choice, seam.pair,
                    points);
    else
      part_manifold(round, round_side.frame, plane, world, seam.reach, seam.choice, seam.pair,
                    points);
    for (ManifoldPoint& p : points) {
      if (!goes_on(world.to_local(p.core_point - p.radius * p.normal))) continue;
      p.feature =
          feature_name(seam.pair, of_a ? FeatureMode::exposed_of_a : FeatureMode::exposed_of_b,
                       {f, p.feature, 0});
      out.push_back(p);
    }
  }
}

// A polyhedron scaled about its center.
Polyhedron scaled_down(const Polyhedron& whole, double factor) {
  std::vector<Vec3> vertices;
  for (const Vec3& v : whole.vertices())
    vertices.push_back(whole.center() + factor * (v - whole.center()));
  std::vector<std::vector<int>> faces;
  for (const Polyhedron::Face& face : whole.faces()) {
    faces.emplace_back();
    for (int i = 0; i < face.count; ++i) faces.back().push_back(whole.corner(face.first + i));
  }
  return {std::move(vertices), faces};
}

// What is nearest with the part of the other side scaled down, where the neighbours of a (or of b)
// bury the axis of least depth.
void add_shrunk(const SeamPair& seam, bool of_a, std::vector<ManifoldPoint>& out) {
  const ConvexPart& first = seam.first();
  const ConvexPart& second = seam.second();
  const std::size_t from = out.size();
  for (double factor : seam::shrinking) {
    SupportCore core_a(first, first.in(seam.a.frame));
    SupportCore core_b(second, second.in(seam.b.frame));
    SupportCore& scaled = of_a ? core_b : core_a;
    const Vec3 center = scaled.center();
    std::optional<Polyhedron> smaller;
    if (scaled.polyhedron)
      scaled.polyhedron = &smaller.emplace(scaled_down(*scaled.polyhedron, factor));
    scaled.scale(factor);
    RoundDistance near = round_distance(core_a, core_b);
    if (!(near.distance > 0)) continue;
    if (buries(seam, of_a, near)) return;
    // the same point of the part itself
    Vec3& point = of_a ? near.point_b : near.point_a;
    point = center + (point - center) / factor;
    near.distance = near.normal.dot(near.point_b - near.point_a);
    if (near.distance > seam.reach) return;
    // a depth that is real: half of it farther out the parts still hold the point
    const Vec3 outward = of_a ? near.normal : Vec3(-near.normal);
    if (near.distance < 0 && !holds(seam, of_a, point - 0.5 * near.distance * outward)) return;
    round_manifold(first, seam.a.frame, second, seam.b.frame, near, seam.reach, seam.pair, out);
    seam.remove_ghosts(from, seam::face_angle, out);
    return;
  }
}

// What is nearest, or what of it the neighbours leave exposed.
void add_reached(const SeamPair& seam, const RoundDistance& near, std::vector<ManifoldPoint>& out) {
  const std::size_t from = out.size();
  round_manifold(seam.first(), seam.a.frame, seam.second(), seam.b.frame, near, seam.reach,
                 seam.pair, out);
  const bool ghost_a = buries(seam, true, near);
  const bool ghost = ghost_a || buries(seam, false, near);
  if (ghost)
    keep_exposed(seam, ghost_a, from, out);
  else
    seam.remove_ghosts(from, seam::face_angle, out);
  const bool sunk = near.distance < seam::sunk * seam.size;
  if (ghost && sunk && out.size() == from) add_shrunk(seam, ghost_a, out);
  if (ghost && sunk && out.size() == from) round_at_edges(seam, ghost_a, out);
}

}  // namespace

double round_at_seam(const SeamPair& seam, std::vector<ManifoldPoint>& out) {
  const std::size_t from = out.size();
  const Separation s =
      part_separation(seam.first(), seam.a.frame, seam.second(), seam.b.frame, nullptr);
  if (s.distance > seam.farthest()) return s.distance;
  if (s.distance <= seam.reach)
    add_reached(seam, {s.distance, s.normal, s.point_a, s.point_b}, out);
  for (const bool of_a : {true, false}) add_in_valleys(seam, of_a, from, out);
  return s.distance;
}

}  // namespace tw
