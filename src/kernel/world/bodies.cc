// Bodies that come and go between runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/bodies.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/constants.h"
#include "base/hash.h"
#include "dynamics/contact-scales.h"
#include "groups/placed/placed-loads.h"
#include "groups/regroup/birth-group.h"
#include "groups/told/contact-survey.h"
#include "integrate/standing.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/claims.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/arc-accounts.h"
#include "kernel/report/reading.h"
#include "kernel/world/editing.h"
#include "kernel/world/make-body.h"
#include "kernel/world/make-multibody.h"
#include "timeline/swept-bounds.h"

namespace tw {
namespace {

// For messages: ", which joint J of M joins"; empty where none does.
std::string joint_between(const Body& a, const Body& b) {
  if (!Scene::are_neighbours(a, b)) return "";
  const Multibody& multibody = a.multibody ? *a.multibody : *b.multibody;
  // the one that hangs on the other: links come after their parents
  const Body& child = !b.multibody || (a.multibody && a.link > b.link) ? a : b;
  return " (which the joint " + multibody.tree.link(static_cast<int>(child.link)).joint_name +
         " of " + multibody.name + " joins)";
}

}  // namespace

Bodies::Bodies(Simulation& simulation, ActivePairs& pairs, CallbackBook& callbacks, Claims& claims,
               Discontinuities& discontinuities, Editing& editing)
    : sim_(simulation),
      pairs_(pairs),
      callbacks_(callbacks),
      claims_(claims),
      discontinuities_(discontinuities),
      editing_(editing) {}

std::optional<BodyId> Bodies::find(const std::string& name) const {
  const auto found = names_.find(name);
  if (found == names_.end()) return std::nullopt;
  return found->second;
}

// ---- coming ----

BodyId Bodies::add(const BodyDef& def) {
  sim_.require_between_runs("a body was added");
  const BodyId id = static_cast<BodyId>(sim_.scene.bodies.size());
  enter(make(def, id), def, id);
  return id;
}

std::unique_ptr<Body> Bodies::make(const BodyDef& def, BodyId id) const {
  const std::string name = def.name.empty() ? "body-" + std::to_string(id) : def.name;
  TW_REQUIRE(!names_.contains(name),
             "name " + name + " is taken; expected a name no other body has");
  std::unique_ptr<Body> body = make_body(def, id, name);
  require_numbers_of_parts(*body);
  return body;
}

void Bodies::require_numbers_of_parts(const Body& body) const {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (!body.shape_P || body.shape_P->part_count() <= most / most_parts_) return;
  const std::size_t parts = body.shape_P->part_count();
  for (const auto& other : sim_.scene.bodies) {
    if (other->info.removed || !other->shape_P || !(body.dynamic() || other->dynamic())) continue;
    TW_REQUIRE(parts <= most / other->shape_P->part_count(),
               body.info.name + " has " + std::to_string(parts) + " parts and " + other->info.name +
                   " " + std::to_string(other->shape_P->part_count()) +
                   "; expected a product of at most " + std::to_string(most) +
                   ", by which their pairs are numbered (shapes of fewer parts, or ground cut "
                   "into several bodies)");
  }
}

// What carries a multibody; null: nothing does.
const Body* Bodies::carrier_of(const MultibodyDef& def) const {
  if (def.base == no_body) return nullptr;
  const Body& base = sim_.body(def.base);
  TW_REQUIRE(!base.dynamic() && !base.info.removed && !def.free,
             "the base of the multibody " + def.name + " is " + base.info.name +
                 "; expected a body that is fixed or whose motion is given, 'fixed or 'free (what "
                 "moves freely can be the first link of a free multibody, or be held by attach!)");
  return &base;
}

std::uint32_t Bodies::add_multibody(const MultibodyDef& given) {
  sim_.require_between_runs("a multibody was added");
  Scene& scene = sim_.scene;
  MultibodyDef def = given;
  const double now = sim_.present.time;
  const Body* carrier = carrier_of(def);
  Pose in_carrier;
  if (carrier) {
    in_carrier = carrier->X_PB * Pose{def.position, def.orientation.normalized()};
    const Pose base = carrier->motion->pose(now) * in_carrier;
    def.position = base.p, def.orientation = base.q;
  }
  const std::uint32_t number = static_cast<std::uint32_t>(scene.multibodies.size());
  std::shared_ptr<Multibody> multibody = make_multibody(def, number);
  multibody->tree.set_gravity(scene.gravity_scale());
  for (const auto& other : scene.multibodies)
    TW_REQUIRE(other->name != multibody->name,
               "name " + multibody->name + " is taken; expected a name no other multibody has");
  if (carrier && carrier->kinematic()) {
    multibody->base_motion = carrier->motion;
    multibody->base_in_motion = in_carrier;
  }
  const MultibodyStatePtr joints = joints_at_birth(*multibody, def, now);
  const BodyId first = static_cast<BodyId>(scene.bodies.size());
  const std::vector<BodyDef> defs = link_bodies(*multibody, def, *joints);
  // errors come before any link is there
  std::vector<std::unique_ptr<Body>> bodies;
  for (const BodyDef& link : defs)
    bodies.push_back(make(link, first + static_cast<BodyId>(bodies.size())));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    multibody->links.push_back(bodies[i]->id());
    enter(std::move(bodies[i]), defs[i], first);
  }
  for (std::uint32_t i = 0; i < multibody->links.size(); ++i) {
    Body& body = *scene.bodies[multibody->links[i]];
    body.multibody = multibody.get();
    body.link = i;
    body.welded_down = !multibody->base_motion &&
                       multibody->tree.link(static_cast<int>(i)).node == multibody::base_node;
    multibody->principal.push_back(body.X_BP);
    multibody->touches = multibody->touches || body.shape_P;
    for (const int link : neighbours_of(multibody->tree, static_cast<int>(i)))
      body.neighbours.push_back(multibody->links[static_cast<std::size_t>(link)]);
    if (def.base == no_body || !hangs_on_base(multibody->tree, static_cast<int>(i))) continue;
    body.neighbours.insert(
        std::lower_bound(body.neighbours.begin(), body.neighbours.end(), def.base), def.base);
  }
  scene.multibodies.push_back(multibody);
  tell_carriers(*multibody);

  // born together, in a group
  std::vector<State*> ring;
  for (const BodyId link : multibody->links) ring.push_back(sim_.graph.tail(sim_.process_of(link)));
  sim_.graph.close_ring(ring);
  make_birth_group(scene, scene.multibodies.back(), joints, ring);
  return number;
}

void Bodies::enter(std::unique_ptr<Body> body, const BodyDef& def, BodyId born_as) {
  Scene& scene = sim_.scene;
  const BodyId id = body->id();
  Present& present = sim_.present;
  if (present.begun) discontinuities_.restart_future();
  body->process = sim_.graph.add_process();
  Process& process = sim_.processes.emplace_back();
  process.id = body->process;
  process.bodies = {id};
  State& state = *sim_.graph.append(body->process, {present.time, 0, KeyKind::birth, born_as});
  make_birth(*body, def, present.settings.gravity, state);
  if (body->dynamic()) let_move(scene, *body, state);
  // a stream of its own for every body
  state.random = mix64(sim_.options.seed ^ mix64(id + 0x632be59bd9b4e019ull));
  process.claim = state.key;
  present.counters.integrations += body->dynamic();

  sim_.present.newborn.push_back(id);
  enlist(*body);
  identities_.push_back(std::make_shared<const Identity>(++last_serial_));
  scene.bodies.push_back(std::move(body));
}

// What follows from a body that comes, or is back; bodies in the order of their numbers.
void Bodies::enlist(const Body& body) {
  const BodyId id = body.id();
  Scene& scene = sim_.scene;
  scene.first_bodies.push_back(id);
  scene.contacts.add_body(body);
  pairs_.make_room_for(id);
  claims_.make_room_for(id);
  if (body.info.removed) return;
  names_[body.info.name] = id;
  if (body.unbounded) sim_.unbounded.push_back(id);
  if (body.kinematic()) sim_.kinematic.push_back(id);
  if (body.kinematic() && body.motion->calls_out()) sim_.calls_out = true;
  if (body.shape_P) most_parts_ = std::max(most_parts_, body.shape_P->part_count());
}

// What carries a multibody touches none of the links that hang on it, and so must know them.
void Bodies::tell_carriers(const Multibody& multibody) {
  for (const BodyId link : multibody.links)
    for (const BodyId other : sim_.body(link).neighbours)
      if (sim_.body(other).multibody != &multibody)
        sim_.scene.bodies[other]->neighbours.push_back(link);
}

bool Bodies::any_newborn() const { return !sim_.present.newborn.empty(); }

void Bodies::check_newborn() {
  const PlacedTogether together = sim_.present.together;
  try {
    for (const BodyId id : sim_.present.newborn) check_overlaps(sim_.body(id));
  } catch (...) {
    sim_.present.together = together;
    throw;
  }
}

void Bodies::claim_newborn() {
  std::vector<const Body*> newborn;
  for (const BodyId id : sim_.present.newborn) newborn.push_back(&sim_.body(id));
  claims_.claim_windows(newborn);
  sim_.present.newborn.clear();
}

Separation Bodies::separation_of(const Body& a, const Body& b) const {
  const auto frame = [&](const Body& body) {
    return state_at(sim_, body.id(), sim_.present.time)->trajectory().frame(sim_.present.time);
  };
  return separation(*a.shape_P, frame(a), *b.shape_P, frame(b));
}

std::vector<std::pair<BodyId, BodyId>> Bodies::pairs_near(const ContactSide& a,
                                                          const ContactSide& b) const {
  const Scene& scene = sim_.scene;
  const std::vector<BodyId>& newborn = sim_.present.newborn;
  const auto is_newborn = [&](BodyId id) {
    return std::find(newborn.begin(), newborn.end(), id) != newborn.end();
  };
  const auto named = [&](const ContactSide& side) {
    std::vector<const Body*> all;
    for (const auto& body : scene.bodies)
      if (body->shape_P && !body->info.removed && !is_newborn(body->id()) &&
          scene.contacts.names(side, body->id()))
        all.push_back(body.get());
    return all;
  };
  const double now = sim_.present.time;
  const auto boxes = [&](const std::vector<const Body*>& all) {
    std::vector<Aabb> result;
    for (const Body* body : all)
      result.push_back(
          body->unbounded
              ? Aabb()
              : swept_bounds(*body, state_at(sim_, body->id(), now)->trajectory(), now, now));
    return result;
  };
  const std::vector<const Body*> ones = named(a), others = named(b);
  const std::vector<Aabb> boxes_of_ones = boxes(ones), boxes_of_others = boxes(others);
  std::vector<std::pair<BodyId, BodyId>> near;
  for (std::size_t i = 0; i < ones.size(); ++i)
    for (std::size_t j = 0; j < others.size(); ++j) {
      const Body &one = *ones[i], &other = *others[j];
      if (&one == &other || !(one.dynamic() || other.dynamic())) continue;
      if (one.unbounded || other.unbounded || boxes_of_ones[i].overlaps(boxes_of_others[j]))
        near.emplace_back(std::min(one.id(), other.id()), std::max(one.id(), other.id()));
    }
  return near;
}

// What collides rests deeper in each other than what may be placed: as deep as where its springs
// are hardest, twenty times as deep as the lighter one's weight presses it.
void Bodies::check_enabled(const Body& a, const Body& b) const {
  const double depth = -separation_of(a, b).distance;
  const ContactConstants law = contact_scales(sim_.scene, a, b, {}).law;
  const double allowed = answer::hardest_ratio * law.hardening;
  if (depth > answer::start_depth * law.size)
    sim_.present.together.note(a.id(), b.id(), sim_.present.time, true);
  TW_REQUIRE(depth <= allowed || sim_.scene.options.push_overlaps,
             a.info.name + " and " + b.info.name + joint_between(a, b) + " overlap by " +
                 show(depth) + " m at " + show(sim_.present.time) +
                 " s, so they cannot collide from now on; expected bodies that at most touch (" +
                 show(allowed) +
                 " m): move one of them away first, or enable their collisions "
                 "later");
}

void Bodies::require_no_overlap(const Body& a, const Body& b) const {
  if (!a.shape_P || !b.shape_P || !(a.dynamic() || b.dynamic()) || !sim_.scene.may_collide(a, b))
    return;
  const Separation s = separation_of(a, b);
  const double size = lesser_thickness(a, b), allowed = answer::start_overlap * size;
  if (s.distance > answer::start_gap * size) return;
  if (s.distance >= -allowed || sim_.scene.options.push_overlaps) {
    sim_.present.together.note(a.id(), b.id(), sim_.present.time,
                               -s.distance > answer::start_depth * size);
    return;
  }
  throw UserError(a.info.name + " and " + b.info.name + joint_between(a, b) + " overlap by " +
                      show(-s.distance) + " m at " + show(sim_.present.time) +
                      " s; expected bodies that at most touch (" + show(allowed) +
                      " m), (scene #:on-overlap 'push), which pushes them apart, or " +
                      "disable-collisions! for the pair",
                  a.id() > b.id() ? a.info.place : b.info.place);
}

double Bodies::closing_of(const Body& a, const Body& b, const Separation& s) const {
  const auto velocity = [&](const Body& body, const Vec3& at) {
    return PlacedBody(body, point_at(sim_, body.id(), sim_.present.time)).velocity_at(at);
  };
  return (velocity(a, s.point_a) - velocity(b, s.point_b)).dot(s.normal);
}

void Bodies::meet_overlapping() {
  PlacedTogether& together = sim_.present.together;
  together.settle();
  for (const auto& [first, second] : together.take_overlapping()) {
    const Body &a = sim_.body(first), &b = sim_.body(second);
    const Before before = sim_.before(sim_.present.key());
    if (!sim_.scene.may_collide(a, b) || before.owned(pair_id(first, second)).pair ||
        before.state_of(first).error || before.state_of(second).error)
      continue;
    const Separation s = separation_of(a, b);
    const double size = lesser_thickness(a, b), depth = -s.distance;
    if (depth > answer::start_overlap * size ||
        (depth > answer::start_depth * size &&
         closing_of(a, b, s) <= placed_speed(sim_.scene, size)))
      editing_.bring_together(first, second);
  }
}

// The body's box at the present time against all others that have one: a newborn body later in line
// looks back.
void Bodies::check_overlaps(const Body& body) {
  if (!body.shape_P) return;
  if (!body.unbounded) {
    Aabb box = swept_bounds(body, state_at(sim_, body.id(), sim_.present.time)->trajectory(),
                            sim_.present.time, sim_.present.time);
    box.grow(1e-9 * (box.lo.cwiseAbs().maxCoeff() + box.hi.cwiseAbs().maxCoeff()) +
             answer::start_gap * body.least_width);
    sim_.grid.place(body.id(), box, body.fixed());
    sim_.grid.overlapping(body.id(),
                          [&](BodyId other) { require_no_overlap(sim_.body(other), body); });
    for (const BodyId other : sim_.unbounded)
      if (claims_.boxes_overlap(body, sim_.body(other))) require_no_overlap(sim_.body(other), body);
    return;
  }
  for (const auto& other : sim_.scene.bodies)
    if (other->id() != body.id() && (other->unbounded || sim_.grid.contains(other->id())) &&
        claims_.boxes_overlap(body, *other))
      require_no_overlap(*other, body);
}

// ---- going ----

void Bodies::remove(BodyId id) {
  sim_.require_between_runs("a body was removed");
  const Body& there = sim_.body(id);
  TW_REQUIRE(!there.multibody, there.info.name + " cannot be removed; it is a link of " +
                                   there.multibody->name + ", expected a body that is no link");
  TW_REQUIRE(!there.info.removed,
             "body " + there.info.name + " was removed before; expected one that is there");
  for (const auto& multibody : sim_.scene.multibodies)
    TW_REQUIRE(!there.kinematic() || multibody->base_motion != there.motion,
               there.info.name + " cannot be removed; it is the base of " + multibody->name +
                   ", expected a body that carries no multibody");
  const BodyState last = body_state(there, point_at(sim_, id, sim_.present.time));
  const double in_springs = energy_in_springs();
  // a copy in its place
  const std::uint64_t serial = identities_[id]->serial;
  auto stone = std::make_unique<Body>(there);
  stone->info.removed = true;
  lay_aside(id, true);
  sim_.scene.bodies[id] = std::move(stone);
  identities_[id] = std::make_shared<const Identity>(serial);
  Body& body = *sim_.scene.bodies[id];
  if (sim_.present.begun) discontinuities_.restart_future();
  editing_.let_go_of(id);

  callbacks_.end_all_of(id);
  pairs_.drop_all_of(id);
  claims_.withdraw(body.process);
  claims_.forget_box(id);
  if (sim_.grid.contains(id)) sim_.grid.remove(id);
  std::erase(sim_.unbounded, id);
  std::erase(sim_.kinematic, id);
  std::erase(sim_.present.newborn, id);
  sim_.present.together.forget(id);
  names_.erase(body.info.name);
  bury(body, last);
  ++sim_.present.removals;
  forget_placed(in_springs - energy_in_springs());
}

// Asked for where it matters to what is placed.
double Bodies::energy_in_springs() const {
  if (sim_.present.counters.placed_energy == 0) return 0;
  const double now = sim_.present.time;
  return elastic_energy(sim_.scene, states_at(sim_, now), now);
}

// What springs held from the start counts for nothing: it goes where these springs go, which held
// that much at last, and the rest with the last body.
void Bodies::forget_placed(double gone) {
  double& placed = sim_.present.counters.placed_energy;
  const auto& bodies = sim_.scene.bodies;
  const bool empty =
      std::none_of(bodies.begin(), bodies.end(), [](const auto& body) { return body->dynamic(); });
  placed -= empty ? placed : std::clamp(gone, std::min(0.0, placed), std::max(0.0, placed));
}

void Bodies::bury(Body& body, const BodyState& last) {
  StateGraph& graph = sim_.graph;
  Present& present = sim_.present;
  // its last arc counts up to the present
  if (body.dynamic()) {
    graph.free_before(graph.tail(body.process), count_used(sim_));
    const State& tail = *graph.tail(body.process);
    present.counters.kinematic_work += kinematic_work_of(sim_, tail, present.time);
    present.counters.integration_length += integrated_length(tail, present.time);
  }
  graph.clear(body.process);
  body.info.kind = BodyKind::fixed;
  body.info.shape = nullptr;
  body.info.visible = false;
  body.shape_P = nullptr;
  body.unbounded = body.is_fixed_plane = false;
  body.X_BP = body.X_PB = Pose();
  body.motion = make_standing({last.position, last.orientation});
  State* state = graph.append(body.process, {present.time, 0, KeyKind::birth, body.id()});
  state->arc_key = state->key;
  state->arc_time = present.time;
  state->follows = body.motion;
  state->committed = present.begun;
  sim_.process(body).claim = present.begun ? last_key : state->key;
}

// ---- checkpoints ----

void Bodies::lay_aside(BodyId id, bool removed) {
  aside_[identities_[id]] = {std::move(sim_.scene.bodies[id]), removed};
}

void Bodies::forget_lost() {
  std::erase_if(aside_, [](const auto& entry) {
    return !entry.second.removed && entry.first.use_count() == 1;
  });
}

Bodies::Kept Bodies::keep() {
  forget_lost();
  return {identities_, sim_.scene.multibodies, sim_.scene.contacts.rules()};
}

void Bodies::restore(const Kept& kept) {
  Scene& scene = sim_.scene;
  // those that are others by now, or not there
  const std::size_t count = kept.bodies.size();
  for (BodyId id = 0; id < scene.bodies.size(); ++id) {
    if (id < count && kept.bodies[id] == identities_[id]) continue;
    claims_.forget_box(id);
    if (sim_.grid.contains(id)) sim_.grid.remove(id);
    lay_aside(id, false);
  }
  scene.bodies.resize(count);
  identities_ = kept.bodies;
  for (BodyId id = 0; id < count; ++id)
    if (!scene.bodies[id])
      scene.bodies[id] = std::move(aside_.extract(identities_[id]).mapped().body);
  scene.multibodies = kept.multibodies;
  scene.contacts.restart(kept.rules);
  scene.first_bodies.clear();
  names_.clear();
  sim_.unbounded.clear();
  sim_.kinematic.clear();
  for (const auto& body : scene.bodies) enlist(*body);
  for (const auto& body : scene.bodies)
    if (!body->multibody) body->neighbours.clear();
  for (const auto& multibody : scene.multibodies) tell_carriers(*multibody);

  sim_.graph.set_process_count(scene.bodies.size());
  forget_lost();
  sim_.processes.resize(scene.bodies.size());
  for (const auto& body : scene.bodies) {
    Process& process = sim_.process(*body);
    process.id = body->process;
    process.bodies = {body->id()};
  }
}

void Bodies::place_fixed() {
  const std::vector<BodyId>& newborn = sim_.present.newborn;
  for (const auto& body : sim_.scene.bodies)
    if (body->fixed() && body->shape_P && !claims_.placed(body->id()) &&
        std::find(newborn.begin(), newborn.end(), body->id()) == newborn.end())
      claims_.place_fixed(*body);
}

}  // namespace tw
