// Dips: overlaps that come and go between two points of the grid of checks.
//
// What is thin and fast may pass into the other and out of it again between two grid points.  Where
// the two can move by more than a share of the thinner one meanwhile, the stretch is looked at on a
// grid of its own, so fine that nothing gets deeper than that share unseen; certificates that allow
// for such a depth skip nearly all of its points.
//
// Cost: nothing for pairs that cannot move so far; else one certificate for each grid point that no
// certificate skips.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "detect/certificate.h"
#include "detect/piece.h"

namespace tw {

// The first point of the fine grid in (from, to) at which the two are deeper than a dip's share of
// the thinner one; `never`: none.  A function of the piece and the stretch alone.  `looks`: counts
// certificates.  May be given up (base/interruption.h).
double first_dip(const Piece& piece, SimplexCaches& caches, double from, double to,
                 std::uint64_t& looks);

}  // namespace tw
