// Running a scene that may break, and what came of it: for the stability table and its tests.
//
// The energy (kinetic, weight, contact springs) is sampled finely; depths are those of separation
// queries on the final state, independent of what the contacts believe.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "collision/distance/separation.h"
#include "multibody/multibody.h"
#include "support/schedule.h"

namespace tw::test {

inline constexpr double ample_budget = 20;  // s of CPU, which no scene comes near

struct StabilityScene {
  std::string name, what;
  double duration = 1;  // s
  bool rests = true;    // whether it ought to come to rest in that time
  std::function<void(World&)> fill;
  double sample_rate = 500;  // Hz
  bool driven = false;       // something does work on it: a rise of the energy says nothing
};

struct StabilityOutcome {
  std::string error;         // empty: none
  bool stalled = false;      // the budget was spent before the end
  double reached = 0;        // s
  double cpu = 0;            // s
  double worst_second = 0;   // s of CPU per simulated second, in the dearest tenth of the duration
  double rest_time = never;  // s: nothing moves from here on
  double deepest = 0;        // m, overlap of two bodies at the end
  double deepest_share = 0;  // overlap over the least width of the smaller body, at the end
  std::string deepest_pair;
  double energy_start = 0, energy_end = 0;  // J
  double rise = 0;       // J, largest rise of the energy above a level it had fallen to
  double rise_time = 0;  // s
  double travel = 0;     // m, largest displacement of a body
  double fastest = 0;    // m/s, at the end
  std::string fastest_body;
  std::int64_t collisions = 0, groups = 0;
  bool sunk = false;  // a body's origin lies below the floor, z = 0

  double rise_share() const { return rise / energy_start; }
  bool at_rest() const { return rest_time < never; }
};

inline bool is_dynamic(const World& world, BodyId id) {
  return world.body(id).kind == BodyKind::dynamic;
}

inline bool moves(const World& world) {
  for (BodyId id = 0; id < world.body_count(); ++id) {
    if (!is_dynamic(world, id)) continue;
    const BodyState s = world.state(id);
    if (s.velocity != Vec3::Zero() || s.angular_velocity != Vec3::Zero()) return true;
  }
  return false;
}

inline Frame frame_of(const World& world, BodyId id) {
  const BodyState s = world.state(id);
  return Frame(s.orientation.toRotationMatrix(), s.position);
}

// By a hold, or by a joint: they do not touch.
inline bool joined(const World& world, BodyId a, BodyId b) {
  if (world.attached(a, b)) return true;
  const auto tree = world.multibody_of(a);
  if (!tree || tree != world.multibody_of(b)) return false;
  const Multibody& multibody = world.multibody(*tree);
  const auto link_of = [&](BodyId id) {
    return static_cast<int>(std::find(multibody.links.begin(), multibody.links.end(), id) -
                            multibody.links.begin());
  };
  const int i = link_of(a), j = link_of(b);
  return multibody.tree.link(i).parent == j || multibody.tree.link(j).parent == i;
}

// The deepest overlaps of all pairs with a dynamic body, now.
inline void measure_depths(const World& world, StabilityOutcome& outcome) {
  for (BodyId a = 0; a < world.body_count(); ++a)
    for (BodyId b = a + 1; b < world.body_count(); ++b) {
      if (!is_dynamic(world, a) && !is_dynamic(world, b)) continue;
      if (joined(world, a, b)) continue;
      const Shape& shape_a = *world.body(a).shape;
      const Shape& shape_b = *world.body(b).shape;
      const double distance =
          separation(shape_a, frame_of(world, a), shape_b, frame_of(world, b)).distance;
      const double thinner = std::min(shape_a.least_width(), shape_b.least_width());
      outcome.deepest = std::max(outcome.deepest, -distance);
      if (-distance / thinner <= outcome.deepest_share) continue;
      outcome.deepest_share = -distance / thinner;
      outcome.deepest_pair = world.body(a).name + " / " + world.body(b).name;
    }
}

// Walks through the scene, sample by sample, for at most `budget` seconds of CPU.
class StabilityRun {
 public:
  StabilityRun(const StabilityScene& scene, double budget) : scene_(scene), budget_(budget) {
    scene.fill(world_);
    outcome_.energy_start = lowest_ = world_.total_energy();
    for (BodyId id = 0; id < world_.body_count(); ++id) start_.push_back(world_.state(id).position);
  }

  World& world() { return world_; }

  StabilityOutcome run() {
    try {
      const auto samples = static_cast<long>(std::ceil(scene_.duration * scene_.sample_rate));
      for (long i = 1; i <= samples && !outcome_.stalled; ++i)
        sample(scene_.duration * static_cast<double>(i) / static_cast<double>(samples));
    } catch (const std::exception& e) {
      outcome_.error = e.what();
    }
    finish();
    return outcome_;
  }

 private:
  double cpu() const { return number_of(world_.statistics(), "cpu_seconds"); }

  void sample(double when) {
    // wall time: twice the CPU, for a machine that is shared
    const double left = budget_ - cpu();
    if (left <= 0 || world_.advance(when, 2 * left) == RunStatus::slice_over) {
      outcome_.stalled = true;
      return;
    }
    note_energy(when);
    if (moves(world_)) moved_ = when;
    const double tenth = scene_.duration / 10;
    if (when < tenth_start_ + tenth && when < scene_.duration) return;
    const double now = cpu();
    outcome_.worst_second =
        std::max(outcome_.worst_second, (now - tenth_cpu_) / (when - tenth_start_));
    tenth_cpu_ = now;
    tenth_start_ = when;
  }

  void note_energy(double when) {
    const double energy = world_.total_energy();
    if (energy - lowest_ > outcome_.rise) {
      outcome_.rise = energy - lowest_;
      outcome_.rise_time = when;
    }
    lowest_ = std::min(lowest_, energy);
  }

  void finish() {
    outcome_.reached = world_.time();
    outcome_.cpu = cpu();
    if (moved_ < outcome_.reached) outcome_.rest_time = moved_;
    outcome_.energy_end = world_.total_energy();
    outcome_.collisions = count_of(world_.statistics(), "collisions");
    outcome_.groups = count_of(world_.statistics(), "groups");
    for (BodyId id = 0; id < world_.body_count(); ++id) {
      const Vec3 now = world_.state(id).position;
      if (is_dynamic(world_, id) && !(now.z() > 0)) outcome_.sunk = true;
      outcome_.travel = std::max(outcome_.travel, (now - start_[id]).norm());
      const double speed = world_.state(id).velocity.norm();
      if (speed <= outcome_.fastest) continue;
      outcome_.fastest = speed;
      outcome_.fastest_body = world_.body(id).name;
    }
    measure_depths(world_, outcome_);
  }

  World world_;
  const StabilityScene& scene_;
  double budget_ = never, lowest_ = 0, moved_ = 0, tenth_start_ = 0, tenth_cpu_ = 0;
  std::vector<Vec3> start_;
  StabilityOutcome outcome_;
};

}  // namespace tw::test
