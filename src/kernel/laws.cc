// Forces that users give to bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/laws.h"

#include <cmath>

#include "base/constants.h"
#include "base/limits.h"
#include "integrate/anchored-spring.h"
#include "kernel/kernel.h"
#include "kernel/reading.h"

namespace tw {
namespace {

void require_constant(double value, const std::string& what, const char* unit) {
  TW_REQUIRE(value >= 0 && value <= greatest_force_constant,
             what + " is " + show(value) + "; expected a number of " + unit + " from 0 to " +
                 show(greatest_force_constant));
}

void require_point(const Vec3& point, const std::string& what) {
  TW_REQUIRE(is_finite(point) && point.cwiseAbs().maxCoeff() <= greatest_length,
             what + " is #(" + show(point.x()) + " " + show(point.y()) + " " + show(point.z()) +
                 "); expected coordinates of at most " + show(greatest_length) + " m");
}

// By differences: the procedure is asked 24 times for each derivative, in groups alone.
class ProcedureLaw final : public ForceLaw {
 public:
  ProcedureLaw(const Body& body, double gravity, std::shared_ptr<ForceProcedure> procedure)
      : body_(body),
        size_(body.shape_P ? body.radius : std::sqrt(body.moments.maxCoeff() / body.mass)),
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

void add_drag(Kernel& kernel, BodyId id, double linear, double quadratic) {
  const std::string& name = kernel.simulation.body(id).info.name;
  require_constant(linear, "linear drag of " + name, "N s/m");
  require_constant(quadratic, "quadratic drag of " + name, "N s^2/m^2");
  add_law(kernel, id, make_drag(linear, quadratic));
}

void add_spring(Kernel& kernel, const SpringDef& def) {
  const Simulation& simulation = kernel.simulation;
  const Body &given_a = simulation.body(def.a), &given_b = simulation.body(def.b);
  const std::string spring =
      "the spring between " + given_a.info.name + " and " + given_b.info.name;
  TW_REQUIRE(def.a != def.b, spring + " has both ends on one body; expected two bodies");
  for (const Body* body : {&given_a, &given_b})
    TW_REQUIRE(!body->info.removed,
               body->info.name + " was removed; expected a body that is there");
  TW_REQUIRE(given_a.dynamic() || given_b.dynamic(),
             spring + " moves neither of them; expected one of them to be dynamic");
  TW_REQUIRE(!given_a.dynamic() || !given_b.dynamic(),
             spring +
                 " is one between two dynamic bodies, which is not there yet; expected one "
                 "of them to be fixed or kinematic");
  require_constant(def.stiffness, "stiffness of " + spring, "N/m");
  require_constant(def.damping, "damping of " + spring, "N s/m");
  require_point(def.at_a, "at-a of " + spring);
  require_point(def.at_b, "at-b of " + spring);

  const bool swapped = !given_a.dynamic();
  const Body &body = swapped ? given_b : given_a, &other = swapped ? given_a : given_b;
  const Vec3 &at = swapped ? def.at_b : def.at_a, &anchor = swapped ? def.at_a : def.at_b;
  const double now = simulation.present.time;
  const Vec3 arm = body.X_PB.q * at + body.X_PB.p;
  const PoseTwist here = point_at(simulation, body.id(), now);
  const double length = (Frame(other.motion->pose(now)) * anchor - here.x - here.q * arm).norm();
  const double rest = def.rest.value_or(length);
  TW_REQUIRE(rest >= 0 && rest <= greatest_length, "rest of " + spring + " is " + show(rest) +
                                                       "; expected a length from 0 to " +
                                                       show(greatest_length) + " m");
  add_law(kernel, body.id(),
          make_anchored_spring({def.stiffness, def.damping, rest}, arm,
                               {other.id(), other.motion, other.fixed(), anchor}));
}

void add_force(Kernel& kernel, BodyId id, std::shared_ptr<ForceProcedure> procedure) {
  const Body& body = kernel.simulation.body(id);
  TW_REQUIRE(body.dynamic(),
             "a force on " + body.info.name + " cannot move it; expected a dynamic body");
  add_law(kernel, id,
          std::make_shared<ProcedureLaw>(body, kernel.simulation.scene.gravity_scale(),
                                         std::move(procedure)));
}

}  // namespace tw
