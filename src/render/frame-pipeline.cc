// The two threads and their queues.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/frame-pipeline.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <utility>

#include "base/cpu-clock.h"
#include "base/error.h"
#include "render/floating-point-guard.h"
#include "render/movie.h"
#include "render/picture-files.h"
#include "render/png.h"
#include "render/whole-file.h"

namespace tw {

namespace {

// a bound for memory; those who feed the queue keep it shorter, by wait()
constexpr std::size_t queue_length = 64;

constexpr std::size_t pictures_waiting = 2;

// Starts a thread in which no signal handler ever runs: signals are for the main thread.
template <class Work>
std::thread start_quiet_thread(Work work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread thread([work] {
      const FloatingPointGuard guard;
      work();
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
}

double drawing_cpu_seconds() {
  return thread_cpu_seconds() + named_threads_cpu_seconds("llvmpipe-");
}

}  // namespace

void check_frames(const FrameSettings& settings) {
  check_size(settings.render.size, settings.render.quality);
  if (!settings.frames.empty()) make_writable_folder(FrameName(settings.frames).folder());
  if (!settings.movie.empty()) check_movie(settings.movie);
}

FramePipeline::FramePipeline(const FrameSettings& settings, const DrawScene& scene)
    : settings_(settings), scene_(scene) {
  check_frames(settings);
  check_scene(scene);
  // here, where changing the environment disturbs no other thread
  gl_library();
  drawing_ = start_quiet_thread([this] {
    guarded([this] { draw_all(); });
    const std::lock_guard lock(mutex_);
    all_drawn_ = true;
    changed_.notify_all();
  });
  try {
    writing_ = start_quiet_thread([this] { write_all(); });
  } catch (...) {
    abandon();
    throw;
  }
}

FramePipeline::Outputs FramePipeline::open_outputs(const FrameSettings& settings) {
  Outputs outputs;
  if (!settings.frames.empty())
    outputs.push_back(std::make_unique<PictureFiles>(FrameName(settings.frames),
                                                     settings.first_frame, settings.stride));
  if (!settings.movie.empty())
    outputs.push_back(std::make_unique<Movie>(settings.movie, settings.render.size, settings.fps));
  return outputs;
}

FramePipeline::~FramePipeline() { abandon(); }

void FramePipeline::abandon() {
  {
    const std::lock_guard lock(mutex_);
    unwritten_ -= queue_.size();
    queue_.clear();
  }
  join();
}

void FramePipeline::join() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  if (drawing_.joinable()) drawing_.join();
  if (writing_.joinable()) writing_.join();
}

// ---- errors ----

void FramePipeline::guarded(const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    fail(std::current_exception());
  }
}

// After an error nothing more is drawn or written.
void FramePipeline::fail(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  if (!failed_) error_ = std::move(error);
  failed_ = true;
  queue_.clear();
  pictures_.clear();
  unwritten_ = 0;
  changed_.notify_all();
}

void FramePipeline::raise_error(std::unique_lock<std::mutex>& lock) {
  if (!error_) return;
  const std::exception_ptr error = std::exchange(error_, nullptr);
  lock.unlock();
  std::rethrow_exception(error);
}

// ---- the side of the simulation ----

void FramePipeline::submit(DrawFrame frame) {
  std::unique_lock lock(mutex_);
  TW_ASSERT(!closing_, "a frame after the last");
  changed_.wait(lock, [this] { return failed_ || queue_.size() < queue_length; });
  raise_error(lock);
  if (failed_) return;
  queue_.push_back(std::move(frame));
  ++unwritten_;
  changed_.notify_all();
}

bool FramePipeline::wait(std::size_t most, double seconds) {
  std::unique_lock lock(mutex_);
  const bool reached = changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                                         [&] { return failed_ || unwritten_ <= most; });
  raise_error(lock);
  return reached;
}

bool FramePipeline::finish(double seconds) {
  std::unique_lock lock(mutex_);
  closing_ = true;
  changed_.notify_all();
  const bool finished =
      changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return all_written_; });
  raise_error(lock);
  return finished;
}

void FramePipeline::finish() {
  join();
  std::unique_lock lock(mutex_);
  raise_error(lock);
}

// ---- the thread that draws ----

void FramePipeline::draw_all() {
  Renderer renderer(settings_.render, scene_);
  while (std::optional<DrawFrame> frame = next_frame()) {
    Image picture = renderer.draw(*frame);
    note_drawn(renderer, *frame);
    hand_over(std::move(picture));
  }
}

// Waits for a frame; nothing after the last.
std::optional<DrawFrame> FramePipeline::next_frame() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failed_ || closing_ || !queue_.empty(); });
  if (queue_.empty()) return std::nullopt;
  DrawFrame frame = std::move(queue_.front());
  queue_.pop_front();
  changed_.notify_all();
  return frame;
}

void FramePipeline::hand_over(Image picture) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failed_ || pictures_.size() < pictures_waiting; });
  if (failed_) return;
  pictures_.push_back(std::move(picture));
  changed_.notify_all();
}

void FramePipeline::note_drawn(const Renderer& renderer, const DrawFrame& frame) {
  // the threads of the renderer must still live to be asked
  const double cpu_seconds = drawing_cpu_seconds();
  const std::lock_guard lock(mutex_);
  drawing_seconds_ = cpu_seconds;
  if (skipped_ == 0 && renderer.skipped_poses() > 0)
    std::fprintf(stderr,
                 "timewarp: warning: at %s s the pose of a body is not finite; it is not drawn\n",
                 show(frame.time).c_str());
  skipped_ = renderer.skipped_poses();
}

// ---- the thread that writes ----

void FramePipeline::write_all() {
  Outputs outputs;
  guarded([&] {
    outputs = open_outputs(settings_);
    write_pictures(outputs);
  });
  // also after an error: what was written is to be whole
  for (const auto& output : outputs) guarded([&] { output->close(); });
  const std::lock_guard lock(mutex_);
  all_written_ = true;
  changed_.notify_all();
}

void FramePipeline::write_pictures(Outputs& outputs) {
  while (const std::optional<Image> picture = next_picture()) {
    for (const auto& output : outputs) output->write(*picture);
    const std::lock_guard lock(mutex_);
    ++written_;
    if (!failed_) --unwritten_;
    writing_seconds_ = thread_cpu_seconds();
    changed_.notify_all();
  }
}

// Waits for a picture; nothing after the last.
std::optional<Image> FramePipeline::next_picture() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failed_ || all_drawn_ || !pictures_.empty(); });
  if (pictures_.empty()) return std::nullopt;
  Image picture = std::move(pictures_.front());
  pictures_.pop_front();
  changed_.notify_all();
  return picture;
}

// ---- counts ----

long FramePipeline::frames_written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

double FramePipeline::draw_cpu_seconds() const {
  const std::lock_guard lock(mutex_);
  return drawing_seconds_ + writing_seconds_;
}

long FramePipeline::skipped_poses() const {
  const std::lock_guard lock(mutex_);
  return skipped_;
}

void render_image(const std::string& file, const RenderSettings& settings, const DrawScene& scene,
                  const DrawFrame& frame) {
  check_size(settings.size, settings.quality);
  check_scene(scene);
  gl_library();
  std::exception_ptr error;
  std::thread thread = start_quiet_thread([&] {
    try {
      write_whole_file(file, encode_png(Renderer(settings, scene).draw(frame)));
    } catch (...) {
      error = std::current_exception();
    }
  });
  thread.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace tw
