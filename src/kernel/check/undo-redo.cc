// Test mode: every discontinuity is taken back once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/check/undo-redo.h"

#include "base/hash.h"
#include "kernel/loop/simulation.h"
#include "timeline/field-words.h"

namespace tw {

std::uint64_t UndoRedo::name_of(const Key& key) const {
  Hasher name;
  each_word(key, [&](auto word) { name.add(word); });
  for (const Process& process : sim_.processes)
    if (const State* s = sim_.graph.tail(process.id); s->key == key && s->prev)
      name.add(state_checksum(*s->prev));
  return name.value();
}

bool UndoRedo::redone(const Key& key) {
  // what GVT has passed will not be found again
  const double gvt = sim_.present.gvt;
  std::erase_if(undone_, [&](const auto& undone) { return undone.second.time < gvt; });
  StateImage now = image_of_ring(sim_.graph, key);
  const std::uint64_t name = name_of(key);
  const auto known = undone_.find(name);
  if (known == undone_.end()) {
    undone_[name] = {key.time, std::move(now)};
    return false;
  }
  const std::string difference = now.first_difference(sim_.scene, known->second.image);
  TW_ASSERT(difference.empty(), "redoing " + show(key) + " gave another " + difference);
  undone_.erase(known);
  return true;
}

void UndoRedo::require_no_trace(const Key& key, std::uint64_t checksum_before) const {
  TW_ASSERT(graph_checksum(sim_.graph) == checksum_before,
            "undoing " + show(key) + " left a trace");
}

}  // namespace tw
