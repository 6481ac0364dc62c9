// Test mode: every committed state as text, to find where two schedules part.
//
// One run writes a line a state, in the order of its commits; another one, under another schedule,
// is compared with it as it commits, and stops at the least key whose state differs.  The lines of
// one process stand in the order of their keys in every run; those of different processes need not.
//
// A line: time, process, body, then FIELD=VALUE,... for every field of the state and, with its
// first member, of its group (timeline/state-fields.h, groups/group-fields.h); separated by tabs,
// doubles with all their digits.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/scene.h"
#include "timeline/state-graph.h"

namespace tw {

class StateTrace {
 public:
  // `write` and `compare`: the files, "" for none.
  // Errors: UserError with the file and the system's reason.
  StateTrace(const Scene& scene, const std::string& write, const std::string& compare);
  ~StateTrace();
  StateTrace(const StateTrace&) = delete;
  StateTrace& operator=(const StateTrace&) = delete;

  void add(const State& state);
  // All before `limit` (at it, too, if inclusive) has been added.
  // Errors: UserError that names the first difference: its time, body, field, and both values.
  void check(double limit, bool inclusive);

 private:
  struct Difference {
    double time = 0;
    std::string text;
  };
  using Lines = std::deque<std::string>;

  void read(const std::string& path);
  void note(double time, std::string text);
  Lines& lines_of(ProcessId process);

  const Scene& scene_;
  std::FILE* out_ = nullptr;
  std::string compared_;         // the other run's file, "" for none
  std::vector<Lines> expected_;  // by process: what the other run committed, and is still to come
  std::optional<Difference> first_;
};

}  // namespace tw
