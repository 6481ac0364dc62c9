// Callbacks and observers that call Scheme procedures.
//
// A callback hands views to its procedure and kills them when it returns.  The error of a procedure
// is raised with the callback's name, its event's time and its bodies in the message.
// The procedure is kept alive by the world's table (types.h), not by these objects.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include "kernel/world/callback.h"
#include "kernel/world/world.h"
#include "script/live.h"
#include "script/types.h"

namespace tw {

// What every Scheme procedure of a world has in common.
struct Hook : Live<LiveKind::callback> {
  WorldBox* box = nullptr;
  SCM procedure = SCM_BOOL_F;
  const char* what = "callback";  // for messages
  Place place;
  bool timed = false;  // counts in callback_cpu_seconds
};

class ScmCallback : public Callback {
 public:
  ScmCallback(Hook hook, bool periodic) : hook_(std::move(hook)), periodic_(periodic) {}
  std::optional<double> run(double event_time, std::span<StateView* const> targets) override;

 private:
  Hook hook_;
  bool periodic_;
};

class ScmCollisionCallback : public CollisionCallback {
 public:
  explicit ScmCollisionCallback(Hook hook) : hook_(std::move(hook)) {}
  void run(const Collision& collision, bool reversed, StateView& a, StateView& b) override;

 private:
  Hook hook_;
};

// Hands (time index views) of each frame to a procedure; the views only look.
class ScmFrameObserver : public FrameSink {
 public:
  explicit ScmFrameObserver(Hook hook) : hook_(std::move(hook)) {}
  void frame(long index, double frame_time, std::span<const BodyPose> poses) override;

 private:
  Hook hook_;
};

}  // namespace tw
