// The tables of tests/data (see tests/data/README.md) as plain numbers: nothing of the simulator
// and no matrices, so that programs around other engines read them as their libraries were
// compiled.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

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

using Numbers3 = std::array<double, 3>;

struct CaseBody {
  std::string shape;  // sphere, box, plane, rod
  bool fixed = false;
  // a sphere's radius, a box's half edges, the length of a rod along x that touches nothing
  Numbers3 size{};
  double mass = 0;
  Numbers3 inertia{}, position{};
  std::array<double, 4> orientation{1, 0, 0, 0};  // w x y z
  Numbers3 velocity{}, angular_velocity{};
  double friction = -1;  // a pair has the lesser; negative: the case's
  Numbers3 force{};      // N, at the centre of mass, all the time
  bool driven = false;   // moves as CaseTable::motion says, whatever touches it
};

// How driven bodies move from where they are at the start: turning about an axis through the
// origin, or there and back from rest, by swing (1 - cos 2 pi f t)/2.
struct CaseMotion {
  Numbers3 axis{};  // of length 1
  double rate = 0;  // rad/s
  Numbers3 swing{};
  double frequency = 0;  // Hz
};

// Between two bodies; in the world, at the start.
struct CaseHinge {
  int parent = -1, child = 0;  // numbers of bodies, -1: the world
  Numbers3 anchor{}, axis{};
};

struct CaseTable {
  std::string name;
  Numbers3 gravity{};
  double friction = 0, restitution = 1, duration = 0;
  std::vector<CaseBody> bodies;
  std::vector<CaseHinge> hinges;  // that of a parent before those of its children
  CaseMotion motion;
};

// It is where the case says, whatever touches it.
inline bool is_held(const CaseBody& body) { return body.fixed || body.driven; }

inline bool is_pushed(const CaseBody& body) { return body.force != Numbers3{}; }

// Of a pair.
inline double friction_of(const CaseTable& c, const CaseBody& a, const CaseBody& b) {
  const auto own = [&](const CaseBody& body) {
    return body.friction < 0 ? c.friction : body.friction;
  };
  return own(a) < own(b) ? own(a) : own(b);
}

template <std::size_t N>
std::istream& operator>>(std::istream& in, std::array<double, N>& numbers) {
  for (double& x : numbers) in >> x;
  return in;
}

// Reads NAME.bodies.txt and, if it is there, NAME.hinges.txt.
inline CaseTable read_table(const std::string& name) {
  std::ifstream file(data_file(name + ".bodies.txt"));
  if (!file) throw std::runtime_error("cannot read " + data_file(name + ".bodies.txt"));
  CaseTable result;
  result.name = name;
  std::string line, word;
  std::getline(file, line);
  std::istringstream header(line);
  while (header >> word) {
    if (word == "gravity") header >> result.gravity;
    if (word == "friction") header >> result.friction;
    if (word == "restitution") header >> result.restitution;
    if (word == "duration") header >> result.duration;
  }
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    int id, hull;
    CaseBody body;
    in >> id >> body.shape >> body.fixed >> body.size >> hull >> body.mass >> body.inertia;
    in >> body.position >> body.orientation >> body.velocity >> body.angular_velocity;
    result.bodies.push_back(body);
  }
  std::ifstream hinges(data_file(name + ".hinges.txt"));
  while (std::getline(hinges, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    CaseHinge hinge;
    in >> hinge.parent >> hinge.child >> hinge.anchor >> hinge.axis;
    result.hinges.push_back(hinge);
  }
  return result;
}

}  // namespace tw::test
