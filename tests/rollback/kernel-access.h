// Access to the kernel's inside for its own tests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/kernel.h"

namespace tw {

// The bodies of its members, each a process of its own.
inline std::vector<BodyId> members_of(const Group& group) {
  std::vector<BodyId> bodies;
  for (const ProcessId member : group.members) bodies.push_back(number(member));
  return bodies;
}

// The friend that kernel.h names.
class KernelTest {
 public:
  explicit KernelTest(World& world) : kernel_(world.kernel()) {}

  // What a run does before its first event.
  void begin() { kernel_.begin_run(); }
  // Claims the body's next window.
  void claim(BodyId id) { kernel_.claim_window(*kernel_.scene.bodies[id]); }
  double claimed_time(BodyId id) const {
    return kernel_.process(*kernel_.scene.bodies[id]).claim.time;
  }
  // Claims and events up to the body's claimed time being at least `time`.
  void claim_up_to(BodyId id, double time) {
    while (claimed_time(id) < time) claim(id);
  }
  // The record of the pair; null if it is not active.
  const Pair* pair(BodyId a, BodyId b) const {
    const std::uint32_t index =
        kernel_.find_pair(*kernel_.scene.bodies[a], *kernel_.scene.bodies[b]);
    return index == no_pair ? nullptr : &kernel_.pairs[index];
  }
  // Processes the pair's pending impact now, whatever else is due.
  void process_impact(BodyId a, BodyId b) {
    kernel_.process_impact(kernel_.find_pair(*kernel_.scene.bodies[a], *kernel_.scene.bodies[b]));
  }
  void process_callback(std::uint32_t number) { kernel_.process_callback(number); }
  // Processes what is due up to `time`, least key first, and commits nothing.
  void run_uncommitted(double time) {
    while (!kernel_.queue.empty() && kernel_.queue.top_priority() <= time)
      kernel_.process_next();
  }
  // Removes the body's states from the key on, as a discontinuity found late would.
  std::size_t roll_back(BodyId id, const Key& key) {
    std::vector<Affected> affected;
    const std::size_t removed =
        kernel_.graph.rollback(kernel_.process_of(id), key, affected, kernel_.removal());
    kernel_.treat(affected);
    return removed;
  }
  // The body's states, earliest first.
  std::vector<const State*> states(BodyId id) const {
    std::vector<const State*> result;
    for (const State* s = kernel_.graph.head(kernel_.process_of(id)); s; s = s->next)
      result.push_back(s);
    return result;
  }
  const State& tail(BodyId id) const { return *kernel_.graph.tail(kernel_.process_of(id)); }
  std::size_t undelivered() const { return kernel_.undelivered_.size(); }
  // For breaking what validators look at.
  State& tail_of(BodyId id) { return *kernel_.graph.tail(kernel_.process_of(id)); }

 private:
  Kernel& kernel_;
};

}  // namespace tw
