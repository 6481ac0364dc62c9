// Movies by ffmpeg: whole or not there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/movie.h"

#include <csignal>
#include <exception>
#include <fstream>
#include <thread>

#include "picture-tools.h"
#include "render/frame-pipeline.h"

namespace tw::test {
namespace {

namespace fs = std::filesystem;

#define TW_SKIP_WITHOUT_FFMPEG() \
  if (!program_in_path("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed"

FrameSettings movie_settings(const std::string& file, ImageSize size = {64, 48}) {
  FrameSettings settings;
  settings.render = small_settings();
  settings.render.size = size;
  settings.movie = file;
  settings.fps = 25;
  return settings;
}

// What ffprobe says of the only stream: "width,height,frames".
std::string probe(const std::string& file) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v -of csv=p=0 -show_entries "
      "stream=width,height,nb_read_frames '" +
      file + "'";
  FILE* pipe = popen(command.c_str(), "r");
  char line[200] = "";
  if (!fgets(line, sizeof line, pipe)) line[0] = 0;
  pclose(pipe);
  const std::string text = line;
  return text.substr(0, text.find('\n'));
}

TEST(Movie, every_format_holds_all_frames) {
  TW_SKIP_WITHOUT_OPENGL();
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  for (const char* name : {"a.mp4", "a.mkv", "a.webm", "a.gif", "A.MP4", "-b: 'c'.mov"}) {
    FramePipeline pipeline(movie_settings(folder / "new" + ("/" + std::string(name))),
                           ball_over_ground());
    for (int i = 0; i < 5; ++i) pipeline.submit(frame_at(i));
    pipeline.finish();
    EXPECT_EQ(pipeline.frames_written(), 5);
    const std::string file = folder / "new" + ("/" + std::string(name));
    EXPECT_TRUE(fs::exists(file)) << name;
    EXPECT_FALSE(fs::exists(file + ".part")) << name;
    if (std::string(name).find('\'') == std::string::npos) {
      EXPECT_EQ(probe(file), "64,48,5") << name;
    }
  }
}

TEST(Movie, odd_sides_are_made_even_where_the_format_asks_for_it) {
  TW_SKIP_WITHOUT_OPENGL();
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  for (const char* name : {"odd.mp4", "odd.webm", "odd.gif"}) {
    FramePipeline pipeline(movie_settings(folder / name, {65, 49}), ball_over_ground());
    for (int i = 0; i < 2; ++i) pipeline.submit(frame_at(i));
    pipeline.finish();
    EXPECT_EQ(probe(folder / name), std::string(name) == "odd.gif" ? "65,49,2" : "66,50,2");
  }
}

TEST(Movie, it_is_written_beside_numbered_files) {
  TW_SKIP_WITHOUT_OPENGL();
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  FrameSettings settings = movie_settings(folder / "m.mkv");
  settings.frames = folder / "f";
  FramePipeline pipeline(settings, ball_over_ground());
  for (int i = 0; i < 3; ++i) pipeline.submit(frame_at(i));
  pipeline.finish();
  EXPECT_EQ(probe(folder / "m.mkv"), "64,48,3");
  EXPECT_TRUE(fs::exists(folder / "f/00002.png"));
}

TEST(Movie, given_up_it_holds_what_was_drawn_until_then) {
  TW_SKIP_WITHOUT_OPENGL();
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  FramePipeline pipeline(movie_settings(folder / "m.mp4"), ball_over_ground());
  for (int i = 0; i < 60; ++i) pipeline.submit(frame_at(i));
  EXPECT_TRUE(pipeline.wait(58, 60));
  pipeline.abandon();
  EXPECT_EQ(probe(folder / "m.mp4"), "64,48," + std::to_string(pipeline.frames_written()));
}

TEST(Movie, an_error_of_drawing_leaves_the_frames_before_it) {
  TW_SKIP_WITHOUT_OPENGL();
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  FramePipeline pipeline(movie_settings(folder / "m.mp4"), ball_over_ground());
  pipeline.submit(frame_at(0));
  EXPECT_TRUE(pipeline.wait(0, 60));
  DrawFrame bad = frame_at(1);
  bad.camera = Camera();
  bad.camera->fov = 0;
  pipeline.submit(bad);
  EXPECT_TRUE(contains(user_error_of([&] { pipeline.finish(); }), "fov is 0"));
  EXPECT_EQ(probe(folder / "m.mp4"), "64,48,1");
}

// Small pictures: the disk is full where the last bytes are written.  Large ones: long before.
TEST(Movie, a_full_disk_is_told_in_the_words_of_ffmpeg) {
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder / "full.mkv");
  for (const int side : {64, 1024}) {
    Image noise{side, side, {}};
    for (int i = 0; i < 3 * side * side; ++i)
      noise.rgb.push_back(static_cast<std::uint8_t>((i * 7919) >> 3));
    const std::string message = user_error_of([&] {
      std::exception_ptr error;
      // as in the pipeline: a thread that SIGPIPE does not reach
      std::thread([&] {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, nullptr);
        try {
          Movie movie(folder / "full.mkv", {side, side}, 30);
          for (int i = 0; i < 3 * side / 64; ++i) movie.write(noise);
          movie.close();
        } catch (...) {
          error = std::current_exception();
        }
      }).join();
      if (error) std::rethrow_exception(error);
    });
    EXPECT_TRUE(contains(message, "full.mkv': ffmpeg ")) << message;
    EXPECT_TRUE(contains(message, "No space left on device")) << message;
  }
}

TEST(Movie, after_an_error_the_movie_that_was_there_is_untouched) {
  TW_SKIP_WITHOUT_FFMPEG();
  const TemporaryFolder folder;
  const std::string file = folder / "m.mp4";
  std::ofstream(file) << "older";
  {
    // no such rate: ffmpeg refuses it
    Movie movie(file, {64, 48}, 1e-300);
    Image image{64, 48, std::vector<std::uint8_t>(64 * 48 * 3)};
    // what is in the pipe already is not missed
    movie.write(image);
    EXPECT_TRUE(contains(user_error_of([&] { movie.close(); }), "m.mp4': ffmpeg ended"));
  }
  EXPECT_EQ(fs::file_size(file), 5u);
  EXPECT_FALSE(fs::exists(file + ".part"));
}

TEST(Movie, what_cannot_be_is_refused_at_once) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(user_error_of([&] { check_movie(folder / "m.avi"); }),
                       "no ending that is known; expected .mp4"));
  EXPECT_TRUE(contains(user_error_of([&] { check_movie(".mp4"); }), "no ending that is known"));
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_TRUE(contains(user_error_of([&] { check_movie(folder / "m.mp4"); }),
                       "needs ffmpeg, which is not in PATH; on Debian: apt-get install ffmpeg"));
  setenv("PATH", path.c_str(), 1);
  TW_SKIP_WITHOUT_FFMPEG();
  fs::create_directory(folder / "d.mp4");
  EXPECT_TRUE(contains(user_error_of([&] { check_movie(folder / "d.mp4"); }), "it is a folder"));
  EXPECT_TRUE(
      contains(user_error_of([&] { check_movie("/proc/timewarp/m.mp4"); }), "/proc/timewarp"));
}

}  // namespace
}  // namespace tw::test
