// The cases in ODE: the direct solver, but the iterative one where many bodies lie on each other,
// for which the direct one breaks down (the stack) or takes the cube of their number.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <ode/ode.h>

#include <cmath>

#include "bench/engine-cases.h"
#include "support/case-motion.h"

namespace tw::bench {
namespace {

constexpr int quick_iterations = 50;  // 20 by default: too few for a stack of ten

class Ode : public CaseEngine {
 public:
  Ode(const CaseTable& c, double step);
  ~Ode() override;
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;
  void advance(double duration) override;
  EngineState state(std::size_t body) const override;

 private:
  dBodyID add(const CaseBody& def);
  dGeomID shape(const CaseBody& def);
  void push();
  void touch(dGeomID a, dGeomID b);

  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
  CaseTable case_;
  double step_;
  long steps_ = 0;
  bool direct_;
};

bool piles_up(const std::string& name) {
  for (const char* one : {"stack", "elastic-666", "666", "kapla", "drum", "shaken"})
    if (name == one) return true;
  return false;
}

Ode::Ode(const CaseTable& c, double step) : case_(c), step_(step), direct_(!piles_up(c.name)) {
  dInitODE2(0);
  dAllocateODEDataForThread(dAllocateMaskAll);
  world_ = dWorldCreate();
  space_ = dHashSpaceCreate(nullptr);
  contacts_ = dJointGroupCreate(0);
  dWorldSetGravity(world_, c.gravity[0], c.gravity[1], c.gravity[2]);
  // A compliance of 1e-10 s/kg by default, over the step: the shorter that is, the more of an
  // impact it takes up.  Resting boxes, whose corners are one too many, need it.
  if (c.restitution > 0) dWorldSetCFM(world_, 0);
  dWorldSetQuickStepNumIterations(world_, quick_iterations);
  for (const CaseBody& def : case_.bodies) bodies_.push_back(add(def));
  for (const test::CaseHinge& hinge : c.hinges) {
    const auto body = [this](int i) {
      return i < 0 ? nullptr : bodies_[static_cast<std::size_t>(i)];
    };
    const dJointID joint = dJointCreateHinge(world_, nullptr);
    dJointAttach(joint, body(hinge.child), body(hinge.parent));
    dJointSetHingeAnchor(joint, hinge.anchor[0], hinge.anchor[1], hinge.anchor[2]);
    dJointSetHingeAxis(joint, hinge.axis[0], hinge.axis[1], hinge.axis[2]);
  }
}

Ode::~Ode() {
  dJointGroupDestroy(contacts_);
  dSpaceDestroy(space_);
  dWorldDestroy(world_);
  dCloseODE();
}

dGeomID Ode::shape(const CaseBody& def) {
  const auto& [x, y, z] = def.size;
  if (def.shape == "sphere") return dCreateSphere(space_, x);
  if (def.shape == "box") return dCreateBox(space_, 2 * x, 2 * y, 2 * z);
  dMatrix3 R;
  dQtoR(def.orientation.data(), R);
  const auto& p = def.position;
  const double n[] = {R[2], R[6], R[10]};
  return dCreatePlane(space_, n[0], n[1], n[2], n[0] * p[0] + n[1] * p[1] + n[2] * p[2]);
}

void place(dBodyID body, const CaseBody& def) {
  dBodySetQuaternion(body, def.orientation.data());
  const auto &p = def.position, &v = def.velocity, &w = def.angular_velocity;
  dBodySetPosition(body, p[0], p[1], p[2]);
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, w[0], w[1], w[2]);
}

dBodyID Ode::add(const CaseBody& def) {
  const dGeomID geom = def.shape == "rod" ? nullptr : shape(def);
  if (geom) dGeomSetData(geom, const_cast<CaseBody*>(&def));
  if (def.fixed) return nullptr;
  const dBodyID body = dBodyCreate(world_);
  if (geom) dGeomSetBody(geom, body);
  if (def.driven) {
    dBodySetKinematic(body);
  } else {
    const auto& [ix, iy, iz] = def.inertia;
    dMass mass;
    dMassSetParameters(&mass, def.mass, 0, 0, 0, ix, iy, iz, 0, 0, 0);
    dBodySetMass(body, &mass);
  }
  place(body, def);
  return body;
}

void Ode::touch(dGeomID a, dGeomID b) {
  constexpr int most = 8;
  const auto &one = *static_cast<const CaseBody*>(dGeomGetData(a)),
             &other = *static_cast<const CaseBody*>(dGeomGetData(b));
  if (test::is_held(one) && test::is_held(other)) return;
  dContact contacts[most];
  const int count = dCollide(a, b, most, &contacts[0].geom, sizeof(dContact));
  for (int i = 0; i < count; ++i) {
    dSurfaceParameters& surface = contacts[i].surface;
    surface.mode = dContactApprox1;
    surface.mu = test::friction_of(case_, one, other);
    if (case_.restitution > 0) {
      surface.mode |= dContactBounce;
      surface.bounce = case_.restitution;
      surface.bounce_vel = 0;
    }
    const dJointID joint = dJointCreateContact(world_, contacts_, &contacts[i]);
    dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
  }
}

// Forces act for a step; driven bodies go on from where they are to be by themselves.
void Ode::push() {
  const double now = static_cast<double>(steps_++) * step_;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const CaseBody& def = case_.bodies[i];
    if (def.driven) place(bodies_[i], test::driven_body(def, case_.motion, now));
    const auto& [x, y, z] = def.force;
    if (test::is_pushed(def)) dBodyAddForce(bodies_[i], x, y, z);
  }
}

void Ode::advance(double duration) {
  const auto near = [](void* engine, dGeomID a, dGeomID b) {
    static_cast<Ode*>(engine)->touch(a, b);
  };
  for (long n = std::lround(duration / step_); n > 0; --n) {
    push();
    dSpaceCollide(space_, this, near);
    direct_ ? dWorldStep(world_, step_) : dWorldQuickStep(world_, step_);
    dJointGroupEmpty(contacts_);
  }
}

EngineState Ode::state(std::size_t index) const {
  const dReal* p = dBodyGetPosition(bodies_[index]);
  const dReal* q = dBodyGetQuaternion(bodies_[index]);
  const dReal* v = dBodyGetLinearVel(bodies_[index]);
  const dReal* w = dBodyGetAngularVel(bodies_[index]);
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}};
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  const bool is_double = sizeof(dReal) == sizeof(double);
  return run_cases(runner_of<Ode>("ODE", is_double ? "double" : "single"), argc, argv);
}
