// The world: what scenes fill and runs advance.  The public face of the kernel.
//
// Frames and units: world frame, SI, radians, z up.  Everything a user gets wrong raises UserError.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "dynamics/contact-parameters.h"
#include "geometry/shape.h"
#include "integrate/trajectory.h"
#include "kernel/callback.h"
#include "kernel/statistics.h"
#include "timeline/key.h"

namespace tw {

class Kernel;
struct Checkpoint;

// How a body comes into the world.  Absent mass properties come from shape and density.
struct BodyDef {
  std::string name;                     // empty: body-N with N the body's id
  ShapePtr shape;                       // null: touches nothing; then mass and inertia are needed
  std::optional<double> density;        // kg/m^3, default 1000
  std::optional<double> mass;           // kg; scales the shape's inertia
  std::optional<Mat3> inertia;          // kg m^2 about the centre of mass, body axes
  std::optional<Vec3> center_of_mass;   // body frame, m
  Vec3 position = Vec3::Zero();         // of the body frame's origin
  Quat orientation = Quat::Identity();  // normalised here; zero is an error
  Vec3 velocity = Vec3::Zero();         // of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();
  bool fixed = false;
  TrajectoryPtr motion;  // makes the body kinematic; excludes `fixed`
  std::string material;
  SlotsPtr slots;             // null: no slots
  std::optional<Vec3> color;  // sRGB 0..1
  bool visible = true;
  Place place;  // of the form that made it
};

// Test modes of the scheduler (kernel.md): the committed history must not depend on them.
struct AdversaryOptions {
  std::uint64_t seed = 0;
  double head_start = 0;     // s: events are taken as if up to this much earlier
  double body_share = 0.3;   // share of bodies with a head start of their own
  bool every_event = false;  // every event draws a fresh head start
  bool some_bodies = true;
};

struct WorldOptions {
  Vec3 gravity{0, 0, -9.81};
  double accuracy = 1e-6;
  std::uint64_t seed = 0;
  bool hash = false;              // accumulate the hash of the committed history
  bool check = false;             // run every validator after every event
  bool undo_redo = false;         // test mode: undo every discontinuity and redo it
  long gvt_interval = 0;          // events between computations of GVT; 0: automatic
  double window_cells = 0.7;      // claimed window, in cells of travel
  double group_check_rate = 480;  // Hz, the finest
  std::optional<AdversaryOptions> adversary;
};

struct CallbackDef {
  std::vector<BodyId> targets;
  std::shared_ptr<Callback> callback;
  double start = 0;
  std::optional<double> period;  // absent: the callback returns its next time
  std::string name;              // for messages
  Place place;
};

struct CollisionCallbackDef {
  ContactSide a, b;
  std::shared_ptr<CollisionCallback> callback;
  std::string name;
  Place place;
};

enum class RunStatus {
  finished,   // everything up to and including `until` is committed and observed
  slice_over  // the slice's time is up; call again
};

// One state kept in a body's queue, for the curious.
struct QueuedState {
  Key key;
  bool committed = false;
  BodyState state;
};

// A contact of a group at one instant.
struct ContactReading {
  BodyId body1 = 0, body2 = 0;   // body1 < body2
  Vec3 point = Vec3::Zero();     // where the force acts, world, m
  Vec3 normal = Vec3::UnitZ();   // unit, world, from body1 to body2
  double gap = 0;                // m; negative: depth
  double force = 0;              // N, on body2 along the normal, >= 0; 0: not in touch just now
  Vec3 friction = Vec3::Zero();  // N, on body2, world
  bool slipping = false;         // in touch, with the friction at its limit
};

struct ContactSurvey {
  std::vector<ContactReading> contacts;  // by pair of bodies, then in the group's own order
  std::size_t groups = 0;
  std::size_t bodies_at_rest = 0;
};

class World {
 public:
  World();
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // ---- settings; most only before the first run ----
  const WorldOptions& options() const;
  void set_gravity(const Vec3& gravity);  // from now on
  void set_accuracy(double accuracy);     // before the first run
  void set_seed(std::uint64_t seed);      // before the first run
  void set_hash(bool on);                 // before the first run
  void set_check(bool on);
  void set_undo_redo(bool on);
  void set_gvt_interval(long events);
  void set_window_cells(double cells);
  void set_group_check_rate(double rate);                         // before the first run
  void set_adversary(std::optional<AdversaryOptions> adversary);  // before the first run
  // "timewarp" is the only policy so far; others raise UserError.
  void set_policy(const std::string& policy);

  // ---- bodies ----
  BodyId add_body(const BodyDef& def);  // born at time()
  // Between runs: it touches nothing from now on, what lay on it falls, callbacks that have it
  // among their targets end. Its number is not given again, its name may be.  Errors: it was
  // removed before.
  void remove_body(BodyId id);
  std::size_t body_count() const;  // removed ones, too
  std::uint64_t removals() const;  // how many were removed
  const BodyInfo& body(BodyId id) const;
  std::optional<BodyId> find_body(const std::string& name) const;

  void set_contact(const ContactSide& a, const ContactSide& b, const ContactSettings& settings);
  ContactParameters contact_parameters(BodyId a, BodyId b) const;

  // ---- callbacks and observers ----
  // Number of the callback, counted from 0 in order of registration.
  std::uint64_t add_callback(const CallbackDef& def);
  void add_collision_callback(const CollisionCallbackDef& def);
  // Called at commit, once each, in time order, for what is of this kind.
  void add_collision_observer(CollisionObserver observer,
                              CollisionKind kind = CollisionKind::collision);
  // fps > 0.  Several sinks with different rates are served in time order.  Frames before time()
  // are not delivered again.
  void add_frame_sink(std::shared_ptr<FrameSink> sink, double fps);
  // Removes a sink added before.
  void remove_frame_sink(const FrameSink* sink);

  // ---- running ----
  double time() const;  // last committed time
  // Advances towards `until` for at most `slice` seconds of wall time (infinite: to the end).
  // Raises what a callback raised, once it is final, and UserError; the world stays usable, at its
  // last committed time.  Interrupted passes through.
  RunStatus advance(double until, double slice = never);
  // Processes one event; false if there is none before `until`.
  bool step(double until = never);
  // Before the run and after it nobody is inside the kernel; during an advance this is true.
  bool running() const;

  // ---- looking and changing between runs ----
  BodyState state(BodyId id) const;  // at time()
  double kinetic_energy(BodyId id) const;
  Vec3 applied_force(BodyId id) const;
  SlotsPtr slots(BodyId id) const;
  // A discontinuity of kind `edit` at time(): `change` gets a view of the body.
  void edit(BodyId id, const std::function<void(StateView&)>& change);
  // The committed present, to come back to; delivers first what an interrupt or an observer's error
  // has left. Bodies and callbacks must be the same at restore.  Frames go on where they stood.
  std::shared_ptr<const Checkpoint> checkpoint();
  void restore(const Checkpoint& checkpoint);
  std::vector<QueuedState> state_queue(BodyId id) const;
  double total_energy() const;  // kinetic, gravity, contact springs, J, at time()
  // Contacts of all groups.  `when`: time(), or the time of the frame that a sink is being handed.
  ContactSurvey survey_contacts(double when) const;
  Vec3 total_momentum() const;  // linear, kg m/s, dynamic bodies, at time()
  // SHA-256, 64 hexadecimal digits, of the committed history and of every body's state at time().
  // Needs set_hash(true) before the first run.
  std::string history_hash() const;
  StatisticsTable statistics() const;

  // Opaque: for the kernel's own tests and benchmarks.
  Kernel& kernel() { return *kernel_; }

 private:
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace tw
