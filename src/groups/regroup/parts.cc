// Parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/parts.h"

#include "groups/joints/joined.h"
#include "groups/rest/rest.h"

namespace tw {
namespace {

// The successors with new arcs that hang together by contact pairs, those that rest apart from the
// others, or that are joined.
Components hang_together(const Regrouping& work, const Contacts& contacts,
                         const std::vector<bool>& rests) {
  Components together(work.successors.size());
  for (const ContactPair& pair : contacts.pairs) {
    const Successor *a = work.successor_of(pair.a()), *b = work.successor_of(pair.b());
    if (!work.changes(a) || !work.changes(b)) continue;
    if (const std::size_t i = work.place_of(a), j = work.place_of(b); rests[i] == rests[j])
      together.join(i, j);
  }
  visit_joined(work, [&](std::size_t i, std::size_t j) { together.join(i, j); });
  return together;
}

}  // namespace

Parts parts_of(const Regrouping& work, const Contacts& contacts) {
  const std::size_t count = work.successors.size();
  std::vector<bool> touching(count, false), rests(count, false);
  for (const ContactPair& pair : contacts.pairs)
    for (const BodyId id : {pair.a(), pair.b()})
      if (const Successor* member = work.successor_of(id); work.changes(member))
        touching[work.place_of(member)] = true;
  std::vector<bool> held = touching;
  std::vector<Stillness> stillness(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Successor& successor = work.successors[i];
    // what is joined never parts
    if (is_in_group(successor) && work.changes(&successor)) held[i] = true;
    if (held[i]) stillness[i] = stillness_of(work, successor, touching[i]);
  }
  Components together = hang_together(work, contacts, rests);
  if (work.cause() == Cause::check) {
    rests = who_rests(work, contacts, {touching, stillness}, together);
    together = hang_together(work, contacts, rests);
  }
  return {std::move(touching), std::move(held), std::move(stillness), std::move(rests),
          std::move(together)};
}

}  // namespace tw
