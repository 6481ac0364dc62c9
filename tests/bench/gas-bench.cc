// What an elastic gas costs, beside the dedicated event-driven program, in the same run; and
// whether memory stays bounded over 1e6 collisions: two tables of doc/performance.md.
//
//   gas-bench            both tables
//   gas-bench N RUNS     one row: for profilers
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "bench-tools.h"
#include "event-driven-md.h"

namespace tw::bench {
namespace {

constexpr double duration = 2;  // s

// Spheres get the gas's numbers as ids; the walls are six half-spaces.
void fill(World& world, const Gas& gas) {
  world.set_threads(1);  // as the other program
  world.set_gravity(Vec3::Zero());
  ContactSettings elastic;
  elastic.restitution = 1;
  elastic.friction = 0;
  world.set_contact({}, {}, elastic);
  const ShapePtr sphere = make_sphere(gas.radius);
  for (std::size_t i = 0; i < gas.position.size(); ++i) {
    BodyDef def;
    def.shape = sphere;
    def.position = gas.position[i];
    def.velocity = gas.velocity[i];
    world.add_body(def);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true}) {
      const Vec3 inwards = (far ? -1 : 1) * Vec3::Unit(axis);
      BodyDef def;
      def.shape = make_half_space(inwards, far ? -gas.side : 0);
      def.fixed = true;
      world.add_body(def);
    }
}

struct Row {
  double md = never, loop = never, start = never;  // s, best of the runs
  long collisions = 0;
  double apart = 0;  // m, the worst sphere's distance
};

// Both programs by turns, so that whatever else the machine does meets both.
Row measure(int count, int runs) {
  const Gas gas = make_gas(count);
  Row row;
  for (int k = 0; k < runs; ++k) {
    EventDrivenMd md(gas);
    const double before = cpu_seconds();
    md.advance(duration);
    row.md = std::min(row.md, cpu_seconds() - before);

    World world;
    fill(world, gas);
    const RunCost cost = run(world, duration);
    row.start = std::min(row.start, cost.start);
    row.loop = std::min(row.loop, cost.loop);
    row.collisions = static_cast<long>(statistic(world, "collisions"));

    if (row.collisions != md.pair_collisions() + md.wall_collisions())
      std::printf("collisions differ: %ld and %ld\n", row.collisions,
                  md.pair_collisions() + md.wall_collisions());
    for (int i = 0; i < count; ++i) {
      const Vec3 x = world.state(static_cast<BodyId>(i)).position;
      row.apart = std::max(row.apart, (x - md.position(i)).norm());
    }
  }
  return row;
}

double per_collision(const Row& row) {
  return 1e6 * row.loop / static_cast<double>(row.collisions);
}

constexpr const char* columns =
    "N | collisions | event-driven, ms | timewarp, ms | ratio | us per collision | start, ms | "
    "apart, m";

Row print_row(Table& table, int count, int runs) {
  const Row row = measure(count, runs);
  table.row("%d | %ld | %.3g | %.3g | %.2f | %.2f | %.2g | %.1e", count, row.collisions,
            1e3 * row.md, 1e3 * row.loop, row.loop / row.md, per_collision(row), 1e3 * row.start,
            row.apart);
  return row;
}

void print_growth() {
  Table table("gas", columns);
  Row first, last;
  for (const int count : {200, 400, 800, 1600, 3200}) {
    last = print_row(table, count, std::max(10, 16000 / count));
    if (count == 200) first = last;
  }
  std::printf(
      "\nFrom N = 200 to 3200 the cost per collision grows by %.2f, per sphere and second by "
      "%.2f (event-driven: %.2f and %.2f).\n\n",
      per_collision(last) / per_collision(first), last.loop / first.loop / 16,
      last.md / first.md * static_cast<double>(first.collisions) /
          static_cast<double>(last.collisions),
      last.md / first.md / 16);
}

// gas-200 until 1e6 collisions are committed, looked at every 1e5.
void print_memory() {
  World world;
  fill(world, make_gas(200));
  Table table("memory",
              "collisions | simulated, s | CPU, s | peak states | peak resident, MB | "
              "energy drift");
  double next = 1e5;
  for (double until = 25; next <= 1e6; until += 25) {
    world.advance(until);
    const double collisions = statistic(world, "collisions");
    if (collisions < next) continue;
    const double energy = statistic(world, "energy_start");
    table.row("%.0f | %.0f | %.2f | %.0f | %.1f | %.1e", collisions, until,
              statistic(world, "cpu_seconds"), statistic(world, "peak_states"),
              statistic(world, "peak_rss_bytes") / 1e6,
              std::abs(statistic(world, "energy_end") - energy) / energy);
    next += next < 2e5 ? 1e5 : 2e5;
  }
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  if (argc > 2) {
    tw::bench::Table table("gas-row", tw::bench::columns);
    tw::bench::print_row(table, std::atoi(argv[1]), std::atoi(argv[2]));
    return 0;
  }
  tw::bench::print_growth();
  tw::bench::print_memory();
  return 0;
}
