// Stepping and measuring for the programs that run the avalanche in other engines.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "other-engine.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "bench-tools.h"

namespace tw::bench {

namespace {

[[noreturn]] void usage(const char* program) {
  std::fprintf(stderr,
               "usage: %s FILE [--until=SECONDS] [--rate=HZ] [--iterations=N] [--sleep]\n"
               "       [--poses=FILE.csv]     FILE is written by dump-bodies.scm\n",
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
  else if (text == "--sleep")
    options.sleep = true;
  else if (text[0] != '-' && options.file.empty())
    options.file = text;
  else
    return false;
  return true;
}

}  // namespace

OtherOptions parse_options(int argc, char** argv) {
  OtherOptions options;
  for (int i = 1; i < argc; ++i)
    if (!read_option(argv[i], options)) usage(argv[0]);
  const bool sane = options.until > 0 && options.rate >= frames_per_second &&
                    options.rate % frames_per_second == 0 && options.iterations >= 0;
  if (options.file.empty() || !sane) usage(argv[0]);
  return options;
}

void run_other_engine(OtherEngine& engine, const OtherScene& scene, const OtherOptions& options) {
  std::vector<OtherState> states = first_states(scene);
  SceneMeter meter(scene);
  meter.look(states);
  std::ofstream poses;
  if (!options.poses.empty()) {
    poses.open(options.poses);
    poses << "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
    write_poses(poses, 0, scene, states);
  }
  std::puts(
      "| s | CPU ms per frame | slowest frame, ms | depth so far, mm | lost | energy, MJ |\n"
      "| --- | --- | --- | --- | --- | --- |");
  std::printf("| 0 | | | %.2f | %d | %.4f |\n", 1e3 * meter.depth(), meter.lost(),
              1e-6 * meter.energy());

  const long frames = std::lround(options.until * frames_per_second);
  const long steps = options.rate / frames_per_second;
  double total = 0, recent = 0, slowest = 0, depth = 0;
  long recent_frames = 0;
  for (long frame = 1; frame <= frames; ++frame) {
    const double before = cpu_seconds();
    for (long k = 0; k < steps; ++k) engine.step(1.0 / static_cast<double>(options.rate));
    const double cost = cpu_seconds() - before;
    total += cost;
    recent += cost;
    ++recent_frames;
    slowest = std::max(slowest, cost);
    fetch(engine, scene, states);
    meter.look(states);
    depth = std::max(depth, meter.depth());
    const double time = static_cast<double>(frame) / frames_per_second;
    if (poses.is_open()) write_poses(poses, time, scene, states);
    if (frame % (5 * frames_per_second) != 0 && frame != frames) continue;
    std::printf("| %g | %.2f | %.1f | %.2f | %d | %.4f |\n", time,
                1e3 * recent / static_cast<double>(recent_frames), 1e3 * slowest, 1e3 * depth,
                meter.lost(), 1e-6 * meter.energy());
    std::fflush(stdout);
    recent = 0;
    recent_frames = 0;
  }
  std::printf("all: %.2f ms per frame, deepest %.2f mm, %d lost\n",
              1e3 * total / static_cast<double>(frames), 1e3 * depth, meter.lost());
}

}  // namespace tw::bench
