// What a regrouping changed: for statistics and observers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regrouping.h"

namespace tw {

// Bodies that came apart, and those that left the ground alone.  `held`: which successors touch
// something.
void count_fissions(Regrouping& work, const std::vector<bool>& held);

// Which pairs went, which came: counted, and reported as fissions where bodies parted; who is
// squeezed; and how deep the others are.  After count_fissions.
void note_changes(Regrouping& work);

// Puts the tally and the report on the first state that enters the graph: once all is decided.
void add_report(Regrouping& work);

}  // namespace tw
