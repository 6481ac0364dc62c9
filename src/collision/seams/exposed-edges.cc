// Exposed edges; see the header.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/seams/exposed-edges.h"
#include "collision/seams/seams.h"

#include <algorithm>

#include "collision/distance/part-pairs.h"

namespace tw {

namespace {

// A height that is linear along the edge.
struct Height {
  double at_tail = 0, at_head = 0;
  int face = 0;
  double rise() const { return at_head - at_tail; }
  double at(double s) const { return at_tail + s * rise(); }
};

// Cuts the stretch down to where the height is at most `limit`.
void cut(Stretch& stretch, const Height& height, double limit) {
  const double tail = height.at_tail - limit, head = height.at_head - limit;
  if (tail > 0 && head > 0) stretch.to = stretch.from - 1;
  if (tail > 0 && head <= 0) stretch.from = std::max(stretch.from, tail / (tail - head));
  if (tail <= 0 && head > 0) stretch.to = std::min(stretch.to, tail / (tail - head));
}

// What of the segment (world) a neighbour grown by the margin holds.
Stretch held_by(const SeamNeighbour& q, const Vec3& tail, const Vec3& head, double margin) {
  Stretch held;
  if (q.part->kind == PartKind::half_space) {
    const Vec3 normal = q.frame.R * q.part->normal;
    const double offset = q.part->offset + normal.dot(q.frame.p);
    cut(held, {normal.dot(tail) - offset, normal.dot(head) - offset}, margin);
    return held;
  }
  if (q.part->kind != PartKind::polyhedron) return {1, 0};
  const Frame place = q.part->in(q.frame);
  const Vec3 from = place.to_local(tail), to = place.to_local(head);
  for (const Polyhedron::Face& face : q.part->core->faces()) {
    cut(held, {face.normal.dot(from) - face.offset, face.normal.dot(to) - face.offset}, margin);
    if (held.empty()) break;
  }
  return held;
}

void subtract(std::vector<Stretch>& from, const Stretch& held) {
  if (held.empty()) return;
  for (std::size_t i = from.size(); i-- > 0;) {
    const Stretch before{from[i].from, std::min(from[i].to, held.from)};
    const Stretch after{std::max(from[i].from, held.to), from[i].to};
    from.erase(from.begin() + static_cast<std::ptrdiff_t>(i));
    if (!before.empty()) from.push_back(before);
    if (!after.empty()) from.push_back(after);
  }
}

// Where the greatest of the heights is least on the stretch, and the one or two heights there:
// `falling` is the one that governs on the side of the tail.
struct Lowest {
  double s = 0;
  const Height* falling = nullptr;
  const Height* rising = nullptr;
};

const Height& highest_at(const std::vector<Height>& heights, double s) {
  return *std::max_element(heights.begin(), heights.end(),
                           [s](const Height& a, const Height& b) { return a.at(s) < b.at(s); });
}

Lowest lowest(const std::vector<Height>& heights, const Stretch& stretch) {
  const Height* falling = &highest_at(heights, stretch.from);
  if (falling->rise() >= 0) return {stretch.from, nullptr, falling};
  const Height* rising = &highest_at(heights, stretch.to);
  if (rising->rise() <= 0) return {stretch.to, rising, nullptr};
  // the greatest height is convex: the crossing of a tangent from each side never passes its least
  for (std::size_t i = 0;; ++i) {
    const double s = (falling->at_tail - rising->at_tail) / (rising->rise() - falling->rise());
    const Height& there = highest_at(heights, s);
    if (i >= heights.size() || !(there.at(s) > falling->at(s)) || &there == falling ||
        &there == rising)
      return {s, falling, rising};
    (there.rise() < 0 ? falling : rising) = &there;
  }
}

int edge_between(const Polyhedron& p, int face1, int face2) {
  for (std::size_t e = 0; e < p.edges().size(); ++e) {
    const Polyhedron::Edge& edge = p.edges()[e];
    if ((edge.left == face1 && edge.right == face2) || (edge.left == face2 && edge.right == face1))
      return static_cast<int>(e);
  }
  return -1;
}

// One edge of a polyhedron and what it runs through.
struct EdgeThrough {
  const Polyhedron& part;
  const Polyhedron& other;
  const Frame& other_in_part;
  int number;
  const Polyhedron::Edge& edge = part.edges()[static_cast<std::size_t>(number)];
  const Vec3& tail = part.vertex(edge.tail);
  const Vec3 along = part.vertex(edge.head) - tail;
  const Vec3& left = part.face(edge.left).normal;
  const Vec3& right = part.face(edge.right).normal;

  Vec3 at(double s) const { return tail + s * along; }
  double outward(const Vec3& normal) const { return normal.dot(left + right); }

  // Whether the normal, but for its part along the edge, is one of the edge's.  Where it is not, a
  // point beside the edge lies deeper.
  bool is_normal(const Vec3& normal) const {
    return outward(normal) > 0 && normal.dot(left.cross(along)) <= 0 &&
           normal.dot(along.cross(right)) <= 0;
  }

  // Heights over the planes of the other's faces, and what of the edge is that near.
  Stretch measure(double reach, std::vector<Height>& heights) const {
    Stretch inside;
    heights.clear();
    for (std::size_t f = 0; f < other.faces().size() && !inside.empty(); ++f) {
      const Polyhedron::Face& face = other.faces()[f];
      const Vec3 normal = other_in_part.R * face.normal;
      const double at_tail = normal.dot(tail - other_in_part.p) - face.offset;
      heights.push_back({at_tail, at_tail + normal.dot(along), static_cast<int>(f)});
      cut(inside, heights.back(), reach);
    }
    return inside;
  }

  ExposedPoint under_face(double s, const Height& height) const {
    ExposedPoint p;
    p.point = at(s);
    p.normal = -(other_in_part.R * other.face(height.face).normal);
    p.gap = height.at(s);
    p.opposite = p.point + p.gap * p.normal;
    p.edge = number;
    p.face = height.face;
    return p;
  }

  // False where the lines are nearest beyond the end of an edge or of the stretch.
  bool crossing(int other_edge, const Stretch& stretch, ExposedPoint& p) const {
    const Polyhedron::Edge& across = other.edges()[static_cast<std::size_t>(other_edge)];
    const Vec3 base = other_in_part * other.vertex(across.tail);
    const Vec3 direction = other_in_part * other.vertex(across.head) - base;
    p.normal = along.cross(direction).normalized();
    if (outward(p.normal) < 0) p.normal = -p.normal;
    nearest_on_segments(tail, along, base, direction, p.point, p.opposite);
    p.gap = p.normal.dot(p.opposite - p.point);
    p.edge = number;
    p.other_edge = other_edge;
    const double s = (p.point - tail).dot(along) / along.squaredNorm();
    const double aside = (p.opposite - p.point - p.gap * p.normal).norm();
    return s >= stretch.from && s <= stretch.to &&
           aside <= touch_ratio * (part.radius() + other.radius());
  }

  // Between two faces that are no neighbours: along what both push, across the edge.
  ExposedPoint between(double s, const Height& falling, const Height& rising) const {
    ExposedPoint p;
    p.point = at(s);
    p.edge = number;
    p.face = falling.face;
    const Vec3 first = other_in_part.R * other.face(falling.face).normal;
    const Vec3 second = other_in_part.R * other.face(rising.face).normal;
    p.normal = (falling.rise() * second - rising.rise() * first).normalized();
    // down to the surface
    double depth = std::numeric_limits<double>::infinity();
    for (const Polyhedron::Face& face : other.faces()) {
      const Vec3 normal = other_in_part.R * face.normal;
      const double cosine = -normal.dot(p.normal);
      if (!(cosine > 0)) continue;
      const double height = normal.dot(p.point - other_in_part.p) - face.offset;
      depth = std::min(depth, -height / cosine);
    }
    p.gap = -depth;
    p.opposite = p.point + p.gap * p.normal;
    return p;
  }

  ExposedPoint deepest(const std::vector<Height>& heights, const Stretch& stretch) const {
    const Lowest low = lowest(heights, stretch);
    if (!low.rising) return under_face(low.s, *low.falling);
    if (!low.falling) return under_face(low.s, *low.rising);
    ExposedPoint p;
    const int across = edge_between(other, low.falling->face, low.rising->face);
    // of edges apart the normal points away from the other's inside, not from the part's
    const bool apart = low.falling->at(low.s) > 0;
    if (across >= 0 && crossing(across, stretch, p) && !(apart && p.gap < 0)) return p;
    return between(low.s, *low.falling, *low.rising);
  }
};

}  // namespace

void leave_exposed(const Vec3& tail, const Vec3& head, const std::vector<SeamNeighbour>& neighbours,
                   double margin, std::vector<Stretch>& stretches) {
  for (const SeamNeighbour& q : neighbours)
    if (!held_by(q, tail, head, -margin).empty())
      subtract(stretches, held_by(q, tail, head, margin));
}

void exposed_edges(const Polyhedron& part, const Frame& world, const Polyhedron& other,
                   const Frame& other_in_part, const std::vector<SeamNeighbour>& neighbours,
                   double margin, double reach, std::vector<ExposedPoint>& out) {
  thread_local std::vector<Height> heights;
  thread_local std::vector<Stretch> exposed;
  for (int e = 0; e < static_cast<int>(part.edges().size()); ++e) {
    const EdgeThrough through{part, other, other_in_part, e};
    const Stretch inside = through.measure(reach, heights);
    if (inside.empty()) continue;
    const Vec3 tail = world * through.tail, head = world * through.at(1);
    exposed.assign(1, inside);
    leave_exposed(tail, head, neighbours, margin, exposed);
    for (const Stretch& stretch : exposed) {
      const ExposedPoint p = through.deepest(heights, stretch);
      if (p.gap <= reach && through.is_normal(p.normal)) out.push_back(p);
    }
  }
}

}  // namespace tw
