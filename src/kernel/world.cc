// The world: the public face of the kernel.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world.h"

#include <cmath>

#include "kernel/kernel.h"

namespace tw {

World::World() : kernel_(std::make_unique<Kernel>()) {}
World::~World() = default;

const WorldOptions& World::options() const { return kernel_->options; }
const Vec3& World::gravity() const { return kernel_->present.settings.gravity; }

void World::set_gravity(const Vec3& gravity) {
  TW_REQUIRE(gravity.norm() <= greatest_acceleration, "gravity is " + show(gravity.norm()) +
                                                          " m/s^2; expected at most " +
                                                          show(greatest_acceleration));
  kernel_->set_gravity(gravity);
}

void World::set_accuracy(double accuracy) {
  kernel_->require_before_first_run("accuracy was set");
  TW_REQUIRE(accuracy >= 1e-12 && accuracy <= 1e-1,
             "accuracy is " + show(accuracy) + "; expected a relative error from 1e-12 to 0.1");
  kernel_->present.settings.accuracy = accuracy;
}

void World::set_seed(std::uint64_t seed) {
  kernel_->require_before_first_run("the seed was set");
  TW_REQUIRE(kernel_->scene.bodies.empty() || kernel_->options.seed == seed,
             "the seed was set after bodies were added; expected it before them");
  kernel_->options.seed = seed;
}

void World::set_hash(bool on) {
  kernel_->require_before_first_run("the hash was turned on or off");
  kernel_->options.hash = on;
}

void World::set_check(bool on) { kernel_->options.check = on; }
void World::set_undo_redo(bool on) { kernel_->options.undo_redo = on; }
void World::set_gvt_interval(long events) { kernel_->options.gvt_interval = events; }

void World::set_window_cells(double cells) {
  TW_REQUIRE(cells > 0 && std::isfinite(cells),
             "window is " + show(cells) + " cells; expected a positive number");
  kernel_->options.window_cells = cells;
}

void World::set_group_check_rate(double rate) {
  TW_REQUIRE(rate > 0 && std::isfinite(rate),
             "group-check-rate is " + show(rate) + " Hz; expected a positive number");
  TW_REQUIRE(rate >= 1 && rate <= greatest_rate, "group-check-rate is " + show(rate) +
                                                     " Hz; expected a rate from 1 to " +
                                                     show(greatest_rate) + " Hz");
  kernel_->require_before_first_run("group-check-rate was set");
  kernel_->present.settings.group_check_rate = rate;
}

void World::set_adversary(std::optional<AdversaryOptions> adversary) {
  kernel_->require_before_first_run("the adversary scheduler was set");
  kernel_->options.adversary = adversary;
}

void World::set_policy(const std::string& policy) { set_policy(make_policy(policy)); }

void World::set_policy(std::unique_ptr<Policy> policy) {
  kernel_->require_before_first_run("the policy was set");
  kernel_->policy = std::move(policy);
}

BodyId World::add_body(const BodyDef& def) { return kernel_->add_body(def); }
std::size_t World::body_count() const { return kernel_->scene.bodies.size(); }

const BodyInfo& World::body(BodyId id) const {
  TW_REQUIRE(id < kernel_->scene.bodies.size(), "body " + std::to_string(id) + " does not exist");
  return kernel_->scene.bodies[id]->info;
}

std::optional<BodyId> World::find_body(const std::string& name) const {
  const auto found = kernel_->names.find(name);
  if (found == kernel_->names.end()) return std::nullopt;
  return found->second;
}

void World::set_contact(const ContactSide& a, const ContactSide& b,
                        const ContactSettings& settings) {
  kernel_->set_contact(a, b, settings);
}

ContactParameters World::contact_parameters(BodyId a, BodyId b) const {
  return kernel_->scene.contacts.between(a, b);
}

std::uint64_t World::removals() const { return kernel_->present.removals; }
void World::remove_body(BodyId id) { kernel_->remove_body(id); }

std::uint64_t World::add_callback(const CallbackDef& def) { return kernel_->add_callback(def); }

void World::add_collision_callback(const CollisionCallbackDef& def) {
  kernel_->add_collision_callback(def);
}

void World::add_collision_observer(CollisionObserver observer, CollisionKind kind) {
  kernel_->add_collision_observer(std::move(observer), kind);
}

void World::add_frame_sink(std::shared_ptr<FrameSink> sink, double fps) {
  kernel_->add_frame_sink(std::move(sink), fps);
}

void World::remove_frame_sink(const FrameSink* sink) { kernel_->remove_frame_sink(sink); }

double World::time() const { return kernel_->present.time; }

RunStatus World::advance(double until, double slice) {
  TW_REQUIRE(until <= greatest_time,
             "until is " + show(until) + " s; expected at most " + show(greatest_time) + " s");
  return kernel_->advance(until, slice);
}

bool World::step(double until) { return kernel_->step(until); }
bool World::running() const { return kernel_->running; }

BodyState World::state(BodyId id) const {
  return body_state(*kernel_->scene.bodies[id], kernel_->point_at(id, kernel_->present.time));
}

double World::kinetic_energy(BodyId id) const {
  return tw::kinetic_energy(*kernel_->scene.bodies[id],
                            kernel_->point_at(id, kernel_->present.time));
}

Vec3 World::applied_force(BodyId id) const {
  return kernel_->state_at(id, kernel_->present.time)->force;
}
SlotsPtr World::slots(BodyId id) const {
  return kernel_->state_at(id, kernel_->present.time)->slots;
}

void World::edit(BodyId id, const std::function<void(StateView&)>& change) {
  kernel_->edit(id, change);
}

std::shared_ptr<const Checkpoint> World::checkpoint() { return kernel_->checkpoint(); }
void World::restore(const Checkpoint& checkpoint) { kernel_->restore(checkpoint); }

std::vector<QueuedState> World::state_queue(BodyId id) const { return kernel_->state_queue(id); }
double World::total_energy() const { return kernel_->total_energy(kernel_->present.time); }
ContactSurvey World::survey_contacts(double when) const { return kernel_->survey_contacts(when); }
Vec3 World::total_momentum() const { return kernel_->total_momentum(kernel_->present.time); }

std::string World::history_hash() const {
  TW_REQUIRE(kernel_->options.hash,
             "the hash was not asked for; expected --hash, or set_hash before "
             "the first run");
  return kernel_->history_hash();
}

StatisticsTable World::statistics() const { return kernel_->statistics(); }

}  // namespace tw
