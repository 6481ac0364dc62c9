// The head-up display: the time and other lines, blended into the finished picture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/blend.h"
#include "render/image.h"

namespace tw {

struct HudLine {
  std::string text;  // UTF-8
  Ink ink = white_ink;

  HudLine(std::string line, const Ink& color = white_ink) : text(std::move(line)), ink(color) {}
  HudLine(const char* line) : text(line) {}
};

struct Hud {
  double time = 0;             // s; shown as "t = 12.480 s"
  std::vector<HudLine> lines;  // below it, smaller
  std::string footer;          // at the lower right, UTF-8
  // A bar of a round length at the lower left; none where pixels_per_metre is 0.
  double pixels_per_metre = 0;
};

// Letters grow with the picture; what does not fit is cut off.  Pictures lower than 48 pixels get
// none.
void draw_hud(Image& image, const Hud& hud);

// "t = 12.480 s"
std::string time_text(double time);

}  // namespace tw
