// Reading the table of known faults, and measuring its rows.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/known-faults.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "fuzz/apart.h"
#include "fuzz/generator.h"
#include "support/case-table.h"

namespace tw::fuzz {
namespace {

constexpr double budget = 120;  // s of CPU: none of the rows takes so long

Fault fault_named(const std::string& name) {
  for (const Fault fault : {Fault::deep, Fault::energy, Fault::slow})
    if (name == name_of(fault)) return fault;
  throw UserError("a fault is " + name + "; expected deep, energy or slow");
}

std::vector<KnownFault> read_table() {
  const std::string name = test::data_file("known-faults.tsv");
  std::ifstream file(name);
  TW_REQUIRE(file, "cannot read " + name);
  std::vector<KnownFault> faults;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    std::array<std::string, 6> column;
    for (std::string& text : column) std::getline(in, text, '\t');
    TW_REQUIRE(!column[5].empty(), name + ": expected six columns in " + line);
    faults.push_back({column[0], std::stoull(column[1]), fault_named(column[2]),
                      std::stod(column[3]), std::stoi(column[4]), column[5]});
  }
  return faults;
}

}  // namespace

const std::vector<KnownFault>& known_faults() {
  static const std::vector<KnownFault> faults = read_table();
  return faults;
}

bool is_known(const DescribedScene& scene, Fault fault) {
  return std::any_of(known_faults().begin(), known_faults().end(), [&](const KnownFault& known) {
    return known.kind == scene.kind && known.seed == scene.seed && known.fault == fault;
  });
}

double measured(const KnownFault& fault) {
  const DescribedScene scene = random_scene(fault.kind, fault.seed);
  const Findings found =
      run_apart(budget, [&](Findings& f) { run_judged(scene, budget, f, fault.looks); });
  if (!found.finished) return std::numeric_limits<double>::quiet_NaN();
  switch (fault.fault) {
    case Fault::deep: return found.depth;
    case Fault::energy: return found.rise;
    default: return found.work;
  }
}

}  // namespace tw::fuzz
