// Convex polyhedra: vertices, polygonal faces, edges and the vertex graph.
//
// Invariants (checked by the constructor, `validate`): every edge has exactly two faces, which run
// along it in opposite directions; V - E + F = 2; no vertex lies outside a face by more than
// 1e-12 of the size.
//
// Cost: support is a sign test for boxes, a vectorised scan up to 32 vertices, hill climbing on the
// vertex graph above (a few steps when started near the answer).
//
// Frames: everything in the polyhedron's own frame, metres.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "math/aabb.h"
#include "math/vec.h"

namespace tw {

class Polyhedron {
 public:
  // A polygon, counter-clockwise seen from outside; solid where normal.x <= offset.
  struct Face {
    Vec3 normal = Vec3::UnitZ();
    double offset = 0;
    int first = 0;  // its corners are corner(first) .. corner(first + count - 1)
    int count = 0;
    double area = 0;
  };
  // The side of a face from one of its corners to the next: in the face's plane, the face lies
  // where inward.x >= offset.
  struct Side {
    Vec3 inward = Vec3::UnitX();
    double offset = 0;
    int edge = 0;
  };
  // A neighbour of a vertex and the edge to it.
  struct Link {
    int vertex = 0;
    int edge = 0;
  };
  // An edge runs from tail to head with the face `left` on its left seen from outside, so that
  // head - tail points along normal(left) x normal(right).
  struct Edge {
    int tail = 0;
    int head = 0;
    int left = 0;
    int right = 0;
  };

  // Faces list their vertices counter-clockwise seen from outside.  Raises UserError when the
  // faces do not close to a convex solid.
  Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces);
  // A box centred at the origin; bit k of a vertex's number says on which side of axis k it lies.
  static Polyhedron box(const Vec3& half_edges);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const Vec3& vertex(int i) const { return vertices_[static_cast<std::size_t>(i)]; }
  const std::vector<Face>& faces() const { return faces_; }
  const Face& face(int i) const { return faces_[static_cast<std::size_t>(i)]; }
  const std::vector<Edge>& edges() const { return edges_; }
  int corner(int i) const { return corners_[static_cast<std::size_t>(i)]; }
  // The side that begins at corner(i).
  const Side& side(int i) const { return sides_[static_cast<std::size_t>(i)]; }
  // The neighbours of a vertex.
  std::span<const Link> links(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return {links_.data() + first_link_[v], links_.data() + first_link_[v + 1]};
  }
  bool is_box() const { return is_box_; }

  // A point inside (the middle of the bounding box where that is inside, else the mean of the
  // vertices) and the radius of the ball around it that holds all.
  const Vec3& center() const { return center_; }
  double radius() const { return radius_; }
  const Aabb& bounds() const { return bounds_; }
  // A ball around center() inside the solid.
  double inner_radius() const { return inner_radius_; }

  // A vertex farthest along `direction` (any length); `start` is where hill climbing begins.
  int support(const Vec3& direction, int start) const {
    if (is_box_)
      return (direction.x() > 0 ? 1 : 0) | (direction.y() > 0 ? 2 : 0) |
             (direction.z() > 0 ? 4 : 0);
    return scans_ ? scan(direction) : climb(direction, start);
  }
  // Whether `support` is hill climbing, where `start` decides between equals.
  bool climbs() const { return !is_box_ && !scans_; }
  // The same as the value max over the solid of direction.x.
  double extent(const Vec3& direction, int start) const {
    return direction.dot(vertex(support(direction, start)));
  }

  // Appends the faces over whose planes the point is no lower than `height`, up to rounding,
  // ascending.
  void faces_under(const Vec3& point, double height, std::vector<int>& out) const;
  // Greatest signed distance of the point over all face planes, and that face: positive outside,
  // minus the depth inside.  Ties: the first face.
  double face_separation(const Vec3& point, int& best_face) const;
  // The face at this vertex whose normal is most along `direction`.  Ties: the first.
  int face_at_vertex(int vertex, const Vec3& direction) const;

 private:
  Polyhedron() = default;
  void set_faces(const std::vector<std::vector<int>>& faces);
  void set_sides();
  void set_edges();
  void set_links();
  void set_bounds();
  void set_lanes();
  void validate() const;
  int scan(const Vec3& direction) const;
  int climb(const Vec3& direction, int start) const;

  std::vector<Vec3> vertices_;
  std::vector<Face> faces_;
  std::vector<int> corners_;
  std::vector<Side> sides_;
  std::vector<Edge> edges_;
  // compressed rows: the links and the faces of vertex i start at first_..._[i]
  std::vector<int> first_link_;
  std::vector<Link> links_;
  std::vector<int> first_vertex_face_, vertex_faces_;
  // x, y, z of four vertices after each other, padded with the last vertex: what `scan` reads
  std::vector<double> lanes_;
  // x, y, z, offset of four face planes, padded with the last
  std::vector<double> plane_lanes_;
  Vec3 center_ = Vec3::Zero();
  double radius_ = 0;
  double inner_radius_ = 0;
  Aabb bounds_;
  bool is_box_ = false;
  bool scans_ = true;
};

}  // namespace tw
