// The drawing thread and its queue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/frame-pipeline.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <utility>

#include "base/cpu-clock.h"
#include "base/error.h"
#include "render/floating-point-guard.h"
#include "render/png.h"
#include "render/whole-file.h"

namespace tw {

namespace {

// a bound for memory; those who feed the queue keep it shorter, by wait()
constexpr std::size_t queue_length = 64;

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

FramePipeline::FramePipeline(const FrameSettings& settings, const DrawScene& scene)
    : settings_(settings), name_(settings.frames), scene_(scene) {
  check_size(settings.render.size, settings.render.quality);
  check_scene(scene);
  make_writable_folder(name_.folder());
  // here, where changing the environment disturbs no other thread
  gl_library();
  thread_ = start_quiet_thread([this] { work(); });
}

FramePipeline::~FramePipeline() { abandon(); }

void FramePipeline::abandon() {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
  }
  join();
}

void FramePipeline::join() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void FramePipeline::raise_error(std::unique_lock<std::mutex>& lock) {
  if (!error_) return;
  const std::exception_ptr error = std::exchange(error_, nullptr);
  lock.unlock();
  std::rethrow_exception(error);
}

void FramePipeline::submit(DrawFrame frame) {
  std::unique_lock lock(mutex_);
  TW_ASSERT(!closing_, "a frame after the last");
  changed_.wait(lock, [this] { return failed_ || queue_.size() < queue_length; });
  raise_error(lock);
  // after an error nothing more is drawn
  if (failed_) return;
  queue_.push_back(std::move(frame));
  changed_.notify_all();
}

bool FramePipeline::wait(std::size_t most, double seconds) {
  std::unique_lock lock(mutex_);
  const bool reached = changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
    return failed_ || queue_.size() + (in_hand_ ? 1 : 0) <= most;
  });
  raise_error(lock);
  return reached;
}

void FramePipeline::finish() {
  join();
  std::unique_lock lock(mutex_);
  raise_error(lock);
}

void FramePipeline::work() {
  try {
    draw_all();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    failed_ = true;
    in_hand_ = false;
    queue_.clear();
  }
  changed_.notify_all();
}

void FramePipeline::draw_all() {
  Renderer renderer(settings_.render, scene_);
  long index = settings_.first_frame;
  while (std::optional<DrawFrame> frame = next_frame()) {
    const Image image = renderer.draw(*frame);
    write_whole_file(name_.name(index), encode_png(image));
    index += settings_.stride;
    note_progress(renderer, *frame);
  }
}

// Waits for a frame; nothing after the last.
std::optional<DrawFrame> FramePipeline::next_frame() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return abandoned_ || closing_ || !queue_.empty(); });
  if (abandoned_ || queue_.empty()) return std::nullopt;
  DrawFrame frame = std::move(queue_.front());
  queue_.pop_front();
  in_hand_ = true;
  changed_.notify_all();
  return frame;
}

void FramePipeline::note_progress(const Renderer& renderer, const DrawFrame& frame) {
  // the threads of the renderer must still live to be asked
  const double cpu_seconds = drawing_cpu_seconds();
  const std::lock_guard lock(mutex_);
  ++written_;
  in_hand_ = false;
  changed_.notify_all();
  cpu_seconds_ = cpu_seconds;
  if (skipped_ == 0 && renderer.skipped_poses() > 0)
    std::fprintf(stderr,
                 "timewarp: warning: at %s s the pose of a body is not finite; it is not drawn\n",
                 show(frame.time).c_str());
  skipped_ = renderer.skipped_poses();
}

long FramePipeline::frames_written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

double FramePipeline::draw_cpu_seconds() const {
  const std::lock_guard lock(mutex_);
  return cpu_seconds_;
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
