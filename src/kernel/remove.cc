// Removing a body between runs.
//
// Numbers of bodies are parts of keys and places in lists, so a removed body stays as what touches
// nothing: fixed where it was last, without a shape, in no box, no list and no sum.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "integrate/standing.h"
#include "kernel/kernel.h"

namespace tw {

void Kernel::remove_body(BodyId id) {
  require_between_runs("a body was removed");
  Body& body = *bodies[id];
  TW_REQUIRE(!body.info.removed,
             "body " + body.info.name + " was removed before; expected one that is there");
  const BodyState last = body_state(body, point_at(id, time));
  body.info.removed = true;
  if (begun) restart_future();

  // whoever touches it gets arcs without it
  edit_together(
      [&](BodyId other) {
        const State& state = *graph.last_before(process_of(other), present_key());
        if (!state.group || state.error) return false;
        const auto in_contact = state.group->pairs_of(state.member);
        return std::any_of(in_contact.begin(), in_contact.end(), [&](std::uint32_t number) {
          const std::uint64_t pair = state.group->pairs[number].id;
          return first_of(pair) == id || second_of(pair) == id;
        });
      },
      [](Successor&) {});

  for (std::size_t number = 0; number < callbacks.size(); ++number) {
    CallbackRecord& callback = callbacks[number];
    if (std::count(callback.def.targets.begin(), callback.def.targets.end(), id) == 0) continue;
    callback.ended = true;
    schedule_callback(static_cast<std::uint32_t>(number));
  }
  while (!body.pairs.empty()) drop_pair(body.pairs.back());
  queue.withdraw(process(body).advance);
  queue.withdraw(process(body).group_check);
  if (grid.contains(id)) grid.remove(id);
  std::erase(unbounded, id);
  std::erase(kinematic, id);
  std::erase(newborn_, id);
  names.erase(body.info.name);

  // its last arc counts up to the present
  if (body.dynamic()) {
    graph.free_before(graph.tail(process_of(id)), release());
    const State& tail = *graph.tail(process_of(id));
    counters.kinematic_work += contact_work(tail, time);
    counters.integration_length += time - tail.arc_time;
  }
  graph.clear(process_of(id));
  body.info.kind = BodyKind::fixed;
  body.info.shape = nullptr;
  body.info.visible = false;
  body.shape_P = nullptr;
  body.unbounded = body.is_fixed_plane = body.placed = false;
  body.X_BP = body.X_PB = Pose();
  body.motion = make_standing({last.position, last.orientation});
  State* state = graph.append(body.process, {time, 0, KeyKind::birth, id});
  state->arc_key = state->key;
  state->arc_time = time;
  state->follows = body.motion;
  state->committed = begun;
  process(body).claim = begun ? last_key : state->key;
  ++removals_;
}

}  // namespace tw
