// What one run of a scene shows; plain memory, so that it outlives the process that ran it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

namespace tw::fuzz {

template <std::size_t size>
using Text = std::array<char, size>;

struct Findings {
  bool finished = false;
  Text<600> error{};  // what was raised, or the last words of a process that died
  int signal = 0;     // that ended the process
  bool out_of_time = false;
  bool judging = false;  // when it ended: the judge's fault
  double reached = 0;    // s
  double cpu = 0;        // s, of the world's loop
  double pace = 0;       // s of CPU per time unit and moving body, in the dearest tenth
  // Steps, integrations and queries per time unit and moving body: in all, in the dearest tenth.
  double work = 0, dearest = 0;
  Text<72> hash{};

  double depth = 0;  // share of the smaller body's least width
  double depth_time = 0;
  int deep_a = -1, deep_b = -1;
  double squeezed = 0;  // the same of pairs of whom one was told to be squeezed; not in depth
  bool not_finite = false;
  double lost_time = -1;  // s; negative: nobody
  int lost_body = -1;
  double energy_scale = 0;         // J
  double rise = 0, rise_time = 0;  // share of the scale; s
  long long collisions = 0, groups = 0;
  double rejected = 0;  // share of the steps
};

}  // namespace tw::fuzz
