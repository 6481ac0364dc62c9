// Draws frames beside the simulation and writes them: into numbered PNG files, a movie, or both.
//
// One thread draws, another writes (compressing a picture takes a fifth of the time of drawing it);
// up to two pictures wait between them.  The drawing thread owns the OpenGL context from its
// beginning to its end.  Both run with all signals blocked and without floating-point traps, and
// know no Scheme object.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/draw-list.h"
#include "render/image.h"
#include "render/picture-output.h"
#include "render/renderer.h"

namespace tw {

struct FrameSettings {
  RenderSettings render;
  std::string frames;    // a folder, made where it is missing, or a pattern like out/%05d.png
  std::string movie;     // a file; of frames and movie one may be empty
  double fps = 30;       // of the movie
  long first_frame = 0;  // the number of the first frame submitted
  long stride = 1;       // by which the numbers of those submitted go up
};

// Raises UserError where the folder cannot be made or written to, where the pattern, the movie's
// name or the size are wrong, and where a movie is wanted without ffmpeg.
void check_frames(const FrameSettings& settings);

class FramePipeline {
 public:
  // Raises UserError at once as check_frames() does, and where the scene's camera, light, sky or
  // colours are wrong or no OpenGL library is found.  Call it from the main thread.
  FramePipeline(const FrameSettings& settings, const DrawScene& scene);
  // Abandons, unless finish() was called.
  ~FramePipeline();
  FramePipeline(const FramePipeline&) = delete;
  FramePipeline& operator=(const FramePipeline&) = delete;

  // Queues the next frame; waits while 64 are queued.  Raises the first error of drawing or
  // writing, once a thread has met one; frames before it stay on disk.
  void submit(DrawFrame frame);
  // Waits until at most `most` of the frames submitted are not written, but no longer than
  // `seconds`; tells whether it is so.  Raises as submit() does.
  bool wait(std::size_t most, double seconds);
  // No submit() afterwards.  Waits until all frames are written and a movie is whole, but no longer
  // than `seconds`; tells whether it is so.  Raises as submit() does.
  bool finish(double seconds);
  // The same for as long as it takes.
  void finish();
  // Waits until the frame in hand and those drawn before are written, and drops those queued.  A
  // movie is whole up to there.  No submit() afterwards.
  void abandon();

  long frames_written() const;
  // Of drawing and writing so far, in all threads; without ffmpeg's.
  double draw_cpu_seconds() const;
  // Poses that were not finite and so not drawn; a warning went to standard error once.
  long skipped_poses() const;

 private:
  using Outputs = std::vector<std::unique_ptr<PictureOutput>>;

  static Outputs open_outputs(const FrameSettings& settings);
  void guarded(const std::function<void()>& work);
  void draw_all();
  void write_all();
  void write_pictures(Outputs& outputs);
  std::optional<DrawFrame> next_frame();
  void hand_over(Image picture);
  std::optional<Image> next_picture();
  void note_drawn(const Renderer& renderer, const DrawFrame& frame);
  void fail(std::exception_ptr error);
  void raise_error(std::unique_lock<std::mutex>& lock);
  void join();

  const FrameSettings settings_;
  DrawScene scene_;  // read by the drawing thread only

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<DrawFrame> queue_;  // to be drawn
  std::deque<Image> pictures_;   // to be written
  std::size_t unwritten_ = 0;    // frames submitted, not written
  std::exception_ptr error_;     // the first, until it is raised
  bool closing_ = false, failed_ = false;
  bool all_drawn_ = false, all_written_ = false;
  long written_ = 0, skipped_ = 0;
  double drawing_seconds_ = 0, writing_seconds_ = 0;
  std::thread drawing_, writing_;
};

// Draws one picture into a PNG file, in a thread of its own.  The folder must exist.  Raises
// UserError.
void render_image(const std::string& file, const RenderSettings& settings, const DrawScene& scene,
                  const DrawFrame& frame);

}  // namespace tw
