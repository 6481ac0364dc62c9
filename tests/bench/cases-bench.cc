// Brick, bounce, billiard and two gases: error against the exact results and CPU time, cold and
// warm: a table of doc/performance.md.  Reads tests/data, or the folder that TW_TEST_DATA names.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "../support/case-file.h"
#include "bench-tools.h"

namespace tw::bench {
namespace {

using Exact = std::vector<std::vector<double>>;
// m or rad: what the world's present state is off by.
using ErrorOf = std::function<double(const World&, const Exact&)>;

// The angle between attitudes: 2 |vec(q q_exact*)|.
double attitude_error(const World& world, const Exact& exact) {
  const auto& e = exact.at(0);
  const Quat q(e[3], e[4], e[5], e[6]);
  return 2 * (world.state(0).orientation * q.conjugate()).vec().norm();
}

double height_error(const World& world, const Exact& exact) {
  return std::abs(world.state(1).position.z() - exact.at(0)[0]);
}

double worst_position(const World& world, const Exact& exact) {
  double worst = 0;
  for (const auto& row : exact) {
    const Vec3 x = world.state(static_cast<BodyId>(row[0])).position;
    worst = std::max(worst, (x - Vec3(row[1], row[2], row[3])).norm());
  }
  return worst;
}

void print_case(Table& table, const std::string& name, const std::string& unit,
                const ErrorOf& error_of) {
  constexpr int runs = 50;
  const test::Case c = test::read_case(name);
  const Exact exact = test::read_rows(name + ".exact.txt");
  RunCost best{never, never};
  double cold = 0;
  double error = 0, collisions = 0;
  for (int k = 0; k < runs; ++k) {
    World world;
    test::fill(world, c);
    const RunCost cost = run(world, c.duration);
    // the first run of a process is what a user gets
    if (k == 0) cold = cost.start + cost.loop;
    best.start = std::min(best.start, cost.start);
    best.loop = std::min(best.loop, cost.loop);
    error = error_of(world, exact);
    collisions = statistic(world, "collisions");
  }
  table.row("%s, %g s | %.0f | %.3g | %.3g | %.3g | %.1e %s", name.c_str(), c.duration, collisions,
            1e3 * cold, 1e3 * best.start, 1e3 * best.loop, error, unit.c_str());
}

// Each case in a process of its own, in which nothing has run before.
void print_case_cold(Table& table, const std::string& name, const std::string& unit,
                     const ErrorOf& error_of) {
  const pid_t child = fork();
  if (child != 0) {
    waitpid(child, nullptr, 0);
    return;
  }
  print_case(table, name, unit, error_of);
  _exit(0);
}

}  // namespace
}  // namespace tw::bench

int main() {
  using namespace tw::bench;
  Table table("cases", "case | collisions | cold, ms | start, ms | loop, ms | error");
  print_case_cold(table, "brick", "rad", attitude_error);
  print_case_cold(table, "bounce", "m", height_error);
  print_case_cold(table, "billiard", "m", worst_position);
  print_case_cold(table, "gas-100", "m", worst_position);
  print_case_cold(table, "gas-200", "m", worst_position);
  return 0;
}
