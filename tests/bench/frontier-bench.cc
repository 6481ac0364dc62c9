// What a frame costs when a scene is stepped as one cluster, against the depth that is asked for:
// one row for each scene and depth.
//
//   frontier-bench [--until=SECONDS] [--depth=M,M,...] FILE...
//
// FILE is written by dump-bodies.scm.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench-tools.h"
#include "frame-row.h"
#include "integrate/stepped/stepped-cluster.h"
#include "other-scene.h"

namespace tw::bench {
namespace {

SteppedCluster cluster_of(const OtherScene& scene, const StepSettings& settings) {
  std::vector<StepMember> members;
  std::vector<StepOutside> outside;
  for (const OtherBody& body : scene.bodies) {
    if (body.fixed) {
      outside.push_back({body.shape, body.pose, nullptr});
      continue;
    }
    StepMember member;
    member.shape = body.shape;
    member.mass = body.mass;
    member.inertia = body.inertia;
    member.radius = body.shape->radius_about_origin();
    member.size = body.shape->least_width();
    member.x = body.pose.p;
    member.q = body.pose.q;
    member.v = body.velocity;
    member.w = body.angular_velocity;
    member.force = body.mass * scene.gravity;
    members.push_back(member);
  }
  const StepLaw law{scene.friction, scene.restitution};
  return {std::move(members), std::move(outside), [law](int, int) { return law; },
          scene.gravity,      settings,           0};
}

// By depth: what the prototype's frontier was made with.
StepSettings settings_for(double depth) {
  StepSettings settings;
  settings.depth = depth;
  settings.step = 1.0 / (depth > 9e-3 ? 120 : depth > 1.5e-3 ? 240 : 480);
  settings.follow = depth > 4e-3 ? 0.03 : depth > 1.5e-3 ? 0.02 : depth > 0.8e-3 ? 0.01 : 0.005;
  settings.substeps = (depth < 4e-3 && depth > 1.5e-3) || depth < 0.8e-3 ? 4 : 2;
  return settings;
}

void run(const std::string& file, double depth, double until) {
  const OtherScene scene = read_scene(file);
  SceneMeter meter(scene);
  std::vector<OtherState> states = first_states(scene);
  meter.look(states);
  const double start = meter.energy();
  double energy = start, slowest = 0;
  const StepSettings settings = settings_for(depth);
  SteppedCluster cluster = cluster_of(scene, settings);
  FrameRow row;
  row.scene = scene_name(file);
  row.engine = "stepped, " + std::to_string(depth * 1e3).substr(0, 4) + " mm";
  const long frames = std::lround(until * frames_per_second);
  const long steps = std::lround(1 / (frames_per_second * settings.step));
  for (long frame = 0; frame < frames; ++frame) {
    const double cpu = cpu_seconds(), wall = wall_seconds();
    for (long i = 0; i < steps; ++i) cluster.advance();
    const double spent = cpu_seconds() - cpu;
    row.cpu += spent;
    slowest = std::max(slowest, spent);
    row.wall += wall_seconds() - wall;
    int member = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].fixed) continue;
      const PoseTwist at = cluster.state(member++);
      states[i] = {{at.x, at.q}, at.v, at.w};
    }
    meter.look(states);
    row.depth = std::max(row.depth, meter.depth());
    row.rise = std::max(row.rise, (meter.energy() - energy) / start);
    energy = meter.energy();
  }
  row.cpu /= static_cast<double>(frames);
  row.wall /= static_cast<double>(frames);
  row.lost = meter.lost();
  print(row);
  const StepCounts counts = cluster.counts();
  const double per = 1 / static_cast<double>(counts.steps);
  const auto mean = [&](std::uint64_t count) { return static_cast<double>(count) * per; };
  std::printf(
      "  steps %.2f of the lattice's, halved %.3f; a step: looks %.0f follows %.0f skips %.0f "
      "refits "
      "%.1f contacts %.0f; slowest frame %.1f ms; own depth %.2f mm; energy %.6g -> %.6g J\n",
      static_cast<double>(counts.steps) / static_cast<double>(frames * steps),
      mean(counts.halvings), mean(counts.looks), mean(counts.follows), mean(counts.skips),
      mean(counts.refits), mean(counts.contacts), 1e3 * slowest, 1e3 * cluster.deepest(), start,
      energy);
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  double until = 10;
  std::vector<double> depths{20e-3, 10e-3, 5e-3, 2e-3, 1e-3, 0.5e-3};
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--until=")) {
      until = std::atof(word.c_str() + 8);
    } else if (word.starts_with("--depth=")) {
      depths.clear();
      for (char* next = argv[i] + 8; *next; next += *next == ',')
        depths.push_back(std::strtod(next, &next));
    } else {
      for (const double depth : depths) run(word, depth, until);
    }
  }
}
