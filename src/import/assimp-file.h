// Files that Assimp reads, in a process with bounds (bounded-process.h).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

struct aiScene;
namespace Assimp {
class Importer;
}

namespace tw {

// What `take` makes of the scene, its transforms applied, as bytes.  `prepare` sets what the
// importer is to do, beside that: the steps of its postprocessing are returned.  Axes are the
// file's own. Memory: a gigabyte and a hundred times the size of the file; time: two minutes.
//
// Errors: UserError, with the file's name, where it is missing, is no mesh, or cannot be read
// within the bounds, and those of `take`.
std::vector<char> read_with_assimp(const std::string& file,
                                   const std::function<unsigned(Assimp::Importer&)>& prepare,
                                   const std::function<std::vector<char>(const aiScene&)>& take);

}  // namespace tw
