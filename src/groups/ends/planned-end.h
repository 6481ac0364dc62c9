// The planned end of a group's arc: when its contacts are to be looked at again, and why not later.
//
// A table (planned-end.cc): some reasons bound how long the arc lasts, and the shortest of these
// intervals is laid on the lattice of checks (check-times.h); others name an instant.  The first of
// all is the end.  A function of the regrouping and of the group that was there before.
//
// Source: doc/architecture.md, "When an arc ends".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/contacts/contacts.h"

namespace tw {

struct EndPlan {
  ArcEnd end;
  double patience = never;  // how long an arc may be worth making, s; of the next arc's plan, too
};

// Of a group whose members, pairs, border and doublings are set, and whether it rests.
struct PlannedGroup {
  const Regrouping& work;
  const Contacts& contacts;
  const Group& group;
  const Group* before;  // the group of these very members that was there; null: there was none
  double border_end = never;  // until when all at its border know where they go, s
};

EndPlan plan_end(const PlannedGroup& planned);

// Of a multibody that touches nothing, just born.
ArcEnd plan_birth_end(const Scene& scene, const Multibody& multibody, double now);

}  // namespace tw
