// Forces that users give to bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/laws.h"

#include <cmath>

#include "base/constants.h"
#include "base/limits.h"
#include "kernel/loop/kernel.h"
#include "kernel/report/reading.h"
#include "kernel/world/state-view.h"

namespace tw {
namespace {

// By differences: the procedure is asked 24 times for each derivative, in groups alone.
class ProcedureLaw final : public ForceLaw {
 public:
  ProcedureLaw(const Body& body, double gravity, std::shared_ptr<ForceProcedure> procedure)
      : body_(body),
        size_(body.extent()),
        speed_(std::sqrt(gravity * size_)),
        procedure_(std::move(procedure)) {}

  void add(double time, const PoseTwist& point, Wrench& sum) const override {
    const Wrench more = procedure_->force(time, body_state(body_, point));
    sum.force += more.force;
    sum.torque += more.torque;
  }
  void add_derivative(double time, const PoseTwist& point, WrenchDerivative& sum) const override {
    add_differences(*this, time, point, size_, speed_, sum);
  }
  double longest_unlooked() const override { return answer::motion_span; }
  std::uint64_t hash() const override { return procedure_->number(); }

 private:
  const Body& body_;
  double size_, speed_;
  std::shared_ptr<ForceProcedure> procedure_;
};

ForceHandle add_law(Kernel& kernel, BodyId id, const ForceLawPtr& law) {
  kernel.edit(id, [&](StateView& view) { view.add_force(law); });
  return {id, id, law};
}

}  // namespace

void require_constant(double value, const std::string& what, const char* unit) {
  TW_REQUIRE(value >= 0 && value <= greatest_force_constant,
             what + " is " + show(value) + "; expected a number of " + unit + " from 0 to " +
                 show(greatest_force_constant));
}

ForceHandle add_drag(Kernel& kernel, BodyId id, double linear, double quadratic) {
  const std::string& name = kernel.simulation.body(id).info.name;
  require_constant(linear, "linear drag of " + name, "N s/m");
  require_constant(quadratic, "quadratic drag of " + name, "N s^2/m^2");
  return add_law(kernel, id, make_drag(linear, quadratic));
}

ForceHandle add_force(Kernel& kernel, BodyId id, std::shared_ptr<ForceProcedure> procedure) {
  const Body& body = kernel.simulation.body(id);
  TW_REQUIRE(body.dynamic(),
             "a force on " + body.info.name + " cannot move it; expected a dynamic body");
  const auto law = std::make_shared<ProcedureLaw>(body, kernel.simulation.scene.gravity_scale(),
                                                  std::move(procedure));
  const ForceHandle force = add_law(kernel, id, law);
  kernel.simulation.calls_out = true;
  return force;
}

bool acts(const Simulation& simulation, const ForceHandle& force) {
  for (const BodyId id : {force.a, force.b}) {
    if (id >= simulation.scene.bodies.size()) return false;
    if (has(state_at(simulation, id, simulation.present.time)->forces, force.law.get()))
      return true;
  }
  return false;
}

void remove_force(Kernel& kernel, const ForceHandle& force, const std::string& what) {
  kernel.simulation.require_between_runs("a force was removed");
  TW_REQUIRE(acts(kernel.simulation, force),
             what + " does not act any more; expected one that was not removed, nor restored away");
  kernel.editing.edit_pair(force.a, force.b, [&](SuccessorView& a, SuccessorView& b) {
    a.let_go(force.law.get());
    b.let_go(force.law.get());
  });
}

}  // namespace tw
