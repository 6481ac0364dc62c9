// What a regrouping changed: for statistics and observers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regroup/parts.h"

namespace tw {

// Which pairs went, which came: counted, and told as fissions where bodies parted, or left the
// ground alone; who is squeezed (noted in the successors), and how deep the others are.  `contacts`
// and `parts`: from here on.
Told tell_changes(const Regrouping& work, const Contacts& contacts, const Parts& parts);

// Puts what is told on the first state that enters the graph: once all is decided.
void put_on_first(std::vector<Successor>& successors, const Told& told);

}  // namespace tw
