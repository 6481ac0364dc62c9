// File names of frames: DIR stands for DIR/00000.png ..., a pattern like out/%05d.png for itself.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

namespace tw {

class FrameName {
 public:
  // A folder, or a pattern: it holds one conversion %d, %Nd or %0Nd (N up to 20 digits); %% is a
  // percent sign.  Raises UserError on anything else after a percent sign, and on an empty name.
  explicit FrameName(const std::string& folder_or_pattern);

  // The name of frame `index` (0 or more).
  std::string name(long index) const;
  // Where the frames go; "" is the current folder.
  const std::string& folder() const { return folder_; }

 private:
  std::string before_, after_, folder_;
  int width_ = 5;
  char fill_ = '0';
};

}  // namespace tw
