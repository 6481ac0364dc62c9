// Cases with exact results in any engine: run time against error, as lines of CSV.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/engine-cases.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>

#include "base/cpu-clock.h"
#include "math/vec.h"

namespace tw::bench {

namespace {

using test::CaseTable;
using test::Numbers3;
using Rows = std::vector<std::vector<double>>;

constexpr double settled = 1;   // s: the second error of what should stand still counts from here
constexpr double budget = 0.3;  // CPU s for the runs after the first
constexpr int most_runs = 30;
// CPU s, of all runs of a setting: the next one, with steps a quarter as long, is left out then
constexpr double longest = 3;
constexpr rlim_t too_long = 60;  // CPU s: a process is ended then

const char* const case_names[] = {"brick", "bounce", "billiard", "gas-200",
                                  "slide", "creep",  "stack",    "chain-5"};

bool stands_still(const std::string& name) { return name == "creep" || name == "stack"; }

Rows exact_rows(const std::string& name) {
  if (name == "slide" || stands_still(name)) return {};
  return test::read_rows(name + ".exact.txt");
}

Vec3 vector_of(const Numbers3& x) { return {x[0], x[1], x[2]}; }
Quat rotation_of(const std::array<double, 4>& q) { return Quat(q[0], q[1], q[2], q[3]); }

Vec3 position(const CaseEngine& engine, std::size_t body) {
  return vector_of(engine.pose(body).position);
}

double attitude_error(const CaseEngine& engine, const Rows& exact) {
  const auto& e = exact.at(0);
  const Quat q(e[3], e[4], e[5], e[6]);
  return 2 * (rotation_of(engine.pose(0).orientation).normalized() * q.conjugate()).vec().norm();
}

double worst_position(const CaseEngine& engine, const Rows& exact) {
  double worst = 0;
  for (const auto& row : exact) {
    const Vec3 x = position(engine, static_cast<std::size_t>(row[0]));
    const double off = (x - Vec3(row[1], row[2], row[3])).norm();
    // a NaN is to stay one
    if (!(off <= worst)) worst = off;
  }
  return worst;
}

// Of the far end of the last rod.
double tip_error(const CaseEngine& engine, const CaseTable& c, const Rows& exact) {
  const EnginePose last = engine.pose(c.bodies.size() - 1);
  const Vec3 half(0.5 * c.bodies.back().size[0], 0, 0);
  const Vec3 tip = vector_of(last.position) + rotation_of(last.orientation).normalized() * half;
  return (tip - Vec3(exact.at(0)[0], exact[0][1], exact[0][2])).norm();
}

// Of the ground, the first body.
Vec3 normal_of(const CaseTable& c) { return rotation_of(c.bodies[0].orientation) * Vec3::UnitZ(); }

// Where a cube is on a slope under Coulomb's friction that does not hold it: along the slope, for
// how deep it sinks in is each engine's own law of contact.
double slide_error(const CaseEngine& engine, const CaseTable& c) {
  const Vec3 normal = normal_of(c), gravity = vector_of(c.gravity);
  const double press = -gravity.dot(normal);
  const Vec3 pull = gravity + press * normal;
  const double rate = pull.norm() - c.friction * press;
  const double way = 0.5 * rate * c.duration * c.duration;
  const Vec3 moved = position(engine, 1) - vector_of(c.bodies[1].position);
  return std::abs(moved.dot(pull.normalized()) - way);
}

std::vector<Vec3> positions(const CaseEngine& engine, const CaseTable& c) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < c.bodies.size(); ++i)
    result.push_back(c.bodies[i].fixed ? vector_of(c.bodies[i].position) : position(engine, i));
  return result;
}

// On a slope the part along it.
double drift(const std::vector<Vec3>& from, const std::vector<Vec3>& to, const CaseTable& c) {
  const Vec3 normal = normal_of(c);
  const bool slope = normal.z() < 0.999;
  double worst = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    Vec3 d = to[i] - from[i];
    if (slope) d -= normal.dot(d) * normal;
    if (!(d.norm() <= worst)) worst = d.norm();
  }
  return worst;
}

// CPU of the loop, and errors: from the start and, of what should stand still, after a second.
struct Result {
  double cpu = 0, error = 0, error_settled = 0;
};

Result run_once(const CaseRunner& runner, const CaseTable& c, const Setting& setting,
                const Rows& exact) {
  const std::string& name = c.name;
  const auto engine = runner.make(c, setting);
  Result result;
  const std::vector<Vec3> start = positions(*engine, c);
  std::vector<Vec3> middle;
  const auto advance = [&](double duration) {
    const double before = thread_cpu_seconds();
    engine->advance(duration);
    result.cpu += thread_cpu_seconds() - before;
  };
  if (stands_still(name)) {
    advance(settled);
    middle = positions(*engine, c);
    advance(c.duration - settled);
    const std::vector<Vec3> end = positions(*engine, c);
    result.error = drift(start, end, c);
    result.error_settled = drift(middle, end, c);
    return result;
  }
  advance(c.duration);
  if (name == "brick")
    result.error = attitude_error(*engine, exact);
  else if (name == "bounce")
    result.error = std::abs(position(*engine, 1).z() - exact.at(0)[0]);
  else if (!c.hinges.empty())
    result.error = tip_error(*engine, c, exact);
  else if (name == "slide")
    result.error = slide_error(*engine, c);
  else
    result.error = worst_position(*engine, exact);
  return result;
}

struct Line {
  const CaseRunner& runner;
  std::string name;
  Setting setting;

  void print(double cold, double best, double error) const {
    std::printf("%s,%s,%s,%s,%.4g,%.4g,", runner.engine.c_str(), runner.version.c_str(),
                name.c_str(), setting.text.c_str(), cold, best);
    if (std::isfinite(error))
      std::printf("%.3g,%s,\n", error, name == "brick" ? "rad" : "m");
    else
      std::printf(",%s,unstable\n", name == "brick" ? "rad" : "m");
  }
  void fail(const std::string& why) const {
    std::printf("%s,%s,%s,%s,,,,%s,%s\n", runner.engine.c_str(), runner.version.c_str(),
                name.c_str(), setting.text.c_str(), name == "brick" ? "rad" : "m", why.c_str());
  }
};

void measure(const CaseRunner& runner, const std::string& name, const Setting& setting) {
  const CaseTable c = test::read_table(name);
  const Rows exact = exact_rows(name);
  const Result first = run_once(runner, c, setting, exact);
  double best = first.cpu, spent = first.cpu;
  for (int k = 1; k < most_runs && spent < budget; ++k) {
    const double cpu = run_once(runner, c, setting, exact).cpu;
    best = std::min(best, cpu);
    spent += cpu;
  }
  Line{runner, name, setting}.print(first.cpu, best, first.error);
  if (stands_still(name))
    Line{runner, name + " after 1 s", setting}.print(first.cpu, best, first.error_settled);
}

// In a process in which nothing has run before, and which may crash.  Returns the CPU seconds.
double measure_apart(const CaseRunner& runner, const std::string& name, const Setting& setting) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{too_long, too_long};
    setrlimit(RLIMIT_CPU, &limit);
    int status = 0;
    try {
      measure(runner, name, setting);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s, %s, %s: %s\n", runner.engine.c_str(), name.c_str(),
                   setting.text.c_str(), error.what());
      status = 1;
    }
    std::fflush(stdout);
    _exit(status);
  }
  int status = 0;
  rusage used;
  if (child < 0 || wait4(child, &status, 0, &used) < 0) throw std::runtime_error("cannot fork");
  const bool out_of_time =
      WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGXCPU);
  if (out_of_time)
    Line{runner, name, setting}.fail("not within " + std::to_string(too_long) + " s");
  else if (status != 0)
    Line{runner, name, setting}.fail(WIFSIGNALED(status) ? "crashed" : "failed");
  return static_cast<double>(used.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

}  // namespace

std::vector<Setting> time_steps() {
  std::vector<Setting> result;
  for (long rate = 60; rate <= 15728640; rate *= 4)
    result.push_back({"1/" + std::to_string(rate) + " s", 1 / static_cast<double>(rate)});
  return result;
}

int run_cases(const CaseRunner& runner, int argc, char** argv) {
  try {
    const auto wanted = [&](const std::string& name) {
      return argc < 2 || std::find(argv + 1, argv + argc, name) != argv + argc;
    };
    for (const char* name : case_names) {
      if (!wanted(name)) continue;
      if (const std::string why = runner.unable(test::read_table(name)); !why.empty()) {
        Line{runner, name, {}}.fail(why);
        continue;
      }
      for (const Setting& setting : runner.settings)
        if (measure_apart(runner, name, setting) > longest) break;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", runner.engine.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace tw::bench
