// The cases with exact results in ODE: the direct solver, but the iterative one for the stack, on
// which the direct one breaks down.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <ode/ode.h>

#include <cmath>

#include "bench/engine-cases.h"

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
  EnginePose pose(std::size_t body) const override;

 private:
  dBodyID add(const CaseBody& def);
  dGeomID shape(const CaseBody& def);
  void touch(dGeomID a, dGeomID b);

  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
  double friction_, restitution_, step_;
  bool direct_;
};

Ode::Ode(const CaseTable& c, double step)
    : friction_(c.friction), restitution_(c.restitution), step_(step), direct_(c.name != "stack") {
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
  for (const CaseBody& def : c.bodies) bodies_.push_back(add(def));
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

dBodyID Ode::add(const CaseBody& def) {
  const dGeomID geom = def.shape == "rod" ? nullptr : shape(def);
  if (def.fixed) return nullptr;
  const dBodyID body = dBodyCreate(world_);
  if (geom) dGeomSetBody(geom, body);
  const auto& [ix, iy, iz] = def.inertia;
  dMass mass;
  dMassSetParameters(&mass, def.mass, 0, 0, 0, ix, iy, iz, 0, 0, 0);
  dBodySetMass(body, &mass);
  dBodySetQuaternion(body, def.orientation.data());
  const auto &p = def.position, &v = def.velocity, &w = def.angular_velocity;
  dBodySetPosition(body, p[0], p[1], p[2]);
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, w[0], w[1], w[2]);
  return body;
}

void Ode::touch(dGeomID a, dGeomID b) {
  constexpr int most = 8;
  if (!dGeomGetBody(a) && !dGeomGetBody(b)) return;
  dContact contacts[most];
  const int count = dCollide(a, b, most, &contacts[0].geom, sizeof(dContact));
  for (int i = 0; i < count; ++i) {
    dSurfaceParameters& surface = contacts[i].surface;
    surface.mode = dContactApprox1;
    surface.mu = friction_;
    if (restitution_ > 0) {
      surface.mode |= dContactBounce;
      surface.bounce = restitution_;
      surface.bounce_vel = 0;
    }
    const dJointID joint = dJointCreateContact(world_, contacts_, &contacts[i]);
    dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
  }
}

void Ode::advance(double duration) {
  const auto near = [](void* engine, dGeomID a, dGeomID b) {
    static_cast<Ode*>(engine)->touch(a, b);
  };
  for (long n = std::lround(duration / step_); n > 0; --n) {
    dSpaceCollide(space_, this, near);
    direct_ ? dWorldStep(world_, step_) : dWorldQuickStep(world_, step_);
    dJointGroupEmpty(contacts_);
  }
}

EnginePose Ode::pose(std::size_t index) const {
  const dReal* p = dBodyGetPosition(bodies_[index]);
  const dReal* q = dBodyGetQuaternion(bodies_[index]);
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  const bool is_double = sizeof(dReal) == sizeof(double);
  return run_cases(runner_of<Ode>("ODE", is_double ? "double" : "single"), argc, argv);
}
