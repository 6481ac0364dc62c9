// Who is joined to whom.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/joints/joined.h"

#include "multibody/multibody.h"

namespace tw {

void add_joined(const Before& before, std::vector<ProcessId>& processes) {
  const Scene& scene = before.scene();
  std::vector<ProcessId> next;
  const auto joins = [&](ProcessId process) {
    return scene.body_of(process).multibody || !bonds_of(before.state(process).forces).empty();
  };
  for (const ProcessId process : processes)
    if (joins(process)) next.push_back(process);
  const auto add = [&](BodyId id) {
    const ProcessId process = scene.process_of(id);
    if (holds(processes, process)) return;
    insert(processes, process);
    next.push_back(process);
  };
  // links come in rows
  const Multibody* last = nullptr;
  while (!next.empty()) {
    const ProcessId process = next.back();
    next.pop_back();
    const Body& body = scene.body_of(process);
    if (body.multibody && body.multibody != last)
      for (const BodyId link : body.multibody->links) add(link);
    if (body.multibody) last = body.multibody;
    for (const BondPtr& bond : bonds_of(before.state(process).forces)) add(bond->other(body.id()));
  }
}

bool is_in_group(const Successor& successor) {
  return successor.body->multibody || needs_group(successor.data.forces);
}

}  // namespace tw
