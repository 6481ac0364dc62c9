// Chains of hinged rods that fall from level: CPU time against the error of the tip after 2 s,
// beside MuJoCo's classical Runge-Kutta method where that is installed.
//
// Rods of 0.2 m and 0.2 kg under 9.81 m/s^2, without damping; whole runs, made from nothing.  The
// error is against a run at the finest accuracy, whose own error the last column bounds: by how
// much a run ten times looser differs from it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cstdio>

#include "bench/bench-tools.h"
#include "bench/chain-mujoco.h"
#include "kernel/world/world.h"

namespace tw::bench {
namespace {

constexpr double duration = 2;

Vec3 tip_at(const World& world, BodyId last) {
  const BodyState state = world.state(last);
  return state.position + state.orientation * Vec3(rod_length, 0, 0);
}

MultibodyDef chain_of(int links) {
  MultibodyDef def;
  def.name = "chain";
  for (int i = 0; i < links; ++i) {
    LinkDef link;
    link.name = "rod-" + std::to_string(i);
    if (i > 0) link.parent = def.links.back().name;
    link.joint.axis = Vec3::UnitY();
    if (i > 0) link.joint.placement.p = {rod_length, 0, 0};
    link.body.mass = rod_mass;
    link.body.inertia = rod_inertia().asDiagonal();
    link.body.center_of_mass = Vec3(0.5 * rod_length, 0, 0);
    def.links.push_back(link);
  }
  return def;
}

struct Run {
  Vec3 tip;
  double cpu = 0;
};

Run run_chain(int links, double accuracy) {
  const double start = cpu_seconds();
  World world;
  world.set_accuracy(accuracy);
  const std::uint32_t chain = world.add_multibody(chain_of(links));
  world.advance(duration);
  Run run{tip_at(world, world.multibody(chain).links.back()), 0};
  run.cpu = cpu_seconds() - start;
  return run;
}

struct Exact {
  Vec3 tip;
  double doubt;  // m
};

// The first run and the best of a few.
template <class Once>
void print_row(Table& table, int links, const std::string& name, const Exact& exact, Once&& once) {
  Run first = once();
  double best = first.cpu, spent = first.cpu;
  for (int i = 0; i < 10 && spent < 2; ++i) {
    const Run again = once();
    best = std::min(best, again.cpu);
    spent += again.cpu;
  }
  table.row("%d | %s | %.1e | %.2f | %.2f | %.0e", links, name.c_str(),
            (first.tip - exact.tip).norm(), 1e3 * first.cpu, 1e3 * best, exact.doubt);
}

void print_chain(Table& table, int links) {
  Exact exact{run_chain(links, 1e-12).tip, 0};
  exact.doubt = (run_chain(links, 1e-11).tip - exact.tip).norm();
  for (const double accuracy : {1e-4, 1e-6, 1e-8, 1e-10}) {
    char name[40];
    std::snprintf(name, sizeof name, "timewarp, %.0e", accuracy);
    print_row(table, links, name, exact, [&] { return run_chain(links, accuracy); });
  }
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    char name[40];
    std::snprintf(name, sizeof name, "MuJoCo, %g ms", 1e3 * step);
    if (run_mujoco_chain(links, step, 0))
      print_row(table, links, name, exact, [&] {
        const double start = cpu_seconds();
        Run run{*run_mujoco_chain(links, step, duration), 0};
        run.cpu = cpu_seconds() - start;
        return run;
      });
  }
}

}  // namespace
}  // namespace tw::bench

int main() {
  tw::bench::Table table("chains",
                         "links | integrator | error of the tip, m | cold, ms | warm, ms | "
                         "known to, m");
  for (const int links : {2, 5, 10, 20}) tw::bench::print_chain(table, links);
}
