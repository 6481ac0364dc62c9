// The adversary scheduler: events are taken out of order, which makes rollbacks common.
//
// Each event, or each event of some bodies, gets a random head start: it is taken as if it were
// that much earlier.  The committed history must not change.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "base/hash.h"
#include "base/random.h"
#include "kernel/world/options.h"
#include "timeline/event-queue.h"
#include "timeline/process.h"

namespace tw {

class Adversary {
 public:
  // Before the first run.
  void begin(const AdversaryOptions& options) {
    options_ = options;
    random_ = Random(mix64(options.seed + 1));
  }
  // Head starts of some processes, for good.
  void choose(std::vector<Process>& processes) {
    for (Process& process : processes)
      if (options_.some_bodies && random_.real() < options_.body_share)
        process.head_start = options_.head_start * random_.real();
  }
  // The event of a subject with this head start of its own, s.
  Event event(const Key& key, EventKind kind, std::uint32_t subject, double head_start) {
    double priority = key.time - head_start;
    if (options_.every_event) priority -= options_.head_start * random_.real();
    return {priority, key, kind, subject};
  }

 private:
  AdversaryOptions options_;
  Random random_{0};
};

}  // namespace tw
