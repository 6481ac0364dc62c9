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
#include "kernel/arc.h"
#include "kernel/body.h"
#include "kernel/checkpoint.h"
#include "kernel/counters.h"
#include "kernel/draft.h"
#include "kernel/due.h"
#include "kernel/event-queue.h"
#include "kernel/pair.h"
#include "kernel/policy.h"
#include "kernel/region.h"
#include "kernel/regroup.h"
#include "kernel/side.h"
#include "kernel/state-graph.h"
#include "kernel/world.h"

namespace tw {

// Checks of pairs that are not predicted exactly happen at multiples of this, s (2^-20).
inline constexpr double check_grid = 0x1p-20;

// Boxes of members of moving groups reach this share of their size farther: a group check finds in
// them whom a member may touch before the next check.
inline constexpr double link_margin = 0.1;

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
  void process(Event event);  // for policies

  // ---- reading ----
  std::uint64_t removals() const { return removals_; }
  ArcPoint point_at(BodyId id, double when) const;
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
                     const std::function<void(Draft&)>& change);
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
  bool predicted_exactly(const Piece& piece, const Body& a, const Body& b) const;
  double exact_impact(const Piece& piece, const Body& a, const Body& b) const;
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
  bool linked(const Piece& piece) const;
  bool linked_from(BodyId a, BodyId b, const Key& from) const;
  bool next_piece(Pair& pair, const Piece& piece);
  Separation separation_at(const Piece& piece, double when) const;
  double closing_at(const Piece& piece, double when, const Separation& s) const;
  bool approaching_at(const Piece& piece, double when) const;
  bool pressed_at(const Piece& piece, const Vec3& normal) const;

  // ---- certificate.cc ----
  // Until when the pair is surely apart on the piece's arcs; -infinity: perhaps not at `when`.
  // Overlaps up to `allowance` (m) count as apart.
  double certificate(Pair& pair, const Piece& piece, double when, double allowance);

  // ---- clearance.cc ----
  // Whether the pair is surely apart from its safe time to `to`; cheaper than a certificate.
  bool apart_throughout(Pair& pair, const Piece& piece, double to);

  // ---- impact.cc ----
  void process_impact(std::uint32_t index);
  // True: the impact is soft, and the two stay in contact.
  bool compute_impact(const Key& key, Draft& a, Draft& b, std::optional<Collision>& collision);
  void find_impact_points(const Draft& a, const Draft& b);
  bool drop_ghosts(const Draft& a, const Draft& b);
  bool is_soft(const Key& key, Draft& a, Draft& b, double fastest) const;
  void run_collision_callbacks(const Collision& collision, Draft& a, Draft& b);
  bool wants_collision(const Body& a, const Body& b) const;
  bool observed(CollisionKind kind) const;

  // ---- callbacks.cc ----
  void schedule_callback(std::uint32_t number);
  void process_callback(std::uint32_t number);
  void rewind_callback(std::uint32_t number, const Key& key);
  Key first_tick(const CallbackRecord& callback, const Key& key) const;

  // ---- regroup.cc ----
  void collect_old(Regroup& work) const;
  void carry(Regroup& work, const OldLink& old) const;
  // Cuts the drafts into groups and isolated bodies.
  void finish(Regroup& work);
  std::shared_ptr<Group> make_group(Regroup& work, const std::vector<BodyId>& members);
  MotionPtr outside_motion(const Regroup& work, BodyId id) const;
  void start_arc_of(Group& group, Regroup& work) const;
  void share_out(Regroup& work) const;
  void share_ground(const std::vector<LooseContact*>& points, BodyId mover) const;
  void tell(Regroup& work) const;
  void count_group(const Group& group);
  std::size_t count_pieces(const Regroup& work, const std::vector<std::uint64_t>& linked) const;
  void count_fissions(Regroup& work, const std::vector<bool>& held) const;

  // ---- region.cc ----
  const Group* governing(const State& a, const State& b) const;
  std::vector<BodyId> remaining(const Group& group, const Key& key) const;
  template <class Visit>
  void visit_neighbours(const std::vector<BodyId>& inside, const Key& key, Visit visit) const;
  Region region_of(const Key& key, const std::vector<BodyId>& hit, bool whole) const;
  void add_neighbours(Region& region, const Key& key) const;
  void complete(Region& region, const Key& key, bool whole) const;
  template <class GoesOn>
  std::vector<BodyId> reached_from(const std::vector<BodyId>& ids, const Key& key,
                                   GoesOn goes_on) const;
  std::vector<BodyId> all_provisional(const std::vector<BodyId>& ids, const Key& key) const;
  std::vector<BodyId> hanging_together(BodyId id, const Key& key) const;
  bool disturbed(const Regroup& work, const std::vector<BodyId>& asleep,
                 std::vector<BodyId>& movers) const;
  bool own_check_before(BodyId id, const Key& key) const;
  bool await(BodyId id, const Key& key);
  bool await(const Region& region, const Key& key);
  double deviation(const Group& group, BodyId id) const;
  std::vector<BodyId> reached_beyond(const Regroup& work) const;
  void discard(const Regroup& work);
  std::vector<Draft> drafts_of(const Region& region, const Key& key,
                               const std::vector<Draft>& given) const;
  bool touches_groups(const Key& key, const std::vector<Draft>& drafts) const;
  bool regroup(const Key& key, std::vector<Draft>& drafts, const Occasion& occasion);
  void regroup_edited(const Key& key, std::vector<Draft>& drafts);

  // ---- linking.cc ----
  // Links the pair if it touches or may touch before the next check; `must`: in any case.
  bool link(Regroup& work, const Side& a, const Side& b, double interval, bool must);
  bool wants_link(const Side& a, const Side& b, bool linked_before, double interval,
                  const ContactConstants& law) const;
  ContactConstants contact_law(const Body& a, const Body& b, double lightest,
                               double heaviest) const;
  LooseContact loose_contact(const ManifoldPoint& point, const Side& a, const Side& b,
                             const ContactConstants& law) const;
  void match_stretches(Regroup& work, const LooseLink& link, const OldLink& was_linked) const;
  bool ghosts(const Side& a, const Side& b, double distance) const;
  void preload(Regroup& work, const LooseLink& link, const Side& a, const Side& b) const;
  void refresh(Regroup& work, const std::vector<BodyId>& bodies_looked_at, double interval);
  void find_fixed_around(const Body& mover);
  std::vector<SeamNeighbour> around(const Body& body) const;
  Side side_of(const Draft& draft) const;
  Side outside_side(const Body& body, double when) const;
  double gravity_magnitude() const;
  double fusion_speed(const Body& a, const Body& b) const;

  // ---- group-check.cc ----
  Key group_check_key(const Group& group, double when) const;
  void schedule_group_check(Body& body);
  void schedule_group_checks(const Group& group);
  std::vector<BodyId> family(const std::shared_ptr<Group>& group, const Key& key) const;
  std::vector<BodyId> early_bodies(const Group& group, double when, const Key& key) const;
  void process_group_check(BodyId id);
  double check_interval(const Regroup& work, const std::vector<BodyId>& members) const;
  double next_check_time(double birth, double now, double interval) const;
  bool comes_to_rest(Regroup& work, Group& after, const Group& before) const;
  void note_changes(Regroup& work) const;
  std::string group_failure(const Group& group) const;

  // ---- calm.cc ----
  Calm calm_of(const Draft& draft, const Key& key) const;
  std::vector<bool> sleepers(const Regroup& work) const;
  std::vector<BodyId> provisional_around(const Regroup& work) const;

  // ---- kinematic-work.cc ----
  double contact_work(const State& state, double until) const;

  // ---- end-test.cc ----
  void test_group_end(Group& group);
  double early_end(Group& group, const GroupLink& link);

  // ---- pass-on.cc ----
  std::vector<BodyId> pass_on(Regroup& work) const;

  // ---- rollback.cc ----
  Draft draft_for(const Body& body, const Key& key, bool new_arc) const;
  void enter_discontinuity(const Key& key, std::vector<Draft>& drafts);
  void treat(const std::vector<Touched>& touched);
  void stop_fellows(const Key& key, std::vector<Draft>& drafts) const;
  void append_drafts(const Key& key, std::vector<Draft>& drafts);
  void check_finite(Draft& draft) const;
  void note_removed(State& state);
  StateGraph::Farewell removal();
  StateGraph::Farewell release();
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
std::uint64_t state_hash(const Body& body, const Key& key, const ArcPoint& point,
                         const StateData& data);

}  // namespace tw
