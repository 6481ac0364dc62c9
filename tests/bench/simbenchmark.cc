// The rigid-body tests of SimBenchmark (github.com/leggedrobotics/SimBenchmark), their metrics, and
// the figures that its authors measured at dt = 1 ms, erp = 0, on an i7-7700HQ.  Prints a Markdown
// table.
//
// - rolling: a box of 10 kg, 20 x 20 x 1 m, with 5 x 5 balls of 1 kg on it, is pushed by 150 N;
//   mean squared velocity error of box and first ball against the closed form, m^2/s^2.  (Ours is
//   all made in the first 50 ms, while the contacts are loaded: 13 mm/s that stay.)
// - bouncing: 49 elastic balls of 10 kg dropped from 5 m; mean squared error of the energy, J^2.
// - 666: 6 x 6 x 6 balls of 10 kg with e = 0, nearly touching; mean of the sum of squared
//   depths, m^2.
// - elastic 666: the same from 1.1 m with e = 1; mean squared error of the energy, J^2.
//
// The means are over time, at 1 kHz.  Arguments name the tests to run; none: all.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/random.h"
#include "bench-tools.h"

namespace tw::bench {
namespace {

constexpr double gravity = 9.81;
constexpr double samples_per_second = 1000;

using Poses = std::span<const BodyPose>;
// What a test is judged by, at one instant.
using Metric = std::function<double(double time, Poses poses)>;

// Gathers the metric of every sample.
class Meter : public FrameSink {
 public:
  explicit Meter(Metric metric) : metric_(std::move(metric)) {}
  void frame(long, double frame_time, Poses poses) override {
    values_.push_back(metric_(frame_time, poses));
  }
  double mean() const {
    return std::accumulate(values_.begin(), values_.end(), 0.0) /
           static_cast<double>(values_.size());
  }

 private:
  Metric metric_;
  std::vector<double> values_;
};

struct Test {
  std::string name, published;
  double duration = 0;  // s
  std::function<Metric(World&)> fill;
  double scale = 0;  // the energy that sqrt(metric) is divided by; 0: the metric as it is
};

void set_contact(World& world, const ContactSide& a, const ContactSide& b, double restitution,
                 double friction) {
  ContactSettings settings;
  settings.restitution = restitution;
  settings.friction = friction;
  world.set_contact(a, b, settings);
}

BodyId add(World& world, const ShapePtr& shape, double mass, const Vec3& position) {
  BodyDef def;
  def.shape = shape;
  def.position = position;
  if (mass > 0)
    def.mass = mass;
  else
    def.fixed = true;
  return world.add_body(def);
}

BodyId add_ground(World& world) {
  return add(world, make_half_space(Vec3::UnitZ(), 0), 0, Vec3::Zero());
}

// ---- energy of balls ----

constexpr double radius = 0.1, mass = 10;

// m v^2/2 + (2/5) m r^2 w^2/2 + m g z
double energy(Poses poses) {
  double sum = 0;
  for (const auto& [body, state] : poses)
    sum += 0.5 * mass * state.velocity.squaredNorm() +
           0.2 * mass * radius * radius * state.angular_velocity.squaredNorm() +
           mass * gravity * state.position.z();
  return sum;
}

// The square of the energy's change since the first sample.
Metric energy_error() {
  auto start = std::make_shared<double>(-1);
  return [start](double, Poses poses) {
    const double now = energy(poses);
    if (*start < 0) *start = now;
    return (now - *start) * (now - *start);
  };
}

// ---- the tests ----

Metric fill_bouncing(World& world) {
  set_contact(world, {}, {}, 1, 0);
  add_ground(world);
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j) add(world, make_sphere(radius), mass, {2.0 * i, 2.0 * j, 5});
  return energy_error();
}

// Lattice with a random shift of up to 1 mm along each axis.
void fill_666(World& world, double restitution, double height) {
  set_contact(world, {}, {}, restitution, 0);
  add_ground(world);
  Random random(42);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = 0.21 * i + random.real(0, 1e-3), y = 0.21 * j + random.real(0, 1e-3);
        const double z = 0.21 * k + random.real(0, 1e-3) + height;
        add(world, make_sphere(radius), mass, {x, y, z});
      }
}

// Sum of squared overlaps of balls with each other and with the ground.
double squared_depths(double, Poses poses) {
  const auto square_of = [](double depth) { return depth > 0 ? depth * depth : 0; };
  double sum = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vec3& x = poses[i].state.position;
    sum += square_of(radius - x.z());
    for (std::size_t j = 0; j < i; ++j)
      sum += square_of(2 * radius - (x - poses[j].state.position).norm());
  }
  return sum;
}

// Balls roll: the box carries 2/7 of their mass along,
// (M + 2/7 n m) a = F - mu (M + n m) g, and each ball accelerates by 2/7 a.
Metric fill_rolling(World& world, const Vec3& direction) {
  constexpr double box_mass = 10, ball_mass = 1, force = 150, mu = 0.4;
  constexpr int side = 5;
  set_contact(world, {}, {}, 0, 0.8);
  const BodyId ground = add_ground(world);
  const BodyId box = add(world, make_box({20, 20, 1}), box_mass, {0, 0, 0.5});
  const auto body = ContactSide::Kind::body;
  set_contact(world, {body, "", ground}, {body, "", box}, 0, mu);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      add(world, make_sphere(0.5), ball_mass, {2.0 * i - 4, 2.0 * j - 4, 1.5});
  world.advance(0);
  world.edit(box, [&](StateView& view) { view.set_applied_force(force * direction); });
  constexpr double balls = side * side * ball_mass;
  constexpr double a = (force - mu * (box_mass + balls) * gravity) / (box_mass + 2.0 / 7 * balls);
  return [direction](double time, Poses poses) {
    const Vec3 expected = a * time * direction;
    return (poses[0].state.velocity - expected).squaredNorm() +
           (poses[1].state.velocity - 2.0 / 7 * expected).squaredNorm();
  };
}

const std::vector<Test>& tests() {
  static const std::vector<Test> all = {
      {"rolling", "see the next", 4, [](World& w) { return fill_rolling(w, Vec3::UnitY()); }, 0},
      {"rolling-diagonal", "Bullet 3.9e-27, RaiSim 4.1e-7, MuJoCo 2e-3 to 7e-3, ODE and DART 3.14",
       4,
       [](World& w) {
         return fill_rolling(w, {0.5, std::sqrt(0.75), 0});
       },
       0},
      {"bouncing", "RaiSim 5.7e-6 in 0.24 s, ODE 5.7e-4 in 1.9 s, Bullet 1.1e-2 in 0.85 s", 20,
       fill_bouncing, 49 * mass * gravity * 5},
      {"elastic-666", "RaiSim 8.4e-5 in 0.66 s, ODE 3.1e-4 in 5.6 s, Bullet 5.9e-3 in 2.3 s", 10,
       [](World& w) { return fill_666(w, 1, 1.101), energy_error(); },
       216 * mass * gravity * (1.101 + 2.5 * 0.21)},
      {"666", "RaiSim 1.35e-4 in 1.5 s, ODE 1.5e-4 in 10 s, DART 2.8e-4, MuJoCo 0.095, Bullet 0.38",
       10, [](World& w) { return fill_666(w, 0, 0.101), Metric(squared_depths); }, 0},
  };
  return all;
}

void run_test(const Test& test) {
  World world;
  const auto meter = std::make_shared<Meter>(test.fill(world));
  world.add_frame_sink(meter, samples_per_second);
  world.advance(test.duration);
  const double metric = meter->mean();
  std::printf("| %s, %g s | %.3g | %s%.2e | %.0f | %.0f | %s |\n", test.name.c_str(), test.duration,
              statistic(world, "cpu_seconds"), test.scale > 0 ? "relative " : "",
              test.scale > 0 ? std::sqrt(metric) / test.scale : metric,
              statistic(world, "collisions"), statistic(world, "groups"), test.published.c_str());
  std::fflush(stdout);
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  const std::set<std::string> wanted(argv + 1, argv + argc);
  std::puts(
      "| test | CPU, s | metric | collisions | groups | published |\n"
      "| --- | --- | --- | --- | --- | --- |");
  for (const Test& test : tests())
    if (wanted.empty() || wanted.count(test.name)) run_test(test);
  return 0;
}
