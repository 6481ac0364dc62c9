// The second hardening of what presses: of contacts, stops of joints and holds.
//
// A spring made for a weight bears millions of weights within a few of its depths.  With dl its
// limit, from which it is linear again, and s = (d/dl - 0.6)/0.4 between 0 and 1,
//   f = k d (1 + ... + H s^4),   H k dl = answer::firm_weights weights.
// What presses by its own weight, or strikes, stays below 0.6 dl, where nothing is added.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

struct SecondHardening {
  double limit = 0;     // dl, in the units of the depth
  double firmness = 0;  // H; 0: none

  // Of a spring that one weight bends by `sag`.
  static SecondHardening of(double limit, double sag);
  // s
  double part(double depth) const;
  // H s^4, and its derivative by the depth; at dl that from within.
  double hardness(double depth) const;
  double slope(double depth) const;
  // The derivative of d H s^4, beyond dl that at dl: what holds along the surface keeps up with how
  // steeply the force rises, or what is wedged slips out before friction holds it.
  double grip(double depth) const;
  // The integral of d H s^4.
  double energy(double depth) const;

 private:
  double slope_there(double depth) const;  // that of dl beyond it
};

}  // namespace tw
