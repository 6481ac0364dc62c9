// Joints of URDF files as those of multibodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "import/mending.h"
#include "import/urdf-file.h"
#include "multibody/tree.h"

namespace tw::urdf {

// What each joint of the model is, in the order of the model: where it is in its parent, its axis,
// limits, damping and effort, and whom it follows.  Joints whose limits leave them nothing are
// welds; of a planar joint it is the turn, of a floating one a free joint.  What is wrong in `file`
// but clear is mended.
//
// Errors: UserError with the line: an axis of 0 0 0, a follower that neither turns nor slides.
std::vector<multibody::JointSpec> joint_specs(const std::string& file, const Robot& model,
                                              Mending& mending);

}  // namespace tw::urdf
