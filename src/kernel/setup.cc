// What comes into the world: bodies, contact parameters, callbacks, sinks; and the beginning of
// runs.
//
// A change that may concern the future of bodies (a new body, other contact parameters) forgets
// everything after the present time; what is committed stays.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "integrate/standing.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

// Bodies may overlap by this share of the smaller size when they come into the world: touching.
constexpr double start_depth = 1e-6;

void require_finite(const Vec3& v, const char* what, const std::string& name) {
  TW_REQUIRE(is_finite(v), std::string(what) + " of " + name + " is #(" + show(v.x()) + " " +
                               show(v.y()) + " " + show(v.z()) +
                               "); expected three finite numbers");
}

// kappa = max |Ii - Ij| / Ik: torque-free rotation has |w'| <= kappa |w|^2.
double turn_excess(const Vec3& m) {
  double most = 0;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, std::abs(m[(k + 1) % 3] - m[(k + 2) % 3]) / m[k]);
  return most;
}

}  // namespace

void Kernel::require_between_runs(const char* what) const {
  TW_REQUIRE(!running,
             std::string(what) + " inside a callback or observer; expected to be between runs");
}

void Kernel::require_before_first_run(const char* what) const {
  TW_REQUIRE(!begun,
             std::string(what) + " after the simulation began; expected before the first run");
}

// ---- bodies ----

void Kernel::validate_body_def(const BodyDef& def, const std::string& name) const {
  TW_REQUIRE(!names.contains(name),
             "name " + name + " is taken; expected a name no other body has");
  require_finite(def.position, "position", name);
  require_finite(def.velocity, "velocity", name);
  require_finite(def.angular_velocity, "angular-velocity", name);
  TW_REQUIRE(def.velocity.norm() <= speed_limit, "the speed of " + name + " is " +
                                                     show(def.velocity.norm()) +
                                                     " m/s; expected at most " + show(speed_limit));
  require_near(def.position, name);
  TW_REQUIRE(def.angular_velocity.norm() <= greatest_angular_speed,
             "the angular velocity of " + name + " is " + show(def.angular_velocity.norm()) +
                 " rad/s; expected at most " + show(greatest_angular_speed));
  TW_REQUIRE(is_finite(def.orientation) && def.orientation.squaredNorm() > 0,
             "orientation of " + name + " is zero or not finite; expected a quaternion #(w x y z)");
  TW_REQUIRE(!(def.fixed && def.motion),
             name + " has both #:fixed? and #:motion; expected one of them");
  const bool moves = !def.fixed && !def.motion;
  TW_REQUIRE(moves || (def.velocity.isZero() && def.angular_velocity.isZero()),
             name + " is fixed or kinematic and has a velocity; expected a dynamic body");
  if (def.color) require_finite(*def.color, "color", name);
}

void Kernel::resolve_shape(Body& body, const BodyDef& def) {
  if (!def.shape) return;
  body.shape_P = body.X_PB.p.isZero() && body.X_PB.q.coeffs() == Quat::Identity().coeffs()
                     ? def.shape
                     : place_shape(def.shape, body.X_PB);
  body.unbounded = !body.shape_P->bounded();
  body.radius = body.shape_P->radius_about_origin();
  body.least_width = body.shape_P->least_width();
  const ConvexPart& part = body.shape_P->parts().front();
  const bool at_center = part.bound_center.norm() <= 1e-15 * part.bound_radius;
  if (body.shape_P->is_sphere() && at_center) body.sphere_radius = part.radius;
  if (body.fixed() && body.shape_P->is_half_space()) {
    const Frame frame(body.motion->pose(0));
    body.is_fixed_plane = true;
    body.plane_normal = frame.R * part.normal;
    body.plane_offset = part.offset + body.plane_normal.dot(frame.p);
  }
  TW_REQUIRE(!body.unbounded || !body.motion || body.motion->bounds(-never, never).turn == 0,
             body.info.name + " is a half-space that turns; expected a motion without rotation");
}

void Kernel::make_birth(Body& body, const BodyDef& def) {
  const Key key{time, 0, KeyKind::birth, body.id()};
  State* state = graph.append(body.process, key);
  state->arc_key = key;
  state->arc_time = time;
  state->slots = def.slots;
  // a stream of its own for every body
  state->random = mix64(options.seed ^ mix64(body.id() + 0x632be59bd9b4e019ull));
  if (body.dynamic()) {
    const Quat q = def.orientation.normalized();
    state->q = q * body.X_BP.q;
    state->x = def.position + q * body.X_BP.p;
    state->v = def.velocity;
    state->L = angular_momentum(body, state->q, def.angular_velocity);
    state->acceleration = options.gravity;
    let_fly(body, *state);
    ++counters.integrations;
  } else {
    state->follows = body.motion;
  }
  process(body).claim = key;
}

BodyId Kernel::add_body(const BodyDef& def) {
  require_between_runs("a body was added");
  const BodyId id = static_cast<BodyId>(bodies.size());
  const std::string name = def.name.empty() ? "body-" + std::to_string(id) : def.name;
  validate_body_def(def, name);

  auto body = std::make_unique<Body>();
  body->info = {id, name,      def.material, BodyKind::dynamic, def.shape,
                0,  def.color, def.visible,  def.place};
  body->contact = {id, def.material};
  if (def.fixed || def.motion) {
    body->info.kind = def.fixed ? BodyKind::fixed : BodyKind::kinematic;
    body->motion = def.motion;
    if (def.fixed) body->motion = make_standing({def.position, def.orientation.normalized()});
  } else {
    const RigidInertia inertia = resolve_inertia(
        {def.density, def.mass, def.inertia, def.center_of_mass}, def.shape.get(), name);
    body->mass = body->info.mass = inertia.mass;
    body->moments = inertia.moments;
    body->turn_excess = turn_excess(inertia.moments);
    body->X_BP = inertia.X_BP;
    body->X_PB.q = inertia.X_BP.q.conjugate();
    body->X_PB.p = -(body->X_PB.q * inertia.X_BP.p);
  }
  resolve_shape(*body, def);

  if (begun) restart_future();
  processes.push_back({});
  Process& process = processes.back();
  process.id = body->process = graph.add_process();
  process.bodies = {id};
  make_birth(*body, def);
  newborn_.push_back(id);
  names[name] = id;
  if (body->unbounded) unbounded.push_back(id);
  if (body->info.kind == BodyKind::kinematic) kinematic.push_back(id);
  bodies.push_back(std::move(body));
  return id;
}

void Kernel::require_no_overlap(const Body& a, const Body& b) const {
  if (!a.shape_P || !b.shape_P || !(a.dynamic() || b.dynamic()) || !may_collide(a, b)) return;
  const auto frame = [&](const Body& body) {
    return state_at(body.id(), time)->trajectory().frame(time);
  };
  const Separation s = separation(*a.shape_P, frame(a), *b.shape_P, frame(b));
  const double allowed = start_depth * std::min(a.least_width, b.least_width);
  if (s.distance >= -allowed) return;
  throw UserError(a.info.name + " and " + b.info.name + " overlap by " + show(-s.distance) +
                      " m at " + show(time) + " s; expected bodies that at most touch (" +
                      show(allowed) + " m), or disable-collisions! for the pair",
                  a.id() > b.id() ? a.info.place : b.info.place);
}

// The body's box at the present time against all others that have one: a newborn body later in line
// looks back.
void Kernel::check_overlaps(Body& body) {
  if (!body.shape_P) return;
  if (!body.unbounded) {
    Aabb box = swept_bounds(body, state_at(body.id(), time)->trajectory(), time, time);
    box.grow(1e-9 * (box.lo.cwiseAbs().maxCoeff() + box.hi.cwiseAbs().maxCoeff()));
    grid.place(body.id(), box, body.fixed());
    grid.overlapping(body.id(), [&](BodyId other) { require_no_overlap(*bodies[other], body); });
    for (const BodyId other : unbounded)
      if (boxes_overlap(body, *bodies[other])) require_no_overlap(*bodies[other], body);
    return;
  }
  for (const auto& other : bodies)
    if (other->id() != body.id() && (other->unbounded || grid.contains(other->id())) &&
        boxes_overlap(body, *other))
      require_no_overlap(*other, body);
}

// ---- contact, callbacks, observers, sinks ----

void Kernel::set_contact(const ContactSide& a, const ContactSide& b,
                         const ContactSettings& settings) {
  require_between_runs("contact parameters were set");
  contacts.add(a, b, settings);
  if (settings.collide && !*settings.collide) contacts_may_disable_ = true;
  if (!begun) return;
  restart_future();
  renew_groups();
}

// Bodies that no rule names differ by their material alone: one class for each material, one for
// each body that is named.  Few classes, so what is looked up for all pairs stays small.
void Kernel::update_contact_classes() const {
  if (contact_cache_version_ != contacts.version()) {
    contact_cache_.clear();
    contact_classes_.clear();
    contact_class_of_material_.clear();
    contact_cache_version_ = contacts.version();
  }
  while (contact_classes_.size() < bodies.size()) {
    const BodyId id = static_cast<BodyId>(contact_classes_.size());
    const ContactBody& body = bodies[id]->contact;
    BodyId first = id;
    if (!contacts.names_body(id))
      first = contact_class_of_material_.emplace(body.material, id).first->second;
    contact_classes_.push_back(first);
  }
}

const ContactParameters& Kernel::contact_parameters(BodyId a, BodyId b) const {
  update_contact_classes();
  const std::uint64_t id = pair_id(contact_classes_[a], contact_classes_[b]);
  const auto known = contact_cache_.find(id);
  if (known != contact_cache_.end()) return known->second;
  const ContactParameters found = contacts.look_up(bodies[a]->contact, bodies[b]->contact);
  return contact_cache_.emplace(id, found).first->second;
}

std::uint64_t Kernel::add_callback(const CallbackDef& def) {
  require_between_runs("a callback was added");
  TW_REQUIRE(!def.targets.empty(), "callback " + def.name + " has no targets; expected bodies");
  for (std::size_t i = 0; i < def.targets.size(); ++i)
    TW_REQUIRE(std::count(def.targets.begin(), def.targets.end(), def.targets[i]) == 1,
               "callback " + def.name + " names " + bodies[def.targets[i]]->info.name +
                   " twice; expected each target once");
  TW_REQUIRE(std::isfinite(def.start), "start of callback " + def.name + " is " + show(def.start) +
                                           "; expected a finite number of seconds");
  TW_REQUIRE(std::abs(def.start) <= greatest_time, "start of callback " + def.name + " is " +
                                                       show(def.start) + " s; expected at most " +
                                                       show(greatest_time) + " s");
  TW_REQUIRE(!def.period || (std::isfinite(*def.period) && *def.period > 0),
             "period of callback " + def.name + " is " + show(def.period.value_or(0)) +
                 "; expected a positive number of seconds, or #f");
  TW_REQUIRE(!def.period || (*def.period >= least_period && *def.period <= greatest_time),
             "period of callback " + def.name + " is " + show(def.period.value_or(0)) +
                 " s; expected a time from " + show(least_period) + " to " + show(greatest_time) +
                 " s: more ticks could not be counted");
  TW_REQUIRE(def.period || def.start > time || (!begun && def.start == time),
             "start of callback " + def.name + " is " + show(def.start) +
                 "; expected a time after the present (" + show(time) + " s)");
  if (begun) restart_future();

  const std::uint32_t number = static_cast<std::uint32_t>(callbacks.size());
  callbacks.push_back({});
  CallbackRecord& callback = callbacks.back();
  callback.def = def;
  callback.committed_next = def.start;
  callback.next = {def.start, 0, KeyKind::callback, number};
  // ticks before the present are not made up for
  const KeyKind present = begun ? KeyKind::group_check : KeyKind::birth;
  if (def.period) callback.next = first_tick(callback, {time, 0, present, 0});
  for (const BodyId id : def.targets) process(*bodies[id]).callbacks.push_back(number);
  schedule_callback(number);
  return number;
}

void Kernel::add_collision_callback(const CollisionCallbackDef& def) {
  require_between_runs("a collision callback was added");
  collision_callbacks.push_back(def);
  if (begun) restart_future();
}

void Kernel::add_collision_observer(CollisionObserver observer, CollisionKind kind) {
  require_between_runs("an observer was added");
  if (begun && !observed(kind)) restart_future();
  observers.push_back({std::move(observer), kind});
}

bool Kernel::observed(CollisionKind kind) const {
  return std::any_of(observers.begin(), observers.end(),
                     [&](const ObserverRecord& record) { return record.kind == kind; });
}

void Kernel::add_frame_sink(std::shared_ptr<FrameSink> sink, double fps) {
  require_between_runs("a frame sink was added");
  TW_REQUIRE(std::isfinite(fps) && fps > 0,
             "frames per second are " + show(fps) + "; expected a positive number");
  TW_REQUIRE(fps <= greatest_rate,
             "frames per second are " + show(fps) + "; expected at most " + show(greatest_rate));
  SinkRecord record{std::move(sink), fps, static_cast<long>(std::floor(time * fps))};
  while (record.next_time() < time) ++record.next_frame;
  sinks.push_back(std::move(record));
}

void Kernel::remove_frame_sink(const FrameSink* sink) {
  std::erase_if(sinks, [&](const SinkRecord& record) { return record.sink.get() == sink; });
}

// ---- changes between runs ----

// Of an edit that concerns these.  After whatever they have done at this instant, where that is
// final; else before everything there: a callback that stopped the run, or an impact that an
// interrupt left, sees what was changed, and doesn't take it back by coming earlier.
Key Kernel::edit_key(const std::vector<BodyId>& concerned) {
  if (!due_.inclusive) return {time, 0, KeyKind::early_edit, edits_++};
  std::uint32_t microstep = 1;
  for (const BodyId member : concerned)
    for (const State* s = graph.tail(process_of(member)); s && s->key.time >= time; s = s->prev)
      if (s->key.time == time) microstep = std::max(microstep, s->key.microstep + 1);
  return {time, microstep, KeyKind::edit, edits_++};
}

void Kernel::edit(BodyId id, const std::function<void(StateView&)>& change) {
  require_between_runs("a body was changed");
  Body& body = *bodies[id];
  const Region region = region_of(present_key(), {id}, true);
  std::vector<BodyId> concerned = region.inside;
  concerned.insert(concerned.end(), region.border.begin(), region.border.end());
  const Key key = edit_key(concerned);
  std::vector<Successor> successors{make_successor(body, key, false)};
  successors[0].role = Role::record;
  const Vec3 x_before = successors[0].point.x;
  const Quat q_before = successors[0].point.q;
  SuccessorView view(successors[0], key, true, options.gravity);
  change(view);
  regroup_edited(key, successors);
  enter_discontinuity(key, successors);
  if (begun &&
      (successors[0].point.x != x_before || successors[0].point.q.coeffs() != q_before.coeffs()))
    check_overlaps(body);
}

void Kernel::set_gravity(const Vec3& gravity) {
  require_between_runs("gravity was set");
  TW_REQUIRE(is_finite(gravity), "gravity is not finite; expected #(x y z) in m/s^2");
  options.gravity = gravity;
  // a body that is still at its birth needs no discontinuity
  const auto newborn = [&](BodyId id) { return !begun && !graph.tail(process_of(id))->prev; };
  for (const auto& body : bodies)
    if (body->dynamic() && newborn(body->id())) {
      State* tail = graph.tail(body->process);
      tail->acceleration = gravity + tail->force / body->mass;
      let_fly(*body, *tail);
    }
  edit_together([&](BodyId id) { return !newborn(id); },
                [&](Successor& successor) {
                  successor.data.acceleration =
                      gravity + successor.data.force / successor.body->mass;
                });
}

// Gives new arcs, changed by `change`, to all dynamic bodies that are `concerned` and to those that
// hang together with them: one edit for all that hang together, so that no group is made in between
// whose members are half changed.
void Kernel::edit_together(const std::function<bool(BodyId)>& concerned,
                           const std::function<void(Successor&)>& change) {
  std::vector<bool> done(bodies.size(), false);
  for (const auto& body : bodies) {
    if (!body->dynamic() || done[body->id()] || !concerned(body->id())) continue;
    const std::vector<BodyId> together = hanging_together(body->id(), present_key());
    const Key key = edit_key(together);
    std::vector<Successor> successors;
    successors.reserve(together.size());
    for (const BodyId id : together) {
      done[id] = true;
      successors.push_back(make_successor(*bodies[id], key, true));
      change(successors.back());
    }
    regroup_edited(key, successors);
    enter_discontinuity(key, successors);
  }
}

// What is below it is past: all that has happened at the present time where that is final, else
// nothing but what was changed between runs.
Key Kernel::present_key() const {
  if (due_.inclusive) return {time, 0xffffffffu, KeyKind::edit, ~0ull};
  return {time, 0, KeyKind::early_edit, ~0ull};
}

// Everything after the present time is forgotten and will be found again.
void Kernel::restart_future() {
  undone_.clear();
  const Key present = present_key();
  std::vector<Affected> affected;
  for (const auto& body : bodies) graph.rollback(body->process, present, affected, removal());
  for (std::uint32_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].live) drop_pair(i);
  std::vector<Affected> all;
  for (const auto& body : bodies) all.push_back({body->process, present});
  treat(all);
}

void Kernel::renew_groups() {
  edit_together(
      [&](BodyId id) {
        const State* tail = graph.tail(process_of(id));
        return tail->group && !tail->error;
      },
      [](Successor&) {});
}

// ---- the beginning of a run ----

// Typical spacing of moving bodies: (volume / number)^(1/3), at least their size.
void Kernel::update_cell() {
  Aabb space;
  double radii = 0;
  int count = 0;
  for (const auto& body : bodies) {
    if (!body->dynamic() || !body->shape_P) continue;
    space.add(point_at(body->id(), time).x);
    radii += body->radius;
    ++count;
  }
  if (count == 0) return;
  const double width = 2 * radii / count;
  const Vec3 extent = space.size().cwiseMax(Vec3::Constant(width));
  cell_ = std::max(width, std::cbrt(extent.prod() / count));
}

// What stopped a process may have been mended since: try again.
void Kernel::retry_errors() {
  std::vector<Affected> affected;
  for (const auto& body : bodies) {
    const State* tail = graph.tail(body->process);
    if (tail->error) graph.rollback(body->process, tail->key, affected, removal());
  }
  treat(affected);
}

void Kernel::begin_run() {
  retry_errors();
  if (!newborn_.empty()) {
    update_cell();
    for (const BodyId id : newborn_) check_overlaps(*bodies[id]);
    if (!begun && options.adversary) {
      adversary_ = Random(mix64(options.adversary->seed + 1));
      for (const auto& body : bodies)
        if (options.adversary->some_bodies && adversary_.real() < options.adversary->body_share)
          process(*body).head_start = options.adversary->head_start * adversary_.real();
      for (CallbackRecord& callback : callbacks)
        for (const BodyId id : callback.def.targets)
          callback.head_start = std::max(callback.head_start, process(*bodies[id]).head_start);
    }
    begun = true;
    for (const BodyId id : newborn_) claim_window(*bodies[id]);
    newborn_.clear();
  }
  begun = true;
  if (!counters.energy_known) {
    counters.energy_start = total_energy(time);
    counters.energy_known = true;
  }
}

}  // namespace tw
