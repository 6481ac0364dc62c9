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
#include <iterator>
#include <memory>
#include <stdexcept>

#include "base/cpu-clock.h"
#include "bench/case-judge.h"
#include "bench/made-cases.h"

namespace tw::bench {

namespace {

constexpr double budget = 0.3;  // CPU s for the runs after the first
constexpr int most_runs = 30;
// What takes less is run cold in so many processes, of which the middle one counts.
constexpr double brief = 0.1;  // CPU s
constexpr int cold_runs = 5;
// CPU s of the first run of a setting: the next one, which costs a multiple, is left out then.
// Where depths are to be alike engines are to come down to ours.
double longest(const std::string& name) { return is_judged_by_depth(name) ? 10 : 3; }
// CPU s: a process is ended then.
rlim_t too_long(const std::string& name) { return is_heap(name) ? 180 : 60; }

const char* const case_names[] = {
    "brick",    "bounce",      "billiard", "gas-200",  "gas-1600", "slide",
    "creep",    "stack",       "chain-5",  "chain-20", "rolling",  "rolling-diagonal",
    "bouncing", "elastic-666", "666",      "kapla",    "drum",     "shaken"};

// CPU s of making an engine's world, of the first run in a process, and of the best.
struct Times {
  double made = 0, cold = 0, best = 0;
};

struct Outcome {
  Times times;
  bool judged = false;
  double error = 0, settled_error = 0;
};

// A run in one go, with nobody looking.
std::unique_ptr<CaseEngine> run_unseen(const CaseRunner& runner, const CaseTable& c,
                                       const Setting& setting, Times& times) {
  const double begun = thread_cpu_seconds();
  auto engine = runner.make(c, setting);
  const double made = thread_cpu_seconds();
  engine->advance(c.duration);
  times.cold = times.best = thread_cpu_seconds() - made;
  times.made = made - begun;
  return engine;
}

void take(Outcome& outcome, const CaseJudge& judge) {
  outcome.judged = true;
  outcome.error = judge.error();
  outcome.settled_error = judge.settled_error();
}

// Several runs; the first one's end is judged if no more than that is to be seen.
Outcome time(const CaseRunner& runner, const CaseTable& c, const Setting& setting) {
  Outcome result;
  {
    const auto engine = run_unseen(runner, c, setting, result.times);
    const auto judge = judge_of(c);
    if (judge->interval() >= c.duration) {
      judge->look(c.duration, *engine);
      take(result, *judge);
    }
  }
  double spent = result.times.cold;
  for (int k = 1; k < most_runs && spent < budget; ++k) {
    Times again;
    run_unseen(runner, c, setting, again);
    result.times.best = std::min(result.times.best, again.cold);
    spent += again.cold;
  }
  return result;
}

// A run that stops wherever the judge looks, which costs: its time is no run's.
Outcome judge(const CaseRunner& runner, const CaseTable& c, const Setting& setting) {
  const auto engine = runner.make(c, setting);
  const auto judge = judge_of(c);
  const double interval = std::max(judge->interval(), runner.by_steps ? setting.value : 0);
  judge->look(0, *engine);
  double now = 0;
  for (long k = 1; k <= std::lround(c.duration / interval); ++k) {
    const double next = static_cast<double>(k) * interval;
    engine->advance(next - now);
    now = next;
    judge->look(now, *engine);
  }
  Outcome result;
  take(result, *judge);
  return result;
}

// Why a process came to nothing; empty where it did not.
std::string failure_of(int status, rlim_t most_cpu) {
  if (status == 0) return "";
  if (!WIFSIGNALED(status)) return "failed";
  const bool out_of_time = WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGXCPU;
  return out_of_time ? "not within " + std::to_string(most_cpu) + " s" : "crashed";
}

// What `work` returns in a process in which nothing has run before, and which may crash.
struct Apart {
  std::string why;  // it came to nothing
  Outcome outcome;
  double cpu = 0;  // s, of the process
};

template <class Work>
Apart apart(rlim_t most_cpu, const Work& work) {
  std::fflush(stdout);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    const rlimit limit{most_cpu, most_cpu};
    setrlimit(RLIMIT_CPU, &limit);
    int status = 0;
    try {
      const Outcome found = work();
      status = write(ends[1], &found, sizeof found) != sizeof found;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = 1;
    }
    std::fflush(stdout);
    _exit(status);
  }
  Apart result;
  close(ends[1]);
  const bool whole = read(ends[0], &result.outcome, sizeof result.outcome) == sizeof result.outcome;
  close(ends[0]);
  int status = 0;
  rusage used;
  if (wait4(child, &status, 0, &used) < 0) throw std::runtime_error("cannot wait");
  result.why = failure_of(status, most_cpu);
  if (result.why.empty() && !whole) result.why = "failed";
  result.cpu =
      static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
  return result;
}

struct Line {
  const CaseRunner& runner;
  std::string name;
  Setting setting;

  void print(const Times& times, double error) const {
    std::printf("%s,%s,%s,%s,%.4g,%.4g,", runner.engine.c_str(), runner.version.c_str(),
                name.c_str(), setting.text.c_str(), times.cold, times.best);
    if (std::isfinite(error))
      std::printf("%.3g,%s,", error, unit_of(name).c_str());
    else
      std::printf(",%s,unstable", unit_of(name).c_str());
    std::printf(",%.4g\n", times.made);
  }
  void fail(const std::string& why) const {
    std::printf("%s,%s,%s,%s,,,,%s,%s,\n", runner.engine.c_str(), runner.version.c_str(),
                name.c_str(), setting.text.c_str(), unit_of(name).c_str(), why.c_str());
  }
};

// The middle one of several first runs; `times` has one of them.
void run_cold(const CaseRunner& runner, const CaseTable& c, const Setting& setting, Times& times) {
  std::vector<double> cold{times.cold}, made{times.made};
  while (cold.size() < cold_runs) {
    const Apart once = apart(too_long(c.name), [&] {
      Outcome outcome;
      run_unseen(runner, c, setting, outcome.times);
      return outcome;
    });
    if (!once.why.empty()) return;
    cold.push_back(once.outcome.times.cold);
    made.push_back(once.outcome.times.made);
  }
  const auto middle = [](std::vector<double>& x) {
    std::sort(x.begin(), x.end());
    return x[x.size() / 2];
  };
  times.cold = middle(cold);
  times.made = middle(made);
}

// Returns the CPU seconds of the process with the first run.
double measure(const CaseRunner& runner, const std::string& name, const Setting& setting) {
  const CaseTable c = case_named(name);
  Apart timed = apart(too_long(name), [&] { return time(runner, c, setting); });
  const bool seen = !timed.why.empty() || timed.outcome.judged;
  const Apart judged =
      seen ? timed : apart(too_long(name), [&] { return judge(runner, c, setting); });
  if (!judged.why.empty()) {
    Line{runner, name, setting}.fail(judged.why);
    return judged.cpu;
  }
  Times& times = timed.outcome.times;
  if (times.cold < brief) run_cold(runner, c, setting, times);
  Line{runner, name, setting}.print(times, judged.outcome.error);
  if (stands_still(name))
    Line{runner, name + " after 1 s", setting}.print(times, judged.outcome.settled_error);
  return timed.cpu;
}

}  // namespace

std::vector<Setting> time_steps(const std::string& name) {
  std::vector<Setting> result;
  for (long rate = is_heap(name) ? 240 : 60; rate <= 15728640;
       rate *= is_judged_by_depth(name) ? 2 : 4)
    result.push_back({"1/" + std::to_string(rate) + " s", 1 / static_cast<double>(rate)});
  return result;
}

int run_cases(const CaseRunner& runner, int argc, char** argv) {
  try {
    const auto wanted = [&](const std::string& name) {
      return argc < 2 || std::find(argv + 1, argv + argc, name) != argv + argc;
    };
    long number = 0;
    for (const char* name : case_names) {
      ++number;
      if (!wanted(name)) continue;
      std::fprintf(stderr, "%s: %s, %ld of %zu\n", runner.engine.c_str(), name, number,
                   std::size(case_names));
      if (const std::string why = runner.unable(case_named(name)); !why.empty()) {
        Line{runner, name, {}}.fail(why);
        continue;
      }
      for (const Setting& setting : runner.settings(name))
        if (measure(runner, name, setting) > longest(name) && !runner.every_setting) break;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", runner.engine.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace tw::bench
