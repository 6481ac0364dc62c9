// Two polyhedra at a seam.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "base/constants.h"
#include "collision/distance/nearest-to-point.h"
#include "collision/manifold/face-contact.h"
#include "collision/seams/exposed-edges.h"
#include "collision/seams/seam-pair.h"
#include "collision/seams/seams.h"
#include "collision/seams/valley.h"

namespace tw {

namespace {

// What the neighbours of one side leave exposed of it in the other.
struct Exposure {
  const SeamPair& seam;
  const CorePair& cores;
  bool of_a;
  std::size_t from;  // what the pair of parts has begins there
  std::vector<ManifoldPoint>& out;
  const Polyhedron& part = of_a ? cores.a : cores.b;
  const Polyhedron& other = of_a ? cores.b : cores.a;
  const Frame world = of_a ? cores.world_a : cores.world_a * cores.b_in_a;
  const Frame other_in_part = of_a ? cores.b_in_a : cores.a_in_b();
  const Vec3 middle = other_in_part * other.center();

  // Of one side, over a face or edge of the other; lengths in the frame of the part.
  struct Point {
    bool reference_is_a;
    Vec3 normal, core_point;
    double gap;
    // of what meets there
    std::uint64_t first, second, third;
    // edges of the part and of the other that cross, or 0
    Vec3 along = Vec3::Zero(), other_along = Vec3::Zero();
  };

  // False for ghosts.
  bool add(const Point& found) const {
    ManifoldPoint p;
    p.reference_is_a = found.reference_is_a;
    p.normal = world.R * found.normal;
    p.core_point = world * found.core_point;
    p.gap = found.gap;
    p.reference_point = p.core_point - p.gap * p.normal;
    p.pair = seam.pair;
    p.follow_lines(world.R * found.along, world.R * found.other_along);
    const FeatureMode mode = of_a ? FeatureMode::exposed_of_a : FeatureMode::exposed_of_b;
    p.feature = feature_name(seam.pair, mode, {found.first, found.second, found.third});
    if (seam.is_ghost(p, seam::same_angle)) return false;
    out.push_back(p);
    return true;
  }

  static Vec3 ends_of(const Polyhedron& polyhedron, int number) {
    const Polyhedron::Edge& edge = polyhedron.edges()[static_cast<std::size_t>(number)];
    return polyhedron.vertex(edge.head) - polyhedron.vertex(edge.tail);
  }

  // Edges of the part through the other.
  void add_edges() const {
    thread_local std::vector<ExposedPoint> exposed;
    exposed.clear();
    exposed_edges(part, world, other, other_in_part, seam.neighbours(of_a),
                  seam::buried_margin * seam.size, seam.reach, exposed);
    for (const ExposedPoint& p : exposed) {
      const auto edge = static_cast<std::uint64_t>(p.edge),
                 face = static_cast<std::uint64_t>(p.face + 1);
      const auto other_edge = static_cast<std::uint64_t>(p.other_edge + 1);
      if (p.face >= 0)
        add({!of_a, -p.normal, p.point, p.gap, edge, face, other_edge});
      else
        add({of_a, p.normal, p.opposite, p.gap, edge, face, other_edge, ends_of(part, p.edge),
             other_in_part.R * ends_of(other, p.other_edge)});
    }
  }

  // Whether the point, `depth` under a face of the part, is nearer to an exposed face of a
  // neighbour: as behind the edge of a steep ridge.
  bool leaves_by_neighbour(const Vec3& point, double depth) const {
    const Vec3 here = world * point;
    const std::vector<SeamNeighbour>& neighbours = seam.neighbours(of_a);
    thread_local std::vector<SeamNeighbour> others;
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      const SeamNeighbour& q = neighbours[i];
      if (q.part->kind != PartKind::polyhedron) continue;
      const Polyhedron& core = *q.part->core;
      const Frame place = q.part->in(q.frame);
      const Vec3 local = place.to_local(here);
      for (const Polyhedron::Face& face : core.faces()) {
        const double under = face.offset - face.normal.dot(local);
        if (!(under >= 0 && under < depth - same_place())) continue;
        const Vec3 foot = local + under * face.normal;
        if (!over_face(core, face, foot, 0)) continue;
        others = neighbours;
        others[i] = {of_a ? &seam.first() : &seam.second(), (of_a ? seam.a : seam.b).frame};
        // what stands on the face, as a wall on the floor of a pit; seen from over its border, too
        const Vec3 above = place * Vec3(foot + 4 * same_place() * face.normal);
        const Vec3 towards =
            above + seam::crack * seam::probe * seam.size * (world * middle - above).normalized();
        if (std::any_of(others.begin(), others.end(), [&](const SeamNeighbour& covering) {
              return height_over(covering, above) < -2 * same_place() ||
                     height_over(covering, towards) < -2 * same_place();
            }))
          continue;
        if (!buried_edge(*q.part, q.frame, place * foot, place.R * face.normal, others, seam.size))
          return true;
      }
    }
    return false;
  }

  // Whether a place (world) is inside the part or one of the neighbours.
  bool covered(const Vec3& place) const {
    const std::vector<SeamNeighbour>& around = seam.neighbours(of_a);
    const auto holds = [&](const SeamNeighbour& q) {
      return height_over(q, place) < -same_place();
    };
    int face = 0;
    return part.face_separation(world.to_local(place), face) < -same_place() ||
           std::any_of(around.begin(), around.end(), holds);
  }

  double same_place() const { return seam::buried_margin * seam.size; }

  // False also under a face that the middle of the other is not over: it comes from elsewhere.
  bool add_vertex(std::uint64_t v, std::uint64_t face, const Vec3& point, double height) const {
    const Polyhedron::Face& under = part.faces()[face];
    if (under.normal.dot(middle) <= under.offset) return false;
    return add({of_a, under.normal, point, height, v, face, ~std::uint64_t{0}});
  }

  // Vertices of the other, each over or under the face of the part that it is nearest to, or under
  // the one that it leaves the ground by.
  void add_vertices() const {
    for (std::uint64_t v = 0; v < other.vertices().size(); ++v) {
      const Vec3 point = other_in_part * other.vertices()[v];
      int nearest = 0;
      const double height = part.face_separation(point, nearest);
      if (height <= seam.reach && add_vertex(v, static_cast<std::uint64_t>(nearest), point, height))
        continue;
      if (height <= seam::sunk * seam.size) add_under_face(v, point, nearest, height > 0);
    }
  }

  // Vertices of the other beside the part, in a valley: over or under what a face goes on by
  // beneath the neighbours.
  void add_in_valleys() const {
    thread_local std::vector<std::pair<double, std::uint64_t>> heights;
    // most are far over the face that is most towards the other's middle
    int towards = 0;
    part.face_separation(middle, towards);
    const Polyhedron::Face& over = part.face(towards);
    const double clearly = (1 + 1e-9) * seam.farthest();
    for (std::uint64_t v = 0; v < other.vertices().size(); ++v) {
      const Vec3 point = other_in_part * other.vertices()[v];
      if (over.normal.dot(point) - over.offset > clearly) continue;
      int nearest = 0;
      const double beside = part.face_separation(point, nearest);
      if (!(beside > 0 && beside <= seam.farthest())) continue;
      heights.clear();
      for (std::uint64_t f = 0; f < part.faces().size(); ++f) {
        const Polyhedron::Face& face = part.faces()[f];
        const double height = face.normal.dot(point) - face.offset;
        if (height < -seam::sunk * seam.size || height > seam.reach) continue;
        if (goes_on_to(part, face, point, middle, world, seam.neighbours(of_a), seam.farthest(),
                       seam.size))
          heights.emplace_back(-height, f);
      }
      if (heights.empty()) continue;
      // it leaves what the part goes on by under the nearest of its faces
      std::sort(heights.begin(), heights.end());
      if (is_known(world * point, -heights.front().first)) continue;
      for (const auto& [depth, f] : heights)
        if (add_vertex(v, f, point, -depth)) break;
    }
  }

  // Whether a contact holds this point (world) of the other, at `height` or deeper: in a slit it is
  // beside walls, too, that it is not to get to.
  bool is_known(const Vec3& point, double height) const {
    return std::any_of(out.begin() + static_cast<std::ptrdiff_t>(from), out.end(),
                       [&](const auto& p) {
                         return p.reference_is_a == of_a && p.gap <= height + same_place() &&
                                (p.core_point - point).norm() <= same_place();
                       });
  }

  // A vertex inside the part, or `beside` it and inside a neighbour: as close to a wall between the
  // two as a place is known, it is in neither, and across that wall is looked at.
  void add_under_face(std::uint64_t v, const Vec3& point, int nearest, bool beside) const {
    const Vec3 across = 2 * same_place() * part.face(nearest).normal;
    if (beside && !covered(world * point) && !covered(world * (point + across))) return;
    thread_local std::vector<std::pair<double, std::uint64_t>> depths;
    depths.clear();
    for (std::uint64_t f = 0; f < part.faces().size(); ++f) {
      const Polyhedron::Face& face = part.faces()[f];
      const double depth = face.offset - face.normal.dot(point);
      if (depth < 0 || depth > seam::sunk * seam.size) continue;
      if (beside && !over_face(part, face, point + depth * face.normal, 0)) continue;
      depths.emplace_back(depth, f);
    }
    std::sort(depths.begin(), depths.end());
    for (const auto& [depth, f] : depths) {
      if (leaves_by_neighbour(point, depth)) return;
      if (add_vertex(v, f, point, -depth)) return;
    }
  }
};

// Whether a plane square to the line of their centres proves that two cores are farther apart.
bool farther_apart(const CorePair& cores, double distance) {
  const Vec3 along = cores.b_in_a * cores.b.center() - cores.a.center();
  const Vec3 back = -(cores.b_in_a.R.transpose() * along);
  const double a = along.dot(cores.a.vertex(cores.a.support(along, 0)));
  const double b = along.dot(cores.b_in_a * cores.b.vertex(cores.b.support(back, 0)));
  return b - a > (1 + 1e-9) * distance * along.norm();
}

// Leaves each place once and no more points than a manifold has, the deepest.
void thin(double same_place, std::size_t from, std::vector<ManifoldPoint>& out) {
  const auto first_new = out.begin() + static_cast<std::ptrdiff_t>(from);
  std::sort(first_new, out.end(), [](const auto& p, const auto& q) {
    return std::pair(p.gap, p.feature) < std::pair(q.gap, q.feature);
  });
  // edges that end in one vertex meet the same face there
  const auto last = std::unique(first_new, out.end(), [&](const auto& p, const auto& q) {
    return (p.core_point - q.core_point).norm() <= same_place &&
           p.reference_is_a == q.reference_is_a;
  });
  out.erase(last, out.end());
  out.resize(std::min(out.size(), from + patch::most_points));
}

}  // namespace

double polyhedra_at_seam(const SeamPair& seam, std::vector<ManifoldPoint>& out) {
  const std::size_t from = out.size();
  const CorePair cores(seam.first(), seam.a.frame, seam.second(), seam.b.frame);
  if (farther_apart(cores, seam.farthest())) return std::numeric_limits<double>::infinity();
  const NearestFeatures near = nearest_features(cores.a, cores.b, cores.b_in_a, seam.reach);
  if (near.distance > seam.farthest()) return near.distance;
  const bool reached = near.distance <= seam.reach;
  const auto buried = [&](bool on_a) {
    return seam.buries(on_a, cores.world_a * (on_a ? near.point_a : near.point_b),
                       cores.world_a.R * near.normal, seam::same_angle);
  };
  if (reached && !buried(true) && !buried(false)) {
    features_manifold(cores, near, seam.reach, seam.choice, seam.pair, &seam, out);
    seam.remove_ghosts(from, seam::face_angle, out);
  }
  const bool nothing = reached && out.size() == from;
  for (const bool of_a : {true, false}) {
    if (!(of_a ? seam.a : seam.b).has_seams) continue;
    const Exposure exposure{seam, cores, of_a, from, out};
    if (nothing) exposure.add_edges();
    if (nothing) exposure.add_vertices();
    exposure.add_in_valleys();
  }
  if (nothing) thin(coincident_ratio * cores.size(), from, out);
  return near.distance;
}

}  // namespace tw
