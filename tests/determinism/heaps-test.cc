// Heaps, towers, platforms and tiles under every schedule: contact groups roll back, too.
//
// Head starts are short beside those of gases: bodies in contact know one another's arcs for a few
// hundredths of a second, so longer ones only add events.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "determinism/compare-schedules.h"
#include "support/counter.h"
#include "support/heap-scenes.h"

namespace tw::test {
namespace {

// Head starts from 0.01 to 0.5 s, of bodies, of events, or of both.
Schedule short_adversary(std::uint64_t seed) {
  Schedule schedule = adversary_schedule(seed);
  schedule.adversary->head_start = 0.01 * std::pow(50, static_cast<double>(seed % 7) / 6);
  return schedule;
}

std::vector<Schedule> short_adversaries(int seeds) {
  std::vector<Schedule> schedules;
  for (int seed = 0; seed < seeds; ++seed)
    schedules.push_back(short_adversary(static_cast<std::uint64_t>(seed)));
  return schedules;
}

std::vector<Scene> heaps() {
  return {heap_scene(long_tests() ? 20 : 12, long_tests() ? 2 : 1.2), tower_scene(4, 1),
          platform_scene(0.8), tiles_scene(0.8)};
}

// Many rollbacks, one history.
void expect_same_under_adversaries(const Scene& scene, int seeds) {
  const Tally tally = expect_one_history(scene, short_adversaries(long_tests() ? 50 : seeds), 5);
  EXPECT_GT(tally.rollbacks, 2 * tally.runs) << scene.name << ": the adversaries did nothing";
}

TEST(Heaps, heap_of_boxes_balls_and_rocks_under_adversaries) {
  expect_same_under_adversaries(heaps()[0], 50);
}

// Large enough that blows divide its groups (groups/regroup/region.cc).
TEST(Heaps, large_heap_in_regions_under_adversaries) {
  std::vector<Schedule> schedules;
  for (std::uint64_t seed = 0; seed < (long_tests() ? 30u : 6u); ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start = 0.01;
    schedules.push_back(schedule);
  }
  const Tally tally = expect_one_history(heap_scene(40, 1), schedules, 3);
  EXPECT_GT(tally.rollbacks, 20 * tally.runs);
}

TEST(Heaps, tower_hit_by_a_ball_under_adversaries) {
  expect_same_under_adversaries(heaps()[1], 100);
}

TEST(Heaps, platform_under_adversaries) { expect_same_under_adversaries(heaps()[2], 100); }

TEST(Heaps, tiles_under_adversaries) { expect_same_under_adversaries(heaps()[3], 100); }

// GVT intervals, windows, pieces, frames, observers, with and without an adversary.
TEST(Heaps, settings_of_the_run_have_no_influence) {
  std::vector<Schedule> schedules(6);
  for (Schedule& s : schedules) s.observe = true;
  schedules[0].gvt_interval = 1;
  schedules[1].gvt_interval = 5000;
  schedules[2].window_cells = 0.1;
  schedules[3].window_cells = 3;
  schedules[4].pieces = 23;
  schedules[5].fps = 100;
  for (std::size_t i = 0; i < 6; ++i) {
    schedules.push_back(schedules[i]);
    schedules.back().adversary = short_adversary(i + 3).adversary;
  }
  for (const Scene& scene : heaps()) expect_one_history(scene, schedules, 5);
}

// Why arcs ended is committed history: counted once, whenever it is freed.
TEST(Heaps, why_arcs_ended_is_the_same_at_all_gvt_intervals) {
  for (const Scene& scene : heaps()) {
    std::vector<StatisticsTable> tables;
    for (const long interval : {1L, 40L, 5000L}) {
      World world;
      Schedule schedule;
      schedule.gvt_interval = interval;
      apply(world, schedule);
      scene.fill(world);
      world.advance(scene.duration, never);
      tables.push_back(world.statistics());
      std::erase_if(tables.back(),
                    [](const auto& row) { return !row.first.starts_with("arcs_ended_"); });
    }
    EXPECT_TRUE(std::any_of(tables[0].begin(), tables[0].end(), [](const auto& row) {
      return std::get<std::int64_t>(row.second) > 0;
    })) << scene.name;
    EXPECT_EQ(tables[0], tables[1]) << scene.name;
    EXPECT_EQ(tables[0], tables[2]) << scene.name;
  }
}

TEST(Heaps, validators_find_nothing_and_have_no_influence) {
  std::vector<Schedule> schedules = short_adversaries(long_tests() ? 20 : 3);
  schedules.insert(schedules.begin(), Schedule());
  for (Schedule& s : schedules) s.check = true;
  for (const Scene& scene : heaps()) expect_one_history(scene, schedules, 5);
}

TEST(Heaps, undoing_and_redoing_every_discontinuity_has_no_influence) {
  std::vector<Schedule> schedules = short_adversaries(long_tests() ? 20 : 3);
  schedules.insert(schedules.begin(), Schedule());
  for (Schedule& s : schedules) s.undo_redo = true;
  for (const Scene& scene : heaps()) expect_one_history(scene, schedules, 5);
}

TEST(Heaps, single_steps_and_slices_have_no_influence) {
  for (const Scene& scene : heaps()) {
    const Outcome expected = run(scene, Schedule());
    World world;
    apply(world, short_adversary(4));
    scene.fill(world);
    for (int i = 0; i < 500 && world.step(scene.duration); ++i) continue;
    while (world.advance(scene.duration, 0) == RunStatus::slice_over) continue;
    EXPECT_EQ(world.history_hash(), expected.hash) << scene.name;
  }
}

// What is so soft that its contacts press from farther than boxes are grown is in contact for as
// long, whether or not its box, as GVT and the windows have it, still meets the floor's.
TEST(Heaps, cushions_that_are_thrown_up_have_one_history) {
  const auto fill = [](World& world) {
    ContactSettings soft;
    soft.stiffness = 3e4;  // a static depth of 0.3 m
    world.set_contact({}, {}, soft);
    BodyDef floor = body_of(make_box({10, 10, 1}), {0, 0, -0.5}, Vec3::Zero());
    floor.fixed = true;
    world.add_body(floor);
    for (int i = 0; i < 6; ++i) {
      const BodyId box =
          world.add_body(body_of(make_box({1, 1, 1}), {1.6 * (i - 3), 0, 0.5}, Vec3::Zero()));
      add_callback(world, {box}, 0.1, std::nullopt,
                   [i](double, std::span<StateView* const> targets) {
                     targets[0]->set_velocity({0.3, 0, 3.0 + 4 * i});
                     return std::optional<double>();
                   });
    }
  };
  std::vector<Schedule> schedules = short_adversaries(6);
  for (const double window : {0.05, 0.2, 0.7, 3.0}) {
    Schedule narrow;
    narrow.gvt_interval = 1;
    narrow.window_cells = window;
    schedules.push_back(narrow);
  }
  expect_one_history({"cushions", 0.4, fill}, schedules, 0);
}

// Fusions and fissions reach their observers in the same order, each once.
TEST(Heaps, fusions_and_fissions_are_told_alike_under_every_schedule) {
  const auto told = [](const Scene& scene, const Schedule& schedule) {
    World world;
    apply(world, schedule);
    scene.fill(world);
    std::vector<std::tuple<int, double, std::uint64_t, double>> rows;
    for (const CollisionKind kind :
         {CollisionKind::collision, CollisionKind::fusion, CollisionKind::fission})
      world.add_collision_observer(
          [&](const Collision& c) {
            rows.push_back({static_cast<int>(c.kind), c.time, pair_id(c.body1, c.body2), c.speed});
          },
          kind);
    world.advance(scene.duration);
    return rows;
  };
  for (const Scene& scene : heaps()) {
    const auto expected = told(scene, Schedule());
    EXPECT_GT(expected.size(), 10u);
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Schedule schedule = short_adversary(seed);
      schedule.gvt_interval = seed % 2 ? 3000 : 1;
      EXPECT_EQ(told(scene, schedule), expected) << scene.name << ": " << describe(schedule);
    }
  }
}

}  // namespace
}  // namespace tw::test
