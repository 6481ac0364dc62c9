// Frames become files beside the simulation; errors reach the one who submits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/frame-pipeline.h"

#include <cfenv>
#include <fstream>
#include <limits>

#include "picture-tools.h"

namespace tw::test {
namespace {

namespace fs = std::filesystem;

FrameSettings settings_for(const std::string& frames) {
  FrameSettings settings;
  settings.render = small_settings();
  settings.render.size = {64, 48};
  settings.frames = frames;
  return settings;
}

TEST(FramePipeline, all_frames_become_files_in_a_folder_that_it_makes) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FramePipeline pipeline(settings_for(folder / "new/frames"), ball_over_ground());
  for (int i = 0; i < 5; ++i) pipeline.submit(frame_at(i));
  pipeline.finish();
  EXPECT_EQ(pipeline.frames_written(), 5);
  EXPECT_GT(pipeline.draw_cpu_seconds(), 0);
  for (const char* name : {"00000.png", "00001.png", "00002.png", "00003.png", "00004.png"})
    EXPECT_GT(fs::file_size(folder / (std::string("new/frames/") + name)), 100u);
  EXPECT_FALSE(fs::exists(folder / "new/frames/00005.png"));
}

TEST(FramePipeline, numbers_can_go_on_where_another_ended) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FrameSettings settings = settings_for(folder / "f%03d.png");
  settings.first_frame = 8;
  FramePipeline pipeline(settings, ball_over_ground());
  pipeline.submit(frame_at(0));
  pipeline.finish();
  EXPECT_TRUE(fs::exists(folder / "f008.png"));
}

TEST(FramePipeline, numbers_can_go_up_by_more_than_one) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FrameSettings settings = settings_for(folder / "f%03d.png");
  settings.first_frame = 1;
  settings.stride = 3;
  FramePipeline pipeline(settings, ball_over_ground());
  for (int i = 0; i < 2; ++i) pipeline.submit(frame_at(i));
  pipeline.finish();
  EXPECT_TRUE(fs::exists(folder / "f001.png"));
  EXPECT_FALSE(fs::exists(folder / "f002.png"));
  EXPECT_TRUE(fs::exists(folder / "f004.png"));
}

TEST(FramePipeline, nothing_is_made_when_the_folder_cannot_be) {
  EXPECT_NE(user_error_of([] { FramePipeline pipeline(settings_for("/dev/full"), DrawScene()); }),
            "");
  EXPECT_NE(user_error_of(
                [] { FramePipeline pipeline(settings_for("/proc/timewarp/frames"), DrawScene()); }),
            "");
}

TEST(FramePipeline, a_full_disk_is_raised_once_and_earlier_frames_remain) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder / "00002.png");
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  std::string message;
  for (int i = 0; i < 20 && message.empty(); ++i)
    message = user_error_of([&] {
      pipeline.submit(frame_at(i));
      pipeline.wait(2, 60);
    });
  EXPECT_TRUE(contains(message, "00002.png': No space left on device")) << message;
  EXPECT_EQ(user_error_of([&] { pipeline.finish(); }), "");
  EXPECT_EQ(pipeline.frames_written(), 2);
  EXPECT_TRUE(fs::exists(folder / "00001.png"));
  EXPECT_FALSE(fs::exists(folder / "00003.png"));
}

TEST(FramePipeline, an_error_after_the_last_frame_is_raised_by_finish) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder / "00000.png");
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  pipeline.submit(frame_at(0));
  EXPECT_TRUE(contains(user_error_of([&] { pipeline.finish(); }), "No space left"));
}

TEST(FramePipeline, errors_of_the_scene_are_raised_at_once_and_later_ones_too) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  DrawScene scene = ball_over_ground();
  scene.sky.fog = -1;
  EXPECT_TRUE(contains(
      user_error_of([&] { FramePipeline pipeline(settings_for(folder.path().string()), scene); }),
      "fog is -1"));
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  DrawFrame frame = frame_at(0);
  frame.camera = Camera();
  frame.camera->fov = 0;
  pipeline.submit(frame);
  EXPECT_TRUE(contains(user_error_of([&] { pipeline.finish(); }), "fov is 0"));
}

TEST(FramePipeline, it_can_be_given_up_with_frames_in_the_queue) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  for (int i = 0; i < 3; ++i) pipeline.submit(frame_at(i));
}

TEST(FramePipeline, abandoned_it_writes_the_frame_in_hand_and_no_other) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FrameSettings settings = settings_for(folder.path().string());
  settings.render.size = {1280, 720};
  settings.render.quality = Quality::best;
  FramePipeline pipeline(settings, ball_over_ground());
  for (int i = 0; i < 20; ++i) pipeline.submit(frame_at(i));
  EXPECT_FALSE(pipeline.wait(0, 0.001));
  EXPECT_TRUE(pipeline.wait(19, 60));
  pipeline.abandon();
  EXPECT_GE(pipeline.frames_written(), 1);
  EXPECT_LE(pipeline.frames_written(), 3);
  EXPECT_FALSE(fs::exists(folder / "00005.png"));
}

TEST(FramePipeline, its_end_can_be_waited_for_in_pieces) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  for (int i = 0; i < 5; ++i) pipeline.submit(frame_at(i));
  EXPECT_FALSE(pipeline.finish(0));
  EXPECT_TRUE(pipeline.finish(60));
  EXPECT_EQ(pipeline.frames_written(), 5);
  EXPECT_TRUE(fs::exists(folder / "00004.png"));
  pipeline.finish();
}

TEST(FramePipeline, lost_bodies_are_counted) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  DrawFrame frame = frame_at(0.5);
  frame.poses.resize(1);
  frame.poses[0].p.x() = std::numeric_limits<double>::quiet_NaN();
  testing::internal::CaptureStderr();
  pipeline.submit(frame);
  pipeline.submit(frame);
  pipeline.finish();
  const std::string warning = testing::internal::GetCapturedStderr();
  EXPECT_EQ(pipeline.skipped_poses(), 2);
  EXPECT_TRUE(contains(warning, "at 0.5 s"));
  // one warning only
  EXPECT_EQ(warning.find("warning"), warning.rfind("warning"));
}

TEST(FramePipeline, drawing_works_while_floating_point_traps_are_on) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  FramePipeline pipeline(settings_for(folder.path().string()), ball_over_ground());
  pipeline.submit(frame_at(0));
  pipeline.finish();
  const int traps = fedisableexcept(FE_ALL_EXCEPT);
  EXPECT_EQ(traps, FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  EXPECT_EQ(pipeline.frames_written(), 1);
}

TEST(RenderImage, one_picture_becomes_one_file) {
  TW_SKIP_WITHOUT_OPENGL();
  const TemporaryFolder folder;
  render_image(folder / "shot.png", small_settings(), ball_over_ground(), frame_at(0));
  EXPECT_GT(fs::file_size(folder / "shot.png"), 100u);
  EXPECT_TRUE(contains(user_error_of([&] {
                         render_image(folder / "no/shot.png", small_settings(), ball_over_ground(),
                                      frame_at(0));
                       }),
                       "No such file or directory"));
  EXPECT_TRUE(contains(user_error_of([&] {
                         RenderSettings settings = small_settings();
                         settings.size = {0, 3};
                         render_image(folder / "shot.png", settings, ball_over_ground(),
                                      frame_at(0));
                       }),
                       "size is 0x3"));
}

}  // namespace
}  // namespace tw::test
