// The cases with exact results in timewarp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/engine-cases.h"
#include "support/case-file.h"

namespace tw::bench {
namespace {

class Timewarp : public CaseEngine {
 public:
  Timewarp(const CaseTable& c, double accuracy) {
    world_.set_accuracy(accuracy);
    test::fill(world_, test::case_of(c));
  }
  // The first one pays for the start, too: first claims, predictions, the check for overlaps.
  void advance(double duration) override { world_.advance(now_ += duration); }
  EnginePose pose(std::size_t body) const override {
    const BodyState state = world_.state(static_cast<BodyId>(body));
    const Vec3& p = state.position;
    const Quat& q = state.orientation;
    return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
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
  runner.make = [](const CaseTable& c, const Setting& setting) {
    return std::make_unique<Timewarp>(c, setting.value);
  };
  runner.settings = {{"accuracy 1e-4", 1e-4}, {"accuracy 1e-6", 1e-6}, {"accuracy 1e-8", 1e-8}};
  return run_cases(runner);
}
