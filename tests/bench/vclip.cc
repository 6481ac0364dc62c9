// V-Clip.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/vclip.h"

#include <algorithm>
#include <limits>

#include "collision/distance/sat.h"

namespace tw::bench {

VoronoiSolid::VoronoiSolid(const Polyhedron& core) : core_(&core) {
  for (const Polyhedron::Edge& e : core.edges()) {
    Edge& edge = edges_.emplace_back();
    edge.tail = core.vertex(e.tail);
    edge.head = core.vertex(e.head);
    edge.along = (edge.head - edge.tail).normalized();
    edge.from_tail = edge.along.dot(edge.tail);
    edge.to_head = edge.along.dot(edge.head);
    edge.face[0] = e.left;
    edge.face[1] = e.right;
    edge.vertex[0] = e.tail;
    edge.vertex[1] = e.head;
    for (int k = 0; k < 2; ++k) {
      const Polyhedron::Face& face = core.face(edge.face[k]);
      for (int i = face.first; i < face.first + face.count; ++i)
        if (&core.edges()[static_cast<std::size_t>(core.side(i).edge)] == &e) {
          edge.inward[k] = core.side(i).inward;
          edge.offset[k] = core.side(i).offset;
        }
    }
  }
  for (int i = 0; i < static_cast<int>(core.vertices().size()); ++i) {
    first_spoke_.push_back(static_cast<int>(spokes_.size()));
    for (const Polyhedron::Link& link : core.links(i)) {
      const Edge& edge = this->edge(link.edge);
      const Vec3 along = edge.vertex[0] == i ? edge.along : Vec3(-edge.along);
      spokes_.push_back({along, along.dot(core.vertex(i)), link.edge});
    }
  }
  first_spoke_.push_back(static_cast<int>(spokes_.size()));
}

namespace {

// One body's feature, and how the other's frame is seen from its own.
struct Side {
  const VoronoiSolid& solid;
  const Frame& other_in_this;
  Feature feature;

  const Vec3& vertex() const { return solid.core().vertex(feature.index); }
  const VoronoiSolid::Edge& edge() const { return solid.edge(feature.index); }
  const Polyhedron::Face& face() const { return solid.core().face(feature.index); }
  void move(FeatureKind kind, int index) { feature = {kind, index}; }
};

enum class Step { moved, done, overlap };

// The stretch lo..hi of a segment that is left within some planes, and whose regions lie beyond its
// ends.
struct Clip {
  double lo = 0, hi = 1;
  Feature beyond_lo, beyond_hi;
  bool excluded = false;  // nothing is left
  bool simply = false;    // all of it lies beyond one plane

  // Heights of the segment's ends over the plane, positive within; false where nothing is left.
  bool by(double tail, double head, Feature neighbour) {
    if (tail < 0 && head < 0) {
      beyond_lo = beyond_hi = neighbour;
      excluded = simply = true;
    } else if (tail < 0) {
      const double at = tail / (tail - head);
      if (at > lo) {
        lo = at;
        beyond_lo = neighbour;
      }
    } else if (head < 0) {
      const double at = tail / (tail - head);
      if (at < hi) {
        hi = at;
        beyond_hi = neighbour;
      }
    }
    if (lo > hi) excluded = true;
    return !excluded;
  }
};

struct Segment {
  Vec3 tail, head;
  Vec3 at(double s) const { return tail + s * (head - tail); }
};

Segment seen(const Side& from, const Side& edge) {
  return {from.other_in_this * edge.edge().tail, from.other_in_this * edge.edge().head};
}

// How the distance from a vertex or a face changes along a segment at s: its sign, or 0 with
// `touches` set where the distance is 0.
double slope(const VoronoiSolid& solid, Feature feature, const Segment& segment, double s,
             bool& touches) {
  const Vec3 along = segment.head - segment.tail;
  if (feature.kind == FeatureKind::vertex) {
    const Vec3 apart = segment.at(s) - solid.core().vertex(feature.index);
    touches = apart.isZero(0);
    return along.dot(apart);
  }
  const Polyhedron::Face& face = solid.core().face(feature.index);
  const double height = face.normal.dot(segment.at(s)) - face.offset;
  touches = height == 0;
  const double rise = face.normal.dot(along);
  return height > 0 ? rise : -rise;
}

// Of two neighbours the one that is no edge: on the plane between them both are as far away.
Feature no_edge(Feature x, Feature neighbour) {
  return neighbour.kind == FeatureKind::edge ? x : neighbour;
}

// After a clip: moves to the neighbour beyond an end of the stretch where the distance still falls.
Step move_by_slope(Side& x, const Segment& segment, const Clip& clip) {
  const Feature from = x.feature;
  bool touches = false;
  if (clip.beyond_lo.kind != FeatureKind::none) {
    const double s = slope(x.solid, no_edge(from, clip.beyond_lo), segment, clip.lo, touches);
    if (touches) return Step::overlap;
    if (s > 0) {
      x.feature = clip.beyond_lo;
      return Step::moved;
    }
  }
  if (clip.beyond_hi.kind != FeatureKind::none) {
    const double s = slope(x.solid, no_edge(from, clip.beyond_hi), segment, clip.hi, touches);
    if (touches) return Step::overlap;
    if (s < 0) {
      x.feature = clip.beyond_hi;
      return Step::moved;
    }
  }
  return Step::done;
}

// To the edge whose VE plane a point lies beyond, if any.
bool leave_vertex(Side& v, const Vec3& point) {
  const int end = v.solid.first_spoke(v.feature.index + 1);
  for (int i = v.solid.first_spoke(v.feature.index); i < end; ++i) {
    const VoronoiSolid::Spoke& spoke = v.solid.spoke(i);
    if (spoke.along.dot(point) > spoke.offset) {
      v.move(FeatureKind::edge, spoke.edge);
      return true;
    }
  }
  return false;
}

Step vertex_vertex(Side& a, Side& b) {
  if (leave_vertex(a, a.other_in_this * b.vertex())) return Step::moved;
  if (leave_vertex(b, b.other_in_this * a.vertex())) return Step::moved;
  return Step::done;
}

Step vertex_edge(Side& v, Side& e) {
  // the vertex within the edge's region?
  const VoronoiSolid::Edge& edge = e.edge();
  const Vec3 point = e.other_in_this * v.vertex();
  const double at = edge.along.dot(point);
  if (at < edge.from_tail || at > edge.to_head) {
    e.move(FeatureKind::vertex, edge.vertex[at < edge.from_tail ? 0 : 1]);
    return Step::moved;
  }
  for (int k = 0; k < 2; ++k)
    if (edge.inward[k].dot(point) > edge.offset[k]) {
      e.move(FeatureKind::face, edge.face[k]);
      return Step::moved;
    }
  // the edge's nearest point within the vertex's region?
  const Segment segment = seen(v, e);
  Clip clip;
  const int end = v.solid.first_spoke(v.feature.index + 1);
  for (int i = v.solid.first_spoke(v.feature.index); i < end; ++i) {
    const VoronoiSolid::Spoke& spoke = v.solid.spoke(i);
    if (!clip.by(spoke.offset - spoke.along.dot(segment.tail),
                 spoke.offset - spoke.along.dot(segment.head), {FeatureKind::edge, spoke.edge}))
      break;
  }
  if (clip.simply) {
    v.feature = clip.beyond_lo;
    return Step::moved;
  }
  return move_by_slope(v, segment, clip);
}

// A point below the plane of the face in whose prism it lies: to the face it is highest over, or
// all faces lie over it.
Step leave_local_minimum(Side& f, const Vec3& point) {
  int highest = 0;
  const double height = f.solid.core().face_separation(point, highest);
  f.move(FeatureKind::face, highest);
  return height <= 0 ? Step::overlap : Step::moved;
}

Step vertex_face(Side& v, Side& f) {
  const Polyhedron& core = f.solid.core();
  const Polyhedron::Face& face = f.face();
  const Vec3 point = f.other_in_this * v.vertex();
  // beyond a side: to the one it is farthest beyond
  double deepest = 0;
  int beyond = -1;
  for (int i = face.first; i < face.first + face.count; ++i) {
    const double height = core.side(i).inward.dot(point) - core.side(i).offset;
    if (height < deepest) {
      deepest = height;
      beyond = core.side(i).edge;
    }
  }
  if (beyond >= 0) {
    f.move(FeatureKind::edge, beyond);
    return Step::moved;
  }
  // an edge of the vertex that comes nearer to the plane
  const double height = face.normal.dot(point) - face.offset;
  const Vec3 normal_in_v = v.other_in_this.R * face.normal;
  const double down = height > 0 ? -1 : 1;
  const int end = v.solid.first_spoke(v.feature.index + 1);
  for (int i = v.solid.first_spoke(v.feature.index); i < end; ++i)
    if (down * normal_in_v.dot(v.solid.spoke(i).along) > 0) {
      v.move(FeatureKind::edge, v.solid.spoke(i).edge);
      return Step::moved;
    }
  return height > 0 ? Step::done : leave_local_minimum(f, point);
}

// One half of the test of two edges: the other's nearest point within the region of `x`?
Step edge_within(Side& x, const Side& other) {
  const VoronoiSolid::Edge& edge = x.edge();
  const Segment segment = seen(x, other);
  Clip clip;
  // first across the edge, then along it
  const double tail = edge.along.dot(segment.tail), head = edge.along.dot(segment.head);
  if (clip.by(tail - edge.from_tail, head - edge.from_tail, {FeatureKind::vertex, edge.vertex[0]}))
    clip.by(edge.to_head - tail, edge.to_head - head, {FeatureKind::vertex, edge.vertex[1]});
  if (clip.simply) {
    x.feature = clip.beyond_lo;
    return Step::moved;
  }
  if (const Step step = move_by_slope(x, segment, clip); step != Step::done) return step;
  for (int k = 0; k < 2; ++k)
    if (!clip.by(edge.offset[k] - edge.inward[k].dot(segment.tail),
                 edge.offset[k] - edge.inward[k].dot(segment.head),
                 {FeatureKind::face, edge.face[k]}))
      break;
  if (clip.simply) {
    x.feature = clip.beyond_lo;
    return Step::moved;
  }
  return move_by_slope(x, segment, clip);
}

Step edge_edge(Side& a, Side& b) {
  if (const Step step = edge_within(a, b); step != Step::done) return step;
  return edge_within(b, a);
}

// To the side or corner of the face that is nearest to a segment which passes it by.
void to_rim(Side& f, const Segment& segment) {
  const Polyhedron::Face& face = f.face();
  const Vec3 along = segment.head - segment.tail;
  double least = std::numeric_limits<double>::infinity();
  Feature best;
  for (int i = face.first; i < face.first + face.count; ++i) {
    const int number = f.solid.core().side(i).edge;
    const VoronoiSolid::Edge& edge = f.solid.edge(number);
    Vec3 on_edge, on_segment;
    nearest_on_segments(edge.tail, edge.head - edge.tail, segment.tail, along, on_edge, on_segment);
    const double square = (on_edge - on_segment).squaredNorm();
    if (!(square < least)) continue;
    least = square;
    best = on_edge == edge.tail   ? Feature{FeatureKind::vertex, edge.vertex[0]}
           : on_edge == edge.head ? Feature{FeatureKind::vertex, edge.vertex[1]}
                                  : Feature{FeatureKind::edge, number};
  }
  f.feature = best;
}

Step edge_face(Side& e, Side& f) {
  const Polyhedron& core = f.solid.core();
  const Polyhedron::Face& face = f.face();
  const Segment segment = seen(f, e);
  Clip clip;
  for (int i = face.first; i < face.first + face.count; ++i) {
    const Polyhedron::Side& side = core.side(i);
    if (!clip.by(side.inward.dot(segment.tail) - side.offset,
                 side.inward.dot(segment.head) - side.offset, {FeatureKind::edge, side.edge})) {
      to_rim(f, segment);
      return Step::moved;
    }
  }
  // through the face?
  const double low = face.normal.dot(segment.at(clip.lo)) - face.offset;
  const double high = face.normal.dot(segment.at(clip.hi)) - face.offset;
  if ((low <= 0 && high >= 0) || (low >= 0 && high <= 0)) return Step::overlap;
  // to the end that is nearer to the plane, told as vertex_face tells it: with another rounding the
  // two would send the walk to and fro over faces that are nearly parallel
  const double rise = (e.other_in_this.R * face.normal).dot(e.edge().along);
  const bool tail = (low > 0 ? rise : -rise) >= 0;
  const Feature beyond = tail ? clip.beyond_lo : clip.beyond_hi;
  if (beyond.kind != FeatureKind::none)
    f.feature = beyond;
  else
    e.move(FeatureKind::vertex, e.edge().vertex[tail ? 0 : 1]);
  return Step::moved;
}

Step take_step(Side& a, Side& b) {
  using enum FeatureKind;
  const FeatureKind p = a.feature.kind, q = b.feature.kind;
  if (p == vertex && q == vertex) return vertex_vertex(a, b);
  if (p == vertex && q == edge) return vertex_edge(a, b);
  if (p == edge && q == vertex) return vertex_edge(b, a);
  if (p == edge && q == edge) return edge_edge(a, b);
  if (p == vertex && q == face) return vertex_face(a, b);
  if (p == face && q == vertex) return vertex_face(b, a);
  return p == face ? edge_face(b, a) : edge_face(a, b);
}

Vec3 nearest_on_edge(const VoronoiSolid::Edge& edge, const Vec3& point) {
  return edge.tail + (edge.along.dot(point - edge.tail)) * edge.along;
}

// Of edges that cross at less the points say more of the normal than the edges do.
constexpr double least_sine = 1e-6;

// Two points of a vertex or an edge and another, and their distance.
void measure_points(const Side& a, const Side& b, VClipAnswer& answer) {
  const auto corner = [](const Side& side) {
    return side.feature.kind == FeatureKind::vertex ? side.vertex() : side.edge().tail;
  };
  answer.point_a = corner(a);
  answer.point_b = a.other_in_this * corner(b);
  const bool edge_a = a.feature.kind == FeatureKind::edge;
  const bool edge_b = b.feature.kind == FeatureKind::edge;
  if (edge_a && edge_b) {
    const Segment other = seen(a, b);
    const Vec3 x = a.edge().tail, y = other.tail;
    nearest_on_segments(x, a.edge().head - x, y, other.head - y, answer.point_a, answer.point_b);
  } else if (edge_a) {
    answer.point_a = nearest_on_edge(a.edge(), answer.point_b);
  } else if (edge_b) {
    answer.point_b = a.other_in_this * nearest_on_edge(b.edge(), b.other_in_this * a.vertex());
  }
  const Vec3 apart = answer.point_b - answer.point_a;
  answer.distance = apart.norm();
  if (answer.distance > 0) answer.normal = apart / answer.distance;
  if (!edge_a || !edge_b) return;
  // square to both edges, whatever the distance; outwards as the faces of a's edge look
  const Vec3 across = a.edge().along.cross(a.other_in_this.R * b.edge().along);
  const double sine = across.norm();
  if (!(sine > least_sine)) return;
  const Vec3 outwards =
      a.solid.core().face(a.edge().face[0]).normal + a.solid.core().face(a.edge().face[1]).normal;
  answer.normal = (across.dot(outwards) < 0 ? -1 : 1) / sine * across;
}

// What the features at the walk's end say.  Of an overlap a vertex and a face give its depth under
// that face; otherwise nothing is known.
VClipAnswer measure(const Side& a, const Side& b) {
  VClipAnswer answer;
  if (a.feature.kind == FeatureKind::face && b.feature.kind == FeatureKind::vertex) {
    const Polyhedron::Face& face = a.face();
    answer.point_b = a.other_in_this * b.vertex();
    answer.distance = face.normal.dot(answer.point_b) - face.offset;
    answer.normal = face.normal;
    answer.point_a = answer.point_b - answer.distance * face.normal;
  } else if (a.feature.kind == FeatureKind::vertex && b.feature.kind == FeatureKind::face) {
    const Polyhedron::Face& face = b.face();
    answer.distance = face.normal.dot(b.other_in_this * a.vertex()) - face.offset;
    answer.normal = -(a.other_in_this.R * face.normal);
    answer.point_a = a.vertex();
    answer.point_b = answer.point_a + answer.distance * answer.normal;
  } else if (a.feature.kind != FeatureKind::face && b.feature.kind != FeatureKind::face) {
    measure_points(a, b, answer);
  }
  return answer;
}

}  // namespace

VClipAnswer vclip(const VoronoiSolid& solid_a, const VoronoiSolid& solid_b, const Frame& b_in_a,
                  FeaturePair& pair) {
  const Mat3 back = b_in_a.R.transpose();
  const Frame a_in_b(back, -(back * b_in_a.p));
  Side a{solid_a, b_in_a, pair.a};
  Side b{solid_b, a_in_b, pair.b};
  Step step = Step::moved;
  int steps = 0;
  while (step == Step::moved && steps < most_steps) {
    step = take_step(a, b);
    ++steps;
  }
  pair = {a.feature, b.feature};
  VClipAnswer answer = measure(a, b);
  answer.steps = steps;
  answer.end = step == Step::moved  ? VClipEnd::out_of_steps
               : step == Step::done ? VClipEnd::apart
                                    : VClipEnd::overlap;
  if (answer.end == VClipEnd::overlap) answer.distance = std::min(answer.distance, 0.0);
  return answer;
}

}  // namespace tw::bench
