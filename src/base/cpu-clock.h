// Clocks: CPU time of threads, and the wall clock.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Seconds of CPU time that the calling thread has used.
double thread_cpu_seconds();

// Seconds that the living threads of this process whose names begin with `prefix` have used, as
// far as the kernel tells (else 0).
double named_threads_cpu_seconds(const char* prefix);

// Seconds of a clock that never goes back, from an origin of its own.
double wall_seconds();

}  // namespace tw
