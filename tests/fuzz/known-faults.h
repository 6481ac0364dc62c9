// What is known to be wrong with random scenes: tests/data/known-faults.tsv.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fuzz/judged-run.h"
#include "fuzz/verdict.h"

namespace tw::fuzz {

struct KnownFault {
  std::string kind;
  std::uint64_t seed = 0;
  Fault fault = Fault::slow;  // deep, energy or slow
  double value = 0;           // a share of the width or of the energy; of slow ones the work
  int looks = samples;        // of the judge, after which the value has been seen
  std::string cause;

  std::string name() const { return kind + ":" + std::to_string(seed); }
};

const std::vector<KnownFault>& known_faults();

bool is_known(const DescribedScene& scene, Fault fault);

// The value as it is now, whatever the machine; NaN where the run comes to nothing.
double measured(const KnownFault& fault);

}  // namespace tw::fuzz
