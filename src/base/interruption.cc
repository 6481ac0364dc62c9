// Who is asked whether to go on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/interruption.h"

#include <utility>

namespace tw {
namespace {

thread_local InterruptionCheck::Ask asked = nullptr;

}  // namespace

InterruptionCheck::InterruptionCheck(Ask ask) : outer_(std::exchange(asked, ask)) {}

InterruptionCheck::~InterruptionCheck() { asked = outer_; }

void raise_if_interrupted() {
  if (asked) asked();
}

}  // namespace tw
