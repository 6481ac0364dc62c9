// The cases with exact results in timewarp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/engine-cases.h"
#include "support/case-file.h"

namespace tw::bench {
namespace {

class Timewarp : public CaseEngine {
 public:
  Timewarp(const CaseTable& c, double accuracy) {
    world_.set_accuracy(accuracy);
    const test::Case scene = test::case_of(c);
    centers_.resize(scene.bodies.size(), Vec3::Zero());
    if (c.hinges.empty())
      test::fill(world_, scene);
    else
      fill_hinged(c, scene);
  }
  // The first one pays for the start, too: first claims, predictions, the check for overlaps.
  void advance(double duration) override { world_.advance(now_ += duration); }
  EnginePose pose(std::size_t body) const override {
    const BodyState state = world_.state(static_cast<BodyId>(body));
    const Quat& q = state.orientation;
    const Vec3 p = state.position + q * centers_[body];
    return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
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

  World world_;
  std::vector<Vec3> centers_;  // of mass, in the frames of links
  double now_ = 0;
};

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  CaseRunner runner = runner_of<Timewarp>("timewarp", PACKAGE_VERSION);
  runner.settings = {{"accuracy 1e-4", 1e-4},
                     {"accuracy 1e-6", 1e-6},
                     {"accuracy 1e-8", 1e-8},
                     {"accuracy 1e-10", 1e-10}};
  return run_cases(runner, argc, argv);
}
