// The world: what scenes fill and runs advance.  The public face of the kernel.
//
// Frames and units: world frame, SI, radians, z up.  Everything a user gets wrong raises UserError.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "dynamics/contact-parameters.h"
#include "dynamics/scene.h"
#include "groups/told/contact-survey.h"
#include "groups/told/sensing.h"
#include "kernel/report/statistics.h"
#include "kernel/world/definitions.h"
#include "kernel/world/options.h"
#include "timeline/key.h"

namespace tw {

class Kernel;
class Policy;
struct Checkpoint;

// Settings that scenes make; absent: as it is.
struct SettingChanges {
  std::optional<Vec3> gravity = {};             // m/s^2
  std::optional<double> accuracy = {};          // this and the others before the first run
  std::optional<std::uint64_t> seed = {};       // and before the first body
  std::optional<double> group_check_rate = {};  // Hz
  std::optional<std::string> policy = {};
  std::optional<bool> push_overlaps = {};  // what overlaps deeply where it is put is pushed apart
};

enum class RunStatus {
  finished,   // everything up to and including `until` is committed and observed
  slice_over  // the slice's time is up; call again
};

// An event that a step has processed, for the curious.
struct StepReport {
  const char* kind = "";  // advance, check, impact, callback or group-check
  double time = 0;        // s
  std::vector<BodyId> bodies;
};

// One state kept in a body's queue, for the curious.
struct QueuedState {
  Key key;
  bool committed = false;
  BodyState state;
};

class World {
 public:
  World();
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // ---- settings; most only before the first run ----
  // All that are given or, where one is refused, none.
  void set(const SettingChanges& changes);
  const WorldOptions& options() const;
  const Vec3& gravity() const;            // m/s^2, at time()
  void set_gravity(const Vec3& gravity);  // from now on
  void set_accuracy(double accuracy);     // before the first run
  void set_seed(std::uint64_t seed);      // before the first run
  void set_hash(bool on);                 // before the first run
  void set_check(bool on);
  void set_undo_redo(bool on);
  void set_write_states(const std::string& file);    // before the first run
  void set_compare_states(const std::string& file);  // before the first run
  void set_gvt_interval(long events);
  // Loops are shared among so many threads; 0: as many as there are cores.  The answer is the same.
  void set_threads(int threads);
  void set_window_cells(double cells);
  void set_group_check_rate(double rate);                         // before the first run
  void set_adversary(std::optional<AdversaryOptions> adversary);  // before the first run
  // "timewarp" is the only policy so far; others raise UserError.
  // "auto", or "rk45": isolated bodies are integrated by Cash and Karp's method, even where their
  // flight has a closed form.  Before there are bodies.
  void set_integrator(const std::string& integrator);
  void set_policy(const std::string& policy);
  void set_policy(std::unique_ptr<Policy> policy);  // one of your own: policy.h

  // ---- bodies ----
  BodyId add_body(const BodyDef& def);  // born at time()
  // Its number.
  std::uint32_t add_multibody(const MultibodyDef& def);
  const Multibody& multibody(std::uint32_t number) const;
  std::optional<std::uint32_t> find_multibody(const std::string& name) const;
  std::size_t multibody_count() const;
  // Of a link; nullopt of other bodies.
  std::optional<std::uint32_t> multibody_of(BodyId id) const;
  // Between runs: it touches nothing from now on, what lay on it falls, callbacks that have it
  // among their targets end. Its number is not given again, its name may be.  Errors: it was
  // removed before.
  void remove_body(BodyId id);
  std::size_t body_count() const;  // removed ones, too
  // Tells the body from all others that this world ever had, also from one that had its number
  // before a restore.
  std::uint64_t serial(BodyId id) const;
  const BodyInfo& body(BodyId id) const;
  std::optional<BodyId> find_body(const std::string& name) const;

  void set_contact(const ContactSide& a, const ContactSide& b, const ContactSettings& settings);
  // The same for several pairs of sides, for all or none.
  void set_contact(std::span<const std::pair<ContactSide, ContactSide>> sides,
                   const ContactSettings& settings);
  // `collide`: whether they do.
  ContactParameters contact_parameters(BodyId a, BodyId b) const;
  // Whether a joint joins them: they collide only by a rule that names both.
  bool joined(BodyId a, BodyId b) const;

  // ---- forces, from time() on, beside those that act already ----
  // -(linear + quadratic |v|) v at the centre of mass, N s/m and N s^2/m^2.
  ForceHandle add_drag(BodyId id, double linear, double quadratic);
  ForceHandle add_spring(const SpringDef& def);
  ForceHandle add_force(BodyId id, std::shared_ptr<ForceProcedure> procedure);
  // Whether it acts at time(); takes it away.  Errors: it does not act; `what` it is.
  bool acts(const ForceHandle& force) const;
  void remove_force(const ForceHandle& force, const std::string& what);

  // Holds the two as they are; lets go of them; whether they are held.  Errors: as of make_hold
  // (kernel/world/bonds.h); what is not held cannot be detached.
  void attach(BodyId a, BodyId b, const HoldDef& def = {});
  void detach(BodyId a, BodyId b);
  bool attached(BodyId a, BodyId b) const;

  // ---- callbacks and observers ----
  // Number of the callback, counted from 0 in order of registration.
  std::uint64_t add_callback(const CallbackDef& def);
  void add_collision_callback(const CollisionCallbackDef& def);
  // Between runs: no more calls from time() on.  Errors: it is not there.
  void remove_callback(const Callback* callback);
  void remove_callback(const CollisionCallback* callback);
  // Called at commit, once each, in time order, for what is of this kind.
  CollisionObserverPtr add_collision_observer(CollisionObserver observer,
                                              CollisionKind kind = CollisionKind::collision,
                                              Watch watch = Watch::outside);
  // Between runs.  Errors: it is not there.
  void remove_observer(const CollisionObserver* observer);
  // fps > 0.  Several sinks with different rates are served in time order.  Frames before time()
  // are not delivered again.
  void add_frame_sink(std::shared_ptr<FrameSink> sink, double fps, Watch watch = Watch::outside);
  // Removes a sink added before; false: there is no such one.
  bool remove_frame_sink(const FrameSink* sink);
  // The rates of those that there are, frames per second.
  std::vector<double> frame_rates() const;
  // Whether they are there.
  bool has(const Callback* callback) const;
  bool has(const CollisionCallback* callback) const;
  bool has(const CollisionObserver* observer) const;
  bool has(const FrameSink* sink) const;

  // ---- running ----
  double time() const;  // last committed time
  // Advances towards `until` for at most `slice` seconds of wall time (infinite: to the end).
  // Raises what a callback raised, once it is final, and UserError; the world stays usable, at its
  // last committed time.  Interrupted passes through.
  RunStatus advance(double until, double slice = never);
  // Processes one event and tells which; nothing if there is none before `until`.
  std::optional<StepReport> step(double until = never);
  // Before the run and after it nobody is inside the kernel; during an advance this is true.
  bool running() const;

  // ---- looking and changing between runs ----
  BodyState state(BodyId id) const;  // at time()
  double kinetic_energy(BodyId id) const;
  MultibodyState joints(std::uint32_t multibody) const;
  Vec3 applied_force(BodyId id) const;
  Vec3 applied_torque(BodyId id) const;
  SlotsPtr slots(BodyId id) const;
  // The same at `when`: time(), or the time of the frame that a sink is being handed, during the
  // call.
  double kinetic_energy(BodyId id, double when) const;
  MultibodyState joints(std::uint32_t multibody, double when) const;
  const Vec3& applied_force(BodyId id, double when) const;
  Vec3 applied_torque(BodyId id, double when) const;
  const SlotsPtr& slots(BodyId id, double when) const;
  bool attached(BodyId a, BodyId b, double when) const;
  // A discontinuity of kind `edit` at time(): `change` gets a view of the body.
  void edit(BodyId id, const std::function<void(StateView&)>& change);
  // The committed present, to come back to; delivers first what an interrupt or an observer's error
  // has left.  Bodies, rules of contact, callbacks and observers of the scene are part of it: what
  // came since is gone after restore, what was removed is back.  Frames go on where they stood.
  std::shared_ptr<const Checkpoint> checkpoint();
  void restore(const Checkpoint& checkpoint);
  std::vector<QueuedState> state_queue(BodyId id) const;
  double total_energy() const;  // kinetic, gravity, contact springs, J, at time()
  // Contacts of all groups.  `when` as above.
  ContactSurvey survey_contacts(double when) const;
  // What sensors on a body read, and its contacts: a dynamic one's as its own motion has them.
  SensedMotion sensed_motion(BodyId id, double when) const;
  std::vector<ContactReading> contacts_of(BodyId id, double when) const;
  // Of a body that is dynamic: what springs or the hold to another do to it.  Of the joint of a
  // link: what passes through it (groups/told/sensing.h).
  Wrench pull(BodyId id, BodyId other, PullKind kind, double when) const;
  Wrench joint_load(std::uint32_t multibody, int link, double when) const;
  Vec3 total_momentum() const;  // linear, kg m/s, dynamic bodies, at time()
  // SHA-256, 64 hexadecimal digits, of the committed history and of every body's state at time().
  // Needs set_hash(true) before the first run.
  std::string history_hash() const;
  StatisticsTable statistics() const;
  std::vector<DearestGroup> dearest_groups() const;

  // Opaque: for the kernel's own tests and benchmarks.
  Kernel& kernel() { return *kernel_; }

 private:
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace tw
