// Arcs of contact groups: extended, and looked at wherever they are known.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/group-arc.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/interruption.h"
#include "integrate/arc/group-stepper.h"
#include "integrate/arc/member-trajectory.h"
#include "integrate/implicit/group-rows.h"

namespace tw {

struct GroupArc::Data {
  GroupStart start;
  GroupStepper stepper;
  const GroupSystem& system;
  const GroupRecord& record;
  std::vector<MemberTrajectory> trajectories;
  std::vector<ArcEnd> ends;  // of each member; empty: the arc's
  std::string failure;
  int failed_contact = -1;
  const std::uint64_t serial = next_serial();  // no two arcs of a program share one

  static std::uint64_t next_serial() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }

  explicit Data(GroupStart given)
      : start(std::move(given)),
        stepper(start),
        system(stepper.system()),
        record(stepper.record()) {}

  // Whether all that there will ever be is there.
  bool complete() const { return record.reached() >= last() || !failure.empty(); }
  double last() const { return record.steps() >= start.most_steps ? record.reached() : start.end; }
  // A time on the arc.
  double at(double time) const {
    TW_ASSERT(time <= record.reached() || complete(),
              "an arc completed to " + show(record.reached()) + " s was looked at at " +
                  show(time) + " s");
    return std::clamp(time, start.time, record.reached());
  }
  // Whether there is a step to look at: an arc of no length, or that failed at once, has none.
  bool has_steps() const {
    TW_ASSERT(record.steps() > 0 || complete(), "an arc was looked at before its first step");
    return record.steps() > 0;
  }
  // The record of the multibody that a member is a link of; null: it moves by itself.
  const JointRecord* joints_of(int member) const {
    const int tree = start.members[static_cast<std::size_t>(member)].tree;
    return tree >= 0 ? &stepper.joints(tree) : nullptr;
  }
  int link_of(int member) const { return start.members[static_cast<std::size_t>(member)].link; }
  // kinematics of all slots at a time that is reached
  void set_bodies(double time, GroupScratch& s) const;
  void set_slot(int slot, double time, BodyKinematics& body) const;
  struct KeptPack {
    PackState state;
    Vec3 center_b[lane_count];
  };
  // What was asked of an arc at one instant.
  struct KeptInstant {
    std::uint64_t arc = 0;
    double time = 0;
    std::vector<BodyKinematics> bodies;  // by slot
    std::vector<KeptPack> packs;         // by number
    std::vector<bool> has_body;
    std::vector<std::uint8_t> lanes;  // of each pack: those that are set, a bit each
  };
  KeptInstant& instant_at(double at) const;
  static constexpr unsigned all_lanes = (1u << lane_count) - 1;
  const KeptPack& pack_at(int number, double at, unsigned lanes = all_lanes) const;
  ContactForce contact_force(int contact, double at, bool lone) const;
  // What a contact does to a member, and where; where the work counts, how fast the outside body's
  // material moves there, and its turning.
  struct MemberForce {
    Vec3 point, force;
    double normal = 0;
    Vec3 torque = Vec3::Zero();  // beside that of the force
    Vec3 other_velocity = Vec3::Zero(), other_turn = Vec3::Zero();
  };
  MemberForce force_on(int member, const WorkingContact& contact, double at) const;
  int strongest_contact() const;
  void fail();
};

int GroupArc::Data::strongest_contact() const {
  GroupScratch& s = system.scratch();
  set_bodies(record.reached(), s);
  int strongest = -1;
  double largest = -1;
  PackState state;
  for (int p = 0; p < system.packs(); ++p) {
    const ContactPack& pack = system.contact_packs().packs[static_cast<std::size_t>(p)];
    const double at = record.reached();
    evaluate_pack(pack, s.bodies.data(), record.stretch(p, at), record.bend(pack, at),
                  record.side(p, at), state);
    const Lanes force = dot(state.f, state.f);
    for (int i = 0; i < pack.count; ++i)
      if (!(force[i] <= largest)) largest = force[i], strongest = pack.contact[i];
  }
  return strongest;
}

void GroupArc::Data::fail() {
  failed_contact = strongest_contact();
  std::ostringstream text;
  text.precision(17);
  text << "contact group stopped at " << record.reached() << " s: " << stepper.failure();
  if (failed_contact >= 0) text << "; largest force at contact " << failed_contact;
  failure = text.str();
}

void GroupArc::Data::set_slot(int slot, double time, BodyKinematics& body) const {
  if (const JointRecord* joints = joints_of(slot)) {
    const PoseTwist point = joints->at(link_of(slot), time);
    rows::vec(body.x) = point.x;
    rows::vec(body.v) = point.v;
    rows::vec(body.w) = point.w;
    rows::store_rotation(point.q.toRotationMatrix(), body.R);
    return;
  }
  Vec3 x, v, L;
  Quat q;
  record.motion(slot, time, x, q, v, L);
  system.set_member(slot, x, q, v, L, body);
}

void GroupArc::Data::set_bodies(double time, GroupScratch& s) const {
  system.set_outside(time, s);
  for (int i = 0; i < system.members(); ++i)
    set_slot(i, time, s.bodies[static_cast<std::size_t>(i)]);
}

GroupArc::GroupArc(GroupStart start) : data_(std::make_unique<Data>(std::move(start))) {
  const int count = data_->system.members();
  data_->trajectories.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) data_->trajectories.emplace_back(*this, i);
}
GroupArc::~GroupArc() = default;

const GroupStart& GroupArc::start() const { return data_->start; }
double GroupArc::last() const { return data_->last(); }
double GroupArc::reached() const { return data_->record.reached(); }
bool GroupArc::complete() const { return data_->complete(); }
const std::string& GroupArc::failure() const { return data_->failure; }
int GroupArc::failed_contact() const { return data_->failed_contact; }
double GroupArc::next_step() const { return data_->stepper.next_step(); }

void GroupArc::lower_ends(std::vector<ArcEnd> ends) {
  TW_ASSERT(data_->ends.empty(), "the ends of an arc were told twice");
  data_->ends = std::move(ends);
}

double GroupArc::end(int member) const {
  return data_->ends.empty() ? data_->last() : data_->ends[static_cast<std::size_t>(member)].time;
}

const std::vector<ArcEnd>& GroupArc::found_ends() const { return data_->ends; }

const Trajectory& GroupArc::trajectory(int member) const {
  return data_->trajectories[static_cast<std::size_t>(member)];
}

GroupCounts GroupArc::counts() const { return data_->stepper.counts(); }

bool GroupArc::extend(double time) {
  Data& d = *data_;
  const double to = std::min(time, d.start.end);
  while (d.record.reached() < to && !d.complete())
    if (!d.stepper.step()) d.fail();
  return d.record.reached() >= to;
}

bool GroupArc::extend_patiently(double time) {
  Data& d = *data_;
  constexpr int between_looks = 16;
  for (int step = 1; d.record.reached() < time && !d.complete(); ++step) {
    if (step % between_looks == 0) raise_if_interrupted();
    if (!d.stepper.step()) d.fail();
  }
  return extend(time);
}

GroupSample GroupArc::evaluate(int member, double time) const {
  const double at = data_->at(time);
  GroupSample sample;
  if (const JointRecord* joints = data_->joints_of(member)) {
    const PoseTwist point = joints->at(data_->link_of(member), at);
    const Mat3 R = point.q.toRotationMatrix();
    const Vec3& moments = data_->start.members[static_cast<std::size_t>(member)].moments;
    return {point.x, point.v, point.w, R * moments.cwiseProduct(R.transpose() * point.w), point.q};
  }
  data_->record.motion(member, at, sample.x, sample.q, sample.v, sample.L);
  sample.w = data_->system.angular_velocity(member, sample.q, sample.L);
  return sample;
}

void GroupArc::pose(int member, double time, Vec3& x, Quat& q) const {
  const double at = data_->at(time);
  if (const JointRecord* joints = data_->joints_of(member)) {
    const Pose pose = joints->pose(data_->link_of(member), at);
    x = pose.p;
    q = pose.q;
    return;
  }
  const Pose pose = data_->record.pose(member, at);
  x = pose.p;
  q = pose.q;
}

Vec3 GroupArc::position(int member, double time) const {
  const double at = data_->at(time);
  if (const JointRecord* joints = data_->joints_of(member))
    return joints->pose(data_->link_of(member), at).p;
  return data_->record.position(member, at);
}

void GroupArc::pose_rates(int member, double time, Vec3& dx, Vec3& w) const {
  // at the start too the rates are those of a step
  if (const JointRecord* joints = data_->joints_of(member); joints && data_->has_steps()) {
    const Twist rates = joints->rates(data_->link_of(member), data_->at(time));
    dx = rates.v;
    w = rates.w;
    return;
  }
  if (data_->has_steps()) return data_->record.pose_rates(member, data_->at(time), dx, w);
  const GroupSample sample = evaluate(member, time);
  dx = sample.v;
  w = sample.w;
}

PoseTwist GroupArc::path_at(int member, double time) const {
  if (!data_->joints_of(member) && data_->has_steps())
    return data_->record.path_at(member, data_->at(time));
  PoseTwist point;
  pose(member, time, point.x, point.q);
  pose_rates(member, time, point.v, point.w);
  return point;
}

MotionBounds GroupArc::bounds(int member, double from, double to) const {
  // at the instant at which it begins an arc is known before its first step
  const bool begins = to <= data_->start.time && data_->record.steps() == 0;
  if (!begins && data_->has_steps()) {
    // a body is asked for the same stretch by each of its neighbours: the last answers are kept
    struct Kept {
      std::uint64_t arc = 0;
      int member = 0;
      double from = 0, to = 0;
      MotionBounds bounds;
    };
    constexpr std::size_t least_places = 512;
    thread_local std::vector<Kept> table(least_places);
    const std::size_t members = data_->trajectories.size();
    if (table.size() < members) table.resize(std::bit_ceil(2 * members));
    const double end = data_->at(to), begin = std::min(data_->at(from), end);
    const JointRecord* joints = data_->joints_of(member);
    Kept& kept =
        table[(data_->serial * 61 + static_cast<std::uint64_t>(member)) & (table.size() - 1)];
    if (kept.arc != data_->serial || kept.member != member || kept.from != begin || kept.to != end)
      kept = {data_->serial, member, begin, end,
              joints ? joints->bounds(data_->link_of(member), begin, end)
                     : data_->record.bounds(member, begin, end)};
    return kept.bounds;
  }
  const GroupSample start = evaluate(member, from);
  return standing_bounds(start.x, start.v, start.w);
}

double GroupArc::turn_change_across(const Vec3& n, int member, double from, double to,
                                    const MotionBounds& known) const {
  if (data_->record.steps() == 0 || data_->joints_of(member)) return known.turn_change;
  const double end = data_->at(to), begin = std::min(data_->at(from), end);
  return std::min(known.turn_change, data_->record.turn_change_across(n, member, begin, end));
}

double GroupArc::step_end(double time) const {
  TW_ASSERT(time < reached() || data_->complete(),
            "the step from " + show(time) + " s on is not completed");
  const double from = data_->at(time);
  const GroupRecord& record = data_->record;
  const int step = record.step_from(from);
  return step >= 0 ? record.time(step + 1) : record.reached();
}

TrajectoryPtr GroupArc::excerpt(int member, double from, double to) const {
  PoseTwist start;
  if (!data_->has_steps()) start = trajectory(member).at(from);
  data_->at(to);
  if (const JointRecord* joints = data_->joints_of(member))
    return make_excerpt(joints->stretch(data_->at(from)), data_->link_of(member), start);
  return make_excerpt(data_->record.stretch_of(member, data_->at(from)), start);
}

void GroupArc::joints(int tree, double time, std::vector<double>& q, std::vector<double>& u) const {
  data_->stepper.joints(tree).joints(data_->at(time), q, u);
}

const JointRecord& GroupArc::joints_record(int tree) const { return data_->stepper.joints(tree); }

Vec3 GroupArc::stretch(int contact, double time) const {
  const ContactPlace place =
      data_->system.contact_packs().places[static_cast<std::size_t>(contact)];
  const LaneVec s = data_->record.stretch(place.pack, data_->at(time));
  return {s.x[place.lane], s.y[place.lane], s.z[place.lane]};
}

Vec3 GroupArc::bend(int contact, double time) const {
  const ContactPacks& all = data_->system.contact_packs();
  const ContactPlace place = all.places[static_cast<std::size_t>(contact)];
  const LaneVec z =
      data_->record.bend(all.packs[static_cast<std::size_t>(place.pack)], data_->at(time));
  return {z.x[place.lane], z.y[place.lane], z.z[place.lane]};
}

// The contacts of a group are asked for one after the other at one instant, and those of a pair, of
// a body or of a pack stand apart: what was made for the ones before is kept.
GroupArc::Data::KeptInstant& GroupArc::Data::instant_at(double at) const {
  thread_local KeptInstant kept;
  if (kept.arc == serial && kept.time == at) return kept;
  const ContactPacks& all = system.contact_packs();
  kept.arc = serial;
  kept.time = at;
  kept.has_body.assign(static_cast<std::size_t>(all.slots), false);
  kept.lanes.assign(all.packs.size(), 0);
  if (kept.bodies.size() < kept.has_body.size()) kept.bodies.resize(kept.has_body.size());
  if (kept.packs.size() < kept.lanes.size()) kept.packs.resize(kept.lanes.size());
  return kept;
}

// A pack of contacts at one instant, of which these lanes are wanted.  The others are those of
// bodies of another instant, if nobody has asked for them: lanes have nothing to do with each
// other, but for the signs of zeros.
const GroupArc::Data::KeptPack& GroupArc::Data::pack_at(int number, double at,
                                                        unsigned lanes) const {
  KeptInstant& kept = instant_at(at);
  const std::size_t index = static_cast<std::size_t>(number);
  KeptPack& result = kept.packs[index];
  if ((kept.lanes[index] & lanes) == lanes) return result;
  const ContactPack& pack = system.contact_packs().packs[index];
  for (const auto& slots : {pack.a, pack.b})
    for (int i = 0; i < pack.count; ++i) {
      if (!(lanes >> i & 1)) continue;
      const std::size_t slot = static_cast<std::size_t>(slots[i]);
      if (kept.has_body[slot]) continue;
      if (slots[i] < system.members())
        set_slot(slots[i], at, kept.bodies[slot]);
      else
        system.set_outside_slot(slots[i], at, kept.bodies[slot]);
      kept.has_body[slot] = true;
    }
  evaluate_pack(pack, kept.bodies.data(), record.stretch(number, at), record.bend(pack, at),
                record.side(number, at), result.state);
  unsigned set = all_lanes & ~((1u << pack.count) - 1);
  for (int i = 0; i < pack.count; ++i) {
    const std::size_t a = static_cast<std::size_t>(pack.a[i]);
    const std::size_t b = static_cast<std::size_t>(pack.b[i]);
    if (!kept.has_body[a] || !kept.has_body[b]) continue;
    const double* x = kept.bodies[b].x;
    result.center_b[i] = Vec3(x[0], x[1], x[2]);
    set |= 1u << i;
  }
  kept.lanes[index] = static_cast<std::uint8_t>(set);
  return result;
}

ContactForce GroupArc::Data::contact_force(int contact, double at, bool lone) const {
  const ContactPlace place = system.contact_packs().places[static_cast<std::size_t>(contact)];
  const int i = place.lane;
  const KeptPack& kept = pack_at(place.pack, at, lone ? 1u << i : all_lanes);
  const PackState& state = kept.state;
  const auto lane = [i](const LaneVec& v) { return Vec3(v.x[i], v.y[i], v.z[i]); };
  ContactForce force;
  force.point = kept.center_b[i] + lane(state.sb);
  force.normal = lane(state.n);
  force.gap = state.gap[i];
  force.normal_force = state.N[i];
  // (a sum with 0 is no -0)
  force.friction = lane(state.F) - state.drag[i] * lane(state.u) + Vec3::Zero();
  force.velocity = lane(state.vr);
  force.slipping = state.slipping[i] != 0 && state.N[i] > 0;
  if (state.turns) force.torque = lane(state.torque) + Vec3::Zero();
  return force;
}

ContactForce GroupArc::contact_force(int contact, double time) const {
  return data_->contact_force(contact, data_->at(time), false);
}

ContactForce GroupArc::lone_contact_force(int contact, double time) const {
  return data_->contact_force(contact, data_->at(time), true);
}

GroupArc::Data::MemberForce GroupArc::Data::force_on(int member, const WorkingContact& c,
                                                     double at) const {
  const ContactPlace place = system.contact_packs().places[static_cast<std::size_t>(c.contact)];
  const int i = place.lane;
  const KeptPack& kept = pack_at(place.pack, at, 1u << i);
  const auto lane = [i](const LaneVec& v) { return Vec3(v.x[i], v.y[i], v.z[i]); };
  const Vec3 on_b = lane(kept.state.f);
  const ContactPack& pack = system.contact_packs().packs[static_cast<std::size_t>(place.pack)];
  const bool is_b = pack.b[i] == member;
  MemberForce result{kept.center_b[i] + lane(kept.state.sb), is_b ? on_b : Vec3(-on_b),
                     kept.state.N[i]};
  if (kept.state.turns) result.torque = (is_b ? 1 : -1) * lane(kept.state.torque);
  if (!c.counts) return result;
  const int other = is_b ? pack.a[i] : pack.b[i];
  const BodyKinematics& body = instant_at(at).bodies[static_cast<std::size_t>(other)];
  const auto vec = [](const double* x) { return Vec3(x[0], x[1], x[2]); };
  result.other_turn = vec(body.w);
  result.other_velocity = vec(body.v) + result.other_turn.cross(result.point - vec(body.x));
  return result;
}

// Gauss's rule with two points a step.  The force of the dense output is not what the step was made
// of: damping turns the small error of velocities between the steps' ends into one of forces,
// always to the same side (2.6 % of the work of a lift at accuracy 1e-4, 0.1 % at 1e-6).  What the
// step was made of is known as a whole, m dv - F h and dL; the difference is shared out by the
// normal forces, and what it lacks of the torque likewise.
double GroupArc::work_on(int member, std::span<const WorkingContact> contacts, double from,
                         double to) const {
  const Data& d = *data_;
  const GroupMember& body = d.start.members[static_cast<std::size_t>(member)];
  // what joints, springs and forces by time did is not known
  const auto on_bond = [&](const GroupBond& bond) { return bond.a == member || bond.b == member; };
  const bool is_free = body.tree < 0 && !body.forces &&
                       std::none_of(d.start.bonds.begin(), d.start.bonds.end(), on_bond);
  double work = 0;
  const double end = d.at(to);
  for (double start = d.at(from); start < end;) {
    const double stop = std::min(end, step_end(start)), h = stop - start;
    Vec3 v0, v1, L0, L1;
    if (is_free) {
      d.record.velocities(member, start, v0, L0);
      d.record.velocities(member, stop, v1, L1);
    }
    // of all contacts, and by normal forces: where they act, how those that count move there and
    // turn
    Vec3 impulse = Vec3::Zero(), angular = Vec3::Zero();
    Vec3 arm = Vec3::Zero(), carrying = Vec3::Zero(), turning = Vec3::Zero();
    double normal = 0;
    for (const double side : {-1.0, 1.0}) {
      const double when = start + 0.5 * h + side * 0.5 / std::sqrt(3.0) * h;
      const Vec3 centre = is_free ? d.record.position(member, when) : Vec3(Vec3::Zero());
      for (const WorkingContact& c : contacts) {
        const Data::MemberForce f = d.force_on(member, c, when);
        impulse += 0.5 * h * f.force;
        angular += 0.5 * h * ((f.point - centre).cross(f.force) + f.torque);
        normal += 0.5 * h * f.normal;
        arm += 0.5 * h * f.normal * (f.point - centre);
        if (!c.counts) continue;
        work += 0.5 * h * (f.force.dot(f.other_velocity) + f.torque.dot(f.other_turn));
        carrying += 0.5 * h * f.normal * f.other_velocity;
        turning += 0.5 * h * f.normal * f.other_turn;
      }
    }
    if (!is_free) {
      start = stop;
      continue;
    }
    const Vec3 missed = body.mass * (v1 - v0) - h * body.force - impulse;
    if (normal > 0) {
      const Vec3 twist = L1 - L0 - angular - arm.cross(missed) / normal;
      work += (missed.dot(carrying) + twist.dot(turning)) / normal;
    }
    start = stop;
  }
  return work;
}

double GroupArc::elastic_energy(double time, const std::vector<bool>& counted) const {
  const Data& d = *data_;
  const double at = d.at(time);
  GroupScratch& s = d.system.scratch();
  d.set_bodies(at, s);
  double energy = 0;
  PackState state;
  for (int p = 0; p < d.system.packs(); ++p) {
    const ContactPack& pack = d.system.contact_packs().packs[static_cast<std::size_t>(p)];
    evaluate_pack(pack, s.bodies.data(), d.record.stretch(p, at), d.record.bend(pack, at),
                  d.record.side(p, at), state);
    const Lanes each = pack_energy(pack, state);
    for (int i = 0; i < pack.count; ++i)
      if (counted[static_cast<std::size_t>(pack.contact[i])]) energy += each[i];
  }
  return energy;
}

}  // namespace tw
