// Reading the contacts of all groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/told/contact-survey.h"

#include <algorithm>
#include <set>

#include "groups/before.h"

namespace tw {

ContactReading reading_of(const ContactTag& tag, const ContactForce& force) {
  ContactReading reading;
  const bool turned = tag.other < tag.reference;
  const double sign = turned ? -1 : 1;
  reading.body1 = turned ? tag.other : tag.reference;
  reading.body2 = turned ? tag.reference : tag.other;
  reading.point = force.point;
  reading.normal = sign * force.normal;
  reading.gap = force.gap;
  reading.force = force.normal_force;
  reading.friction = sign * force.friction;
  reading.slipping = force.slipping;
  reading.torque = sign * force.torque;
  return reading;
}

namespace {

bool owns(const Scene& scene, const StateOf& state_of, const Group& group,
          const ContactPair& pair) {
  return owner_of(scene.body(pair.a()), state_of(pair.a()), scene.body(pair.b()),
                  state_of(pair.b()))
             .get() == &group;
}

}  // namespace

ContactSurvey survey_contacts(const Scene& scene, const StateOf& state_of, double when) {
  ContactSurvey survey;
  const auto group_of = [&](BodyId id) { return state_of(id).group.get(); };
  for (const auto& body : scene.bodies) {
    if (!body->dynamic()) continue;
    const Group* group = group_of(body->id());
    if (!group) continue;
    survey.bodies_at_rest += group->at_rest;
    // each group once: with the first of its members that is still in it
    const auto first = std::find_if(
        group->members.begin(), group->members.end(),
        [&](ProcessId member) { return group_of(scene.body_of(member).id()) == group; });
    if (*first != body->process) continue;
    ++survey.groups;
    for (const ContactPair& pair : group->pairs) {
      if (!owns(scene, state_of, *group, pair)) continue;
      each_contact(pair, [&](std::uint32_t c) {
        survey.contacts.push_back(reading_of(group->tags[c], group->contact_at(c, when)));
      });
    }
  }
  std::stable_sort(survey.contacts.begin(), survey.contacts.end(),
                   [](const ContactReading& x, const ContactReading& y) {
                     return std::pair(x.body1, x.body2) < std::pair(y.body1, y.body2);
                   });
  return survey;
}

double elastic_energy(const Scene& scene, const StateOf& state_of, double when) {
  const auto by_key = [](const Group* x, const Group* y) {
    return x->key < y->key || (x->key == y->key && x->members < y->members);
  };
  std::set<const Group*, decltype(by_key)> groups(by_key);
  for (const auto& body : scene.bodies)
    if (body->dynamic())
      if (const Group* group = state_of(body->id()).group.get()) groups.insert(group);
  double energy = 0;
  for (const Group* group : groups) {
    std::vector<bool> counted(group->tags.size(), false);
    for (const ContactPair& pair : group->pairs)
      if (owns(scene, state_of, *group, pair))
        std::fill_n(counted.begin() + pair.first, pair.count, true);
    energy += group->arc->elastic_energy(group->contact_time(when), counted);
  }
  return energy;
}

double deepest_contact(const Scene& scene, const StateOf& state_of, double when) {
  double depth = 0;
  for (const auto& body : scene.bodies) {
    if (!body->dynamic()) continue;
    const State& state = state_of(body->id());
    if (!state.group || state.group->at_rest || state.squeezed_since < never) continue;
    const Group& group = *state.group;
    for (const std::uint32_t number : group.pairs_of(state.member)) {
      const ContactPair& pair = group.pairs[number];
      // from the member that was added first
      const BodyId other = pair.other(body->id());
      if (other < body->id() && group.contains(scene.process_of(other)) &&
          state_of(other).group.get() == &group)
        continue;
      if (scene.body(other).dynamic() && state_of(other).squeezed_since < never) continue;
      each_contact(
          pair, [&](std::uint32_t c) { depth = std::max(depth, -group.contact_at(c, when).gap); });
    }
  }
  return depth;
}

double contact_work(const Scene& scene, const State& state, double until) {
  if (!state.group || state.group->at_rest || state.error) return 0;
  const Group& group = *state.group;
  const BodyId self = scene.body_of(state.process).id();
  std::vector<WorkingContact> all;
  bool any = false;
  for (const std::uint32_t number : group.pairs_of(state.member)) {
    const ContactPair& pair = group.pairs[number];
    const bool counts = scene.body(pair.other(self)).kinematic();
    any = any || (counts && pair.count > 0);
    each_contact(pair, [&](std::uint32_t c) { all.push_back({static_cast<int>(c), counts}); });
  }
  if (!any) return 0;
  return group.arc->work_on(static_cast<int>(state.member), all,
                            std::max(group.arc->start().time, state.key.time),
                            std::min(until, state.trajectory().end()));
}

}  // namespace tw
