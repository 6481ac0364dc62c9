// The differential equations of a contact group, their derivative and the linear systems of a step.
//
// A state is a row of numbers: 12 a member (x, theta, v, L; theta from the step's start), then 12 a
// pack of four contacts (the stretches: four x, four y, four z, in a's frame), then 12 a pack that
// resists rolling or spinning (the bends, likewise), then 2 n a multibody (tree-in-group.h).  Links
// are members, whose own numbers mean nothing: joints say where they are.
//   x' = v,  theta' = Jl(theta)^-1 w,  v' = F/m,  L' = T,  w = R I^-1 R^T L,  R = exp(theta) R0
// With J = R0 I^-1 R0^T, the derivatives at theta = 0 (exact):
//   dw = J dL + W dth,  W = J [L]x - [w]x,     dtheta' = dw + [w]x dth/2.
// A stage (s 1 - Jacobian) k = r is reduced to 6 unknowns a member, (kv, kL):
//   kx = (rx + kv)/s,  kth = A (rth + J kL),  A = (s - W - [w]x/2)^-1,
//   m s kv - dF = m rv,  s kL - dT = rL,  dF, dT by contact-linear.h and dynamics/forces.h.
// With multibodies the unknowns are those of the members that move by themselves and the joint
// velocities; the matrix is what `solve` does to one unknown at a time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "base/never.h"
#include "integrate/implicit/body-matrix.h"
#include "integrate/implicit/contact-linear.h"
#include "integrate/implicit/coupled-matrix.h"
#include "integrate/implicit/member-linear.h"
#include "integrate/implicit/tree-in-group.h"

namespace tw {

// Work space of a step, shared by all arcs of a thread.  Nothing in it is read that the step did
// not write.
struct GroupScratch {
  std::vector<MemberLinear> members;
  std::vector<BodyKinematics> bodies;  // by slot
  std::vector<BodyChange> changes;     // by slot
  std::vector<BodyWrench> wrenches;    // by slot
  std::vector<PackLinear> linear;      // by pack
  std::vector<PackSides> sides;        // by pack, of the stage
  BodyMatrix::Numbers matrix;
  std::vector<double> right_side;  // the unknowns; at least one a member
  std::vector<double> state, slope, time_slope, trial, stage[6];
  bool firm = true;               // whether the second hardening of contacts counts
  bool reaches_firmness = false;  // of some contact, as evaluated last
  int pressed_hard = 0;           // contacts that press within it, as evaluated last
  double moving_at = -never;      // s: where the outside bodies that move stand
};

class GroupSystem {
 public:
  explicit GroupSystem(const GroupStart& start);

  int members() const { return members_; }
  int packs() const { return static_cast<int>(packs_.packs.size()); }
  int bends() const { return packs_.bends; }
  std::size_t size() const { return size_; }
  std::size_t unknowns() const {
    return coupled_ ? static_cast<std::size_t>(coupled_->size())
                    : 6 * static_cast<std::size_t>(members_);
  }
  const ContactPacks& contact_packs() const { return packs_; }
  std::vector<std::unique_ptr<TreeInGroup>>& trees() { return trees_; }
  const std::vector<std::unique_ptr<TreeInGroup>>& trees() const { return trees_; }
  // Where the stretches of a pack begin, and its bends, if it has some.
  std::size_t stretch_row(int pack) const { return 12 * static_cast<std::size_t>(members_ + pack); }
  std::size_t bend_row(const ContactPack& pack) const { return stretch_row(packs() + pack.bend); }
  // Where the numbers of a multibody begin.
  std::size_t tree_row(std::size_t tree) const { return tree_rows_[tree]; }
  bool moved_from_outside() const {
    return !moving_slots_.empty() || forces_change_ || bases_move_;
  }
  std::uint64_t factorizations() const {
    return coupled_ ? coupled_->factorizations() : matrix_.factorizations();
  }

  // Attitude of a member at the step's start.
  void set_attitude(int member, const Quat& q) { member_[static_cast<std::size_t>(member)].q0 = q; }
  const Quat& attitude(int member) const { return member_[static_cast<std::size_t>(member)].q0; }
  // Normals that choose the sign of line and point contacts, by pack.
  const std::vector<LaneVec>& sides() const { return sides_; }

  // dy/dt; leaves the kinematics of all slots in the scratch.
  void evaluate(double time, const double* y, GroupScratch& scratch, double* slope) const;
  // The same at theta = 0, with the derivative; sets the sides.
  void linearise(double time, const double* y, GroupScratch& scratch, double* slope);
  // Partial derivative by time at y, by the motion of outside bodies, whose velocities are
  // differenced over a part of the `step`, as are forces that change by themselves; all of it where
  // bases of multibodies move.  After linearise, which gave `slope`, before factor.
  void set_time_slope(double time, double step, const double* y, const double* slope,
                      GroupScratch& scratch, double* time_slope) const;
  // Largest over members of the sum of |dN/dd| of its contacts, or of k where that is more, over
  // its mass, 1/s^2, as linearised last.
  double squared_frequency(GroupScratch& scratch) const;
  // Of springs, holds and other forces, contacts apart: the largest over members of the sums of
  // |dF/dx|/m + |dT/dth|/I, 1/s^2, and of |dF/dv|/m + |dT/dw|/I, 1/s, I the least moment; as
  // linearised last.
  struct SpringRates {
    double squared_frequency = 0, damping = 0;
  };
  SpringRates spring_rates(const GroupScratch& scratch) const;
  // The same frequency of one bond, of both its bodies.
  double squared_frequency_of(int bond) const;
  // For a step h, sigma = 1/(gamma h).  False: singular.
  bool factor(double sigma, GroupScratch& scratch);
  // In place: right side to stage.  Leaves the changes of x, theta, v, w in the scratch.  False:
  // singular.
  bool solve(GroupScratch& scratch, double* stage);

  // Of this thread, fitted to the system.
  GroupScratch& scratch() const;

  Vec3 angular_velocity(int member, const Quat& q, const Vec3& L) const;
  // Kinematics of slots at one instant from poses and momenta.
  void set_member(int member, const Vec3& x, const Quat& q, const Vec3& v, const Vec3& L,
                  BodyKinematics& out) const;
  void set_outside(double time, GroupScratch& scratch) const;
  void set_outside_slot(int slot, double time, BodyKinematics& body) const;

 private:
  struct Member {
    double mass = 1, inverse_mass = 1;
    Vec3 inverse_moments = Vec3::Ones(), force = Vec3::Zero(), torque = Vec3::Zero();
    Quat q0 = Quat::Identity();
    bool is_link = false;
    int unknown = 0;   // its first one, where there are multibodies
    ForcesPtr forces;  // what else acts on it
  };

  struct HeldPair {
    GroupBond given;
    Bond::Derivative derivative;  // at the step's start
  };

  // `number`: what of the lanes counts
  template <class Number>
  void add_block(int Y, int X, const LaneMat (&part)[2][2], Number number);
  template <bool with_derivative>
  void evaluate_as(double time, const double* y, GroupScratch& scratch, double* slope) const;
  PoseTwist point_of(int member, const double* y, const BodyKinematics& body) const;
  void add_bond_wrenches(const double* y, GroupScratch& scratch) const;
  void difference_slopes(double time, double step, const double* y, const double* slope,
                         GroupScratch& scratch, double* time_slope) const;
  void place_outside(int slot, double time, BodyKinematics& body) const;
  // Outside bodies that move, where they do not stand there since set_outside, or since an
  // evaluation after it; the others are where set_outside put them.
  void set_moving(double time, GroupScratch& scratch) const;
  LaneBody gather(const ContactPack& pack, const int (&slot)[lane_count],
                  const GroupScratch& scratch) const;
  // Parts of a stage (group-stage.cc).
  void change_bond(int bond, GroupScratch& scratch) const;
  void subtract_from_block(const WrenchDerivative& by, const MemberLinear& of_X, int Y, int X);
  PackSides sides_of(int pack, const PackLinear& linear, const double* stage) const;
  void scatter_stretches(GroupScratch& scratch, const double* stage) const;
  void solve_stretches(GroupScratch& scratch, double* stage) const;

  // ---- with multibodies (coupled-stage.cc) ----
  // Contacts and bonds, ascending.
  struct Couplings {
    std::vector<int> packs, bonds;
    void add(const Couplings& more);
    void tidy();
  };
  void make_coupled();
  double rate_of(int member, const Mat6& derivative) const;
  bool factor_coupled(GroupScratch& scratch);
  bool solve_coupled(GroupScratch& scratch, double* stage);
  // Calls visit(slot) for each body of these, perhaps more than once.
  template <class Visit>
  void each_slot(const Couplings& couplings, Visit&& visit) const;
  // The wrenches that the changes of their slots make, into the scratch.
  void change_couplings(const Couplings& couplings, GroupScratch& scratch) const;
  // One column: the changes of its bodies are in the scratch; minus their wrenches into `column`.
  void gather_column(const Couplings& couplings, GroupScratch& scratch,
                     std::span<const int> moved_members, double* column) const;
  void change_forced(int member, GroupScratch& scratch) const;

  int members_;
  std::size_t size_;
  double end_;
  std::vector<TrajectoryPtr> outside_;
  std::vector<BodyKinematics> outside_at_start_;
  bool forces_change_ = false;     // of some member, with time by themselves
  bool bases_move_ = false;        // of some multibody
  std::vector<int> moving_slots_;  // of outside bodies that do not stand still, ascending
  std::vector<Member> member_;
  std::vector<HeldPair> bonds_;
  ContactPacks packs_;
  std::vector<LaneVec> sides_;
  BodyMatrix matrix_;
  double sigma_ = 0;
  std::vector<std::unique_ptr<TreeInGroup>> trees_;
  std::vector<std::size_t> tree_rows_;
  std::vector<int> tree_unknowns_;  // the first of each
  std::vector<Couplings> couplings_of_slot_, couplings_of_tree_;
  std::unique_ptr<CoupledMatrix> coupled_;  // where there are multibodies
};

}  // namespace tw
