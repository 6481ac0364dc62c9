// The exposed edges of a polyhedron through a round part.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "collision/distance/support-core.h"
#include "collision/manifold/manifold-parts.h"
#include "collision/seams/exposed-edges.h"
#include "collision/seams/seam-pair.h"
#include "collision/seams/valley.h"
#include "math/maximum.h"

namespace tw {

namespace {

// An exposed edge of a polyhedron and a round part: the axis of least depth of those square to the
// edge, between the normals of its faces.  That of the two parts may be another one, which a
// neighbour buries.
struct EdgeUnder {
  const Vec3& left;  // normals of the faces, world
  const Vec3& right;
  const Vec3& tail;
  const SupportCore& round;
  double angle = std::atan2(left.cross(right).norm(), left.dot(right));

  Vec3 normal_at(double turn) const {
    return (std::sin(angle - turn) * left + std::sin(turn) * right) / std::sin(angle);
  }
  Vec3 lowest(const Vec3& normal) const { return round.support(-normal) - round.margin * normal; }
  double height(const Vec3& normal) const { return normal.dot(lowest(normal) - tail); }

  // False where no axis is.
  bool reaches(double reach) const {
    return std::sin(angle) > 0 && height(left) <= reach && height(right) <= reach;
  }

  // Seen from the edge; false where a face is nearer.
  bool find(RoundDistance& least) const {
    const double end = 1e-6 * angle;
    const double turn = greatest_at([&](double t) { return height(normal_at(t)); }, 0, angle, end);
    if (turn < 2 * end || turn > angle - 2 * end) return false;
    least.normal = normal_at(turn);
    // where a line of it crosses the edge the lowest point jumps from one end to the other
    const Vec3 aside = left.cross(right).cross(least.normal);
    const Vec3 before = lowest(normal_at(turn - 2 * end)),
               after = lowest(normal_at(turn + 2 * end));
    const double from = aside.dot(before - tail), to = aside.dot(after - tail);
    least.point_b =
        from * to < 0 ? Vec3(before + from / (from - to) * (after - before)) : lowest(least.normal);
    least.distance = least.normal.dot(least.point_b - tail);
    least.point_a = least.point_b - least.distance * least.normal;
    return true;
  }
};

}  // namespace

void round_at_edges(const SeamPair& seam, bool of_a, std::vector<ManifoldPoint>& out) {
  const SeamSide& side = of_a ? seam.a : seam.b;
  const ConvexPart& part = of_a ? seam.first() : seam.second();
  const ConvexPart& round = of_a ? seam.second() : seam.first();
  if (part.kind != PartKind::polyhedron || !side.has_seams) return;
  // of the many parts of a tree only the neighbours next to the round part are known here, not all
  // that may bury an edge
  if (side.shape.tree()) return;
  const Polyhedron& core = *part.core;
  const Frame world = part.in(side.frame);
  const SupportCore support(round, round.in((of_a ? seam.b : seam.a).frame));
  // as deep as bodies may be, and as far beyond the end of an edge as that allows
  const double farthest = support.size() + support.margin +
                          std::max(seam.reach, (1 + seam::beyond_end) * seam::sunk * seam.size);
  thread_local std::vector<Stretch> exposed;
  for (std::size_t e = 0; e < core.edges().size(); ++e) {
    const Polyhedron::Edge& edge = core.edges()[e];
    const Vec3 tail = world * core.vertex(edge.tail), head = world * core.vertex(edge.head);
    const double margin = seam::buried_margin * seam.size, length = (head - tail).norm();
    const double beneath = (head - tail).dot(support.center() - tail) / (length * length);
    const Vec3 nearest = tail + std::clamp(beneath, 0.0, 1.0) * (head - tail);
    if ((nearest - support.center()).norm() > farthest) continue;
    const Vec3 left = world.R * core.face(edge.left).normal;
    const Vec3 right = world.R * core.face(edge.right).normal;
    const EdgeUnder under{left, right, tail, support};
    if (!under.reaches(seam.reach)) continue;
    const auto edge_at = [&](double share) {
      return GroundEdge(core, e, share, world, seam.neighbours(of_a), seam.size);
    };
    // most are those of inner walls, all along
    const double inset = std::min(0.5, seam::probe * seam.size / length);
    if (!edge_at(std::clamp(beneath, inset, 1 - inset)).is_open(0)) continue;
    RoundDistance least;
    if (!under.find(least)) continue;
    if (least.distance > seam.reach || least.distance < -seam::sunk * seam.size) continue;
    const double at = (head - tail).dot(least.point_a - tail) / length;
    exposed.assign(1, Stretch());
    leave_exposed(tail, head, seam.neighbours(of_a), margin, exposed);
    const bool on_it = std::any_of(exposed.begin(), exposed.end(), [&](const Stretch& stretch) {
      return at >= stretch.from * length && at <= stretch.to * length &&
             edge_at(at / length).is_open(0);
    });
    // or beneath a neighbour beside its end
    const double beyond = seam::beyond_end * std::abs(least.distance) + margin;
    const bool beside = std::any_of(exposed.begin(), exposed.end(), [&](const Stretch& stretch) {
      const bool to_head = at > 0.5 * (stretch.from + stretch.to) * length;
      const double end = to_head ? stretch.to : stretch.from;
      if (std::abs(at - end * length) > beyond) return false;
      const int towards = to_head ? 1 : -1;
      return edge_at(end).is_open(-towards) && edge_at(end).goes_on(towards);
    });
    if (!on_it && !beside) continue;
    if (!of_a) {
      std::swap(least.point_a, least.point_b);
      least.normal = -least.normal;
    }
    const std::size_t first = out.size();
    round_manifold(seam.first(), seam.a.frame, seam.second(), seam.b.frame, least, seam.reach,
                   seam.pair, out);
    for (std::size_t i = first; i < out.size(); ++i)
      out[i].feature =
          feature_name(seam.pair, of_a ? FeatureMode::exposed_of_a : FeatureMode::exposed_of_b,
                       {e, out[i].feature, 1});
    if (!beside) seam.remove_ghosts(first, seam::same_angle, out);
  }
}

}  // namespace tw
