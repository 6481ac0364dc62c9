// Robots as the Unified Robot Description Format has them: what becomes of a file.
//
// A link with a mass is a link, called as it is in the file, and its joint by its name.  What has
// none and is fixed to another is a part of that: its shapes go there.  Shapes are those of
// <collision>, a mesh its convex hull; a link that has <visual> alone is seen and touches nothing.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kernel/definitions.h"

namespace tw {

struct UrdfRobot {
  std::string name;
  std::vector<LinkDef> links;
  std::optional<BodyDef> stand;  // what is fixed to the base, in its frame; called as its link
  std::vector<std::string> untouchable;  // links that are to touch nothing
};

// `free`: the first link moves about, else it is welded to the base.  Errors: UserError that names
// file, line and element: what is no URDF, what multibodies cannot do (floating, planar and mimic
// joints), moving links without mass, missing meshes.
UrdfRobot read_urdf(const std::string& file, bool free);

}  // namespace tw
