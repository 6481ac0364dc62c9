// A described scene becomes a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/described-scene.h"

#include <algorithm>

#include "support/scene.h"

namespace tw::fuzz {

std::size_t DescribedScene::moving() const {
  const auto count = std::count_if(bodies.begin(), bodies.end(),
                                   [](const DescribedBody& body) { return !body.fixed; });
  return static_cast<std::size_t>(count);
}

Solid ball(double radius) {
  Solid solid;
  solid.kind = SolidKind::ball;
  solid.radius = radius;
  return solid;
}

Solid box(const Vec3& edges) {
  Solid solid;
  solid.kind = SolidKind::box;
  solid.edges = edges;
  return solid;
}

Vec3 Hills::corner(std::size_t row, std::size_t column) const {
  const auto at = [&](std::size_t i, std::size_t count) {
    return (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * spacing;
  };
  return {at(column, columns), at(row, rows()), heights[row * columns + column]};
}

namespace {

Solid turned(SolidKind kind, double radius, double length) {
  Solid solid;
  solid.kind = kind;
  solid.radius = radius;
  solid.length = length;
  return solid;
}

}  // namespace

Solid cylinder(double radius, double length) { return turned(SolidKind::cylinder, radius, length); }

Solid capsule(double radius, double length) { return turned(SolidKind::capsule, radius, length); }

Solid cone(double radius, double height) { return turned(SolidKind::cone, radius, height); }

Solid ellipsoid(const Vec3& widths) {
  Solid solid;
  solid.kind = SolidKind::ellipsoid;
  solid.edges = widths;
  return solid;
}

Solid hull(std::vector<Vec3> points) {
  Solid solid;
  solid.kind = SolidKind::hull;
  solid.points = std::move(points);
  return solid;
}

Solid half_space(const Vec3& normal, double offset) {
  Solid solid;
  solid.kind = SolidKind::half_space;
  solid.normal = normal;
  solid.offset = offset;
  return solid;
}

Solid placed(Solid solid, const Vec3& position, const Quat& orientation) {
  solid.placement = Pose{position, orientation};
  return solid;
}

namespace {

ShapePtr shape_of(const Solid& solid) {
  switch (solid.kind) {
    case SolidKind::ball: return make_sphere(solid.radius);
    case SolidKind::box: return make_box(solid.edges);
    case SolidKind::cylinder: return make_cylinder(solid.radius, solid.length);
    case SolidKind::capsule: return make_capsule(solid.radius, solid.length);
    case SolidKind::cone: return make_cone(solid.radius, solid.length);
    case SolidKind::ellipsoid: return make_ellipsoid(0.5 * solid.edges);
    case SolidKind::hull: return make_hull(solid.points);
    case SolidKind::half_space: break;
  }
  return make_half_space(solid.normal, solid.offset);
}

}  // namespace

ShapePtr shape_of(const DescribedBody& body) {
  if (body.hills) {
    const Hills& hills = *body.hills;
    return make_height_field(hills.heights, hills.columns, hills.spacing, hills.spacing);
  }
  if (body.solids.size() == 1) return shape_of(body.solids.front());
  std::vector<ShapePtr> parts;
  for (const Solid& solid : body.solids)
    parts.push_back(place_shape(shape_of(solid), solid.placement));
  return make_union(parts);
}

void fill(World& world, const DescribedScene& scene) {
  world.set_gravity(scene.gravity);
  world.set_accuracy(scene.accuracy);
  ContactSettings contact;
  contact.restitution = scene.restitution;
  contact.friction = scene.friction;
  contact.rolling_friction = scene.rolling;
  contact.spinning_friction = scene.spinning;
  world.set_contact({}, {}, contact);
  for (const DescribedBody& body : scene.bodies) {
    BodyDef def;
    def.name = body.name;
    def.shape = shape_of(body);
    def.fixed = body.fixed;
    if (body.kinematic()) {
      def.motion = make_keyframes(body.keyframes, body.smooth);
    } else {
      def.position = body.pose.p;
      def.orientation = body.pose.q;
    }
    if (body.dynamic()) {
      def.density = body.density;
      def.velocity = body.velocity;
      def.angular_velocity = body.spin;
    }
    world.add_body(def);
  }
}

}  // namespace tw::fuzz
