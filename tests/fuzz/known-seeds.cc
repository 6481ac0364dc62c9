// The table of what is known: a line goes when its cause is mended.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/known-seeds.h"

#include <algorithm>

namespace tw::fuzz {
namespace {

const KnownFault table[] = {
    {"thin", 17, Fault::slow, 0, "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    // from 30 on: make check-long; what they look like, the causes were not looked into
    {"cards", 82, Fault::energy, 0.011, "a point of a card far deeper than the card is thick"},
    {"thin", 87, Fault::slow, 0, "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    {"shaker", 146, Fault::energy, 0.0083, "between the slabs of a shaken room"},
    {"cards", 152, Fault::energy, 0.12, "a point of a card far deeper than the card is thick"},
    {"shaker", 188, Fault::slow, 0, "many short arcs"},
    {"cards", 194, Fault::energy, 0.0023, "a point of a card far deeper than the card is thick"},
    {"thin", 199, Fault::energy, 0.015,
     "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    {"thin", 199, Fault::slow, 0, "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    {"cards", 278, Fault::energy, 4.7, "a point of a card far deeper than the card is thick"},
};

const MendedSeed mended[] = {
    {"seam", 51, "a tile that ends in a wall's plane took the wall away"},
    {"bullet", 63, "a spinning disc rolled on a wall by an impact a grid point, without gravity"},
    {"ramp", 223, "the foot of a ramp took the floor away"},
    {"heap", 196, "a corner at the foot of a wall"},
    {"lattice", 183, "drums in touch along a line were looked at at every grid point"},
    {"thin", 115, "pivots of a rod's rows were chosen in SI units"},
};

}  // namespace

std::span<const KnownFault> known_faults() { return table; }
std::span<const MendedSeed> mended_seeds() { return mended; }

bool known_fault(const DescribedScene& scene, Fault fault) {
  return std::any_of(std::begin(table), std::end(table), [&](const KnownFault& known) {
    return known.kind == scene.kind && known.seed == scene.seed && known.fault == fault;
  });
}

}  // namespace tw::fuzz
