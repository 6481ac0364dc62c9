// Callbacks of described scenes: what they change turns on a count that is kept in slots, so that a
// call too many, too few or too early shows in the history's hash.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/deeds.h"

#include "support/counter.h"

namespace tw::fuzz {
namespace {

using Targets = std::span<StateView* const>;
using Result = std::optional<double>;

long count_up(StateView& view) {
  const long count = test::counter_of(view.slots()) + 1;
  view.set_slots(test::make_counter(count));
  return count;
}

Result turn(const DescribedCallback&, double, Targets targets) {
  StateView& view = *targets[0];
  if (count_up(view) % 2 && view.draw_random() < 0.5)
    view.set_velocity(test::permuted(view.state().velocity));
  return std::nullopt;
}

Result feel(const DescribedCallback&, double, Targets targets) {
  StateView& view = *targets[0];
  if (view.contacts().empty()) return std::nullopt;
  if (count_up(view) % 2) view.set_angular_velocity(-view.state().angular_velocity);
  return std::nullopt;
}

Result grip(const DescribedCallback& callback, double when, Targets targets) {
  StateView& view = *targets[0];
  count_up(view);
  if (view.attached(*targets[1]))
    view.detach(*targets[1]);
  else
    view.attach(*targets[1], {});
  return when + callback.period * (0.5 + view.draw_random());
}

Result reach(const DescribedCallback& callback, double, Targets targets) {
  StateView& view = *targets[0];
  const long count = count_up(view);
  view.change_joints([&](MultibodyState& joints) {
    joints.torques.resize(joints.u.size());
    const double pushed = joints.u.back() > 0 ? -callback.torque : callback.torque;
    joints.torques.back() = count % 3 ? pushed : 0;
  });
  return std::nullopt;
}

Result lean(const DescribedCallback& callback, double, Targets targets) {
  StateView& view = *targets[0];
  const BodyId other = targets[1]->body();
  const long turn = count_up(view) % 3;
  Vec3 felt = Vec3::Zero();
  if (turn == 1)
    felt = view.pull(other, PullKind::springs).force + view.pull(other, PullKind::holds).force;
  if (turn == 2) felt = view.sensed_motion().proper_acceleration(Vec3::Zero());
  const double length = felt.norm();
  view.set_applied_force(length > 0 ? Vec3(-callback.torque / length * felt) : Vec3::Zero());
  return std::nullopt;
}

Result perform(const DescribedCallback& callback, double when, Targets targets) {
  switch (callback.deed) {
    case Deed::turn: return turn(callback, when, targets);
    case Deed::feel: return feel(callback, when, targets);
    case Deed::grip: return grip(callback, when, targets);
    case Deed::lean: return lean(callback, when, targets);
    case Deed::reach: break;
  }
  return reach(callback, when, targets);
}

}  // namespace

void add_callbacks(World& world, const DescribedScene& scene) {
  if (scene.callbacks.empty()) return;
  CollisionCallbackDef count;
  count.name = "count";
  count.callback = std::make_shared<test::CountCollisions>();
  world.add_collision_callback(count);
  for (const DescribedCallback& callback : scene.callbacks) {
    std::vector<BodyId> targets;
    for (const std::string& name : callback.targets)
      targets.push_back(world.find_body(name).value());
    const std::optional<double> period =
        callback.deed == Deed::grip ? std::nullopt : std::optional(callback.period);
    test::add_callback(
        world, targets, callback.start, period,
        [callback](double when, Targets views) { return perform(callback, when, views); });
  }
}

}  // namespace tw::fuzz
