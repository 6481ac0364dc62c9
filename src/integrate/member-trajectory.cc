// The trajectory of one member of a contact group.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/member-trajectory.h"

#include <algorithm>

#include "integrate/group-arc.h"
#include "integrate/group-record.h"

namespace tw {

Pose MemberTrajectory::pose(double time) const {
  Pose pose;
  arc_->pose(member_, time, pose.p, pose.q);
  return pose;
}

Twist MemberTrajectory::twist(double time) const {
  Twist rates;
  arc_->pose_rates(member_, time, rates.v, rates.w);
  return rates;
}

PoseTwist MemberTrajectory::at(double time) const {
  const GroupSample s = arc_->evaluate(member_, time);
  return {s.x, s.q, s.v, s.w};
}

MotionBounds MemberTrajectory::bounds(double from, double to) const {
  MotionBounds bounds = arc_->bounds(member_, from, to);
  bounds.valid_until = to < end() ? to : never;
  return bounds;
}

double MemberTrajectory::end() const { return arc_->end(member_); }

double MemberTrajectory::step_end(double time) const {
  const double step_end = arc_->step_end(time);
  return step_end < end() ? step_end : never;
}

Effort MemberTrajectory::effort() const {
  Effort effort;
  effort.length = arc_->reached() - arc_->start().time;
  if (member_ > 0) return effort;
  const GroupCounts counts = arc_->counts();
  effort.steps = counts.steps;
  effort.rejected = counts.rejected;
  effort.factorizations = counts.factorizations;
  effort.evaluations = counts.evaluations;
  effort.implicit = true;
  return effort;
}

TrajectoryPtr member_trajectory(const std::shared_ptr<const GroupArc>& arc, int member) {
  return {arc, &arc->trajectory(member)};
}

MotionBounds standing_bounds(const Vec3& x, const Vec3& v, const Vec3& w) {
  MotionBounds bounds;
  bounds.path.add(x);
  bounds.speed = v.norm();
  bounds.turn = w.norm();
  bounds.acceleration.add(Vec3(Vec3::Zero()));
  return bounds;
}

namespace {

class Excerpt final : public Trajectory {
 public:
  Excerpt(GroupRecord record, const PoseTwist& start) : record_(std::move(record)), start_(start) {}
  Pose pose(double time) const override {
    const double t = at_most(time);
    return {record_.position(0, t), record_.attitude(0, t)};
  }
  Twist twist(double time) const override {
    if (record_.steps() == 0) return {start_.v, start_.w};
    Twist rates;
    record_.pose_rates(0, at_most(time), rates.v, rates.w);
    return rates;
  }
  MotionBounds bounds(double from, double to) const override {
    if (record_.steps() == 0) return standing_bounds(start_.x, start_.v, start_.w);
    const double end = at_most(to);
    MotionBounds bounds = record_.bounds(0, std::min(at_most(from), end), end);
    bounds.valid_until = to;
    return bounds;
  }
  bool stepped() const override { return true; }

 private:
  double at_most(double time) const { return std::clamp(time, record_.start(), record_.reached()); }

  GroupRecord record_;
  PoseTwist start_;
};

}  // namespace

TrajectoryPtr make_excerpt(GroupRecord record, const PoseTwist& start) {
  return std::make_shared<Excerpt>(std::move(record), start);
}

}  // namespace tw
