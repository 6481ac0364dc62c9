// What a frame of one scene costs in one engine: a row of the table that moving-rocks.sh prints.
//
// - CPU: of the stepping thread; helpers: of the other threads, at work
// - wall: as seen, on however busy a machine
// - rise: the largest rise of the energy from one frame to the next, over the energy at the start
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

namespace tw::bench {

struct FrameRow {
  std::string scene, engine;
  double cpu = 0, helpers = 0, wall = 0;  // s a frame
  double depth = 0;                       // deepest overlap, m
  int lost = 0;
  double rise = 0;
};

void print(const FrameRow& row);

// Seconds of a clock that runs whoever computes.
double wall_seconds();

// build/avalanche-7.bodies -> avalanche-7
std::string scene_name(const std::string& file);

}  // namespace tw::bench
