// Contact manifolds without ghosts at seams.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "collision/manifold-parts.h"
#include "collision/separation.h"

namespace tw {

namespace {

// How far a body is scaled down to be apart from the one it overlaps: one of these mostly does.
constexpr double shrinking[] = {0.98, 0.9};

// Bodies nearer than this, relative to the size, may overlap the neighbours of what they are near to.
constexpr double sunk_ratio = 0.01;

// A point this near to a part, relative to the size, is held by it.
constexpr double held_ratio = 1e-5;

// Normals that agree so far are the same, rad.
constexpr double same_angle = 1e-4;

// Points on a face of the other body have its normal, up to 2 degrees from that of the nearest features
// and a little more: rad.
constexpr double face_angle = 0.04;

// One body with what surrounds its parts.
struct Side {
  const Shape& shape;
  const Frame& frame;
  const std::vector<SeamNeighbour>& around;
  bool has_seams;

  Side(const Shape& s, const Frame& f, const std::vector<SeamNeighbour>& neighbours)
      : shape(s), frame(f), around(neighbours),
        has_seams(!neighbours.empty() || s.parts().size() > 1) {}

  // The neighbours of one part whose balls come near its own.
  void neighbours_of(std::size_t part, std::vector<SeamNeighbour>& out) const {
    out.clear();
    const ConvexPart& here = shape.parts()[part];
    const Vec3 center = frame * here.bound_center;
    const auto add = [&](const SeamNeighbour& q) {
      const double near = (q.part->bound_radius + here.bound_radius) * (1 + 1e-6);
      const bool apart = (q.frame * q.part->bound_center - center).squaredNorm() > near * near;
      if (!apart) out.push_back(q);
    };
    for (std::size_t i = 0; i < shape.parts().size(); ++i)
      if (i != part) add({&shape.parts()[i], frame});
    for (const SeamNeighbour& q : around) add(q);
  }
};

// A pair of parts at a seam of one of them.
struct SeamPair {
  const Side& a;
  const Side& b;
  std::size_t part_a, part_b;
  double reach, size;
  ReferenceChoice choice;
  int pair;
  // the neighbours of the part of a and of b, once they are asked for
  std::vector<SeamNeighbour>* lists[2];
  mutable bool listed[2] = {false, false};

  const std::vector<SeamNeighbour>& neighbours(bool of_a) const {
    const std::size_t side = of_a ? 0 : 1;
    if (!listed[side]) (of_a ? a : b).neighbours_of(of_a ? part_a : part_b, *lists[side]);
    listed[side] = true;
    return *lists[side];
  }

  const ConvexPart& first() const { return a.shape.parts()[part_a]; }
  const ConvexPart& second() const { return b.shape.parts()[part_b]; }

  // Whether the neighbours of a's part (or b's) bury the point; the normal is from a to b, world.
  bool buries(bool on_a, const Vec3& point, const Vec3& normal, double angle) const {
    const Side& side = on_a ? a : b;
    if (!side.has_seams) return false;
    return buried_edge(on_a ? first() : second(), side.frame, point,
                       on_a ? normal : Vec3(-normal), neighbours(on_a), size, angle);
  }

  bool is_ghost(const ManifoldPoint& p, double angle) const {
    const Vec3 on_reference = p.reference_point + p.reference_radius * p.normal;
    const Vec3 on_other = p.core_point - p.radius * p.normal;
    const Vec3 normal = p.reference_is_a ? p.normal : Vec3(-p.normal);
    return buries(p.reference_is_a, on_reference, normal, angle) ||
           buries(!p.reference_is_a, on_other, normal, angle);
  }

  void remove_ghosts(std::size_t from, double angle, std::vector<ManifoldPoint>& out) const {
    const auto ghosts =
        std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(from), out.end(),
                       [&](const ManifoldPoint& p) { return is_ghost(p, angle); });
    out.erase(ghosts, out.end());
  }

  // Whether the nearest features are buried on the side of a (or of b).
  bool buries_features(bool on_a, const CorePair& cores, const NearestFeatures& near) const {
    return buries(on_a, cores.world_a * (on_a ? near.point_a : near.point_b),
                  cores.world_a.R * near.normal, same_angle);
  }
  bool buries_features(bool on_a, const RoundDistance& near) const {
    return buries(on_a, on_a ? near.point_a : near.point_b, near.normal, same_angle);
  }

  // Of points along a buried axis, leaves what is exposed elsewhere on that side.
  void keep_exposed(bool on_a, std::size_t from, std::vector<ManifoldPoint>& out) const {
    const auto first_new = out.begin() + static_cast<std::ptrdiff_t>(from);
    out.erase(std::remove_if(first_new, out.end(),
                             [&](const auto& p) { return p.reference_is_a != on_a; }),
              out.end());
    remove_ghosts(from, same_angle, out);
  }

  // Whether the part of a (or of b) or a neighbour of it holds a point of the other body.
  bool holds(bool of_a, const Vec3& point) const {
    const auto held_by = [&](const SeamNeighbour& q) {
      return height_over(q, point) <= held_ratio * size;
    };
    const std::vector<SeamNeighbour>& others = neighbours(of_a);
    return held_by({of_a ? &first() : &second(), (of_a ? a : b).frame}) ||
           std::any_of(others.begin(), others.end(), held_by);
  }

  // The features of a (or of b) that are nearest with the other body scaled down.
  void add_shrunk(const CorePair& cores, bool of_a, std::vector<ManifoldPoint>& out) const {
    const std::size_t from = out.size();
    for (double factor : shrinking) {
      NearestFeatures near;
      if (!shrunk_features(cores, of_a, factor, near)) continue;
      if (near.distance > reach || buries_features(of_a, cores, near)) return;
      // a depth that is real: half of it farther out the parts still hold the point
      const Vec3 half = 0.5 * near.distance * near.normal;
      const Vec3 lifted = of_a ? Vec3(near.point_b - half) : Vec3(near.point_a + half);
      if (near.distance < 0 && !holds(of_a, cores.world_a * lifted)) return;
      features_manifold(cores, near, reach, choice, pair, out);
      remove_ghosts(from, face_angle, out);
      return;
    }
  }

  // False where scaling by the factor is not enough.
  static bool shrunk_features(const CorePair& cores, bool of_a, double factor,
                              NearestFeatures& near) {
    if (of_a) return features_of_shrunk(cores.a, cores.b, cores.b_in_a, factor, near);
    if (!features_of_shrunk(cores.b, cores.a, cores.a_in_b(), factor, near)) return false;
    std::swap(near.a, near.b);
    const Vec3 on_b = near.point_a;
    near.point_a = cores.b_in_a * near.point_b;
    near.point_b = cores.b_in_a * on_b;
    near.normal = -(cores.b_in_a.R * near.normal);
    return true;
  }

  void add_polyhedra(std::vector<ManifoldPoint>& out) const {
    const std::size_t from = out.size();
    const CorePair cores(first(), a.frame, second(), b.frame);
    const NearestFeatures near = nearest_features(cores.a, cores.b, cores.b_in_a, reach);
    if (near.distance > reach) return;
    features_manifold(cores, near, reach, choice, pair, out);
    const bool ghost_a = buries_features(true, cores, near);
    const bool ghost = ghost_a || buries_features(false, cores, near);
    if (!ghost) return remove_ghosts(from, face_angle, out);
    keep_exposed(ghost_a, from, out);
    const bool sunk = near.distance < sunk_ratio * size;
    if (sunk && out.size() == from) add_shrunk(cores, ghost_a, out);
  }

  // As add_shrunk, for a cylinder that the features of a (or of b) meet.
  void add_shrunk_cylinder(bool of_a, std::vector<ManifoldPoint>& out) const {
    if ((of_a ? second() : first()).kind != PartKind::cylinder) return;
    const std::size_t from = out.size();
    for (double factor : shrinking) {
      SupportCore core_a(first(), a.frame * first().placement);
      SupportCore core_b(second(), b.frame * second().placement);
      SupportCore& scaled = of_a ? core_b : core_a;
      scaled.radius *= factor;
      scaled.half_length *= factor;
      RoundDistance near = round_distance(core_a, core_b);
      if (!(near.distance > 0)) continue;
      if (buries_features(of_a, near)) return;
      // the same point of the cylinder itself
      Vec3& point = of_a ? near.point_b : near.point_a;
      point = scaled.place.p + (point - scaled.place.p) / factor;
      near.distance = near.normal.dot(near.point_b - near.point_a);
      if (near.distance > reach) return;
      const Vec3 outward = of_a ? near.normal : Vec3(-near.normal);
      if (near.distance < 0 && !holds(of_a, point - 0.5 * near.distance * outward)) return;
      round_manifold(first(), a.frame, second(), b.frame, near, reach, pair, out);
      remove_ghosts(from, face_angle, out);
      return;
    }
  }

  void add_cylinders(std::vector<ManifoldPoint>& out) const {
    const std::size_t from = out.size();
    const Separation s = part_separation(first(), a.frame, second(), b.frame, nullptr);
    if (s.distance > reach) return;
    const RoundDistance near{s.distance, s.normal, s.point_a, s.point_b};
    round_manifold(first(), a.frame, second(), b.frame, near, reach, pair, out);
    const bool ghost_a = buries_features(true, near);
    const bool ghost = ghost_a || buries_features(false, near);
    if (!ghost) return remove_ghosts(from, face_angle, out);
    keep_exposed(ghost_a, from, out);
    const bool sunk = near.distance < sunk_ratio * size;
    if (sunk && out.size() == from) add_shrunk_cylinder(ghost_a, out);
  }

  void add(std::vector<ManifoldPoint>& out) const {
    const auto has_core = [](const ConvexPart& part) {
      return part.kind == PartKind::polyhedron || part.kind == PartKind::cylinder;
    };
    if (first().kind == PartKind::polyhedron && second().kind == PartKind::polyhedron)
      return add_polyhedra(out);
    if (has_core(first()) && has_core(second())) return add_cylinders(out);
    const std::size_t from = out.size();
    part_manifold(first(), a.frame, second(), b.frame, reach, choice, pair, out);
    remove_ghosts(from, same_angle, out);
  }
};

}  // namespace

void manifold_at_seams(const Shape& a, const Frame& frame_a,
                       const std::vector<SeamNeighbour>& around_a, const Shape& b,
                       const Frame& frame_b, const std::vector<SeamNeighbour>& around_b,
                       double reach, double size, std::vector<ManifoldPoint>& out,
                       ReferenceChoice choice) {
  const Side side_a(a, frame_a, around_a);
  const Side side_b(b, frame_b, around_b);
  thread_local std::vector<SeamNeighbour> near_a, near_b;
  int pair = 0;
  for (std::size_t i = 0; i < a.parts().size(); ++i)
    for (std::size_t j = 0; j < b.parts().size(); ++j, ++pair) {
      const auto first = static_cast<std::ptrdiff_t>(out.size());
      if (far_apart(a.parts()[i], frame_a, b.parts()[j], frame_b, reach)) continue;
      SeamPair{side_a, side_b, i, j, reach, size, choice, pair, {&near_a, &near_b}}.add(out);
      std::sort(out.begin() + first, out.end(),
                [](const auto& p, const auto& q) { return p.feature < q.feature; });
    }
}

}  // namespace tw
