// Random scenes that had a fault once, beyond the first seeds of their kinds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tw::fuzz {

struct MendedSeed {
  std::string kind;
  std::uint64_t seed;
  const char* cause;
  bool history = false;  // it had another one under some schedule
};

std::span<const MendedSeed> mended_seeds();

}  // namespace tw::fuzz
