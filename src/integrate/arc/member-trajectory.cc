// The trajectory of one member of a contact group.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/member-trajectory.h"

#include <algorithm>
#include <type_traits>

#include "integrate/arc/group-arc.h"
#include "integrate/arc/group-record.h"
#include "integrate/arc/joint-record.h"

namespace tw {

Pose MemberTrajectory::pose(double time) const {
  Pose pose;
  arc_->pose(member_, time, pose.p, pose.q);
  return pose;
}

Vec3 MemberTrajectory::center(double time) const { return arc_->position(member_, time); }

Twist MemberTrajectory::twist(double time) const {
  Twist rates;
  arc_->pose_rates(member_, time, rates.v, rates.w);
  return rates;
}

PoseTwist MemberTrajectory::at(double time) const {
  const GroupSample s = arc_->evaluate(member_, time);
  return {s.x, s.q, s.v, s.w};
}

PoseTwist MemberTrajectory::path_at(double time) const { return arc_->path_at(member_, time); }

MotionBounds MemberTrajectory::bounds(double from, double to) const {
  MotionBounds bounds = arc_->bounds(member_, from, to);
  bounds.valid_until = to < end() ? to : never;
  return bounds;
}

double MemberTrajectory::turn_change_across(const Vec3& n, double from, double to,
                                            const MotionBounds& known) const {
  return arc_->turn_change_across(n, member_, from, to, known);
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

// `Record` answers for `part` of it: a member, or a link.
template <class Record>
class Excerpt final : public Trajectory {
 public:
  Excerpt(Record record, int part, const PoseTwist& start)
      : record_(std::move(record)), part_(part), start_(start) {}
  Pose pose(double time) const override { return record_.pose(part_, at_most(time)); }
  Twist twist(double time) const override {
    if (!has_steps()) return {start_.v, start_.w};
    return record_.rates(part_, at_most(time));
  }
  PoseTwist path_at(double time) const override {
    if constexpr (std::is_same_v<Record, GroupRecord>)
      if (has_steps()) return record_.path_at(part_, at_most(time));
    return joined(time);
  }
  MotionBounds bounds(double from, double to) const override {
    if (!has_steps()) return standing_bounds(start_.x, start_.v, start_.w);
    const double end = at_most(to);
    MotionBounds bounds = record_.bounds(part_, std::min(at_most(from), end), end);
    bounds.valid_until = to;
    return bounds;
  }
  bool stepped() const override { return true; }

 private:
  bool has_steps() const { return record_.start() < record_.reached(); }
  double at_most(double time) const { return std::clamp(time, record_.start(), record_.reached()); }

  Record record_;
  int part_;
  PoseTwist start_;
};

}  // namespace

TrajectoryPtr make_excerpt(GroupRecord record, const PoseTwist& start) {
  return std::make_shared<Excerpt<GroupRecord>>(std::move(record), 0, start);
}

TrajectoryPtr make_excerpt(JointRecord record, int link, const PoseTwist& start) {
  return std::make_shared<Excerpt<JointRecord>>(std::move(record), link, start);
}

}  // namespace tw
