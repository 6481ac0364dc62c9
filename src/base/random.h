// Random numbers whose whole state is one word: they live in simulation states and roll back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/hash.h"

namespace tw {

// SplitMix64: a counter with a mixer.  Copying the object copies the stream.
class Random {
 public:
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}

  std::uint64_t word() {
    state_ += 0x9e3779b97f4a7c15ull;
    return mix64(state_);
  }
  // Uniform in [0, 1), 53 bits.
  double real() { return static_cast<double>(word() >> 11) * 0x1p-53; }
  double real(double from, double to) { return from + (to - from) * real(); }
  // Uniform in 0 .. count-1; the bias of the remainder is below count/2^64.
  std::uint64_t below(std::uint64_t count) { return word() % count; }

 private:
  std::uint64_t state_;
};

}  // namespace tw
