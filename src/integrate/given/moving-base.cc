// The base of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/moving-base.h"

#include <algorithm>
#include <cmath>

#include "multibody/forward-dynamics.h"

namespace tw {

using namespace multibody;

double MovingBase::inside(double time) const {
  return time < end_ ? time : std::nextafter(end_, -never);
}

void MovingBase::set(double time, BaseMotion& around) const {
  around.base = multibody_->base;
  if (!moves()) return;
  const double known = std::min(time, end_), beyond = time - known;
  Pose body = motion().pose(known);
  Twist t = motion().twist(inside(known));
  const Twist rate = motion().twist_rates(inside(known));
  if (beyond > 0) {
    body.p += beyond * (t.v + 0.5 * beyond * rate.v);
    body.q = rotation_by(beyond * (t.w + 0.5 * beyond * rate.w)) * body.q;
    t.v += beyond * rate.v;
    t.w += beyond * rate.w;
  }
  const Vec3 arm = body.q * multibody_->base_in_motion.p;
  around.base = Frame(body * multibody_->base_in_motion);
  around.v = t.v + t.w.cross(arm);
  around.w = t.w;
  around.a = rate.v + rate.w.cross(arm) + t.w.cross(t.w.cross(arm));
  around.alpha = rate.w;
}

Twist MovingBase::twist(double time) const {
  if (!moves()) return {};
  BaseMotion around;
  set(time, around);
  return {around.v, around.w};
}

Twist MovingBase::twist_before(double time) const { return twist(std::nextafter(time, -never)); }

MotionRates MovingBase::most_rates(double from, double to) const {
  if (!moves()) return {};
  return motion().most_rates(from, to).at(multibody_->base_in_motion.p.norm());
}

double next_corner_of(const Multibody& multibody, double from, double to) {
  return multibody.base_motion ? multibody.base_motion->next_corner(from, to) : never;
}

void follow_base(const Multibody& multibody, double time, MultibodyState& joints) {
  const MovingBase base(multibody);
  if (!base.moves()) return;
  const Twist now = base.twist(time);
  BaseMotion jump;
  base.set(time, jump);
  jump.v = jump.w = Vec3::Zero();
  jump.a = now.v - joints.base.v;
  jump.alpha = now.w - joints.base.w;
  joints.base = now;
  if (jump.a.isZero(0) && jump.alpha.isZero(0)) return;
  const Tree& tree = multibody.tree;
  const std::vector<double> none(joints.u.size());
  std::vector<double> du(none);
  Kinematics placed(tree);
  Articulation factors(tree);
  place(tree, joints.q, none, jump, placed);
  if (!forward_dynamics(tree, placed, none, factors, du)) return;
  for (std::size_t k = 0; k < du.size(); ++k) joints.u[k] += du[k];
}

}  // namespace tw
