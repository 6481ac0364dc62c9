// Marks a simulation as running, and adds up its CPU time, delivery to sinks excluded.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "base/cpu-clock.h"
#include "kernel/loop/simulation.h"

namespace tw {

class RunGuard {
 public:
  explicit RunGuard(Simulation& simulation)
      : sim_(simulation),
        cpu_(thread_cpu_seconds()),
        output_(simulation.present.counters.output_cpu_seconds),
        scope_(team_of(simulation)) {
    sim_.running = true;
  }
  ~RunGuard() {
    sim_.running = false;
    Counters& counters = sim_.present.counters;
    counters.cpu_seconds += thread_cpu_seconds() - cpu_ - (counters.output_cpu_seconds - output_);
  }
  RunGuard(const RunGuard&) = delete;
  RunGuard& operator=(const RunGuard&) = delete;

 private:
  static Team* team_of(Simulation& simulation) {
    const int threads = simulation.threads();
    if (threads < 2 || simulation.calls_out) return nullptr;
    if (!simulation.team) simulation.team = std::make_unique<Team>(threads);
    return simulation.team.get();
  }

  Simulation& sim_;
  double cpu_, output_;
  Team::Scope scope_;
};

}  // namespace tw
