// A gas of equal elastic spheres in a closed cube, and a dedicated event-driven program for it.
//
// The yardstick of speed: nothing but what such a gas needs - no rotation, no shapes, no gravity,
// no going back - and a second opinion on positions where there is no table.
//
// Method: each sphere flies straight from its last impact, x(t) = x + (t - since) v, and has one
// event in an indexed heap: its next impact or the next wall of its grid cell, whichever comes
// first. Crossing a cell wall looks at the nine cells that come into reach, an impact at all
// twenty-seven. A sphere whose partner found an earlier impact looks anew when its own would have
// come.
// Source: B. D. Lubachevsky, "How to simulate billiards and similar systems", J. Comput. Phys. 94
// (1991) 255-283 (one event a sphere, advancement events).
// Invariants: partners name each other at the same time; the cell edge is at least a diameter.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace tw::bench {

struct Gas {
  double side = 0;    // the cube is [0, side]^3, m
  double radius = 0;  // m
  std::vector<Vec3> position, velocity;
};

// `count` spheres of radius 0.25 m, 5 m^3 of space for each (the density of the case gas-200),
// speeds 3 m/s (root of the mean square).  The same for the same count, on every machine.
Gas make_gas(int count);

class EventDrivenMd {
 public:
  explicit EventDrivenMd(const Gas& gas);

  // Up to and including the events at `until`, s.
  void advance(double until);
  Vec3 position(int i) const;
  Vec3 velocity(int i) const { return spheres_[static_cast<std::size_t>(i)].v; }
  long pair_collisions() const { return pair_collisions_; }
  long wall_collisions() const { return wall_collisions_; }

 private:
  static constexpr std::int32_t nobody = -1;  // no impact is known: look anew when it is time
  static constexpr std::int32_t wall = -2;    // - axis: walls at right angles to x, y, z

  struct Sphere {
    Vec3 x, v;  // at `since`
    double since = 0;
    double impact = 0, crossing = 0;                // times, s
    std::int32_t partner = nobody;                  // of the impact; at or below `wall`: a wall
    std::int32_t next = nobody, previous = nobody;  // in the cell's list
    std::array<std::int16_t, 3> cell{};
    std::int8_t crossing_axis = 0, crossing_step = 0;
  };
  struct Range {
    std::array<int, 3> lo, hi;  // of cells, both ends included
  };
  struct Slot {
    double time;
    std::int32_t sphere;
  };

  Sphere& sphere(std::int32_t i) { return spheres_[static_cast<std::size_t>(i)]; }
  std::int32_t& list_of(int x, int y, int z);
  void enter_cell(std::int32_t i);
  void leave_cell(std::int32_t i);
  void cross(std::int32_t i);

  void find_crossing(Sphere& s);
  void find_wall(Sphere& s, double now);
  Range reach(const Sphere& s) const;
  void look_in_cell(std::int32_t i, int x, int y, int z, double now);
  void look_in(std::int32_t i, const Range& range, double now);
  void look_anew(std::int32_t i, double now);
  void part(std::int32_t i);
  void meet(std::int32_t i, std::int32_t j, double when);

  void move_to(Sphere& s, double when);
  void collide(std::int32_t i);
  void bounce(std::int32_t i);

  void schedule(std::int32_t i);
  void put(std::size_t at, Slot slot);
  void up(std::size_t at, Slot slot);
  void down(std::size_t at, Slot slot);

  double side_, radius_, edge_;
  int cells_;  // along each side
  std::vector<Sphere> spheres_;
  std::vector<std::int32_t> lists_;   // first sphere of each cell
  std::vector<Slot> heap_;            // 4-ary
  std::vector<std::uint32_t> place_;  // of each sphere in the heap
  double now_ = 0;
  long pair_collisions_ = 0, wall_collisions_ = 0;
};

}  // namespace tw::bench
