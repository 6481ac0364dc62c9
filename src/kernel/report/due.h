// Which frames may be delivered: those that nothing can change any more.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Everything before `time`, s, and what is at it if `inclusive`.
struct Due {
  double time = 0;
  bool inclusive = false;

  bool reaches(double frame_time) const {
    return frame_time < time || (inclusive && frame_time == time);
  }
};

}  // namespace tw
