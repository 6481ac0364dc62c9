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
#include "dynamics/placed-body.h"
#include "groups/region.h"
#include "groups/regrouping.h"
#include "kernel/checkpoint.h"
#include "kernel/counters.h"
#include "kernel/due.h"
#include "kernel/policy.h"
#include "kernel/state-view.h"
#include "kernel/world.h"
#include "timeline/arc.h"
#include "timeline/event-queue.h"
#include "timeline/process.h"
#include "timeline/state-graph.h"
#include "timeline/successor.h"

namespace tw {

// Checks of pairs that are not predicted exactly happen at multiples of this, s (2^-20).
inline constexpr double check_grid = 0x1p-20;

// Boxes of members of moving groups reach this share of their size farther: a group check finds in
// them whom a member may touch before the next check.
inline constexpr double contact_margin = 0.1;

inline constexpr std::uint32_t no_pair = 0xffffffffu;

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
  const ContactParameters& contact_parameters(BodyId a, BodyId b) const;
  void edit(BodyId id, const std::function<void(StateView&)>& change);
  std::shared_ptr<const Checkpoint> checkpoint();  // checkpoint.cc
  void restore(const Checkpoint& checkpoint);
  void require_between_runs(const char* what) const;
  void require_before_first_run(const char* what) const;

  // ---- kernel.cc ----
  RunStatus advance(double until, double slice);
  bool step(double until);
  void handle(Event event);  // for policies

  // ---- reading ----
  std::uint64_t removals() const { return removals_; }
  PoseTwist point_at(BodyId id, double when) const;
  const State* state_at(BodyId id, double when) const;
  double total_energy(double when) const;
  ContactSurvey survey_contacts(double when) const;  // contacts.cc
  double deepest_contact(double when) const;
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
  // A checksum of every queue (states, order): for undo tests.
  std::uint64_t graph_checksum() const;
  std::uint64_t ring_checksum(const Key& key) const;
  std::uint64_t state_checksum(const State& state) const;

  // ---- data ----
  WorldOptions options;
  std::unique_ptr<Policy> policy = make_policy("timewarp");
  std::vector<std::unique_ptr<Body>> bodies;
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
  ContactTable contacts;
  Counters counters;
  double time = 0;  // last committed time users see
  double gvt = 0;
  bool begun = false;  // the first run has begun
  bool running = false;

  // ---- who owns whom ----
  Process& process(const Body& body) { return processes[number(body.process)]; }
  const Process& process(const Body& body) const { return processes[number(body.process)]; }
  ProcessId process_of(BodyId id) const { return bodies[id]->process; }
  // The body of a process that has one.
  Body& body_of(ProcessId id) const { return *bodies[processes[number(id)].bodies.front()]; }

 private:
  friend class KernelTest;  // tests/rollback: looks and pokes inside

  // ---- setup.cc ----
  void begin_run();
  void require_no_overlap(const Body& a, const Body& b) const;
  void check_overlaps(Body& body);
  void update_contact_classes() const;
  Key edit_key(const std::vector<BodyId>& concerned);
  Key present_key() const;
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
  bool may_collide(const Body& a, const Body& b) const;
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
  void process_impact(std::uint32_t index);
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
  void process_callback(std::uint32_t number);
  void rewind_callback(std::uint32_t number, const Key& key);
  Key first_tick(const CallbackRecord& callback, const Key& key) const;

  // ---- regroup.cc ----
  void collect_old(Regrouping& work) const;
  void carry(Regrouping& work, const PairBefore& old) const;
  // Cuts the drafts into groups and isolated bodies.
  void finish(Regrouping& work);
  std::shared_ptr<Group> make_group(Regrouping& work, const std::vector<BodyId>& members);
  TrajectoryPtr outside_motion(const Regrouping& work, BodyId id) const;
  void start_arc_of(Group& group, Regrouping& work) const;
  void share_stiffness(Regrouping& work) const;
  void share_ground_stiffness(const std::vector<NewContact*>& points, BodyId mover) const;
  void add_report(Regrouping& work) const;
  void count_group(const Group& group);
  std::size_t count_pieces(const Regrouping& work,
                           const std::vector<std::uint64_t>& in_contact) const;
  void count_fissions(Regrouping& work, const std::vector<bool>& held) const;

  // ---- region.cc ----
  const Group* owner_of(const State& a, const State& b) const;
  std::vector<BodyId> remaining(const Group& group, const Key& key) const;
  template <class Visit>
  void visit_contacts(const std::vector<BodyId>& inside, const Key& key, Visit visit) const;
  Region region_of(const Key& key, const std::vector<BodyId>& struck, bool whole) const;
  void add_neighbours(Region& region, const Key& key) const;
  void complete(Region& region, const Key& key, bool whole) const;
  template <class GoesOn>
  std::vector<BodyId> reached_from(const std::vector<BodyId>& ids, const Key& key,
                                   GoesOn goes_on) const;
  std::vector<BodyId> all_asleep(const std::vector<BodyId>& ids, const Key& key) const;
  std::vector<BodyId> hanging_together(BodyId id, const Key& key) const;
  bool disturbed(const Regrouping& work, const std::vector<BodyId>& asleep,
                 std::vector<BodyId>& movers) const;
  bool own_check_before(BodyId id, const Key& key) const;
  bool await(BodyId id, const Key& key);
  bool await(const Region& region, const Key& key);
  double deviation(const Group& group, BodyId id) const;
  std::vector<BodyId> reached_beyond(const Regrouping& work) const;
  void discard(const Regrouping& work);
  std::vector<Successor> make_successors(const Region& region, const Key& key,
                                         const std::vector<Successor>& given) const;
  bool touches_groups(const std::vector<Successor>& successors) const;
  bool regroup(const Key& key, std::vector<Successor>& successors, Cause cause);
  void regroup_edited(const Key& key, std::vector<Successor>& successors);

  // ---- linking.cc ----
  // Links the pair if it touches or may touch before the next check; `must`: in any case.
  bool connect(Regrouping& work, const PlacedBody& a, const PlacedBody& b, double interval,
               bool must);
  bool comes_into_contact(const PlacedBody& a, const PlacedBody& b, bool linked_before,
                          double interval, const ContactConstants& law) const;
  ContactConstants contact_law(const Body& a, const Body& b, double lightest,
                               double heaviest) const;
  NewContact new_contact(const ManifoldPoint& point, const PlacedBody& a, const PlacedBody& b,
                         const ContactConstants& law) const;
  void match_stretches(Regrouping& work, const NewContactPair& pair,
                       const PairBefore& before_it) const;
  bool ghosts(const PlacedBody& a, const PlacedBody& b, double distance) const;
  void preload(Regrouping& work, const NewContactPair& pair, const PlacedBody& a,
               const PlacedBody& b) const;
  void refresh(Regrouping& work, const std::vector<BodyId>& bodies_looked_at, double interval);
  void find_fixed_around(const Body& mover);
  std::vector<SeamNeighbour> around(const Body& body) const;
  PlacedBody placed(const Successor& successor) const;
  PlacedBody placed_outside(const Body& body, double when) const;
  double gravity_magnitude() const;
  double fusion_speed(const Body& a, const Body& b) const;

  // ---- group-check.cc ----
  Key group_check_key(const Group& group, double when) const;
  void schedule_group_check(Body& body);
  void schedule_group_checks(const Group& group);
  std::vector<BodyId> family(const std::shared_ptr<Group>& group, const Key& key) const;
  std::vector<BodyId> early_bodies(const Group& group, double when, const Key& key) const;
  void process_group_check(BodyId id);
  double check_interval(const Regrouping& work, const std::vector<BodyId>& members) const;
  double next_check_time(double birth, double now, double interval) const;
  bool comes_to_rest(Regrouping& work, Group& after, const Group& before) const;
  void note_changes(Regrouping& work) const;
  std::string group_failure(const Group& group) const;

  // ---- calm.cc ----
  Stillness stillness_of(const Successor& successor, const Key& key) const;
  std::vector<bool> sleepers(const Regrouping& work) const;
  std::vector<BodyId> asleep_around(const Regrouping& work) const;

  // ---- kinematic-work.cc ----
  double contact_work(const State& state, double until) const;

  // ---- end-test.cc ----
  void test_group_end(Group& group);
  double early_end(Group& group, const ContactPair& pair);

  // ---- pass-on.cc ----
  std::vector<BodyId> propagate_impulses(Regrouping& work) const;

  // ---- rollback.cc ----
  Successor make_successor(const Body& body, const Key& key, bool new_arc) const;
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

  double cell_ = 1;                    // typical spacing, m
  bool contacts_may_disable_ = false;  // somebody called disable-collisions!
  long events_since_gvt_ = 0;
  double slice_end_ = never;  // wall clock, s
  double until_ = 0;          // end of the present run
  std::vector<BodyId> newborn_;
  std::deque<std::shared_ptr<const Collision>> undelivered_;  // committed, in time order
  std::size_t next_observer_ = 0;                             // who hears next of the first of them
  Due due_;                                                   // frames that may be delivered
  std::uint64_t hash_sum_ = 0, hash_count_ = 0;
  std::uint64_t edits_ = 0, removals_ = 0;
  unsigned long long queries_before_ = distance_queries;  // of other worlds in this thread
  Random adversary_{0};
  mutable std::unordered_map<std::uint64_t, ContactParameters>
      contact_cache_;                            // by contact classes
  mutable std::vector<BodyId> contact_classes_;  // of each body: the first body of its class
  mutable std::unordered_map<std::string, BodyId> contact_class_of_material_;
  mutable unsigned contact_cache_version_ = 0;
  std::unordered_map<std::uint64_t, std::uint64_t> undone_;  // hash of key -> checksum after
  std::vector<ContactPoint> contact_points_;
  std::vector<ManifoldPoint> manifold_points_;
  std::vector<BodyId> candidates_, ground_;
};

// Hash of a state at one instant, as it enters the history's hash.
std::uint64_t state_hash(const Body& body, const Key& key, const PoseTwist& point,
                         const StateData& data);

}  // namespace tw
