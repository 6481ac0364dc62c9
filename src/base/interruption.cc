// Who is asked whether to go on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/interruption.h"

#include <utility>

namespace tw {
namespace {

thread_local InterruptionCheck::Ask asked = nullptr;
thread_local std::exception_ptr put_off;

}  // namespace

InterruptionCheck::InterruptionCheck(Ask ask) : outer_(std::exchange(asked, ask)) {}

InterruptionCheck::~InterruptionCheck() {
  asked = outer_;
  if (!asked) put_off = nullptr;
}

void raise_if_interrupted() {
  if (put_off) std::rethrow_exception(std::exchange(put_off, nullptr));
  if (asked) asked();
}

bool is_interrupted() {
  try {
    raise_if_interrupted();
  } catch (...) {
    put_off = std::current_exception();
  }
  return put_off != nullptr;
}

}  // namespace tw
