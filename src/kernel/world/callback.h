// Interfaces that the kernel hands out: callbacks (may change states), observers (only look) and
// frame sinks.  script/ and record/ implement them; the kernel knows no Guile and no OpenGL.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/interruption.h"
#include "dynamics/body.h"
#include "dynamics/forces.h"
#include "groups/told/sensing.h"
#include "multibody/multibody.h"
#include "timeline/collision.h"
#include "timeline/slots.h"

namespace tw {

struct HoldDef;

// What a callback is handed for each target: reads at the event's time, writes into the state that
// follows.  Lives only during the call.
class StateView {
 public:
  virtual ~StateView() = default;
  virtual BodyId body() const = 0;
  virtual const BodyState& state() const = 0;
  virtual double kinetic_energy() const = 0;
  virtual const Vec3& applied_force() const = 0;  // N, world, at the centre of mass
  virtual Vec3 applied_torque() const = 0;        // N m, world
  virtual const SlotsPtr& slots() const = 0;
  // How it is accelerated, and the contacts that it has, on the motion that leads to the event:
  // what sensors read.
  virtual SensedMotion sensed_motion() const {
    throw UserError("this view has no sensors; expected one that a callback is handed");
  }
  virtual std::vector<ContactReading> contacts() const {
    throw UserError("this view knows no contacts; expected one that a callback is handed");
  }
  // What springs or the hold to another body do to it, N, N m; what passes through the joint of a
  // link of its multibody: as above.
  virtual Wrench pull(BodyId /*other*/, PullKind /*kind*/) const {
    throw UserError("this view knows no springs or holds; expected one that a callback is handed");
  }
  virtual Wrench joint_load(int /*link*/) const {
    throw UserError("this view knows no joints; expected one that a callback is handed");
  }
  // Of a link: its multibody and how the joints stand, and when, s; null of other bodies.
  virtual const Multibody* multibody() const { return nullptr; }
  virtual const MultibodyState* joints() const { return nullptr; }
  virtual double joints_time() const { return 0; }

  // Errors: UserError where the body cannot do it (velocity of a fixed body), or a value is not
  // finite.
  virtual void set_velocity(const Vec3& v) = 0;
  virtual void set_angular_velocity(const Vec3& w) = 0;
  virtual void set_applied_force(const Vec3& force) = 0;
  virtual void set_applied_torque(const Vec3& torque) = 0;
  // Acts from here on, beside those that do.
  virtual void add_force(ForceLawPtr law) = 0;
  virtual void set_slots(SlotsPtr slots) = 0;
  // Of a link: `change` gets a copy of how the joints stand, which is checked and then holds; a new
  // arc starts where it differs.  Errors: as of check_joints (kernel/world/joint-changes.h).
  virtual void change_joints(const std::function<void(MultibodyState&)>& /*change*/) {
    throw UserError("this view has no joints to change");
  }
  // Holds it and the other, of the same call, together as they are; lets go of each other again;
  // whether they are held.  Errors: as of make_hold (kernel/world/bonds.h).
  virtual void attach(StateView& /*other*/, const HoldDef& /*hold*/) {
    throw UserError("this view cannot be attached to anything");
  }
  virtual void detach(StateView& /*other*/) {
    throw UserError("this view cannot be detached from anything");
  }
  virtual bool attached(const StateView& /*other*/) const { return false; }
  // Edits only (World::edit), never in callbacks.
  virtual void set_pose(const Vec3& position, const Quat& orientation) = 0;
  // Uniform in [0, 1), from the generator that lives in the state.
  virtual double draw_random() = 0;
};

// A user's callback.  May run again after a rollback.  Any other exception than Interrupted
// becomes a speculative error: raised when GVT passes it, gone if it is rolled back.
class Callback {
 public:
  virtual ~Callback() = default;
  // Returns the next time for callbacks without a period (nullopt: never again); ignored otherwise.
  virtual std::optional<double> run(double event_time, std::span<StateView* const> targets) = 0;
};

class CollisionCallback {
 public:
  virtual ~CollisionCallback() = default;
  // After the impulse.  `a` and `b` in the order in which the callback's sides were given.
  // `reversed`: a is collision.body2.
  virtual void run(const Collision& collision, bool reversed, StateView& a, StateView& b) = 0;
};

using CollisionObserver = std::function<void(const Collision&)>;
using CollisionObserverPtr = std::shared_ptr<const CollisionObserver>;

// Whether a checkpoint knows who looks: observers of a scene come and go with it, whoever records a
// run stays.
enum class Watch : std::uint8_t { of_scene, outside };

// One moving body in a frame.
struct BodyPose {
  BodyId body = 0;
  BodyState state;
};

// Receives committed frames, in order, each once.  Frame k is at k/fps.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  // The poses of all moving (dynamic and kinematic) bodies, by body id; valid during the call.
  virtual void frame(long index, double frame_time, std::span<const BodyPose> poses) = 0;
};

}  // namespace tw
