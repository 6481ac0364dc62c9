// What is known to be wrong with random scenes, by kind and seed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "fuzz/verdict.h"

namespace tw::fuzz {

struct KnownFault {
  std::string kind;
  std::uint64_t seed;
  Fault fault;
  double value;  // share of the width or of the energy; of finished runs, else 0
  const char* reason;
};

std::span<const KnownFault> known_faults();

// A scene beyond the first that had a fault once, and what that came from.
struct MendedSeed {
  std::string kind;
  std::uint64_t seed;
  const char* cause;
  bool history = false;  // it had another one under some schedule
};

std::span<const MendedSeed> mended_seeds();

bool known_fault(const DescribedScene& scene, Fault fault);

}  // namespace tw::fuzz
