// How far the arc of a process is known.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/horizon.h"

#include "groups/ends/check-times.h"

namespace tw {
namespace {

// Checks and callbacks come before the impacts of their instant.
bool comes_first(const Key& key) {
  return key.kind == KeyKind::group_check || key.kind == KeyKind::callback;
}

}  // namespace

// Whether its arc ends at the time of the key, and the check that stands there comes first.
bool Horizon::own_check_before(ProcessId id, const Key& key) const {
  if (!sim_.body_of(id).dynamic()) return false;
  const State& tail = *sim_.graph.tail(id);
  if (tail.error || tail.arc_end() != key.time) return false;
  const Key check = end_key(tail, key.time);
  return tail.key < check && check < key;
}

bool Horizon::is_claimed(ProcessId id, const Key& key) const {
  const Body& body = sim_.body_of(id);
  if (body.fixed() || sim_.graph.tail(id)->error) return true;
  const Key& claim = sim_.process(body).claim;
  return comes_first(key) ? claim.time >= key.time : key < claim;
}

bool Horizon::is_known(ProcessId id, const Key& key) const {
  // its own check of this instant would be forgotten if its arc were changed by a greater key
  return !(comes_first(key) && own_check_before(id, key)) && is_claimed(id, key);
}

bool Horizon::may_be_shared(ProcessId id, const Before& before) const {
  const Group* group = before.state(id).group.get();
  return (!group || group->at_rest || group->arc->complete()) && is_known(id, before.key());
}

bool Horizon::may_be_read_beside(const State& state, const Key& key) const {
  const ProcessId process = state.process;
  if (sim_.body_of(process).fixed()) return true;
  return sim_.processes[number(process)].claimed_time() > key.time && !state.may_grow() &&
         sim_.graph.last_before(process, key) == &state;
}

bool Horizon::is_open(const State& state) {
  return state.may_grow() ||
         (state.group && !state.group->at_rest && !state.group->arc->complete());
}

}  // namespace tw
