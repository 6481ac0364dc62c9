// Draws frames into numbered PNG files beside the simulation, in a thread of its own.
//
// The thread owns the OpenGL context from its beginning to its end.  It runs with all signals
// blocked and without floating-point traps, and knows no Scheme object.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "render/draw-list.h"
#include "render/frame-name.h"
#include "render/renderer.h"

namespace tw {

struct FrameSettings {
  RenderSettings render;
  std::string frames;    // a folder, made where it is missing, or a pattern like out/%05d.png
  long first_frame = 0;  // the number of the first frame submitted
  long stride = 1;       // by which the numbers of those submitted go up
};

class FramePipeline {
 public:
  // Raises UserError at once where the folder cannot be made or written to, where the pattern, the
  // size or the scene's camera, light, sky or colours are wrong, and where no OpenGL library is
  // found.  Call it from the main thread.
  FramePipeline(const FrameSettings& settings, const DrawScene& scene);
  // Abandons, unless finish() was called.
  ~FramePipeline();
  FramePipeline(const FramePipeline&) = delete;
  FramePipeline& operator=(const FramePipeline&) = delete;

  // Queues the next frame; waits while 64 are queued.  Raises the first error of drawing or
  // writing, once the thread has met one; frames before it stay on disk.
  void submit(DrawFrame frame);
  // Waits until at most `most` of the frames submitted are not on disk, but no longer than
  // `seconds`; tells whether it is so.  Raises as submit() does.
  bool wait(std::size_t most, double seconds);
  // Waits until all frames are written.  Raises the first error, once.  No submit() afterwards.
  void finish();
  // Waits until the frame in hand is written and drops those queued.  No submit() afterwards.
  void abandon();

  long frames_written() const;
  // Of drawing and writing so far, in all threads.
  double draw_cpu_seconds() const;
  // Poses that were not finite and so not drawn; a warning went to standard error once.
  long skipped_poses() const;

 private:
  void work();
  void draw_all();
  std::optional<DrawFrame> next_frame();
  void note_progress(const Renderer& renderer, const DrawFrame& frame);
  void raise_error(std::unique_lock<std::mutex>& lock);
  void join();

  const FrameSettings settings_;
  const FrameName name_;
  DrawScene scene_;  // read by the thread only

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<DrawFrame> queue_;
  std::exception_ptr error_;
  bool closing_ = false, abandoned_ = false, failed_ = false;
  bool in_hand_ = false;  // the thread draws a frame
  long written_ = 0, skipped_ = 0;
  double cpu_seconds_ = 0;
  std::thread thread_;
};

// Draws one picture into a PNG file, in a thread of its own.  The folder must exist.  Raises
// UserError.
void render_image(const std::string& file, const RenderSettings& settings, const DrawScene& scene,
                  const DrawFrame& frame);

}  // namespace tw
