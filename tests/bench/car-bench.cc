// A car that drives a slalom under a controller at 50 Hz: CPU time against the error of its path,
// beside MuJoCo where that is installed.
//
// Contacts differ: each engine's error is against its own finest run, and how far these lie apart
// is told.  Whole runs of 10 s, made from nothing.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cstdio>

#include "bench/bench-tools.h"
#include "bench/car-model.h"
#include "kernel/world/world.h"

namespace tw::bench {
namespace {

constexpr double duration = 10;

LinkDef wheel_link(const CarModel& car, int number, const std::string& parent, const Vec3& place) {
  LinkDef wheel;
  wheel.name = "wheel-" + std::to_string(number);
  wheel.parent = parent;
  wheel.joint.axis = Vec3::UnitY();
  wheel.joint.placement.p = place;
  const Quat sideways(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()));
  wheel.body.shape =
      car.balls ? make_sphere(car.radius)
                : place_shape(make_cylinder(car.radius, car.width), Pose{Vec3::Zero(), sideways});
  wheel.body.mass = car.wheel_mass;
  return wheel;
}

MultibodyDef make_car(const CarModel& car) {
  MultibodyDef def;
  def.name = "car";
  def.free = true;
  def.position = {0, 0, car.height()};
  LinkDef chassis;
  chassis.name = "chassis";
  chassis.body.shape = make_box(car.chassis);
  chassis.body.mass = car.chassis_mass;
  def.links.push_back(chassis);
  for (int i = 0; i < 4; ++i) {
    const Vec3 place(i < 2 ? car.axle : -car.axle, i % 2 == 0 ? car.track : -car.track, -car.drop);
    if (i >= 2) {
      def.links.push_back(wheel_link(car, i, "chassis", place));
      continue;
    }
    LinkDef knuckle;
    knuckle.name = "knuckle-" + std::to_string(i);
    knuckle.parent = "chassis";
    knuckle.joint.axis = Vec3::UnitZ();
    knuckle.joint.placement.p = place;
    knuckle.body.shape = make_box(car.knuckle);
    knuckle.body.mass = car.knuckle_mass;
    def.links.push_back(knuckle);
    def.links.push_back(wheel_link(car, i, knuckle.name, Vec3::Zero()));
  }
  return def;
}

class Driver : public Callback {
 public:
  explicit Driver(const CarModel& car) : car_(car) {}
  std::optional<double> run(double time, std::span<StateView* const> targets) override {
    const multibody::Tree& tree = targets[0]->multibody()->tree;
    targets[0]->change_joints([&](MultibodyState& joints) {
      const std::size_t axes = tree.axes().size();
      joints.servos.resize(axes);
      joints.targets.resize(static_cast<std::size_t>(tree.nq()));
      joints.target_velocities.resize(static_cast<std::size_t>(tree.nv()));
      for (int i = 0; i < tree.link_count(); ++i) {
        const multibody::Link& link = tree.link(i);
        if (link.axes != 1) continue;
        const auto axis = static_cast<std::size_t>(link.first_axis);
        const bool wheel = link.name.starts_with("wheel");
        if (!wheel && !link.name.starts_with("knuckle")) continue;
        joints.servos[axis] = {wheel ? 0 : car_.steering,
                               wheel ? car_.drive : car_.steering_damping};
        joints.targets[static_cast<std::size_t>(link.q)] = wheel ? 0 : car_.angle(time);
        joints.target_velocities[static_cast<std::size_t>(link.u)] =
            wheel ? car_.wheel_speed(time) : 0;
      }
    });
    return std::nullopt;
  }

 private:
  CarModel car_;
};

void add_rules(World& world, const CarModel& car, const Multibody& made) {
  ContactSettings settings;
  settings.friction = car.friction;
  settings.restitution = 0;
  world.set_contact({}, {}, settings);
  // links of one car pass through each other, as in the other engine
  ContactSettings apart;
  apart.collide = false;
  for (const BodyId a : made.links)
    for (const BodyId b : made.links)
      if (a < b)
        world.set_contact({ContactSide::Kind::body, {}, a}, {ContactSide::Kind::body, {}, b},
                          apart);
}

const char* wheels(const CarModel& car) { return car.balls ? "balls" : "cylinders"; }

struct Run {
  Vec3 place;
  double cpu = 0;
};

Run run_car(const CarModel& car, double accuracy) {
  const double start = cpu_seconds();
  World world;
  world.set_accuracy(accuracy);
  BodyDef floor;
  floor.shape = make_half_space(Vec3::UnitZ(), 0);
  floor.fixed = true;
  world.add_body(floor);
  const Multibody& made = world.multibody(world.add_multibody(make_car(car)));
  add_rules(world, car, made);
  CallbackDef driver;
  driver.targets = {made.links.front()};
  driver.callback = std::make_shared<Driver>(car);
  driver.period = car.tick;
  world.add_callback(driver);
  world.advance(duration);
  return {world.state(made.links.front()).position, cpu_seconds() - start};
}

template <class Once>
void print_row(Table& table, const CarModel& car, const std::string& name, const Vec3& exact,
               Once&& once) {
  const Run first = once();
  const double best = std::min(first.cpu, once().cpu);
  table.row("%s | %s | %.1e | %.0f | %.0f", wheels(car), name.c_str(), (first.place - exact).norm(),
            1e3 * first.cpu, 1e3 * best);
}

void print_rows(Table& table, const CarModel& car) {
  const Vec3 ours = run_car(car, 1e-9).place;
  std::fprintf(stderr, "%s: timewarp's finest run ends at (%.6f, %.6f)\n", wheels(car), ours.x(),
               ours.y());
  constexpr double finest_step = 2e-5;
  const auto theirs = run_mujoco_car(car, finest_step, duration);
  if (theirs) std::fprintf(stderr, "MuJoCo's ends at (%.6f, %.6f)\n", theirs->x(), theirs->y());
  for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    char name[40];
    std::snprintf(name, sizeof name, "timewarp, %.0e", accuracy);
    print_row(table, car, name, ours, [&] { return run_car(car, accuracy); });
  }
  if (!theirs) return;
  for (const double step : {5e-3, 2e-3, 1e-3, 5e-4, 1e-4}) {
    char name[40];
    std::snprintf(name, sizeof name, "MuJoCo, %g ms", 1e3 * step);
    print_row(table, car, name, *theirs, [&] {
      const double start = cpu_seconds();
      Run run{*run_mujoco_car(car, step, duration), 0};
      run.cpu = cpu_seconds() - start;
      return run;
    });
  }
}

}  // namespace
}  // namespace tw::bench

int main() {
  tw::bench::Table table("car", "wheels | run | error of the end, m | cold, ms | warm, ms");
  tw::bench::CarModel car;
  for (const bool balls : {false, true}) {
    car.balls = balls;
    tw::bench::print_rows(table, car);
  }
}
