// Running one scene under one schedule: what must not change, and what it cost.
//
// The committed motion is a function of the scene alone.  `Outcome` holds everything that users can
// see of a run: the hash of the committed history, the collisions that observers were told of in
// their order, and the frames.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "base/hash.h"
#include "support/scene.h"

namespace tw::test {

struct Schedule {
  std::optional<AdversaryOptions> adversary;
  long gvt_interval = 0;
  double window_cells = 0.7;
  int pieces = 1;
  double fps = 0;  // 0: no frames
  bool check = false;
  bool undo_redo = false;
  bool observe = false;
  int threads = 1;
};

// Head starts from 0.2 to 2 s; even seeds: bodies, odd seeds: every event, every fourth: both.
inline Schedule adversary_schedule(std::uint64_t seed) {
  AdversaryOptions adversary;
  adversary.seed = seed;
  adversary.head_start = 0.2 + 1.8 * static_cast<double>(seed % 10) / 9;
  adversary.every_event = seed % 2 == 1;
  adversary.some_bodies = seed % 2 == 0 || seed % 4 == 3;
  Schedule schedule;
  schedule.adversary = adversary;
  return schedule;
}

// For messages.
inline std::string describe(const Schedule& s) {
  std::string text = "gvt " + std::to_string(s.gvt_interval) + " window " + show(s.window_cells) +
                     " pieces " + std::to_string(s.pieces) + " fps " + show(s.fps);
  if (s.check) text += " check";
  if (s.undo_redo) text += " undo";
  if (s.threads > 1) text += " threads " + std::to_string(s.threads);
  if (s.adversary)
    text += " adversary " + std::to_string(s.adversary->seed) + " head start " +
            show(s.adversary->head_start) + (s.adversary->every_event ? " events" : "") +
            (s.adversary->some_bodies ? " bodies" : "");
  return text;
}

// Folds every frame into a hash, in the order of delivery.
class FrameHash : public FrameSink {
 public:
  void frame(long index, double frame_time, std::span<const BodyPose> poses) override {
    hasher_.add(static_cast<std::uint64_t>(index));
    hasher_.add(frame_time);
    for (const BodyPose& p : poses) {
      hasher_.add(std::uint64_t{p.body});
      for (int i = 0; i < 3; ++i) hasher_.add(p.state.position[i]);
      for (int i = 0; i < 4; ++i) hasher_.add(p.state.orientation.coeffs()[i]);
      for (int i = 0; i < 3; ++i) hasher_.add(p.state.velocity[i]);
    }
    in_order_ = in_order_ && index == count_;
    ++count_;
  }
  std::uint64_t value() const { return hasher_.value(); }
  long count() const { return count_; }
  bool in_order() const { return in_order_; }

 private:
  Hasher hasher_;
  long count_ = 0;
  bool in_order_ = true;
};

struct Outcome {
  std::string hash;
  std::uint64_t frames = 0;  // hash of the frames, 0 without
  long frame_count = 0;
  bool frames_in_order = true;
  std::uint64_t observed = 0;  // hash of what an observer was told
  long observed_count = 0;
  bool observed_in_order = true;
  // what it took
  std::int64_t collisions = 0, rollbacks = 0, removed = 0, cascade = 0, peak_states = 0;
  double depth = 0;  // s
};

inline std::int64_t count_of(const StatisticsTable& table, const std::string& name) {
  for (const auto& [key, value] : table)
    if (key == name) return std::get<std::int64_t>(value);
  throw std::runtime_error("no statistic " + name);
}

inline double number_of(const StatisticsTable& table, const std::string& name) {
  for (const auto& [key, value] : table)
    if (key == name) return std::get<double>(value);
  throw std::runtime_error("no statistic " + name);
}

inline void apply(World& world, const Schedule& schedule) {
  world.set_hash(true);
  world.set_adversary(schedule.adversary);
  world.set_gvt_interval(schedule.gvt_interval);
  world.set_window_cells(schedule.window_cells);
  world.set_check(schedule.check);
  world.set_undo_redo(schedule.undo_redo);
  world.set_threads(schedule.threads);
}

// Cut at times that are no round numbers.
inline void advance_in_pieces(World& world, double duration, int pieces) {
  for (int i = 1; i < pieces; ++i) world.advance(duration * (i - 0.37) / pieces);
  world.advance(duration);
}

inline void read_statistics(const World& world, Outcome& outcome) {
  const StatisticsTable table = world.statistics();
  outcome.collisions = count_of(table, "collisions");
  outcome.rollbacks = count_of(table, "rollbacks");
  outcome.removed = count_of(table, "states_rolled_back");
  outcome.cascade = count_of(table, "largest_cascade");
  outcome.peak_states = count_of(table, "peak_states");
  outcome.depth = number_of(table, "deepest_rollback");
}

inline Outcome run(const Scene& scene, const Schedule& schedule) {
  World world;
  apply(world, schedule);
  scene.fill(world);

  Outcome outcome;
  Hasher observed;
  double last_time = 0;
  if (schedule.observe)
    world.add_collision_observer([&](const Collision& c) {
      outcome.observed_in_order = outcome.observed_in_order && c.time >= last_time;
      last_time = c.time;
      ++outcome.observed_count;
      observed.add(c.time);
      observed.add(pair_id(c.body1, c.body2));
      observed.add(c.impulse);
      observed.add(c.speed);
    });
  const auto sink = std::make_shared<FrameHash>();
  if (schedule.fps > 0) world.add_frame_sink(sink, schedule.fps);

  advance_in_pieces(world, scene.duration, schedule.pieces);
  outcome.hash = world.history_hash();
  outcome.frames = sink->value();
  outcome.frame_count = sink->count();
  outcome.frames_in_order = sink->in_order();
  outcome.observed = observed.value();
  read_statistics(world, outcome);
  return outcome;
}

// Sums over many runs, for the report.
struct Tally {
  int runs = 0;
  std::int64_t collisions = 0, rollbacks = 0, removed = 0, cascade = 0;
  double depth = 0;

  void add(const Outcome& o) {
    ++runs;
    collisions += o.collisions;
    rollbacks += o.rollbacks;
    removed += o.removed;
    cascade = std::max(cascade, o.cascade);
    depth = std::max(depth, o.depth);
  }
};

}  // namespace tw::test
