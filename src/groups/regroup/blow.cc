// Who takes up a blow.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/blow.h"

#include <algorithm>
#include <map>

#include "base/constants.h"
#include "base/error.h"
#include "dynamics/impulse-solver.h"
#include "groups/components.h"
#include "groups/joints/joints.h"

namespace tw {
namespace {

// A contact that the blow may come to.
struct Touch {
  ImpulseContact at;
  std::uint64_t pair = 0;
  double load = 0;  // N, along the normal before the blow
  bool carries = false;
  bool spent = false;  // no impulse moves it
  int blows = 0;       // that it has taken
};

class Struck {
 public:
  // `all_links`: of multibodies, not only those that touch or are held.
  Struck(const Before& before, const Known& known, bool all_links,
         std::vector<Successor>& successors)
      : before_(before),
        known_(known),
        all_links_(all_links),
        successors_(successors),
        joints_(solver_, now()) {}

  Blow strike(const BlowAt& at);
  // Whether it has stopped: arcs must be known first, or a link has come in late.
  bool stops() const { return !missing_.inside.empty() || late_link_; }
  bool late_link() const { return late_link_; }
  Waits missing() const { return {missing_}; }
  void take();

 private:
  double now() const { return before_.key().time; }
  const Scene& scene() const { return before_.scene(); }
  const Body& body(BodyId id) const { return scene().body(id); }
  bool is_known(BodyId id);
  std::uint32_t add_slot(BodyId id, const ImpulseSlot& slot);
  std::uint32_t slot_of(BodyId id);
  struct Tie {
    BodyId a, b;
  };
  struct Unit {
    std::vector<BodyId> bodies;
    std::vector<Tie> ties;
  };
  Unit unit_of(BodyId id);
  void add_unit(BodyId id);
  Successor& successor_of(BodyId id);
  void open(BodyId id);
  void open_sides(const ImpulseContact& at);
  void blow(std::span<const std::size_t> struck, double restitution,
            std::span<const ImpulseContact> first);
  std::vector<std::size_t> next_struck() const;
  void add_rigid(std::span<const BodyId> members, BodyId held_by);
  bool carries(const Touch& touch, std::span<const Touch> beside) const;
  double approach(const Touch& touch) const { return -solver_.approach(touch.at); }
  // How much faster than with the velocities of those slots, m/s.
  double faster(const Touch& touch, const std::vector<ImpulseSlot>& than) const {
    const Vec3& where = touch.at.point;
    const Vec3 u = than[touch.at.b].velocity_at(where) - than[touch.at.a].velocity_at(where);
    return approach(touch) + u.dot(touch.at.normal);
  }

  const Before& before_;
  const Known& known_;
  const bool all_links_;
  std::vector<Successor>& successors_;
  ImpulseSolver solver_;
  JointImpulses joints_;
  std::map<BodyId, std::uint32_t> slots_;
  std::vector<BodyId> ids_;            // by slot; no_body: of a stop
  std::vector<Successor> reached_;     // links, and who is moved, that are none of those given
  std::vector<ImpulseSlot> added_;     // all slots as they were at first
  ImpulseSolver::Moment before_blow_;  // of all slots
  std::vector<Touch> touches_;
  std::vector<std::uint64_t> seen_;  // pairs, ascending
  std::vector<BodyId> opened_;       // ascending
  Region missing_;
  bool late_link_ = false;
};

bool Struck::is_known(BodyId id) {
  const ProcessId process = scene().process_of(id);
  if (!body(id).dynamic() || known_(process)) return true;
  insert(missing_.inside, process);
  return false;
}

std::uint32_t Struck::add_slot(BodyId id, const ImpulseSlot& slot) {
  const std::uint32_t number = solver_.add(slot);
  ids_.resize(number, no_body);
  ids_.push_back(id);
  return slots_[id] = number;
}

Successor& Struck::successor_of(BodyId id) {
  for (Successor& successor : successors_)
    if (successor.body->id() == id) return successor;
  for (Successor& successor : reached_)
    if (successor.body->id() == id) return successor;
  reached_.push_back(make_successor(before_, scene().process_of(id), true));
  Successor& made = reached_.back();
  // one multibody has its joints once
  for (const std::vector<Successor>* all : {&successors_, &reached_})
    for (const Successor& other : *all)
      if (made.joints && &other != &made && other.body->multibody == made.body->multibody) {
        made.joints = other.joints;
        return made;
      }
  return made;
}

// What answers as one with the body: the links of its multibody that touch or are held, and all
// that holds tie to it.
Struck::Unit Struck::unit_of(BodyId id) {
  Unit unit{{id}, {}};
  std::vector<BodyId>& bodies = unit.bodies;
  const auto add = [&](BodyId other) {
    if (std::find(bodies.begin(), bodies.end(), other) == bodies.end()) bodies.push_back(other);
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& member = body(bodies[i]);
    if (!member.dynamic() || !is_known(bodies[i])) continue;
    const State& state = before_.state_of(bodies[i]);
    if (state.error) continue;
    const auto tie = [&](const Bond& bond) {
      if (!bond.is_firm()) return;
      add(bond.other(bodies[i]));
      if (bond.a == bodies[i] || !body(bond.a).dynamic()) unit.ties.push_back({bond.a, bond.b});
    };
    for (const BondPtr& bond : bonds_of(state.forces)) tie(*bond);
    if (state.forces)
      for (const ForceLawPtr& law : state.forces->laws())
        if (const Bond* bond = law->bond()) tie(*bond);
    if (!member.multibody) continue;
    for (const BodyId link : member.multibody->links) {
      if (!is_known(link)) continue;
      const State& theirs = before_.state_of(link);
      const bool touches =
          theirs.group && !theirs.error && !theirs.group->pairs_of(theirs.member).empty();
      const bool struck = link == successors_[0].body->id() || link == successors_[1].body->id();
      if (all_links_ || touches || struck || theirs.forces) add(link);
    }
  }
  return unit;
}

void Struck::add_unit(BodyId id) {
  const Unit found = unit_of(id);
  const std::vector<BodyId>& unit = found.bodies;
  const std::vector<Tie>& ties = found.ties;
  if (stops()) return;

  const auto stands = [&](BodyId member) {
    return !body(member).dynamic() || before_.state_of(member).error;
  };
  const auto is_free = [&](BodyId member) { return !stands(member) && !body(member).multibody; };
  for (const BodyId member : unit) {
    if (slots_.contains(member) || is_free(member)) continue;
    ImpulseSlot slot = ImpulseSlot::of(body(member), before_.placed(member).point);
    if (stands(member)) {
      slot.answer = Answer::held;
      add_slot(member, slot);
      continue;
    }
    late_link_ = late_link_ || joints_.has_joined(*body(member).multibody);
    if (late_link_) return;
    joints_.add(successor_of(member), add_slot(member, slot));
  }
  for (const ImpulseContact& stop : joints_.add_stops()) touches_.push_back({stop, 0, 0, true});
  joints_.join();

  // what holds join directly, not by links between, is one rigid body each
  const auto place = [&](BodyId member) {
    return static_cast<std::size_t>(std::find(unit.begin(), unit.end(), member) - unit.begin());
  };
  Components components(unit.size());
  for (const Tie& tie : ties)
    if (is_free(tie.a) && is_free(tie.b)) components.join(place(tie.a), place(tie.b));
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (!is_free(unit[i]) || components.root(i) != i) continue;
    std::vector<BodyId> members;
    for (std::size_t j = i; j < unit.size(); ++j)
      if (is_free(unit[j]) && components.root(j) == i) members.push_back(unit[j]);
    BodyId held_by = no_body;
    for (const Tie& tie : ties)
      for (const auto& [own, other] : {std::pair(tie.a, tie.b), std::pair(tie.b, tie.a)})
        if (is_free(own) && components.root(place(own)) == i && stands(other)) held_by = other;
    add_rigid(members, held_by);
  }
  for (const Tie& tie : ties)
    if ((!is_free(tie.a) || !is_free(tie.b)) &&
        (solver_.slot(slots_[tie.a]).moves() || solver_.slot(slots_[tie.b]).moves()))
      solver_.hold(slots_[tie.a], slots_[tie.b]);
  ids_.resize(solver_.slot_count(), no_body);
  for (auto slot = added_.size(); slot < solver_.slot_count(); ++slot) {
    added_.push_back(solver_.slot(static_cast<std::uint32_t>(slot)));
    before_blow_.slots.push_back(added_.back());
  }
}

// Free bodies that holds join, or tie to what stands or moves by itself: then they move with it.
void Struck::add_rigid(std::span<const BodyId> members, BodyId held_by) {
  std::vector<std::uint32_t> numbers;
  for (const BodyId member : members) {
    ImpulseSlot slot = ImpulseSlot::of(body(member), before_.placed(member).point);
    if (held_by != no_body) {
      const PlacedBody holder = before_.placed(held_by);
      slot.answer = Answer::held;
      slot.v = holder.velocity_at(slot.x);
      slot.w = holder.point.w;
    }
    numbers.push_back(add_slot(member, slot));
  }
  if (held_by == no_body) solver_.join_rigidly(numbers);
}

std::uint32_t Struck::slot_of(BodyId id) {
  if (const auto at = slots_.find(id); at != slots_.end()) return at->second;
  add_unit(id);
  const auto at = slots_.find(id);
  return at != slots_.end() ? at->second : 0;
}

// The contacts of one that may move.
void Struck::open(BodyId id) {
  const auto place = std::lower_bound(opened_.begin(), opened_.end(), id);
  if (id == no_body || !body(id).dynamic() || (place != opened_.end() && *place == id)) return;
  opened_.insert(place, id);
  if (!is_known(id)) return;
  const State& state = before_.state_of(id);
  if (!state.group || state.error) return;
  const std::size_t first = touches_.size();
  for (const std::uint32_t number : state.group->pairs_of(state.member)) {
    const std::uint64_t pair = state.group->pairs[number].id;
    const auto at = std::lower_bound(seen_.begin(), seen_.end(), pair);
    if (at != seen_.end() && *at == pair) continue;
    const BodyId other = state.group->pairs[number].other(id);
    if (!is_known(other)) continue;
    seen_.insert(at, pair);
    const Before::Owned owned = before_.owned(pair);
    if (!owned.pair) continue;
    const Group& group = *owned.owner;
    each_contact(*owned.pair, [&](std::uint32_t c) {
      const ContactForce f = group.lone_contact_at(c, now());
      const GroupContact& contact = group.arc->start().contacts[c];
      if (f.gap > group.reach_of(c) + answer::touching * contact.law.gap_scale()) return;
      const ContactTag& tag = group.tags[c];
      const std::uint32_t a = slot_of(tag.reference), b = slot_of(tag.other);
      if (stops()) return;
      const ContactParameters& law = scene().contacts.between(tag.reference, tag.other);
      touches_.push_back(
          {{a, b, f.normal, f.point, law.restitution, contact.law.mu,
            borne_by(scene(), body(tag.reference), body(tag.other), contact.law, f.gap),
            law.impact_law},
           pair,
           f.normal_force});
    });
    if (stops()) return;
  }
  const std::span<Touch> found = std::span(touches_).subspan(first);
  for (Touch& touch : found)
    if (touch.pair != 0) touch.carries = carries(touch, found);
}

// Of the contacts of one body: loaded, with all of its pair, or with all ground that lies in its
// plane, for what lies on many pieces lies on all of them.
bool Struck::carries(const Touch& touch, std::span<const Touch> beside) const {
  const Body &a = body(first_of(touch.pair)), &b = body(second_of(touch.pair));
  const bool both_move = a.dynamic() && b.dynamic();
  const double mass = both_move ? std::min(a.mass, b.mass) : (a.dynamic() ? a : b).mass;
  // from what stands to what moves
  const auto outward = [&](const Touch& t) {
    return body(ids_[t.at.a]).dynamic() ? Vec3(-t.at.normal) : t.at.normal;
  };
  double load = 0;
  for (const Touch& t : beside) {
    if (t.pair == 0) continue;
    const bool on_ground = !body(first_of(t.pair)).dynamic() || !body(second_of(t.pair)).dynamic();
    if (both_move ? t.pair == touch.pair
                  : on_ground && outward(t).dot(outward(touch)) > answer::one_ground)
      load += t.load;
  }
  return load > answer::carrying_share * mass * scene().gravity_scale();
}

void Struck::open_sides(const ImpulseContact& at) {
  for (const std::uint32_t slot : {at.a, at.b}) {
    // who answers with it
    for (const std::uint32_t other : solver_.answering(slot))
      if (!stops()) open(ids_[other]);
  }
}

// One blow with all that takes it up.
void Struck::blow(std::span<const std::size_t> struck, double restitution,
                  std::span<const ImpulseContact> first) {
  std::vector<ImpulseContact> together;
  double speed = 0;
  for (const std::size_t i : struck) {
    together.push_back(touches_[i].at);
    together.back().restitution = restitution;
    speed = std::max(speed, approach(touches_[i]));
  }
  for (const ImpulseContact& at : std::vector<ImpulseContact>(together)) {
    open_sides(at);
    if (stops()) return;
  }
  before_blow_ = solver_.moment();

  const double negligible = answer::residual_approach * speed;
  for (const ImpulseContact& at : first)
    if (solver_.approach(at) < -negligible) solver_.strike(at);
  solver_.solve(together, negligible, guard::most_impulses);
  std::vector<bool> takes_part(touches_.size());
  for (const std::size_t i : struck) takes_part[i] = true;
  // who takes part is found without friction, which is solved for once
  bool rough = false;
  for (;;) {
    const std::size_t before = together.size();
    for (std::size_t i = 0; i < takes_part.size() && together.size() < guard::most_together; ++i) {
      const Touch& touch = touches_[i];
      if (!touch.carries || takes_part[i]) continue;
      const double least = std::max(std::min(touch.at.bears, answer::taken_up_share * speed),
                                    answer::settled_share * speed);
      if (approach(touch) <= least || faster(touch, before_blow_.slots) <= least) continue;
      takes_part[i] = true;
      together.push_back(touch.at);
    }
    if (together.size() == before && (rough || before == struck.size())) return;
    rough = together.size() == before;
    for (std::size_t i = before; i < together.size(); ++i) {
      open_sides(together[i]);
      if (stops()) return;
    }
    takes_part.resize(touches_.size());
    std::vector<ImpulseContact> contacts = together;
    for (ImpulseContact& contact : contacts) contact.friction = rough ? contact.friction : 0;
    solver_.return_to(before_blow_);
    if (!solver_.strike_together(contacts, struck.size(), restitution)) {
      solver_.solve(together, negligible, guard::most_impulses);
      return;
    }
  }
}

// What touches and approaches fastest beyond what it bears, with all points of its pair; what it
// carries with would have been taken up.
std::vector<std::size_t> Struck::next_struck() const {
  std::size_t worst = touches_.size();
  double most = 0;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const Touch& touch = touches_[i];
    if (touch.carries || touch.spent) continue;
    if (const double excess = approach(touch) - touch.at.bears; excess > most) {
      most = excess;
      worst = i;
    }
  }
  std::vector<std::size_t> all;
  for (std::size_t i = 0; worst < touches_.size() && i < touches_.size(); ++i)
    if (!touches_[i].carries && touches_[i].pair == touches_[worst].pair) all.push_back(i);
  return all;
}

Blow Struck::strike(const BlowAt& at) {
  const BodyId a = successors_[0].body->id(), b = successors_[1].body->id();
  const std::uint32_t slot_a = slot_of(a), slot_b = slot_of(b);
  if (stops()) return {};
  Blow told;
  // a pair of its own: the two may be in contact elsewhere
  std::vector<std::size_t> struck;
  std::vector<ImpulseContact> contacts;
  const double slow = fusion_speed(scene(), body(a), body(b));
  for (const ContactPoint& point : at.points) {
    contacts.push_back({slot_a, slot_b, point.normal, point.point, at.law->restitution,
                        at.law->friction, slow, at.law->impact_law});
    struck.push_back(touches_.size());
    touches_.push_back({contacts.back(), 0});
  }
  for (const ImpulseContact& contact : contacts)
    if (const double speed = -solver_.approach(contact); speed > told.approach) {
      told.approach = speed;
      told.largest = contact;
    }
  const std::vector<ImpulseContact> middles =
      contacts.size() > 1 ? centroids(at.points, contacts) : std::vector<ImpulseContact>();
  if (middles.size() == 1 && -solver_.approach(middles[0]) > 0) {
    told.largest = middles[0];
    told.approach = -solver_.approach(middles[0]);
  }
  blow(struck, at.law->restitution, middles);
  told.impulse = solver_.normal_impulse();
  for (int count = 0; !stops(); ++count) {
    std::vector<std::size_t> next = next_struck();
    if (next.empty()) break;
    if (count == guard::most_blows) break;
    double before = 0;
    bool often = false;
    for (const std::size_t i : next) {
      before = std::max(before, approach(touches_[i]));
      often = often || ++touches_[i].blows > answer::most_to_and_fro;
    }
    // a blow that goes to and fro loads what it comes to
    for (std::size_t i = 0; often && i < touches_.size(); ++i)
      if (touches_[i].pair != touches_[next.front()].pair)
        touches_[i].carries =
            touches_[i].carries || 2 * touches_[i].blows > answer::most_to_and_fro;
    blow(next, touches_[next.front()].at.restitution, {});
    if (stops()) break;
    for (const std::size_t i : next)
      touches_[i].spent = approach(touches_[i]) >= answer::undiminished * before;
  }
  for (const ImpulseContact& contact : contacts)
    told.left_over = told.left_over || -solver_.approach(contact) > slow;
  for (const Touch& touch : touches_) {
    const double borne = std::max(touch.at.bears, answer::settled_share * at.speed);
    told.given_up = told.given_up || (approach(touch) > borne && faster(touch, added_) > borne);
  }
  told.held_work = solver_.work_of_held();
  return told;
}

void Struck::take() {
  joints_.take();
  std::vector<const Body*> moved;
  for (const auto& [id, slot] : slots_) {
    const ImpulseSlot& after = solver_.slot(slot);
    if (!after.moves() || (after.v == added_[slot].v && after.w == added_[slot].w)) continue;
    Successor& successor = successor_of(id);
    take_velocities(successor, after);
    moved.push_back(successor.body);
  }
  for (Successor& successor : reached_)
    if (std::find(moved.begin(), moved.end(), successor.body) != moved.end())
      successors_.push_back(std::move(successor));
}

}  // namespace

std::vector<ImpulseContact> centroids(std::span<const ContactPoint> points,
                                      std::span<const ImpulseContact> contacts) {
  std::vector<ImpulseContact> result;
  for (std::size_t i = 0, j = 0; i < points.size(); i = j) {
    ImpulseContact c = contacts[i];
    Vec3 sum = Vec3::Zero();
    for (j = i; j < points.size() && points[j].pair == points[i].pair; ++j) sum += points[j].point;
    c.point = sum / static_cast<double>(j - i);
    result.push_back(c);
  }
  return result;
}

// Beyond the depth where it hardens no more a spring bears any speed: it stops what comes within
// sqrt(d0/g)/2000.  Impulses on a body that is squeezed there would go to and fro between the walls
// without end, and leave it with a velocity that it does not have.  Not so among unequal masses,
// whose contacts harden within a tenth of that: the heavy press the light as deep by mere weight,
// and a blow on them would drive the light through the floor.
double borne_by(const Scene& scene, const Body& a, const Body& b, const ContactConstants& law,
                double gap) {
  const double hardening =
      std::max(law.hardening, answer::hardening_depths * answer::depth_share * law.size);
  if (-gap > answer::hardest_ratio * hardening) return never;
  return borne_speed(fusion_speed(scene, a, b), law.depth, scene.gravity_scale());
}

std::variant<Blow, Waits> take_up(const Before& before, const Known& known, const BlowAt& at,
                                  std::vector<Successor>& successors) {
  for (const bool all_links : {false, true}) {
    Struck struck(before, known, all_links, successors);
    const Blow blow = struck.strike(at);
    if (struck.late_link()) continue;
    if (struck.stops()) return struck.missing();
    struck.take();
    return blow;
  }
  TW_ASSERT(false, "all links of a multibody are there from the start");
  return Blow();
}

}  // namespace tw
