// The table of what is known: a line goes when its cause is mended.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/known-seeds.h"

#include <algorithm>

namespace tw::fuzz {
namespace {

const KnownFault table[] = {
    // beyond what make check-long runs
    {"drum", 17430, Fault::energy, 0.0026, "a cross of bars tumbles over a box's edge"},
    {"plates", 190, Fault::deep, 0.048, "a cone in the corner of a trough and a wall"},
    {"plates", 20145, Fault::deep, 0.041, "a cone in the corner of a trough and a wall"},
    {"thin", 5313, Fault::slow, 0.47, "discs of 1:1000 wobble under needles: steps of 0.1 us"},
    {"thin", 14032, Fault::slow, 0.8, "rods under a plate, which takes short steps once it rolls"},
    {"bonds", 79, Fault::slow, 0.27, "springs pull hulls into each other: 4100 blows"},
    {"bonds", 124, Fault::slow, 0.19, "a union of 10 g on a stiff spring turns at 1800 rad/s"},
    {"bonds", 148, Fault::slow, 0.18, "bodies on stiff springs without damping"},
    {"bonds", 234, Fault::slow, 0.23, "bodies on stiff springs without damping"},
    {"meshes", 2055, Fault::energy, 0.0049,
     "the rim of a cone without friction is 0.8 % deep in a crease before that is found"},
    {"pressed", 507, Fault::energy, 0.031, "a ball wanders over a box with 300 weights, by checks"},
    {"struck", 3, Fault::slow, 0.63, "thin links whirl about themselves in joints with friction"},
    {"struck", 38, Fault::slow, 0.28, "thin links whirl about themselves in joints with friction"},
    {"struck", 233, Fault::slow, 0.77, "thin links whirl about themselves in joints with friction"},
    {"struck", 238, Fault::slow, 0.17, "thin links whirl about themselves in joints with friction"},
    {"struck", 188, Fault::slow, 0.27,
     "a light body is held between two that are 200 times as dense"},
};

const MendedSeed mended[] = {
    {"seam", 51, "a tile that ends in a wall's plane took the wall away"},
    {"bullet", 63, "a spinning disc rolled on a wall by an impact a grid point, without gravity"},
    {"ramp", 223, "the foot of a ramp took the floor away"},
    {"heap", 196, "a corner at the foot of a wall"},
    {"lattice", 183, "drums in touch along a line were looked at at every grid point"},
    {"cards", 278, "an edge along another one was cut far beyond its end"},
    {"groove", 360, "the edge at the end of a slope, beyond a box, was taken for one deep in it"},
    {"ramp", 46, "a rim that touched a face to rounding was found as deep as the plate is thick"},
    {"bullet", 945, "a rim that touched a face to rounding was found as deep as the wall is thick"},
    {"cards", 474, "a corner under a tilted face pressed along its own face: sinking as it slid"},
    {"lattice", 3417, "what got deeper while its witness points parted was looked at for ever"},
    {"shaker", 1910, "in the crease between the ball and the bar of a dumbbell nothing held"},
    {"lattice", 267, "a warm query found what touched apart by its last digit: another history",
     true},
    {"cards", 1090, "a piece cut before it was looked at had another root than one cut later",
     true},
    {"lattice", 1289, "an arc found again under its old key was not looked at from its start",
     true},
    {"thin", 115, "pivots of a rod's rows were chosen in SI units"},
    {"thin", 17, "where rods cross a fixed point missed the gap, and arcs ended for it"},
    {"shaker", 146, "between the slabs of a shaken room the energy rose by 0.8 %"},
    {"round", 29, "a contact that slid from its birth held 99 times the energy of its cone"},
    {"seam", 5424, "a union leaned over its tiles' edge, and that was taken for a slot's"},
    {"stack", 7967,
     "a point that came to a face which bore a load pressed ten times as hard as the others"},
    {"thin", 451, "steps of coins of 1:100 at accuracy 1e-4 gained energy as they rolled"},
    {"shaker", 20, "boxes between slabs: certificates knew nothing of the slabs but their speed"},
    {"thin", 7833, "a coin over a plate that turned was looked at a million times a second"},
    {"lattice", 6811,
     "drums that slid over a wall without gravity were looked at every microsecond"},
    {"shaker", 5436, "of a room that flew at 13 m/s certificates knew its speed alone"},
    {"shaker", 5496, "a rim's point on a rod ran away, and the contact thought itself 2.5 cm deep"},
    {"thin", 5193, "a turn of a rod about its own axis counted as if it were as thick as long"},
    {"thin", 773, "a coin came down on a rod on the floor by thousands of impacts"},
    {"cards", 6034, "two cards met edge along edge in one point and turned through each other"},
    {"spin", 10098, "a contact was carried along after its ball had turned by half a turn"},
    {"lattice", 6028, "what spun upright on a wall was looked at every microsecond"},
    {"shaker", 6756, "the walls of a room were as soft as the room is wide"},
    {"piston", 10031, "a cylinder that whirled on its rim at accuracy 1e-4 gained energy"},
    {"heap", 330, "a heap without friction at accuracy 1e-4 gained energy"},
    {"called", 110, "a callback that grips was called no more after a commit in a group", true},
    {"called", 103, "of a small cart and what it drove on equations were solved in SI units"},
    {"chains", 123, "a joint came to lean on a stop that it had passed unseen"},
    {"shaker", 14049,
     "work was not counted on arcs whose first state was committed before their end"},
    {"drum", 560,
     "a ball jammed between drum and end wall hung on friction as soft as for its weight"},
    {"drum", 6080,
     "a ball that friction jams where its normals are not opposite was not told squeezed"},
    {"bonds", 22, "bodies swung on stiff springs by the implicit method"},
    {"called", 16053, "a callback turned a held body back within a step that was far too long"},
    {"round", 19270,
     "a rim over which a cone lay was followed where it crossed it last, not deepest"},
    {"plates", 90, "a spike's edge lay in the slit between two plates, held by one check in two"},
    {"shaker", 19546, "a rod was on an edge that it crossed beyond the edge's end"},
    {"lattice", 19553, "faces that lay on each other to rounding were not apart by a plane"},
    {"lattice", 19035,
     "the same, and bodies that turn about the normal of a face they are next to"},
    {"drum", 16086, "a cylinder was squeezed by 9 %, a point of it left and the others held more"},
    {"drum", 19759, "the same of a hull, which gained 11 %"},
    {"stack", 16122, "a cylinder toppled over its rim, and points left it while it was pressed"},
    {"hills", 87, "a body that rocked on a height field gained 1.9 %"},
    {"plates", 20248, "a tip pressed into the wall where a slit ends fell into the slit"},
    {"corner", 475, "a tip left a room by the corner of three walls"},
    {"corner", 797, "a tip left a room by the corner of three walls"},
    {"corner", 764, "a tip slid into a slit that leans in under the floor"},
    {"corner", 2265, "a tip slid into a slit that leans in under the floor"},
    {"corner", 2512, "a tip left a room where two walls that end at a slant meet"},
    {"hills", 21288, "a tip was on the wall beneath the crest that ends a valley"},
    {"cards", 28212,
     "what touched to its last digits was apart on a piece that was cut: another history", true},
    {"round", 25349, "of what friction held in a blow a tenth was counted as energy"},
    {"chains", 21212, "in weak gravity stops were thousands of times too stiff"},
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
