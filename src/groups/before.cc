// What stands before a key.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/before.h"

#include <algorithm>

#include "groups/joints/joined.h"

namespace tw {

const std::shared_ptr<Group>& owner_of(const State& a, const State& b) {
  // of one discontinuity: the one that moves
  if (a.arc_key == b.arc_key) return (a.group && !a.group->at_rest ? a : b).group;
  return (a.arc_key < b.arc_key ? b : a).group;
}

const std::shared_ptr<Group>& owner_of(const Body& body_a, const State& a, const Body& body_b,
                                       const State& b) {
  if (!body_b.dynamic()) return a.group;
  if (!body_a.dynamic()) return b.group;
  return owner_of(a, b);
}

PlacedBody Before::placed(BodyId id) const {
  const Body& body = scene_.body(id);
  return PlacedBody(body, state_of(id).trajectory().at(key_.time));
}

Before::Owned Before::owned(std::uint64_t pair) const {
  const BodyId a = first_of(pair), b = second_of(pair);
  const std::shared_ptr<Group>& owner =
      owner_of(scene_.body(a), state_of(a), scene_.body(b), state_of(b));
  return {owner, owner ? owner->find(pair) : nullptr};
}

std::vector<ProcessId> Before::remaining(const Group& group) const {
  std::vector<ProcessId> result;
  result.reserve(group.members.size());
  for (const ProcessId member : group.members)
    if (const State& s = state(member); s.group.get() == &group && !s.error)
      result.push_back(member);
  return result;
}

std::vector<ProcessId> Before::hanging_together(ProcessId process) const {
  std::vector<ProcessId> all{process};
  add_joined(*this, all);
  std::vector<ProcessId> next = all;
  while (!next.empty()) {
    std::vector<ProcessId> found;
    visit_contacts(next, [&](const Group&, const ContactPair&, BodyId other) {
      const ProcessId theirs = scene_.process_of(other);
      if (!holds(all, theirs)) insert(found, theirs);
    });
    add_joined(*this, found);
    std::erase_if(found, [&](ProcessId other) { return holds(all, other); });
    for (const ProcessId other : found) insert(all, other);
    next = std::move(found);
  }
  return all;
}

void insert(std::vector<ProcessId>& processes, ProcessId process) {
  const auto at = std::lower_bound(processes.begin(), processes.end(), process);
  if (at == processes.end() || *at != process) processes.insert(at, process);
}

bool holds(const std::vector<ProcessId>& processes, ProcessId process) {
  return std::binary_search(processes.begin(), processes.end(), process);
}

}  // namespace tw
