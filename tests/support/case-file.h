// Reads the tables of tests/data (see tests/data/README.md) into worlds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel/world.h"

namespace tw::test {

inline std::string data_file(const std::string& name) {
#ifdef TW_TEST_DATA_DIR
  const std::string folder = TW_TEST_DATA_DIR;
#else
  const char* from_environment = std::getenv("TW_TEST_DATA");
  const std::string folder = from_environment ? from_environment : "tests/data";
#endif
  return folder + "/" + name;
}

// Rows of numbers, comments left out.
inline std::vector<std::vector<double>> read_rows(const std::string& name) {
  std::ifstream file(data_file(name));
  if (!file) throw std::runtime_error("cannot read " + data_file(name));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    rows.emplace_back();
    for (double x; in >> x;) rows.back().push_back(x);
  }
  return rows;
}

struct Case {
  double gravity_z = 0, friction = 0, restitution = 1, duration = 0;
  Vec3 gravity = Vec3::Zero();
  std::vector<BodyDef> bodies;
};

// Reads NAME.bodies.txt.
inline Case read_case(const std::string& name) {
  std::ifstream file(data_file(name + ".bodies.txt"));
  if (!file) throw std::runtime_error("cannot read " + data_file(name + ".bodies.txt"));
  Case result;
  std::string line, word;
  std::getline(file, line);
  std::istringstream header(line);
  while (header >> word) {
    if (word == "gravity") header >> result.gravity.x() >> result.gravity.y() >> result.gravity.z();
    if (word == "friction") header >> result.friction;
    if (word == "restitution") header >> result.restitution;
    if (word == "duration") header >> result.duration;
  }
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    int id, fixed, hull;
    std::string shape;
    double sx, sy, sz, mass, ix, iy, iz;
    BodyDef def;
    in >> id >> shape >> fixed >> sx >> sy >> sz >> hull >> mass >> ix >> iy >> iz;
    in >> def.position.x() >> def.position.y() >> def.position.z();
    in >> def.orientation.w() >> def.orientation.x() >> def.orientation.y() >> def.orientation.z();
    in >> def.velocity.x() >> def.velocity.y() >> def.velocity.z();
    in >> def.angular_velocity.x() >> def.angular_velocity.y() >> def.angular_velocity.z();
    def.fixed = fixed != 0;
    if (shape == "sphere") def.shape = make_sphere(sx);
    if (shape == "box") def.shape = make_box(2 * Vec3(sx, sy, sz));
    if (shape == "plane") def.shape = make_half_space(Vec3::UnitZ(), 0);
    if (!def.fixed) {
      def.mass = mass;
      def.inertia = Vec3(ix, iy, iz).asDiagonal();
    }
    def.name = name + "-" + std::to_string(id);
    result.bodies.push_back(def);
  }
  return result;
}

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
