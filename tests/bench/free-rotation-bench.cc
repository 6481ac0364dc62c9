// The cost of one evaluation and one construction of the closed-form free rotation.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "integrate/free-rotation.h"

namespace tw {
namespace {

struct Case {
  const char* name;
  Vec3 moments;
  Vec3 momentum;
};

const Case cases[] = {
    {"rest", {6.5, 5.0, 2.5}, {0, 0, 0}},
    {"sphere", {2, 2, 2}, {1, 2, 3}},
    {"axisymmetric", {2, 2, 3}, {1, 2, 3}},
    {"triaxial", {6.5, 5.0, 2.5}, {10, -2, 3}},
    {"triaxial, m > 1/2", {6.5, 5.0, 2.5}, {3, 20, 1}},
    {"triaxial, near the separatrix", {6.5, 5.0, 2.5}, {1e-6, 20, 1e-6}},
};

// An attitude that is aligned with no axis.
Quat start() { return Quat(0.3, 0.4, -0.5, 0.7).normalized(); }

void evaluate(benchmark::State& state, const Case& c) {
  const Quat q0 = start();
  const FreeRotation motion(c.moments, q0, q0 * c.momentum);
  double elapsed = 0;
  Quat q;
  Vec3 w;
  for (auto _ : state) {
    elapsed += 1.0 / 480.0;
    motion.evaluate(elapsed, q, w);
    benchmark::DoNotOptimize(q);
    benchmark::DoNotOptimize(w);
  }
}

void attitude(benchmark::State& state, const Case& c) {
  const Quat q0 = start();
  const FreeRotation motion(c.moments, q0, q0 * c.momentum);
  double elapsed = 0;
  for (auto _ : state) {
    elapsed += 1.0 / 480.0;
    Quat q = motion.attitude(elapsed);
    benchmark::DoNotOptimize(q);
  }
}

void construct(benchmark::State& state, const Case& c) {
  const Quat q0 = start();
  Vec3 momentum = q0 * c.momentum;
  for (auto _ : state) {
    benchmark::DoNotOptimize(momentum);
    FreeRotation motion(c.moments, q0, momentum);
    benchmark::DoNotOptimize(motion);
  }
}

void register_all() {
  for (const Case& c : cases) {
    const std::string name = c.name;
    benchmark::RegisterBenchmark(("evaluate/" + name).c_str(), evaluate, c);
    benchmark::RegisterBenchmark(("attitude/" + name).c_str(), attitude, c);
    benchmark::RegisterBenchmark(("construct/" + name).c_str(), construct, c);
  }
}

}  // namespace
}  // namespace tw

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  tw::register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
