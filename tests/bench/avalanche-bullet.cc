// The avalanche in Bullet: sequential impulses, all bodies as convex hulls.
//
// Bullet's hulls get a margin around them; it is set to 1 mm (default 4 cm), so that rocks have
// their own size.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <deque>
#include <memory>
#include <string>

#include "other-engine.h"

namespace tw::bench {
namespace {

btVector3 to_bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btQuaternion to_bullet(const Quat& q) {
  return {static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
          static_cast<btScalar>(q.w())};
}

Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Quat from_bullet(const btQuaternion& q) { return Quat(q.w(), q.x(), q.y(), q.z()); }

// Bullet's inertia is diagonal: the body frame is turned to the principal axes, whose frame is
// q_BP.
struct Principal {
  btVector3 moments;
  Quat q_BP;
  explicit Principal(const Mat3& inertia);
};

Principal::Principal(const Mat3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  moments = to_bullet(solver.eigenvalues());
  q_BP = Quat(axes);
}

class BulletEngine : public OtherEngine {
 public:
  BulletEngine(const OtherScene& scene, const OtherOptions& options);
  ~BulletEngine() override;
  void step(double dt) override;
  OtherState state(std::size_t index) const override;

 private:
  void add_body(const OtherBody& body, const OtherScene& scene);

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::deque<btConvexHullShape> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<Quat> q_BP_;
  bool sleep_;
};

// by default those of a pair are multiplied; here all bodies have the same
btScalar own_friction(const btCollisionObject* a, const btCollisionObject*) {
  return a->getFriction();
}
btScalar own_restitution(const btCollisionObject* a, const btCollisionObject*) {
  return a->getRestitution();
}

BulletEngine::BulletEngine(const OtherScene& scene, const OtherOptions& options)
    : sleep_(options.sleep) {
  gCalculateCombinedFrictionCallback = own_friction;
  gCalculateCombinedRestitutionCallback = own_restitution;
  world_.setGravity(to_bullet(scene.gravity));
  if (options.iterations > 0) world_.getSolverInfo().m_numIterations = options.iterations;
  for (const OtherBody& body : scene.bodies) add_body(body, scene);
}

BulletEngine::~BulletEngine() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

void BulletEngine::add_body(const OtherBody& body, const OtherScene& scene) {
  const Principal principal(body.fixed ? Mat3(Mat3::Identity()) : body.inertia);
  btConvexHullShape& shape = shapes_.emplace_back();
  for (const Vec3& x : body.hull().vertices())
    shape.addPoint(to_bullet(principal.q_BP.conjugate() * x), false);
  shape.recalcLocalAabb();
  shape.initializePolyhedralFeatures();
  shape.setMargin(btScalar(0.001));
  const bool fixed = body.fixed;
  btRigidBody::btRigidBodyConstructionInfo info(
      fixed ? btScalar(0) : static_cast<btScalar>(body.mass), nullptr, &shape,
      fixed ? btVector3(0, 0, 0) : principal.moments);
  info.m_startWorldTransform =
      btTransform(to_bullet(Quat(body.pose.q * principal.q_BP)), to_bullet(body.pose.p));
  info.m_friction = static_cast<btScalar>(scene.friction);
  info.m_restitution = static_cast<btScalar>(scene.restitution);
  bodies_.push_back(std::make_unique<btRigidBody>(info));
  q_BP_.push_back(principal.q_BP);
  btRigidBody& made = *bodies_.back();
  made.setLinearVelocity(to_bullet(body.velocity));
  made.setAngularVelocity(to_bullet(body.angular_velocity));
  if (!sleep_) made.setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(&made);
}

void BulletEngine::step(double dt) {
  world_.stepSimulation(static_cast<btScalar>(dt), 0, static_cast<btScalar>(dt));
}

OtherState BulletEngine::state(std::size_t index) const {
  const btRigidBody& body = *bodies_[index];
  OtherState state;
  state.pose.p = from_bullet(body.getWorldTransform().getOrigin());
  state.pose.q =
      (from_bullet(body.getWorldTransform().getRotation()) * q_BP_[index].conjugate()).normalized();
  state.velocity = from_bullet(body.getLinearVelocity());
  state.angular_velocity = from_bullet(body.getAngularVelocity());
  return state;
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  const std::string name = std::string("Bullet ") + std::to_string(btGetVersion()) +
                           (sizeof(btScalar) == sizeof(float) ? ", single" : ", double");
  const auto make = [](const OtherScene& scene, const OtherOptions& options) {
    return std::make_unique<BulletEngine>(scene, options);
  };
  return run_other_engine({name, make}, argc, argv);
}
