// Images of states: every word of every field, with its name; to compare one moment with another.
//
// For test modes: what was undone must leave no trace, what is done again must be what it was.
// The fields are those of timeline/state-fields.h and groups/group-fields.h; a group's own stand
// with its first member.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/scene.h"
#include "timeline/state-graph.h"

namespace tw {

class StateImage {
 public:
  void add(const State& state);
  std::uint64_t checksum() const;
  // "\tFIELD=VALUE,VALUE..." for each field in turn.
  std::string text() const;
  // "velocity of ball-3: 1.0000001, before 1": the first field that differs from that of an image
  // made before; empty if none does.
  std::string first_difference(const Scene& scene, const StateImage& before) const;

 private:
  struct Word {
    const char* field;
    ProcessId process;
    bool real;  // the bits are those of a double
    std::uint64_t bits;

    bool operator==(const Word&) const = default;
    std::string value() const;
  };
  std::vector<Word> words_;
};

// Of one state, and of all that stand, in order.
std::uint64_t state_checksum(const State& state);
std::uint64_t graph_checksum(const StateGraph& graph);
// Of the latest states that one discontinuity made.
StateImage image_of_ring(const StateGraph& graph, const Key& key);

}  // namespace tw
