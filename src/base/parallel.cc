// Loops on several threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <mutex>
#include <thread>

#include "base/cpu-clock.h"
#include "base/work-count.h"

// ThreadSanitizer does not see into the pool, which is compiled without it as this file is: it is
// told what the pool guarantees.
extern "C" {
__attribute__((weak)) void __tsan_acquire(void* where);
__attribute__((weak)) void __tsan_release(void* where);
}

namespace tw {
namespace {

thread_local Team* team_of_thread = nullptr;

// All that was done before hand_on comes before what is done after take_up of the same object.
void hand_on(void* object) {
  if (__tsan_release) __tsan_release(object);
}
void take_up(void* object) {
  if (__tsan_acquire) __tsan_acquire(object);
}

}  // namespace

struct Team::Pool {
  explicit Pool(int threads)
      : arena(threads, 1), allowed(parallelism, static_cast<std::size_t>(threads)) {}

  // tests run more threads than there are cores
  static constexpr auto parallelism = oneapi::tbb::global_control::max_allowed_parallelism;
  oneapi::tbb::task_arena arena;
  oneapi::tbb::global_control allowed;
};

Team::Team(int threads) : threads_(threads) {}
Team::~Team() = default;

int Team::cores() { return oneapi::tbb::info::default_concurrency(); }

Team* Team::current() { return team_of_thread; }

Team::Scope::Scope(Team* team) : outer_(team_of_thread) {
  team_of_thread = team && team->threads() > 1 ? team : nullptr;
}
Team::Scope::~Scope() { team_of_thread = outer_; }

void Team::run(std::size_t items, std::size_t grain, Item item, void* loop) {
  if (!pool_) pool_ = std::make_unique<Pool>(threads_);
  std::mutex mutex;
  WorkCount helped;
  const auto caller = std::this_thread::get_id();
  const auto work = [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
    const auto do_all = [&] {
      for (std::size_t i = range.begin(); i < range.end(); ++i) item(loop, i);
    };
    if (std::this_thread::get_id() == caller) return do_all();
    take_up(&helped);
    // what helps within an item of its own loop counts there
    const bool idle = !current();
    const WorkCount before = work_count;
    const double begun = idle ? thread_cpu_seconds() : 0;
    const Scope scope(this);
    do_all();
    WorkCount done = work_count.since(before);
    if (idle) done.helper_seconds += thread_cpu_seconds() - begun;
    hand_on(&mutex);
    const std::lock_guard lock(mutex);
    helped.add(done);
  };
  const oneapi::tbb::blocked_range<std::size_t> all(0, items, grain);
  const auto share = [&] {
    oneapi::tbb::parallel_for(all, work, oneapi::tbb::simple_partitioner());
  };
  // isolated: a thread that waits for the end of a loop within a loop takes up nothing else, for it
  // is in the midst of an item and its scratch is in use
  hand_on(&helped);
  pool_->arena.execute([&] { oneapi::tbb::this_task_arena::isolate(share); });
  take_up(&mutex);
  work_count.add(helped);
}

}  // namespace tw
