// The cases with exact results in timewarp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/engine-cases.h"

namespace tw::bench {
namespace {

class Timewarp : public CaseEngine {
 public:
  Timewarp(const test::Case& c, double accuracy) {
    world_.set_accuracy(accuracy);
    test::fill(world_, c);
  }
  // The first one pays for the start, too: first claims, predictions, the check for overlaps.
  void advance(double duration) override { world_.advance(now_ += duration); }
  Pose pose(std::size_t body) const override {
    const BodyState state = world_.state(static_cast<BodyId>(body));
    return {state.position, state.orientation};
  }

 private:
  World world_;
  double now_ = 0;
};

}  // namespace
}  // namespace tw::bench

int main() {
  using namespace tw::bench;
  CaseRunner runner;
  runner.engine = "timewarp";
  runner.version = PACKAGE_VERSION;
  runner.make = [](const std::string&, const tw::test::Case& c, const Setting& setting) {
    return std::make_unique<Timewarp>(c, setting.value);
  };
  runner.settings = {{"accuracy 1e-4", 1e-4}, {"accuracy 1e-6", 1e-6}, {"accuracy 1e-8", 1e-8}};
  return run_cases(runner);
}
