// Every field of a group that its members' later motion depends on, once, by name (the list of a
// state's fields: timeline/state-fields.h).  What follows from these is not listed: who has which
// contact pair, and whether the ends were looked for.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/group.h"
#include "timeline/field-words.h"
#include "timeline/state-fields.h"

namespace tw {

template <class Visit>
void for_each_field(const Group& group, Visit&& visit) {
  using enum FieldUse;
  visit("key of the group", motion, group.key);
  visit("members", motion, group.members);
  visit("when it was placed", motion, group.placed_at);
  visit("next check", motion, group.next_check());
  std::vector<double> ends;
  for (std::uint32_t i = 0; i < group.members.size(); ++i) ends.push_back(group.end_of(i).time);
  visit("ends", motion, ends);
  visit("rest", motion, group.at_rest);
  visit("stillness", motion, group.stillness);
  visit("first step", motion, group.first_step);
  visit("patience", motion, group.patience);
  visit("doublings", motion, group.doublings);
  visit("range of masses", motion, group.masses);
  visit("outside bodies", motion, group.outside);
  visit("border", motion, group.has_border);
  visit("contact pairs", motion, group.pairs);
  visit("contact tags", motion, group.tags);
  visit("gaps", motion, group.gaps);
  visit("contacts", motion, group.arc->start().contacts);
}

template <class Put>
void each_word(const Stillness& stillness, Put&& put) {
  for (const double number :
       {stillness.since, stillness.length, stillness.early_peak, stillness.late_peak})
    put(number);
  each_word(stillness.x, put);
  each_word(stillness.q, put);
}
template <class Put>
void each_word(const MassRange& masses, Put&& put) {
  put(masses.lightest);
  put(masses.heaviest);
}
template <class Put>
void each_word(const ContactPair& pair, Put&& put) {
  put(pair.id);
  put(std::uint64_t{pair.first} << 33 | std::uint64_t{pair.count} << 1 |
      std::uint64_t{pair.has_borne_load});
  each_word(pair.masses, put);
}
template <class Put>
void each_word(const ContactTag& tag, Put&& put) {
  put(pair_id(tag.reference, tag.other));
  put(static_cast<std::uint64_t>(tag.parts));
  put(tag.feature);
  put(tag.flatness);
  put(tag.beyond);
}
template <class Put>
void each_word(const GroupContact& contact, Put&& put) {
  put(contact.offset);
  put(contact.share);
  each_word(contact.stretch, put);
  each_word(contact.bend, put);
}

}  // namespace tw
