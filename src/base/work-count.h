// What a thread has done, for statistics: helpers of a loop (parallel.h) hand theirs to whoever
// called it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

struct WorkCount {
  unsigned long long distance_queries = 0;
  double helper_seconds = 0;  // of CPU, of helpers at items

  void add(const WorkCount& other) {
    distance_queries += other.distance_queries;
    helper_seconds += other.helper_seconds;
  }
  WorkCount since(const WorkCount& before) const {
    return {distance_queries - before.distance_queries, helper_seconds - before.helper_seconds};
  }
};

inline constinit thread_local WorkCount work_count;

}  // namespace tw
