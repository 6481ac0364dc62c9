// The group that the links of a multibody are born in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/birth-group.h"

#include "groups/ends/planned-end.h"
#include "groups/group.h"
#include "groups/joints/joints.h"
#include "groups/regroup/start-members.h"
#include "integrate/arc/member-trajectory.h"

namespace tw {

void make_birth_group(const Scene& scene, const std::shared_ptr<const Multibody>& multibody,
                      const MultibodyStatePtr& joints, std::span<State* const> states) {
  const double now = states.front()->key.time;
  const PlacedJoints placed(*multibody, *joints, now);
  auto group = std::make_shared<Group>();
  group->key = states.front()->key;
  group->planned = plan_birth_end(scene, *multibody, now);
  GroupStart start;
  start.time = now;
  start.end = group->planned.time;
  StartOfMembers members(scene, start);
  for (std::size_t i = 0; i < states.size(); ++i) {
    State& state = *states[i];
    const Body& body = scene.body(multibody->links[i]);
    const PoseTwist point = placed.link(static_cast<int>(i));
    set_motion(body, point, state);
    state.joints = joints;
    members.add(body, point, state, joints);
    group->members.push_back(body.process);
    group->masses.add(body.mass);
  }
  members.set_tolerances();
  group->pair_starts.assign(states.size() + 1, 0);
  group->stillness.resize(states.size());
  group->arc = std::make_shared<GroupArc>(std::move(start));
  for (std::size_t i = 0; i < states.size(); ++i) {
    State& state = *states[i];
    state.group = group;
    state.member = static_cast<std::uint32_t>(i);
    state.follows = member_trajectory(group->arc, static_cast<int>(i));
  }
}

}  // namespace tw
