// The cases in DART.
//
// Compiled as DART's library was, since that decides how Eigen's matrices are laid out: nothing of
// ours that includes Eigen may be included here.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
// not <dart/dart.hpp>: in Debian 12 it wants headers of other packages
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/config.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/constraint/ContactConstraint.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include <cmath>

#include "bench/engine-cases.h"
#include "support/case-motion.h"

namespace tw::bench {
namespace {

namespace dynamics = dart::dynamics;

// m: of the box that stands for a half-space, which DART's own detector does not know
constexpr double ground = 100;

Eigen::Vector3d vector_of(const test::Numbers3& x) { return {x[0], x[1], x[2]}; }

Eigen::Isometry3d placement(const CaseBody& def) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const auto& q = def.orientation;
  result.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  result.translation() = vector_of(def.position);
  return result;
}

dynamics::ShapePtr shape_of(const CaseBody& def) {
  if (def.shape == "sphere") return std::make_shared<dynamics::SphereShape>(def.size[0]);
  if (def.shape == "box")
    return std::make_shared<dynamics::BoxShape>(Eigen::Vector3d(2 * vector_of(def.size)));
  return std::make_shared<dynamics::BoxShape>(Eigen::Vector3d(ground, ground, ground));
}

class Dart : public CaseEngine {
 public:
  Dart(const CaseTable& c, double step);
  void advance(double duration) override {
    for (long n = std::lround(duration / step_); n > 0; --n) {
      push();
      world_->step();
    }
  }
  EngineState state(std::size_t body) const override;

 private:
  void add(const CaseBody& def, const CaseTable& c);
  void add_hinged(const CaseTable& c);
  void add_driven();
  void push();

  dart::simulation::WorldPtr world_ = dart::simulation::World::create();
  std::vector<dynamics::BodyNode*> bodies_;
  CaseTable case_;
  dynamics::Joint* drive_ = nullptr;  // of the driven bodies
  double step_;
  long steps_ = 0;
};

Dart::Dart(const CaseTable& c, double step) : case_(c), step_(step) {
  world_->setTimeStep(step);
  world_->setGravity(vector_of(c.gravity));
  world_->getConstraintSolver()->setCollisionDetector(
      dart::collision::DARTCollisionDetector::create());
  // by default a part in 1e5 of an impact is lost; this is the least that DART takes
  if (c.restitution > 0) dart::constraint::ContactConstraint::setConstraintForceMixing(1e-9);
  add_hinged(c);
  if (c.bodies[0].driven) add_driven();
  for (const CaseBody& def : c.bodies)
    if (c.hinges.empty() && !def.driven) add(def, c);
}

// DART multiplies the restitutions of a pair, and takes the lesser friction.
void add_shape(dynamics::BodyNode& body, const CaseBody& def, const CaseTable& c,
               const Eigen::Isometry3d& place) {
  auto* node = body.createShapeNodeWith<dynamics::VisualAspect, dynamics::CollisionAspect,
                                        dynamics::DynamicsAspect>(shape_of(def));
  node->setRelativeTransform(place);
  node->getDynamicsAspect()->setFrictionCoeff(test::friction_of(c, def, def));
  node->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(c.restitution));
}

// All as one body, on a joint whose velocity is given.
template <class Joint>
dynamics::BodyNode* body_on(const dynamics::SkeletonPtr& skeleton, const test::Numbers3& axis,
                            dynamics::Joint*& drive) {
  const auto made = skeleton->createJointAndBodyNodePair<Joint>();
  made.first->setAxis(vector_of(axis).normalized());
  made.first->setActuatorType(dynamics::Joint::VELOCITY);
  drive = made.first;
  return made.second;
}

void Dart::add_driven() {
  const auto skeleton = dynamics::Skeleton::create("driven");
  const test::CaseMotion& motion = case_.motion;
  dynamics::BodyNode* body =
      motion.rate != 0 ? body_on<dynamics::RevoluteJoint>(skeleton, motion.axis, drive_)
                       : body_on<dynamics::PrismaticJoint>(skeleton, motion.swing, drive_);
  for (const CaseBody& def : case_.bodies) {
    if (!def.driven) continue;
    add_shape(*body, def, case_, placement(def));
    bodies_.push_back(body);
  }
  world_->addSkeleton(skeleton);
}

// Forces act for a step; the joint gets the velocity that takes it where it is to be at its end.
void Dart::push() {
  const double now = static_cast<double>(steps_++) * step_, next = now + step_;
  for (std::size_t i = 0; i < case_.bodies.size(); ++i)
    if (test::is_pushed(case_.bodies[i])) bodies_[i]->addExtForce(vector_of(case_.bodies[i].force));
  if (!drive_) return;
  const auto along = [&](double time) {
    const test::CasePlacement at = test::placement_at(case_.motion, time);
    return case_.motion.rate != 0
               ? at.angle
               : vector_of(at.shift).dot(vector_of(case_.motion.swing).normalized());
  };
  drive_->setCommand(0, (along(next) - along(now)) / step_);
}

dynamics::Inertia inertia_of(const CaseBody& def) {
  const Eigen::Vector3d i = vector_of(def.inertia);
  return dynamics::Inertia(def.mass, Eigen::Vector3d::Zero(), Eigen::Matrix3d(i.asDiagonal()));
}

// One skeleton of bodies without a turn at the start; their frames are at the centres of mass.
void Dart::add_hinged(const CaseTable& c) {
  const auto skeleton = dynamics::Skeleton::create(c.name);
  for (const test::CaseHinge& hinge : c.hinges) {
    const auto child = static_cast<std::size_t>(hinge.child);
    const auto parent = static_cast<std::size_t>(hinge.parent);
    // else it tells on stdout that it has made up a name
    dynamics::RevoluteJoint::Properties joint;
    joint.mName = "hinge-" + std::to_string(child);
    const auto made = skeleton->createJointAndBodyNodePair<dynamics::RevoluteJoint>(
        hinge.parent < 0 ? nullptr : bodies_[parent], joint,
        dynamics::BodyNode::AspectProperties("body-" + std::to_string(child)));
    made.second->setInertia(inertia_of(c.bodies[child]));
    made.first->setAxis(vector_of(hinge.axis));
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translation() = vector_of(hinge.anchor);
    if (hinge.parent >= 0) place.translation() -= vector_of(c.bodies[parent].position);
    made.first->setTransformFromParentBodyNode(place);
    place.translation() = vector_of(hinge.anchor) - vector_of(c.bodies[child].position);
    made.first->setTransformFromChildBodyNode(place);
    bodies_.push_back(made.second);
  }
  world_->addSkeleton(skeleton);
}

void Dart::add(const CaseBody& def, const CaseTable& c) {
  const auto skeleton = dynamics::Skeleton::create("body-" + std::to_string(bodies_.size()));
  dynamics::BodyNode* body;
  if (def.fixed) {
    const auto made = skeleton->createJointAndBodyNodePair<dynamics::WeldJoint>();
    Eigen::Isometry3d place = placement(def);
    place.translation() -= 0.5 * ground * place.linear().col(2);
    made.first->setTransformFromParentBodyNode(place);
    body = made.second;
    skeleton->setMobile(false);
  } else {
    const auto made = skeleton->createJointAndBodyNodePair<dynamics::FreeJoint>();
    body = made.second;
    body->setInertia(inertia_of(def));
    made.first->setTransform(placement(def));
    made.first->setLinearVelocity(vector_of(def.velocity));
    made.first->setAngularVelocity(vector_of(def.angular_velocity));
  }
  add_shape(*body, def, c, Eigen::Isometry3d::Identity());
  bodies_.push_back(body);
  world_->addSkeleton(skeleton);
}

EngineState Dart::state(std::size_t index) const {
  const Eigen::Isometry3d& t = bodies_[index]->getWorldTransform();
  const Eigen::Vector3d p = t.translation();
  const Eigen::Quaterniond q(t.linear());
  const Eigen::Vector3d v = bodies_[index]->getCOMLinearVelocity();
  const Eigen::Vector3d w = bodies_[index]->getAngularVelocity();
  return {{p.x(), p.y(), p.z()},
          {q.w(), q.x(), q.y(), q.z()},
          {v.x(), v.y(), v.z()},
          {w.x(), w.y(), w.z()}};
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  return run_cases(runner_of<Dart>("DART", DART_VERSION), argc, argv);
}
