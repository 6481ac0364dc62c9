// Steps of a cluster.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/stepped-cluster.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tw {

namespace {

StepBody body_of(const StepMember& member) {
  StepBody body;
  body.shape = member.shape.get();
  body.moves = true;
  body.v = member.v;
  body.w = member.w;
  // a ball's turning moves nothing
  body.radius = member.shape->is_sphere() && member.center == member.shape->part(0).placement().p
                    ? 0
                    : member.radius;
  body.size = member.size;
  return body;
}

StepBody body_of(const StepOutside& outside) {
  StepBody body;
  body.shape = outside.shape.get();
  body.motion = outside.motion.get();
  body.frame = body.ahead = Frame(outside.pose);
  body.x = outside.pose.p;
  if (body.motion) body.radius = body.shape->radius_about_origin();
  return body;
}

std::vector<StepBody> bodies_of(const std::vector<StepMember>& members,
                                const std::vector<StepOutside>& outside) {
  std::vector<StepBody> bodies;
  bodies.reserve(members.size() + outside.size());
  for (const StepMember& member : members) bodies.push_back(body_of(member));
  for (const StepOutside& other : outside) bodies.push_back(body_of(other));
  return bodies;
}

// q turned by the rotation vector, world.
Quat turned(const Quat& q, const Vec3& by) { return (rotation_by(by) * q).normalized(); }

}  // namespace

SteppedCluster::SteppedCluster(std::vector<StepMember> members, std::vector<StepOutside> outside,
                               StepLaws laws, const Vec3& gravity, const StepSettings& settings,
                               double start)
    : members_(std::move(members)),
      outside_(std::move(outside)),
      settings_(settings),
      time_(start),
      bodies_(bodies_of(members_, outside_)),
      attitudes_(members_.size()),
      pairs_(bodies_, static_cast<int>(members_.size()), std::move(laws), gravity, settings.follow),
      sweep_members_(members_.size()),
      touched_(members_.size()),
      levels_(static_cast<std::size_t>(settings.halvings)) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const StepMember& member = members_[i];
    place(i, member.x, member.q);
    inverse_.push_back(member.inertia.inverse());
    const Mat3 lower = member.inertia.llt().matrixL();
    root_.push_back(lower.inverse());  // G^-T
    sweep_members_[i].inverse_root_mass = 1 / std::sqrt(member.mass);
    sweep_members_[i].push = member.force / std::sqrt(member.mass);
  }
}

PoseTwist SteppedCluster::state(int member) const {
  const auto i = static_cast<std::size_t>(member);
  return {bodies_[i].x, attitudes_[i], bodies_[i].v, bodies_[i].w};
}

StepCounts SteppedCluster::counts() const {
  StepCounts counts = pairs_.counts();
  counts.steps = counts_.steps;
  counts.halvings = counts_.halvings;
  return counts;
}

void SteppedCluster::place(std::size_t i, const Vec3& x, const Quat& q) {
  StepBody& body = bodies_[i];
  attitudes_[i] = q;
  body.x = x;
  body.frame.R = q.toRotationMatrix();
  body.frame.p = x - body.frame.R * members_[i].center;
}

// What is driven moves at the mean velocity of the step to come.
void SteppedCluster::drive_outside(double h) {
  for (std::size_t i = members_.size(); i < bodies_.size(); ++i) {
    StepBody& body = bodies_[i];
    if (!body.motion) continue;
    const Pose now = body.motion->pose(time_);
    const Vec3 before = body.x;
    const Mat3 R = body.frame.R;
    body.frame = Frame(now);
    body.x = now.p;
    body.moved += body.x - before;
    body.turned += (body.frame.R - R).norm() * body.radius;
    body.v = (body.motion->pose(time_ + h).p - now.p) / h;
    body.w = body.motion->twist(time_ + 0.5 * h).w;
  }
}

void SteppedCluster::look(double h) {
  if (looked_for_ == h) return;
  drive_outside(h);
  pairs_.look(h);
  worst_ = pairs_.gather(settings_.depth, contacts_);
  looked_for_ = h;
}

void SteppedCluster::solve(double h) {
  const double substep = h / settings_.substeps;
  std::fill(touched_.begin(), touched_.end(), 0);
  for (StepContact& contact : contacts_) {
    if (contact.a >= 0) touched_[static_cast<std::size_t>(contact.a)] = 1;
    touched_[static_cast<std::size_t>(contact.b)] = 1;
    if (impulse_time_ == 0 || impulse_time_ == substep) continue;
    contact.impulse *= substep / impulse_time_;
    contact.tangential *= substep / impulse_time_;
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    SweepMember& member = sweep_members_[i];
    member.turning = root_[i] * bodies_[i].frame.R.transpose();
    member.twist = member.turning * members_[i].torque;
  }
  sweeps_.solve(sweep_members_,
                {h, settings_.step, settings_.substeps, settings_.pushing, settings_.relaxing},
                contacts_);
  impulse_time_ = substep;
}

// Nothing touches it: the parabola; torque-free turning with its angular momentum kept.
void SteppedCluster::fly(std::size_t i, double h) {
  StepBody& body = bodies_[i];
  const StepMember& member = members_[i];
  const Vec3 acceleration = member.force / member.mass;
  const Mat3& R = body.frame.R;
  const Vec3 L = R * (member.inertia * (R.transpose() * body.w)) + 0.5 * h * member.torque;
  const Mat3 half = turned(attitudes_[i], 0.5 * h * body.w).toRotationMatrix();
  const Vec3 turn = h * (half * (inverse_[i] * (half.transpose() * L)));
  const Vec3 step = h * (body.v + 0.5 * h * acceleration);
  body.v += h * acceleration;
  place(i, body.x + step, turned(attitudes_[i], turn));
  const Vec3 at_end = L + 0.5 * h * member.torque;
  body.w = body.frame.R * (inverse_[i] * (body.frame.R.transpose() * at_end));
  body.moved += step;
  body.turned += turn.norm() * body.radius;
}

// It touches something: by what the sweeps found.
void SteppedCluster::slide(std::size_t i, double h) {
  StepBody& body = bodies_[i];
  const StepMember& member = members_[i];
  const SweepMember& scale = sweep_members_[i];
  const Mat3& R = body.frame.R;
  const Mat3 back = scale.turning.transpose();  // R G^-1
  const Vec3 step = h * body.v + scale.inverse_root_mass * sweeps_.shift(i);
  const Vec3 turn = h * body.w + back * sweeps_.turn(i);
  body.v += scale.inverse_root_mass * sweeps_.velocity(i);
  const Vec3 w = body.w + back * sweeps_.turning(i);
  const Vec3 L = R * (member.inertia * (R.transpose() * w));
  place(i, body.x + step, turned(attitudes_[i], turn));
  body.w = body.frame.R * (inverse_[i] * (body.frame.R.transpose() * L));
  body.moved += step;
  body.turned += turn.norm() * body.radius;
}

void SteppedCluster::move(double h) {
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (touched_[i])
      slide(i, h);
    else
      fly(i, h);
  pairs_.keep_impulses(contacts_);
  time_ += h;
  looked_for_ = 0;
}

void SteppedCluster::keep(Level& level) const {
  level.time = time_;
  level.impulse_time = impulse_time_;
  level.members.clear();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const StepBody& body = bodies_[i];
    level.members.push_back({body.x, body.v, body.w, attitudes_[i], body.frame});
  }
  level.contacts = contacts_;
}

// To have gone there and back is motion like any other.
void SteppedCluster::go_back(const Level& level) {
  time_ = level.time;
  impulse_time_ = level.impulse_time;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    StepBody& body = bodies_[i];
    const Kept& kept = level.members[i];
    body.moved += kept.x - body.x;
    body.turned += (kept.frame.R - body.frame.R).norm() * body.radius;
    body.x = kept.x;
    body.v = kept.v;
    body.w = kept.w;
    body.frame = kept.frame;
    attitudes_[i] = kept.q;
  }
  pairs_.take_back();
  pairs_.keep_impulses(level.contacts);
  looked_for_ = 0;
}

void SteppedCluster::step(double h, int level) {
  look(h);
  const bool may_halve = level < settings_.halvings;
  if (may_halve) keep(levels_[static_cast<std::size_t>(level)]);
  solve(h);
  if (may_halve) pairs_.begin_log();
  move(h);
  ++counts_.steps;
  look(h);
  pairs_.end_log();
  if (!may_halve || !(worst_ > settings_.depth)) {
    deepest_ = std::max(deepest_, pairs_.deepest());
    return;
  }
  ++counts_.halvings;
  go_back(levels_[static_cast<std::size_t>(level)]);
  step(0.5 * h, level + 1);
  step(0.5 * h, level + 1);
  looked_for_ = 0;
}

void SteppedCluster::advance() { step(settings_.step, 0); }

}  // namespace tw
