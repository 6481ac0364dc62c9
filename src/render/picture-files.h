// Pictures as numbered PNG files, each either whole or not there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "render/frame-name.h"
#include "render/picture-output.h"

namespace tw {

class PictureFiles : public PictureOutput {
 public:
  // The first picture has the number `first`, each further one `stride` more.  The folder is there.
  PictureFiles(FrameName name, long first, long stride)
      : name_(std::move(name)), index_(first), stride_(stride) {}
  void write(const Image& image) override;
  void close() override {}

 private:
  const FrameName name_;
  long index_;
  const long stride_;
};

}  // namespace tw
