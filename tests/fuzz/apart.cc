// fork, limits, shared memory.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/apart.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace tw::fuzz {
namespace {

void set_limits(double cpu) {
  const auto seconds = static_cast<rlim_t>(std::max(1.0, std::ceil(cpu)));
  const rlimit time{seconds, seconds + 1}, core{0, 0};
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &core);
#ifndef __SANITIZE_ADDRESS__
  // what takes more raises std::bad_alloc, and leaves the machine to others
  constexpr rlim_t memory = rlim_t{3} << 30;
  const rlimit data{memory, memory};
  setrlimit(RLIMIT_DATA, &data);
#endif
}

// The last words of a process that died: what it wrote to standard error.
void read_last_words(std::FILE* words, Findings& findings) {
  std::rewind(words);
  if (findings.error[0]) return;
  const std::size_t got = std::fread(findings.error.data(), 1, findings.error.size() - 1, words);
  findings.error[got] = 0;
}

}  // namespace

Findings run_apart(double cpu, const std::function<void(Findings&)>& run) {
  void* const memory =
      mmap(nullptr, sizeof(Findings), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  std::FILE* const words = std::tmpfile();
  if (memory == MAP_FAILED || !words) throw std::runtime_error("no memory to share, or no file");
  auto* const shared = new (memory) Findings;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    dup2(fileno(words), STDERR_FILENO);
    set_limits(cpu);
    run(*shared);
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  Findings findings = *shared;
  munmap(memory, sizeof(Findings));
  if (WIFSIGNALED(status)) {
    findings.finished = false;
    findings.signal = WTERMSIG(status);
    findings.out_of_time = findings.signal == SIGXCPU || findings.signal == SIGKILL;
    if (!findings.out_of_time) read_last_words(words, findings);
  }
  std::fclose(words);
  return findings;
}

}  // namespace tw::fuzz
