// Forces that users give to bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/laws.h"

#include <cmath>

#include "base/constants.h"
#include "base/limits.h"
#include "kernel/kernel.h"
#include "kernel/reading.h"

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

void add_law(Kernel& kernel, BodyId id, const ForceLawPtr& law) {
  kernel.edit(id, [&](StateView& view) { view.add_force(law); });
}

}  // namespace

void require_constant(double value, const std::string& what, const char* unit) {
  TW_REQUIRE(value >= 0 && value <= greatest_force_constant,
             what + " is " + show(value) + "; expected a number of " + unit + " from 0 to " +
                 show(greatest_force_constant));
}

void add_drag(Kernel& kernel, BodyId id, double linear, double quadratic) {
  const std::string& name = kernel.simulation.body(id).info.name;
  require_constant(linear, "linear drag of " + name, "N s/m");
  require_constant(quadratic, "quadratic drag of " + name, "N s^2/m^2");
  add_law(kernel, id, make_drag(linear, quadratic));
}

void add_force(Kernel& kernel, BodyId id, std::shared_ptr<ForceProcedure> procedure) {
  const Body& body = kernel.simulation.body(id);
  TW_REQUIRE(body.dynamic(),
             "a force on " + body.info.name + " cannot move it; expected a dynamic body");
  add_law(kernel, id,
          std::make_shared<ProcedureLaw>(body, kernel.simulation.scene.gravity_scale(),
                                         std::move(procedure)));
  kernel.simulation.calls_out = true;
}

}  // namespace tw
