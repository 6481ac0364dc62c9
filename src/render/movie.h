// A movie: pictures handed to ffmpeg, which must be installed where a movie is wanted, and only
// there.
//
// The name's end chooses format and codec: .mp4, .m4v, .mov and .mkv are H.264, .webm is VP9, all
// in 4:2:0 and marked as BT.709; .gif has a palette for every picture.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/draw-list.h"
#include "render/picture-output.h"
#include "render/piped-program.h"

namespace tw {

class Movie : public PictureOutput {
 public:
  // fps > 0.  ffmpeg is started with the first picture: without any there is no movie.
  Movie(std::string file, ImageSize size, double fps);
  ~Movie() override;

  // ffmpeg writes into `file`.part (unless that is a device or a pipe); after an error the part is
  // gone, and a file that was there before is untouched.
  void write(const Image& image) override;
  // Waits for ffmpeg, and gives the movie its name.
  void close() override;

 private:
  void start();
  [[noreturn]] void fail(const std::string& how);

  const std::string file_;
  const ImageSize size_;
  const double fps_;
  std::string written_file_;  // the part, or the file itself
  std::optional<PipedProgram> ffmpeg_;
};

// Raises UserError, before anything is drawn, where ffmpeg is missing, the name's end is none of
// those above, or the file cannot be written.  Makes its folder.
void check_movie(const std::string& file);

// What ffmpeg is called with to write `output` in the format that `file` asks for.
std::vector<std::string> ffmpeg_command(const std::string& file, const std::string& output,
                                        ImageSize size, double fps);

// The size of a movie's pictures: the formats but GIF need even sides.
ImageSize movie_size(const std::string& file, ImageSize size);

}  // namespace tw
