// The world: the public face of the kernel.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/world.h"

#include <cmath>

#include "base/limits.h"
#include "groups/joints/joints.h"
#include "kernel/loop/kernel.h"
#include "kernel/report/reading.h"
#include "kernel/world/bonds.h"
#include "kernel/world/contact-edits.h"
#include "kernel/world/laws.h"
#include "timeline/swept-bounds.h"

namespace tw {

World::World() : kernel_(std::make_unique<Kernel>()) {}
World::~World() = default;

const WorldOptions& World::options() const { return kernel_->simulation.options; }
const Vec3& World::gravity() const { return kernel_->simulation.present.settings.gravity; }

void World::set(const SettingChanges& changes) {
  Simulation& simulation = kernel_->simulation;
  // all is looked at before anything is set
  simulation.require_between_runs("a setting was changed");
  if (const auto& gravity = changes.gravity) {
    TW_REQUIRE(is_finite(*gravity), "gravity is not finite; expected #(x y z) in m/s^2");
    TW_REQUIRE(gravity->norm() <= greatest_acceleration, "gravity is " + show(gravity->norm()) +
                                                             " m/s^2; expected at most " +
                                                             show(greatest_acceleration));
  }
  if (const auto& accuracy = changes.accuracy) {
    simulation.require_before_first_run("accuracy was set");
    TW_REQUIRE(*accuracy >= 1e-12 && *accuracy <= 1e-1,
               "accuracy is " + show(*accuracy) + "; expected a relative error from 1e-12 to 0.1");
  }
  if (const auto& seed = changes.seed) {
    simulation.require_before_first_run("the seed was set");
    TW_REQUIRE(simulation.scene.bodies.empty() || simulation.options.seed == *seed,
               "the seed was set after bodies were added; expected it before them");
  }
  if (const auto& rate = changes.group_check_rate) {
    TW_REQUIRE(*rate > 0 && std::isfinite(*rate),
               "group-check-rate is " + show(*rate) + " Hz; expected a positive number");
    TW_REQUIRE(*rate >= 1 && *rate <= greatest_rate, "group-check-rate is " + show(*rate) +
                                                         " Hz; expected a rate from 1 to " +
                                                         show(greatest_rate) + " Hz");
    simulation.require_before_first_run("group-check-rate was set");
  }
  std::unique_ptr<Policy> policy;
  if (changes.policy) {
    policy = make_policy(*changes.policy);
    simulation.require_before_first_run("the policy was set");
  }

  SceneOptions& settings = simulation.present.settings;
  if (changes.push_overlaps && *changes.push_overlaps != settings.push_overlaps) {
    if (simulation.present.begun) kernel_->discontinuities.restart_future();
    settings.push_overlaps = *changes.push_overlaps;
  }
  if (changes.accuracy) settings.accuracy = *changes.accuracy;
  if (changes.seed) simulation.options.seed = *changes.seed;
  if (changes.group_check_rate) settings.group_check_rate = *changes.group_check_rate;
  if (policy) simulation.policy = std::move(policy);
  if (changes.gravity) kernel_->editing.set_gravity(*changes.gravity);
}

void World::set_gravity(const Vec3& gravity) { set({.gravity = gravity}); }
void World::set_accuracy(double accuracy) { set({.accuracy = accuracy}); }
void World::set_seed(std::uint64_t seed) { set({.seed = seed}); }
void World::set_group_check_rate(double rate) { set({.group_check_rate = rate}); }
void World::set_policy(const std::string& policy) { set({.policy = policy}); }

void World::set_hash(bool on) {
  kernel_->simulation.require_before_first_run("the hash was turned on or off");
  kernel_->simulation.options.hash = on;
}

void World::set_check(bool on) { kernel_->simulation.options.check = on; }
void World::set_undo_redo(bool on) { kernel_->simulation.options.undo_redo = on; }
void World::set_write_states(const std::string& file) {
  kernel_->simulation.options.write_states = file;
}
void World::set_compare_states(const std::string& file) {
  kernel_->simulation.options.compare_states = file;
}
void World::set_gvt_interval(long events) { kernel_->simulation.options.gvt_interval = events; }

void World::set_threads(int threads) {
  TW_REQUIRE(threads >= 0 && threads <= most_threads,
             "threads is " + std::to_string(threads) +
                 "; expected a whole number from 0 (as many as there are cores) to " +
                 std::to_string(most_threads));
  kernel_->simulation.require_between_runs("the number of threads was set");
  kernel_->simulation.options.threads = threads;
  kernel_->simulation.team.reset();
}

void World::set_window_cells(double cells) {
  TW_REQUIRE(cells > 0 && std::isfinite(cells),
             "window is " + show(cells) + " cells; expected a positive number");
  kernel_->simulation.options.window_cells = cells;
}

void World::set_adversary(std::optional<AdversaryOptions> adversary) {
  kernel_->simulation.require_before_first_run("the adversary scheduler was set");
  kernel_->simulation.options.adversary = adversary;
}

void World::set_integrator(const std::string& integrator) {
  TW_REQUIRE(integrator == "auto" || integrator == "rk45",
             "integrator is " + integrator + "; expected auto or rk45");
  TW_REQUIRE(kernel_->simulation.scene.bodies.empty(),
             "the integrator was set when there were bodies; expected it before the first");
  kernel_->simulation.present.settings.cash_karp = integrator == "rk45";
}

void World::set_policy(std::unique_ptr<Policy> policy) {
  kernel_->simulation.require_before_first_run("the policy was set");
  kernel_->simulation.policy = std::move(policy);
}

BodyId World::add_body(const BodyDef& def) { return kernel_->bodies.add(def); }
std::uint32_t World::add_multibody(const MultibodyDef& def) {
  return kernel_->bodies.add_multibody(def);
}
std::size_t World::multibody_count() const { return kernel_->simulation.scene.multibodies.size(); }

const Multibody& World::multibody(std::uint32_t number) const {
  TW_REQUIRE(number < multibody_count(), "multibody " + std::to_string(number) + " does not exist");
  return *kernel_->simulation.scene.multibodies[number];
}

std::optional<std::uint32_t> World::find_multibody(const std::string& name) const {
  for (const auto& multibody : kernel_->simulation.scene.multibodies)
    if (multibody->name == name) return multibody->number;
  return std::nullopt;
}

std::optional<std::uint32_t> World::multibody_of(BodyId id) const {
  const Multibody* multibody = kernel_->simulation.body(id).multibody;
  if (!multibody) return std::nullopt;
  return multibody->number;
}

MultibodyState World::joints(std::uint32_t number) const { return joints(number, time()); }
MultibodyState World::joints(std::uint32_t number, double when) const {
  return *joints_at(*state_at(kernel_->simulation, multibody(number).links.front(), when), when);
}

std::size_t World::body_count() const { return kernel_->simulation.scene.bodies.size(); }

const BodyInfo& World::body(BodyId id) const {
  TW_REQUIRE(id < kernel_->simulation.scene.bodies.size(),
             "body " + std::to_string(id) + " does not exist");
  return kernel_->simulation.scene.bodies[id]->info;
}

std::optional<BodyId> World::find_body(const std::string& name) const {
  return kernel_->bodies.find(name);
}

void World::set_contact(const ContactSide& a, const ContactSide& b,
                        const ContactSettings& settings) {
  const std::pair<ContactSide, ContactSide> sides[] = {{a, b}};
  set_contact(sides, settings);
}
void World::set_contact(std::span<const std::pair<ContactSide, ContactSide>> sides,
                        const ContactSettings& settings) {
  tw::set_contact(*kernel_, sides, settings);
}

ContactParameters World::contact_parameters(BodyId a, BodyId b) const {
  const Scene& scene = kernel_->simulation.scene;
  const Body &one = scene.body(a), &other = scene.body(b);
  ContactParameters parameters = scene.contacts.between(a, b);
  parameters.collide = a != b && one.shape_P && other.shape_P &&
                       (one.dynamic() || other.dynamic()) && scene.may_collide(one, other);
  return parameters;
}

bool World::joined(BodyId a, BodyId b) const {
  const Scene& scene = kernel_->simulation.scene;
  return Scene::are_neighbours(scene.body(a), scene.body(b));
}

ForceHandle World::add_drag(BodyId id, double linear, double quadratic) {
  return tw::add_drag(*kernel_, id, linear, quadratic);
}
ForceHandle World::add_spring(const SpringDef& def) { return tw::add_spring(*kernel_, def); }
void World::attach(BodyId a, BodyId b, const HoldDef& def) { tw::attach(*kernel_, a, b, def); }
void World::detach(BodyId a, BodyId b) { tw::detach(*kernel_, a, b); }
bool World::attached(BodyId a, BodyId b) const { return attached(a, b, time()); }
bool World::attached(BodyId a, BodyId b, double when) const {
  return tw::attached(kernel_->simulation, a, b, when);
}
ForceHandle World::add_force(BodyId id, std::shared_ptr<ForceProcedure> procedure) {
  return tw::add_force(*kernel_, id, std::move(procedure));
}
bool World::acts(const ForceHandle& force) const { return tw::acts(kernel_->simulation, force); }
void World::remove_force(const ForceHandle& force, const std::string& what) {
  tw::remove_force(*kernel_, force, what);
}

std::uint64_t World::serial(BodyId id) const { return kernel_->bodies.serial(id); }
void World::remove_body(BodyId id) { kernel_->bodies.remove(id); }

std::uint64_t World::add_callback(const CallbackDef& def) { return kernel_->add_callback(def); }

void World::add_collision_callback(const CollisionCallbackDef& def) {
  kernel_->add_collision_callback(def);
}

void World::remove_callback(const Callback* callback) { kernel_->remove_callback(callback); }
void World::remove_callback(const CollisionCallback* callback) {
  kernel_->remove_callback(callback);
}

CollisionObserverPtr World::add_collision_observer(CollisionObserver observer, CollisionKind kind,
                                                   Watch watch) {
  return kernel_->add_collision_observer(std::move(observer), kind, watch);
}
void World::remove_observer(const CollisionObserver* observer) {
  kernel_->remove_observer(observer);
}

void World::add_frame_sink(std::shared_ptr<FrameSink> sink, double fps, Watch watch) {
  kernel_->add_frame_sink(std::move(sink), fps, watch);
}

bool World::remove_frame_sink(const FrameSink* sink) { return kernel_->delivery.remove_sink(sink); }
std::vector<double> World::frame_rates() const { return kernel_->delivery.rates(); }

bool World::has(const Callback* callback) const { return kernel_->callbacks.is_called(callback); }
bool World::has(const CollisionCallback* callback) const {
  return kernel_->impacts.is_called(callback);
}
bool World::has(const CollisionObserver* observer) const { return kernel_->delivery.has(observer); }
bool World::has(const FrameSink* sink) const { return kernel_->delivery.has(sink); }

double World::time() const { return kernel_->simulation.present.time; }

RunStatus World::advance(double until, double slice) {
  TW_REQUIRE(until <= greatest_time,
             "until is " + show(until) + " s; expected at most " + show(greatest_time) + " s");
  return kernel_->advance(until, slice);
}

std::optional<StepReport> World::step(double until) { return kernel_->step(until); }
bool World::running() const { return kernel_->simulation.running; }

BodyState World::state(BodyId id) const {
  return body_state(*kernel_->simulation.scene.bodies[id],
                    point_at(kernel_->simulation, id, kernel_->simulation.present.time));
}

double World::kinetic_energy(BodyId id) const { return kinetic_energy(id, time()); }
double World::kinetic_energy(BodyId id, double when) const {
  const Simulation& simulation = kernel_->simulation;
  return tw::kinetic_energy(*simulation.scene.bodies[id], point_at(simulation, id, when));
}

Vec3 World::applied_force(BodyId id) const { return applied_force(id, time()); }
const Vec3& World::applied_force(BodyId id, double when) const {
  return state_at(kernel_->simulation, id, when)->force;
}
Vec3 World::applied_torque(BodyId id) const { return applied_torque(id, time()); }
Vec3 World::applied_torque(BodyId id, double when) const {
  const ForcesPtr& forces = state_at(kernel_->simulation, id, when)->forces;
  return forces ? forces->torque() : Vec3(Vec3::Zero());
}
SlotsPtr World::slots(BodyId id) const { return slots(id, time()); }
const SlotsPtr& World::slots(BodyId id, double when) const {
  return state_at(kernel_->simulation, id, when)->slots;
}

void World::edit(BodyId id, const std::function<void(StateView&)>& change) {
  kernel_->edit(id, change);
}

std::shared_ptr<const Checkpoint> World::checkpoint() { return kernel_->checkpoint(); }
void World::restore(const Checkpoint& checkpoint) { kernel_->restore(checkpoint); }

std::vector<QueuedState> World::state_queue(BodyId id) const {
  const Body& body = kernel_->simulation.body(id);
  std::vector<QueuedState> result;
  for (const State* s = kernel_->simulation.graph.head(body.process); s; s = s->next)
    result.push_back({s->key, s->committed, body_state(body, s->trajectory().at(s->key.time))});
  return result;
}
double World::total_energy() const {
  return tw::total_energy(kernel_->simulation, kernel_->simulation.present.time);
}
ContactSurvey World::survey_contacts(double when) const {
  const Simulation& simulation = kernel_->simulation;
  return tw::survey_contacts(simulation.scene, states_at(simulation, when), when);
}
SensedMotion World::sensed_motion(BodyId id, double when) const {
  const Simulation& simulation = kernel_->simulation;
  return sense_motion(simulation.scene, simulation.body(id), *state_at(simulation, id, when), when);
}
std::vector<ContactReading> World::contacts_of(BodyId id, double when) const {
  const Simulation& simulation = kernel_->simulation;
  const Body& body = simulation.body(id);
  if (body.dynamic()) return tw::contacts_of(body, *state_at(simulation, id, when), when);
  std::vector<ContactReading> contacts = survey_contacts(when).contacts;
  std::erase_if(contacts, [id](const ContactReading& contact) {
    return contact.body1 != id && contact.body2 != id;
  });
  return contacts;
}
Wrench World::pull(BodyId id, BodyId other, PullKind kind, double when) const {
  const Simulation& simulation = kernel_->simulation;
  return sense_pull(simulation.body(id), *state_at(simulation, id, when), other, kind, when);
}
Wrench World::joint_load(std::uint32_t number, int link, double when) const {
  const Simulation& simulation = kernel_->simulation;
  const BodyId first = multibody(number).links.front();
  return sense_joint(simulation.body(first), *state_at(simulation, first, when), link, when);
}
Vec3 World::total_momentum() const {
  return tw::total_momentum(kernel_->simulation, kernel_->simulation.present.time);
}

std::string World::history_hash() const {
  TW_REQUIRE(kernel_->simulation.options.hash,
             "the hash was not asked for; expected --hash, or set_hash before "
             "the first run");
  return tw::history_hash(kernel_->simulation);
}

StatisticsTable World::statistics() const { return kernel_->statistics(); }

std::vector<DearestGroup> World::dearest_groups() const { return kernel_->dearest_groups(); }

}  // namespace tw
