// Stepping and measuring for the programs that run the avalanche in other engines.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "other-engine.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>

#include "bench-tools.h"
#include "frame-row.h"

namespace tw::bench {

namespace {

constexpr long highest_rate = 3840;  // Hz; a search for a depth ends there

[[noreturn]] void usage(const char* program) {
  std::fprintf(stderr,
               "usage: %s FILE [--until=SECONDS] [--rate=HZ] [--iterations=N] [--sleep]\n"
               "       [--poses=FILE.csv] [--brief] [--depth=MM]\n"
               "       FILE is written by dump-bodies.scm; --depth: doubles the rate until\n"
               "       nothing overlaps deeper\n",
               program);
  std::exit(2);
}

// Asks the engine for the states of the moving bodies.
void fetch(const OtherEngine& engine, const OtherScene& scene, std::vector<OtherState>& states) {
  for (std::size_t i = 0; i < states.size(); ++i)
    if (!scene.bodies[i].fixed) states[i] = engine.state(i);
}

void write_poses(std::ostream& out, double time, const OtherScene& scene,
                 const std::vector<OtherState>& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    const auto& [pose, v, w] = states[i];
    out << time << ',' << i << ',' << pose.p.x() << ',' << pose.p.y() << ',' << pose.p.z() << ','
        << pose.q.w() << ',' << pose.q.x() << ',' << pose.q.y() << ',' << pose.q.z() << ',' << v.x()
        << ',' << v.y() << ',' << v.z() << ',' << w.x() << ',' << w.y() << ',' << w.z() << '\n';
  }
}

bool read_option(const std::string& text, OtherOptions& options) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  if (name == "--until")
    options.until = std::atof(value.c_str());
  else if (name == "--rate")
    options.rate = std::atol(value.c_str());
  else if (name == "--iterations")
    options.iterations = std::atoi(value.c_str());
  else if (name == "--poses")
    options.poses = value;
  else if (name == "--depth")
    options.depth = 1e-3 * std::atof(value.c_str());
  else if (text == "--brief")
    options.brief = true;
  else if (text == "--sleep")
    options.sleep = true;
  else if (text[0] != '-' && options.file.empty())
    options.file = text;
  else
    return false;
  return true;
}

OtherOptions parse_options(int argc, char** argv) {
  OtherOptions options;
  for (int i = 1; i < argc; ++i)
    if (!read_option(argv[i], options)) usage(argv[0]);
  const bool sane = options.until > 0 && options.rate >= frames_per_second &&
                    options.rate % frames_per_second == 0 && options.iterations >= 0 &&
                    options.depth > 0;
  if (options.file.empty() || !sane) usage(argv[0]);
  return options;
}

// A run at one rate: what it cost, and a table every 5 s unless it is to be brief.
class EngineRun {
 public:
  EngineRun(const EngineKind& kind, const OtherScene& scene, const OtherOptions& options);
  FrameRow run();

 private:
  // Returns the CPU of the frame, s.
  double step_frame();
  void look(double time);
  void print_part(double time, double mean) const;

  const OtherScene& scene_;
  const OtherOptions& options_;
  std::unique_ptr<OtherEngine> engine_;
  std::vector<OtherState> states_;
  SceneMeter meter_;
  std::ofstream poses_;
  double energy_start_ = 0, energy_ = 0, slowest_ = 0;
  FrameRow row_;
};

EngineRun::EngineRun(const EngineKind& kind, const OtherScene& scene, const OtherOptions& options)
    : scene_(scene),
      options_(options),
      engine_(kind.make(scene, options)),
      states_(first_states(scene)),
      meter_(scene) {
  row_.scene = scene_name(options.file);
  row_.engine = kind.name + ", 1/" + std::to_string(options.rate) + " s";
  meter_.look(states_);
  energy_start_ = energy_ = meter_.energy();
  if (options.poses.empty()) return;
  poses_.open(options.poses);
  poses_ << "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
  write_poses(poses_, 0, scene, states_);
}

double EngineRun::step_frame() {
  const long steps = options_.rate / frames_per_second;
  const double before = cpu_seconds(), begun = wall_seconds();
  for (long k = 0; k < steps; ++k) engine_->step(1.0 / static_cast<double>(options_.rate));
  row_.wall += wall_seconds() - begun;
  const double cost = cpu_seconds() - before;
  row_.cpu += cost;
  slowest_ = std::max(slowest_, cost);
  return cost;
}

void EngineRun::look(double time) {
  fetch(*engine_, scene_, states_);
  meter_.look(states_);
  row_.depth = std::max(row_.depth, meter_.depth());
  row_.lost = meter_.lost();
  row_.rise = std::max(row_.rise, (meter_.energy() - energy_) / energy_start_);
  energy_ = meter_.energy();
  if (poses_.is_open()) write_poses(poses_, time, scene_, states_);
}

void EngineRun::print_part(double time, double mean) const {
  if (options_.brief) return;
  std::printf("| %g | %.2f | %.1f | %.2f | %d | %.4f |\n", time, 1e3 * mean, 1e3 * slowest_,
              1e3 * row_.depth, meter_.lost(), 1e-6 * meter_.energy());
  std::fflush(stdout);
}

FrameRow EngineRun::run() {
  if (!options_.brief)
    std::printf(
        "%s\n| s | CPU ms per frame | slowest frame, ms | depth so far, mm | lost | energy, MJ |\n"
        "| --- | --- | --- | --- | --- | --- |\n",
        row_.engine.c_str());
  print_part(0, 0);
  const long frames = std::lround(options_.until * frames_per_second);
  double recent = 0;
  long recent_frames = 0;
  for (long frame = 1; frame <= frames; ++frame) {
    recent += step_frame();
    ++recent_frames;
    const double time = static_cast<double>(frame) / frames_per_second;
    look(time);
    if (frame % (5 * frames_per_second) != 0 && frame != frames) continue;
    print_part(time, recent / static_cast<double>(recent_frames));
    recent = 0;
    recent_frames = 0;
  }
  row_.cpu /= static_cast<double>(frames);
  row_.wall /= static_cast<double>(frames);
  return row_;
}

void report(const FrameRow& row, bool brief) {
  if (brief)
    print(row);
  else
    std::printf("all: %.2f ms per frame, deepest %.2f mm, %d lost\n", 1e3 * row.cpu,
                1e3 * row.depth, row.lost);
}

}  // namespace

int run_other_engine(const EngineKind& kind, int argc, char** argv) {
  OtherOptions options = parse_options(argc, argv);
  try {
    const OtherScene scene = read_scene(options.file);
    FrameRow row;
    do {
      row = EngineRun(kind, scene, options).run();
      report(row, options.brief);
      options.rate *= 2;
    } while (row.depth > options.depth && options.rate <= highest_rate);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace tw::bench
