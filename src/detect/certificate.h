// Certificates: until when two bodies are surely apart.
//
// For each pair of convex parts a plane is put midway between them, across the witness direction n,
// and moves with the mean of the witness points' velocity and the bodies' acceleration along n.  As
// long as every point of a part's core stays on its side, the parts are apart.  A core point r of a
// body in free flight has the height along n
//   h(s) <= h0 + n.(v + w x r) s + (n.a + (A + W^2) |r|) s^2 / 2
// with W and A bounds on |w| and |w'| over the arc; where w stays along n, |n x w| W stands in for
// W^2.  So the time until the plane may be reached is the least root of
// quadratics: close to the true impact time, and never after it.  Kinematic bodies are bounded by
// their speed, over a horizon.  Members of groups are bounded by the derivatives of their dense
// output, over one step.
//
// With an allowance the plane gives way by half of it to either side: bodies that slide past each
// other at touch are then apart for as long as they do.
//
// The certificate decides only where the next query is made, never the answer: warm simplices are
// allowed here.  What a warm query finds apart by no more than rounding the cold one may find at
// touch, so that is not surely apart.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "collision/distance/separation.h"
#include "detect/moving-body.h"
#include "detect/piece.h"
#include "geometry/part-tree.h"

namespace tw {

// Warm starts of the distance queries: of few pairs of parts one for each, of many those of the
// last ones.
class SimplexCaches {
 public:
  // That of the pair with this number, of so many.
  SimplexCache& of(std::size_t number, std::size_t pairs) {
    if (places_.empty()) places_.resize(std::min(pairs, most));
    Place& place = places_[number % places_.size()];
    if (place.number != number) place = {number, {}};
    return place.cache;
  }
  void clear() { places_.clear(); }

 private:
  static constexpr std::size_t most = 64;
  struct Place {
    std::size_t number = 0;
    SimplexCache cache;
  };
  std::vector<Place> places_;
};

// What a query of two bodies of one part each found at a time, s.
struct SeenApart {
  double when = never;
  Separation separation;
};

// The two bodies of a piece as seen at `when`, s.
class Certificates {
 public:
  // `seen`: need not be asked again if it was then; null: nothing was.
  Certificates(const Piece& piece, SimplexCaches& caches, double when,
               const SeenApart* seen = nullptr);

  // Until when the two are surely apart on the piece's arcs, s; -infinity: perhaps not at `when`.
  // Overlaps up to `allowance` (m) count as apart.
  double until(double allowance);
  // How deep the two were found to overlap, as a negative distance, m: the very number of the cold
  // query.  Nothing: they were not, or it is not known.
  std::optional<double> overlap() const;

 private:
  const Separation& separation(std::size_t part_a, std::size_t part_b);
  // Seconds until two parts may meet, or two balls or boxes around them; -never: perhaps they do.
  double parts_apart(std::size_t i, std::size_t j, double allowance);
  double boxes_apart(const ConvexPart& part, const PartTree::Node& node, bool of_b,
                     double allowance);
  double planes_apart(const ConvexPart& part, const ConvexPart& other, bool of_b, double allowance);
  void search(std::size_t few, const PartTree::Node& node, bool of_b, double allowance,
              double& least);
  // Either body's arc has steps.
  bool in_steps() const { return a_.step_end != never || b_.step_end != never; }
  template <class Bound>
  double longest(const Bound& bound);
  template <class Bound>
  double by_step(const Bound& bound);

  const Piece& piece_;
  SimplexCaches& caches_;
  double when_;
  MovingBody a_, b_;
  double rounding_;                            // less than this is perhaps not apart, m
  std::optional<MovingBody> step_a_, step_b_;  // within the present step of the integrator
  static constexpr std::size_t most_kept = 4;
  std::optional<Separation> kept_[most_kept];  // of the first pairs of parts
  std::optional<Separation> last_;             // of others
};

double certificate(const Piece& piece, SimplexCaches& caches, double when, double allowance,
                   const SeenApart* seen = nullptr);

// What rounding may make of no distance between two bodies with their centres there, m.
double distance_rounding(const Body& a, const Vec3& at_a, const Body& b, const Vec3& at_b);

}  // namespace tw
