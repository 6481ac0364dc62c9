// The Scheme types of the binding.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/types.h"

#include "script/border.h"
#include "script/primitive.h"
#include "script/values.h"

namespace tw {

namespace {

SCM world_type, body_type, multibody_type, view_type, shape_type, visual_type, motion_type,
    collision_type, checkpoint_type, addition_type;

struct ShapeBox : Live<LiveKind::shape> {
  ShapePtr shape;
};

struct VisualBox : Live<LiveKind::visual> {
  VisualPtr visual;
};

struct CheckpointBox : Live<LiveKind::checkpoint> {
  ScmCheckpoint checkpoint;
};
struct AdditionBox : Live<LiveKind::callback> {
  Addition addition;
};
struct MotionBox : Live<LiveKind::motion> {
  TrajectoryPtr motion;
};

template <class Box>
void finalize_box(SCM object) {
  auto* box = static_cast<Box*>(scm_foreign_object_ref(object, 0));
  scm_foreign_object_set_x(object, 0, nullptr);
  delete box;
}

SCM make_type(const char* name, std::initializer_list<const char*> fields,
              scm_t_struct_finalize finalizer) {
  SCM list = SCM_EOL;
  for (const char* field : fields) list = scm_cons(scm_from_utf8_symbol(field), list);
  const SCM type =
      scm_make_foreign_object_type(scm_from_utf8_symbol(name), scm_reverse(list), finalizer);
  scm_c_define(name, type);
  scm_c_export(name, nullptr);
  return scm_gc_protect_object(type);
}

bool has_type(SCM object, SCM type) {
  return SCM_STRUCTP(object) && scm_is_eq(SCM_STRUCT_VTABLE(object), type);
}

void* field(SCM object, std::size_t index) { return scm_foreign_object_ref(object, index); }

SCM scm_field(SCM object, std::size_t index) {
  return SCM_PACK_POINTER(scm_foreign_object_ref(object, index));
}

// Of a body or multibody: number and serial number in one word.
constexpr int bits_of_number = 32;
std::uint64_t word_of(SCM object) { return reinterpret_cast<std::uintptr_t>(field(object, 0)); }
std::uint32_t number_of(SCM object) { return static_cast<std::uint32_t>(word_of(object)); }
std::uint64_t serial_of(SCM object) { return word_of(object) >> bits_of_number; }

// A multibody has that of its first link.
std::uint64_t serial_of(const World& world, const Multibody& multibody) {
  return world.serial(multibody.links.front());
}

// The object that stands for a body or multibody in a world's table, made at first use.
SCM handle_of(SCM type, SCM world, std::uint32_t number, std::uint64_t serial, SCM key,
              const std::string& name) {
  const SCM table = world_table(world);
  SCM object = scm_hashv_ref(table, key, SCM_BOOL_F);
  if (scm_is_true(object)) return object;
  object = scm_make_foreign_object_3(
      type, reinterpret_cast<void*>(static_cast<std::uintptr_t>(serial << bits_of_number | number)),
      SCM_UNPACK_POINTER(world), SCM_UNPACK_POINTER(from_string(name)));
  scm_hashv_set_x(table, key, object);
  return object;
}

SCM key_of_kept() {
  static const SCM key = scm_gc_protect_object(scm_from_utf8_symbol("kept"));
  return key;
}

constexpr const char* there = "one that is there (restore! went back to before it was added)";

}  // namespace

// ---- worlds ----

bool is_world(SCM object) { return has_type(object, world_type); }

WorldBox& to_world_box(SCM object) {
  if (!is_world(object)) throw BadValue{"the world", object, "a world, as (make-world) returns"};
  return *static_cast<WorldBox*>(field(object, 0));
}

SCM make_world_handle() {
  const SCM table = scm_c_make_hash_table(31);
  auto* box = new WorldBox;
  const SCM handle = scm_make_foreign_object_2(world_type, box, SCM_UNPACK_POINTER(table));
  box->handle = handle;
  return handle;
}

SCM world_table(SCM world) { return scm_field(world, 1); }

void keep_with_world(SCM world, SCM object) {
  const SCM key = key_of_kept();
  const SCM table = world_table(world);
  scm_hashq_set_x(table, key, scm_cons(object, scm_hashq_ref(table, key, SCM_EOL)));
}

// ---- bodies ----

bool is_body(SCM object) { return has_type(object, body_type); }

SCM body_world(SCM body) { return scm_field(body, 1); }

BodyId to_body(SCM world, SCM object, const char* name) {
  if (!stands_for_body(object)) throw BadValue{name, object, "a body"};
  if (!scm_is_eq(body_world(object), world))
    throw BadValue{name, object, "a body of the current world (this one belongs to another)"};
  if (!is_known(object)) throw BadValue{name, object, there};
  const BodyId id = body_number(object);
  if (to_world(world).body(id).removed) throw BadValue{name, object, "a body that was not removed"};
  return id;
}

SCM current_world() {
  static const SCM parameter = scm_permanent_object(
      scm_variable_ref(scm_c_private_variable("timewarp worlds", "current-world")));
  return scm_call_0(parameter);
}

bool is_known(SCM body) {
  const World& world = to_world(body_world(body));
  const std::uint32_t number = number_of(body);
  if (is_multibody(body))
    return number < world.multibody_count() &&
           serial_of(world, world.multibody(number)) == serial_of(body);
  return number < world.body_count() && world.serial(number) == serial_of(body);
}

SCM body_name_of(SCM body) { return scm_field(body, 2); }

BodyId body_number(SCM body) {
  if (!is_known(body)) throw BadValue{"the body", body, there};
  if (is_multibody(body))
    return to_world(body_world(body)).multibody(number_of(body)).links.front();
  return number_of(body);
}

SCM from_body(SCM world, BodyId id) {
  const World& w = to_world(world);
  const std::uint64_t serial = w.serial(id);
  return handle_of(body_type, world, id, serial, scm_from_uint64(serial), w.body(id).name);
}

SCM from_past_body(SCM world, BodyId id, std::uint64_t serial) {
  const World& w = to_world(world);
  const bool is_there = id < w.body_count() && w.serial(id) == serial;
  return handle_of(body_type, world, id, serial, scm_from_uint64(serial),
                   is_there ? w.body(id).name : "body-" + std::to_string(id));
}

// ---- multibodies ----

bool is_multibody(SCM object) { return has_type(object, multibody_type); }

const Multibody& to_multibody(SCM world, SCM object, const char* name) {
  if (!is_multibody(object)) throw BadValue{name, object, "a multibody, as add-multibody! returns"};
  if (!scm_is_eq(body_world(object), world))
    throw BadValue{name, object, "a multibody of the current world (this one belongs to another)"};
  if (!is_known(object)) throw BadValue{name, object, there};
  return to_world(world).multibody(number_of(object));
}

SCM from_multibody(SCM world, std::uint32_t number) {
  const World& w = to_world(world);
  const Multibody& multibody = w.multibody(number);
  const std::uint64_t serial = serial_of(w, multibody);
  return handle_of(multibody_type, world, number, serial,
                   scm_from_int64(-1 - static_cast<std::int64_t>(serial)), multibody.name);
}

// ---- views ----

bool is_view(SCM object) { return has_type(object, view_type); }

StateView& to_view(SCM view) {
  auto* pointer = static_cast<StateView*>(field(view, 0));
  TW_REQUIRE(pointer,
             "this view is dead: it was used after its callback returned; expected a view only "
             "during the call that was handed it");
  return *pointer;
}

SCM view_world(SCM view) { return scm_field(view, 1); }

SCM make_view(StateView& view, SCM world) {
  ++live_counts[static_cast<std::size_t>(LiveKind::view)];
  return scm_make_foreign_object_2(view_type, &view, SCM_UNPACK_POINTER(world));
}

void kill_view(SCM view) {
  --live_counts[static_cast<std::size_t>(LiveKind::view)];
  scm_foreign_object_set_x(view, 0, nullptr);
}

// ---- shapes, motions ----

bool is_shape(SCM object) { return has_type(object, shape_type); }

ShapePtr to_shape(SCM object, const char* name) {
  if (!is_shape(object)) throw BadValue{name, object, "a shape, as (sphere 0.1) returns"};
  return static_cast<ShapeBox*>(field(object, 0))->shape;
}

SCM from_shape(ShapePtr shape) {
  auto* box = new ShapeBox;
  box->shape = std::move(shape);
  return scm_make_foreign_object_1(shape_type, box);
}

bool is_visual(SCM object) { return has_type(object, visual_type); }

VisualPtr to_visual(SCM object, const char* name) {
  Visual parts;
  std::vector<SCM> given{object};
  if (scm_is_true(scm_list_p(object))) given = to_elements(object, name, "a list");
  for (const SCM one : given) {
    if (is_visual(one)) {
      const Visual& visual = *static_cast<VisualBox*>(field(one, 0))->visual;
      parts.insert(parts.end(), visual.begin(), visual.end());
    } else if (is_shape(one) && !to_shape(one, name)->is_ground()) {
      parts.push_back({to_shape(one, name), nullptr, Pose{}, std::nullopt});
    } else {
      throw BadValue{name, one,
                     "a visual, as (load-visual FILE) returns, a shape with bounds, or a "
                     "list of them"};
    }
  }
  return std::make_shared<const Visual>(std::move(parts));
}

SCM from_visual(VisualPtr visual) {
  auto* box = new VisualBox;
  box->visual = std::move(visual);
  return scm_make_foreign_object_1(visual_type, box);
}

bool is_motion(SCM object) { return has_type(object, motion_type); }

TrajectoryPtr to_motion(SCM object, const char* name) {
  if (!is_motion(object))
    throw BadValue{name, object, "keyframes, as (keyframes '((0 #(0 0 0)) ...)) returns"};
  return static_cast<MotionBox*>(field(object, 0))->motion;
}

SCM from_motion(TrajectoryPtr motion, SCM kept) {
  auto* box = new MotionBox;
  box->motion = std::move(motion);
  return scm_make_foreign_object_2(motion_type, box, SCM_UNPACK_POINTER(kept));
}

// ---- collisions ----

bool is_collision(SCM object) { return has_type(object, collision_type); }

const CollisionCopy& to_collision(SCM object) {
  if (!is_collision(object))
    throw BadValue{"the collision", object, "the collision that a procedure is handed"};
  return *static_cast<const CollisionCopy*>(field(object, 0));
}

SCM collision_world(SCM object) { return scm_field(object, 1); }

SCM from_collision(const Collision& collision, bool reversed, SCM world) {
  static_assert(std::is_trivially_destructible_v<CollisionCopy>);
  void* memory = scm_gc_malloc_pointerless(sizeof(CollisionCopy), "collision");
  const World& w = to_world(world);
  auto* copy = new (memory)
      CollisionCopy{collision, reversed, w.serial(collision.body1), w.serial(collision.body2)};
  return scm_make_foreign_object_2(collision_type, copy, SCM_UNPACK_POINTER(world));
}

// ---- additions ----

SCM from_addition(Addition addition, SCM world) {
  auto* box = new AdditionBox;
  box->addition = std::move(addition);
  return scm_make_foreign_object_2(addition_type, box, SCM_UNPACK_POINTER(world));
}

const Addition& to_addition(SCM object) {
  if (!has_type(object, addition_type))
    throw BadValue{"the addition", object, "what was added to a world"};
  return static_cast<AdditionBox*>(field(object, 0))->addition;
}

SCM addition_world(SCM object) { return scm_field(object, 1); }

// ---- checkpoints ----

SCM from_checkpoint(ScmCheckpoint checkpoint, SCM world, SCM extra) {
  auto* box = new CheckpointBox;
  box->checkpoint = std::move(checkpoint);
  // what is kept is a list that grows at its head: this tail of it stays as it is
  const SCM kept = scm_hashq_ref(world_table(world), key_of_kept(), SCM_EOL);
  void* fields[] = {box, SCM_UNPACK_POINTER(world), SCM_UNPACK_POINTER(extra),
                    SCM_UNPACK_POINTER(kept)};
  return scm_make_foreign_object_n(checkpoint_type, std::size(fields), fields);
}

const ScmCheckpoint& to_checkpoint(SCM object) {
  if (!has_type(object, checkpoint_type))
    throw BadValue{"the checkpoint", object, "what (checkpoint) returned"};
  return static_cast<CheckpointBox*>(field(object, 0))->checkpoint;
}

SCM checkpoint_world(SCM object) { return scm_field(object, 1); }
SCM checkpoint_extra(SCM object) { return scm_field(object, 2); }

void keep_as_then(SCM object) {
  scm_hashq_set_x(world_table(checkpoint_world(object)), key_of_kept(), scm_field(object, 3));
}

void define_types() {
  checkpoint_type =
      make_type("<checkpoint>", {"box", "world", "extra", "kept"}, finalize_box<CheckpointBox>);
  addition_type = make_type("<addition>", {"box", "world"}, finalize_box<AdditionBox>);
  world_type = make_type("<world>", {"box", "table"}, finalize_box<WorldBox>);
  body_type = make_type("<body>", {"id", "world", "name"}, nullptr);
  multibody_type = make_type("<multibody>", {"number", "world", "name"}, nullptr);
  view_type = make_type("<view>", {"state", "world"}, nullptr);
  shape_type = make_type("<shape>", {"box"}, finalize_box<ShapeBox>);
  visual_type = make_type("<visual>", {"box"}, finalize_box<VisualBox>);
  motion_type = make_type("<motion>", {"box", "kept"}, finalize_box<MotionBox>);
  collision_type = make_type("<collision>", {"copy", "world"}, nullptr);
}

}  // namespace tw
