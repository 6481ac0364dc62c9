// Avalanches to their ends: one row of a Markdown table for each scene written by dump-bodies.scm.
//
//   avalanche-bench FILE... [--until=SECONDS] [--accuracy=EPS] [--threads=N] [--brief]
//
// Default 45 s, as the scene; fails where a row has a verdict but ok.  --brief: only what other
// engines are compared by (frame-row.h), no heading, no verdict.
//
// - CPU: of the kernel (`cpu_seconds`); reading states and measuring depths is not in it
// - integration, rollback: a moving body's, over the duration; integration beyond the duration
// - step: average integration step over the average time between discontinuities
// - depth: deepest overlap of two bodies at any frame, from our own separation queries
// - lost: rocks whose centre is inside the ground or below it at the end
// - rise: largest rise of the energy from one frame to the next, over the energy at the start
// - at rest: the first frame from which on nothing moves, or how many move at the end
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "bench-tools.h"
#include "frame-row.h"
#include "other-scene.h"

namespace tw::bench {
namespace {

// what a run must keep to
constexpr double most_depth = 2e-3;       // m
constexpr double most_rise = 1e-6;        // of the energy at the start
constexpr double most_integration = 0.2;  // beyond the duration
constexpr double most_rollback = 0.16;    // of the duration

constexpr double scene_accuracy = 1e-3;  // that of scenes/avalanche.scm

struct Outcome {
  std::string error;         // empty: none
  double reached = 0;        // s
  double worst_frame = 0;    // s of CPU
  double measuring = 0;      // s of CPU, outside the kernel
  double wall = 0;           // s, in the kernel
  double depth = 0;          // m
  double depth_time = 0;     // s
  std::string deepest;       // who
  double rise = 0;           // over the energy at the start
  double rise_time = 0;      // s
  double moved = 0;          // s: the last frame at which somebody moved
  int moving = 0, lost = 0;  // at the end
};

class AvalancheRun {
 public:
  AvalancheRun(const OtherScene& scene, double accuracy, int threads);
  // Goes on to `until` or to the first error, frame by frame.
  Outcome run(double until);
  const World& world() const { return world_; }

 private:
  void advance(double when);
  void look();

  const OtherScene& scene_;
  World world_;
  SceneMeter meter_;
  std::vector<OtherState> states_;
  double energy_start_ = 0, energy_ = 0;
  Outcome outcome_;
};

AvalancheRun::AvalancheRun(const OtherScene& scene, double accuracy, int threads)
    : scene_(scene), meter_(scene), states_(first_states(scene)) {
  world_.set_threads(threads);
  world_.set_hash(true);
  world_.set_accuracy(accuracy);
  world_.set_gravity(scene.gravity);
  ContactSettings contact;
  contact.restitution = scene.restitution;
  contact.friction = scene.friction;
  world_.set_contact({}, {}, contact);
  for (const OtherBody& body : scene.bodies) {
    BodyDef def;
    def.shape = body.shape;
    def.position = body.pose.p;
    def.orientation = body.pose.q;
    def.fixed = body.fixed;
    if (!body.fixed) {
      def.mass = body.mass;
      def.inertia = body.inertia;
      def.velocity = body.velocity;
      def.angular_velocity = body.angular_velocity;
    }
    world_.add_body(def);
  }
  energy_start_ = energy_ = world_.total_energy();
}

void AvalancheRun::advance(double when) {
  const double before = statistic(world_, "cpu_seconds"), begun = wall_seconds();
  world_.advance(when);
  outcome_.wall += wall_seconds() - begun;
  outcome_.worst_frame = std::max(outcome_.worst_frame, statistic(world_, "cpu_seconds") - before);
}

void AvalancheRun::look() {
  const double begun = cpu_seconds();
  outcome_.moving = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    const BodyState s = world_.state(static_cast<BodyId>(i));
    states_[i] = {{s.position, s.orientation}, s.velocity, s.angular_velocity};
    outcome_.moving += s.velocity != Vec3::Zero() || s.angular_velocity != Vec3::Zero();
  }
  outcome_.reached = world_.time();
  if (outcome_.moving > 0) outcome_.moved = outcome_.reached;

  meter_.look(states_);
  outcome_.lost = meter_.lost();
  if (meter_.depth() > outcome_.depth) {
    outcome_.depth = meter_.depth();
    outcome_.depth_time = outcome_.reached;
    const auto [rock, other] = meter_.deepest();
    outcome_.deepest = std::to_string(rock) + " in " + std::to_string(other) +
                       (scene_.bodies[other].fixed ? " (ground)" : "");
  }
  const double energy = world_.total_energy();  // the springs', too
  if (energy - energy_ > outcome_.rise * energy_start_) {
    outcome_.rise = (energy - energy_) / energy_start_;
    outcome_.rise_time = outcome_.reached;
  }
  energy_ = energy;
  outcome_.measuring += cpu_seconds() - begun;
}

Outcome AvalancheRun::run(double until) {
  const long frames = std::lround(until * frames_per_second);
  try {
    for (long frame = 1; frame <= frames; ++frame) {
      advance(static_cast<double>(frame) / frames_per_second);
      look();
    }
  } catch (const std::exception& error) {
    outcome_.error = error.what();
    look();
  }
  return outcome_;
}

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

// avalanche-7.bodies -> 7; a name without a number is shown whole.
std::string seed_of(const std::string& file) {
  const std::string name = file.substr(file.find_last_of('/') + 1);
  const std::size_t first = name.find_first_of("0123456789");
  if (first == std::string::npos) return name;
  return name.substr(first, name.find_first_not_of("0123456789", first) - first);
}

// What is wrong, or "ok".
std::string verdict(const Outcome& o, double beyond, double rollback) {
  if (!o.error.empty()) return "ERROR after " + number("%.4f s: ", o.reached) + o.error;
  std::string wrong;
  const auto note = [&](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : ", ") + what;
  };
  note(!(o.depth < most_depth), "DEEP at " + number("%.2f s: ", o.depth_time) + o.deepest);
  note(o.lost > 0, "LOST");
  note(!(o.rise <= most_rise), "GAINS ENERGY at " + number("%.2f s", o.rise_time));
  note(!(beyond <= most_integration), "INTEGRATION");
  note(!(rollback <= most_rollback), "ROLLBACK");
  return wrong.empty() ? "ok" : wrong;
}

constexpr const char* columns =
    "seed | CPU, s | ms a frame | worst frame, ms | collisions | fusions | fissions | "
    "integration, % | rollback, % | step | depth, mm | lost | rise | at rest | measuring, s | "
    "verdict";

// Returns whether all is well.
bool run_row(Table& table, const std::string& file, double until, double accuracy, int threads) {
  const OtherScene scene = read_scene(file);
  AvalancheRun run(scene, accuracy, threads);
  const Outcome o = run.run(until);
  const auto value = [&](const char* name) { return statistic(run.world(), name); };
  const double duration = o.reached > 0 ? o.reached : 1;
  const double cpu = value("cpu_seconds");
  const double beyond = value("integration_per_moving_body") / duration - 1;
  const double rollback = value("rollback_per_moving_body") / duration;
  const double between = value("avg_time_between_discontinuities");
  const double step = between > 0 ? value("avg_integration_step") / between : 0;
  const std::string rest =
      o.moving > 0 ? std::to_string(o.moving) + " move" : number("%.1f s", o.moved);
  const std::string judged = verdict(o, beyond, rollback);
  table.row(
      "%s | %.1f | %.1f | %.0f | %.0f | %.0f | %.0f | %+.1f | %.4f | %.0f | %.3f | %d | %.1e | %s "
      "| "
      "%.1f | %s",
      seed_of(file).c_str(), cpu, 1e3 * cpu / (duration * frames_per_second), 1e3 * o.worst_frame,
      value("collisions"), value("fusions"), value("fissions"), 100 * beyond, 100 * rollback, step,
      1e3 * o.depth, o.lost, o.rise, rest.c_str(), o.measuring, judged.c_str());
  std::fprintf(stderr, "hash %s\n", run.world().history_hash().c_str());
  return judged == "ok";
}

void run_brief_row(const std::string& file, double until, double accuracy, int threads) {
  const OtherScene scene = read_scene(file);
  AvalancheRun run(scene, accuracy, threads);
  const Outcome o = run.run(until);
  if (!o.error.empty()) throw std::runtime_error(o.error);
  const auto a_frame = [&](double seconds) { return seconds / (until * frames_per_second); };
  const int used = static_cast<int>(statistic(run.world(), "threads"));
  FrameRow row;
  row.scene = scene_name(file);
  row.engine = "timewarp, " + number("%.0e", accuracy) +
               (used > 1 ? ", " + std::to_string(used) + " threads" : "");
  row.cpu = a_frame(statistic(run.world(), "cpu_seconds"));
  row.helpers = a_frame(statistic(run.world(), "helper_cpu_seconds"));
  row.wall = a_frame(o.wall);
  row.depth = o.depth;
  row.lost = o.lost;
  row.rise = o.rise;
  print(row);
}

[[noreturn]] void usage(const char* program) {
  std::fprintf(stderr,
               "usage: %s FILE... [--until=SECONDS] [--accuracy=EPS] [--threads=N] [--brief]\n"
               "       FILE is written by dump-bodies.scm; --threads=0: all cores\n",
               program);
  std::exit(2);
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  double until = 45;  // s
  double accuracy = scene_accuracy;
  int threads = 1;
  bool brief = false;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--until=", 0) == 0)
      until = std::atof(argument.c_str() + 8);
    else if (argument.rfind("--accuracy=", 0) == 0)
      accuracy = std::atof(argument.c_str() + 11);
    else if (argument.rfind("--threads=", 0) == 0)
      threads = std::atoi(argument.c_str() + 10);
    else if (argument == "--brief")
      brief = true;
    else if (argument[0] == '-')
      usage(argv[0]);
    else
      files.push_back(argument);
  }
  if (files.empty() || !(until > 0) || !(accuracy > 0)) usage(argv[0]);

  bool good = true;
  try {
    std::optional<Table> table;
    if (!brief) {
      std::printf("%g s; depths at every frame\n\n", until);
      table.emplace("avalanche", columns);
    }
    for (const std::string& file : files)
      if (brief)
        run_brief_row(file, until, accuracy, threads);
      else
        good = run_row(*table, file, until, accuracy, threads) && good;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return good ? 0 : 1;
}
