// The table of kinds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/generator.h"

#include "base/error.h"
#include "fuzz/draft.h"
#include "fuzz/kinds.h"

namespace tw::fuzz {
namespace {

constexpr Kind table[] = {
    {"heap", "boxes, balls, cylinders, hulls, rocks and unions fall into a pit", draw_heap},
    {"lattice", "equal bodies in exact touch, in rows and grids, at rest or hit by one",
     draw_lattice},
    {"stack", "stacks of unlike masses, up to a million to one", draw_stack},
    {"thin", "rods, plates and coins of 1:100 to 1:1000 fall into a pit", draw_thin},
    {"piston", "a lid comes down on bodies in a pit and goes up again", draw_piston},
    {"drum", "bodies in a turning drum of staves", draw_drum},
    {"shaker", "bodies in a closed room that is shaken, turned and swung", draw_shaker},
    {"bullet", "bodies at 3 to 300 sqrt(g size) in a room with walls of 1 to 3 % of its width",
     draw_bullet},
    {"spin", "bodies that spin at 1 to 100 sqrt(g/size) fall into a pit", draw_spin},
    {"seam", "bodies slide, roll and fall on abutting tiles", draw_seam},
    {"groove", "bodies and spikes fall into a groove whose bottom edge is a seam", draw_groove},
    {"arch", "an arch is hit by a block", draw_arch},
    {"cards", "a card house is hit by a block", draw_cards},
    {"ramp", "bodies slide and roll down a ramp, along the floor, against a wall", draw_ramp},
    {"round", "capsules, cones, ellipsoids and cylinders among others fall into a pit", draw_round},
    {"hills", "bodies fall and roll on a height field between four walls", draw_hills},
    {"rolls", "what is round falls into a pit, where rolling and spinning are resisted",
     draw_rolls},
};

// Which the seeds take in turn; the others are asked for by name, so that what is known of a seed
// stays its own.
constexpr std::size_t in_turn = 15;

}  // namespace

std::span<const Kind> kinds() { return table; }

DescribedScene random_scene(const std::string& kind, std::uint64_t seed) {
  for (const Kind& k : table)
    if (kind == k.name) {
      Draft draft(kind, seed);
      k.draw(draft);
      return draft.scene;
    }
  throw UserError("kind is " + kind + "; expected one that --help lists");
}

std::string kind_of_seed(std::uint64_t seed) { return table[seed % in_turn].name; }

}  // namespace tw::fuzz
