// Policies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/policy.h"

#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/limits.h"

namespace tw {
namespace {

class Timewarp : public Policy {
 public:
  std::string name() const override { return "timewarp"; }
  const Event& next(const EventQueue& queue) override { return queue.top(); }
  double may_reach(const EventQueue&, const Process&) override { return never; }
  void widen(RollbackScope&, const Key&) override {}
};

// Steps of the same length for all; to each discontinuity within one everybody is backed up.
class Retroactive : public Timewarp {
 public:
  explicit Retroactive(double step) : step_(step) {}
  std::string name() const override { return "retroactive:" + show(step_); }
  double may_reach(const EventQueue&, const Process& process) override {
    const double now = process.claim.time;
    double count = std::floor(now / step_);
    while (!(count * step_ > now)) ++count;
    return count * step_;
  }
  bool synchronous() const override { return true; }
  void widen(RollbackScope& scope, const Key&) override { scope.add_all(); }

 private:
  double step_;  // s
};

// Nobody is integrated over a time at which anything may happen to anybody.
class Conservative : public Timewarp {
 public:
  std::string name() const override { return "conservative"; }
  const Event& next(const EventQueue& queue) override {
    known_ = false;
    return queue.top();
  }
  // What claims at once may reach the same time.
  double may_reach(const EventQueue& queue, const Process&) override {
    if (!known_) least_ = queue.least_time_but(EventKind::advance);
    known_ = true;
    return least_;
  }
  bool synchronous() const override { return true; }

 private:
  bool known_ = false;
  double least_ = 0;  // s, of all checks and callbacks
};

// The step of "retroactive:STEP", s.
double step_of(const std::string& name) {
  const std::string text = name.substr(name.find(':') + 1);
  double step = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step);
  TW_REQUIRE(error == std::errc() && end == text.data() + text.size() && step >= least_period &&
                 step <= greatest_time,
             "step of the policy " + name + " is " + text + "; expected a number of seconds from " +
                 show(least_period) + " to " + show(greatest_time));
  return step;
}

}  // namespace

std::unique_ptr<Policy> make_policy(const std::string& name) {
  if (name == "timewarp") return std::make_unique<Timewarp>();
  if (name == "conservative") return std::make_unique<Conservative>();
  if (name.starts_with("retroactive:")) return std::make_unique<Retroactive>(step_of(name));
  throw UserError("policy is " + name +
                  "; expected timewarp, conservative or retroactive:STEP with a step in seconds");
}

}  // namespace tw
