// The cases in Bullet.  Restitution is not to be lost to its speculative
// contacts: only what touches is solved, and depth is mended by split impulses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>

#include "bench/engine-cases.h"
#include "bench/made-cases.h"
#include "support/case-motion.h"

namespace tw::bench {
namespace {

btVector3 to_bullet(const test::Numbers3& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

btQuaternion to_bullet(const std::array<double, 4>& q) {
  return {static_cast<btScalar>(q[1]), static_cast<btScalar>(q[2]), static_cast<btScalar>(q[3]),
          static_cast<btScalar>(q[0])};
}

// by default those of a pair are multiplied
btScalar least_friction(const btCollisionObject* a, const btCollisionObject* b) {
  return std::min(a->getFriction(), b->getFriction());
}
// here all bodies have the same
btScalar own_restitution(const btCollisionObject* a, const btCollisionObject*) {
  return a->getRestitution();
}

std::unique_ptr<btCollisionShape> shape_of(const CaseBody& def) {
  if (def.shape == "sphere")
    return std::make_unique<btSphereShape>(static_cast<btScalar>(def.size[0]));
  if (def.shape == "box") return std::make_unique<btBoxShape>(to_bullet(def.size));
  return std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0));
}

// More than what is lost in a heap anyhow.
bool bounces(const CaseTable& c) { return c.restitution > 0.5; }

class Bullet : public CaseEngine {
 public:
  Bullet(const CaseTable& c, double step);
  ~Bullet() override;
  Bullet(const Bullet&) = delete;
  Bullet& operator=(const Bullet&) = delete;
  void advance(double duration) override;
  EngineState state(std::size_t body) const override;

 private:
  void add(const CaseBody& def);
  void push();

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  CaseTable case_;
  double step_;
  long steps_ = 0;
};

Bullet::Bullet(const CaseTable& c, double step) : case_(c), step_(step) {
  gCalculateCombinedFrictionCallback = least_friction;
  gCalculateCombinedRestitutionCallback = own_restitution;
  world_.setGravity(to_bullet(c.gravity));
  if (bounces(c)) {
    world_.getSolverInfo().m_splitImpulsePenetrationThreshold = btScalar(1);
    world_.getSolverInfo().m_restitutionVelocityThreshold = btScalar(0);
  }
  if (c.bodies.size() > 2 && !bounces(c)) world_.getSolverInfo().m_numIterations = 50;
  for (const CaseBody& def : c.bodies) add(def);
}

Bullet::~Bullet() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

btTransform place_of(const CaseBody& def) {
  return btTransform(to_bullet(def.orientation), to_bullet(def.position));
}

void Bullet::add(const CaseBody& def) {
  shapes_.push_back(shape_of(def));
  // else edges that balls meet are round, by a tenth of the least half edge
  if (is_heap(case_.name)) shapes_.back()->setMargin(btScalar(1e-4));
  const bool held = test::is_held(def);
  btRigidBody::btRigidBodyConstructionInfo info(
      held ? btScalar(0) : static_cast<btScalar>(def.mass), nullptr, shapes_.back().get(),
      held ? btVector3(0, 0, 0) : to_bullet(def.inertia));
  info.m_startWorldTransform = place_of(def);
  info.m_friction = static_cast<btScalar>(test::friction_of(case_, def, def));
  info.m_restitution = static_cast<btScalar>(case_.restitution);
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  btRigidBody& body = *bodies_.back();
  if (def.driven)
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setLinearVelocity(to_bullet(def.velocity));
  body.setAngularVelocity(to_bullet(def.angular_velocity));
  body.setActivationState(DISABLE_DEACTIVATION);
  if (bounces(case_)) body.setContactProcessingThreshold(btScalar(0));
  world_.addRigidBody(&body);
}

// Forces act for a step; a driven body gets the velocity that takes it to where it is put.
void Bullet::push() {
  const double next = static_cast<double>(++steps_) * step_;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const CaseBody& def = case_.bodies[i];
    if (def.driven)
      bodies_[i]->setWorldTransform(place_of(test::driven_body(def, case_.motion, next)));
    if (test::is_pushed(def)) bodies_[i]->applyCentralForce(to_bullet(def.force));
  }
}

void Bullet::advance(double duration) {
  const auto dt = static_cast<btScalar>(step_);
  for (long n = std::lround(duration / step_); n > 0; --n) {
    push();
    world_.stepSimulation(dt, 0, dt);
  }
}

EngineState Bullet::state(std::size_t index) const {
  const btTransform& t = bodies_[index]->getWorldTransform();
  const btVector3& p = t.getOrigin();
  const btQuaternion q = t.getRotation();
  const btVector3 &v = bodies_[index]->getLinearVelocity(),
                  &w = bodies_[index]->getAngularVelocity();
  return {{p.x(), p.y(), p.z()},
          {q.w(), q.x(), q.y(), q.z()},
          {v.x(), v.y(), v.z()},
          {w.x(), w.y(), w.z()}};
}

// Hinged bodies without a turn at the start, as one multibody: reduced coordinates.
class BulletTree : public CaseEngine {
 public:
  BulletTree(const CaseTable& c, double step);
  ~BulletTree() override { world_.removeMultiBody(&tree_); }
  BulletTree(const BulletTree&) = delete;
  BulletTree& operator=(const BulletTree&) = delete;
  void advance(double duration) override {
    const auto dt = static_cast<btScalar>(step_);
    for (long n = std::lround(duration / step_); n > 0; --n) world_.stepSimulation(dt, 0, dt);
  }
  EngineState state(std::size_t body) const override;

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btMultiBody tree_;  // its links are numbered by their hinges
  std::vector<int> links_;
  double step_;
};

BulletTree::BulletTree(const CaseTable& c, double step)
    : tree_(static_cast<int>(c.hinges.size()), 0, btVector3(0, 0, 0), true, false), step_(step) {
  world_.setGravity(to_bullet(c.gravity));
  links_.resize(c.bodies.size());
  for (int k = 0; k < static_cast<int>(c.hinges.size()); ++k) {
    const test::CaseHinge& hinge = c.hinges[static_cast<std::size_t>(k)];
    const CaseBody& def = c.bodies[static_cast<std::size_t>(hinge.child)];
    links_[static_cast<std::size_t>(hinge.child)] = k;
    const auto parent = static_cast<std::size_t>(hinge.parent);
    const bool root = hinge.parent < 0;
    const btVector3 anchor = to_bullet(hinge.anchor);
    const btVector3 origin = root ? btVector3(0, 0, 0) : to_bullet(c.bodies[parent].position);
    tree_.setupRevolute(k, static_cast<btScalar>(def.mass), to_bullet(def.inertia),
                        root ? -1 : links_[parent], btQuaternion::getIdentity(),
                        to_bullet(hinge.axis), anchor - origin, to_bullet(def.position) - anchor);
  }
  tree_.finalizeMultiDof();
  tree_.setLinearDamping(0);
  tree_.setAngularDamping(0);
  tree_.useRK4Integration(true);
  // rad/s; by default 100, and the end of a chain of twenty whips round faster
  tree_.setMaxCoordinateVelocity(btScalar(1e6));
  tree_.setCanSleep(false);
  world_.addMultiBody(&tree_);
}

EngineState BulletTree::state(std::size_t body) const {
  const int link = links_[body];
  const btVector3 p = tree_.localPosToWorld(link, btVector3(0, 0, 0));
  const btVector3 x = tree_.localDirToWorld(link, btVector3(1, 0, 0));
  const btVector3 y = tree_.localDirToWorld(link, btVector3(0, 1, 0));
  const btVector3 z = x.cross(y);
  btQuaternion q;
  btMatrix3x3(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z()).getRotation(q);
  return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}, {}, {}};
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  CaseRunner runner =
      runner_of<Bullet>("Bullet", std::to_string(btGetVersion()) +
                                      (sizeof(btScalar) == sizeof(float) ? " single" : " double"));
  runner.make = [](const CaseTable& c, const Setting& setting) -> std::unique_ptr<CaseEngine> {
    if (!c.hinges.empty()) return std::make_unique<BulletTree>(c, setting.value);
    return std::make_unique<Bullet>(c, setting.value);
  };
  return run_cases(runner, argc, argv);
}
