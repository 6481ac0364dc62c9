// Another program that reads what this one writes, through a pipe to its standard input.
//
// It has a process group of its own: Ctrl-C on the terminal reaches this program alone, which then
// ends the pipe, so that the other can finish its work.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tw {

// Is there an executable file of this name in a folder of PATH?
bool program_in_path(const std::string& program);

class PipedProgram {
 public:
  // The program is looked for in PATH; its standard output is dropped, what it says on standard
  // error is kept.  Raises UserError where it cannot be started.
  explicit PipedProgram(const std::vector<std::string>& command);
  // Ends the pipe and waits for the program's end.
  ~PipedProgram();
  PipedProgram(const PipedProgram&) = delete;
  PipedProgram& operator=(const PipedProgram&) = delete;

  // Waits until all is in the pipe; false where the program does not read any more.  Only for
  // threads in which SIGPIPE is blocked or ignored.
  bool write(std::span<const std::uint8_t> bytes);
  // Ends the pipe, waits for the program's end, and tells how it ended: empty where it succeeded,
  // else as in "ended with status 1: " and its last words.
  std::string finish();
  // The last lines on its standard error so far, in one.
  std::string last_words() const;

 private:
  pid_t process_ = -1;
  int pipe_ = -1, errors_ = -1;
};

}  // namespace tw
