// Loops over independent items, on several threads where that pays, and work beside them.
//
// An item writes to its own slot alone and reads what no other item writes; whatever else follows
// is done afterwards by the caller, in the order of the items.  So the result is that of an
// ordinary loop, bit for bit, whoever did which item.
//
// The team belongs to the thread that works for a world: Team::Scope lends it to that thread's
// loops, and to the loops within its loops.  Without one, or in a team of one, a loop is a loop.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

namespace tw {

class Beside;
struct SharedLoop;  // while it is shared

// Threads that share loops: the caller's and helpers, which come with the first loop and sleep
// while there is nothing to do.
class Team {
 public:
  // `threads` >= 1, the caller's included.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int threads() const { return threads_; }
  // The cores that this process may use.
  static int cores();

  // For as long as it lives this thread's loops are shared with the team.
  class Scope {
   public:
    explicit Scope(Team* team);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Team* outer_;
  };
  // This thread's; null: its loops are its own.
  static Team* current();

  using Item = void (*)(void* loop, std::size_t item);
  // At most `grain` items at a time.
  void run(std::size_t items, std::size_t grain, Item item, void* loop);

 private:
  friend Beside;
  class Pool;
  Pool& pool();
  int threads_;
  std::unique_ptr<Pool> pool_;
};

// Work that is done beside the caller's if a helper has time for it before the caller wants it,
// else not begun.  What it throws is lost, and then it was not done.
class Beside {
 public:
  // Until finish() nobody changes what `work` reads, or reads what it writes.
  Beside(Team& team, std::function<void()> work);
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  // Waits for it if it has begun, else takes it back.  Whether it was done.
  bool finish();
  // Whether finish() need not wait.
  bool is_over() const;

 private:
  Team& team_;
  std::function<void()> work_;
  std::unique_ptr<SharedLoop> shared_;
  bool was_done_ = false;
};

// Calls item(i) for each i < items, once.  `grain`: so many items are worth a helper, 10 us of work
// or more; fewer than twice as many stay together.  Where items throw, one of their exceptions
// comes out, and the others need not have been called.  Where the caller is interrupted, so are the
// helpers at their items (base/interruption.h).
template <class Function>
void each_in_parallel(std::size_t items, std::size_t grain, Function&& item) {
  Team* team = items >= 2 * grain ? Team::current() : nullptr;
  if (!team) {
    for (std::size_t i = 0; i < items; ++i) item(i);
    return;
  }
  using Loop = std::remove_reference_t<Function>;
  team->run(
      items, grain, [](void* loop, std::size_t i) { (*static_cast<Loop*>(loop))(i); }, &item);
}

}  // namespace tw
