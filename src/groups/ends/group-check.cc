// Group checks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/group-check.h"

#include <algorithm>

#include "base/constants.h"
#include "groups/ends/check-times.h"

namespace tw {

std::vector<ProcessId> family(const Before& before, const std::shared_ptr<Group>& group,
                              Groups* parts) {
  const Scene& scene = before.scene();
  const Key& key = before.key();
  Groups groups{group};
  std::vector<ProcessId> all;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::vector<ProcessId> there = before.remaining(*groups[i]);
    all.insert(all.end(), there.begin(), there.end());
    for (const ContactPair& pair : groups[i]->pairs) {
      if (!scene.body(pair.a()).dynamic() || !scene.body(pair.b()).dynamic()) continue;
      // seen from either side, or two checks of one time would take each other back: so pairs of
      // those that have left do not count
      const State &a = before.state_of(pair.a()), &b = before.state_of(pair.b());
      if (a.group != groups[i] && b.group != groups[i]) continue;
      const Group* owner = owner_of(a, b).get();
      if (!owner || !owner->find(pair.id)) continue;
      for (const State* state : {&a, &b}) {
        if (!state->group || state->group == groups[i] || state->error ||
            state->group->next_check() != group->next_check())
          continue;
        if (group_check_key(*state->group, key.time).microstep != key.microstep) continue;
        add_once(groups, state->group);
      }
    }
  }
  std::sort(all.begin(), all.end());
  if (parts) *parts = std::move(groups);
  return all;
}

std::vector<ProcessId> early_members(const Before& before, const Group& group) {
  std::vector<ProcessId> all;
  for (std::uint32_t i = 0; i < group.members.size(); ++i) {
    if (group.end_of(i).time != before.key().time) continue;
    const State& state = before.state(group.members[i]);
    if (state.group.get() == &group && !state.error) all.push_back(group.members[i]);
  }
  return all;
}

namespace {

std::string names_of(const Scene& scene, const Group& group) {
  std::string all;
  constexpr std::size_t most_names = 8;
  for (std::size_t i = 0; i < std::min(most_names, group.members.size()); ++i)
    all += (i ? ", " : "") + scene.body_of(group.members[i]).info.name;
  if (group.members.size() > most_names)
    all += " and " + std::to_string(group.members.size() - most_names) + " more";
  return all;
}

}  // namespace

std::string standstill_of(const Scene& scene, const Group& group, double when) {
  return "time stands still at " + show(when) + " s: the contact group of " +
         names_of(scene, group) + " changed " + std::to_string(guard::most_microsteps) +
         " times at that instant, which is a fault of the program; another --group-check-rate or "
         "--accuracy may get past it";
}

std::string failure_of(const Scene& scene, const Group& group) {
  std::string where;
  if (const int c = group.arc->failed_contact(); c >= 0) {
    const ContactTag& tag = group.tags[static_cast<std::size_t>(c)];
    where = ", at the contact of " + scene.body(tag.reference).info.name + " and " +
            scene.body(tag.other).info.name;
  }
  return "the contact group of " + names_of(scene, group) + " cannot be followed past " +
         show(group.arc->reached()) + " s: " + group.arc->failure() + where +
         "; expected finite forces (look at #:stiffness, #:damping and the masses)";
}

}  // namespace tw
