// What of a body the sweeps over contacts read and write, for four contacts at a time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "integrate/implicit/lanes.h"

namespace tw {

// Eight numbers, of which six or all are used.
struct alignas(64) StepRow {
  std::array<double, 8> at{};
};

// x[k] holds number k of each of four rows.
TW_LANES void turn_rows(Lanes a, Lanes b, Lanes c, Lanes d, Lanes* x) {
  const Lanes low_ab = __builtin_shuffle(a, b, LaneMask{0, 4, 2, 6});
  const Lanes high_ab = __builtin_shuffle(a, b, LaneMask{1, 5, 3, 7});
  const Lanes low_cd = __builtin_shuffle(c, d, LaneMask{0, 4, 2, 6});
  const Lanes high_cd = __builtin_shuffle(c, d, LaneMask{1, 5, 3, 7});
  x[0] = __builtin_shuffle(low_ab, low_cd, LaneMask{0, 1, 4, 5});
  x[1] = __builtin_shuffle(high_ab, high_cd, LaneMask{0, 1, 4, 5});
  x[2] = __builtin_shuffle(low_ab, low_cd, LaneMask{2, 3, 6, 7});
  x[3] = __builtin_shuffle(high_ab, high_cd, LaneMask{2, 3, 6, 7});
}

// The eight numbers of a row for each lane, and back.
TW_LANES void gather_rows(const StepRow* rows, const int* index, Lanes* x) {
  const auto half = [&](int lane, std::size_t from) {
    Lanes part;
    std::memcpy(&part, rows[index[lane]].at.data() + from, sizeof part);
    return part;
  };
  turn_rows(half(0, 0), half(1, 0), half(2, 0), half(3, 0), x);
  turn_rows(half(0, 4), half(1, 4), half(2, 4), half(3, 4), x + 4);
}
TW_LANES void scatter_rows(StepRow* rows, const int* index, const Lanes* x) {
  Lanes y[8];
  turn_rows(x[0], x[1], x[2], x[3], y);
  turn_rows(x[4], x[5], x[6], x[7], y + 4);
#pragma GCC unroll 4
  for (int lane = 0; lane < lane_count; ++lane) {
    std::memcpy(rows[index[lane]].at.data(), &y[lane], sizeof y[lane]);
    std::memcpy(rows[index[lane]].at.data() + 4, &y[lane + 4], sizeof y[lane]);
  }
}

}  // namespace tw
