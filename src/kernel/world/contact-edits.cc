// Contact parameters that are set.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/contact-edits.h"

#include <algorithm>
#include <vector>

#include "groups/group.h"
#include "kernel/loop/kernel.h"
#include "kernel/report/reading.h"

namespace tw {
namespace {

// What held between two.
struct Held {
  BodyId a, b;
  bool collide;
  ContactParameters parameters;

  bool changes(const Scene& scene) const {
    if (scene.may_collide(scene.body(a), scene.body(b)) != collide) return true;
    ContactParameters now = scene.contacts.between(a, b);
    now.collide = parameters.collide;
    now.collide_names_both = parameters.collide_names_both;
    return now != parameters;
  }
};

// Of all that touch, or may do so from now on.
std::vector<Held> held_so_far(const Kernel& kernel,
                              std::span<const std::pair<ContactSide, ContactSide>> sides,
                              const ContactSettings& settings) {
  const Simulation& simulation = kernel.simulation;
  const Scene& scene = simulation.scene;
  std::vector<std::pair<BodyId, BodyId>> pairs;
  for (const auto& body : scene.bodies) {
    if (!body->dynamic()) continue;
    const State& state = *state_at(simulation, body->id(), simulation.present.time);
    if (!state.group) continue;
    for (const std::uint32_t number : state.group->pairs_of(state.member)) {
      const std::uint64_t pair = state.group->pairs[number].id;
      pairs.emplace_back(first_of(pair), second_of(pair));
    }
  }
  // whom a rule forbids to collide is in contact or of no concern
  if (settings.collide.value_or(false) && scene.may_disable())
    for (const auto& [a, b] : sides) {
      const auto near = kernel.bodies.pairs_near(a, b);
      pairs.insert(pairs.end(), near.begin(), near.end());
    }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<Held> held;
  held.reserve(pairs.size());
  for (const auto& [a, b] : pairs)
    held.push_back(
        {a, b, scene.may_collide(scene.body(a), scene.body(b)), scene.contacts.between(a, b)});
  return held;
}

}  // namespace

void set_contact(Kernel& kernel, std::span<const std::pair<ContactSide, ContactSide>> sides,
                 const ContactSettings& settings) {
  Simulation& simulation = kernel.simulation;
  Scene& scene = simulation.scene;
  simulation.require_between_runs("contact parameters were set");
  const bool begun = simulation.present.begun;
  std::vector<Held> held;
  if (begun) held = held_so_far(kernel, sides, settings);

  const std::size_t rules = scene.contacts.rules().size();
  try {
    for (const auto& [a, b] : sides) scene.contacts.add(a, b, settings);
    std::erase_if(held, [&](const Held& pair) { return !pair.changes(scene); });
    for (const Held& pair : held)
      if (!pair.collide) kernel.bodies.check_enabled(scene.body(pair.a), scene.body(pair.b));
  } catch (...) {
    scene.contacts.take_back(rules);
    throw;
  }
  if (!begun) return;
  kernel.discontinuities.restart_future();
  std::vector<BodyId> concerned;
  for (const Held& pair : held) concerned.insert(concerned.end(), {pair.a, pair.b});
  kernel.editing.renew_groups(concerned);
}

}  // namespace tw
