// Letters of DejaVu Sans, drawn beforehand in a few sizes and compiled in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tw {

// Coverage of one letter, 0..15 per pixel, rows from the top.
struct Glyph {
  int width = 0, height = 0;
  int left = 0, top = 0;  // from the pen to the left edge; from the baseline up to the top edge
  int advance = 0;        // to the next pen position
  std::vector<std::uint8_t> coverage;
};

class Font {
 public:
  // The font whose size is nearest to `pixels`, made on first use; safe from any thread.
  static const Font& nearest(int pixels);

  int size() const { return size_; }
  // The glyph of a Unicode character; a question mark for what is not in Latin-1.
  const Glyph& glyph(char32_t character) const;

 private:
  friend struct FontMaker;
  int size_ = 0;
  std::vector<Glyph> glyphs_;  // of 32..126, then 160..255
};

// The characters of UTF-8 text; bytes that are not UTF-8 become question marks.
std::u32string decode_utf8(const std::string& text);

}  // namespace tw
