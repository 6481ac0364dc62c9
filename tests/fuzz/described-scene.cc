// A described scene becomes a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/described-scene.h"

#include <algorithm>

#include "fuzz/deeds.h"
#include "fuzz/mesh-text.h"
#include "fuzz/procedures.h"
#include "support/counter.h"
#include "support/scene.h"

namespace tw::fuzz {

std::size_t DescribedScene::moving() const {
  const auto count = std::count_if(bodies.begin(), bodies.end(),
                                   [](const DescribedBody& body) { return !body.fixed; });
  return static_cast<std::size_t>(count);
}

bool DescribedScene::has(const std::string& body) const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [&](const DescribedBody& other) { return other.name == body; });
}

bool DescribedScene::driven() const {
  return !servos.empty() ||
         std::any_of(forces.begin(), forces.end(),
                     [](const DescribedForce& force) { return force.procedure; }) ||
         std::any_of(callbacks.begin(), callbacks.end(), [](const DescribedCallback& c) {
           return c.deed == Deed::reach || c.deed == Deed::lean || c.deed == Deed::steady ||
                  c.deed == Deed::strain;
         });
}

Pose Swing::pose(const Pose& middle, double time) const {
  const double share = std::sin(2 * pi / period * time);
  return {middle.p + share * along, rotation_by(share * turn) * middle.q};
}

double Swing::max_speed(double radius) const {
  return 1.01 * 2 * pi / period * (along.norm() + radius * turn.norm());
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

std::vector<MeshTriangle> Hills::triangles() const {
  std::vector<MeshTriangle> all;
  const auto across = static_cast<std::uint32_t>(columns);
  for (std::uint32_t row = 0; row + 1 < rows(); ++row)
    for (std::uint32_t column = 0; column + 1 < across; ++column) {
      const std::uint32_t a = row * across + column, d = a + across;
      all.push_back({a, a + 1, d + 1});
      all.push_back({a, d + 1, d});
    }
  return all;
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

static ShapePtr mesh_of(const Hills& hills) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < hills.heights.size(); ++i)
    points.push_back(hills.corner(i / hills.columns, i % hills.columns));
  return make_mesh(points, hills.triangles());
}

ShapePtr shape_of(const DescribedBody& body) {
  if (body.mesh) return shape_from_file(body);
  if (body.hills) {
    const Hills& hills = *body.hills;
    if (hills.as_mesh) return mesh_of(hills);
    return make_height_field(hills.heights, hills.columns, hills.spacing, hills.spacing);
  }
  if (body.solids.size() == 1) {
    const Solid& solid = body.solids.front();
    return solid.placed() ? place_shape(shape_of(solid), solid.placement) : shape_of(solid);
  }
  std::vector<ShapePtr> parts;
  for (const Solid& solid : body.solids)
    parts.push_back(place_shape(shape_of(solid), solid.placement));
  return make_union(parts);
}

namespace {

BodyDef definition(const DescribedBody& body, bool counts) {
  BodyDef def;
  def.name = body.name;
  if (counts) def.slots = test::make_counter();
  if (body.bare()) {
    def.mass = body.bare_mass;
    def.inertia = body.bare_moment * Mat3::Identity();
    def.center_of_mass = Vec3::Zero();
    return def;
  }
  def.shape = shape_of(body);
  if (body.dynamic()) def.density = body.density;
  if (body.hanging) return def;
  def.fixed = body.fixed;
  if (body.kinematic()) {
    def.motion =
        body.swing ? make_swing(body, *def.shape) : make_keyframes(body.keyframes, body.smooth);
  } else {
    def.position = body.pose.p;
    def.orientation = body.pose.q;
  }
  if (body.dynamic()) {
    def.velocity = body.velocity;
    def.angular_velocity = body.spin;
  }
  return def;
}

// The links from this body on; returns where they end.
std::size_t add_multibody(World& world, const DescribedScene& scene, std::size_t first) {
  const auto& bodies = scene.bodies;
  MultibodyDef def;
  def.name = bodies[first].hanging->multibody;
  def.free = bodies[first].hanging->free;
  def.position = bodies[first].pose.p;
  def.orientation = bodies[first].pose.q;
  const auto short_name = [&](const std::string& name) {
    return name.empty() ? name : name.substr(def.name.size() + 1);
  };
  std::vector<double> velocities;
  std::size_t end = first;
  for (; end < bodies.size() && bodies[end].hanging; ++end) {
    const Hanging& hanging = *bodies[end].hanging;
    if (hanging.multibody != def.name) break;
    LinkDef link;
    link.name = short_name(bodies[end].name);
    link.parent = short_name(hanging.parent);
    link.joint = hanging.joint;
    link.body = definition(bodies[end], !scene.callbacks.empty());
    link.body.name.clear();
    def.links.push_back(link);
    velocities.insert(velocities.end(), hanging.velocity.begin(), hanging.velocity.end());
  }
  const Multibody& added = world.multibody(world.add_multibody(def));
  world.edit(added.links.front(), [&](StateView& view) {
    view.change_joints([&](MultibodyState& joints) { joints.u = velocities; });
  });
  return end;
}

void add_bond(World& world, const DescribedBond& bond) {
  const BodyId a = world.find_body(bond.a).value(), b = world.find_body(bond.b).value();
  if (bond.holds) {
    world.attach(a, b);
    return;
  }
  SpringDef def = bond.spring;
  def.a = a;
  def.b = b;
  world.add_spring(def);
}

void add_force(World& world, const DescribedForce& force, std::uint64_t number) {
  const BodyId body = world.find_body(force.body).value();
  if (force.linear > 0 || force.quadratic > 0) world.add_drag(body, force.linear, force.quadratic);
  if (force.procedure) world.add_force(body, make_force(force, number));
}

// As (set! (joint-servo MULTIBODY NAME) (servo ...)) does.
void add_servo(World& world, const DescribedServo& servo) {
  const BodyId body = world.find_body(servo.link).value();
  world.edit(body, [&](StateView& view) {
    const Multibody& multibody = *view.multibody();
    const auto found = std::find(multibody.links.begin(), multibody.links.end(), body);
    const auto& link = multibody.tree.link(static_cast<int>(found - multibody.links.begin()));
    view.change_joints([&](MultibodyState& joints) {
      if (joints.servos.empty()) {
        joints.servos.resize(static_cast<std::size_t>(multibody.tree.axis_count()));
        joints.targets.resize(static_cast<std::size_t>(multibody.tree.nq()));
        multibody::neutral_position(multibody.tree, joints.targets);
        joints.target_velocities.resize(static_cast<std::size_t>(multibody.tree.nv()));
      }
      joints.targets[static_cast<std::size_t>(link.q)] = servo.target;
      joints.target_velocities[static_cast<std::size_t>(link.u)] = servo.rate;
      joints.servos[static_cast<std::size_t>(link.first_axis)] = {servo.stiffness, servo.damping,
                                                                  servo.max_torque};
    });
  });
}

}  // namespace

void fill(World& world, const DescribedScene& scene) {
  world.set_gravity(scene.gravity);
  world.set_accuracy(scene.accuracy);
  ContactSettings contact;
  contact.restitution = scene.restitution;
  contact.friction = scene.friction;
  contact.rolling_friction = scene.rolling;
  contact.spinning_friction = scene.spinning;
  world.set_contact({}, {}, contact);
  for (std::size_t i = 0; i < scene.bodies.size();) {
    if (scene.bodies[i].hanging)
      i = add_multibody(world, scene, i);
    else
      world.add_body(definition(scene.bodies[i++], !scene.callbacks.empty()));
  }
  for (const DescribedBond& bond : scene.bonds) add_bond(world, bond);
  for (std::size_t i = 0; i < scene.forces.size(); ++i) add_force(world, scene.forces[i], i);
  for (const DescribedServo& servo : scene.servos) add_servo(world, servo);
  add_callbacks(world, scene);
}

}  // namespace tw::fuzz
