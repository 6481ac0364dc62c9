// Successors: the states that a discontinuity gives its processes, before they enter the graph.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/impulse-solver.h"
#include "dynamics/placed-body.h"
#include "dynamics/scene.h"
#include "timeline/state.h"

namespace tw {

// What a discontinuity does to one process.
enum class Role : std::uint8_t {
  new_arc,  // starts an arc here: a receiver, or whom the change reaches
  record,   // was looked at, or only its slots changed: carries its arc along
  border,   // a group member that keeps its arc and touches one that doesn't: a record
  no_state  // a fixed body without slots: takes part, but keeps no states
};

struct Successor {
  const Body* body = nullptr;
  Role role = Role::record;
  bool placed = false;  // an edit put it elsewhere: its contacts are gone
  StateData data;
  PoseTwist point;  // at the discontinuity's time
  // Of a link: its multibody's joints then, shared by all successors that are its links; becomes
  // data.joints where new arcs start.
  std::shared_ptr<MultibodyState> joints;
  // Where they are or how fast, by an edit, a callback or impulses: its fellows don't know yet.
  bool joints_changed = false;

  ProcessId process() const { return body->process; }
  bool enters() const { return role != Role::no_state; }
  // Whether a dynamic body starts an arc here.
  bool starts_arc() const { return role == Role::new_arc; }
};

// Starts a new arc at `key` from the successor's point; the group, if there is one, is still the
// old one.
void start_new_arc(Successor& successor, const Key& key);
// Its motion is now what impulses made of it.
void take_velocities(Successor& successor, const ImpulseSlot& after);

// What would move it if nothing touched it, at the discontinuity's time.
Vec3 free_acceleration(const Successor& successor, double now);

// Gives an isolated dynamic body its motion, from how its arc begins: when the state is published.
void let_move(const Scene& scene, const Body& body, StateData& data);
// The same for one on which nothing acts but weight and a constant force.
void let_fly(const Body& body, StateData& data);

}  // namespace tw
