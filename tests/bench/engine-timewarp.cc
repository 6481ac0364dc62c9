// The cases in timewarp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/engine-cases.h"
#include "bench/made-cases.h"
#include "integrate/given/sampled-motion.h"
#include "support/case-file.h"
#include "support/case-motion.h"

namespace tw::bench {
namespace {

// Of a driven body, as a scene's procedure would be.
class DrivenMotion : public MotionProcedure {
 public:
  DrivenMotion(CaseBody body, const test::CaseMotion& motion)
      : body_(std::move(body)), motion_(motion) {}
  std::string name() const override { return "driven"; }
  Pose pose(double time) const override {
    const CaseBody now = test::driven_body(body_, motion_, time);
    const auto& q = now.orientation;
    return {test::vector_of(now.position), Quat(q[0], q[1], q[2], q[3])};
  }
  void require_speed(double, const Pose&, double, const Pose&) const override {}
  double max_speed() const override { return 100; }
  double size() const override {
    return 2 * std::min({body_.size[0], body_.size[1], body_.size[2]});
  }
  double radius() const override { return test::vector_of(body_.size).norm(); }

 private:
  CaseBody body_;
  test::CaseMotion motion_;
};

bool rolls(const std::string& name) { return name.rfind("rolling", 0) == 0; }

// `setting`: an accuracy; where the contacts' own law is what misses the exact result, their
// stiffness, N/m.
class Timewarp : public CaseEngine {
 public:
  Timewarp(const CaseTable& c, double setting) {
    rolls(c.name) ? stiffness_ = setting : accuracy_ = setting;
    world_.set_accuracy(accuracy_);
    // what helpers do is not in the time
    world_.set_threads(1);
    test::Case scene = test::case_of(c);
    for (std::size_t i = 0; i < c.bodies.size(); ++i)
      if (c.bodies[i].driven) drive(scene.bodies[i], c.bodies[i], c.motion);
    centers_.resize(scene.bodies.size(), Vec3::Zero());
    if (c.hinges.empty())
      test::fill(world_, scene);
    else
      fill_hinged(c, scene);
    rub_and_push(c);
  }
  // The first one pays for the start, too: first claims, predictions, the check for overlaps.
  void advance(double duration) override { world_.advance(now_ += duration); }
  EngineState state(std::size_t body) const override {
    const BodyState state = world_.state(static_cast<BodyId>(body));
    const Quat& q = state.orientation;
    const Vec3 p = state.position + q * centers_[body];
    const Vec3 &v = state.velocity, &w = state.angular_velocity;
    return {{p.x(), p.y(), p.z()},
            {q.w(), q.x(), q.y(), q.z()},
            {v.x(), v.y(), v.z()},
            {w.x(), w.y(), w.z()}};
  }

 private:
  // Bodies without a turn at the start; the frame of a link is at its hinge.
  void fill_hinged(const CaseTable& c, const test::Case& scene) {
    world_.set_gravity(scene.gravity);
    MultibodyDef tree;
    tree.name = c.name;
    for (const test::CaseHinge& hinge : c.hinges) {
      const Vec3 anchor = test::vector_of(hinge.anchor);
      const auto child = static_cast<std::size_t>(hinge.child);
      LinkDef link;
      link.body = scene.bodies[child];
      link.name = link.body.name;
      centers_[child] = link.body.position - anchor;
      link.body.center_of_mass = centers_[child];
      link.body.position = Vec3::Zero();
      link.joint.axis = test::vector_of(hinge.axis);
      link.joint.placement.p = anchor;
      if (hinge.parent >= 0) {
        const BodyDef& parent = scene.bodies[static_cast<std::size_t>(hinge.parent)];
        link.parent = parent.name;
        link.joint.placement.p +=
            centers_[static_cast<std::size_t>(hinge.parent)] - parent.position;
      }
      tree.links.push_back(link);
    }
    world_.add_multibody(tree);
  }

  static void drive(BodyDef& def, const CaseBody& body, const test::CaseMotion& motion) {
    def.motion = std::make_shared<SampledMotion>(std::make_unique<DrivenMotion>(body, motion));
    def.position = Vec3::Zero();
    def.orientation = Quat::Identity();
    def.mass.reset();
    def.inertia.reset();
  }

  void rub_and_push(const CaseTable& c) {
    if (stiffness_) {
      ContactSettings settings;
      settings.restitution = c.restitution;
      settings.friction = c.friction;
      settings.stiffness = stiffness_;
      world_.set_contact({}, {}, settings);
    }
    for (std::size_t i = 0; i < c.bodies.size(); ++i) {
      const CaseBody& body = c.bodies[i];
      const auto id = static_cast<BodyId>(i);
      if (body.friction >= 0) {
        ContactSettings settings;
        settings.restitution = c.restitution;
        settings.friction = body.friction;
        settings.stiffness = stiffness_;
        world_.set_contact({ContactSide::Kind::body, "", id}, {}, settings);
      }
      if (!test::is_pushed(body)) continue;
      world_.advance(0);
      world_.edit(id,
                  [&](StateView& view) { view.set_applied_force(test::vector_of(body.force)); });
    }
  }

  World world_;
  double accuracy_ = 1e-6;
  std::optional<double> stiffness_;
  std::vector<Vec3> centers_;  // of mass, in the frames of links
  double now_ = 0;
};

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  CaseRunner runner = runner_of<Timewarp>("timewarp", PACKAGE_VERSION);
  runner.by_steps = false;
  runner.every_setting = true;
  runner.settings = [](const std::string& name) {
    if (rolls(name))
      return std::vector<Setting>{{"stiffness 1e6 N/m", 1e6},
                                  {"stiffness 1e8 N/m", 1e8},
                                  {"stiffness 1e10 N/m", 1e10},
                                  {"stiffness 1e12 N/m", 1e12}};
    if (is_judged_by_depth(name))
      return std::vector<Setting>{{"accuracy 1e-3", 1e-3}, {"accuracy 1e-4", 1e-4}};
    return std::vector<Setting>{{"accuracy 1e-4", 1e-4},
                                {"accuracy 1e-6", 1e-6},
                                {"accuracy 1e-8", 1e-8},
                                {"accuracy 1e-10", 1e-10}};
  };
  return run_cases(runner, argc, argv);
}
