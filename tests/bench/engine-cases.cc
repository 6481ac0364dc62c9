// Cases in any engine: run time against error, as lines of CSV.
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
#include "bench/case-judge.h"
#include "bench/made-cases.h"

namespace tw::bench {

namespace {

constexpr double budget = 0.3;  // CPU s for the runs after the first
constexpr int most_runs = 30;
// CPU s, of all runs of a setting: the next one, which costs a multiple, is left out then.  Heaps
// are to come down to our depth.
double longest(const std::string& name) { return is_heap(name) ? 10 : 3; }
constexpr rlim_t too_long = 60;  // CPU s: a process is ended then

const char* const case_names[] = {
    "brick",    "bounce",      "billiard", "gas-200",  "gas-1600", "slide",
    "creep",    "stack",       "chain-5",  "chain-20", "rolling",  "rolling-diagonal",
    "bouncing", "elastic-666", "666",      "kapla",    "drum",     "shaken"};

struct Result {
  double cpu = 0, error = 0, settled_error = 0;
};

// Stops wherever the judge looks; the CPU is that of stepping.
Result run_judged(const CaseRunner& runner, const CaseTable& c, const Setting& setting) {
  const auto engine = runner.make(c, setting);
  const auto judge = judge_of(c);
  const double interval = std::max(judge->interval(), runner.by_steps ? setting.value : 0);
  Result result;
  judge->look(0, *engine);
  double now = 0;
  for (long k = 1; k <= std::lround(c.duration / interval); ++k) {
    const double next = static_cast<double>(k) * interval;
    const double before = thread_cpu_seconds();
    engine->advance(next - now);
    result.cpu += thread_cpu_seconds() - before;
    now = next;
    judge->look(now, *engine);
  }
  result.error = judge->error();
  result.settled_error = judge->settled_error();
  return result;
}

// In one go.
double run_unseen(const CaseRunner& runner, const CaseTable& c, const Setting& setting) {
  const auto engine = runner.make(c, setting);
  const double before = thread_cpu_seconds();
  engine->advance(c.duration);
  return thread_cpu_seconds() - before;
}

struct Line {
  const CaseRunner& runner;
  std::string name;
  Setting setting;

  void print(double cold, double best, double error) const {
    std::printf("%s,%s,%s,%s,%.4g,%.4g,", runner.engine.c_str(), runner.version.c_str(),
                name.c_str(), setting.text.c_str(), cold, best);
    if (std::isfinite(error))
      std::printf("%.3g,%s,\n", error, unit_of(name).c_str());
    else
      std::printf(",%s,unstable\n", unit_of(name).c_str());
  }
  void fail(const std::string& why) const {
    std::printf("%s,%s,%s,%s,,,,%s,%s\n", runner.engine.c_str(), runner.version.c_str(),
                name.c_str(), setting.text.c_str(), unit_of(name).c_str(), why.c_str());
  }
};

void measure(const CaseRunner& runner, const std::string& name, const Setting& setting) {
  const CaseTable c = case_named(name);
  const Result first = run_judged(runner, c, setting);
  double best = first.cpu, spent = first.cpu;
  for (int k = 1; k < most_runs && spent < budget; ++k) {
    const double cpu = run_unseen(runner, c, setting);
    best = std::min(best, cpu);
    spent += cpu;
  }
  Line{runner, name, setting}.print(first.cpu, best, first.error);
  if (stands_still(name))
    Line{runner, name + " after 1 s", setting}.print(first.cpu, best, first.settled_error);
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

std::vector<Setting> time_steps(const std::string& name) {
  const bool heap = is_heap(name);
  std::vector<Setting> result;
  for (long rate = heap ? 240 : 60; rate <= 15728640; rate *= heap ? 2 : 4)
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
      if (const std::string why = runner.unable(case_named(name)); !why.empty()) {
        Line{runner, name, {}}.fail(why);
        continue;
      }
      for (const Setting& setting : runner.settings(name))
        if (measure_apart(runner, name, setting) > longest(name)) break;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", runner.engine.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace tw::bench
