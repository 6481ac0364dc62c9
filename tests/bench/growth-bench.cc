// Growth: heaps of 100, 200, 400, 800 and 1600 rocks, poured into pits whose floor grows with the
// number, so that all have the same six or seven layers.
//
//   growth-bench [DOUBLINGS]    default 4: up to 1600
//
// - moving: CPU over 0.5 to 2 s of the run, in which the rocks fall on the heap and settle
// - events, discontinuities: in that time, for each body
// - at rest: when nothing moved any more (looked at every 0.25 s), or how many still move after 20
// s
// - resting: CPU over the 10 s after that
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench-tools.h"
#include "support/heap-scenes.h"
#include "support/stability-scenes.h"

namespace tw::bench {
namespace {

constexpr int smallest = 100;   // rocks
constexpr double cell = 0.575;  // of the pit's floor, for each rock of a layer, m
constexpr double moving_from = 0.5, moving_until = 2, patience = 20, resting = 10;  // s

// A pit of `across` times `along` cells with walls of fixed boxes.
void add_pit(World& world, int across, int along) {
  const double edges[] = {cell * across, cell * along};
  test::add_block(world, {edges[0] + 2, edges[1] + 2, 1}, {0, 0, -0.5});
  for (const int axis : {0, 1})
    for (const double side : {-1.0, 1.0}) {
      Vec3 size(0.5, 0.5, 8), at(0, 0, 4);
      size[1 - axis] = edges[1 - axis] + 1;
      at[axis] = side * (0.5 * edges[axis] + 0.25);
      test::add_block(world, size, at);
    }
}

// Rocks of 0.3 to 0.45 m in layers 0.6 m apart, let go at rest.
void add_rocks(World& world, int count, int across, int along) {
  Random random(5);
  for (int k = 0; k < count; ++k) {
    const int column = k % across, row = k / across % along, layer = k / (across * along);
    BodyDef def = test::body_of(test::random_stone(random, random.real(0.3, 0.45)), Vec3::Zero(),
                                Vec3::Zero());
    // as far from the walls as their size asks for
    const double pitch = 0.55;
    def.position = Vec3(pitch * (column - 0.5 * (across - 1)), pitch * (row - 0.5 * (along - 1)),
                        0.4 + 0.6 * layer) +
                   test::random_vector(random, 0.03);
    def.orientation = test::random_attitude(random);
    def.density = 2600;
    world.add_body(def);
  }
}

int moving_bodies(const World& world) {
  int moving = 0;
  for (BodyId id = 0; id < world.body_count(); ++id) {
    if (!test::is_dynamic(world, id)) continue;
    const BodyState s = world.state(id);
    moving += s.velocity != Vec3::Zero() || s.angular_velocity != Vec3::Zero();
  }
  return moving;
}

// What happened since the last look.
struct Costs {
  double cpu = 0, events = 0, discontinuities = 0;
  explicit Costs(const World& world)
      : cpu(statistic(world, "cpu_seconds")),
        events(statistic(world, "events")),
        discontinuities(statistic(world, "discontinuities")) {}
};

// Returns the CPU per body and simulated second while moving, s.
double run_row(Table& table, int doublings, double first) {
  const int count = smallest << doublings;
  const int across = 4 << (doublings / 2), along = 4 << ((doublings + 1) / 2);
  World world;
  world.set_accuracy(1e-4);  // as scenes/avalanche.scm
  test::set_contact_for_all(world, 0.2, 0.5);
  add_pit(world, across, along);
  add_rocks(world, count, across, along);

  world.advance(moving_from);
  const Costs before(world);
  world.advance(moving_until);
  const Costs after(world);
  const double each = (after.cpu - before.cpu) / count / (moving_until - moving_from);

  double when = moving_until;
  while (moving_bodies(world) > 0 && when < patience) world.advance(when += 0.25);
  const int moving = moving_bodies(world);
  const std::string rest = moving > 0 ? std::to_string(moving) + " move" : show(when) + " s";
  const double rest_before = Costs(world).cpu;
  world.advance(when + resting);
  const double rest_each = (Costs(world).cpu - rest_before) / count / resting;

  table.row("%d | %.0f | %.0f | %.0f | %.1f | %.2f | %.2f | %s | %.3g", count,
            statistic(world, "largest_group_bodies"), (after.events - before.events) / count,
            (after.discontinuities - before.discontinuities) / count, after.cpu, 1e3 * each,
            first > 0 ? each / first : 1.0, rest.c_str(), 1e6 * rest_each);
  return each;
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  const int most = argc > 1 ? std::atoi(argv[1]) : 4;
  if (argc > 2 || most < 0 || most > 10) {
    std::fprintf(stderr, "usage: %s [DOUBLINGS]     of 100 rocks, 0 to 10\n", argv[0]);
    return 2;
  }
  tw::bench::Table table(
      "growth",
      "N | largest group | events a body | discontinuities a body | CPU until 2 s, s | "
      "moving, ms per body and s | over N = 100 | at rest | resting, us per body and s");
  double first = 0;
  for (int doublings = 0; doublings <= most; ++doublings) {
    const double each = tw::bench::run_row(table, doublings, first);
    if (doublings == 0) first = each;
  }
  return 0;
}
