// The axis of least penetration by climbing over the faces of the Minkowski difference.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/axis-climb.h"

#include <algorithm>

namespace tw {

namespace {

// below this squared sine of their angle two edges count as parallel
constexpr double edges_parallel = 1e-8;

// neighbours whose height falls by less than this, relative to their distance, do not take over
constexpr double height_slack = 1e-13;

// A face of the Minkowski difference with the foot of the origin.
struct Place {
  LeastAxis axis;
  double room = 0;  // m, from the foot to the nearest side; negative: how far it is beyond
  int side =
      0;  // the nearest side: of a face by its number; of edges 0, 1: tail, head of A's; 2, 3
};

struct Climber {
  const Polyhedron& a;
  const Polyhedron& b;
  const Frame& b_in_a;
  Frame a_in_b;

  Climber(const Polyhedron& core_a, const Polyhedron& core_b, const Frame& frame)
      : a(core_a), b(core_b), b_in_a(frame) {
    a_in_b.R = frame.R.transpose();
    a_in_b.p = -(a_in_b.R * frame.p);
  }

  Place start() const;
  bool cross(Place& place) const;
  bool proven(const Place& place) const;

 private:
  void on_face(Place& place) const;
  Place face_of_a(int face, int vertex_b) const;
  Place face_of_b(int vertex_a, int face) const;
  bool edges(int edge_a, int edge_b, Place& place) const;
  bool turn_about_a(int edge_a, int next_face, int vertex_b, const Vec3& n, Place& place) const;
  bool turn_about_b(int edge_b, int next_face, int vertex_a, const Vec3& n, Place& place) const;
};

// The side of the face that is nearest to the point or the farthest beyond.
void nearest_side(const Polyhedron& p, int number, const Vec3& point, Place& place) {
  const Polyhedron::Face& face = p.face(number);
  place.room = 1e300;
  for (int i = face.first; i < face.first + face.count; ++i) {
    const double in = p.side(i).inward.dot(point) - p.side(i).offset;
    if (!(in < place.room)) continue;
    place.room = in;
    place.side = i;
  }
}

Place Climber::face_of_a(int face, int vertex_b) const {
  Place place;
  const Vec3 point = b_in_a * b.vertex(vertex_b);
  const Vec3& normal = a.face(face).normal;
  place.axis = {AxisKind::face_a, normal.dot(point) - a.face(face).offset, normal, face, vertex_b};
  nearest_side(a, face, point, place);
  return place;
}

Place Climber::face_of_b(int vertex_a, int face) const {
  Place place;
  const Vec3 point = a_in_b * a.vertex(vertex_a);
  const Vec3& normal = b.face(face).normal;
  place.axis = {AxisKind::face_b, normal.dot(point) - b.face(face).offset, -(b_in_a.R * normal),
                vertex_a, face};
  nearest_side(b, face, point, place);
  return place;
}

// False where the edges are nearly parallel.
bool Climber::edges(int edge_a, int edge_b, Place& place) const {
  const Polyhedron::Edge& ea = a.edges()[static_cast<std::size_t>(edge_a)];
  const Polyhedron::Edge& eb = b.edges()[static_cast<std::size_t>(edge_b)];
  const Vec3& p = a.vertex(ea.tail);
  const Vec3 u = a.vertex(ea.head) - p;
  const Vec3 q = b_in_a * b.vertex(eb.tail);
  const Vec3 v = b_in_a.R * (b.vertex(eb.head) - b.vertex(eb.tail));
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double det = uu * vv - uv * uv;
  if (!(det > edges_parallel * uu * vv)) return false;
  Vec3 n = u.cross(v) / std::sqrt(det);
  n -= u * (n.dot(u) / uu);
  n -= v * (n.dot(v) / vv);
  n.normalize();
  if (n.dot(a.face(ea.left).normal + a.face(ea.right).normal) < 0) n = -n;
  place.axis = {AxisKind::edges, n.dot(q - p), n, edge_a, edge_b};
  // the foot in the parallelogram: |r + s u - t v| least
  const Vec3 r = p - q;
  const double ur = u.dot(r);
  const double vr = v.dot(r);
  const double length_a = std::sqrt(uu);
  const double length_b = std::sqrt(vv);
  const double s = (uv * vr - vv * ur) / det;
  const double t = (uu * vr - uv * ur) / det;
  const double rooms[4] = {s * length_a, (1 - s) * length_a, t * length_b, (1 - t) * length_b};
  place.side = static_cast<int>(std::min_element(rooms, rooms + 4) - rooms);
  place.room = rooms[place.side] * std::sqrt(det) / (length_a * length_b);
  return true;
}

// While the axis turns from n to m, which neighbour of the vertex becomes as deep as the vertex
// first. `sign` +1: deep is low along the axis; -1: high.
const Polyhedron::Link* first_to_take_over(const Polyhedron& p, int vertex, const Vec3& n,
                                           const Vec3& m, double sign) {
  const Polyhedron::Link* first = nullptr;
  double least = 2;
  double steepest = 0;
  for (const Polyhedron::Link& link : p.links(vertex)) {
    const Vec3 d = sign * (p.vertex(link.vertex) - p.vertex(vertex));
    const double after = d.dot(m);
    const double square = d.squaredNorm();
    if (!(after < 0 && after * after > height_slack * height_slack * square)) continue;
    // the height (1 - tau) before + tau after is 0
    const double before = std::max(d.dot(n), 0.0);
    const double tau = before / (before - after);
    if (tau > least + height_slack) continue;
    // at ties the steepest
    const double slope = after * after / square;
    if (tau > least - height_slack && slope < steepest) continue;
    least = tau;
    steepest = slope;
    first = &link;
  }
  return first;
}

bool Climber::turn_about_a(int edge_a, int next_face, int vertex_b, const Vec3& n,
                           Place& place) const {
  const Polyhedron::Link* link =
      first_to_take_over(b, vertex_b, a_in_b.R * n, a_in_b.R * a.face(next_face).normal, 1);
  if (link != nullptr) return edges(edge_a, link->edge, place);
  place = face_of_a(next_face, vertex_b);
  return true;
}

bool Climber::turn_about_b(int edge_b, int next_face, int vertex_a, const Vec3& n,
                           Place& place) const {
  const Polyhedron::Link* link =
      first_to_take_over(a, vertex_a, n, -(b_in_a.R * b.face(next_face).normal), -1);
  if (link != nullptr) return edges(link->edge, edge_b, place);
  place = face_of_b(vertex_a, next_face);
  return true;
}

// Moves across the side that the foot is beyond.  False where edges are nearly parallel.
bool Climber::cross(Place& place) const {
  const LeastAxis axis = place.axis;
  const auto other_face = [](const Polyhedron& p, int edge, int face) {
    const Polyhedron::Edge& e = p.edges()[static_cast<std::size_t>(edge)];
    return e.left == face ? e.right : e.left;
  };
  if (axis.kind == AxisKind::face_a) {
    const int edge = a.side(place.side).edge;
    return turn_about_a(edge, other_face(a, edge, axis.feature_a), axis.feature_b, axis.normal,
                        place);
  }
  if (axis.kind == AxisKind::face_b) {
    const int edge = b.side(place.side).edge;
    return turn_about_b(edge, other_face(b, edge, axis.feature_b), axis.feature_a, axis.normal,
                        place);
  }
  const Polyhedron::Edge& ea = a.edges()[static_cast<std::size_t>(axis.feature_a)];
  const Polyhedron::Edge& eb = b.edges()[static_cast<std::size_t>(axis.feature_b)];
  const bool at_tail = place.side % 2 == 0;
  if (place.side < 2) {
    // over an end of A's edge: about B's, to its face that lies that way
    const Vec3 out = (at_tail ? -1 : 1) * (a.vertex(ea.head) - a.vertex(ea.tail));
    const Vec3 out_b = a_in_b.R * out;
    const bool left = b.face(eb.left).normal.dot(out_b) < b.face(eb.right).normal.dot(out_b);
    return turn_about_b(axis.feature_b, left ? eb.left : eb.right, at_tail ? ea.tail : ea.head,
                        axis.normal, place);
  }
  // over an end of B's edge, M = A - B: about A's
  const Vec3 out = (at_tail ? 1 : -1) * (b_in_a.R * (b.vertex(eb.head) - b.vertex(eb.tail)));
  const bool left = a.face(ea.left).normal.dot(out) > a.face(ea.right).normal.dot(out);
  return turn_about_a(axis.feature_a, left ? ea.left : ea.right, at_tail ? eb.tail : eb.head,
                      axis.normal, place);
}

// The faces most opposite the other's centre, each with the deepest vertex; the one less deep.
Place Climber::start() const {
  int face_a = 0;
  int face_b = 0;
  a.face_separation(b_in_a * b.center(), face_a);
  b.face_separation(a_in_b * a.center(), face_b);
  const Place of_a = face_of_a(face_a, b.support(-(a_in_b.R * a.face(face_a).normal), 0));
  const Place of_b = face_of_b(a.support(-(b_in_a.R * b.face(face_b).normal), 0), face_b);
  return of_b.axis.distance > of_a.axis.distance ? of_b : of_a;
}

// Whether the hull of the disc and the ball holds the ball of radius `depth` about the origin.
//
// With nu the axis and a direction cos(phi) nu + sin(phi) u, the disc reaches depth cos(phi) +
// room sin(phi), which is enough up to tan(phi/2) = room/depth.  For the rest, at most psi from -nu
// with tan(psi/2) = depth/room, the ball about c must do: c.(-nu) cos(psi) - |c'| sin(psi) + R >=
// depth.
bool Climber::proven(const Place& place) const {
  const double depth = -place.axis.distance;
  const double room = place.room;
  if (!(room > depth)) return false;
  const Vec3 c = a.center() - b_in_a * b.center();
  const double below = -c.dot(place.axis.normal);
  const double aside = (c + below * place.axis.normal).norm();
  const double square = room * room + depth * depth;
  const double cos_psi = (room * room - depth * depth) / square;
  const double sin_psi = 2 * room * depth / square;
  return below > 0 &&
         below * cos_psi - aside * sin_psi + a.inner_radius() + b.inner_radius() > depth;
}

}  // namespace

Climb climb_to_axis(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a) {
  // from any face of small polyhedra a few steps lead to the nearest; big ones begin near it too
  constexpr int most_steps = 64;
  // a foot this near a side, relative to the size, is on it
  constexpr double on_side = 1e-12;
  const Climber climber(a, b, b_in_a);
  const double slack = on_side * (a.radius() + b.radius());
  Place place = climber.start();
  for (int step = 0; step < most_steps; ++step) {
    const bool inside = place.room >= -slack;
    if (place.axis.distance > 0) return {inside ? ClimbEnd::apart : ClimbEnd::beyond, place.axis};
    if (inside) return {climber.proven(place) ? ClimbEnd::proven : ClimbEnd::local, place.axis};
    if (!climber.cross(place)) return {};
  }
  return {};
}

}  // namespace tw
