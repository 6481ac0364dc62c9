// The table of what is known: a line goes when its cause is mended.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/known-seeds.h"

#include <algorithm>

namespace tw::fuzz {
namespace {

const KnownFault table[] = {
    {"thin", 17, Fault::slow, 0, "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    // from 30 on: make check-long; what they look like, the causes were not looked into
    {"thin", 87, Fault::slow, 0, "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    {"lattice", 127, Fault::slow, 0, "drums in touch along a line or end to end"},
    {"shaker", 146, Fault::energy, 0.0082, "between the slabs of a shaken room"},
    {"heap", 196, Fault::energy, 0.27, "a corner at the foot of a wall, or a fusion"},
    {"thin", 199, Fault::energy, 0.0052,
     "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    {"thin", 199, Fault::slow, 0, "a rod or plate of 1:100 or thinner: an arc that hardly goes on"},
    {"bullet", 273, Fault::slow, 0, "a fast body sinks into a thin wall between two checks"},
    {"stack", 296, Fault::slow, 0, "a fall on unlike masses"},
};

const MendedSeed mended[] = {
    {"seam", 51, "a tile that ends in a wall's plane took the wall away"},
    {"bullet", 63, "a spinning disc rolled on a wall by an impact a grid point, without gravity"},
    {"ramp", 223, "the foot of a ramp took the floor away"},
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
