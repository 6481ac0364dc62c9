// Blending panels, bars and letters into rows of pixels.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/hud.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/font.h"

namespace tw {

namespace {

struct Box {
  int x, y, width, height;
};

void blend_box(Image& image, const Box& box, const Ink& ink, int coverage) {
  const int x_end = std::min(box.x + box.width, image.width);
  const int y_end = std::min(box.y + box.height, image.height);
  for (int y = std::max(box.y, 0); y < y_end; ++y)
    for (int x = std::max(box.x, 0); x < x_end; ++x) blend(image.pixel(x, y), ink, coverage);
}

// Letters of `scale` times the font's size, their baseline's left end at (x, y).
struct Text {
  const Font& font;
  int scale;

  int width(const std::u32string& text) const {
    int sum = 0;
    for (const char32_t c : text) sum += scale * font.glyph(c).advance;
    return sum;
  }
  int line_height() const { return scale * (font.size() * 4 / 3); }

  void draw_glyph(Image& image, const Glyph& glyph, int x, int y, const Ink& ink,
                  int strength) const {
    for (int row = 0; row < glyph.height; ++row)
      for (int column = 0; column < glyph.width; ++column) {
        const int coverage =
            glyph.coverage[static_cast<std::size_t>(row * glyph.width + column)] * 17;
        if (coverage == 0) continue;
        const Box dot{x + scale * (glyph.left + column), y + scale * (row - glyph.top), scale,
                      scale};
        blend_box(image, dot, ink, coverage * strength / 255);
      }
  }

  // on a soft shadow so that it reads on any ground
  void draw(Image& image, const std::u32string& text, int x, int y,
            const Ink& ink = white_ink) const {
    for (const char32_t c : text) {
      const Glyph& glyph = font.glyph(c);
      draw_glyph(image, glyph, x + scale, y + scale, black_ink, 110);
      draw_glyph(image, glyph, x, y, ink, 245);
      x += scale * glyph.advance;
    }
  }
};

// The font for letters of this height, doubled where the largest is too small.
Text text_of(double pixels) {
  const int scale = std::max(1, static_cast<int>(std::lround(pixels / 40)));
  return {Font::nearest(static_cast<int>(std::lround(pixels / scale))), scale};
}

struct Layout {
  Text large, small;
  int margin, padding;
};

Layout layout_of(const Image& image) {
  const double unit = std::clamp(image.height / 720.0, 0.5, 16.0);
  return {text_of(22 * unit), text_of(16 * unit), static_cast<int>(std::lround(18 * unit)),
          static_cast<int>(std::lround(12 * unit))};
}

void draw_panel(Image& image, const Hud& hud, const Layout& layout) {
  const std::u32string time = decode_utf8(time_text(hud.time));
  std::vector<std::u32string> lines;
  // a width that does not jitter as digits change
  int width = layout.large.width(time);
  for (const HudLine& line : hud.lines) {
    lines.push_back(decode_utf8(line.text));
    width = std::max(width, layout.small.width(lines.back()));
  }
  const int height =
      layout.large.line_height() + static_cast<int>(lines.size()) * layout.small.line_height();
  blend_box(image,
            {layout.margin, layout.margin, width + 2 * layout.padding,
             height + 2 * layout.padding - layout.padding / 2},
            {24, 24, 24}, 140);
  const int x = layout.margin + layout.padding;
  int y = layout.margin + layout.padding / 2 + layout.large.line_height() * 7 / 8;
  layout.large.draw(image, time, x, y);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    y += layout.small.line_height();
    layout.small.draw(image, lines[i], x, y, hud.lines[i].ink);
  }
}

// 1, 2 or 5 times a power of ten, at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= length) return factor * power;
  return power;
}

void draw_scale_bar(Image& image, const Hud& hud, const Layout& layout) {
  if (!(hud.pixels_per_metre > 0) || !std::isfinite(hud.pixels_per_metre)) return;
  const double length = round_length(0.14 * image.width / hud.pixels_per_metre);
  const int width = static_cast<int>(std::lround(length * hud.pixels_per_metre));
  const int thickness = std::max(1, layout.margin / 6);
  const int y = image.height - layout.margin - thickness;
  blend_box(image, {layout.margin + 1, y + 1, width, thickness}, black_ink, 110);
  blend_box(image, {layout.margin, y, width, thickness}, white_ink, 235);
  char text[64];
  std::snprintf(text, sizeof text, "%g m", length);
  layout.small.draw(image, decode_utf8(text), layout.margin, y - layout.margin / 3);
}

}  // namespace

std::string time_text(double time) {
  char text[400];
  std::snprintf(text, sizeof text, "t = %.3f s", time);
  return text;
}

void draw_hud(Image& image, const Hud& hud) {
  if (image.height < 48) return;
  const Layout layout = layout_of(image);
  draw_panel(image, hud, layout);
  draw_scale_bar(image, hud, layout);
  if (hud.footer.empty()) return;
  const std::u32string footer = decode_utf8(hud.footer);
  layout.small.draw(image, footer, image.width - layout.margin - layout.small.width(footer),
                    image.height - layout.margin);
}

}  // namespace tw
