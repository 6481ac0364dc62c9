// Access to the kernel's inside for its own tests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/check/validate.h"
#include "kernel/loop/kernel.h"
#include "kernel/report/reading.h"

namespace tw {

// The bodies of its members, each a process of its own.
inline std::vector<BodyId> members_of(const Group& group) {
  std::vector<BodyId> bodies;
  for (const ProcessId member : group.members) bodies.push_back(number(member));
  return bodies;
}

class KernelTest {
 public:
  explicit KernelTest(World& world) : kernel_(world.kernel()) {}

  // What a run does before its first event.
  void begin() { kernel_.begin_run(); }
  // Claims the body's next window.
  void claim(BodyId id) { kernel_.claims.claim_window(kernel_.simulation.body(id)); }
  double claimed_time(BodyId id) const {
    return kernel_.simulation.process(kernel_.simulation.body(id)).claim.time;
  }
  // Claims and events up to the body's claimed time being at least `time`.
  void claim_up_to(BodyId id, double time) {
    while (claimed_time(id) < time) claim(id);
  }
  // The record of the pair; null if it is not active.
  const Pair* pair(BodyId a, BodyId b) const {
    const std::uint32_t index = kernel_.pairs.find(a, b);
    return index == ActivePairs::none ? nullptr : &kernel_.pairs[index];
  }
  // Processes the pair's pending impact now, whatever else is due.
  void process_impact(BodyId a, BodyId b) {
    static_cast<void>(kernel_.impacts.process(kernel_.pairs.find(a, b)));
  }
  void process_callback(std::uint32_t number) {
    static_cast<void>(kernel_.callback_events.process(number));
  }
  // Processes what is due up to `time`, least key first, and commits nothing.
  void run_uncommitted(double time) {
    while (!kernel_.simulation.queue.empty() && kernel_.simulation.queue.top_priority() <= time)
      kernel_.process_next();
  }
  // Removes the body's states from the key on, as a discontinuity found late would.
  std::size_t roll_back(BodyId id, const Key& key) {
    return kernel_.discontinuities.roll_back(kernel_.simulation.process_of(id), key);
  }
  // The body's states, earliest first.
  std::vector<const State*> states(BodyId id) const {
    std::vector<const State*> result;
    for (const State* s = kernel_.simulation.graph.head(kernel_.simulation.process_of(id)); s;
         s = s->next)
      result.push_back(s);
    return result;
  }
  const State& tail(BodyId id) const {
    return *kernel_.simulation.graph.tail(kernel_.simulation.process_of(id));
  }
  std::string validate_event_queue() const {
    return tw::validate_event_queue(kernel_.simulation, kernel_.pairs, kernel_.callbacks);
  }
  std::size_t undelivered() const { return kernel_.delivery.undelivered(); }
  // For breaking what validators look at.
  State& tail_of(BodyId id) {
    return *kernel_.simulation.graph.tail(kernel_.simulation.process_of(id));
  }

 private:
  Kernel& kernel_;
};

}  // namespace tw
