// Pictures as numbered PNG files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/picture-files.h"

#include "render/png.h"
#include "render/whole-file.h"

namespace tw {

void PictureFiles::write(const Image& image) {
  write_whole_file(name_.name(index_), encode_png(image));
  index_ += stride_;
}

}  // namespace tw
