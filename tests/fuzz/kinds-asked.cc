// Kinds of scenes in which callbacks look about and sensors drive, with the forces, motions and
// meshes that the other kinds lack.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "fuzz/draft.h"
#include "fuzz/kinds.h"
#include "fuzz/ties.h"

namespace tw::fuzz {
namespace {

double gravity_scale(const Draft& draft) { return draft.speed * draft.speed / draft.size; }

// What swings among the others; it keeps off the walls.
void add_swinging(Draft& draft) {
  const double s = draft.size, diameter = s * draft.random.real(0.3, 0.7);
  const double height = s * draft.random.real(0.6, 1.5), width = s * draft.random.real(0.05, 0.5);
  DescribedBody& body = draft.add_moving(draft.shape(diameter), {0, 0, height});
  body.pose.q = draft.attitude();
  Swing swing;
  swing.along = width * draft.direction();
  swing.along.z() *= 0.3;
  if (draft.chance(0.5)) swing.turn = draft.vector(1.5);
  swing.period = draft.time * draft.log_uniform(1, 6);
  body.swing = swing;
}

bool polyhedral(const DescribedBody& body) {
  return std::all_of(body.solids.begin(), body.solids.end(), [](const Solid& solid) {
    return solid.kind == SolidKind::box || solid.kind == SolidKind::hull;
  });
}

void make_meshes(Draft& draft, double share) {
  for (DescribedBody& body : draft.scene.bodies)
    if (!body.fixed && !body.hanging && polyhedral(body)) body.mesh = draft.chance(share);
}

double mass_of(const DescribedBody& body) {
  return body.density * shape_of(body)->mass_properties().volume;
}

void add_drag(Draft& draft, const DescribedBody& body) {
  DescribedForce force;
  force.body = body.name;
  const double mass = mass_of(body);
  if (draft.chance(0.7)) force.linear = mass / draft.time * draft.log_uniform(1e-3, 1);
  if (draft.chance(0.7)) force.quadratic = mass / draft.size * draft.log_uniform(1e-3, 1);
  draft.scene.forces.push_back(force);
}

void add_push(Draft& draft, const DescribedBody& body) {
  DescribedForce force;
  force.body = body.name;
  force.procedure = true;
  const double mass = mass_of(body), weight = mass * gravity_scale(draft);
  force.place = draft.vector(draft.size) + Vec3(0, 0, 1.5 * draft.size);
  force.stiffness = weight / draft.size * draft.log_uniform(0.01, 3);
  if (draft.chance(0.5)) force.push = draft.vector(0.3 * weight);
  if (draft.chance(0.5))
    force.resistance = mass * draft.size * draft.size / draft.time * draft.log_uniform(1e-4, 0.1);
  force.period = draft.time * draft.log_uniform(0.5, 5);
  draft.scene.forces.push_back(force);
}

// Of all loose bodies, which stay where they are meanwhile.
std::vector<std::size_t> loose_numbers(const DescribedScene& scene) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].dynamic() && !scene.bodies[i].hanging) numbers.push_back(i);
  return numbers;
}

// The torque by which a link's weight may pull at its joint, N m.
double own_torque(const Draft& draft, const DescribedBody& link) {
  return mass_of(link) * gravity_scale(draft) * shape_of(link)->radius_about_origin();
}

void add_servos(Draft& draft) {
  using multibody::JointKind;
  for (const DescribedBody& link : draft.scene.bodies) {
    if (!link.hanging || link.hanging->free) continue;
    const JointKind kind = link.hanging->joint.kind;
    if (kind != JointKind::revolute && kind != JointKind::prismatic) continue;
    if (draft.chance(0.4)) continue;
    const double unit = kind == JointKind::prismatic ? draft.size : 1;
    const double torque = own_torque(draft, link) / unit;
    DescribedServo servo;
    servo.link = link.name;
    servo.target = unit * draft.random.real(-1, 1);
    servo.rate = draft.chance(0.3) ? unit / draft.time * draft.random.real(-1, 1) : 0;
    servo.stiffness = draft.chance(0.8) ? torque / unit * draft.log_uniform(0.1, 30) : 0;
    servo.damping = torque / unit * draft.time * draft.log_uniform(0.01, 1);
    servo.max_torque = torque * draft.log_uniform(0.5, 20);
    draft.scene.servos.push_back(servo);
  }
}

}  // namespace

void draw_asked(Draft& draft) {
  const double half = draft.size * draft.random.real(1.5, 2.5);
  draft.add_pit(half, 8 * draft.size);
  if (draft.chance(0.6)) add_swinging(draft);
  draft.pour(draft.whole(2, 8), half, 0.05 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size * draft.log_uniform(0.3, 0.9)); });
  make_meshes(draft, 0.6);
  DescribedScene& scene = draft.scene;
  if (draft.chance(0.3)) scene.rolling = draft.size * draft.log_uniform(1e-4, 0.1);
  const auto names = loose(scene);
  for (const std::size_t i : loose_numbers(scene))
    if (draft.chance(0.5)) add_drag(draft, scene.bodies[i]);
  for (std::size_t i = 0; i < names.size(); ++i) {
    // itself, the others after it, a fixed one, and what swings
    std::vector<std::string> targets;
    for (std::size_t k = 0; k < std::min<std::size_t>(names.size(), 4); ++k)
      targets.push_back(names[(i + k) % names.size()]);
    for (const DescribedBody& body : scene.bodies)
      if (body.swing || body.name == scene.bodies.front().name) targets.push_back(body.name);
    if (draft.chance(0.5)) {
      scene.callbacks.push_back(callback(draft, Deed::scan, targets));
      scene.callbacks.back().reach = draft.size * draft.log_uniform(0.3, 3);
    }
    if (draft.chance(0.5)) {
      scene.callbacks.push_back(callback(draft, Deed::mind, targets));
      scene.callbacks.back().reach = draft.size * draft.log_uniform(0.1, 1);
    }
  }
  draft.last(8);
}

void draw_driven(Draft& draft) {
  draw_bonds(draft);
  add_tree(draft, {0, 0, 4 * draft.size}, 2 * draft.size);
  make_meshes(draft, 0.3);
  DescribedScene& scene = draft.scene;
  if (draft.chance(0.5)) scene.rolling = draft.size * draft.log_uniform(1e-4, 0.1);
  if (draft.chance(0.5)) scene.spinning = draft.size * draft.log_uniform(1e-4, 0.1);
  for (const std::size_t i : loose_numbers(scene)) {
    if (draft.chance(0.3)) add_drag(draft, scene.bodies[i]);
    if (draft.chance(0.3)) add_push(draft, scene.bodies[i]);
  }
  add_servos(draft);
  const auto names = loose(scene);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (draft.chance(0.4)) continue;
    scene.callbacks.push_back(
        callback(draft, Deed::steady, {names[i], names[(i + 1) % names.size()]}));
    scene.callbacks.back().torque =
        typical_mass(draft) * gravity_scale(draft) * draft.log_uniform(0.01, 0.3);
    scene.callbacks.back().reach = draft.size * draft.random.real(0.05, 0.3);
  }
  const auto root = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [](const DescribedBody& body) { return body.hanging; });
  // a lone free link has no joint to feel
  if (root != scene.bodies.end() && &*root != &scene.bodies.back()) {
    scene.callbacks.push_back(callback(draft, Deed::strain, {root->name}));
    scene.callbacks.back().torque =
        own_torque(draft, scene.bodies.back()) * draft.log_uniform(0.01, 0.5);
  }
  draft.last(8);
}

}  // namespace tw::fuzz
