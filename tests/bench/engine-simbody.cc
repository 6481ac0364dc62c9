// The cases in Simbody.
//
// Its contacts are springs with Hunt and Crossley's damping, whose restitution depends on the
// speed: it is right at the first impact.  Stiffness and the speed below which friction is viscous
// follow the accuracy that is asked for.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <Simbody.h>

#include <cmath>
#include <memory>

#include "bench/engine-cases.h"

namespace tw::bench {
namespace {

// Pa, m/s: of contacts at accuracy 1
constexpr double softest = 1e5;
constexpr double viscous_speed = 0.1;
constexpr double gravity = 9.81;  // m/s^2, in what rests
// m/s: of the first impact that damps (bounce: 1 m of fall)
const double impact_speed = std::sqrt(2 * 9.81 * 1);

SimTK::Vec3 vector_of(const test::Numbers3& x) { return {x[0], x[1], x[2]}; }

SimTK::Rotation rotation_of(const std::array<double, 4>& q) {
  return SimTK::Rotation(SimTK::Quaternion(q[0], q[1], q[2], q[3]));
}

// The dissipation c, s/m, with which f = k x^(3/2) (1 + 3/2 c v) gives back `restitution` at a
// speed.  With a = 3/2 c, v dv / (1 + a v) is the same integral on the way in and on the way out.
double dissipation_of(double restitution, double speed) {
  if (restitution >= 1) return 0;
  const auto energy = [](double a, double v) { return v / a - std::log1p(a * v) / (a * a); };
  double low = 1e-6 / speed, high = 0.999 / (restitution * speed);
  for (int i = 0; i < 60; ++i) {
    const double a = 0.5 * (low + high);
    (energy(a, -restitution * speed) < energy(a, speed) ? low : high) = a;
  }
  return low / 1.5;
}

class Simbody : public CaseEngine {
 public:
  Simbody(const CaseTable& c, double accuracy);
  void advance(double duration) override { stepper_->stepTo(now_ += duration); }
  EngineState state(std::size_t body) const override;

 private:
  SimTK::ContactMaterial material_of(const CaseTable& c, double accuracy) const;
  void add(const CaseBody& def, const SimTK::ContactMaterial& material);
  void add_hinged(const CaseTable& c, const test::CaseHinge& hinge);

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  SimTK::ContactTrackerSubsystem tracker_{system_};
  SimTK::CompliantContactSubsystem contacts_{system_, tracker_};
  std::vector<SimTK::MobilizedBody> bodies_;
  std::unique_ptr<SimTK::Integrator> integrator_;
  std::unique_ptr<SimTK::TimeStepper> stepper_;
  double now_ = 0;
};

// What does not bounce is damped about critically: a box, whose corners are linear springs, as a
// quarter of its mass on each, a ball as if it were on one.
SimTK::ContactMaterial Simbody::material_of(const CaseTable& c, double accuracy) const {
  double stiffness = softest / accuracy, dissipation = 0;
  if (c.restitution > 0) {
    dissipation = dissipation_of(c.restitution, impact_speed);
  } else {
    // the first that moves: a lone body, or the one after the ground
    const CaseBody& body = c.bodies[c.bodies.size() > 1 ? 1 : 0];
    const double mass = body.shape == "box" ? 0.25 * body.mass : body.mass;
    dissipation = 2 * std::sqrt(stiffness / mass) / gravity;
  }
  return SimTK::ContactMaterial(stiffness, dissipation, c.friction, c.friction);
}

void Simbody::add(const CaseBody& def, const SimTK::ContactMaterial& material) {
  using SimTK::ContactGeometry;
  SimTK::MobilizedBody& ground = matter_.updGround();
  if (def.fixed) {
    // Simbody's half-space is where x is positive
    const SimTK::UnitVec3 normal(rotation_of(def.orientation) * SimTK::Vec3(0, 0, 1));
    ground.updBody().addContactSurface(
        SimTK::Transform(SimTK::Rotation(-normal, SimTK::XAxis), vector_of(def.position)),
        SimTK::ContactSurface(ContactGeometry::HalfSpace(), material));
    bodies_.push_back(ground);
    return;
  }
  SimTK::Body::Rigid body(
      SimTK::MassProperties(def.mass, SimTK::Vec3(0), SimTK::Inertia(vector_of(def.inertia))));
  if (def.shape == "sphere")
    body.addContactSurface(SimTK::Transform(),
                           SimTK::ContactSurface(ContactGeometry::Sphere(def.size[0]), material));
  else
    body.addContactSurface(
        SimTK::Transform(),
        SimTK::ContactSurface(ContactGeometry::Brick(vector_of(def.size)), material));
  bodies_.push_back(
      SimTK::MobilizedBody::Free(ground, SimTK::Transform(), body, SimTK::Transform()));
}

// Bodies without a turn at the start; their frames are at the centres of mass.
void Simbody::add_hinged(const CaseTable& c, const test::CaseHinge& hinge) {
  const CaseBody& def = c.bodies[static_cast<std::size_t>(hinge.child)];
  const SimTK::Body::Rigid body(
      SimTK::MassProperties(def.mass, SimTK::Vec3(0), SimTK::Inertia(vector_of(def.inertia))));
  // a pin turns about z
  const SimTK::Rotation axes(SimTK::UnitVec3(vector_of(hinge.axis)), SimTK::ZAxis);
  const SimTK::Vec3 anchor = vector_of(hinge.anchor);
  const auto parent = static_cast<std::size_t>(hinge.parent);
  const SimTK::Vec3 origin =
      hinge.parent < 0 ? SimTK::Vec3(0) : vector_of(c.bodies[parent].position);
  SimTK::MobilizedBody& on =
      hinge.parent < 0 ? static_cast<SimTK::MobilizedBody&>(matter_.updGround()) : bodies_[parent];
  bodies_.push_back(
      SimTK::MobilizedBody::Pin(on, SimTK::Transform(axes, anchor - origin), body,
                                SimTK::Transform(axes, anchor - vector_of(def.position))));
}

Simbody::Simbody(const CaseTable& c, double accuracy) {
  SimTK::Force::UniformGravity(forces_, matter_, vector_of(c.gravity));
  const SimTK::ContactMaterial material = material_of(c, accuracy);
  for (const test::CaseHinge& hinge : c.hinges) add_hinged(c, hinge);
  for (const CaseBody& body : c.bodies)
    if (c.hinges.empty()) add(body, material);
  contacts_.setTransitionVelocity(viscous_speed * std::sqrt(accuracy));
  SimTK::State state = system_.realizeTopology();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const CaseBody& def = c.bodies[i];
    if (def.fixed || !c.hinges.empty()) continue;
    bodies_[i].setQToFitTransform(
        state, SimTK::Transform(rotation_of(def.orientation), vector_of(def.position)));
    bodies_[i].setUToFitVelocity(
        state, SimTK::SpatialVec(vector_of(def.angular_velocity), vector_of(def.velocity)));
  }
  integrator_ = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
  integrator_->setAccuracy(accuracy);
  stepper_ = std::make_unique<SimTK::TimeStepper>(system_, *integrator_);
  stepper_->initialize(state);
}

EngineState Simbody::state(std::size_t body) const {
  const SimTK::State& state = stepper_->getState();
  system_.realize(state, SimTK::Stage::Position);
  const SimTK::Transform& X = bodies_[body].getBodyTransform(state);
  const SimTK::Quaternion q = X.R().convertRotationToQuaternion();
  system_.realize(state, SimTK::Stage::Velocity);
  const SimTK::Vec3 v = bodies_[body].getBodyOriginVelocity(state);
  const SimTK::Vec3 w = bodies_[body].getBodyAngularVelocity(state);
  return {{X.p()[0], X.p()[1], X.p()[2]},
          {q[0], q[1], q[2], q[3]},
          {v[0], v[1], v[2]},
          {w[0], w[1], w[2]}};
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  CaseRunner runner =
      runner_of<Simbody>("Simbody", std::to_string(major) + "." + std::to_string(minor));
  runner.by_steps = false;
  runner.settings = [](const std::string&) {
    std::vector<Setting> result;
    for (const char* accuracy : {"1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12"})
      result.push_back({std::string("accuracy ") + accuracy, std::atof(accuracy)});
    return result;
  };
  // boxes meet half-spaces alone
  runner.unable = [](const CaseTable& c) {
    const bool boxes = c.bodies.size() > 2 && c.bodies[1].shape == "box" && c.hinges.empty();
    return boxes ? "no contacts of boxes with boxes or balls" : "";
  };
  return run_cases(runner, argc, argv);
}
