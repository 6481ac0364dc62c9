// The first seeds over all kinds: none has a fault but those that are known.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "fuzz/generator.h"
#include "fuzz/judged-run.h"
#include "fuzz/known-faults.h"
#include "fuzz/mended-seeds.h"
#include "fuzz/verdict.h"
#include "support/known-fault.h"
#include "support/scene.h"

namespace tw::fuzz {
namespace {

constexpr double budget = 30;  // s of CPU

// Slow is what takes many steps and queries: seconds are the machine's as well.
constexpr Judges quick_judges{.pace = std::numeric_limits<double>::infinity(), .work = 25000};

// Histories are the dearest to judge.  The first seeds have theirs compared under every schedule,
// and so have those that had another one once; in a short run each of the others takes two, in
// turn.
Judges two_schedules(std::size_t place) {
  Judges two = quick_judges;
  if (!test::long_tests()) two.first_schedule = 2 * place, two.most_schedules = 2;
  return two;
}

void expect_what_is_known(const Verdict& verdict) {
  for (const Fault fault : verdict.faults)
    EXPECT_TRUE(is_known(verdict.scene, fault))
        << verdict.scene.name() << " is " << name_of(fault) << ", which is not known:\n"
        << verdict.line();
}

TEST(Seeds, have_no_faults_but_those_that_are_known) {
  const std::uint64_t count = test::long_tests() ? 300 : 30;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const Verdict verdict = judge(random_scene(kind_of_seed(seed), seed), quick_judges, budget);
    std::printf("%s\n", verdict.line().c_str());
    std::fflush(stdout);
    expect_what_is_known(verdict);
  }
}

TEST(Seeds, of_kinds_asked_for_by_name_have_no_faults_but_those_that_are_known) {
  const std::uint64_t count = test::long_tests() ? 300 : 10;
  for (const char* kind :
       {"hills", "rolls", "chains", "bonds", "called", "sensed", "asked", "driven", "flush",
        "tools", "corner", "struck", "pressed", "rested", "meshes"})
    for (std::uint64_t seed = 0; seed < count; ++seed)
      expect_what_is_known(judge(random_scene(kind, seed), two_schedules(seed), budget));
}

TEST(Seeds, that_had_faults_have_none_any_more) {
  std::size_t place = 0;
  for (const MendedSeed& mended : mended_seeds()) {
    const Judges judges = mended.history ? quick_judges : two_schedules(place++);
    const Verdict verdict = judge(random_scene(mended.kind, mended.seed), judges, budget);
    std::printf("%s\n", verdict.line().c_str());
    std::fflush(stdout);
    EXPECT_TRUE(verdict.faults.empty()) << mended.cause << ":\n" << verdict.line();
  }
}

double bound_of(Fault fault) {
  return fault == Fault::deep ? depth_bound : fault == Fault::energy ? energy_bound : 0;
}

// No worse than they are known, and no better without somebody noticing.
TEST(Seeds, with_known_faults_have_them_still) {
  for (const KnownFault& known : known_faults()) {
    const double value = measured(known);
    std::printf("%-14s %-7s known %-9.3g now %-9.3g\n", known.name().c_str(), name_of(known.fault),
                known.value, value);
    std::fflush(stdout);
    EXPECT_KNOWN_FAULT(value, bound_of(known.fault), known.value)
        << known.name() << ", " << known.cause;
  }
}

}  // namespace
}  // namespace tw::fuzz
