// The joints of multibodies at a discontinuity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/joints/joints.h"

#include <algorithm>

#include "base/error.h"
#include "integrate/arc/joint-record.h"
#include "integrate/given/moving-base.h"
#include "multibody/limits.h"

namespace tw {

using namespace multibody;

PlacedJoints::PlacedJoints(const Multibody& multibody, const MultibodyState& joints, double time)
    : multibody_(multibody), k_(multibody.tree) {
  // gravity and accelerations of the base don't enter places and velocities
  multibody::BaseMotion around;
  MovingBase(multibody).set(time, around);
  around.v = joints.base.v, around.w = joints.base.w;
  place(multibody.tree, joints.q, joints.u, around, k_);
}

PoseTwist PlacedJoints::link(int link) const { return link_point(multibody_, k_, link); }

void set_motion(const Body& body, const PoseTwist& point, StateData& data) {
  data.x = point.x;
  data.q = point.q;
  data.v = point.v;
  data.L = angular_momentum(body, point.q, point.w);
}

std::shared_ptr<MultibodyState> joints_at(const State& state, double when) {
  auto joints = std::make_shared<MultibodyState>(*state.joints);
  if (!state.group || state.group->at_rest) return joints;
  const GroupArc& arc = *state.group->arc;
  const int tree = arc.start().members[state.member].tree;
  arc.joints(tree, when, joints->q, joints->u);
  const MovingBase base(*arc.start().trees[static_cast<std::size_t>(tree)].multibody);
  if (base.moves() && arc.start().time < when) joints->base = base.twist_before(when);
  return joints;
}

void share_joints(std::vector<Successor>& successors) {
  std::vector<std::pair<const Multibody*, std::shared_ptr<MultibodyState>>> known;
  for (Successor& successor : successors) {
    const Multibody* multibody = successor.body->multibody;
    if (!multibody) continue;
    auto at = std::find_if(known.begin(), known.end(),
                           [&](const auto& entry) { return entry.first == multibody; });
    if (at == known.end())
      at = known.insert(at, {multibody, std::make_shared<MultibodyState>(*successor.joints)});
    successor.joints = at->second;
  }
}

void follow_changed_joints(double time, std::vector<Successor>& successors) {
  for (const Successor& changed : successors) {
    if (!changed.joints_changed) continue;
    const PlacedJoints joints(*changed.body->multibody, *changed.joints, time);
    for (Successor& link : successors) {
      if (link.body->multibody != changed.body->multibody) continue;
      link.point = joints.link(static_cast<int>(link.body->link));
      link.placed = link.placed || changed.placed;
    }
  }
}

void JointImpulses::add(Successor& successor, std::uint32_t slot) {
  const Multibody* multibody = successor.body->multibody;
  if (!multibody) return;
  auto at = std::find_if(struck_.begin(), struck_.end(),
                         [&](const Struck& s) { return s.multibody == multibody; });
  if (at == struck_.end()) {
    Struck struck{multibody,
                  successor.joints,
                  {},
                  {},
                  false,
                  std::make_shared<PlacedJoints>(*multibody, *successor.joints, time_),
                  std::make_shared<Articulation>(multibody->tree)};
    factor(multibody->tree, struck.placed->kinematics(), *struck.factors);
    at = struck_.insert(at, std::move(struck));
  }
  TW_ASSERT(!at->joined, "all links of a multibody are added before they are joined");
  at->links.emplace_back(static_cast<int>(successor.body->link), slot);
}

std::vector<ImpulseContact> JointImpulses::add_stops() {
  std::vector<ImpulseContact> contacts;
  for (Struck& s : struck_) {
    if (s.joined) continue;
    for (const LeaningStop& stop : leaning_stops(*s.multibody, *s.joints)) {
      ImpulseSlot along;
      along.v = limited_rate(*stop.axis, s.joints->q, s.joints->u) * Vec3::UnitX();
      const std::uint32_t held = solver_.add({}), slot = solver_.add(along);
      s.stops.emplace_back(stop, slot);
      ImpulseContact contact;
      contact.a = held, contact.b = slot;
      contact.normal = stop.side * Vec3::UnitX();
      contacts.push_back(contact);
    }
  }
  return contacts;
}

void JointImpulses::join() {
  for (Struck& s : struck_) {
    if (s.joined) continue;
    s.joined = true;
    const Tree& tree = s.multibody->tree;
    const Factored factored{tree, s.placed->kinematics(), *s.factors};
    ImpulseWork work(tree);
    std::vector<double> du(static_cast<std::size_t>(tree.nv())), force(du.size());
    std::vector<Mat6> of_links(s.links.size()), of_stops(s.stops.size());
    // what a unit impulse changed, as this column of all blocks
    const auto take_column = [&](int column) {
      for (std::size_t i = 0; i < s.links.size(); ++i) {
        const auto& [of, of_slot] = s.links[i];
        const Motion& change = work.change[static_cast<std::size_t>(tree.link(of).node)];
        of_links[i].col(column) << change.v + change.w.cross(solver_.slot(of_slot).x -
                                                             s.placed->kinematics().origin),
            change.w;
      }
      for (std::size_t i = 0; i < s.stops.size(); ++i)
        of_stops[i].col(column) =
            limited_rate(*s.stops[i].first.axis, s.joints->q, du) * Vec6::Unit(0);
    };
    const auto join_all = [&](std::uint32_t on) {
      for (std::size_t i = 0; i < s.links.size(); ++i)
        solver_.join(s.links[i].second, on, of_links[i]);
      for (std::size_t i = 0; i < s.stops.size(); ++i)
        solver_.join(s.stops[i].second, on, of_stops[i]);
    };
    for (const auto& [on, on_slot] : s.links) {
      for (int column = 0; column < 6; ++column) {
        LinkImpulse unit{on, solver_.slot(on_slot).x, Vec3::Zero(), Vec3::Zero()};
        (column < 3 ? unit.linear : unit.angular) = Vec3::Unit(column % 3);
        velocity_change(factored, {&unit, 1}, {}, work, du);
        take_column(column);
      }
      join_all(on_slot);
    }
    for (const auto& [stop, on_slot] : s.stops) {
      for (Mat6& block : of_links) block.setZero();
      for (Mat6& block : of_stops) block.setZero();
      set_along_limited(*stop.axis, s.joints->q, 1, force);
      velocity_change(factored, {}, force, work, du);
      take_column(0);
      join_all(on_slot);
    }
  }
}

bool JointImpulses::has_joined(const Multibody& multibody) const {
  return std::any_of(struck_.begin(), struck_.end(),
                     [&](const Struck& s) { return s.multibody == &multibody && s.joined; });
}

void JointImpulses::take() {
  if (struck_.empty()) return;
  const std::vector<Vec6> received = solver_.received();
  for (const Struck& s : struck_) {
    const Tree& tree = s.multibody->tree;
    std::vector<LinkImpulse> impulses;
    for (const auto& [link, slot] : s.links)
      impulses.push_back(
          {link, solver_.slot(slot).x, received[slot].head<3>(), received[slot].tail<3>()});
    ImpulseWork work(tree);
    std::vector<double> du(static_cast<std::size_t>(tree.nv())), along(du.size()), force(du.size());
    for (const auto& [stop, slot] : s.stops) {
      set_along_limited(*stop.axis, s.joints->q, received[slot][0], along);
      for (std::size_t k = 0; k < force.size(); ++k) force[k] += along[k];
    }
    velocity_change({tree, s.placed->kinematics(), *s.factors}, impulses, force, work, du);
    for (std::size_t k = 0; k < du.size(); ++k) s.joints->u[k] += du[k];
  }
}

void settle_joints(const Regrouping& work) {
  const Multibody* placed = nullptr;
  std::unique_ptr<PlacedJoints> joints;
  for (const auto& [process, at] : work.index()) {
    Successor& successor = work.successors[at];
    const Multibody* multibody = successor.body->multibody;
    if (!multibody || !work.changes(&successor)) continue;
    if (multibody != placed) {
      follow_base(*multibody, work.now(), *successor.joints);
      settle_stops(*multibody, work.now(), finds_contacts(work.cause()), *successor.joints);
      joints = std::make_unique<PlacedJoints>(*multibody, *successor.joints, work.now());
    }
    placed = multibody;
    successor.point = joints->link(static_cast<int>(successor.body->link));
    set_motion(*successor.body, successor.point, successor.data);
  }
}

}  // namespace tw
