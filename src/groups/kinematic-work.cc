// The work that kinematic bodies do through contacts: with that of impulses (impact.cc, pass-on.cc)
// what an energy balance needs.
//
// Of a member's contacts with kinematic bodies, over the stretch that it followed the arc.  Nothing
// is computed in worlds without kinematic bodies, nor in groups that touch none.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "kernel/kernel.h"

namespace tw {

// Done on the body of `state` along its arc until `until`, J.
double Kernel::contact_work(const State& state, double until) const {
  if (kinematic.empty() || !state.group || state.group->at_rest || state.error) return 0;
  const Group& group = *state.group;
  std::vector<WorkingContact> all;
  bool any = false;
  for (const std::uint32_t number : group.pairs_of(state.member)) {
    const ContactPair& pair = group.pairs[number];
    const BodyId other =
        first_of(pair.id) == body_of(state.process).id() ? second_of(pair.id) : first_of(pair.id);
    const bool counts = bodies[other]->info.kind == BodyKind::kinematic;
    any = any || (counts && pair.count > 0);
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
      all.push_back({static_cast<int>(c), counts});
  }
  if (!any) return 0;
  return group.arc->work_on(static_cast<int>(state.member), all, group.arc->start().time,
                            std::min(until, state.trajectory().end()));
}

}  // namespace tw
