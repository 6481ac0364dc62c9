// Shapes: immutable unions of placed convex parts.
//
// Every shape is a list of convex parts in the body's frame, of few kinds: a box or hull is a
// polyhedron; cylinder, cone and capsule are *frustums*: what a line that need not be parallel to
// the axis sweeps out about it, and all points within a margin of that.  A kind is a row in the
// tables of pairs in collision/distance/separation.cc and collision/manifold/manifold.cc.  The
// parts of height fields and meshes are made when they are asked for; shapes of many parts have a
// tree over them.
//
// Units: metres.  All constructors raise UserError on values that are not finite, not positive, or
// flat, and say which value.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "math/aabb.h"
#include "math/vec.h"

namespace tw {

class HeightField;
class LazyParts;
class MeshGround;
struct MeshFaults;
class PartTree;
class Polyhedron;
class Shape;
using ShapePtr = std::shared_ptr<const Shape>;

using MeshTriangle = std::array<std::uint32_t, 3>;  // numbers of points

enum class PartKind { sphere, polyhedron, half_space, frustum, ellipsoid };

// One convex part, placed in the frame of the shape.
struct ConvexPart {
  PartKind kind = PartKind::sphere;
  double radius = 0;                       // sphere: its radius; frustum: at -half_length
  double top_radius = 0;                   // frustum: at +half_length
  double half_length = 0;                  // frustum: along z of the part's frame, to either side
  double margin = 0;                       // frustum: and what is within this of it
  Vec3 semi_axes = Vec3::Zero();           // ellipsoid: along the axes of the part's frame
  std::shared_ptr<const Polyhedron> core;  // polyhedron only, in the part's frame
  Vec3 normal = Vec3::UnitZ();             // half-space: outward unit normal, shape's frame
  double offset = 0;                       // half-space: solid where normal.x <= offset
  // A ball around the part, shape's frame; infinite radius for a half-space.
  Vec3 bound_center = Vec3::Zero();
  double bound_radius = 0;
  bool is_box = false;  // a box keeps its half edges for drawing
  Vec3 half_edges = Vec3::Zero();

  // The part's frame in the shape's.
  const Frame& placement() const { return placement_; }
  void place(const Frame& placement);
  // The part's frame where its shape's is this one; most lie in their shapes as they are.
  Frame in(const Frame& shape) const { return is_placed_ ? shape * placement_ : shape; }

 private:
  Frame placement_;
  bool is_placed_ = false;  // by more than nothing
};

// Volume integrals at density 1.  Frames: the shape's own; inertia about the centroid.
struct MassProperties {
  double volume = 0;
  Vec3 centroid = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
};

class Shape {
 public:
  // All parts, of shapes that have no lazy ones.
  const std::vector<ConvexPart>& parts() const;
  // Of any shape.  A number may be that of no part: of lazy ones those that the tree does not name.
  std::size_t part_count() const { return lazy_ ? lazy_count() : parts_.size(); }
  const ConvexPart& part(std::size_t i) const { return lazy_ ? lazy_part(i) : parts_[i]; }
  // Whether the number is that of a part.
  bool has_part(std::size_t i) const { return !lazy_ || lazy_has(i); }
  // Over the parts, in the shape's frame; null: they are few.
  const PartTree* tree() const { return tree_.get(); }
  // Whether its parts are made when they are asked for.
  bool has_lazy_parts() const { return lazy_ != nullptr; }
  // Null: it is none.
  const HeightField* height_field() const;
  const MeshGround* mesh() const;
  // False for a half-space (and unions that hold one).
  bool bounded() const { return bounded_; }
  // Half-spaces, height fields and meshes are ground, not bodies that could move freely.
  bool is_ground() const { return !bounded_ || lazy_; }
  // Exact, the parts of a union added up (an overlap counts twice).  Not of ground.
  const MassProperties& mass_properties() const { return mass_; }
  // Least width of the bounding box, m: the `size` of contact parameters.  Of a height field the
  // least of its sides, of a mesh the middle one of its three, infinite if unbounded.
  double least_width() const { return least_width_; }
  // Least width of the boxes of its parts, each along the axes of its own frame, m: a wall's
  // thickness, however large the room is.  Of a mesh what is solid beneath nearly all of it, of a
  // height field the least of its sides.
  double thickness() const { return thickness_; }
  // The smallest ball around the frame's origin that holds the shape (bound by the parts' farthest
  // points, exact but for ellipsoids about another centre), m.
  double radius_about_origin() const { return radius_about_origin_; }
  // No point is farther from the line through the origin, m (exact but for tilted frustums and
  // ellipsoids that are off it).
  double radius_about_line(const Vec3& direction) const;
  // The shape's bounds when its frame is placed at `frame`, m.  Exact, but of lazy parts that are
  // turned: the bounds of their box.
  Aabb bounds(const Frame& frame) const;
  // One word for messages: "sphere", "box", "hull", "cylinder", "cone", "union" and so on.
  const std::string& kind_name() const { return kind_name_; }
  // True for a single sphere centred anywhere.
  bool is_sphere() const { return parts_.size() == 1 && parts_[0].kind == PartKind::sphere; }
  bool is_half_space() const {
    return parts_.size() == 1 && parts_[0].kind == PartKind::half_space;
  }

 private:
  friend ShapePtr finish_shape(std::vector<ConvexPart> parts, std::string kind_name,
                               const MassProperties& mass);
  friend ShapePtr finish_ground(std::shared_ptr<const LazyParts> parts, std::string kind_name,
                                double least_width, double thickness);
  std::size_t lazy_count() const;
  bool lazy_has(std::size_t i) const;
  const ConvexPart& lazy_part(std::size_t i) const;

  std::vector<ConvexPart> parts_;
  std::shared_ptr<const LazyParts> lazy_;
  std::shared_ptr<const PartTree> tree_;
  MassProperties mass_;
  bool bounded_ = true;
  double least_width_ = 0, thickness_ = 0;
  double radius_about_origin_ = 0;
  std::string kind_name_;
};

ShapePtr make_sphere(double radius);
// Full edges, centred at the origin.
ShapePtr make_box(const Vec3& edges);
// About the z axis, from -length/2 to length/2.
ShapePtr make_cylinder(double radius, double length);
// About the z axis: all points within the radius of a segment from -length/2 to length/2.
ShapePtr make_capsule(double radius, double length);
// About the z axis, the centroid at the origin: the base at -height/4, the tip at 3/4 height.
ShapePtr make_cone(double radius, double height);
// Semi-axes along x, y and z.
ShapePtr make_ellipsoid(const Vec3& semi_axes);
// The convex hull of the points (Qhull).  The frame is the points' own: the centroid need not be
// at the origin.
ShapePtr make_hull(const std::vector<Vec3>& points);
// Solid where normal.x <= offset; the normal is normalised.
ShapePtr make_half_space(const Vec3& normal, double offset);
// Ground by its heights over a rectangular grid: see geometry/height-field.h.  `colors`: sRGB, one
// a height, or none.
ShapePtr make_height_field(std::vector<double> heights, std::size_t columns, double spacing_x,
                           double spacing_y, std::vector<Vec3> colors = {});
// Ground by its surface, however concave: see geometry/mesh-ground.h.  Three corners a triangle,
// counter-clockwise from outside, with numbers of points.  `faults`: of the triangles, if wanted.
ShapePtr make_mesh(const std::vector<Vec3>& points, const std::vector<MeshTriangle>& triangles,
                   MeshFaults* faults = nullptr);
ShapePtr make_union(const std::vector<ShapePtr>& shapes);
// With a mass of its own, where overlaps are not to count twice.
ShapePtr make_union(const std::vector<ShapePtr>& shapes, const MassProperties& mass);
// The shape moved by `pose` within the body's frame.
ShapePtr place_shape(const ShapePtr& shape, const Pose& pose);
// The bounds of one part when the frame of its shape is placed at `frame`, m.  Exact.
Aabb part_bounds(const ConvexPart& part, const Frame& frame);

}  // namespace tw
