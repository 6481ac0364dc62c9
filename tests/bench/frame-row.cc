// Rows of the table of moving-rocks.sh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "frame-row.h"

#include <chrono>
#include <cstdio>

namespace tw::bench {

void print(const FrameRow& row) {
  std::printf("| %s | %s | %.1f | %.1f | %.1f | %.2f | %d | %.0e |\n", row.scene.c_str(),
              row.engine.c_str(), 1e3 * row.cpu, 1e3 * row.helpers, 1e3 * row.wall, 1e3 * row.depth,
              row.lost, row.rise);
  std::fflush(stdout);
}

double wall_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

std::string scene_name(const std::string& file) {
  const std::string name = file.substr(file.find_last_of('/') + 1);
  return name.substr(0, name.find('.'));
}

}  // namespace tw::bench
