// Who is joined to whom.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/joined.h"

#include "groups/before.h"
#include "multibody/multibody.h"

namespace tw {

const Multibody* multibody_of(const Scene& scene, ProcessId process) {
  return scene.body_of(process).multibody;
}

void add_joined(const Scene& scene, std::vector<ProcessId>& processes) {
  if (scene.multibodies.empty()) return;
  const std::vector<ProcessId> given = processes;
  const Multibody* last = nullptr;
  for (const ProcessId process : given) {
    const Multibody* multibody = multibody_of(scene, process);
    if (!multibody || multibody == last) continue;
    for (const BodyId link : multibody->links) insert(processes, scene.process_of(link));
    last = multibody;
  }
}

}  // namespace tw
