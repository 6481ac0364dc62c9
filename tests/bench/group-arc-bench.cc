// What steps of contact groups cost, and what tolerances buy: Markdown tables.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "analytic/group-arc-scenes.h"
#include "bench/bench-tools.h"

namespace tw {
namespace {

using namespace group_scenes;

struct GroupScene {
  std::string name;
  GroupStart start;
};

std::vector<GroupScene> scenes() {
  std::vector<GroupScene> all;
  GroupStart lands = cube_on_slope(0, 0.5, 0.2, 0.5);
  lands.members[0].x.z() += 0.005;
  lands.members[0].q = rotation_by(Vec3(0.02, 0.01, 0.1));
  lands.members[0].v = Vec3(0.3, 0.1, -0.1);
  all.push_back({"tilted cube lands, slides, stops", lands});
  GroupStart rolls = ball_on_slope(0, 0.3, 0.1, 2);
  rolls.members[0].v = Vec3(1, 0, 0);
  all.push_back({"ball slides, then rolls", rolls});
  all.push_back({"stack of 10, dropped 0.1 mm each", stack(10, 0.5, 0.5, 1e-4)});
  GroupStart pushed = wall(4, 4, 0.5, 0.25, 1e-4);
  pushed.members[13].v = Vec3(0, 0.3, 0);
  all.push_back({"wall of 16, a brick pushed out", pushed});
  all.push_back({"wall of 64, dropped 0.1 mm a row", wall(8, 8, 0.5, 0.1, 1e-4)});
  return all;
}

// Best of five, s.
double best_time(const GroupStart& start, bool extend) {
  double best = 1e300;
  for (int i = 0; i < 5; ++i) {
    const double begin = bench::cpu_seconds();
    GroupArc arc(start);
    if (extend) arc.extend(start.end);
    best = std::min(best, bench::cpu_seconds() - begin);
  }
  return best;
}

double largest_error(GroupArc& arc, GroupArc& reference) {
  double largest = 0;
  const GroupStart& start = arc.start();
  for (std::size_t k = 0; k < start.members.size(); ++k)
    for (int i = 1; i <= 100; ++i) {
      const double time = 0.01 * i * start.end;
      const int member = static_cast<int>(k);
      largest = std::max(
          largest, (arc.evaluate(member, time).x - reference.evaluate(member, time).x).norm());
    }
  return largest;
}

void print_costs() {
  bench::Table table("group-steps", "group | bodies | contacts | making, us | a step, us");
  for (const GroupScene& scene : scenes()) {
    CompleteArc arc(scene.start);
    arc.extend(scene.start.end);
    const double tries = static_cast<double>(arc.counts().steps + arc.counts().rejected);
    const double construction = best_time(scene.start, false), whole = best_time(scene.start, true);
    table.row("%s | %zu | %zu | %.1f | %.2f", scene.name.c_str(), scene.start.members.size(),
              scene.start.contacts.size(), 1e6 * construction,
              1e6 * (whole - construction) / tries);
  }
}

void print_errors(GroupScene scene) {
  std::printf(
      "\n%s, %g s\n\n| tolerance m, m/s | steps + rejected | CPU ms | largest error m "
      "|\n|---|---|---|---|\n",
      scene.name.c_str(), scene.start.end);
  GroupStart exact = scene.start;
  exact.position_tolerance = 1e-10;
  exact.velocity_tolerance = 1e-9;
  CompleteArc reference(exact);
  const std::pair<double, double> tolerances[] = {{1e-4, 1e-3}, {1e-5, 1e-3}, {1e-5, 1e-4},
                                                  {1e-6, 1e-4}, {1e-6, 1e-5}, {1e-7, 1e-6}};
  for (const auto& [position, velocity] : tolerances) {
    scene.start.position_tolerance = position;
    scene.start.velocity_tolerance = velocity;
    CompleteArc arc(scene.start);
    const double error = largest_error(arc, reference);
    std::printf("| %.0e, %.0e | %llu + %llu | %.3g | %.1e |\n", position, velocity,
                static_cast<unsigned long long>(arc.counts().steps),
                static_cast<unsigned long long>(arc.counts().rejected),
                1e3 * best_time(scene.start, true), error);
  }
}

}  // namespace
}  // namespace tw

int main() {
  tw::print_costs();
  for (const tw::GroupScene& scene : tw::scenes())
    if (scene.start.members.size() <= 16) tw::print_errors(scene);
  return 0;
}
