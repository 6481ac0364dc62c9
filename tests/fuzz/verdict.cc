// Judging a scene: the plain run, then the same under other schedules.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "fuzz/apart.h"
#include "fuzz/judged-run.h"

namespace tw::fuzz {
namespace {

struct NamedSchedule {
  const char* name;
  test::Schedule schedule;
  bool vain_edits = false;
};

// Head starts of some bodies, of every event; seeds follow the scene's.
test::Schedule adversary(const DescribedScene& scene, bool every_event) {
  AdversaryOptions options;
  options.seed = 2 * scene.seed + every_event;
  options.head_start = (every_event ? 0.05 : 0.2) * scene.duration;
  options.every_event = every_event;
  options.some_bodies = !every_event;
  test::Schedule schedule;
  schedule.adversary = options;
  return schedule;
}

// The judged run is one in 60 pieces.
std::vector<NamedSchedule> schedules(const DescribedScene& scene) {
  test::Schedule undo;
  undo.undo_redo = true;
  test::Schedule threads;
  threads.threads = 3;
  // boxes as small as they get: nobody is found in them by chance
  test::Schedule narrow;
  narrow.gvt_interval = 1;
  narrow.window_cells = 0.1;
  return {{"pieces", {}},
          {"threads", threads},
          {"narrow", narrow},
          {"bodies", adversary(scene, false)},
          {"events", adversary(scene, true)},
          {"undo", undo},
          {"edits", {}, true}};
}

std::string number(const char* format, double x) {
  char text[64];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

void compare_hashes(Verdict& verdict, const Judges& judges) {
  const std::vector<NamedSchedule> all = schedules(verdict.scene);
  for (std::size_t i = 0; i < std::min(judges.most_schedules, all.size()); ++i) {
    const auto& [name, schedule, vain_edits] = all[(judges.first_schedule + i) % all.size()];
    const double cpu = 1 + 5 * verdict.findings.cpu;
    const Findings other =
        run_apart(cpu, [&](Findings& f) { run_for_hash(verdict.scene, schedule, vain_edits, f); });
    if (other.out_of_time) {
      verdict.dear += std::string(" ") + name;
      continue;
    }
    if (other.finished && other.hash == verdict.findings.hash) continue;
    if (!verdict.has(Fault::hash)) verdict.faults.push_back(Fault::hash);
    verdict.schedules += std::string(" ") + name;
    if (!other.finished)
      verdict.schedules += "(" + std::string(other.error.data()) +
                           (other.signal ? " signal " + std::to_string(other.signal) : "") + ")";
  }
}

void judge_findings(Verdict& verdict, const Judges& judges) {
  const Findings& f = verdict.findings;
  const auto add = [&](bool wrong, Fault fault) {
    if (wrong) verdict.faults.push_back(fault);
  };
  add(f.signal && !f.out_of_time, Fault::crash);
  add(!f.signal && !f.out_of_time && f.error[0], Fault::error);
  add(f.not_finite, Fault::not_finite);
  if (judges.depth) {
    add(f.lost_time >= 0, Fault::lost);
    add(f.depth > depth_bound, Fault::deep);
  }
  if (judges.energy) add(f.rise > energy_bound, Fault::energy);
  if (judges.progress)
    add(f.out_of_time || f.pace > judges.pace || f.dearest > judges.work, Fault::slow);
}

}  // namespace

const char* name_of(Fault fault) {
  switch (fault) {
    case Fault::crash: return "crash";
    case Fault::error: return "error";
    case Fault::not_finite: return "not-finite";
    case Fault::lost: return "lost";
    case Fault::deep: return "deep";
    case Fault::energy: return "energy";
    case Fault::slow: return "slow";
    case Fault::hash: break;
  }
  return "hash";
}

bool Verdict::has(Fault fault) const {
  return std::find(faults.begin(), faults.end(), fault) != faults.end();
}

double Verdict::value(Fault fault) const {
  switch (fault) {
    case Fault::deep: return findings.depth;
    case Fault::energy: return findings.rise;
    case Fault::slow:
      if (!findings.out_of_time) return findings.pace;
      break;
    default: break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string Verdict::line() const {
  const Findings& f = findings;
  std::string text = scene.name();
  text.resize(std::max<std::size_t>(text.size() + 1, 13), ' ');
  std::string wrong;
  for (const Fault fault : faults)
    wrong += (wrong.empty() ? "" : "+") + std::string(name_of(fault));
  if (wrong.empty()) wrong = "ok";
  wrong.resize(std::max<std::size_t>(wrong.size() + 1, 12), ' ');
  text += wrong;
  text += number("n %2.0f", static_cast<double>(scene.moving())) +
          number(" size %-8.2g", scene.size) + number(" g %-7.2g", scene.gravity.norm()) +
          number(" mu %-5.2g", scene.friction) + number(" e %-5.2g", scene.restitution) +
          (scene.accuracy > 1e-5 ? " acc 1e-4" : "") + number(" cpu %6.2f", f.cpu) +
          number(" pace %-8.2g", f.pace) + number(" work %-8.2g", f.dearest) +
          number(" depth %-8.2g", f.depth) + number(" rise %-8.2g", f.rise) +
          (f.squeezed > depth_bound ? number(" squeezed %.2g", f.squeezed) : "");
  const auto body = [&](int i) {
    return i < 0 ? "?" : scene.bodies[static_cast<std::size_t>(i)].name;
  };
  if (has(Fault::deep))
    text += " [" + body(f.deep_a) + " / " + body(f.deep_b) + number(" at %.4g", f.depth_time) +
            number(" of %.4g s]", scene.duration);
  if (has(Fault::lost)) text += " [" + body(f.lost_body) + number(" out at %.4g s]", f.lost_time);
  if (has(Fault::energy))
    text += number(" [rise at %.4g", f.rise_time) + number(" of %.4g s]", scene.duration);
  if (f.out_of_time)
    text += number(" [reached %.4g", f.reached) + number(" of %.4g s", scene.duration) +
            (f.judging  ? ", in the judge]"
             : f.signal ? ", in one arc]"
                        : "]");
  if (f.signal && !f.out_of_time) text += " [signal " + std::to_string(f.signal) + "]";
  if (f.error[0]) text += " [" + std::string(f.error.data()) + "]";
  if (!schedules.empty()) text += " [other hash:" + schedules + "]";
  if (!dear.empty()) text += " [dear:" + dear + "]";
  return text;
}

Verdict judge(const DescribedScene& scene, const Judges& judges, double budget) {
  Verdict verdict;
  verdict.scene = scene;
  // the judge's own work is not the world's
  verdict.findings = run_apart(2 * budget + 10, [&](Findings& f) { run_judged(scene, budget, f); });
  judge_findings(verdict, judges);
  if (judges.hash && verdict.findings.finished) compare_hashes(verdict, judges);
  return verdict;
}

}  // namespace tw::fuzz
