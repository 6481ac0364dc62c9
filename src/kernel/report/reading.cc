// What can be asked of a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/report/reading.h"

#include "base/hash.h"
#include "groups/joints/joints.h"
#include "kernel/loop/simulation.h"
#include "timeline/field-words.h"
#include "timeline/state-fields.h"
#include "timeline/swept-bounds.h"

namespace tw {

const State* state_at(const Simulation& simulation, BodyId id, double when) {
  const StateGraph& graph = simulation.graph;
  const ProcessId process = simulation.process_of(id);
  const Present& present = simulation.present;
  // between runs nothing but the past counts
  const State* state = when == present.time && !simulation.running
                           ? graph.last_before(process, present.key())
                           : graph.last_at_or_before_time(process, when);
  while (state && state->error && state->prev) state = state->prev;
  return state ? state : graph.head(process);
}

StateOf states_at(const Simulation& simulation, double when) {
  return [&simulation, when](BodyId id) -> const State& { return *state_at(simulation, id, when); };
}

PoseTwist point_at(const Simulation& simulation, BodyId id, double when) {
  return state_at(simulation, id, when)->trajectory().at(when);
}

double total_energy(const Simulation& simulation, double when) {
  double energy = 0;
  for (const auto& body : simulation.scene.bodies) {
    if (!body->dynamic()) continue;
    const PoseTwist p = point_at(simulation, body->id(), when);
    energy += kinetic_energy(*body, p) - body->mass * simulation.present.settings.gravity.dot(p.x);
    const State& state = *state_at(simulation, body->id(), when);
    if (state.forces) energy += state.forces->energy(when, p);
    for (const BondPtr& bond : bonds_of(state.forces))
      if (bond->a == body->id()) energy += bond->energy(p, point_at(simulation, bond->b, when));
  }
  for (const auto& multibody : simulation.scene.multibodies) {
    const State& state = *state_at(simulation, multibody->links.front(), when);
    energy += multibody::spring_energy(multibody->tree, joints_at(state, when)->q);
  }
  // what springs started with was given with the poses: it came from nowhere and counts for nothing
  energy -= simulation.present.counters.placed_energy;
  return energy + elastic_energy(simulation.scene, states_at(simulation, when), when);
}

Vec3 total_momentum(const Simulation& simulation, double when) {
  Vec3 sum = Vec3::Zero();
  for (const auto& body : simulation.scene.bodies)
    if (body->dynamic()) sum += body->mass * point_at(simulation, body->id(), when).v;
  return sum;
}

std::uint64_t state_hash(const Body& body, const Key& key, const PoseTwist& point,
                         const StateData& data) {
  const BodyState s = body_state(body, point);
  Hasher h;
  const auto add = [&h](auto word) { h.add(word); };
  add(std::uint64_t{body.id()});
  each_word(key, add);
  each_word(s.position, add);
  each_word(s.orientation, add);
  each_word(s.velocity, add);
  each_word(s.angular_velocity, add);
  for_each_field(data, [&](const char*, FieldUse use, const auto& field) {
    if constexpr (!std::is_same_v<decltype(field), const std::shared_ptr<Group>&>)
      if (use == FieldUse::history) each_word(field, add);
  });
  return h.value();
}

std::string history_hash(const Simulation& simulation) {
  const Present& present = simulation.present;
  std::uint64_t sum = present.history.sum;
  for (const auto& body : simulation.scene.bodies) {
    if (body->info.removed) continue;
    const State* state = state_at(simulation, body->id(), present.time);
    const Key end{present.time, 0, KeyKind::step, body->id()};
    sum += state_hash(*body, end, state->trajectory().at(present.time), *state);
  }
  std::string bytes;
  for (const std::uint64_t word : {sum, present.history.count})
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(word >> (8 * i) & 0xff);
  return sha256_hex(bytes);
}

}  // namespace tw
