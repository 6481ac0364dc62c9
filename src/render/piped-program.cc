// Starting, feeding and ending a program.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/piped-program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "base/error.h"

extern char** environ;

namespace tw {

namespace {

// as much as an unprivileged program may ask for: fewer switches between the two
constexpr int pipe_size = 1 << 20;

// what posix_spawn is to do in the child, freed at the end
struct SpawnPlan {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  SpawnPlan() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnPlan() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
};

// A group of its own, no signal blocked or ignored, no files but the three.
void plan_child(SpawnPlan& plan, int input, int errors) {
  posix_spawn_file_actions_adddup2(&plan.files, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&plan.files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&plan.files, errors, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&plan.files, STDERR_FILENO + 1);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setpgroup(&plan.attributes, 0);
  posix_spawnattr_setsigmask(&plan.attributes, &none);
  posix_spawnattr_setsigdefault(&plan.attributes, &all);
  posix_spawnattr_setflags(&plan.attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
}

std::string describe_end(int status) {
  if (WIFSIGNALED(status))
    return "was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
           strsignal(WTERMSIG(status)) + ")";
  return "ended with status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

bool program_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + program;
    std::error_code error;
    if (access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file, error))
      return true;
  }
  return false;
}

PipedProgram::PipedProgram(const std::vector<std::string>& command) {
  std::array<int, 2> ends{-1, -1};
  errors_ = memfd_create("errors", MFD_CLOEXEC);
  int error = errors_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0 ? errno : 0;
  if (error == 0) {
    fcntl(ends[1], F_SETPIPE_SZ, pipe_size);
    SpawnPlan plan;
    plan_child(plan, ends[0], errors_);
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    error = posix_spawnp(&process_, arguments[0], &plan.files, &plan.attributes, arguments.data(),
                         environ);
  }
  if (ends[0] >= 0) ::close(ends[0]);
  pipe_ = ends[1];
  if (error == 0) return;
  if (pipe_ >= 0) ::close(pipe_);
  if (errors_ >= 0) ::close(errors_);
  throw UserError("cannot start " + command.front() + ": " + std::strerror(error));
}

PipedProgram::~PipedProgram() {
  finish();
  ::close(errors_);
}

bool PipedProgram::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(pipe_, bytes.data(), bytes.size());
    if (n >= 0)
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    else if (errno != EINTR)
      return false;
  }
  return true;
}

std::string PipedProgram::finish() {
  if (process_ < 0) return "";
  ::close(pipe_);
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(process_, &status, 0);
  while (ended < 0 && errno == EINTR);
  process_ = -1;
  // where SIGCHLD is ignored nobody knows the status: its words must do
  const std::string words = last_words();
  if (ended < 0) return words.empty() ? "" : "ended: " + words;
  if (status == 0) return "";
  return describe_end(status) + (words.empty() ? "" : ": " + words);
}

std::string PipedProgram::last_words() const {
  constexpr off_t most = 2000;
  constexpr std::size_t lines_kept = 3;
  const off_t size = lseek(errors_, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, most)), '\0');
  const ssize_t n = pread(errors_, text.data(), text.size(), std::max<off_t>(size - most, 0));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(n, 0)));

  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
  std::string words;
  for (std::size_t i = lines.size() - std::min(lines.size(), lines_kept); i < lines.size(); ++i)
    words += (words.empty() ? "" : "; ") + lines[i];
  return words;
}

}  // namespace tw
