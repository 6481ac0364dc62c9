// Parts: who hangs together with whom from a discontinuity on, and who comes to rest.
//
// Fixed and kinematic bodies, and those at the border, hold nothing together; what sleeps and what
// is awake are parts of their own.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/components.h"
#include "groups/contacts/contacts.h"

namespace tw {

// Of the successors, by their places; of those with new arcs only.
struct Parts {
  std::vector<bool> touching;        // who is in contact with anything
  std::vector<bool> held;            // who is in a group: these, and what is joined
  std::vector<Stillness> stillness;  // of who is held
  std::vector<bool> rests;           // who comes to rest
  Components together;
};

// `contacts`: sorted.
Parts parts_of(const Regrouping& work, const Contacts& contacts);

}  // namespace tw
