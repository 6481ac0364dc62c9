// What a check finds as it was foreseen.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/foreseen.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace tw {

bool is_foreseen(const NewContact& fresh, const ContactForce& followed, BodyId reference,
                 double size) {
  const double gap_off = std::abs(followed.gap - fresh.gap);
  return reference == fresh.tag.reference &&
         gap_off <= answer::foreseen_gap * fresh.contact.law.gap_scale() &&
         (followed.point - fresh.point).norm() <= answer::foreseen_way * size &&
         (followed.normal - fresh.normal).norm() <= answer::foreseen_way;
}

int doublings_of(const Regrouping& work, const Contacts& contacts, const Parts& parts,
                 const Group& group, const Group& before) {
  // whether what is slow has stopped is decided by what checks see of it
  const auto is_watched = [&](ProcessId member) {
    return parts.stillness[work.place_of(work.successor_of(member))].since != never;
  };
  if (std::any_of(group.members.begin(), group.members.end(), is_watched)) return 0;
  // what a callback changes goes on, as far as its contacts are concerned
  if (work.cause() == Cause::callback) return before.doublings;
  if (work.cause() != Cause::check || before.at_rest || group.has_border || before.has_border ||
      group.pairs.size() != before.pairs.size())
    return 0;
  // an arc that ended early
  if (before.ended_early()) return 0;
  for (std::size_t i = 0; i < group.pairs.size(); ++i) {
    const ContactPair &now = group.pairs[i], &then = before.pairs[i];
    if (now.id != then.id || now.count != then.count) return 0;
    for (std::uint32_t c = now.first; c < now.first + now.count; ++c)
      if (!contacts.all[c].foreseen) return 0;
  }
  // steps that are cut short by checks have errors far below their tolerance: so it stays
  const double whole = answer::most_step_change * (work.now() - before.arc->start().time);
  const double step = before.arc->next_step();
  if (step >= whole) return std::min(before.doublings + 1, answer::most_halvings);
  return step >= 0.5 * whole ? before.doublings : std::max(before.doublings - 1, 0);
}

}  // namespace tw
