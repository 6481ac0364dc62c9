// Every field of a state, once, by name: one list for all who must not forget one.
//
// Who reads it: the hash of the committed history, the checksums of test modes, and the comparison
// that names the first field that differs.  What follows from the others is not listed: the place
// in the graph, and what is kept beside an arc's start to evaluate it.  The list of a group's
// fields is groups/group-fields.h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "timeline/state.h"

namespace tw {

// What a field is for.
enum class FieldUse : std::uint8_t {
  history,  // enters the hash of the committed history as it is (motion enters it evaluated)
  motion,   // what later motion depends on
  told      // what this discontinuity tells observers and statistics
};

// Calls visit(name, use, field) for each; `Data`: StateData or State, const or not.
template <class Data, class Visit>
void for_each_field(Data& data, Visit&& visit) requires std::is_base_of_v<StateData, Data> {
  using enum FieldUse;
  if constexpr (requires { data.key; }) visit("key", motion, data.key);
  visit("error", motion, data.error);
  visit("position", motion, data.x);
  visit("attitude", motion, data.q);
  visit("velocity", motion, data.v);
  visit("angular momentum", motion, data.L);
  visit("force", motion, data.force);
  visit("acceleration", motion, data.acceleration);
  visit("forces", motion, data.forces);
  visit("start of the arc", motion, data.arc_time);
  visit("key of the arc", motion, data.arc_key);
  visit("slots", history, data.slots);
  visit("random numbers", motion, data.random);
  visit("run of impacts", motion, data.impacts);
  visit("next callback", motion, data.next_callback);
  visit("place in the group", motion, data.member);
  visit("joints", motion, data.joints);
  visit("group", motion, data.group);
  visit("whether it changed", told, data.changed);
  visit("report", told, data.report);
  visit("tally", told, data.tally);
  visit("squeezed since", told, data.squeezed_since);
}

}  // namespace tw
