// Programs that are written to: how they end, and what they said.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/piped-program.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <csignal>
#include <thread>

#include "picture-tools.h"

namespace tw::test {
namespace {

const std::vector<std::uint8_t> some_bytes(3'000'000, 'x');

// In a thread without SIGPIPE, as those that write have it.
template <class Work>
void without_sigpipe(Work work) {
  std::thread([&] {
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
    work();
  }).join();
}

TEST(PipedProgram, it_reads_all_that_is_written) {
  PipedProgram program({"sh", "-c", "test $(wc -c) = 6000000"});
  EXPECT_TRUE(program.write(some_bytes));
  EXPECT_TRUE(program.write(some_bytes));
  EXPECT_EQ(program.finish(), "");
}

TEST(PipedProgram, one_that_fails_is_quoted_with_its_last_lines) {
  PipedProgram program({"sh", "-c", "for i in 1 2 3 4; do echo word $i >&2; done; exit 3"});
  EXPECT_EQ(program.finish(), "ended with status 3: word 2; word 3; word 4");
  EXPECT_EQ(program.finish(), "");
}

TEST(PipedProgram, one_that_dies_ends_the_writing) {
  without_sigpipe([] {
    PipedProgram program({"sh", "-c", "kill -KILL $$"});
    EXPECT_FALSE(program.write(some_bytes));
    EXPECT_EQ(program.finish(), "was ended by signal 9 (Killed)");
  });
}

TEST(PipedProgram, it_has_a_group_of_its_own_and_no_files_but_three) {
  PipedProgram program({"sh", "-c", "test $(ps -o pgid= -p $$) = $$ && test ! -e /dev/fd/9"});
  EXPECT_EQ(program.finish(), "");
}

TEST(PipedProgram, what_is_not_there_cannot_be_started) {
  EXPECT_EQ(user_error_of([] { PipedProgram program({"no-such-program"}); }),
            "cannot start no-such-program: No such file or directory");
  EXPECT_FALSE(program_in_path("no-such-program"));
  EXPECT_TRUE(program_in_path("sh"));
}

}  // namespace
}  // namespace tw::test
