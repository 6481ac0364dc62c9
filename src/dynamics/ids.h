// Numbers of what a world holds: static, given once, parts of keys.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace tw {

// A rigid body: what has a shape, a pose and contacts.
using BodyId = std::uint32_t;
constexpr BodyId no_body = 0xffffffffu;

// Whatever owns a state queue (timeline/process.h).  A type of its own, so that nobody takes the
// number of a body for it.
enum class ProcessId : std::uint32_t {};

inline std::uint32_t number(ProcessId id) { return static_cast<std::uint32_t>(id); }
inline std::string show(ProcessId id) { return "process " + std::to_string(number(id)); }

}  // namespace tw
