// What driven arcs cost, and the error got for the accuracy asked for: a table of
// doc/performance.md.
//
// A damped oscillator, a throw with quadratic drag, a brick that tumbles between two springs; of
// each the error, the steps a second and the CPU us a second; errors in sizes of the body, worst
// over 200 times of 10 s against closed forms, or the same at an accuracy of 1e-12.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/cpu-clock.h"
#include "bench/bench-table.h"
#include "integrate/explicit/driven-arc.h"
#include "support/anchored-spring.h"

namespace tw {
namespace {

constexpr double duration = 10;

DrivenStart oscillator() {
  DrivenStart start;
  start.size = 0.5;
  start.gravity = 9.81;
  start.v = {0.6, 0, 0};
  start.forces = with_law(nullptr, test::spring_to({-2, 0, 0}, Vec3::Zero(), {7, 0.5, 2}));
  return start;
}

DrivenStart fall() {
  DrivenStart start = oscillator();
  start.v = {3, 0, 8};
  start.L = {0.1, 0, 0.3};
  start.acceleration = {0, 0, -9.81};
  start.forces = with_law(nullptr, make_drag(0, 0.3));
  return start;
}

DrivenStart tumbling() {
  DrivenStart start = oscillator();
  start.moments = {0.05, 0.1, 0.12};
  start.L = {0.2, 0.3, 0.1};
  start.forces = with_law(with_law(nullptr, test::spring_to({3, 0, 0}, {0.4, 0.1, 0}, {20, 0, 0})),
                          test::spring_to({-3, 0, 0}, {-0.4, 0, 0.1}, {20, 0, 0}));
  return start;
}

double error_of(const DrivenArc& arc, const DrivenArc& exact) {
  double worst = 0;
  for (int i = 1; i <= 200; ++i) {
    const double time = duration * i / 200;
    worst = std::max(worst, (arc.pose(time).p - exact.pose(time).p).norm());
  }
  return worst;
}

// Three cells of a row.
std::string cells(DrivenStart start, double accuracy) {
  start.accuracy = 1e-12;
  start.method = &dop853;
  const DrivenArc exact(start);
  start.method = nullptr;
  start.accuracy = accuracy;
  const DrivenArc arc(start);
  const double error = error_of(arc, exact) / start.size;
  constexpr int repeats = 20;
  const double before = thread_cpu_seconds();
  for (int i = 0; i < repeats; ++i) {
    const DrivenArc again(start);
    for (double t = 0; t < duration; t = again.step_end(t)) {
    }
  }
  const double cpu = (thread_cpu_seconds() - before) / repeats / duration;
  char text[80];
  std::snprintf(text, sizeof text, "%.1e | %.0f | %.0f", error,
                static_cast<double>(arc.effort().steps) / duration, 1e6 * cpu);
  return text;
}

}  // namespace
}  // namespace tw

int main() {
  tw::bench::Table table("driven",
                         "accuracy | oscillator: error | steps | CPU, us | throw: error | steps | "
                         "CPU, us | brick: error | steps | CPU, us");
  for (double accuracy = 1e-3; accuracy > 5e-10; accuracy *= 0.1)
    table.row("%.0e | %s | %s | %s", accuracy, tw::cells(tw::oscillator(), accuracy).c_str(),
              tw::cells(tw::fall(), accuracy).c_str(), tw::cells(tw::tumbling(), accuracy).c_str());
}
