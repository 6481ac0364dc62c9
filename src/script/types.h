// The Scheme types of the binding: foreign objects, and who owns what.
//
// Values are copies, identities are handles.  A *world* owns its tw::World; a *body* is a handle
// that keeps its world alive (one handle per body, so `eq?` works); a *shape* and a *motion* hold
// counted references; a *view* points into the kernel during one call and is dead afterwards; a
// *collision* and a *frame* are copies; an *addition* stands for what was added and can be taken
// away: a callback, an observer, a force.  A body's number may be given to another after a restore:
// handles know the serial number, too.  Procedures registered with a world are kept alive by the
// world's table, in Guile's heap, so that a world nobody refers to is collected.
//
// Invariants: finalizers only drop references: Guile may run them in another thread.
// Cost: a type check 2 ns.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <variant>

#include "geometry/shape.h"
#include "integrate/trajectory.h"
#include "kernel/loop/checkpoint.h"
#include "kernel/world/callback.h"
#include "kernel/world/world.h"
#include "script/live.h"

namespace tw {

// A world and its Scheme handle (not counted: the handle owns the box).
struct WorldBox : Live<LiveKind::world> {
  World world;
  SCM handle = SCM_BOOL_F;
  // the binding's own statistics
  std::int64_t guile_calls = 0;
  std::int64_t frames = 0;  // that recorders took; closed recorders count
  double callback_cpu_seconds = 0, draw_cpu_seconds = 0;
  std::uint64_t forces = 0;  // by procedures, so far
};

// ---- worlds ----
bool is_world(SCM object);
WorldBox& to_world_box(SCM object);
inline World& to_world(SCM object) { return to_world_box(object).world; }
SCM make_world_handle();
// The world's hash table for whatever Scheme keeps with it.
SCM world_table(SCM world);
// Keeps a Scheme object alive as long as the world.
void keep_with_world(SCM world, SCM object);

// ---- bodies ----
bool is_body(SCM object);
// The world that a body or multibody belongs to.
SCM body_world(SCM body);
// The number of a body of `world`.  BadValue for what is no body, for a body of another world, and
// for one that is not there: removed, or restored away.
BodyId to_body(SCM world, SCM object, const char* name);
// What the Scheme parameter of that name holds.
SCM current_world();
// Of one that may have been removed, but not restored away (BadValue).
BodyId body_number(SCM body);
// Whether the world has it now, or has removed it.
bool is_known(SCM body);
// The name that it has, or had.
SCM body_name_of(SCM body);
// The number of a body of the current world.
inline BodyId to_own_body(SCM body) { return to_body(current_world(), body, "the body"); }
// The handle of a body, always the same object.
SCM from_body(SCM world, BodyId id);
// Of one that may not be there any more.
SCM from_past_body(SCM world, BodyId id, std::uint64_t serial);

// ---- multibodies ----
bool is_multibody(SCM object);
// What procedures on bodies take: a multibody stands for its first link.
inline bool stands_for_body(SCM object) { return is_body(object) || is_multibody(object); }
const Multibody& to_multibody(SCM world, SCM object, const char* name);
inline const Multibody& to_own_multibody(SCM object) {
  return to_multibody(current_world(), object, "the multibody");
}
SCM from_multibody(SCM world, std::uint32_t number);

// ---- views ----
bool is_view(SCM object);
// BadValue-like UserError if the view is dead.
StateView& to_view(SCM view);
SCM view_world(SCM view);
SCM make_view(StateView& view, SCM world);
void kill_view(SCM view);

// ---- shapes, motions ----
bool is_shape(SCM object);
ShapePtr to_shape(SCM object, const char* name);
SCM from_shape(ShapePtr shape);
// A visual, as load-visual returns, a shape, or a list of them.
VisualPtr to_visual(SCM object, const char* name);
SCM from_visual(VisualPtr visual);
bool is_motion(SCM object);
TrajectoryPtr to_motion(SCM object, const char* name);
// `kept`: a Scheme object that the motion needs.
SCM from_motion(TrajectoryPtr motion, SCM kept = SCM_BOOL_F);

// ---- collisions ----
bool is_collision(SCM object);
// `reversed`: the first side is collision.body2.
struct CollisionCopy {
  Collision collision;
  bool reversed = false;
  std::uint64_t serial1 = 0, serial2 = 0;  // of its bodies
};
const CollisionCopy& to_collision(SCM object);
SCM collision_world(SCM object);
SCM from_collision(const Collision& collision, bool reversed, SCM world);

// ---- additions ----
// What was added to a world and can be taken away, by its address.
struct Addition {
  std::variant<std::shared_ptr<Callback>, std::shared_ptr<CollisionCallback>, CollisionObserverPtr,
               std::shared_ptr<FrameSink>, ForceHandle>
      what;
};
SCM from_addition(Addition addition, SCM world);
const Addition& to_addition(SCM object);
SCM addition_world(SCM object);

// ---- checkpoints ----
// What it brings back, and what the binding does: `extra` belongs to Scheme.
struct ScmCheckpoint {
  std::shared_ptr<const Checkpoint> checkpoint;
  std::uint64_t forces = 0;
};
// The world they belong to is kept alive, and what it kept then.
SCM from_checkpoint(ScmCheckpoint checkpoint, SCM world, SCM extra);
const ScmCheckpoint& to_checkpoint(SCM object);
SCM checkpoint_world(SCM object);
SCM checkpoint_extra(SCM object);
// Its world keeps what it kept then, and no more.
void keep_as_then(SCM checkpoint);

// Makes the types and defines <world> and its like in the current module.
void define_types();

}  // namespace tw
