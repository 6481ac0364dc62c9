// Robots as the Unified Robot Description Format has them: what becomes of a file.
//
// A link with a mass, or one that a joint moves, is a link, and its joint is called by its own
// name. What has no mass and is fixed to another is a part of that: its shapes go there; what is
// fixed to a base that stands is scenery.  Shapes are those of <collision>, a mesh its convex hull;
// a link that has <visual> alone is seen and touches nothing.
//
// <mimic> makes a joint that follows another (multibody/couplings.h); limits of both are the
// leader's.
//
// What files have wrong is mended where it is clear what they mean, and told:
//   <inertia> that no body has    the nearest one that a body has; that of the shapes, where a
//                                 moment is missing or not positive, or where it is missing
//   a mass of 0 that moves        a thousandth of the robot's
//   limits that are equal         the joint is locked there, as at 0 and 0 where none are given
//   limits in the wrong order,    none
//   or no <limit>
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/mending.h"
#include "kernel/world/definitions.h"

namespace tw {

enum class UrdfBase { automatic, fixed, free };

struct UrdfOptions {
  // automatic: a robot without joints that move is free, others stand.
  UrdfBase base = UrdfBase::automatic;
  std::vector<std::string> packages;  // folders where package:// is looked for
};

struct UrdfRobot {
  std::string name;
  bool free = false;
  std::vector<LinkDef> links;    // none: it is scenery
  std::optional<BodyDef> stand;  // what is fixed to the base, in its frame; named as its link
};

// Errors: UserError that names file, line and element: what cannot be read, what multibodies cannot
// do, meshes that are missing.
UrdfRobot read_urdf(const std::string& file, const UrdfOptions& options, Mending& mending);

}  // namespace tw
