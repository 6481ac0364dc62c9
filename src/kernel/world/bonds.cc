// Springs and holds between two bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/bonds.h"

#include <cmath>

#include "base/constants.h"
#include "base/limits.h"
#include "kernel/loop/kernel.h"
#include "kernel/report/reading.h"
#include "kernel/world/laws.h"
#include "kernel/world/state-view.h"
#include "multibody/multibody.h"

namespace tw {
namespace {

void require_point(const Vec3& point, const std::string& what) {
  TW_REQUIRE(is_finite(point) && point.cwiseAbs().maxCoeff() <= greatest_length,
             what + " is #(" + show(point.x()) + " " + show(point.y()) + " " + show(point.z()) +
                 "); expected coordinates of at most " + show(greatest_length) + " m");
}

// `what`: the spring or hold, for errors.
void require_two(const Body& a, const Body& b, const std::string& what) {
  TW_REQUIRE(a.id() != b.id(), what + " has both ends on one body; expected two bodies");
  for (const Body* body : {&a, &b})
    TW_REQUIRE(!body->info.removed,
               body->info.name + " was removed; expected a body that is there");
  TW_REQUIRE(a.dynamic() || b.dynamic(),
             what + " moves neither of them; expected one of them to be dynamic");
}

std::string between(const Body& a, const Body& b) {
  return "between " + a.info.name + " and " + b.info.name;
}

// Where a point of the body frame is in that of its motion.
Vec3 arm_of(const Body& body, const Vec3& at) {
  return body.dynamic() ? Vec3(body.X_PB.q * at + body.X_PB.p) : at;
}

// What a hold at `point` has on one side: kg, m^2, and how far off the centre of mass is, squared.
struct HeldSide {
  double mass = never, gyration = never, lever = 0;

  HeldSide(const Body& body, const PoseTwist& at, const Vec3& point) {
    if (!body.dynamic()) return;
    mass = body.multibody ? body.multibody->tree.mass() : body.mass;
    // the mean about all axes
    gyration = body.moments.sum() / 3 / body.mass;
    lever = (point - at.x).squaredNorm();
  }
};

double size_of(const Body& body) {
  if (!body.dynamic()) return never;
  return body.multibody ? extent_of_link(body) : body.extent();
}

}  // namespace

Bond make_hold(const Scene& scene, const Successor& first, const Successor& second,
               const HoldDef& def) {
  const std::string what = "the hold " + between(*first.body, *second.body);
  require_two(*first.body, *second.body, what);
  const Successor& holder = first.body->dynamic() ? first : second;
  TW_REQUIRE(!holds(holder.data.forces, first.body->id(), second.body->id()),
             first.body->info.name + " and " + second.body->info.name +
                 " are held together already; expected detach! before");

  // what is not dynamic comes first
  const bool swapped = !second.body->dynamic();
  const Successor &a = swapped ? second : first, &b = swapped ? first : second;
  Vec3 point = b.point.x;
  if (def.at) {
    require_point(*def.at, "at of " + what);
    point = first.point.frame() * arm_of(*first.body, *def.at);
  }
  const HeldSide side_a(*a.body, a.point, point), side_b(*b.body, b.point, point);
  const double mass = std::min(side_a.mass, side_b.mass);
  // of turning against stretching, m^2: the longer lever is what a weight turns it by
  const double arm =
      std::min(side_a.gyration, side_b.gyration) + std::max(side_a.lever, side_b.lever);
  const double size = std::min(size_of(*a.body), size_of(*b.body));

  Bond bond;
  bond.a = a.body->id();
  bond.b = b.body->id();
  bond.arm_a = a.point.q.conjugate() * (point - a.point.x);
  bond.arm_b = b.point.q.conjugate() * (point - b.point.x);
  bond.spring.stiffness =
      def.stiffness.value_or(mass * scene.gravity_scale() / (answer::hold_sag * size));
  require_constant(bond.spring.stiffness, "stiffness of " + what, "N/m");
  bond.spring.damping =
      def.damping.value_or(2 * answer::hold_damping * std::sqrt(bond.spring.stiffness * mass));
  require_constant(bond.spring.damping, "damping of " + what, "N s/m");
  // what was made to give way does
  if (!def.stiffness) {
    const double limit = answer::firm_share * size, sag = answer::hold_sag * size;
    bond.firm = SecondHardening::of(limit, sag);
    // at as many weights
    bond.firm_turn = SecondHardening::of(limit / std::sqrt(arm), sag / std::sqrt(arm));
  }
  bond.holds = true;
  bond.turn.stiffness = bond.spring.stiffness * arm;
  bond.turn.damping = bond.spring.damping * arm;
  bond.turn.relative = (a.point.q.conjugate() * b.point.q).normalized();
  return bond;
}

ForceHandle add_spring(Kernel& kernel, const SpringDef& def) {
  const Simulation& simulation = kernel.simulation;
  const Body &given_a = simulation.body(def.a), &given_b = simulation.body(def.b);
  const std::string spring = "the spring " + between(given_a, given_b);
  require_two(given_a, given_b, spring);
  require_constant(def.stiffness, "stiffness of " + spring, "N/m");
  require_constant(def.damping, "damping of " + spring, "N s/m");
  require_point(def.at_a, "at-a of " + spring);
  require_point(def.at_b, "at-b of " + spring);

  // what is not dynamic comes first
  const bool swapped = !given_b.dynamic();
  const Body &a = swapped ? given_b : given_a, &b = swapped ? given_a : given_b;
  Bond bond;
  bond.a = a.id();
  bond.b = b.id();
  bond.arm_a = arm_of(a, swapped ? def.at_b : def.at_a);
  bond.arm_b = arm_of(b, swapped ? def.at_a : def.at_b);
  const double now = simulation.present.time;
  const auto end = [&](const Body& body, const Vec3& arm) {
    const PoseTwist at =
        body.dynamic() ? point_at(simulation, body.id(), now) : body.motion->at(now);
    return Vec3(at.x + at.q * arm);
  };
  const double length = (end(b, bond.arm_b) - end(a, bond.arm_a)).norm();
  bond.spring = {def.stiffness, def.damping, def.rest.value_or(length)};
  TW_REQUIRE(bond.spring.rest >= 0 && bond.spring.rest <= greatest_length,
             "rest of " + spring + " is " + show(bond.spring.rest) +
                 "; expected a length from 0 to " + show(greatest_length) + " m");
  ForceHandle handle{a.id(), b.id(), nullptr};
  kernel.editing.edit_pair(a.id(), b.id(), [&](SuccessorView& view_a, SuccessorView& view_b) {
    handle.law = view_a.tie(view_b, bond);
  });
  return handle;
}

void attach(Kernel& kernel, BodyId a, BodyId b, const HoldDef& def) {
  kernel.editing.edit_pair(
      a, b, [&](SuccessorView& view_a, SuccessorView& view_b) { view_a.attach(view_b, def); });
}

bool attached(const Simulation& simulation, BodyId a, BodyId b, double when) {
  const BodyId holder = simulation.body(a).dynamic() ? a : b;
  return holds(state_at(simulation, holder, when)->forces, a, b);
}

void detach(Kernel& kernel, BodyId a, BodyId b) {
  kernel.editing.edit_pair(
      a, b, [](SuccessorView& view_a, SuccessorView& view_b) { view_a.detach(view_b); });
}

}  // namespace tw
