// The trajectory of one member of a contact group: the group's arc, seen from one of its bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/trajectory.h"

namespace tw {

class GroupArc;
class GroupRecord;
class JointRecord;

// Part of its GroupArc, which a pointer to it keeps alive (member_trajectory).
class MemberTrajectory final : public Trajectory {
 public:
  MemberTrajectory(const GroupArc& arc, int member) : arc_(&arc), member_(member) {}
  Pose pose(double time) const override;
  Vec3 center(double time) const override;
  Twist twist(double time) const override;
  PoseTwist at(double time) const override;
  PoseTwist path_at(double time) const override;
  MotionBounds bounds(double from, double to) const override;
  double turn_change_across(const Vec3& n, double from, double to,
                            const MotionBounds& known) const override;
  double end() const override;
  double step_end(double time) const override;
  bool stepped() const override { return true; }
  Effort effort() const override;

 private:
  const GroupArc* arc_;
  int member_;
};

TrajectoryPtr member_trajectory(const std::shared_ptr<const GroupArc>& arc, int member);

// A copy of what a member does over a stretch, with the same bits; it keeps nothing else of the
// arc.  Beyond the stretch it stands.  `start`: where it stands if the record has no step.
// Its motion is the path itself, so that contacts see what moves them.
TrajectoryPtr make_excerpt(GroupRecord record, const PoseTwist& start);
// The same of a link.
TrajectoryPtr make_excerpt(JointRecord record, int link, const PoseTwist& start);

// Bounds of an arc that stands at its start.
MotionBounds standing_bounds(const Vec3& x, const Vec3& v, const Vec3& w);

}  // namespace tw
