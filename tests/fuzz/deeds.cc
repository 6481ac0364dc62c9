// Callbacks of described scenes: what they change turns on a count that is kept in slots, so that a
// call too many, too few or too early shows in the history's hash.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/deeds.h"

#include <algorithm>

#include "collision/distance/ray.h"
#include "collision/distance/separation.h"
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

// What targets are made of and where.
struct PlacedShape {
  const Shape& shape;
  Frame frame;
};
PlacedShape placed_in(const World& world, const StateView& view) {
  const BodyState& state = view.state();
  return {*world.body(view.body()).shape, Frame(Pose{state.position, state.orientation})};
}

std::optional<RayHit> first_hit(const World& world, Targets among, const Vec3& from,
                                const Vec3& direction, double most) {
  std::optional<RayHit> nearest;
  for (const StateView* view : among) {
    const PlacedShape at = placed_in(world, *view);
    const auto hit =
        cast_ray(at.shape, at.frame, from, direction, nearest ? nearest->distance : most);
    if (hit && (!nearest || hit->distance < nearest->distance)) nearest = hit;
  }
  return nearest;
}

// As off a wall with this unit normal, where it goes into that.
void turn_away(StateView& view, const Vec3& normal) {
  const Vec3 v = view.state().velocity;
  const double into = v.dot(normal);
  if (into < 0) view.set_velocity(v - 2 * into * normal);
}

void turn_spin_round(StateView& view) { view.set_angular_velocity(-view.state().angular_velocity); }

Result scan(const World& world, const DescribedCallback& callback, Targets targets) {
  StateView& view = *targets[0];
  const BodyState s = view.state();
  const Targets others = targets.subspan(1);
  if (count_up(view) % 2) {
    const double speed = s.velocity.norm();
    const Vec3 way = speed > 0 ? Vec3(s.velocity / speed) : Vec3(-Vec3::UnitZ());
    if (const auto hit = first_hit(world, others, s.position, way, callback.reach))
      turn_away(view, hit->normal);
  } else if (first_hit(world, others, s.position, s.orientation * Vec3::UnitX(), callback.reach)) {
    turn_spin_round(view);
  }
  return std::nullopt;
}

Result mind(const World& world, const DescribedCallback& callback, Targets targets) {
  StateView& view = *targets[0];
  const PlacedShape mine = placed_in(world, view), other = placed_in(world, *targets[1]);
  const Vec3 position = view.state().position;
  count_up(view);
  const Separation near = separation(mine.shape, mine.frame, other.shape, other.frame);
  const Vec3 apart = near.point_a - near.point_b;
  const double length = apart.norm();
  if (near.distance < callback.reach && length > 0) turn_away(view, apart / length);
  const ShapePtr probe = make_sphere(callback.reach);
  const auto touched = std::count_if(targets.begin() + 1, targets.end(), [&](StateView* against) {
    const PlacedShape at = placed_in(world, *against);
    return separation(*probe, Frame(Mat3::Identity(), position), at.shape, at.frame).distance <= 0;
  });
  const bool low = mine.shape.bounds(mine.frame).lo.z() < position.z() - callback.reach;
  if (touched % 2 == 0 || low) turn_spin_round(view);
  return std::nullopt;
}

// The felt, turned against, of this length.
Vec3 against(const Vec3& felt, double length) {
  const double most = felt.norm();
  return most > 0 ? Vec3(-length / most * felt) : Vec3::Zero();
}

Result steady(const DescribedCallback& callback, Targets targets) {
  StateView& view = *targets[0];
  const BodyId other = targets[1]->body();
  const long turn = count_up(view) % 4;
  Vec3 push = Vec3::Zero(), felt = Vec3::Zero();
  if (turn == 1) felt = view.state().angular_velocity;
  if (turn == 3) felt = view.pull(other, PullKind::holds).torque;
  for (const ContactReading& contact : view.contacts()) {
    const double side = contact.body2 == view.body() ? 1 : -1;
    if (turn == 2 && (contact.body1 == other || contact.body2 == other))
      push += side * (contact.force * contact.normal + contact.friction);
    if (turn == 3) felt += side * contact.torque;
  }
  view.set_applied_force(against(push, callback.torque));
  view.set_applied_torque(against(felt, callback.torque * callback.reach));
  return std::nullopt;
}

Result strain(const DescribedCallback& callback, Targets targets) {
  StateView& view = *targets[0];
  const long count = count_up(view);
  const Multibody& multibody = *view.multibody();
  const int last = static_cast<int>(multibody.links.size()) - 1;
  const Wrench load = view.joint_load(last);
  const auto& link = multibody.tree.link(last);
  const double felt = (count % 2 ? load.force : load.torque).sum();
  view.change_joints([&](MultibodyState& joints) {
    joints.torques.resize(joints.u.size());
    joints.torques.back() = felt > 0 ? -callback.torque : callback.torque;
    if (count % 3 || joints.servos.empty() || link.coordinates != 1) return;
    double& target = joints.targets[static_cast<std::size_t>(link.q)];
    target = -target;
  });
  return std::nullopt;
}

Result perform(const World& world, const DescribedCallback& callback, double when,
               Targets targets) {
  switch (callback.deed) {
    case Deed::turn: return turn(callback, when, targets);
    case Deed::feel: return feel(callback, when, targets);
    case Deed::grip: return grip(callback, when, targets);
    case Deed::lean: return lean(callback, when, targets);
    case Deed::scan: return scan(world, callback, targets);
    case Deed::mind: return mind(world, callback, targets);
    case Deed::steady: return steady(callback, targets);
    case Deed::strain: return strain(callback, targets);
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
    test::add_callback(world, targets, callback.start, period,
                       [&world, callback](double when, Targets views) {
                         return perform(world, callback, when, views);
                       });
  }
}

}  // namespace tw::fuzz
