// CPU time of threads, from the clock and from /proc/self/task.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/cpu-clock.h"

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

namespace tw {

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double named_threads_cpu_seconds(const char* prefix) {
  double nanoseconds = 0;
  std::error_code error;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", error)) {
    std::string name;
    std::ifstream(thread.path() / "comm") >> name;
    if (!name.starts_with(prefix)) continue;
    // the first number is the time on a processor
    double ran = 0;
    std::ifstream(thread.path() / "schedstat") >> ran;
    nanoseconds += ran;
  }
  return 1e-9 * nanoseconds;
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace tw
