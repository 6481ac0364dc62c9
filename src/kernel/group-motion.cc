// Motion of a member of a group, as another group's integrator sees it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/group-motion.h"

namespace tw {
namespace {

class GroupMotion final : public Motion {
 public:
  GroupMotion(std::shared_ptr<Group> group, int member)
      : group_(std::move(group)), member_(member) {
    group_->arc->extend(group_->next_check);
  }
  Pose pose(double time) const override {
    Pose pose;
    group_->arc->pose(member_, time, pose.p, pose.q);
    return pose;
  }
  // of the path itself, so that contacts see what moves them
  void velocity(double time, Vec3& v, Vec3& w) const override {
    group_->arc->pose_rates(member_, time, v, w);
  }
  double speed_bound(double from, double to) const override {
    Vec3 v, w;
    group_->arc->pose_rates(member_, from, v, w);
    const Aabb bend = group_->arc->bounds(member_, from, to).acceleration;
    return v.norm() + bend.lo.cwiseAbs().cwiseMax(bend.hi.cwiseAbs()).norm() * (to - from);
  }
  double angular_speed_bound(double from, double to) const override {
    return group_->arc->bounds(member_, from, to).turn;
  }
  Aabb path_bounds(double from, double to) const override {
    return group_->arc->bounds(member_, from, to).path;
  }

 private:
  std::shared_ptr<Group> group_;
  int member_;
};

}  // namespace

MotionPtr make_group_motion(std::shared_ptr<Group> group, int member) {
  if (group->at_rest) {
    const GroupMember& m = group->arc->start().members[static_cast<std::size_t>(member)];
    return make_fixed_motion({m.x, m.q});
  }
  return std::make_shared<GroupMotion>(std::move(group), member);
}

}  // namespace tw
