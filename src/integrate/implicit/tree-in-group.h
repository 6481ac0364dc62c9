// A multibody as a part of a contact group: its unknowns, its equations and their derivative.
//
// Unknowns: z, the displacement of the joints from the step's start (q = q0 (+) z), and u, the
// joint velocities; n of each.
//   z' = G(z, u),   u' = M(q)^-1 f(q, u, wrenches)
// With a0 = u' at the step's start the *residual* f - M a0 is differentiated at fixed a0:
//   Kq = d(f - M a0)/dq,  Ku = df/du,  so that du'/dq = M^-1 Kq and du'/du = M^-1 Ku, exactly.
// A stage (s 1 - Jacobian) k = r is multiplied by M, and kq eliminated, E = (s 1 - G_z)^-1:
//   kq = E (rq + ku),   (s M - Ku - Kq E) ku = M ru + Kq E rq + (contacts).
// Contacts see links as bodies in slots.  Changes of the unknowns move these by
//   (dx, dth) = J kq,   (dv, dw) = J ku + d(J u),
// J the Jacobian at the centre of mass; wrenches on them come back as J^T W, and what J^T W
// changes by with q while W does not stands in Kq.
//
// Source: the paper, section 4.3; R. Featherstone, Rigid Body Dynamics Algorithms (2008),
// chapter 7; S. Singh, R. Russell, P. Wensing, IEEE RA-L 7 (2022); doc/numerics/multibodies.md.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "integrate/arc/group-arc.h"
#include "integrate/given/moving-base.h"
#include "integrate/implicit/contact-linear.h"
#include "multibody/derivatives.h"
#include "multibody/forward-dynamics.h"

namespace tw {

class TreeInGroup {
 public:
  // `end`: of the arc.
  TreeInGroup(const GroupTree& start, double end);

  int freedoms() const { return n_; }
  const GroupTree& start() const { return *start_; }
  bool moved_from_outside() const { return base_.moves(); }
  const std::vector<double>& positions() const { return q0_; }  // at the step's start
  void set_positions(const std::vector<double>& q) { q0_ = q; }
  // q0 (+) z.
  std::vector<double> displaced(const double* z) const;

  // The links' kinematics into their slots.
  void place(double time, const double* z, const double* u, BodyKinematics* bodies);
  // z' and u' where `place` put it.  What is singular gives rates that are not finite.
  void evaluate(const double* z, const double* u, const BodyWrench* wrenches, double* z_rate,
                double* u_rate);
  // The derivative at z = 0, after evaluate there.
  void linearise(const double* u, const double* u_rate, const BodyWrench* wrenches);

  // From here on for stages with this s.
  void set_stage_rate(double sigma);
  // kq = E r in place.
  void eliminate(double* r) const;
  // Joints that follow others (multibody/couplings.h): of a row of unknowns, the followers' from
  // the leaders'; of a row of a right side, the leaders' take the followers', whose are 0.
  void follow(double* row) const;
  void fold(double* row) const;
  // The matrix s M - Ku - Kq E, folded, by columns.
  const std::vector<double>& matrix() const { return matrix_; }
  // M ru + Kq kq.
  void right_side(const double* ru, const double* kq, double* to) const;
  // What changes of the unknowns do to the links.
  void spread(const double* kq, const double* ku, BodyChange* changes) const;
  // Adds J^T W, W the wrenches on the links about their centres of mass.
  void gather(const BodyWrench* wrenches, double* row) const;
  // Adds what the laws at the joints do to the links in a step of h, by z from u0 to u1, that their
  // derivative at the start does not tell (multibody/joint-laws.h).  False: nothing.
  bool add_unforeseen(double h, const double* u0, const double* z, const double* u1,
                      BodyChange* changes);
  // Of a step from u0 with that error (multibody/joint-laws.h).
  double friction_doubt(const double* u0, const double* error) const;
  // M^-1 times a row of torques, in place.
  void accelerate(double* row) const;

 private:
  const multibody::Tree& tree() const { return start_->multibody->tree; }

  const GroupTree* start_;
  int n_;
  std::vector<double> q0_, q_, tau_, u0_, rate_;
  MovingBase base_;
  multibody::BaseMotion around_;
  multibody::Kinematics placed_;  // at the last place
  multibody::Kinematics linear_;  // at the step's start
  multibody::Articulation articulation_;
  multibody::Linearisation linearisation_;
  std::vector<double> mass_, Kq_, Ku_, matrix_;  // by columns
  double sigma_ = 0;
};

}  // namespace tw
