// Names of frames.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/frame-name.h"

#include "picture-tools.h"

namespace tw::test {
namespace {

TEST(FrameName, a_folder_gets_five_digits) {
  EXPECT_EQ(FrameName("out").name(7), "out/00007.png");
  EXPECT_EQ(FrameName("a/b/").name(123456), "a/b/123456.png");
  EXPECT_EQ(FrameName("a/b/").folder(), "a/b");
  EXPECT_EQ(FrameName("/").name(0), "/00000.png");
}

TEST(FrameName, a_pattern_is_followed) {
  EXPECT_EQ(FrameName("out/%05d.png").name(7), "out/00007.png");
  EXPECT_EQ(FrameName("out/%05d.png").folder(), "out");
  EXPECT_EQ(FrameName("shot%d.png").name(42), "shot42.png");
  EXPECT_EQ(FrameName("shot%d.png").folder(), "");
  EXPECT_EQ(FrameName("%3d").name(5), "  5");
  EXPECT_EQ(FrameName("100%%-%02d.png").name(3), "100%-03.png");
}

TEST(FrameName, other_patterns_are_refused) {
  for (const char* pattern : {"", "%s.png", "out/%", "%d-%d.png", "%%.png", "%n", "%099d.png", "%5",
                              "%d/x.png", "%ld.png"})
    EXPECT_NE(user_error_of([&] { FrameName name(pattern); }), "") << pattern;
}

}  // namespace
}  // namespace tw::test
