// Callbacks and observers that call Scheme procedures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/callbacks.h"

#include <array>
#include <cmath>

#include "base/cpu-clock.h"
#include "script/frame-view.h"
#include "script/primitive.h"
#include "script/sides.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_callbacks)

namespace {

// Arguments of one call, in memory that the garbage collector scans.
class Arguments {
 public:
  explicit Arguments(std::size_t count) : count_(count), list_(local_) {
    if (count > std::size(local_))
      list_ = static_cast<SCM*>(scm_gc_malloc(count * sizeof(SCM), "arguments"));
  }
  SCM& operator[](std::size_t i) { return list_[i]; }
  std::span<SCM> all() { return {list_, count_}; }

 private:
  std::size_t count_;
  SCM local_[8] = {};
  SCM* list_;
};

// Kills the views among the arguments when the call is over, however it ends.
class ViewKiller {
 public:
  explicit ViewKiller(std::span<SCM> views) : views_(views) {}
  ~ViewKiller() {
    for (const SCM view : views_) kill_view(view);
  }

 private:
  std::span<SCM> views_;
};

std::string body_names(const World& world, std::span<const BodyId> ids) {
  std::string text;
  for (const BodyId id : ids) text += (text.empty() ? "" : ", ") + world.body(id).name;
  return text;
}

std::string target_names(const World& world, std::span<StateView* const> targets) {
  std::string text;
  for (const StateView* view : targets)
    text += (text.empty() ? "" : ", ") + world.body(view->body()).name;
  return text;
}

// Adds the time of a call to the world's statistics.  Reading the clock costs as much as a small
// callback: after the first thousand calls every sixteenth stands for sixteen.
class CallTimer {
 public:
  explicit CallTimer(const Hook& hook) : hook_(hook) {
    if (!hook.timed) return;
    static std::int64_t calls = 0;
    ++calls;
    weight_ = calls <= 1000 ? 1 : (calls % 16 == 0 ? 16 : 0);
    if (weight_ > 0) start_ = thread_cpu_seconds();
  }
  ~CallTimer() {
    if (weight_ > 0) hook_.box->callback_cpu_seconds += weight_ * (thread_cpu_seconds() - start_);
  }
  CallTimer(const CallTimer&) = delete;
  CallTimer& operator=(const CallTimer&) = delete;

 private:
  const Hook& hook_;
  double weight_ = 0, start_ = 0;
};

// Calls the procedure and lets `take` have what it returns; an error of either is raised again with
// its circumstances.
template <class Names, class Take>
void call_hook(const Hook& hook, std::span<SCM> arguments, double time, Names names, Take take) {
  const CallTimer timer(hook);
  try {
    take(call_scheme(hook.procedure, arguments));
  } catch (const SchemeError& error) {
    const Place& place = error.place().known() ? error.place() : hook.place;
    const std::string made = hook.place.text();
    throw SchemeError(std::string(error.what()) + "\n  in the " + hook.what +
                          (made == place.text() ? "" : " made at " + made) + " at " + show(time) +
                          " s, bodies: " + names(),
                      place, error.backtrace());
  }
}

template <class Names>
void call_hook(const Hook& hook, std::span<SCM> arguments, double time, Names names) {
  call_hook(hook, arguments, time, names, [](SCM) {});
}

// `what` names the procedure in messages; `registrar` is what was called to register it.
Hook make_hook(SCM world, SCM procedure, const char* what, const char* registrar, SCM place) {
  require_outside_callbacks(registrar);
  if (scm_is_false(scm_procedure_p(procedure))) throw BadValue{what, procedure, "a procedure"};
  keep_with_world(world, procedure);
  Hook hook;
  hook.box = &to_world_box(world);
  hook.procedure = procedure;
  hook.what = what;
  if (is_place(place)) hook.place = to_place(place);
  return hook;
}

std::vector<BodyId> to_targets(SCM world, SCM value) {
  std::vector<BodyId> ids;
  for (const SCM target : to_elements(value, "the targets", "a body or a list of bodies"))
    ids.push_back(to_body(world, target, "a target"));
  TW_REQUIRE(!ids.empty(), "a callback has no targets; expected a body or a list of bodies");
  return ids;
}

std::optional<double> next_time(SCM result) {
  if (scm_is_false(result)) return std::nullopt;
  if (!scm_is_real(result))
    throw SchemeError(
        "a callback without #:period returned no time; expected its next time in seconds, or #f, "
        "or a #:period",
        {}, "");
  return scm_to_double(result);
}

// (time body (a b) depth share)
SCM from_squeezing(const Collision& told, SCM world) {
  return scm_list_5(scm_from_double(told.time), from_body(world, told.squeezed),
                    scm_list_2(from_body(world, told.body1), from_body(world, told.body2)),
                    scm_from_double(told.depth), scm_from_double(told.depth_share));
}

// When a callback that names no start is called first: at once, which is just after the present
// where the present is committed already.
double default_start(const World& world) {
  return world.time() > 0 ? std::nextafter(world.time(), never) : 0;
}

}  // namespace

std::optional<double> ScmCallback::run(double event_time, std::span<StateView* const> targets) {
  Arguments arguments(targets.size() + 1);
  arguments[0] = scm_from_double(event_time);
  for (std::size_t i = 0; i < targets.size(); ++i)
    arguments[i + 1] = make_view(*targets[i], hook_.box->handle);
  const ViewKiller killer(arguments.all().subspan(1));
  std::optional<double> next;
  call_hook(
      hook_, arguments.all(), event_time, [&] { return target_names(hook_.box->world, targets); },
      [&](SCM result) {
        if (!periodic_) next = next_time(result);
      });
  return next;
}

void ScmCollisionCallback::run(const Collision& collision, bool reversed, StateView& a,
                               StateView& b) {
  const SCM world = hook_.box->handle;
  Arguments arguments(3);
  arguments[0] = from_collision(collision, reversed, world);
  arguments[1] = make_view(a, world);
  arguments[2] = make_view(b, world);
  const ViewKiller killer(arguments.all().subspan(1));
  call_hook(hook_, arguments.all(), collision.time, [&] {
    return body_names(hook_.box->world, std::array{a.body(), b.body()});
  });
}

void ScmFrameObserver::frame(long index, double frame_time, std::span<const BodyPose> poses) {
  const SCM world = hook_.box->handle;
  std::vector<FrameView> views;
  views.reserve(poses.size());
  for (const BodyPose& pose : poses) views.emplace_back(pose, hook_.box->world, frame_time);
  Arguments handles(poses.size());
  SCM list = SCM_EOL;
  for (std::size_t i = views.size(); i-- > 0;) {
    handles[i] = make_view(views[i], world);
    list = scm_cons(handles[i], list);
  }
  const ViewKiller killer(handles.all());
  SCM arguments[] = {scm_list_3(scm_from_double(frame_time), scm_from_long(index), list)};
  call_hook(hook_, arguments, frame_time, [] { return std::string("all"); });
}

// ---- registering ----

TW_PRIMITIVE(add_callback, "%add-callback!",
             (SCM world, SCM targets, SCM procedure, SCM start, SCM period, SCM place),
             "Register a callback on a list of bodies; return (NUMBER . ADDITION).") {
  CallbackDef def;
  Hook hook = make_hook(world, procedure, "callback", "add-callback!", place);
  hook.timed = true;
  def.targets = to_targets(world, targets);
  def.start = scm_is_true(start) ? to_finite(start, "start") : default_start(to_world(world));
  def.period = to_optional_real(period, "period");
  def.callback = std::make_shared<ScmCallback>(hook, def.period.has_value());
  def.name = "of " + body_names(to_world(world), def.targets);
  def.place = hook.place;
  const std::uint64_t number = to_world(world).add_callback(def);
  return scm_cons(scm_from_uint64(number), from_addition({def.callback}, world));
}

TW_PRIMITIVE(add_collision_callback, "%on-collision!",
             (SCM world, SCM a, SCM b, SCM procedure, SCM place),
             "Register a callback on collisions; return its addition.") {
  CollisionCallbackDef def;
  Hook hook = make_hook(world, procedure, "collision callback", "on-collision!", place);
  hook.timed = true;
  def.sides = to_sides(world, a, b);
  def.callback = std::make_shared<ScmCollisionCallback>(hook);
  def.name = "collision callback";
  def.place = hook.place;
  to_world(world).add_collision_callback(def);
  return from_addition({def.callback}, world);
}

TW_PRIMITIVE(
    observe_collisions, "%observe-collisions!", (SCM world, SCM kind, SCM procedure, SCM place),
    "Call a procedure with every committed collision, fusion, fission or squeezing; return "
    "its addition.") {
  const std::string name = to_symbol_name(kind, "what to observe");
  const CollisionKind wanted = name == "fusion"     ? CollisionKind::fusion
                               : name == "fission"  ? CollisionKind::fission
                               : name == "squeezed" ? CollisionKind::squeezed
                                                    : CollisionKind::collision;
  const auto hook =
      std::make_shared<Hook>(make_hook(world, procedure, "observer", "observe!", place));
  const CollisionObserverPtr observer = to_world(world).add_collision_observer(
      [hook](const Collision& told) {
        const SCM handle = hook->box->handle;
        const bool squeezed = told.kind == CollisionKind::squeezed;
        SCM arguments[] = {squeezed ? from_squeezing(told, handle)
                                    : from_collision(told, false, handle)};
        call_hook(*hook, arguments, told.time, [&] {
          return (squeezed ? hook->box->world.body(told.squeezed).name + " between " : "") +
                 body_names(hook->box->world, std::array{told.body1, told.body2});
        });
      },
      wanted, Watch::of_scene);
  return from_addition({observer}, world);
}

TW_PRIMITIVE(
    frame_observer, "%frame-observer", (SCM world, SCM procedure, SCM place),
    "The addition that calls a procedure with every committed frame, once it is attached.") {
  const Hook hook = make_hook(world, procedure, "observer", "observe!", place);
  const std::shared_ptr<FrameSink> sink = std::make_shared<ScmFrameObserver>(hook);
  return from_addition({sink}, world);
}

TW_PRIMITIVE(observe_frames, "%observe-frames!", (SCM addition, SCM fps),
             "Attach what %frame-observer returned.") {
  const auto* const sink = std::get_if<std::shared_ptr<FrameSink>>(&to_addition(addition).what);
  if (!sink) throw BadValue{"the observer", addition, "one of frames"};
  to_world(addition_world(addition)).add_frame_sink(*sink, to_real(fps, "fps"), Watch::of_scene);
  return SCM_UNSPECIFIED;
}

// ---- taking away ----

TW_PRIMITIVE(world_of_addition, "%addition-world", (SCM addition),
             "The world that it was added to.") {
  to_addition(addition);
  return addition_world(addition);
}

TW_PRIMITIVE(is_there, "%there?", (SCM addition), "Is what was added still in its world?") {
  const World& world = to_world(addition_world(addition));
  return scm_from_bool(std::visit(
      [&world](const auto& what) {
        if constexpr (std::is_same_v<std::decay_t<decltype(what)>, ForceHandle>)
          return world.acts(what);
        else
          return world.has(what.get());
      },
      to_addition(addition).what));
}

namespace {

struct Remove {
  World& world;
  std::string what;

  void operator()(const std::shared_ptr<Callback>& callback) const {
    world.remove_callback(callback.get());
  }
  void operator()(const std::shared_ptr<CollisionCallback>& callback) const {
    world.remove_callback(callback.get());
  }
  void operator()(const CollisionObserverPtr& observer) const {
    world.remove_observer(observer.get());
  }
  void operator()(const std::shared_ptr<FrameSink>& sink) const {
    world.remove_frame_sink(sink.get());
  }
  void operator()(const ForceHandle& force) const { world.remove_force(force, what); }
};

}  // namespace

TW_PRIMITIVE(remove_addition, "%remove!", (SCM world, SCM addition, SCM who, SCM what),
             "Take away what was added; WHO is asked to, WHAT it is, strings.") {
  require_outside_callbacks(text_of(who).c_str());
  const Addition& known = to_addition(addition);
  if (!scm_is_eq(addition_world(addition), world))
    throw UserError(text_of(what) +
                    " belongs to another world; expected what was added to the current one");
  std::visit(Remove{to_world(world), text_of(what)}, known.what);
  return SCM_UNSPECIFIED;
}

}  // namespace tw
