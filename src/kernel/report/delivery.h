// Delivery of what is committed: collisions to observers, frames to their sinks, all in time order
// and once.
//
// A collision at a frame's time comes first.  Each observer hears of a collision once, whatever
// another one or a call before did: what an error keeps from being delivered is delivered by the
// next call.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "kernel/world/callback.h"

namespace tw {

struct Simulation;

class Delivery {
 public:
  explicit Delivery(Simulation& simulation) : sim_(simulation) {}

  CollisionObserverPtr add_observer(CollisionObserver observer, CollisionKind kind,
                                    Watch watch = Watch::outside);
  // What is left to deliver it does not hear any more; false: there is no such one.
  bool remove_observer(const CollisionObserver* observer);
  bool has(const CollisionObserver* observer) const;
  // fps > 0.  Frames before the present time are not delivered again.
  void add_sink(std::shared_ptr<FrameSink> sink, double fps, Watch watch = Watch::outside);
  bool remove_sink(const FrameSink* sink);
  bool has(const FrameSink* sink) const;
  std::vector<double> rates() const;  // frames per second, by sink
  // Whether somebody wants to hear of these.
  bool observed(CollisionKind kind) const;

  // ---- what is committed: each commit notes its reports, then puts them in order ----
  void note(const std::shared_ptr<const Report>& report);
  void sort_noted();
  // Rather now than when the slice or the run ends.
  bool is_worth_it() const;
  // Until nothing is due (true) or the wall clock passes `wall_end`; one thing at least.
  bool deliver(double wall_end);
  // States from here on are still read, s.
  double first_needed(double otherwise) const;

  // ---- checkpoints ----
  struct Observer {
    CollisionObserverPtr observer;
    CollisionKind kind = CollisionKind::collision;
    Watch watch = Watch::outside;
  };
  struct Sink {
    std::shared_ptr<FrameSink> sink;
    double fps = 30;
    Watch watch = Watch::outside;
    long next_frame = 0;

    double next_time() const { return static_cast<double>(next_frame) / fps; }
  };
  // Those of the scene.
  struct Kept {
    std::vector<Observer> observers;
    std::vector<Sink> sinks;
  };
  Kept keep() const;
  // Those, and who looks from outside.
  void restore(const Kept& kept);
  // Nothing is left to deliver, and frames go on with the first after what is due.
  void restart();

  // ---- for statistics ----
  std::size_t undelivered() const { return undelivered_.size(); }
  // Of the first sink; 0 and 30 without any.
  long frames() const { return sinks_.empty() ? 0 : sinks_.front().next_frame; }
  double fps() const { return sinks_.empty() ? 30 : sinks_.front().fps; }

 private:
  void deliver_collision();
  void deliver_frame(Sink& sink);

  Simulation& sim_;
  std::vector<Observer> observers_;
  std::vector<Sink> sinks_;
  std::deque<std::shared_ptr<const Collision>> undelivered_;  // committed, in time order
  std::size_t sorted_ = 0;                                    // the first so many are in order
  std::size_t next_observer_ = 0;                             // who hears next of the first of them
};

}  // namespace tw
