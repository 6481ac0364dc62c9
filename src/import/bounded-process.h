// Work that must not take the machine: done by a process of its own, with bounds of memory and
// time.
//
// Libraries that read files of others may run wild on a file that one byte is wrong in, or stop;
// then the process ends, not the program.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tw {

struct Bounds {
  std::uint64_t memory = 0;  // bytes, beyond what the program has
  unsigned seconds = 0;      // of CPU time
  // for messages: "a.dae takes WORKER more than 9 s; expected EXPECTED"
  std::string worker = "the library that reads it", expected = "a file that is whole";
};

// What `work` returns, of bytes that the process writes back.  `what` is done, for messages: "the
// mesh a.dae".  It is given up where this thread is (base/interruption.h).  Errors: UserError,
// those of the work, or that it needs more than its bounds, or was ended by a signal.
std::vector<char> done_within(const Bounds& bounds, const std::string& what,
                              const std::function<std::vector<char>()>& work);

}  // namespace tw
