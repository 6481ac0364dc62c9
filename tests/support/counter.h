// A counter slot, and callbacks that use it: what a user's scene would do, in C++.
//
// The counter decides what a callback does to the motion, so a count that is not rolled back shows
// in the history's hash.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>

#include "kernel/world/world.h"

namespace tw::test {

class Counter : public Slots {
 public:
  explicit Counter(long count) : count_(count) {}
  std::uint64_t hash() const override { return static_cast<std::uint64_t>(count_) + 1; }
  long count() const { return count_; }

 private:
  long count_;
};

inline SlotsPtr make_counter(long count = 0) { return std::make_shared<Counter>(count); }

inline long counter_of(const SlotsPtr& slots) {
  return slots ? static_cast<const Counter&>(*slots).count() : 0;
}

// Adds one to the counters of both bodies of a collision.
class CountCollisions : public CollisionCallback {
 public:
  void run(const Collision&, bool, StateView& a, StateView& b) override {
    for (StateView* view : {&a, &b})
      if (view->slots()) view->set_slots(make_counter(counter_of(view->slots()) + 1));
  }
};

// A callback from a function.
class FunctionCallback : public Callback {
 public:
  using Function = std::function<std::optional<double>(double, std::span<StateView* const>)>;
  explicit FunctionCallback(Function function) : function_(std::move(function)) {}
  std::optional<double> run(double event_time, std::span<StateView* const> targets) override {
    return function_(event_time, targets);
  }

 private:
  Function function_;
};

inline std::uint64_t add_callback(World& world, std::vector<BodyId> targets, double start,
                                  std::optional<double> period,
                                  FunctionCallback::Function function) {
  CallbackDef def;
  def.name = "test";
  def.targets = std::move(targets);
  def.start = start;
  def.period = period;
  def.callback = std::make_shared<FunctionCallback>(std::move(function));
  return world.add_callback(def);
}

// A collision callback from a function, for all pairs.
class FunctionCollisionCallback : public CollisionCallback {
 public:
  using Function = std::function<void(const Collision&, StateView&, StateView&)>;
  explicit FunctionCollisionCallback(Function function) : function_(std::move(function)) {}
  void run(const Collision& collision, bool, StateView& a, StateView& b) override {
    function_(collision, a, b);
  }

 private:
  Function function_;
};

inline void add_collision_callback(World& world, FunctionCollisionCallback::Function function) {
  CollisionCallbackDef def;
  def.name = "test";
  def.callback = std::make_shared<FunctionCollisionCallback>(std::move(function));
  world.add_collision_callback(def);
}

// Cyclic permutation of the components: keeps the speed, and exact times where they were exact.
inline Vec3 permuted(const Vec3& v) { return {v.y(), v.z(), v.x()}; }

}  // namespace tw::test
