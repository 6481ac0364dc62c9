// Writing files that are either whole or not there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tw {

// Writes the bytes to `path`.part and renames it to `path`; after an error the part is gone and a
// file that was at `path` before is untouched.  What is not a regular file (a device, a pipe) is
// written to directly.  Raises UserError naming the file and the reason.
void write_whole_file(const std::string& path, const std::vector<std::uint8_t>& bytes);

// A device, a pipe or the like: there already, and nothing to be renamed to.
bool is_special_file(const std::string& path);

// Makes the folder, and those above it, where they are not there yet; "" is the current one.
// Raises UserError where that fails, or where one may not write into it.
void make_writable_folder(const std::string& folder);

// The folder part of a path: "" where it has none.
std::string folder_of(const std::string& path);

}  // namespace tw
