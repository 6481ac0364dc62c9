// When the arc of a contact group ends, and why.
//
// An arc has two ends.  The *planned* one is known when the arc is made: the least over a table of
// what each reason allows (groups/ends/planned-end.cc).  The *found* one is known once the arc has
// been integrated that far: it is the planned one, or earlier where the arc stops telling the truth
// (groups/ends/end-test.h).  A discontinuity may cut the arc short of both; who counts why arcs
// ended names that, too.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/never.h"

namespace tw {

enum class EndReason : std::uint8_t {
  // planned
  rest,      // it has no end: what rests waits for somebody to touch it
  motion,    // its contacts may be other ones: a member has moved by a share of its size
  tied,      // its members touch nothing, and hang together by joints, springs or holds
  push,      // overlaps are pushed apart, which goes by checks
  patience,  // blow followed on blow: what lies beyond the next one would be made in vain
  border,    // the arc of somebody at its border is known no further
  call,      // a callback is about to be handed a member
  due,       // the check that was due before its members got this arc
  corner,    // the velocity of a multibody's base jumps
  // found
  steps,    // as many steps as an arc may have
  unseen,   // a feature came down that no contact represents
  phantom,  // a contact claims a depth that is not there
  fast,     // an open contact closed faster than its spring is meant for
  stop,     // a joint got to one of its stops
  // cut short
  impact,
  callback,
  edit,
  neighbour  // its member was taken in by a check of others
};

// By number: what statistics call them.
inline constexpr std::array end_names{
    "rest",  "motion", "tied",    "push", "patience", "border", "call",     "due",  "corner",
    "steps", "unseen", "phantom", "fast", "stop",     "impact", "callback", "edit", "neighbour"};

struct ArcEnd {
  double time = never;  // s
  EndReason reason = EndReason::rest;

  friend bool operator==(const ArcEnd&, const ArcEnd&) = default;
};

// The earlier one; of two at one time the first.
inline ArcEnd earlier(const ArcEnd& x, const ArcEnd& y) { return y.time < x.time ? y : x; }

// How many arcs ended for which reason.
struct EndCounts {
  std::array<std::uint64_t, end_names.size()> of{};

  void note(EndReason reason) { ++of[static_cast<std::size_t>(reason)]; }
  // The name of the most frequent one.
  const char* most_frequent() const {
    return end_names[static_cast<std::size_t>(std::max_element(of.begin(), of.end()) - of.begin())];
  }
  void add(const EndCounts& other) {
    for (std::size_t i = 0; i < of.size(); ++i) of[i] += other.of[i];
  }
};

}  // namespace tw
