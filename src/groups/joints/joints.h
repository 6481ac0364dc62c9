// The joints of multibodies at a discontinuity: where they stand, what impulses and stops do to
// them.
//
// A link that is struck moves all others of its multibody: with the slots i, j of its links the
// blocks Y_ij = J_i M^-1 J_j^T join them in the impulse solver, and what they received gives
// du = M^-1 sum J^T impulse.
//
// Source: B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems (1996), section 4.3.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "dynamics/impulse-solver.h"
#include "groups/joints/joint-stops.h"
#include "groups/regroup/regrouping.h"
#include "multibody/impulses.h"
#include "multibody/multibody.h"

namespace tw {

// A multibody's links where its joints are; of a base that moves, at a time.
class PlacedJoints {
 public:
  PlacedJoints(const Multibody& multibody, const MultibodyState& joints, double time);
  PoseTwist link(int link) const;
  const multibody::Kinematics& kinematics() const { return k_; }

 private:
  const Multibody& multibody_;
  multibody::Kinematics k_;
};

// How the arc of a link begins.
void set_motion(const Body& body, const PoseTwist& point, StateData& data);

// At a time on the arc of a link's state.
std::shared_ptr<MultibodyState> joints_at(const State& state, double when);

// Of successors that are links of one multibody the first one's joints become those of all: a copy,
// that of none else.
void share_joints(std::vector<Successor>& successors);

// The links of multibodies whose joints an edit or a callback has changed, where their joints are.
void follow_changed_joints(double time, std::vector<Successor>& successors);

// Joins the slots of links in a solver, then takes what they received.
//
// A stop that carries is a contact of two slots: what is limited, whose velocity is its rate along
// x, against one that is held.
class JointImpulses {
 public:
  JointImpulses(ImpulseSolver& solver, double time) : solver_(solver), time_(time) {}
  // Nothing where the successor is no link; before its multibody's links are joined.
  void add(Successor& successor, std::uint32_t slot);
  // Slots for the stops that the multibodies lean on, and their contacts.
  std::vector<ImpulseContact> add_stops();
  // Those that are not yet joined.
  void join();
  bool has_joined(const Multibody& multibody) const;
  void take();

 private:
  struct Struck {
    const Multibody* multibody;
    std::shared_ptr<MultibodyState> joints;
    std::vector<std::pair<int, std::uint32_t>> links;          // and their slots
    std::vector<std::pair<LeaningStop, std::uint32_t>> stops;  // and theirs
    bool joined = false;
    std::shared_ptr<PlacedJoints> placed;
    std::shared_ptr<multibody::Articulation> factors;
  };
  ImpulseSolver& solver_;
  double time_;
  std::vector<Struck> struck_;
};

// What the base's jumps do, then stops, then the links where their joints are: for new arcs.
void settle_joints(const Regrouping& work);

}  // namespace tw
