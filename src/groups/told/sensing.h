// What acts on one body at one instant, and how that accelerates it: what sensors read.
//
// All follows from the body's own state and the time, as its motion does: from the right side of
// the equations that its arc is integrated from, taken where the arc is.  Nothing but that state is
// looked at, so that what a callback reads of it stands and falls with the state:
// of two that touch across the border of a region each knows the contact as its own arc has it.
//
// What passes through a joint follows from how all links are accelerated; what a spring or a hold
// pulls with from where its two ends are, which the arc of the one knows, too.
//
// At the time of a discontinuity it is what was before: an impulse is no force.  At rest nothing
// accelerates, and contacts are those that it came to rest on.
//
// Frames: world; the centre of mass where no point is named.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "dynamics/scene.h"
#include "groups/told/contact-survey.h"
#include "timeline/state.h"

namespace tw {

struct SensedMotion {
  BodyState body;                            // the frame of the user's
  PoseTwist point;                           // of the centre of mass
  Vec3 acceleration = Vec3::Zero();          // of the centre of mass, m/s^2
  Vec3 angular_acceleration = Vec3::Zero();  // rad/s^2
  Vec3 gravity = Vec3::Zero();               // m/s^2

  // What an accelerometer feels that is fixed at a point of the body frame: its acceleration less
  // gravity's, in the world frame.
  Vec3 proper_acceleration(const Vec3& at) const;
};

SensedMotion sense_motion(const Scene& scene, const Body& body, const State& state, double when);

// Those of a dynamic body, as its own arc has them; none where it is isolated.
std::vector<ContactReading> contacts_of(const Body& body, const State& state, double when);

// What passes through the joint of a link, on that, about the origin of its frame.  `body`,
// `state`: of any link of its multibody.  UserError for a free first link, which no joint carries.
Wrench sense_joint(const Body& body, const State& state, int link, double when);

enum class PullKind { springs, holds };

// What the springs, or the hold, between it and another body do to a dynamic body: the force, and
// the torque that a hold resists turning by, about the point at which it holds; 0 where there are
// none.
Wrench sense_pull(const Body& body, const State& state, BodyId other, PullKind kind, double when);

}  // namespace tw
