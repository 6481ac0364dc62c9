// A cluster of bodies in rough contact, followed by steps: cost falls with the depth that is asked
// for.
//
// All members take steps of one length, h = h0/2^k on a lattice from the cluster's start.  A step
// looks at the pairs (step-pairs.h), solves their contacts together (contact-sweeps.h) and moves
// everybody; then contacts are looked at where it ended, which is the look of the next step.  Where
// a pair is deeper than asked for and has got deeper, all go back and take two steps of half the
// length.
//
// What touches nothing in a step flies its parabola exactly, turning by the midpoint rule; its
// angular momentum stays to rounding.  Errors where bodies touch: doc/numerics/stepped-clusters.md.
//
// The motion is a function of what the constructor is given alone.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "integrate/stepped/contact-sweeps.h"
#include "integrate/stepped/step-bodies.h"
#include "integrate/stepped/step-pairs.h"

namespace tw {

struct StepSettings {
  double step = 1.0 / 240;  // s, the longest
  double depth = 5e-3;      // m, to be kept to
  double follow = 0.03;     // of the lesser size: motion between looks at what touches
  int substeps = 2;
  int pushing = 2, relaxing = 2;
  int halvings = 4;  // at most, one inside the other
};

class SteppedCluster {
 public:
  SteppedCluster(std::vector<StepMember> members, std::vector<StepOutside> outside, StepLaws laws,
                 const Vec3& gravity, const StepSettings& settings, double start);

  // One step of the longest length.
  void advance();
  double time() const { return time_; }
  PoseTwist state(int member) const;           // of the centre of mass, with the shape's attitude
  double deepest() const { return deepest_; }  // m, at the ends of all steps so far
  StepCounts counts() const;

 private:
  // Where a member was, to go back.
  struct Kept {
    Vec3 x, v, w;
    Quat q;
    Frame frame;
  };
  struct Level {
    double time = 0, impulse_time = 0;
    std::vector<Kept> members;
    std::vector<StepContact> contacts;
  };

  void step(double h, int level);
  void look(double h);
  void solve(double h);
  void move(double h);
  void fly(std::size_t i, double h);
  void slide(std::size_t i, double h);
  void place(std::size_t i, const Vec3& x, const Quat& q);
  void drive_outside(double h);
  void keep(Level& level) const;
  void go_back(const Level& level);

  const std::vector<StepMember> members_;
  const std::vector<StepOutside> outside_;
  StepSettings settings_;
  double time_;
  std::vector<StepBody> bodies_;  // members first
  std::vector<Quat> attitudes_;   // of members
  // G^-T of each (contact-sweeps.h), and the inverse inertia, shape's frame
  std::vector<Mat3> root_, inverse_;
  StepPairs pairs_;
  ContactSweeps sweeps_;
  std::vector<SweepMember> sweep_members_;
  std::vector<StepContact> contacts_;
  std::vector<unsigned char> touched_;
  std::vector<Level> levels_;
  double looked_for_ = 0;  // s: the step that the contacts are for; 0: none are there
  double worst_ = 0;       // m, among those that have grown
  double deepest_ = 0;
  double impulse_time_ = 0;  // s: the substep that the impulses are of
  StepCounts counts_;
};

}  // namespace tw
