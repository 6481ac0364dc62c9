// Policies: timewarp, the only one so far.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/policy.h"

#include "base/error.h"

namespace tw {
namespace {

class Timewarp : public Policy {
 public:
  const char* name() const override { return "timewarp"; }
  const Event& next(const EventQueue& queue) override { return queue.top(); }
  double may_reach(const EventQueue&, const Process&) override { return never; }
  void widen(RollbackScope&, const Key&) override {}
};

}  // namespace

std::unique_ptr<Policy> make_policy(const std::string& name) {
  TW_REQUIRE(name == "timewarp",
             "policy is " + name + "; expected timewarp, the only one in this version");
  return std::make_unique<Timewarp>();
}

}  // namespace tw
