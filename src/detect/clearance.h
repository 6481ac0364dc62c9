// Clearance: whether a pair is surely apart for a whole window, by how far it is apart and how far
// its bodies can come towards each other.
//
// In a heap most neighbours never touch and hardly move: a distance once measured, less what both
// have travelled since, keeps answering for many windows without another query.  What is remembered
// decides only whether to look, never the answer.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>

#include "detect/certificate.h"
#include "detect/travels.h"

namespace tw {

// Known to be at least `distance` apart from `from` to `until`, m and s.
struct Clearance {
  double distance = 0, from = 0, until = -never;

  // What follows from `time` on has changed.
  void forget_from(double time) { until = time < from ? -never : std::min(until, time); }
};

// Whether the two are surely apart over [from, to] on the piece's arcs; cheaper than a certificate.
// `seen`: what a query at `from` found is left there, where the two have one part each.
bool apart_throughout(const Piece& piece, Clearance& known, SimplexCaches& caches, double from,
                      double to, const Travels& travels = {}, SeenApart* seen = nullptr);

}  // namespace tw
