// How the two bodies of a piece stand to each other at one instant: apart, closing, pressed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/distance/separation.h"
#include "detect/piece.h"

namespace tw {

// The signed distance at `when`, by a cold query: a function of the piece and the time alone.
Separation separation_at(const Piece& piece, double when);
// The distance alone, with the same bits.
double distance_at(const Piece& piece, double when);
// How fast the nearest points of `s` close at `when`, m/s; 0 where that is rounding.
double closing_at(const Piece& piece, double when, const Separation& s);
// Whether the free accelerations at `when` press the two together, `normal` from a to b; what a
// group or the ground carries has none.
bool pressed_at(const Piece& piece, double when, const Vec3& normal);

}  // namespace tw
