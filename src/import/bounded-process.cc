// Work with bounds of memory and time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/bounded-process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>

#include "base/error.h"
#include "base/interruption.h"

namespace tw {

namespace {

// The first byte of what is written back.
enum class Outcome : char { done, refused, too_large };

// Bytes of address space that this process has.
std::uint64_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit(int what, std::uint64_t most) {
  rlimit bounds{};
  if (getrlimit(static_cast<__rlimit_resource>(what), &bounds) != 0) return;
  if (bounds.rlim_cur == RLIM_INFINITY || bounds.rlim_cur > most) bounds.rlim_cur = most;
  setrlimit(static_cast<__rlimit_resource>(what), &bounds);
}

void write_all(int to, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(to, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

[[noreturn]] void work_and_leave(int to, pid_t parent, const Bounds& bounds,
                                 const std::function<std::vector<char>()>& work) {
  // it ends with its parent
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  // Ctrl-C is for the program, which waits; Guile's collector has a handler of SIGXCPU
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGXCPU, SIG_DFL);
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_UNBLOCK, &all, nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, bounds.seconds);
  if (const std::uint64_t now = address_space(); now > 0) limit(RLIMIT_AS, now + bounds.memory);
  char outcome = static_cast<char>(Outcome::done);
  try {
    const std::vector<char> result = work();
    write_all(to, &outcome, 1);
    write_all(to, result.data(), result.size());
  } catch (const std::bad_alloc&) {
    outcome = static_cast<char>(Outcome::too_large);
    write_all(to, &outcome, 1);
  } catch (const std::exception& error) {
    outcome = static_cast<char>(Outcome::refused);
    write_all(to, &outcome, 1);
    write_all(to, error.what(), std::strlen(error.what()));
  }
  _exit(0);
}

// Ends the process where it is not done in time by the clock, as one that waits for something.
// Asks meanwhile whether it is to be given up.
std::vector<char> read_all(int from, pid_t child, unsigned seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  std::vector<char> all;
  std::vector<char> block(1 << 16);
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd ready{from, POLLIN, 0};
    const int count = poll(&ready, 1, static_cast<int>(std::clamp<std::int64_t>(left, 0, 100)));
    raise_if_interrupted();
    if (count < 0 && errno == EINTR) continue;
    if (count == 0 && left > 0) continue;
    if (count <= 0) {
      kill(child, SIGXCPU);
      return all;
    }
    const ssize_t size = read(from, block.data(), block.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return all;
    all.insert(all.end(), block.begin(), block.begin() + size);
  }
}

}  // namespace

std::vector<char> done_within(const Bounds& bounds, const std::string& what,
                              const std::function<std::vector<char>()>& work) {
  int ends[2];
  TW_REQUIRE(pipe2(ends, O_CLOEXEC) == 0,
             what + " cannot be read: no pipe, " + std::strerror(errno));
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    throw UserError(what + " cannot be read: no process, " + std::strerror(errno));
  }
  if (child == 0) {
    close(ends[0]);
    work_and_leave(ends[1], parent, bounds, work);
  }
  close(ends[1]);
  // twice as long by the clock: the machine may be busy
  std::vector<char> all;
  int status = 0;
  const auto finish = [&] {
    close(ends[0]);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  };
  try {
    all = read_all(ends[0], child, 2 * bounds.seconds);
  } catch (...) {
    kill(child, SIGKILL);
    finish();
    throw;
  }
  finish();
  const std::string memory = std::to_string(bounds.memory >> 20) + " MB";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw UserError(what + " takes " + bounds.worker + " more than " +
                    std::to_string(bounds.seconds) + " s; expected " + bounds.expected);
  const bool ended = !WIFEXITED(status) || WEXITSTATUS(status) != 0 || all.empty();
  if (ended)
    throw UserError(what + " ends " + bounds.worker +
                    (WIFSIGNALED(status) ? std::string(", ") + strsignal(WTERMSIG(status)) : "") +
                    ", which may have " + memory + "; expected " + bounds.expected);
  const auto outcome = static_cast<Outcome>(all[0]);
  all.erase(all.begin());
  if (outcome == Outcome::too_large)
    throw UserError(what + " takes " + bounds.worker + " more than " + memory + "; expected " +
                    bounds.expected);
  if (outcome == Outcome::refused) throw UserError(std::string(all.begin(), all.end()));
  return all;
}

}  // namespace tw
