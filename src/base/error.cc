// Errors with causes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/error.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace tw {

std::string Place::text() const {
  if (!known()) return "";
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

std::string show(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, end.ptr);
}

void assertion_failed(const char* invariant, const char* file, int line,
                      const std::string& details) {
  std::fprintf(stderr, "timewarp: internal error: invariant broken: %s\n  %s\n  at %s:%d\n",
               invariant, details.c_str(), file, line);
  std::fflush(stderr);
  std::abort();
}

}  // namespace tw
