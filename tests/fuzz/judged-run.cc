// Samples of a run: depth, room, energy, pace.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/judged-run.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "fuzz/overlap.h"
#include "fuzz/vain-edits.h"
#include "support/stability.h"

namespace tw::fuzz {
namespace {

// Depths up to here are those of bodies that lie on each other, and are not measured closely.
constexpr double shallow = 1e-3;

template <std::size_t size>
void set_text(Text<size>& text, const std::string& value) {
  std::strncpy(text.data(), value.c_str(), size - 1);
}

class JudgedRun {
 public:
  JudgedRun(const DescribedScene& scene, double budget, int looks, Findings& findings)
      : scene_(scene), budget_(budget), looks_(looks), f_(findings) {
    for (const DescribedBody& body : scene.bodies) {
      parts_.push_back(parts_of(body));
      widths_.push_back(least_width(parts_.back()));
    }
    told_.resize(parts_.size());
    deep_since_.resize(parts_.size(), never);
  }

  // However it ends.
  ~JudgedRun() { settle_depths(never); }

  void run() {
    world_.set_hash(true);
    world_.set_threads(1);  // its pace is that of one core
    fill(world_, scene_);
    world_.add_collision_observer(
        [this](const Collision& c) { told_[c.squeezed].push_back(c.time); },
        CollisionKind::squeezed);
    look(0);
    for (int i = 1; i <= looks_; ++i) {
      // to the bit where other schedules end
      const double when = i < samples ? scene_.duration * i / samples : scene_.duration;
      // wall time: twice the CPU, for a machine that is shared
      const double left = budget_ - cpu();
      if (left <= 0 || world_.advance(when, 2 * left) == RunStatus::slice_over) {
        f_.out_of_time = true;
        break;
      }
      f_.reached = when;
      look(when);
      note_pace(i);
      if (f_.not_finite) return;
    }
    set_text(f_.hash, world_.history_hash());
    const StatisticsTable table = world_.statistics();
    f_.collisions = test::count_of(table, "collisions");
    f_.groups = test::count_of(table, "groups");
    const double rejected = static_cast<double>(test::count_of(table, "rejected_steps"));
    const double steps = static_cast<double>(test::count_of(table, "implicit_steps"));
    f_.rejected = rejected / std::max(1.0, rejected + steps);
    if (f_.reached > 0) f_.work = counted() * scene_.time_unit / f_.reached / moving();
    f_.finished = !f_.out_of_time;
  }

 private:
  double cpu() {
    f_.cpu = test::number_of(world_.statistics(), "cpu_seconds");
    return f_.cpu;
  }

  void look(double when) {
    frames_.clear();
    for (BodyId id = 0; id < world_.body_count(); ++id) {
      const BodyState s = world_.state(id);
      f_.not_finite = f_.not_finite || !is_finite(s.position) || !is_finite(s.orientation) ||
                      !is_finite(s.velocity) || !is_finite(s.angular_velocity);
      frames_.push_back(test::frame_of(world_, id));
    }
    if (f_.not_finite) return;
    f_.judging = true;
    note_depths(when);
    note_room(when);
    note_energy(when);
    f_.judging = false;
  }

  void note_depths(double when) {
    std::vector<bool> deep_now(parts_.size(), false);
    std::vector<Overlap> found;
    for (std::size_t a = 0; a < parts_.size(); ++a)
      for (std::size_t b = a + 1; b < parts_.size(); ++b) {
        if (!scene_.bodies[a].dynamic() && !scene_.bodies[b].dynamic()) continue;
        if (scene_.bodies[a].joined_to(scene_.bodies[b])) continue;
        const double width = std::min(widths_[a], widths_[b]);
        for (const Part& part_a : parts_[a])
          for (const Part& part_b : parts_[b]) {
            const double share =
                overlap(part_a, frames_[a], part_b, frames_[b], shallow * width) / width;
            if (share > 0.5 * depth_bound) deep_now[a] = deep_now[b] = true;
            if (share > depth_bound)
              found.push_back({share, when, a, b});
            else
              note_depth({share, when, a, b});
          }
      }
    for (std::size_t i = 0; i < parts_.size(); ++i)
      deep_since_[i] = deep_now[i] ? std::min(deep_since_[i], when) : never;
    for (Overlap& overlap : found) {
      overlap.since_a = deep_since_[overlap.a];
      overlap.since_b = deep_since_[overlap.b];
      deep_.push_back(overlap);
    }
    settle_depths(when);
  }

  // Deep: half as deep as the bound without a break since then.
  struct Overlap {
    double share, when;
    std::size_t a, b;
    double since_a = never, since_b = never;
  };
  void note_depth(const Overlap& overlap) {
    if (overlap.share <= f_.depth) return;
    f_.depth = overlap.share;
    f_.depth_time = overlap.when;
    f_.deep_a = static_cast<int>(overlap.a);
    f_.deep_b = static_cast<int>(overlap.b);
  }
  // Of each deep overlap, once who is squeezed must have been told (at checks: some samples later),
  // whose it is.
  void settle_depths(double now) {
    const double late = 3 * scene_.duration / samples;
    const auto told = [&](std::size_t body, double since, double when) {
      return std::any_of(told_[body].begin(), told_[body].end(),
                         [&](double time) { return time >= since - late && time <= when + late; });
    };
    std::erase_if(deep_, [&](const Overlap& overlap) {
      if (told(overlap.a, overlap.since_a, overlap.when) ||
          told(overlap.b, overlap.since_b, overlap.when)) {
        f_.squeezed = std::max(f_.squeezed, overlap.share);
        return true;
      }
      if (now <= overlap.when + late) return false;
      note_depth(overlap);
      return true;
    });
  }

  void note_room(double when) {
    const Room& room = scene_.room;
    if (f_.lost_time >= 0) return;
    over_rim_.resize(frames_.size(), false);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!scene_.bodies[i].dynamic()) continue;
      Vec3 x = frames_[i] * mass_center(i);
      if (room.body) x = frames_[*room.body].to_local(x);
      over_rim_[i] = over_rim_[i] || x.z() > room.rim;
      if (over_rim_[i]) continue;
      if ((x - room.lo).minCoeff() >= 0 && (room.hi - x).minCoeff() >= 0) continue;
      f_.lost_time = when;
      f_.lost_body = static_cast<int>(i);
    }
  }

  Vec3 mass_center(std::size_t i) const {
    const ShapePtr& shape = world_.body(static_cast<BodyId>(i)).shape;
    return shape ? shape->mass_properties().centroid : Vec3(Vec3::Zero());
  }

  // The scale is what was given: energy at the start above the least without motion so far, the
  // work of kinematic bodies, and what lifts each body by its own width.
  void note_energy(double when) {
    const double total = world_.total_energy();
    const double work = test::number_of(world_.statistics(), "kinematic_work");
    double kinetic = 0, weights = 0;
    const double acceleration = scene_.size / (scene_.time_unit * scene_.time_unit);
    for (BodyId id = 0; id < world_.body_count(); ++id) {
      if (!test::is_dynamic(world_, id)) continue;
      kinetic += world_.kinetic_energy(id);
      if (!parts_[id].empty()) weights += world_.body(id).mass * acceleration * widths_[id];
    }
    if (when == 0) given_ = total;
    lowest_still_ = std::min(lowest_still_, total - kinetic);
    f_.energy_scale = std::max({f_.energy_scale, std::abs(work), given_ - lowest_still_, weights});
    const double own = total - work;
    const double rise = (own - lowest_) / f_.energy_scale;
    if (rise > f_.rise && !scene_.driven()) {
      f_.rise = rise;
      f_.rise_time = when;
    }
    lowest_ = std::min(lowest_, own);
    f_.not_finite = f_.not_finite || !std::isfinite(total);
  }

  void note_pace(int sample) {
    constexpr int tenth = samples / 10;
    if (sample % tenth) return;
    const double units = scene_.duration / 10 / scene_.time_unit;
    const double now = cpu();
    f_.pace = std::max(f_.pace, (now - tenth_cpu_) / units / moving());
    tenth_cpu_ = now;
    const double count = counted();
    f_.dearest = std::max(f_.dearest, (count - tenth_count_) / units / moving());
    tenth_count_ = count;
  }

  // Steps, integrations and queries so far.
  double counted() const {
    const StatisticsTable table = world_.statistics();
    double count = 0;
    for (const char* name :
         {"implicit_steps", "rejected_steps", "distance_queries", "integrations"})
      count += static_cast<double>(test::count_of(table, name));
    return count;
  }

  double moving() const { return static_cast<double>(std::max<std::size_t>(scene_.moving(), 1)); }

  World world_;
  const DescribedScene& scene_;
  double budget_;
  int looks_;
  Findings& f_;
  std::vector<std::vector<Part>> parts_;
  std::vector<double> widths_;
  std::vector<Frame> frames_;
  std::vector<bool> over_rim_;
  std::vector<std::vector<double>> told_;  // of each body, s: that it is squeezed
  std::vector<double> deep_since_;         // of each body, s
  std::vector<Overlap> deep_;              // of who may be squeezed
  double lowest_ = never, lowest_still_ = never, given_ = 0, tenth_cpu_ = 0, tenth_count_ = 0;
};

// What is raised is a finding.
template <class Run>
void catching(Findings& findings, Run run) {
  try {
    run();
  } catch (const std::bad_alloc&) {
    // an arc that does not end; which limit it meets first depends on the machine
    findings.out_of_time = true;
    set_text(findings.error, "out of memory");
  } catch (const std::exception& e) {
    set_text(findings.error, e.what());
  }
}

}  // namespace

void run_judged(const DescribedScene& scene, double budget, Findings& findings, int looks) {
  catching(findings, [&] { JudgedRun(scene, budget, looks, findings).run(); });
}

void run_for_hash(const DescribedScene& scene, const test::Schedule& schedule, bool vain_edits,
                  Findings& findings) {
  catching(findings, [&] {
    World world;
    test::apply(world, schedule);
    fill(world, scene);
    if (vain_edits)
      for (int i = 1; i < 4; ++i) {
        world.advance(scene.duration * (i - 0.37) / 4);
        edit_in_vain(world);
      }
    test::advance_in_pieces(world, scene.duration, schedule.pieces);
    set_text(findings.hash, world.history_hash());
    findings.cpu = test::number_of(world.statistics(), "cpu_seconds");
    findings.finished = true;
  });
}

}  // namespace tw::fuzz
