// A state: what a process is at a discontinuity, and the arc that starts there.
//
// The state of a contact group stands in the queues of its members, one state each, closed to a
// ring: so a body's residence is its own last state, and rollback needs nothing but rings
// (doc/architecture.md).
//
// The arc is a function of the state alone: free flight, kept by value, or whatever else a body may
// follow (integrate/trajectory.h).  A *record* (a callback that changed no motion) does
// not start an arc of its own: it carries its predecessor's along, origin and all, so that reading
// a body never moves a bit of its motion.
//
// Frames: x centre of mass, q_WP attitude of the principal frame, v velocity, L angular momentum;
// all in the world frame, at arc_time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <exception>
#include <memory>

#include "dynamics/forces.h"
#include "dynamics/ids.h"
#include "integrate/flight.h"
#include "math/vec.h"
#include "multibody/multibody.h"
#include "timeline/collision.h"
#include "timeline/key.h"
#include "timeline/slots.h"
#include "timeline/tally.h"

namespace tw {

struct Group;

// A run of impacts in quick succession (doc/architecture.md, *Soft impacts*): rolls back with its
// state.
struct ImpactRun {
  std::uint32_t count = 0;
  double last_time = -never;
  BodyId partner = no_body;  // of the last one
  // those of a kinematic body at one instant, the last ones: whose, how many, when, and how fast
  // they approached, m/s
  BodyId wall = 0;
  std::uint32_t strikes = 0;
  double wall_time = -never, wall_speed = 0;
};

// All of a state but its place in the graph.  What every prediction reads stands last, beside the
// keys and links of State: a few cache lines instead of all.
struct StateData {
  // what is copied from state to state
  std::uint64_t random = 0;
  ImpactRun impacts;
  SlotsPtr slots;
  ForcesPtr forces;  // that act beside weight and applied force; null: none

  // what this discontinuity was
  bool changed = true;                   // false: a record that changed nothing
  double next_callback = never;          // callbacks without a period: their next time
  std::shared_ptr<const Report> report;  // what observers will hear (on one state of the ring)
  Tally tally;                           // for statistics (on one state of the ring)
  double squeezed_since = never;         // s; never: it is not squeezed (groups/told/squeezed.h)

  // the contact group that the body is in from here on, and its place there; null: it is isolated
  std::shared_ptr<Group> group;
  std::uint32_t member = 0;
  // of a link: how the joints stand where the arc starts, shared by all links; null: of other
  // bodies
  MultibodyStatePtr joints;

  // how the arc begins
  Vec3 L = Vec3::Zero();  // at arc_time, and so on
  Quat q = Quat::Identity();
  Vec3 force = Vec3::Zero();         // applied, constant along the arc
  Vec3 acceleration = Vec3::Zero();  // gravity + force/mass
  Vec3 v = Vec3::Zero();
  Vec3 x = Vec3::Zero();
  double arc_time = 0;       // origin of the arc, s
  Key arc_key;               // key of the discontinuity that started the arc
  std::exception_ptr error;  // speculative: raised when GVT passes it; stops the process

  // the arc itself, made when the state enters the graph and never changed: what it follows; null:
  // it flies
  TrajectoryPtr follows;
  Flight flight;

  const Trajectory& trajectory() const { return follows ? *follows : flight; }
  // The same answers as of trajectory(), without a virtual call where it flies: a gas asks for
  // little else.
  double arc_end() const { return follows ? follows->end() : never; }
  const Parabola* ballistic() const { return follows ? follows->ballistic() : &flight.path(); }
  // Of a dynamic body: it is isolated and does not fly; what acts on it is integrated.
  bool driven() const { return follows && !group; }
  // Whether to look at it beyond what was claimed may compute more of it.
  bool may_grow() const { return driven() && (follows->stepped() || follows->calls_out()); }
};

struct State : StateData {
  Key key;                    // of the discontinuity that made this state
  ProcessId process{};        // that owns the queue
  std::uint64_t entered = 0;  // its number, in the order in which all entered
  State* prev = nullptr;
  State* next = nullptr;
  State* ring = this;         // circular list of the states of one discontinuity,
  State* ring_before = this;  // and backwards
  bool committed = false;

  bool starts_arc() const { return arc_key == key; }
};

}  // namespace tw
