// Policies: how the main loop goes forward.
//
// A policy decides what is processed next; arcs, checks, rollback, GVT and commit are shared.  It
// is an object chosen at run time, so that one program can compare them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

namespace tw {

class Kernel;

class Policy {
 public:
  virtual ~Policy() = default;
  virtual const char* name() const = 0;
  // One step of the loop.  Called only while something is left to do before the run's end.
  virtual void go_forward(Kernel& kernel) = 0;
};

// "timewarp": the event with the least priority, each body at its own time.  Errors: UserError for
// any other name.
std::unique_ptr<Policy> make_policy(const std::string& name);

}  // namespace tw
