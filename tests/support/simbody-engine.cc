// Forward dynamics by Simbody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <Simbody.h>

#include <map>

#include "support/dynamics-engine.h"

namespace tw::test {
namespace {

using multibody::JointKind;
using multibody::LinkSpec;

SimTK::Vec3 convert(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

SimTK::Rotation convert(const Mat3& R) {
  SimTK::Mat33 m;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m(r, c) = R(r, c);
  return SimTK::Rotation(m);
}

SimTK::MassProperties mass_properties(const LinkSpec& link) {
  const Mat3& I = link.inertia;
  const SimTK::Inertia central(SimTK::Vec3(I(0, 0), I(1, 1), I(2, 2)),
                               SimTK::Vec3(I(1, 0), I(2, 0), I(2, 1)));
  const SimTK::Vec3 c = convert(link.center_of_mass);
  return SimTK::MassProperties(link.mass, c, central.shiftFromMassCenter(-c, link.mass));
}

// The frame in which Simbody's joint has its axes: a pin turns about z, a slider runs along x, a
// universal joint turns about x, then y.
SimTK::Rotation joint_axes(const multibody::JointSpec& joint) {
  const Vec3 axis = joint.axis.normalized(), second = joint.second.normalized();
  if (joint.kind == JointKind::revolute)
    return SimTK::Rotation(SimTK::UnitVec3(convert(axis)), SimTK::ZAxis);
  if (joint.kind == JointKind::prismatic)
    return SimTK::Rotation(SimTK::UnitVec3(convert(axis)), SimTK::XAxis);
  if (joint.kind == JointKind::universal)
    return SimTK::Rotation(SimTK::UnitVec3(convert(axis)), SimTK::XAxis, convert(second),
                           SimTK::YAxis);
  return SimTK::Rotation();
}

class SimbodyEngine : public DynamicsEngine {
 public:
  SimbodyEngine(const Links& links, const Vec3& gravity)
      : gravity_(forces_, matter_, convert(gravity)) {
    std::map<std::string, SimTK::MobilizedBodyIndex> made{{"", matter_.getGround()}};
    for (const LinkSpec& link : links) {
      made[link.name] = add(link, matter_.updMobilizedBody(made[link.parent]));
      joints_.push_back({link.joint.kind, made[link.name]});
    }
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    given_.resize(state_.getNU());
  }

  void accelerations(const double* q, const double* u, const double* tau, double* rate) override {
    set_state(q, u, tau);
    torques_.setAllMobilityForces(state_, given_);
    system_.realize(state_, SimTK::Stage::Acceleration);
    const SimTK::Vector& result = state_.getUDot();
    for (const Joint& joint : joints_) {
      const SimTK::MobilizedBody& body = matter_.getMobilizedBody(joint.body);
      const int first = body.getFirstUIndex(state_), count = body.getNumU(state_);
      if (joint.kind == JointKind::free) {
        for (int i = 0; i < 6; ++i) rate[i] = result[first + (i + 3) % 6];
      } else if (joint.kind == JointKind::spherical) {
        const SimTK::Vec3 in_link = ~body.getMobilizerTransform(state_).R() * vector(result, first);
        for (int i = 0; i < 3; ++i) rate[i] = in_link[i];
      } else {
        for (int i = 0; i < count; ++i) rate[i] = result[first + i];
      }
      rate += count;
    }
  }

 private:
  struct Joint {
    JointKind kind;
    SimTK::MobilizedBodyIndex body;
  };

  static SimTK::Vec3 vector(const SimTK::Vector& v, int first) {
    return {v[first], v[first + 1], v[first + 2]};
  }

  static SimTK::MobilizedBodyIndex add(const LinkSpec& link, SimTK::MobilizedBody& parent) {
    const SimTK::Body::Rigid body(mass_properties(link));
    const SimTK::Rotation axes = joint_axes(link.joint);
    const SimTK::Rotation R = convert(link.joint.placement.q.toRotationMatrix());
    const SimTK::Transform X(R * axes, convert(link.joint.placement.p));
    const SimTK::Transform M(axes, SimTK::Vec3(0));
    switch (link.joint.kind) {
      case JointKind::weld: return SimTK::MobilizedBody::Weld(parent, X, body, M);
      case JointKind::revolute: return SimTK::MobilizedBody::Pin(parent, X, body, M);
      case JointKind::prismatic: return SimTK::MobilizedBody::Slider(parent, X, body, M);
      case JointKind::universal: return SimTK::MobilizedBody::Universal(parent, X, body, M);
      case JointKind::spherical: return SimTK::MobilizedBody::Ball(parent, X, body, M);
      case JointKind::free: break;
    }
    return SimTK::MobilizedBody::Free(parent, SimTK::Transform(), body, SimTK::Transform());
  }

  // Simbody's free joint has orientation before position; its ball joint has velocities and torques
  // in the joint's frame, where ours have them in the link's.
  void set_state(const double* q, const double* u, const double* tau) {
    SimTK::Vector& to_q = state_.updQ();
    SimTK::Vector& to_u = state_.updU();
    for (const Joint& joint : joints_) {
      const SimTK::MobilizedBody& body = matter_.getMobilizedBody(joint.body);
      const int qs = body.getNumQ(state_), us = body.getNumU(state_);
      const int first_q = body.getFirstQIndex(state_), first_u = body.getFirstUIndex(state_);
      const bool free = joint.kind == JointKind::free;
      for (int i = 0; i < qs; ++i) to_q[first_q + i] = q[free ? (i + 3) % 7 : i];
      if (joint.kind == JointKind::spherical) {
        const SimTK::Rotation R(SimTK::Quaternion(q[0], q[1], q[2], q[3]));
        const SimTK::Vec3 w = R * SimTK::Vec3(u[0], u[1], u[2]);
        const SimTK::Vec3 t = R * SimTK::Vec3(tau[0], tau[1], tau[2]);
        for (int i = 0; i < 3; ++i) to_u[first_u + i] = w[i], given_[first_u + i] = t[i];
      } else {
        for (int i = 0; i < us; ++i) {
          to_u[first_u + i] = u[free ? (i + 3) % 6 : i];
          given_[first_u + i] = tau[free ? (i + 3) % 6 : i];
        }
      }
      q += qs, u += us, tau += us;
    }
  }

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  SimTK::Force::UniformGravity gravity_;
  SimTK::Force::DiscreteForces torques_{forces_, matter_};
  SimTK::State state_;
  SimTK::Vector given_;
  std::vector<Joint> joints_;
};

}  // namespace

std::unique_ptr<DynamicsEngine> make_simbody(const Links& links, const Vec3& gravity) {
  return std::make_unique<SimbodyEngine>(links, gravity);
}

}  // namespace tw::test
