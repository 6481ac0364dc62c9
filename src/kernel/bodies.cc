// Bodies that come and go between runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/bodies.h"

#include <algorithm>
#include <limits>

#include "base/constants.h"
#include "base/hash.h"
#include "dynamics/contact-scales.h"
#include "groups/birth-group.h"
#include "integrate/standing.h"
#include "kernel/active-pairs.h"
#include "kernel/arc-accounts.h"
#include "kernel/callback-book.h"
#include "kernel/claims.h"
#include "kernel/discontinuities.h"
#include "kernel/editing.h"
#include "kernel/make-body.h"
#include "kernel/make-multibody.h"
#include "kernel/reading.h"
#include "kernel/simulation.h"
#include "timeline/swept-bounds.h"

namespace tw {
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
    multibody->principal.push_back(body.X_BP);
    multibody->touches = multibody->touches || body.shape_P;
    for (const int link : neighbours_of(multibody->tree, static_cast<int>(i)))
      body.neighbours.push_back(multibody->links[static_cast<std::size_t>(link)]);
    if (def.base == no_body || !hangs_on_base(multibody->tree, static_cast<int>(i))) continue;
    body.neighbours.insert(
        std::lower_bound(body.neighbours.begin(), body.neighbours.end(), def.base), def.base);
    scene.bodies[def.base]->neighbours.push_back(body.id());
  }
  scene.multibodies.push_back(multibody);

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

  scene.first_bodies.push_back(id);
  sim_.present.newborn.push_back(id);
  names_[body->info.name] = id;
  pairs_.make_room_for(id);
  claims_.make_room_for(id);
  if (body->unbounded) sim_.unbounded.push_back(id);
  if (body->kinematic()) sim_.kinematic.push_back(id);
  if (body->kinematic() && body->motion->calls_out()) sim_.calls_out = true;
  if (body->shape_P) most_parts_ = std::max(most_parts_, body->shape_P->part_count());
  scene.contacts.add_body(*body);
  scene.bodies.push_back(std::move(body));
}

bool Bodies::any_newborn() const { return !sim_.present.newborn.empty(); }

void Bodies::check_newborn() {
  for (const BodyId id : sim_.present.newborn) check_overlaps(sim_.body(id));
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

// What collides rests deeper in each other than what may be placed, so only pairs that did not
// collide until now are looked at, and they may be as deep as where their springs are hardest,
// twenty times as deep as the lighter one's weight presses it.
void Bodies::check_enabled(const ContactSide& a, const ContactSide& b,
                           const ContactSettings& settings) {
  const Scene& scene = sim_.scene;
  if (!settings.collide.value_or(false) || !scene.may_disable()) return;
  const ContactTable rules = scene.contacts.table_with(a, b, settings);
  // who has come since the last run is looked at when the next one begins
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
  const auto box = [&](const Body& body) {
    return swept_bounds(body, state_at(sim_, body.id(), now)->trajectory(), now, now);
  };
  const std::vector<const Body*> ones = named(a), others = named(b);
  for (const Body* one : ones)
    for (const Body* other : others) {
      if (one == other || !(one->dynamic() || other->dynamic())) continue;
      if (scene.are_neighbours(*one, *other)) continue;
      if (scene.contacts.between(one->id(), other->id()).collide) continue;
      if (!scene.contacts.between(rules, one->id(), other->id()).collide) continue;
      if (!one->unbounded && !other->unbounded && !box(*one).overlaps(box(*other))) continue;
      const double depth = -separation_of(*one, *other).distance;
      const ContactConstants law = contact_scales(scene, *one, *other, {}).law;
      const double allowed = answer::hardest_ratio * law.hardening;
      if (depth > allowed)
        throw UserError(one->info.name + " and " + other->info.name + " overlap by " + show(depth) +
                        " m at " + show(now) + " s, so they cannot collide from now on; expected " +
                        "bodies that at most touch (" + show(allowed) + " m): move one of them " +
                        "away first, or enable their collisions later");
    }
}

void Bodies::require_no_overlap(const Body& a, const Body& b) const {
  if (!a.shape_P || !b.shape_P || !(a.dynamic() || b.dynamic()) || !sim_.scene.may_collide(a, b))
    return;
  const Separation s = separation_of(a, b);
  const double allowed = answer::start_depth * std::min(a.least_width, b.least_width);
  if (std::abs(s.distance) <= allowed)
    sim_.present.together.note(a.id(), b.id(), sim_.present.time);
  if (s.distance >= -allowed) return;
  throw UserError(a.info.name + " and " + b.info.name + " overlap by " + show(-s.distance) +
                      " m at " + show(sim_.present.time) +
                      " s; expected bodies that at most touch (" + show(allowed) +
                      " m), or disable-collisions! for the pair",
                  a.id() > b.id() ? a.info.place : b.info.place);
}

// The body's box at the present time against all others that have one: a newborn body later in line
// looks back.
void Bodies::check_overlaps(const Body& body) {
  if (!body.shape_P) return;
  if (!body.unbounded) {
    Aabb box = swept_bounds(body, state_at(sim_, body.id(), sim_.present.time)->trajectory(),
                            sim_.present.time, sim_.present.time);
    box.grow(1e-9 * (box.lo.cwiseAbs().maxCoeff() + box.hi.cwiseAbs().maxCoeff()) +
             answer::start_depth * body.least_width);
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
  Body& body = *sim_.scene.bodies[id];
  TW_REQUIRE(!body.multibody, body.info.name + " cannot be removed; it is a link of " +
                                  body.multibody->name + ", expected a body that is no link");
  TW_REQUIRE(!body.info.removed,
             "body " + body.info.name + " was removed before; expected one that is there");
  for (const auto& multibody : sim_.scene.multibodies)
    TW_REQUIRE(!body.kinematic() || multibody->base_motion != body.motion,
               body.info.name + " cannot be removed; it is the base of " + multibody->name +
                   ", expected a body that carries no multibody");
  const BodyState last = body_state(body, point_at(sim_, id, sim_.present.time));
  body.info.removed = true;
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

}  // namespace tw
