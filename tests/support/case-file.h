// Reads the tables of tests/data (see tests/data/README.md) into worlds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kernel/world/world.h"
#include "support/case-table.h"

namespace tw::test {

struct Case {
  double friction = 0, restitution = 1, duration = 0;
  Vec3 gravity = Vec3::Zero();
  std::vector<BodyDef> bodies;
};

inline Vec3 vector_of(const Numbers3& x) { return {x[0], x[1], x[2]}; }

inline BodyDef body_of(const CaseBody& body) {
  BodyDef def;
  if (body.shape == "sphere") def.shape = make_sphere(body.size[0]);
  if (body.shape == "box") def.shape = make_box(2 * vector_of(body.size));
  if (body.shape == "plane") def.shape = make_half_space(Vec3::UnitZ(), 0);
  def.fixed = body.fixed;
  if (!def.fixed) {
    def.mass = body.mass;
    def.inertia = vector_of(body.inertia).asDiagonal();
  }
  const auto& q = body.orientation;
  def.position = vector_of(body.position);
  def.orientation = Quat(q[0], q[1], q[2], q[3]);
  def.velocity = vector_of(body.velocity);
  def.angular_velocity = vector_of(body.angular_velocity);
  return def;
}

inline Case case_of(const CaseTable& table) {
  Case result;
  result.gravity = vector_of(table.gravity);
  result.friction = table.friction;
  result.restitution = table.restitution;
  result.duration = table.duration;
  for (const CaseBody& body : table.bodies) {
    result.bodies.push_back(body_of(body));
    result.bodies.back().name = table.name + "-" + std::to_string(result.bodies.size() - 1);
  }
  return result;
}

// Reads NAME.bodies.txt.
inline Case read_case(const std::string& name) { return case_of(read_table(name)); }

// Fills a world; the bodies get their table's order as ids.
inline void fill(World& world, const Case& c) {
  world.set_gravity(c.gravity);
  ContactSettings settings;
  settings.restitution = c.restitution;
  settings.friction = c.friction;
  world.set_contact({}, {}, settings);
  for (const BodyDef& def : c.bodies) world.add_body(def);
}

}  // namespace tw::test
