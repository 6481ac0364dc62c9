// Shapes: constructors, bounds and mass properties of unions of placed convex parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/limits.h"
#include "geometry/height-field.h"
#include "geometry/hull.h"
#include "geometry/mass-properties.h"
#include "geometry/mesh-ground.h"
#include "geometry/part-tree.h"
#include "geometry/polyhedron.h"

namespace tw {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Unions of more parts than these have a tree.
constexpr std::size_t few_parts = 32;

}  // namespace

void ConvexPart::place(const Frame& placement) {
  placement_ = placement;
  is_placed_ = placement.p != Vec3::Zero() || placement.R != Mat3::Identity();
}

namespace {

// The vertices' box in the frame, exact for boxes by half edges, else over all vertices.
Aabb polyhedron_bounds(const ConvexPart& part, const Frame& frame) {
  Aabb box;
  const Frame world = part.in(frame);
  if (part.is_box) {
    // a box reaches sum_j |R_ij| h_j along axis i
    const Vec3 reach = world.R.cwiseAbs() * part.half_edges;
    box.add(world.p - reach);
    box.add(world.p + reach);
    return box;
  }
  const Vec3 x = world.R.row(0), y = world.R.row(1), z = world.R.row(2);
  for (const Vec3& v : part.core->vertices()) box.add(Vec3(x.dot(v), y.dot(v), z.dot(v)));
  return {box.lo + world.p, box.hi + world.p};
}

Aabb half_space_bounds(const ConvexPart& part, const Frame& frame) {
  Aabb box;
  box.lo.setConstant(-infinity);
  box.hi.setConstant(infinity);
  const Vec3 n = frame.R * part.normal;
  const double offset = part.offset + n.dot(frame.p);
  // bounded along an axis only when the plane is exactly square to it
  for (int axis = 0; axis < 3; ++axis)
    if (n[(axis + 1) % 3] == 0 && n[(axis + 2) % 3] == 0) {
      if (n[axis] > 0) box.hi[axis] = offset;
      if (n[axis] < 0) box.lo[axis] = -offset;
    }
  return box;
}

// Either end of a frustum reaches +-h a_i + r sqrt(1 - a_i^2) along axis i, a its own axis.
Aabb frustum_bounds(const ConvexPart& part, const Frame& frame) {
  const Frame world = part.in(frame);
  Vec3 up, down;
  for (int i = 0; i < 3; ++i) {
    const double along = part.half_length * world.R(i, 2);
    const double across = std::hypot(world.R(i, 0), world.R(i, 1));
    const double bottom = part.radius * across, top = part.top_radius * across;
    up[i] = std::max(along + top, bottom - along) + part.margin;
    down[i] = std::max(along + bottom, top - along) + part.margin;
  }
  Aabb box;
  box.add(world.p - down);
  box.add(world.p + up);
  return box;
}

// An ellipsoid reaches |A R^T e_i| along axis i.
Aabb ellipsoid_bounds(const ConvexPart& part, const Frame& frame) {
  const Frame world = part.in(frame);
  const Vec3 reach = (world.R * part.semi_axes.asDiagonal()).rowwise().norm();
  Aabb box;
  box.add(world.p - reach);
  box.add(world.p + reach);
  return box;
}

double radius_about_origin_of(const ConvexPart& part) {
  if (part.kind == PartKind::half_space) return infinity;
  if (part.kind == PartKind::sphere) return part.placement().p.norm() + part.radius;
  if (part.kind == PartKind::ellipsoid)
    return part.placement().p.norm() + part.semi_axes.maxCoeff();
  if (part.kind == PartKind::frustum) {
    // the farthest point of the rims
    const double along = part.placement().p.dot(part.placement().R.col(2));
    const double across = (part.placement().p - along * part.placement().R.col(2)).norm();
    return std::max(std::hypot(along + part.half_length, across + part.top_radius),
                    std::hypot(along - part.half_length, across + part.radius)) +
           part.margin;
  }
  double radius = 0;
  for (const Vec3& v : part.core->vertices())
    radius = std::max(radius, (part.placement() * v).norm());
  return radius;
}

double radius_about_line_of(const ConvexPart& part, const Vec3& direction) {
  if (part.kind == PartKind::half_space) return infinity;
  const auto off = [&](const Vec3& p) { return p.cross(direction).norm(); };
  if (part.kind == PartKind::polyhedron) {
    double radius = 0;
    for (const Vec3& v : part.core->vertices())
      radius = std::max(radius, off(part.placement() * v));
    return radius;
  }
  const Vec3 p = part.placement().p;
  if (part.kind == PartKind::ellipsoid) {
    // |A R^T u| over the unit vectors u square to the line
    const Mat3 square = Mat3::Identity() - direction * direction.transpose();
    const Mat3 reach = square * part.placement().R * part.semi_axes.asDiagonal();
    return off(p) + std::sqrt(Eigen::SelfAdjointEigenSolver<Mat3>(reach * reach.transpose(),
                                                                  Eigen::EigenvaluesOnly)
                                  .eigenvalues()
                                  .maxCoeff());
  }
  const Vec3 cap = part.half_length * part.placement().R.col(2);
  const double bottom = part.kind == PartKind::frustum ? part.radius : 0;
  const double top = part.kind == PartKind::frustum ? part.top_radius : 0;
  const double margin = part.kind == PartKind::sphere ? part.radius : part.margin;
  return std::max(off(p + cap) + top, off(p - cap) + bottom) + margin;
}

ConvexPart polyhedron_part(Polyhedron polyhedron) {
  ConvexPart part;
  part.kind = PartKind::polyhedron;
  part.core = std::make_shared<const Polyhedron>(std::move(polyhedron));
  part.bound_center = part.core->center();
  part.bound_radius = part.core->radius();
  return part;
}

ConvexPart frustum_part(double bottom_radius, double top_radius, double length, double margin) {
  ConvexPart part;
  part.kind = PartKind::frustum;
  part.radius = bottom_radius;
  part.top_radius = top_radius;
  part.half_length = 0.5 * length;
  part.margin = margin;
  part.bound_radius = std::hypot(std::max(bottom_radius, top_radius), part.half_length) + margin;
  return part;
}

std::string lengths_text() {
  return "from " + tw::show(least_length) + " to " + tw::show(greatest_length) + " m";
}

void require_length(const char* what, double value) {
  TW_REQUIRE(value > 0 && std::isfinite(value),
             std::string(what) + " is " + show(value) + "; expected a positive number of metres");
  TW_REQUIRE(value >= least_length && value <= greatest_length,
             std::string(what) + " is " + show(value) + " m; expected a length " + lengths_text());
}

std::string show(const Vec3& v) {
  return "(" + tw::show(v.x()) + " " + tw::show(v.y()) + " " + tw::show(v.z()) + ")";
}

}  // namespace

Aabb part_bounds(const ConvexPart& part, const Frame& frame) {
  switch (part.kind) {
    case PartKind::half_space: return half_space_bounds(part, frame);
    case PartKind::polyhedron: return polyhedron_bounds(part, frame);
    case PartKind::frustum: return frustum_bounds(part, frame);
    case PartKind::ellipsoid: return ellipsoid_bounds(part, frame);
    case PartKind::sphere: break;
  }
  Aabb box;
  box.add(frame * part.placement().p);
  box.grow(part.radius);
  return box;
}

ShapePtr finish_shape(std::vector<ConvexPart> parts, std::string kind_name,
                      const MassProperties& mass) {
  auto shape = std::make_shared<Shape>();
  shape->parts_ = std::move(parts);
  shape->kind_name_ = std::move(kind_name);
  for (const ConvexPart& part : shape->parts_) {
    if (part.kind == PartKind::half_space) shape->bounded_ = false;
    shape->radius_about_origin_ =
        std::max(shape->radius_about_origin_, radius_about_origin_of(part));
  }
  if (shape->bounded_ && shape->parts_.size() > few_parts) {
    std::vector<Aabb> boxes;
    for (const ConvexPart& part : shape->parts_) boxes.push_back(part_bounds(part, Frame()));
    shape->tree_ = std::make_shared<const PartTree>(boxes);
  }
  shape->mass_ = shape->bounded_ ? mass : MassProperties{};
  shape->least_width_ = shape->bounded_ ? shape->bounds(Frame()).size().minCoeff() : infinity;
  shape->thickness_ = shape->least_width_;
  if (shape->parts_.size() > 1)
    for (const ConvexPart& part : shape->parts_)
      if (part.kind != PartKind::half_space)
        shape->thickness_ =
            std::min(shape->thickness_,
                     part_bounds(part, Frame(part.placement().R.transpose(), Vec3::Zero()))
                         .size()
                         .minCoeff());
  TW_REQUIRE(!shape->bounded_ || (shape->least_width_ >= least_length &&
                                  shape->radius_about_origin_ <= 4 * greatest_length),
             "a " + shape->kind_name_ + " is " + show(shape->least_width_) +
                 " m wide and reaches " + show(shape->radius_about_origin_) +
                 " m from its origin; expected lengths " + lengths_text());
  return shape;
}

ShapePtr finish_ground(std::shared_ptr<const LazyParts> parts, std::string kind_name,
                       double least_width, double thickness) {
  auto shape = std::make_shared<Shape>();
  shape->kind_name_ = std::move(kind_name);
  // the tree belongs to the parts
  shape->tree_ = std::shared_ptr<const PartTree>(parts, &parts->tree());
  shape->lazy_ = std::move(parts);
  shape->least_width_ = least_width;
  shape->thickness_ = thickness;
  const Aabb& box = shape->tree_->root().box;
  shape->radius_about_origin_ = box.lo.cwiseAbs().cwiseMax(box.hi.cwiseAbs()).norm();
  TW_REQUIRE(shape->radius_about_origin_ <= 4 * greatest_length,
             "a " + shape->kind_name_ + " reaches " + show(shape->radius_about_origin_) +
                 " m from its origin; expected lengths " + lengths_text());
  return shape;
}

const std::vector<ConvexPart>& Shape::parts() const {
  TW_ASSERT(!lazy_, "all parts of a " + kind_name_ + " were asked for");
  return parts_;
}

std::size_t Shape::lazy_count() const { return lazy_->part_count(); }
bool Shape::lazy_has(std::size_t i) const { return lazy_->exists(i); }
const ConvexPart& Shape::lazy_part(std::size_t i) const { return lazy_->part(i); }

const HeightField* Shape::height_field() const {
  return dynamic_cast<const HeightField*>(lazy_.get());
}
const MeshGround* Shape::mesh() const { return dynamic_cast<const MeshGround*>(lazy_.get()); }

Aabb Shape::bounds(const Frame& frame) const {
  Aabb box;
  if (lazy_) {
    const Aabb& all = tree_->root().box;
    const Frame middle(frame.R, frame * all.center());
    const Vec3 reach = 0.5 * (frame.R.cwiseAbs() * all.size());
    box.add(middle.p - reach);
    box.add(middle.p + reach);
    return box;
  }
  for (const ConvexPart& part : parts_) box.add(part_bounds(part, frame));
  return box;
}

double Shape::radius_about_line(const Vec3& direction) const {
  double radius = 0;
  TW_ASSERT(!lazy_, "a " + kind_name_ + " does not turn freely");
  for (const ConvexPart& part : parts_)
    radius = std::max(radius, radius_about_line_of(part, direction.normalized()));
  return radius;
}

ShapePtr make_sphere(double radius) {
  require_length("the radius of a sphere", radius);
  ConvexPart part;
  part.kind = PartKind::sphere;
  part.radius = radius;
  part.bound_radius = radius;
  return finish_shape({part}, "sphere", sphere_mass(radius));
}

ShapePtr make_box(const Vec3& edges) {
  require_length("the x edge of a box", edges.x());
  require_length("the y edge of a box", edges.y());
  require_length("the z edge of a box", edges.z());
  ConvexPart part = polyhedron_part(Polyhedron::box(0.5 * edges));
  part.is_box = true;
  part.half_edges = 0.5 * edges;
  return finish_shape({part}, "box", box_mass(edges));
}

ShapePtr make_cylinder(double radius, double length) {
  require_length("the radius of a cylinder", radius);
  require_length("the length of a cylinder", length);
  return finish_shape({frustum_part(radius, radius, length, 0)}, "cylinder",
                      cylinder_mass(radius, length));
}

ShapePtr make_capsule(double radius, double length) {
  require_length("the radius of a capsule", radius);
  require_length("the length of a capsule", length);
  return finish_shape({frustum_part(0, 0, length, radius)}, "capsule",
                      capsule_mass(radius, length));
}

ShapePtr make_cone(double radius, double height) {
  require_length("the radius of a cone", radius);
  require_length("the height of a cone", height);
  ConvexPart part = frustum_part(radius, 0, height, 0);
  part.bound_center.z() = 0.25 * height;
  part.place({Mat3::Identity(), part.bound_center});
  return finish_shape({part}, "cone", cone_mass(radius, height));
}

ShapePtr make_ellipsoid(const Vec3& semi_axes) {
  require_length("the x semi-axis of an ellipsoid", semi_axes.x());
  require_length("the y semi-axis of an ellipsoid", semi_axes.y());
  require_length("the z semi-axis of an ellipsoid", semi_axes.z());
  ConvexPart part;
  part.kind = PartKind::ellipsoid;
  part.semi_axes = semi_axes;
  part.bound_radius = semi_axes.maxCoeff();
  return finish_shape({part}, "ellipsoid", ellipsoid_mass(semi_axes));
}

ShapePtr make_hull(const std::vector<Vec3>& points) {
  for (const Vec3& p : points)
    TW_REQUIRE(p.cwiseAbs().maxCoeff() <= greatest_length,
               "a point of a hull is " + show(p) + "; expected coordinates of at most " +
                   tw::show(greatest_length) + " m");
  Aabb box;
  for (const Vec3& p : points) box.add(p);
  TW_REQUIRE(points.empty() || box.size().maxCoeff() >= least_length,
             "the points of a hull are " + tw::show(box.size().maxCoeff()) +
                 " m apart; expected lengths " + lengths_text());
  const ConvexPart part = polyhedron_part(convex_hull(points));
  return finish_shape({part}, "hull", polyhedron_mass(*part.core));
}

ShapePtr make_half_space(const Vec3& normal, double offset) {
  TW_REQUIRE(is_finite(normal) && scaled_norm(normal) > 0 && std::isfinite(scaled_norm(normal)),
             "the normal of a half-space is " + show(normal) +
                 "; expected a finite vector that isn't zero");
  TW_REQUIRE(std::isfinite(offset),
             "the offset of a half-space is " + tw::show(offset) + "; expected a finite number");
  TW_REQUIRE(std::abs(offset) <= farthest, "the offset of a half-space is " + tw::show(offset) +
                                               " m; expected at most " + tw::show(farthest) + " m");
  ConvexPart part;
  part.kind = PartKind::half_space;
  part.normal = normal / scaled_norm(normal);
  part.offset = offset;
  part.bound_radius = infinity;
  return finish_shape({part}, "half-space", MassProperties{});
}

ShapePtr make_height_field(std::vector<double> heights, std::size_t columns, double spacing_x,
                           double spacing_y, std::vector<Vec3> colors) {
  require_length("the spacing of a height field along x", spacing_x);
  require_length("the spacing of a height field along y", spacing_y);
  TW_ASSERT(columns > 0 && heights.size() % columns == 0, "rows of different lengths");
  TW_REQUIRE(columns >= 2 && heights.size() / columns >= 2,
             "a height field has " + std::to_string(heights.size() / columns) + " rows of " +
                 std::to_string(columns) + " heights; expected at least 2 of 2");
  TW_REQUIRE(heights.size() <= most_heights,
             "a height field has " + std::to_string(heights.size()) +
                 " heights; expected at most " + std::to_string(most_heights));
  for (std::size_t i = 0; i < heights.size(); ++i)
    TW_REQUIRE(std::abs(heights[i]) <= greatest_length,
               "height " + std::to_string(i % columns) + " in row " + std::to_string(i / columns) +
                   " of a height field is " + show(heights[i]) +
                   "; expected a number of metres, at most " + tw::show(greatest_length));
  TW_REQUIRE(colors.empty() || colors.size() == heights.size(),
             "a height field has " + std::to_string(colors.size()) + " colors for " +
                 std::to_string(heights.size()) + " heights; expected one a height");
  for (std::size_t i = 0; i < colors.size(); ++i)
    TW_REQUIRE(is_finite(colors[i]) && colors[i].minCoeff() >= 0 && colors[i].maxCoeff() <= 1,
               "color " + std::to_string(i % columns) + " in row " + std::to_string(i / columns) +
                   " of a height field is #" + show(colors[i]) +
                   "; expected red, green and blue from 0 to 1");

  auto field = std::make_shared<const HeightField>(std::move(heights), columns, spacing_x,
                                                   spacing_y, std::move(colors));
  const Vec3 sides = field->tree().root().box.size();
  const double width = std::min(sides.x(), sides.y());
  return finish_ground(std::move(field), "height field", width, width);
}

ShapePtr make_mesh(const std::vector<Vec3>& points, const std::vector<MeshTriangle>& triangles,
                   MeshFaults* faults) {
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t corner : triangles[i])
      TW_REQUIRE(corner < points.size(), "triangle " + std::to_string(i) +
                                             " of a mesh has the corner " + std::to_string(corner) +
                                             "; expected a number below " +
                                             std::to_string(points.size()) + ", that of a point");
  for (const MeshTriangle& triangle : triangles)
    for (const std::uint32_t corner : triangle) {
      const Vec3& p = points[corner];
      TW_REQUIRE(is_finite(p) && p.cwiseAbs().maxCoeff() <= greatest_length,
                 "a point of a mesh is " + show(p) + "; expected coordinates of at most " +
                     tw::show(greatest_length) + " m");
    }
  MeshFaults found;
  auto mesh = std::make_shared<const MeshGround>(mesh_faces(points, triangles, found));
  if (faults) *faults = found;
  Vec3 sides = mesh->tree().root().box.size();
  std::sort(sides.begin(), sides.end());
  const double thickness = std::min(sides.y(), mesh->thickness());
  TW_REQUIRE(sides.y() >= least_length,
             "a mesh is " + show(sides.y()) + " m wide; expected lengths " + lengths_text());
  return finish_ground(std::move(mesh), "mesh", sides.y(), thickness);
}

ShapePtr make_union(const std::vector<ShapePtr>& shapes) {
  std::vector<MassProperties> masses;
  for (const ShapePtr& shape : shapes)
    if (shape) masses.push_back(shape->mass_properties());
  return make_union(shapes, summed_mass(masses));
}

ShapePtr make_union(const std::vector<ShapePtr>& shapes, const MassProperties& mass) {
  TW_REQUIRE(!shapes.empty(), "a union has no parts; expected at least one shape");
  std::vector<ConvexPart> parts;
  for (const ShapePtr& shape : shapes) {
    TW_REQUIRE(shape != nullptr, "a part of a union is not a shape");
    TW_REQUIRE(!shape->has_lazy_parts(), "a part of a union is a " + shape->kind_name() +
                                             "; expected it to be a body of its own");
    parts.insert(parts.end(), shape->parts().begin(), shape->parts().end());
  }
  return finish_shape(std::move(parts), "union", mass);
}

ShapePtr place_shape(const ShapePtr& shape, const Pose& pose) {
  TW_REQUIRE(shape != nullptr, "what is to be placed is not a shape");
  TW_REQUIRE(!shape->has_lazy_parts(),
             "what is to be placed is a " + shape->kind_name() +
                 "; expected the #:position and #:orientation of its body to place it");
  TW_REQUIRE(is_finite(pose.p),
             "a shape is placed at " + show(pose.p) + "; expected finite numbers");
  TW_REQUIRE(pose.p.cwiseAbs().maxCoeff() <= greatest_length,
             "a shape is placed at " + show(pose.p) + "; expected coordinates of at most " +
                 tw::show(greatest_length) + " m");
  TW_REQUIRE(is_finite(pose.q) && pose.q.norm() > 0,
             "a shape is placed with a quaternion that is zero or not finite");
  const Frame move(Pose{pose.p, pose.q.normalized()});
  std::vector<ConvexPart> parts = shape->parts();
  for (ConvexPart& part : parts) {
    part.place(move * part.placement());
    part.bound_center = move * part.bound_center;
    if (part.kind != PartKind::half_space) continue;
    // n.(R^T (x - p)) <= offset
    part.normal = (move.R * part.normal).normalized();
    part.offset += part.normal.dot(move.p);
  }
  return finish_shape(std::move(parts), shape->kind_name(),
                      placed_mass(shape->mass_properties(), move));
}

}  // namespace tw
