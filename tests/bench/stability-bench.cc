// Scenes that break rigid-body simulators, run to their ends: prints the table of doc/stability.md.
//
// Arguments: names of rows (or their beginnings); none: all.  --heaps N: as many random heaps of
// mixed shapes and half as many of angular ones, default 20. A row is given 120 s of CPU.
//
// - at rest: when the last body stopped, or which one is fastest at the end
// - depth: deepest overlap of two bodies at the end, from separation queries; as a share of the
// smaller
//   one's least width
// - rise: the largest rise of the total energy above a level it had fallen to, over the energy at
// the
//   start above the floor
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "support/stability-features.h"

namespace tw::bench {
namespace {

using test::StabilityOutcome;
using test::StabilityScene;

constexpr double budget = 120;  // s

std::vector<StabilityScene> rows(int heaps) {
  using namespace test;
  std::vector<StabilityScene> all;
  for (const int count : {2, 10})
    for (const double ratio : {1e3, 1e6}) all.push_back(column_scene(count, ratio, 10));
  for (const double ratio : {1e3, 1e6}) all.push_back(heavy_blow_scene(ratio, 30));
  all.push_back(column_scene(50, 1, 20));
  for (const int stones : {7, 15, 25}) all.push_back(arch_scene(stones, 0.3, 10));
  for (const double thickness : {2e-3, 3e-4}) all.push_back(card_house_scene(thickness, 0.7, 10));
  for (const double scale : {1e-3, 100.0}) all.push_back(scale_scene(scale));
  all.push_back(unequal_sizes_scene(5));
  all.push_back(rod_scene(1000, 10));
  all.push_back(coin_scene(60, 0.1, 20));
  all.push_back(coin_scene(10, 0.3, 20));
  for (const double off : {-0.1, 0.1}) all.push_back(slope_scene(off, 10));
  for (const double e : {0.0, 1.0}) all.push_back(heap_scene(36, 1, true, e, 10));
  for (int decade = 4; decade <= 10; ++decade)
    all.push_back(stiffness_scene(std::pow(10.0, decade), decade > 4 ? 5 : 25));
  const ShapePtr ball = make_sphere(0.1), box = make_box({0.2, 0.2, 0.1});
  const ShapePtr disc = make_cylinder(0.1, 0.05);
  all.push_back(spin_scene("ball-rolling", ball, 0.1, {0, 1000, 0}, false, 20));
  all.push_back(spin_scene("ball-on-pole", ball, 0.1, {0, 0, 1000}, false, 5));
  all.push_back(spin_scene("box", box, 0.05, {0, 0, 1000}, true, 60));
  all.push_back(spin_scene("disc", disc, 0.025, {0, 0, 1000}, true, 60));
  for (const StabilityScene& scene : feature_scenes()) all.push_back(scene);
  for (int seed = 1; seed <= heaps; ++seed)
    all.push_back(heap_scene(30, static_cast<std::uint64_t>(seed), true, 0.2, 15));
  for (int seed = 1; seed <= heaps / 2; ++seed)
    all.push_back(heap_scene(30, static_cast<std::uint64_t>(seed), false, 0.2, 15));
  return all;
}

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

// What is wrong, or "ok".
std::string verdict(const StabilityScene& scene, const StabilityOutcome& o) {
  if (!o.error.empty()) return "ERROR " + o.error;
  if (o.stalled) return "STALLED at " + number("%.3g s", o.reached);
  if (o.sunk && scene.name.rfind("slope", 0) != 0) return "THROUGH THE FLOOR";
  if (!scene.driven && o.rise_share() > 1e-3)
    return "GAINS ENERGY at " + number("%.4g s", o.rise_time);
  // the softest of the columns is meant to sink in
  if (o.deepest_share > 0.1) return "DEEP: " + o.deepest_pair;
  if (scene.rests && !o.at_rest()) return "NO REST";
  return "ok";
}

void run_row(const StabilityScene& scene) {
  test::StabilityRun run(scene, budget);
  const StabilityOutcome o = run.run();
  const std::string rest =
      o.at_rest() ? number("%.2f", o.rest_time) : o.fastest_body + number(" %.2g m/s", o.fastest);
  const std::string rise = scene.driven ? "driven" : number("%.1e", o.rise_share());
  std::printf("| %s | %s | %g | %.2g | %.2g | %s | %.2g (%.2g %%) | %s | %.3g | %lld | %s |\n",
              scene.name.c_str(), scene.what.c_str(), scene.duration, o.cpu, o.worst_second,
              rest.c_str(), 1e3 * o.deepest, 100 * o.deepest_share, rise.c_str(), o.travel,
              static_cast<long long>(o.collisions), verdict(scene, o).c_str());
  std::fflush(stdout);
}

bool is_wanted(const std::string& name, const std::vector<std::string>& wanted) {
  return wanted.empty() || std::any_of(wanted.begin(), wanted.end(), [&](const std::string& w) {
           return name.compare(0, w.size(), w) == 0;
         });
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  int heaps = 20;
  std::vector<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--heaps" && i + 1 < argc)
      heaps = std::atoi(argv[++i]);
    else
      wanted.push_back(argument);
  }
  std::puts(
      "| row | scene | simulated, s | CPU, s | worst CPU per s | at rest, s | depth, mm |"
      " rise | travel, m | collisions | verdict |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  for (const auto& scene : rows(heaps))
    if (is_wanted(scene.name, wanted)) run_row(scene);
  return 0;
}
