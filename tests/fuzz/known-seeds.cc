// The table of what is known: a line goes when its cause is mended.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/known-seeds.h"

#include <algorithm>

namespace tw::fuzz {
namespace {

const KnownFault table[] = {
    {"heap", 0, Fault::deep, 0.077, "a wall that stands on the ground does not hold a corner"},
    {"piston", 4, Fault::hash, 0, "a head start of some bodies changes the history"},
    {"groove", 10, Fault::energy, 0, "a spike between two bodies that share an edge: early ends"},
    {"groove", 10, Fault::slow, 0, "the same"},
    {"thin", 17, Fault::deep, 0, "a rod of 1:400 in a plate of 1:200"},
    {"thin", 17, Fault::energy, 0, "the same"},
    {"thin", 17, Fault::slow, 0, "the same"},
    {"lattice", 29, Fault::energy, 6.7e4, "a contact of two lying cylinders is two widths deep"},
    {"lattice", 29, Fault::slow, 0, "the same"},
    {"shaker", 20, Fault::slow, 0, "at the bound"},
};

}  // namespace

std::span<const KnownFault> known_faults() { return table; }

bool known_fault(const DescribedScene& scene, Fault fault) {
  return std::any_of(std::begin(table), std::end(table), [&](const KnownFault& known) {
    return known.kind == scene.kind && known.seed == scene.seed && known.fault == fault;
  });
}

}  // namespace tw::fuzz
