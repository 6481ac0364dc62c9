// Numbers side by side for the sweeps over contacts: four doubles, or eight floats, in 32 bytes.
//
// Each lane is computed by the same IEEE operations as a lone number, so that a lane's result does
// not depend on its neighbours.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "integrate/implicit/lanes.h"

namespace tw {

template <class Number>
struct StepLanes;

template <>
struct StepLanes<double> {
  static constexpr int count = 4;
  using V = double __attribute__((vector_size(32)));
};
template <>
struct StepLanes<float> {
  static constexpr int count = 8;
  using V = float __attribute__((vector_size(32)));
};

// What of a body the sweeps read and write: eight numbers, of which six or all are used.
template <class Number>
struct alignas(8 * sizeof(Number)) StepRow {
  std::array<Number, 8> at{};
};

namespace step_lanes {

using D = StepLanes<double>::V;
using F = StepLanes<float>::V;
// what comparisons yield: all bits of a lane, or none
using DMask = decltype(D{} < D{});
using FMask = decltype(F{} < F{});

TW_LANES D root(D a) {
#ifdef __AVX__
  return _mm256_sqrt_pd(a);
#endif
  return D{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
TW_LANES F root(F a) {
#ifdef __AVX__
  return _mm256_sqrt_ps(a);
#endif
  return F{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3]),
           std::sqrt(a[4]), std::sqrt(a[5]), std::sqrt(a[6]), std::sqrt(a[7])};
}
TW_LANES bool any(DMask a) {
#ifdef __AVX__
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(a)) != 0;
#endif
  return (a[0] | a[1] | a[2] | a[3]) != 0;
}
TW_LANES bool any(FMask a) {
#ifdef __AVX__
  return _mm256_movemask_ps(reinterpret_cast<__m256>(a)) != 0;
#endif
  return (a[0] | a[1] | a[2] | a[3] | a[4] | a[5] | a[6] | a[7]) != 0;
}

// x[k] holds number k of each row.
TW_LANES void turn(D a, D b, D c, D d, D* x) {
  const D low_ab = __builtin_shuffle(a, b, DMask{0, 4, 2, 6});
  const D high_ab = __builtin_shuffle(a, b, DMask{1, 5, 3, 7});
  const D low_cd = __builtin_shuffle(c, d, DMask{0, 4, 2, 6});
  const D high_cd = __builtin_shuffle(c, d, DMask{1, 5, 3, 7});
  x[0] = __builtin_shuffle(low_ab, low_cd, DMask{0, 1, 4, 5});
  x[1] = __builtin_shuffle(high_ab, high_cd, DMask{0, 1, 4, 5});
  x[2] = __builtin_shuffle(low_ab, low_cd, DMask{2, 3, 6, 7});
  x[3] = __builtin_shuffle(high_ab, high_cd, DMask{2, 3, 6, 7});
}

TW_LANES void turn(const F* rows, F* x) {
  F pairs[8], fours[8];
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    pairs[2 * i] = __builtin_shuffle(rows[2 * i], rows[2 * i + 1], FMask{0, 8, 1, 9, 4, 12, 5, 13});
    pairs[2 * i + 1] =
        __builtin_shuffle(rows[2 * i], rows[2 * i + 1], FMask{2, 10, 3, 11, 6, 14, 7, 15});
  }
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i)
#pragma GCC unroll 2
    for (int k = 0; k < 2; ++k) {
      const F &first = pairs[4 * i + k], &second = pairs[4 * i + 2 + k];
      fours[4 * i + 2 * k] = __builtin_shuffle(first, second, FMask{0, 1, 8, 9, 4, 5, 12, 13});
      fours[4 * i + 2 * k + 1] =
          __builtin_shuffle(first, second, FMask{2, 3, 10, 11, 6, 7, 14, 15});
    }
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    x[i] = __builtin_shuffle(fours[i], fours[i + 4], FMask{0, 1, 2, 3, 8, 9, 10, 11});
    x[i + 4] = __builtin_shuffle(fours[i], fours[i + 4], FMask{4, 5, 6, 7, 12, 13, 14, 15});
  }
}

// The eight numbers of a row for each lane, and back.
TW_LANES void gather(const StepRow<double>* rows, const int* index, D* x) {
  const auto half = [&](int lane, std::size_t from) {
    D part;
    std::memcpy(&part, rows[index[lane]].at.data() + from, sizeof part);
    return part;
  };
  turn(half(0, 0), half(1, 0), half(2, 0), half(3, 0), x);
  turn(half(0, 4), half(1, 4), half(2, 4), half(3, 4), x + 4);
}
TW_LANES void scatter(StepRow<double>* rows, const int* index, const D* x) {
  D y[8];
  turn(x[0], x[1], x[2], x[3], y);
  turn(x[4], x[5], x[6], x[7], y + 4);
#pragma GCC unroll 4
  for (int lane = 0; lane < 4; ++lane) {
    std::memcpy(rows[index[lane]].at.data(), &y[lane], sizeof y[lane]);
    std::memcpy(rows[index[lane]].at.data() + 4, &y[lane + 4], sizeof y[lane]);
  }
}
TW_LANES void gather(const StepRow<float>* rows, const int* index, F* x) {
  F y[8];
#pragma GCC unroll 8
  for (int lane = 0; lane < 8; ++lane)
    std::memcpy(&y[lane], rows[index[lane]].at.data(), sizeof y[lane]);
  turn(y, x);
}
TW_LANES void scatter(StepRow<float>* rows, const int* index, const F* x) {
  F y[8];
  turn(x, y);
#pragma GCC unroll 8
  for (int lane = 0; lane < 8; ++lane)
    std::memcpy(rows[index[lane]].at.data(), &y[lane], sizeof y[lane]);
}

}  // namespace step_lanes

}  // namespace tw
