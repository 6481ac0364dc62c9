// The members of a group's arc at its start, and the tolerances of its steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/start-members.h"

#include <algorithm>
#include <cmath>

#include "groups/regroup/step-tolerances.h"

namespace tw {

void StartOfMembers::add(const Body& body, const PoseTwist& point, const StateData& d,
                         const MultibodyStatePtr& joints) {
  const double extent = body.multibody ? extent_of_link(body) : body.extent();
  start_.members.push_back({body.mass, body.moments, body.shape_P ? body.radius : extent, d.x, d.q,
                            d.v, d.L, body.mass * d.acceleration, Vec3::Zero(),
                            d.forces && d.forces->act_alone() ? d.forces : nullptr});
  if (body.multibody) add_link(body, d, joints);
  if (body.shape_P) {
    size_ = std::min(size_, body.least_width);
    slimness_ = std::min(slimness_,
                         std::sqrt(body.least_width / cube_width(body)) / answer::thin_check_share);
  }
  reach_ += extent;
  speed_ = std::max(speed_, PlacedBody(body, point).surface_speed());
}

void StartOfMembers::add_link(const Body& body, const StateData& d,
                              const MultibodyStatePtr& joints) {
  const auto& multibody = scene_.multibodies[body.multibody->number];
  const int member = static_cast<int>(start_.members.size()) - 1;
  auto tree = std::find_if(start_.trees.begin(), start_.trees.end(),
                           [&](const GroupTree& known) { return known.multibody == multibody; });
  if (tree == start_.trees.end()) {
    const std::size_t links = multibody->links.size();
    tree = start_.trees.insert(tree, {multibody, joints, scene_.options.gravity,
                                      std::vector<int>(links), std::vector<Vec3>(links)});
  }
  tree->members[body.link] = member;
  tree->forces[body.link] = d.force;
  start_.members.back().tree = static_cast<int>(tree - start_.trees.begin());
  start_.members.back().link = static_cast<int>(body.link);
}

void StartOfMembers::set_tolerances() {
  // nothing of it can touch
  if (size_ == never) size_ = reach_;
  const double accuracy = scene_.options.accuracy, gravity = scene_.gravity_scale();
  start_.joint_tolerance = answer::joint_step_share * accuracy;
  start_.joint_size = size_;
  start_.joint_rate = std::sqrt(gravity / reach_);
  // springs alone are followed as closely as single bodies are; a contact or a hold gives way by
  // more
  const bool springs_alone = !start_.bonds.empty() && start_.contacts.empty() &&
                             std::none_of(start_.bonds.begin(), start_.bonds.end(),
                                          [](const GroupBond& tied) { return tied.bond->holds; });
  if (springs_alone) {
    const double share = answer::spring_step_share * accuracy;
    start_.position_tolerance = share * size_;
    start_.velocity_tolerance = share * std::max(std::sqrt(gravity * size_), speed_);
    return;
  }
  const double closeness = group_closeness(accuracy, speed_ / std::sqrt(gravity * size_));
  start_.position_tolerance = closeness * group_position_tolerance(accuracy, size_);
  start_.velocity_tolerance =
      closeness * slimness_ * group_velocity_tolerance(accuracy, size_, gravity);
  // what rolls goes on for ever, and so do its errors
  if (std::any_of(start_.contacts.begin(), start_.contacts.end(),
                  [](const GroupContact& contact) { return rolls(contact.feature); }))
    start_.velocity_tolerance *= answer::closer_rolling;
  // as does what spins about a hold, or flies with joints, where no contact takes anything from it
  const bool flies = std::any_of(start_.trees.begin(), start_.trees.end(), [](const GroupTree& t) {
    return t.multibody->tree.node(multibody::first_node).kind == multibody::NodeKind::floating;
  });
  if (start_.contacts.empty() && (!start_.bonds.empty() || flies))
    start_.velocity_tolerance *= answer::closer_spinning;
}

}  // namespace tw
