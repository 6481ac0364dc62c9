// Keys of discontinuities: what "earlier" and "later" mean in the whole kernel.
//
// A key is (time, microstep, kind, id), compared lexicographically, built from static ids only:
// never from creation order, slots in memory or addresses.  So the order of discontinuities, and
// with it the committed history, is a function of the scene alone.
//
// Source: the committed history is *by definition* the one found by always processing the least
// key (doc/architecture.md).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <compare>
#include <cstdint>
#include <string>

#include "base/never.h"

namespace tw {

// In order of processing at one time and microstep.
enum class KeyKind : std::uint8_t {
  birth,
  step,
  early_edit,  // between runs, where what happens at that instant is still to come
  callback,
  edit,  // between runs, after what has happened at that instant, before what comes of other edits
  group_check,
  impact
};

const char* kind_name(KeyKind kind);
// Enters the history's hash: the same for ever, whatever kinds there are.
std::uint64_t kind_code(KeyKind kind);

struct Key {
  double time = 0;
  // 0 for birth, step, early_edit and callback; else 1 + the larger of those of the arcs that start
  // exactly at `time`, else 1.  (What was put in touch between runs touches in microstep 1; what is
  // set of it in the same pause comes before that.)
  std::uint32_t microstep = 0;
  KeyKind kind = KeyKind::birth;
  std::uint64_t id = 0;

  friend bool operator==(const Key&, const Key&) = default;
  friend bool operator<(const Key& a, const Key& b) {
    if (a.time != b.time) return a.time < b.time;
    if (a.microstep != b.microstep) return a.microstep < b.microstep;
    if (a.kind != b.kind) return a.kind < b.kind;
    return a.id < b.id;
  }
  friend bool operator>(const Key& a, const Key& b) { return b < a; }
  friend bool operator<=(const Key& a, const Key& b) { return !(b < a); }
  friend bool operator>=(const Key& a, const Key& b) { return !(a < b); }
};

inline bool is_edit(const Key& key) {
  return key.kind == KeyKind::edit || key.kind == KeyKind::early_edit;
}

// After every key.
inline constexpr Key last_key{never, 0xffffffffu, KeyKind::impact, ~0ull};

// The id of a pair: smaller body id above, larger below.
inline std::uint64_t pair_id(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
}

inline std::uint32_t first_of(std::uint64_t pair) { return static_cast<std::uint32_t>(pair >> 32); }
inline std::uint32_t second_of(std::uint64_t pair) { return static_cast<std::uint32_t>(pair); }

// "impact 3-17 at 1.25 s, microstep 1": for messages.
std::string show(const Key& key);

}  // namespace tw
