// The kernel: bodies, the state graph, events and the main loop; what World is the face of.
//
// One event at a time is taken from the queue and processed:
//   advance    claims the next window of a body: extends its swept box, finds new active pairs
//   pair       moves the safe time of an active pair up, finds its impact, or carries it out
//   callback   calls a user's procedure with views of its targets
//   group check  refreshes the contacts of a group, finds its fissions and whether it rests
// Redraws and observers need no events: they are served at commit (commit.cc).
//
// The subject is spread over files by what it does: claim.cc, check.cc, impact.cc, callbacks.cc,
// rollback.cc, commit.cc, validate.cc, setup.cc, kernel.cc (the loop); groups: region.cc,
// regroup.cc, linking.cc, group-check.cc, calm.cc, end-test.cc, pass-on.cc.
//
// Invariants (always on): keys in a queue increase; GVT never falls; nothing with a key before GVT
// is touched; a committed state is never removed.  Under --check also the validators of
// validate.cc.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/limits.h"
#include "base/random.h"
#include "collision/broad-phase.h"
#include "collision/manifold.h"
#include "detect/active-pair.h"
#include "detect/piece.h"
#include "dynamics/body.h"
#include "groups/regroup.h"
#include "groups/surroundings.h"
#include "kernel/checkpoint.h"
#include "kernel/policy.h"
#include "kernel/present.h"
#include "kernel/state-image.h"
#include "kernel/state-view.h"
#include "kernel/world.h"
#include "timeline/arc.h"
#include "timeline/event-queue.h"
#include "timeline/process.h"
#include "timeline/state-graph.h"
#include "timeline/successor.h"

namespace tw {

inline constexpr std::uint32_t no_pair = 0xffffffffu;

// What became of an event.
enum class [[nodiscard]] Progress{
    done,
    try_again  // something else may come first: nothing was done, the event stays and is taken
               // again
};

struct CallbackRecord {
  CallbackDef def;
  Key next;                       // of the next call; time `never`: none
  double committed_next = never;  // without a period: next time after the last committed call
  EventQueue::Handle event = EventQueue::none;
  double head_start = 0;
  bool parked = false;  // a target has stopped
  bool ended = false;   // a target was removed
};

struct SinkRecord {
  std::shared_ptr<FrameSink> sink;
  double fps = 30;
  long next_frame = 0;

  double next_time() const { return static_cast<double>(next_frame) / fps; }
};

struct ObserverRecord {
  CollisionObserver observer;
  CollisionKind kind = CollisionKind::collision;
};

class Kernel {
 public:
  Kernel();

  // ---- setup.cc ----
  BodyId add_body(const BodyDef& def);
  void remove_body(BodyId id);  // remove.cc
  void set_contact(const ContactSide& a, const ContactSide& b, const ContactSettings& settings);
  std::uint64_t add_callback(const CallbackDef& def);
  void add_collision_callback(const CollisionCallbackDef& def);
  void add_collision_observer(CollisionObserver observer, CollisionKind kind);
  void add_frame_sink(std::shared_ptr<FrameSink> sink, double fps);
  void remove_frame_sink(const FrameSink* sink);
  void set_gravity(const Vec3& gravity);
  void edit(BodyId id, const std::function<void(StateView&)>& change);
  std::shared_ptr<const Checkpoint> checkpoint();  // checkpoint.cc
  void restore(const Checkpoint& checkpoint);
  void require_between_runs(const char* what) const;
  void require_before_first_run(const char* what) const;

  // ---- kernel.cc ----
  RunStatus advance(double until, double slice);
  bool step(double until);
  void process_next();  // the event that the policy chooses

  // ---- reading ----
  PoseTwist point_at(BodyId id, double when) const;
  const State* state_at(BodyId id, double when) const;
  double total_energy(double when) const;
  ContactSurvey survey_contacts(double when) const;
  // The state of each body that holds at the instant.
  StateOf states_at(double when) const;
  Vec3 total_momentum(double when) const;
  std::string history_hash() const;
  StatisticsTable statistics() const;
  std::vector<QueuedState> state_queue(BodyId id) const;

  // ---- validate.cc: empty, or the first invariant that does not hold ----
  std::string validate_state_graph() const;
  std::string validate_event_queue() const;
  std::string validate_pairs() const;
  std::string validate_residences() const;
  std::string validate_claims() const;
  void validate_all() const;  // aborts with the message

  // ---- data ----
  WorldOptions options;
  Present present;
  std::unique_ptr<Policy> policy = make_policy("timewarp");
  Scene scene{present.settings};
  std::vector<Process> processes;  // by number
  std::unordered_map<std::string, BodyId> names;
  StateGraph graph;
  EventQueue queue;
  BroadPhase grid;
  std::vector<BodyId> unbounded;  // bodies that no box holds: every claim tests them
  std::vector<BodyId> kinematic;  // bodies that move by a given function of time
  std::vector<Pair> pairs;
  std::vector<std::uint32_t> unused_pairs;
  std::vector<CallbackRecord> callbacks;
  std::vector<CollisionCallbackDef> collision_callbacks;
  std::vector<ObserverRecord> observers;
  std::vector<SinkRecord> sinks;
  std::uint64_t live_pairs_ = 0;
  bool running = false;

  // ---- who owns whom ----
  Process& process(const Body& body) { return processes[number(body.process)]; }
  const Process& process(const Body& body) const { return processes[number(body.process)]; }
  ProcessId process_of(BodyId id) const { return scene.process_of(id); }
  // The body of a process that has one.
  Body& body_of(ProcessId id) const { return *scene.bodies[scene.first_bodies[number(id)]]; }

 private:
  friend class KernelTest;  // tests/rollback: looks and pokes inside

  // ---- setup.cc ----
  void begin_run();
  void require_no_overlap(const Body& a, const Body& b) const;
  void check_overlaps(Body& body);
  Key edit_key(const std::vector<ProcessId>& concerned);
  void edit_together(const std::function<bool(BodyId)>& concerned,
                     const std::function<void(Successor&)>& change);
  void resolve_shape(Body& body, const BodyDef& def);
  void make_birth(Body& body, const BodyDef& def);
  void validate_body_def(const BodyDef& def, const std::string& name) const;
  void restart_future();  // forget everything after `time`
  void renew_groups();    // their contacts take what was set since, and wake
  void retry_errors();
  void update_cell();

  // ---- kernel.cc ----
  Event make_event(const Key& key, EventKind kind, std::uint32_t subject, double head_start);
  bool gvt_is_due() const;
  bool finished();
  void deliver_rest();  // what is committed, all of it

  // ---- claim.cc ----
  void schedule_advance(Body& body);
  void claim_window(Body& body);
  double window_end(const Body& body) const;
  Aabb claimed_box(const Body& body, double end) const;
  void find_partners(Body& body, const Key& claimed_before);
  void meet(Body& body, Body& other, const Key& claimed_before);
  void drop_parted_pairs(Body& body);
  bool boxes_overlap(const Body& a, const Body& b) const;
  bool ready(const Body& body, const Key& key) const;
  void make_ready(Body& body, const Key& key);

  // ---- check.cc ----
  std::uint32_t find_pair(const Body& a, const Body& b) const;
  std::uint32_t make_pair(Body& a, Body& b, const Key& from);
  void drop_pair(std::uint32_t index);
  Piece piece_at(BodyId a, BodyId b, const Key& from) const;
  Key impact_key(const Piece& piece, double impact_time) const;
  std::optional<Key> first_exact_impact(const Body& a, const Body& b, const Key& from,
                                        bool& all_exact) const;
  void pursue(std::uint32_t index);
  bool pursue_exact(std::uint32_t index, const Piece& piece);
  bool pursue_on_grid(std::uint32_t index, const Piece& piece, double until);
  bool check_common_start(Pair& pair, const Piece& piece);
  bool check_grid_point(Pair& pair, const Piece& piece, double when);
  void raise_safe_time(Pair& pair, const Piece& piece, double checked) const;
  void set_pending(std::uint32_t index, const Key& key);
  void schedule_pair(std::uint32_t index, double when);
  void reset_pair(std::uint32_t index, const Key& key);
  // Whether the pair is in contact within one group on this piece.
  bool in_contact(const Piece& piece) const;
  bool in_contact_from(BodyId a, BodyId b, const Key& from) const;
  bool next_piece(Pair& pair, const Piece& piece);

  // ---- impact.cc ----
  Progress process_impact(std::uint32_t index);
  // True: the impact is soft, and the two stay in contact.
  bool compute_impact(const Key& key, Successor& a, Successor& b,
                      std::optional<Collision>& collision);
  void find_impact_points(const Successor& a, const Successor& b);
  bool drop_ghosts(const Successor& a, const Successor& b);
  bool is_soft(const Key& key, Successor& a, Successor& b, double fastest) const;
  void run_collision_callbacks(const Collision& collision, Successor& a, Successor& b);
  bool wants_collision(const Body& a, const Body& b) const;
  bool observed(CollisionKind kind) const;

  // ---- callbacks.cc ----
  void schedule_callback(std::uint32_t number);
  Progress process_callback(std::uint32_t number);
  void rewind_callback(std::uint32_t number, const Key& key);
  Key first_tick(const CallbackRecord& callback, const Key& key) const;

  // ---- group-events.cc ----
  // What stands before a key, and who is near: what groups are decided by.
  Before before(const Key& key) const { return Before(scene, graph, key); }
  bool own_check_before(ProcessId id, const Key& key) const;
  bool claims_reach(ProcessId id, const Key& key) const;
  bool known(ProcessId id, const Key& key) const;
  bool await(ProcessId id, const Key& key);
  bool await(const Region& region, const Key& key);
  Progress regroup(const Key& key, std::vector<Successor>& successors, Cause cause);
  void regroup_edited(const Key& key, std::vector<Successor>& successors);
  void schedule_group_check(ProcessId id);
  void test_group_end(Group& group);
  Progress check_group(ProcessId id);

  // ---- rollback.cc ----
  void enter_discontinuity(const Key& key, std::vector<Successor>& successors);
  void treat(const std::vector<Affected>& affected);
  void stop_group_mates(const Key& key, std::vector<Successor>& successors) const;
  void append_successors(const Key& key, std::vector<Successor>& successors);
  void check_finite(Successor& successor) const;
  void note_removed(State& state);
  StateGraph::OnRelease removal();
  StateGraph::OnRelease release();
  void undo_and_check(const Key& key, std::uint64_t checksum_before);

  // ---- commit.cc ----
  double compute_gvt() const;
  void update_gvt();
  void commit(double limit, bool inclusive);
  void commit_states(double limit, bool inclusive);
  void commit_state(State& state);
  bool delivery_is_worth_it() const;
  // Until nothing is due (true) or the wall clock passes `wall_end`.
  bool deliver(double wall_end);
  void deliver_frame(SinkRecord& sink);
  void free_states(double limit);
  std::exception_ptr error_before(double& limit, bool& inclusive) const;

  double kinematic_work_of(const State& state, double until) const;

  Surroundings surroundings_{scene, grid, unbounded};
  double cell_ = 1;  // typical spacing, m
  long events_since_gvt_ = 0;
  double slice_end_ = never;  // wall clock, s
  double until_ = 0;          // end of the present run
  std::vector<BodyId> newborn_;
  std::deque<std::shared_ptr<const Collision>> undelivered_;  // committed, in time order
  std::size_t next_observer_ = 0;                             // who hears next of the first of them
  unsigned long long queries_before_ = distance_queries;      // of other worlds in this thread
  Random adversary_{0};
  // --undo-redo: what was taken back and not found again yet, by what it followed
  struct Undone {
    double time;
    StateImage image;
  };
  std::unordered_map<std::uint64_t, Undone> undone_;
  std::vector<ContactPoint> contact_points_;
};

// Hash of a state at one instant, as it enters the history's hash.
std::uint64_t state_hash(const Body& body, const Key& key, const PoseTwist& point,
                         const StateData& data);

}  // namespace tw
