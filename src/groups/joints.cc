// The joints of multibodies at a discontinuity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/joints.h"

#include <algorithm>

#include "groups/joint-stops.h"
#include "integrate/joint-record.h"
#include "integrate/moving-base.h"

namespace tw {

using namespace multibody;

PlacedJoints::PlacedJoints(const Multibody& multibody, const MultibodyState& joints, double time)
    : multibody_(multibody), k_(multibody.tree) {
  // gravity and accelerations of the base don't enter places and velocities
  multibody::Surroundings around;
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
                  std::make_shared<PlacedJoints>(*multibody, *successor.joints, time_),
                  std::make_shared<Articulation>(multibody->tree)};
    factor(multibody->tree, struck.placed->kinematics(), *struck.factors);
    at = struck_.insert(at, std::move(struck));
  }
  at->links.emplace_back(static_cast<int>(successor.body->link), slot);
}

void JointImpulses::join() {
  for (const Struck& s : struck_) {
    const Tree& tree = s.multibody->tree;
    const Factored factored{tree, s.placed->kinematics(), *s.factors};
    ImpulseWork work(tree);
    std::vector<double> du(static_cast<std::size_t>(tree.nv()));
    for (const auto& [on, on_slot] : s.links) {
      std::vector<Mat6> blocks(s.links.size());
      for (int column = 0; column < 6; ++column) {
        LinkImpulse unit{on, solver_.slot(on_slot).x, Vec3::Zero(), Vec3::Zero()};
        (column < 3 ? unit.linear : unit.angular) = Vec3::Unit(column % 3);
        velocity_change(factored, {&unit, 1}, {}, work, du);
        for (std::size_t i = 0; i < s.links.size(); ++i) {
          const auto& [of, of_slot] = s.links[i];
          const Motion& change = work.change[static_cast<std::size_t>(tree.link(of).node)];
          blocks[i].col(column) << change.v + change.w.cross(solver_.slot(of_slot).x -
                                                             s.placed->kinematics().origin),
              change.w;
        }
      }
      for (std::size_t i = 0; i < s.links.size(); ++i)
        solver_.join(s.links[i].second, on_slot, blocks[i]);
    }
  }
}

void JointImpulses::take() {
  for (const Struck& s : struck_) {
    const Tree& tree = s.multibody->tree;
    std::vector<LinkImpulse> impulses;
    for (const auto& [link, slot] : s.links) {
      const Vec6& received = solver_.received(slot);
      impulses.push_back({link, solver_.slot(slot).x, received.head<3>(), received.tail<3>()});
    }
    ImpulseWork work(tree);
    std::vector<double> du(static_cast<std::size_t>(tree.nv()));
    velocity_change({tree, s.placed->kinematics(), *s.factors}, impulses, {}, work, du);
    for (std::size_t k = 0; k < du.size(); ++k) s.joints->u[k] += du[k];
  }
}

void settle_joints(Regrouping& work) {
  const Multibody* placed = nullptr;
  std::unique_ptr<PlacedJoints> joints;
  for (const auto& [process, at] : work.index()) {
    Successor& successor = work.successors[at];
    const Multibody* multibody = successor.body->multibody;
    if (!multibody || !work.changes(&successor)) continue;
    if (multibody != placed) {
      follow_base(*multibody, work.now(), *successor.joints);
      settle_stops(*multibody, work.now(), finds_contacts(work.cause), *successor.joints);
      joints = std::make_unique<PlacedJoints>(*multibody, *successor.joints, work.now());
    }
    placed = multibody;
    successor.point = joints->link(static_cast<int>(successor.body->link));
    set_motion(*successor.body, successor.point, successor.data);
  }
}

}  // namespace tw
