// Cases that are made: which there are, and their bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/made-cases.h"

namespace tw::bench {

using test::CaseBody;
using test::Numbers3;

bool is_simbenchmark(const std::string& name) {
  for (const char* one : {"rolling", "rolling-diagonal", "bouncing", "elastic-666", "666", "kapla"})
    if (name == one) return true;
  return false;
}

bool is_heap(const std::string& name) { return name == "drum" || name == "shaken"; }

bool is_judged_by_depth(const std::string& name) { return is_heap(name) || name == "666"; }

namespace {

constexpr int large_gas = 1600;  // smaller ones are in tables

bool is_large_gas(const std::string& name) { return name == "gas-1600"; }

}  // namespace

test::CaseTable case_named(const std::string& name) {
  if (is_simbenchmark(name)) return simbenchmark_case(name);
  if (is_large_gas(name)) return gas_case(large_gas);
  return is_heap(name) ? heap_case(name) : test::read_table(name);
}

std::vector<std::vector<double>> exact_result(const std::string& name) {
  return is_large_gas(name) ? gas_result(large_gas) : test::read_rows(name + ".exact.txt");
}

CaseBody solid_ball(double radius, double mass, const Numbers3& position) {
  CaseBody body;
  body.shape = "sphere";
  body.size = {radius, 0, 0};
  body.mass = mass;
  const double moment = 0.4 * mass * radius * radius;
  body.inertia = {moment, moment, moment};
  body.position = position;
  return body;
}

CaseBody solid_box(const Numbers3& half_edges, double mass, const Numbers3& position) {
  CaseBody body;
  body.shape = "box";
  body.size = half_edges;
  body.mass = mass;
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = half_edges[(i + 1) % 3], b = half_edges[(i + 2) % 3];
    body.inertia[i] = mass / 3 * (a * a + b * b);
  }
  body.position = position;
  return body;
}

}  // namespace tw::bench
