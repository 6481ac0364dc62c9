// The cases with exact results in ODE: the direct solver, but the iterative one for the stack, on
// which the direct one breaks down.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <ode/ode.h>

#include <cmath>

#include "bench/engine-cases.h"

namespace tw::bench {
namespace {

constexpr int quick_iterations = 50;  // 20 by default: too few for a stack of ten

Vec3 vector_of(const dReal* x) { return {x[0], x[1], x[2]}; }

class Ode : public CaseEngine {
 public:
  Ode(const test::Case& c, double step, bool direct);
  ~Ode() override;
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;
  void advance(double duration) override;
  Pose pose(std::size_t body) const override;

 private:
  dBodyID add(const BodyDef& def);
  dGeomID shape(const BodyDef& def);
  void touch(dGeomID a, dGeomID b);

  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
  double friction_, restitution_, step_;
  bool direct_;
};

Ode::Ode(const test::Case& c, double step, bool direct)
    : friction_(c.friction), restitution_(c.restitution), step_(step), direct_(direct) {
  dInitODE2(0);
  dAllocateODEDataForThread(dAllocateMaskAll);
  world_ = dWorldCreate();
  space_ = dHashSpaceCreate(nullptr);
  contacts_ = dJointGroupCreate(0);
  dWorldSetGravity(world_, c.gravity.x(), c.gravity.y(), c.gravity.z());
  dWorldSetQuickStepNumIterations(world_, quick_iterations);
  for (const BodyDef& def : c.bodies) bodies_.push_back(add(def));
}

Ode::~Ode() {
  dJointGroupDestroy(contacts_);
  dSpaceDestroy(space_);
  dWorldDestroy(world_);
  dCloseODE();
}

dGeomID Ode::shape(const BodyDef& def) {
  if (const auto r = sphere_radius(def)) return dCreateSphere(space_, *r);
  if (const auto half = box_half(def))
    return dCreateBox(space_, 2 * half->x(), 2 * half->y(), 2 * half->z());
  const Vec3 n = def.orientation * Vec3::UnitZ();
  return dCreatePlane(space_, n.x(), n.y(), n.z(), n.dot(def.position));
}

dBodyID Ode::add(const BodyDef& def) {
  const dGeomID geom = shape(def);
  if (def.fixed) return nullptr;
  const dBodyID body = dBodyCreate(world_);
  dGeomSetBody(geom, body);
  const Mat3& i = *def.inertia;
  dMass mass;
  dMassSetParameters(&mass, *def.mass, 0, 0, 0, i(0, 0), i(1, 1), i(2, 2), 0, 0, 0);
  dBodySetMass(body, &mass);
  const Quat& o = def.orientation;
  const dQuaternion q = {o.w(), o.x(), o.y(), o.z()};
  dBodySetQuaternion(body, q);
  const Vec3 &p = def.position, &v = def.velocity, &w = def.angular_velocity;
  dBodySetPosition(body, p.x(), p.y(), p.z());
  dBodySetLinearVel(body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body, w.x(), w.y(), w.z());
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

Pose Ode::pose(std::size_t index) const {
  const dReal* q = dBodyGetQuaternion(bodies_[index]);
  return {vector_of(dBodyGetPosition(bodies_[index])), Quat(q[0], q[1], q[2], q[3])};
}

}  // namespace
}  // namespace tw::bench

int main() {
  using namespace tw::bench;
  CaseRunner runner;
  runner.engine = "ODE";
  runner.version = sizeof(dReal) == sizeof(double) ? "double" : "single";
  runner.make = [](const std::string& name, const tw::test::Case& c, const Setting& setting) {
    return std::make_unique<Ode>(c, setting.value, name != "stack");
  };
  runner.settings = time_steps();
  return run_cases(runner);
}
