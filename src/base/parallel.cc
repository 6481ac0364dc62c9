// Loops on several threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/cpu-clock.h"
#include "base/interruption.h"
#include "base/never.h"
#include "base/work-count.h"

namespace tw {
namespace {

thread_local Team* team_of_thread = nullptr;
// Whose item this thread is at; null: nobody's.
thread_local const SharedLoop* at_item_of = nullptr;
thread_local bool is_helper = false;

void pause_a_little() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

// Held for some dozen instructions.
class SpinLock {
 public:
  void lock() {
    while (busy_.test_and_set(std::memory_order_acquire)) pause_a_little();
  }
  void unlock() { busy_.clear(std::memory_order_release); }

 private:
  std::atomic_flag busy_;
};

namespace {

class Locked {
 public:
  explicit Locked(SpinLock& lock) : lock_(lock) { lock_.lock(); }
  ~Locked() { lock_.unlock(); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  SpinLock& lock_;
};

// Helpers have no business with signals.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

// A loop while it is shared.
struct SharedLoop {
  const std::size_t items, grain, threads;
  const Team::Item item;
  void* const loop;
  const SharedLoop* const outer = at_item_of;  // whose item it is a loop of
  std::atomic<std::size_t> next{0};
  std::atomic<int> helping{0};
  std::atomic<bool> given_up{false};  // nobody wants what is not done yet
  SpinLock lock;                      // of what follows
  WorkCount helped;
  std::exception_ptr error;

  SharedLoop(std::size_t all, std::size_t most, std::size_t by, Team::Item of, void* whose)
      : items(all), grain(most), threads(by), item(of), loop(whose) {}
  bool has_items() const { return next.load(std::memory_order_relaxed) < items; }
  // Whether all items were taken and are done.
  bool is_over() const {
    return next.load(std::memory_order_acquire) >= items &&
           helping.load(std::memory_order_acquire) == 0;
  }
  bool is_within(const SharedLoop& other) const {
    const SharedLoop* at = outer;
    while (at && at != &other) at = at->outer;
    return at;
  }
  void give_up() {
    given_up.store(true, std::memory_order_relaxed);
    next.store(items, std::memory_order_release);
  }
  void work() {
    const SharedLoop* const before = std::exchange(at_item_of, this);
    do_items();
    at_item_of = before;
  }

 private:
  // Fewer and fewer towards the end, so that all are done with it together.
  std::size_t at_a_time() const {
    constexpr std::size_t turns = 4;
    const std::size_t left = items - std::min(items, next.load(std::memory_order_relaxed));
    return std::clamp<std::size_t>(left / (turns * threads), 1, grain);
  }
  void do_items() {
    try {
      while (has_items()) {
        const std::size_t count = at_a_time();
        const std::size_t first = next.fetch_add(count, std::memory_order_release);
        for (std::size_t k = first; k < std::min(items, first + count); ++k) item(loop, k);
      }
    } catch (...) {
      {
        const Locked locked(lock);
        if (!error) error = std::current_exception();
      }
      give_up();
    }
  }
};

// What a helper gives up: an item of a loop that was given up, or of a loop within it.
void give_up_if_told() {
  for (const SharedLoop* at = at_item_of; at; at = at->outer)
    if (at->given_up.load(std::memory_order_relaxed)) throw Interrupted();
}

// Helpers look for loops that have items left.  Between two loops of a run there are some hundred
// microseconds, and to be woken takes a helper half as long: so it looks on for a while before it
// sleeps.  Who waits for the last items of a loop helps with the loops within them meanwhile.
class Team::Pool {
 public:
  explicit Pool(Team& team) : patience_(team.threads() > cores() ? 0 : cost::helper_patience) {
    const SignalsBlocked blocked;
    for (int i = 1; i < team.threads(); ++i) helpers_.emplace_back([this, &team] { help(team); });
  }
  ~Pool() {
    stop_ = true;
    published_.fetch_add(1);
    published_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  // The caller takes items of this loop alone and of those within it, for it may be in the midst of
  // an item of another.
  void run(SharedLoop& shared) {
    open(shared);
    shared.work();
    close(shared);
  }

  void open(SharedLoop& shared) {
    {
      const Locked locked(lock_);
      open_.push_back(&shared);
    }
    published_.fetch_add(1);
    if (asleep_.load() > 0) published_.notify_all();
  }

  // Nobody begins with an item from here on, and those that were begun are done.
  void close(SharedLoop& shared) {
    {
      const Locked locked(lock_);
      std::erase(open_, &shared);
    }
    for (int looks = 0; shared.helping.load(std::memory_order_acquire) > 0; ++looks)
      if (SharedLoop* inner = looks % looks_between == 0 ? join(&shared) : nullptr)
        help_with(*inner);
      else if (looks < patient_looks)
        pause_a_little();
      else
        await_a_little(shared);
  }

 private:
  static constexpr int looks_between = 16, patient_looks = 4096;

  // Items may take long: who waits for helpers asks for them.
  static void await_a_little(SharedLoop& shared) {
    if (!is_helper && is_interrupted()) shared.give_up();
    std::this_thread::yield();
  }

  // One with items left, within `outer` if that is given; null: there is none.
  SharedLoop* join(const SharedLoop* outer = nullptr) {
    const Locked locked(lock_);
    for (SharedLoop* shared : open_)
      if (shared->has_items() && (!outer || shared->is_within(*outer))) {
        shared->helping.fetch_add(1, std::memory_order_relaxed);
        return shared;
      }
    return nullptr;
  }

  void help(Team& team) {
    const Scope scope(&team);
    const InterruptionCheck check(give_up_if_told);
    is_helper = true;
    while (!stop_) {
      const std::uint32_t seen = published_.load();
      if (SharedLoop* shared = join())
        help_with(*shared, thread_cpu_seconds());
      else
        await_other_than(seen);
    }
  }

  // What is done counts for who called the loop; the time, too, of a helper that has nothing else
  // to do and began then.
  static void help_with(SharedLoop& shared, double begun = never) {
    const WorkCount before = work_count;
    shared.work();
    WorkCount done = work_count.since(before);
    work_count = before;
    if (begun < never) done.helper_seconds += thread_cpu_seconds() - begun;
    {
      const Locked locked(shared.lock);
      shared.helped.add(done);
    }
    shared.helping.fetch_sub(1, std::memory_order_release);
  }

  void await_other_than(std::uint32_t seen) {
    using Clock = std::chrono::steady_clock;
    const auto late = Clock::now() + std::chrono::duration<double>(patience_);
    do {
      for (int i = 0; i < 64; ++i) {
        if (published_.load(std::memory_order_relaxed) != seen) return;
        pause_a_little();
      }
    } while (Clock::now() < late);
    ++asleep_;
    published_.wait(seen);
    --asleep_;
  }

  const double patience_;  // s
  SpinLock lock_;          // of open_
  std::vector<SharedLoop*> open_;
  std::atomic<std::uint32_t> published_{0};  // loops so far
  std::atomic<int> asleep_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> helpers_;
};

Team::Team(int threads) : threads_(threads) {}
Team::~Team() = default;

int Team::cores() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Team* Team::current() { return team_of_thread; }

Team::Scope::Scope(Team* team) : outer_(team_of_thread) {
  team_of_thread = team && team->threads() > 1 ? team : nullptr;
}
Team::Scope::~Scope() { team_of_thread = outer_; }

Team::Pool& Team::pool() {
  if (!pool_) pool_ = std::make_unique<Pool>(*this);
  return *pool_;
}

void Team::run(std::size_t items, std::size_t grain, Item item, void* loop) {
  SharedLoop shared(items, grain, static_cast<std::size_t>(threads_), item, loop);
  pool().run(shared);
  work_count.add(shared.helped);
  if (shared.error) std::rethrow_exception(shared.error);
}

Beside::Beside(Team& team, std::function<void()> work) : team_(team), work_(std::move(work)) {
  const auto item = [](void* loop, std::size_t) { static_cast<Beside*>(loop)->work_(); };
  shared_ =
      std::make_unique<SharedLoop>(1, 1, static_cast<std::size_t>(team.threads()), item, this);
  team_.pool().open(*shared_);
}

Beside::~Beside() { finish(); }

bool Beside::is_over() const { return !shared_ || shared_->is_over(); }

bool Beside::finish() {
  if (!shared_) return was_done_;
  team_.pool().close(*shared_);
  work_count.add(shared_->helped);
  was_done_ = !shared_->has_items() && !shared_->error;
  shared_.reset();
  return was_done_;
}

}  // namespace tw
