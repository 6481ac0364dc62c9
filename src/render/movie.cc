// Handing pictures to ffmpeg.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/movie.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "render/whole-file.h"

namespace tw {

namespace {

using Words = std::vector<std::string>;

struct Format {
  const char* suffix;
  const char* name;  // ffmpeg's
  Words options;
  bool even;  // sides must be even
};

// Players take pictures of unknown colours for BT.601 or BT.709, by their size: so they are
// converted by BT.709 and say so.
Words with_video_colors(Words options) {
  const Words colors = {"-vf",
                        "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
                        "-colorspace",
                        "bt709",
                        "-color_trc",
                        "bt709",
                        "-color_range",
                        "tv",
                        "-color_primaries",
                        "bt709"};
  options.insert(options.end(), colors.begin(), colors.end());
  return options;
}

Words h264(bool index_first) {
  Words options = with_video_colors({"-c:v", "libx264", "-preset", "veryfast", "-crf", "18"});
  // the index before the pictures, so that a browser can begin to play
  if (index_first) options.insert(options.end(), {"-movflags", "+faststart"});
  return options;
}

Words vp9() {
  return with_video_colors({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-deadline",
                            "realtime", "-cpu-used", "5", "-row-mt", "1"});
}

// one palette per picture: one for all would need all pictures in memory
Words gif() {
  return {"-filter_complex",
          "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=bayer:"
          "bayer_scale=4"};
}

const std::array<Format, 6>& formats() {
  static const std::array<Format, 6> all = {{{".mp4", "mp4", h264(true), true},
                                             {".m4v", "mp4", h264(true), true},
                                             {".mov", "mov", h264(true), true},
                                             {".mkv", "matroska", h264(false), true},
                                             {".webm", "webm", vp9(), true},
                                             {".gif", "gif", gif(), false}}};
  return all;
}

bool ends_in(const std::string& text, const std::string& end) {
  if (text.size() <= end.size()) return false;
  return std::equal(end.begin(), end.end(), text.end() - static_cast<std::ptrdiff_t>(end.size()),
                    [](char wanted, char c) { return wanted == (c | 0x20) || wanted == c; });
}

const Format& format_of(const std::string& file) {
  for (const Format& format : formats())
    if (ends_in(file, format.suffix)) return format;
  throw UserError("the movie '" + file +
                  "' has no ending that is known; expected .mp4, .mov, .mkv, .webm or .gif");
}

// The last column and row once more where a side is to be even and is not.
Image widened(const Image& image, ImageSize size) {
  Image wide{size.width, size.height, {}};
  wide.rgb.resize(3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (int y = 0; y < size.height; ++y) {
    const int from_y = std::min(y, image.height - 1);
    std::copy_n(image.pixel(0, from_y), 3 * image.width, wide.pixel(0, y));
    if (size.width > image.width)
      std::copy_n(image.pixel(image.width - 1, from_y), 3, wide.pixel(image.width, y));
  }
  return wide;
}

}  // namespace

ImageSize movie_size(const std::string& file, ImageSize size) {
  if (!format_of(file).even) return size;
  return {size.width + size.width % 2, size.height + size.height % 2};
}

Words ffmpeg_command(const std::string& file, const std::string& output, ImageSize size,
                     double fps) {
  const Format& format = format_of(file);
  const ImageSize even = movie_size(file, size);
  const std::string sides = std::to_string(even.width) + "x" + std::to_string(even.height);
  Words command = {"ffmpeg",     "-hide_banner", "-nostdin", "-y",    "-loglevel",   "repeat+error",
                   "-f",         "rawvideo",     "-pix_fmt", "rgb24", "-video_size", sides,
                   "-framerate", show(fps),      "-i",       "pipe:0"};
  command.insert(command.end(), format.options.begin(), format.options.end());
  // "file:" so that no name is taken for an option or an address
  command.insert(command.end(), {"-f", format.name, "file:" + output});
  return command;
}

void check_movie(const std::string& file) {
  format_of(file);
  TW_REQUIRE(program_in_path("ffmpeg"), "cannot make the movie '" + file +
                                            "': it needs ffmpeg, which is not in PATH; on Debian: "
                                            "apt-get install ffmpeg");
  make_writable_folder(folder_of(file));
  struct stat status;
  if (stat(file.c_str(), &status) != 0) return;
  TW_REQUIRE(!S_ISDIR(status.st_mode), "cannot write the movie '" + file + "': it is a folder");
  TW_REQUIRE(access(file.c_str(), W_OK) == 0,
             "cannot write the movie '" + file + "': " + std::strerror(errno));
}

Movie::Movie(std::string file, ImageSize size, double fps)
    : file_(std::move(file)),
      size_(movie_size(file_, size)),
      fps_(fps),
      written_file_(is_special_file(file_) ? file_ : file_ + ".part") {}

Movie::~Movie() {
  if (!ffmpeg_) return;
  ffmpeg_.reset();
  if (written_file_ != file_) unlink(written_file_.c_str());
}

void Movie::start() { ffmpeg_.emplace(ffmpeg_command(file_, written_file_, size_, fps_)); }

void Movie::fail(const std::string& how) {
  ffmpeg_.reset();
  if (written_file_ != file_) unlink(written_file_.c_str());
  throw UserError("cannot write the movie '" + file_ + "': " + how);
}

void Movie::write(const Image& image) {
  if (!ffmpeg_) start();
  const bool fits = image.width == size_.width && image.height == size_.height;
  if (ffmpeg_->write(fits ? image.rgb : widened(image, size_).rgb)) return;
  const std::string end = ffmpeg_->finish();
  fail("ffmpeg " + (end.empty() ? "ended too early" : end));
}

void Movie::close() {
  if (!ffmpeg_) return;
  const std::string end = ffmpeg_->finish(), words = ffmpeg_->last_words();
  if (!end.empty()) fail("ffmpeg " + end);
  // what fails while it writes the last bytes does not show in its status
  if (words.find("Error ") != std::string::npos) fail("ffmpeg says: " + words);
  ffmpeg_.reset();
  if (written_file_ != file_ && std::rename(written_file_.c_str(), file_.c_str()) != 0)
    fail(std::strerror(errno));
}

}  // namespace tw
