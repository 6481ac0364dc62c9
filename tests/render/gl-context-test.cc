// OpenGL comes into the process when something is drawn, not before, and draws the same whatever
// the environment says.  Each case runs in a process of its own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/gl-context.h"

#include <cstdlib>
#include <fstream>

#include "picture-tools.h"
#include "render/frame-pipeline.h"

namespace tw::test {
namespace {

bool is_mapped(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (contains(line, library)) return true;
  return false;
}

// Sets an environment variable for this test and its child processes.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Environment() { unsetenv(name_); }

 private:
  const char* name_;
};

class GlContextDeathTest : public testing::Test {
 protected:
  // child processes begin anew, with nothing loaded
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

// "drawn HASH HASH HASH" of a small picture in each quality: with sky, checks, a sphere, and a hull
// that has a grain.
std::string hash_text() {
  DrawScene scene = ball_over_ground();
  scene.bodies.push_back(
      make_body(make_hull({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0.4}, {0, 0, 0.8}}),
                {1, 1, 0}, {0.5, 0.4, 0.3}, true));
  std::string hashes = "drawn";
  for (const Quality quality : {Quality::draft, Quality::normal, Quality::best}) {
    RenderSettings settings = small_settings(quality);
    settings.hud = true;
    const Image image = Renderer(settings, scene).draw(frame_at(1));
    char text[40];
    std::snprintf(text, sizeof text, " %016llx", static_cast<unsigned long long>(hash_of(image)));
    hashes += text;
  }
  return hashes;
}

[[noreturn]] void print_hash_and_exit() {
  std::fprintf(stderr, "%s\n", hash_text().c_str());
  std::exit(0);
}

[[noreturn]] void look_at_maps_and_exit() {
  const bool before = is_mapped("libOSMesa") || is_mapped("libLLVM") || is_mapped("libEGL");
  const TemporaryFolder folder;
  render_image(folder / "shot.png", small_settings(), ball_over_ground(), frame_at(0));
  const bool after = is_mapped("libOSMesa") || is_mapped("libEGL");
  std::exit((before ? 2 : 0) + (after ? 0 : 1));
}

TEST_F(GlContextDeathTest, a_process_that_draws_nothing_maps_no_opengl) {
  EXPECT_EXIT(look_at_maps_and_exit(), testing::ExitedWithCode(0), "");
}

TEST_F(GlContextDeathTest, the_picture_does_not_depend_on_the_number_of_threads) {
  TW_SKIP_WITHOUT_OPENGL();
  const std::string expected = hash_text();
  for (const char* threads : {"0", "1", "2", "3", "8"}) {
    const Environment environment("LP_NUM_THREADS", threads);
    EXPECT_EXIT(print_hash_and_exit(), testing::ExitedWithCode(0), expected) << threads;
  }
}

TEST_F(GlContextDeathTest, egl_draws_the_same_picture_as_osmesa) {
  TW_SKIP_WITHOUT_OPENGL();
  std::string reason;
  if (!open_egl_library(reason)) GTEST_SKIP() << reason;
  const std::string expected = hash_text();
  const Environment environment("TIMEWARP_OPENGL", "egl");
  EXPECT_EXIT(print_hash_and_exit(), testing::ExitedWithCode(0), expected);
}

TEST_F(GlContextDeathTest, egl_is_taken_where_osmesa_is_missing) {
  TW_SKIP_WITHOUT_OPENGL();
  std::string reason;
  if (!open_egl_library(reason)) GTEST_SKIP() << reason;
  const std::string expected = hash_text();
  // found first, and no library
  const TemporaryFolder folder;
  std::ofstream(folder / "libOSMesa.so.8") << "no library";
  const Environment path("LD_LIBRARY_PATH", folder.path().c_str());
  EXPECT_EXIT(print_hash_and_exit(), testing::ExitedWithCode(0), expected);
}

// no question whether it can be drawn: the child would ask it again, and not come to the point
TEST_F(GlContextDeathTest, what_is_missing_is_told_with_its_package) {
  const TemporaryFolder folder;
  std::ofstream(folder / "libOSMesa.so.8") << "no library";
  const Environment path("LD_LIBRARY_PATH", folder.path().c_str());
  const Environment wanted("TIMEWARP_OPENGL", "osmesa");
  EXPECT_EXIT(
      {
        std::fputs(user_error_of([] { gl_library(); }).c_str(), stderr);
        std::exit(0);
      },
      testing::ExitedWithCode(0), "cannot draw: .*libOSMesa.*; EGL is not wanted; on Debian: ");
}

TEST_F(GlContextDeathTest, a_library_that_there_is_not_is_refused) {
  const Environment wanted("TIMEWARP_OPENGL", "vulkan");
  EXPECT_EXIT(
      {
        std::fputs(user_error_of([] { gl_library(); }).c_str(), stderr);
        std::exit(0);
      },
      testing::ExitedWithCode(0), "TIMEWARP_OPENGL is vulkan; expected osmesa or egl");
}

TEST_F(GlContextDeathTest, environments_that_crash_mesa_are_mended) {
  // before the library is opened, which mends it: in this process and in its child
  const Environment driver("GALLIUM_DRIVER", "zink");
  const Environment width("LP_NATIVE_VECTOR_WIDTH", "512");
  TW_SKIP_WITHOUT_OPENGL();
  EXPECT_EXIT(print_hash_and_exit(), testing::ExitedWithCode(0), "drawn");
}

}  // namespace
}  // namespace tw::test
