// What an arc keeps of the joints of a multibody: positions and velocities as functions of time.
//
// At the nodes of the steps the positions q; within each step the displacement from its start and
// the velocities u as polynomials.  Links are where the joints put them at every time, so that
// joints hold to rounding, and what is asked of a link follows from its way to the base:
// bounds go from link to link with |w'|, |w''|, |a| and |a'|, each by the lesser of what the joint
// before may add and what the two ends of the stretch show.  Those of a few parts of every step are
// made with the step, of all links in one pass; what is asked for is put together from them, but
// for stretches that are short against their part.
//
// Frames: links by their principal frames at the centre of mass, in the world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "integrate/arc/bounds-tree.h"
#include "integrate/explicit/step-polynomials.h"
#include "integrate/given/moving-base.h"
#include "integrate/trajectory.h"
#include "multibody/kinematics.h"
#include "multibody/multibody.h"

namespace tw {

class JointRecord {
 public:
  // `end`: of the arc; `degree`: of the polynomials.
  JointRecord(const Multibody& multibody, double start, double end, const std::vector<double>& q,
              const std::vector<double>& u, int degree);

  double start() const { return path_.start(); }
  double reached() const { return path_.reached(); }
  // How many it holds: its memory in doubles, more or less.
  std::size_t numbers() const { return path_.numbers() + nodes_.size(); }
  // A step to `time`, where the positions are q: coefficients of the n displacements and the n
  // velocities, up to the degree of the record or a lower one.
  void append(double time, std::vector<double> coefficients, const std::vector<double>& q);

  // At a time on the record.
  void joints(double time, std::vector<double>& q, std::vector<double>& u) const;
  Pose pose(int link, double time) const;
  // With the velocities that were integrated.
  PoseTwist at(int link, double time) const;
  // The rates of the pose; at a node those of the step before it, as `pose_rates` of the group.
  Twist rates(int link, double time) const;
  MotionBounds bounds(int link, double from, double to) const;
  // When what an axis' limits hold first gets below (side 1) or above (side -1) a limit, s, or,
  // where it begins beyond it, further beyond; `never`: it does not.
  double first_beyond(const multibody::Axis& axis, double side, double limit) const;
  // A copy from the step that holds `from` on.
  JointRecord stretch(double from) const;

 private:
  // Which velocities the links have.
  enum class Velocities { integrated, of_path };
  struct Placed;
  const Placed& placed(double time, Velocities which) const;
  const Placed& place_on_path(int step, double r) const;
  void fill(int step, double r, double time, bool of_path, Placed& p) const;
  double time_at(int step, double r) const;
  // What the axis' limits hold (multibody/limits.h).
  double limited(const multibody::Axis& axis, int step, double r) const;
  double limited_rate(const multibody::Axis& axis, int step, double r0, double r1) const;
  double first_beyond(const multibody::Axis& axis, double side, double limit, double least,
                      int step, double r0, double r1) const;
  struct Stretch;
  struct Ends;
  MotionRates base_rates(const Stretch& stretch) const;
  MotionRates node_rates(int node, const MotionRates& parent, const Stretch& stretch,
                         const Ends& ends) const;
  MotionBounds link_bounds(const MotionRates& node, int link, const Stretch& stretch,
                           const PoseTwist& a, const PoseTwist& b) const;
  void keep_bounds(int step);
  MotionBounds short_bounds(int step, int link, double from, double to) const;
  const double* node(int i) const {
    return nodes_.data() +
           static_cast<std::size_t>(i) * static_cast<std::size_t>(multibody_->tree.nq());
  }
  const double* node_u(int i) const {
    return nodes_u_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n_);
  }
  static std::uint64_t next_serial();

  const Multibody* multibody_;
  MovingBase base_;
  int n_;
  StepPolynomials path_;                 // displacements, velocities
  std::vector<double> nodes_;            // q
  std::vector<double> nodes_u_;          // u at the nodes
  std::vector<BoundsTree> kept_bounds_;  // of each link, over the parts of the steps
  std::uint64_t serial_ = next_serial();
};

// Where the principal frame of a link is, and how it moves, as placed.
PoseTwist link_point(const Multibody& multibody, const multibody::Kinematics& k, int link);

}  // namespace tw
