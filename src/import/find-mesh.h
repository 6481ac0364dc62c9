// Where a mesh of a URDF file lies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace tw {

// `name` as it stands in the URDF file `file`.  package://NAME/REST, or model://NAME/REST, is, the
// first that is there:
//   P/NAME/REST, and P/REST where P itself is called NAME, of each folder P of `packages`,
//   F/NAME/REST of each folder F above the file, then F/REST,
//   P/NAME/REST and P/REST of each folder P of ROS_PACKAGE_PATH;
// other names, file:// before them or not, are taken from the file's folder.  Capitals of the last
// part need not be right.  What is nowhere is returned as it is written.
std::string find_mesh(const std::string& name, const std::string& file,
                      const std::vector<std::string>& packages);

}  // namespace tw
