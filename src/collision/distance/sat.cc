// The axis of least penetration of two polyhedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/sat.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tw {

namespace {

// distances along axes that differ by less, relative to the size, count as equal
constexpr double tie = 1e-13;

// slack of the tests that leave edges out, relative to the size
constexpr double left_out_slack = 1e-9;

// below this sine of their angle two edges count as parallel: the thin Minkowski face between them
// is then within rounding of its neighbours
constexpr double parallel_edges = 1e-13;

// The search so far.
struct Search {
  LeastAxis best;
  double chosen = -1e300;  // s along best.normal
  double greatest = -1e300;
  double margin = 0;  // ties
  int start = 0;      // where hill climbing starts: the last support vertex

  bool takes(double s) {
    greatest = std::max(greatest, s);
    if (!(s > chosen + margin)) return false;
    chosen = s;
    return true;
  }
};

// An edge of either polyhedron in A's frame.
struct PlacedEdge {
  int number;
  Vec3 tail;
  Vec3 along;        // head - tail
  Vec3 left, right;  // normals of its faces
};

// Tries one face of `p` (in p's frame, which `q_in_p` maps q to).
void try_face(const Polyhedron& p, int number, const Polyhedron& q, const Frame& q_in_p,
              AxisKind kind, Search& search) {
  const Polyhedron::Face& face = p.face(number);
  const Vec3 direction = -(q_in_p.R.transpose() * face.normal);
  const int vertex = q.support(direction, search.start);
  search.start = vertex;
  const double s = face.normal.dot(q_in_p * q.vertex(vertex)) - face.offset;
  if (!search.takes(s)) return;
  search.best.kind = kind;
  search.best.feature_a = kind == AxisKind::face_a ? number : vertex;
  search.best.feature_b = kind == AxisKind::face_a ? vertex : number;
  search.best.normal = face.normal;
}

// Tries all faces of p.  A face is left out when even the ball inside q is nearer than the best, or
// when the deepest vertex under the first one is, by more than ties and rounding.
void try_faces(const Polyhedron& p, const Polyhedron& q, const Frame& q_in_p, AxisKind kind,
               Search& search) {
  thread_local std::vector<int> left;
  const Vec3 center = q_in_p * q.center();
  int first = 0;
  search.start = 0;
  const double height = p.face_separation(center, first);
  const bool near = height - q.inner_radius() >= search.chosen;
  if (near) try_face(p, first, q, q_in_p, kind, search);
  // (hill climbing begins where the face before ended: there none is left out by the vertex)
  double least = search.chosen - search.margin;
  if (!near || q.climbs()) least = -std::numeric_limits<double>::infinity();
  left.clear();
  p.faces_under(q_in_p * q.vertex(search.start), least, left);
  for (const int f : left) {
    const Polyhedron::Face& face = p.face(f);
    const double bound = face.normal.dot(center) - face.offset - q.inner_radius();
    if (f == first || bound < search.chosen) continue;
    try_face(p, f, q, q_in_p, kind, search);
  }
}

// Collects the edges of p that reach above a plane, normal.x >= height in p's frame; `place` maps
// an edge to A's frame.
template <class Place>
void edges_above(const Polyhedron& p, const Vec3& normal, double height, const Place& place,
                 std::vector<PlacedEdge>& out) {
  // those at the few vertices above it, ascending
  thread_local std::vector<int> numbers;
  numbers.clear();
  const int count = static_cast<int>(p.vertices().size());
  for (int v = 0; v < count; ++v)
    if (normal.dot(p.vertex(v)) >= height)
      for (const Polyhedron::Link& link : p.links(v)) numbers.push_back(link.edge);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  out.clear();
  for (const int e : numbers) {
    const Polyhedron::Edge& edge = p.edges()[static_cast<std::size_t>(e)];
    const Vec3& tail = p.vertex(edge.tail);
    out.push_back(
        {e, tail, p.vertex(edge.head) - tail, p.face(edge.left).normal, p.face(edge.right).normal});
    place(out.back());
  }
}

// Whether the arc between the normals of edge a crosses that between the negated normals of b: then
// the two edges span a face of the Minkowski difference.
bool arcs_cross(const PlacedEdge& a, const PlacedEdge& b) {
  // each arc straddles the plane of the other, and both on the same half of the sphere
  const double left_b = b.left.dot(a.along);
  const double right_b = b.right.dot(a.along);
  if (!(left_b * right_b < 0)) return false;
  const double left_a = a.left.dot(b.along);
  const double right_a = a.right.dot(b.along);
  return left_a * right_a < 0 && left_b * right_a < 0;
}

// The unit axis square to both edges, outward from A; zero where they are parallel.
Vec3 edge_axis(const PlacedEdge& a, const PlacedEdge& b) {
  Vec3 n = a.along.cross(b.along);
  const double square = n.squaredNorm();
  if (!(square > parallel_edges * parallel_edges * a.along.squaredNorm() * b.along.squaredNorm()))
    return Vec3::Zero();
  n /= std::sqrt(square);
  // nearly parallel edges: what rounding left along them would tilt the axis out of the arcs
  n -= a.along * (n.dot(a.along) / a.along.squaredNorm());
  n -= b.along * (n.dot(b.along) / b.along.squaredNorm());
  n.normalize();
  return n.dot(a.left + a.right) < 0 ? Vec3(-n) : n;
}

void try_edges(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a, double reach,
               Search& search) {
  thread_local std::vector<PlacedEdge> edges_a;
  thread_local std::vector<PlacedEdge> edges_b;
  // edges that meet when B is moved out by at most `reach` come near the slab between the planes
  // of the best face axis: A lies below `top`, B above top + chosen
  const Vec3 n = search.best.normal;
  const double top = a.extent(n, 0);
  edges_above(
      a, n, top + search.chosen - reach, [](PlacedEdge&) {}, edges_a);
  const auto place = [&](PlacedEdge& edge) {
    edge.tail = b_in_a * edge.tail;
    for (Vec3* direction : {&edge.along, &edge.left, &edge.right})
      *direction = b_in_a.R * *direction;
  };
  edges_above(b, -(b_in_a.R.transpose() * n), n.dot(b_in_a.p) - (top + reach), place, edges_b);
  for (const PlacedEdge& ea : edges_a)
    for (const PlacedEdge& eb : edges_b) {
      if (!arcs_cross(ea, eb)) continue;
      const Vec3 axis = edge_axis(ea, eb);
      // a bound by the edges alone (the zero axis included), then by support points
      if (!(axis.dot(eb.tail - ea.tail) > search.chosen) || axis.isZero(0)) continue;
      const int tail_b = b.edges()[static_cast<std::size_t>(eb.number)].tail;
      const int tail_a = a.edges()[static_cast<std::size_t>(ea.number)].tail;
      const Vec3 back = -(b_in_a.R.transpose() * axis);
      const double s =
          axis.dot(b_in_a * b.vertex(b.support(back, tail_b))) - a.extent(axis, tail_a);
      if (!search.takes(s)) continue;
      search.best = {AxisKind::edges, 0, axis, ea.number, eb.number};
    }
}

}  // namespace

LeastAxis least_axis(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a, double gap,
                     const LeastAxis* known) {
  Search search;
  const double size = a.radius() + b.radius();
  search.margin = tie * size;
  if (known != nullptr) {
    search.best = *known;
    search.chosen = search.greatest = known->distance;
  }
  try_faces(a, b, b_in_a, AxisKind::face_a, search);
  // A seen from B's frame; a face of B points from B to A
  const Mat3 back = b_in_a.R.transpose();
  const Frame a_in_b(back, -(back * b_in_a.p));
  const double before = search.chosen;
  try_faces(b, a, a_in_b, AxisKind::face_b, search);
  if (search.chosen != before) search.best.normal = -(b_in_a.R * search.best.normal);
  // moving B by at most -s along the answer makes the two edges meet
  try_edges(a, b, b_in_a, std::max(gap, -search.chosen) + left_out_slack * size, search);
  search.best.distance = search.greatest;
  return search.best;
}

void nearest_on_segments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v, Vec3& on_u,
                         Vec3& on_v) {
  const Vec3 r = p - q;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double ur = u.dot(r);
  const double vr = v.dot(r);
  const double det = uu * vv - uv * uv;
  // minimise |r + s u - t v|^2, clamping s, then t, then s again; lines that are parallel up to
  // rounding leave s free
  constexpr double rounding = 1e-15;
  double s = det > rounding * uu * vv ? std::clamp((uv * vr - vv * ur) / det, 0.0, 1.0) : 0.0;
  double t = (uv * s + vr) / vv;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
  }
  on_u = p + s * u;
  on_v = q + t * v;
}

}  // namespace tw
