// The equations of a multibody that touches nothing, for explicit methods.
//
// y = (z, u): the displacement from the chart, which is q at the step's start, and the velocities.
// z' = G(z, u), u' by the articulated-body algorithm.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "integrate/arc/group-arc.h"
#include "integrate/explicit/equations.h"
#include "integrate/given/moving-base.h"
#include "multibody/forward-dynamics.h"

namespace tw {

class JointEquations final : public Equations {
 public:
  // `end`: of the arc; `tolerance`: the error of a step in displacements, rad; of distances a share
  // of `size`, m, of velocities times `rate`, 1/s, or the fastest one.
  JointEquations(const GroupTree& tree, double end, double tolerance, double size, double rate);

  int size() const override { return 2 * n_; }
  int chart_size() const override;
  void slope(double time, const double* y, const double* chart, double* slope) const override;
  void tolerances(const double* y, const double* chart, double* allowed) const override;
  double longest_step(const double* y, const double* slope, const double* chart) const override;
  void recentre(double* y, double* slope, double* chart) const override;

 private:
  const GroupTree& tree_;
  int n_;
  double tolerance_, size_, rate_;
  std::vector<bool> is_distance_;  // of each dof
  MovingBase base_;
  mutable multibody::BaseMotion around_;
  mutable multibody::Kinematics placed_;
  mutable multibody::Articulation articulation_;
  mutable std::vector<double> q_, tau_;
};

// How fast the laws at the joints of a multibody are where it starts, each by its own inertia: the
// largest (stiffness/inertia), 1/s^2, of springs, servos and the stops it leans on, and the largest
// damping/inertia, 1/s.
struct JointRates {
  double squared_frequency = 0, damping = 0;
};
JointRates joint_rates(const GroupTree& tree);

// Whether explicit steps of a multibody are as long as accuracy lets them be: nothing that acts at
// its joints is stiff against how it moves, a function of the state it starts in.  `size`, `rate`:
// as above.
bool is_nonstiff(const GroupTree& tree, double size, double rate);

// Whether springs and servos at the joints of the group's multibody, which touches nothing, swing
// so widely, and are damped so little, that an explicit method takes longer steps than RODAS4:
// where its joints are at q and u at `time`.
bool swings_widely(const GroupStart& start, double time, const std::vector<double>& q,
                   const std::vector<double>& u);

}  // namespace tw
