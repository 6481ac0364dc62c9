// Where finished pictures go: numbered files, a movie.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "render/image.h"

namespace tw {

class PictureOutput {
 public:
  virtual ~PictureOutput() = default;
  // Takes the next picture.  Raises UserError where it cannot be written; no more come then.
  virtual void write(const Image& image) = 0;
  // Makes what was written whole, as far as pictures have come.  Raises UserError.  Called once,
  // also after write() has failed; then there is nothing left to raise.
  virtual void close() = 0;
};

}  // namespace tw
