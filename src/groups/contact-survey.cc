// Reading the contacts of all groups at one instant.
//
// A link may stand in two groups: in that of a region that a blow gave new arcs, and in that of
// those who keep theirs.  One of them has the say (governing); only its contacts count, as in
// total_energy.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "kernel/kernel.h"

namespace tw {

namespace {

// Turned so that body1 < body2.
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
  return reading;
}

}  // namespace

ContactSurvey Kernel::survey_contacts(double when) const {
  ContactSurvey survey;
  const auto group_of = [&](BodyId id) { return state_at(id, when)->group.get(); };
  for (const auto& body : bodies) {
    if (!body->dynamic()) continue;
    const Group* group = group_of(body->id());
    if (!group) continue;
    survey.bodies_at_rest += group->at_rest;
    // each group once: with the first of its members that is still in it
    const auto first = std::find_if(group->members.begin(), group->members.end(),
                                    [&](BodyId id) { return group_of(id) == group; });
    if (*first != body->id()) continue;
    ++survey.groups;
    const double arc_time = group->contact_time(when);
    for (const ContactPair& pair : group->pairs) {
      const State* a = state_at(first_of(pair.id), when);
      const State* b = state_at(second_of(pair.id), when);
      if (owner_of(*a, *b) != group) continue;
      for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
        survey.contacts.push_back(
            reading_of(group->tags[c], group->arc->contact_force(static_cast<int>(c), arc_time)));
    }
  }
  std::stable_sort(survey.contacts.begin(), survey.contacts.end(),
                   [](const ContactReading& x, const ContactReading& y) {
                     return std::pair(x.body1, x.body2) < std::pair(y.body1, y.body2);
                   });
  return survey;
}

// Of moving groups: what rests is as deep as it was when it came to rest.
double Kernel::deepest_contact(double when) const {
  double depth = 0;
  for (const auto& body : bodies) {
    if (!body->dynamic()) continue;
    const State& state = *state_at(body->id(), when);
    if (!state.group || state.group->at_rest) continue;
    const Group& group = *state.group;
    for (const std::uint32_t number : group.pairs_of(state.member)) {
      const ContactPair& pair = group.pairs[number];
      // from the member that was added first
      const BodyId other = first_of(pair.id) == body->id() ? second_of(pair.id) : first_of(pair.id);
      if (other < body->id() && group.contains(other) &&
          state_at(other, when)->group.get() == &group)
        continue;
      for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
        depth = std::max(depth, -group.arc->contact_force(static_cast<int>(c), when).gap);
    }
  }
  return depth;
}

}  // namespace tw
