// Reading the compiled-in letters, and UTF-8.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/font.h"

#include <cstdlib>

namespace tw {

namespace {

struct GlyphData {
  int code, width, height, left, top, advance;
  const char* pixels;
};

struct FontData {
  int size;
  std::vector<GlyphData> glyphs;
};

const std::vector<FontData>& font_data() {
  static const std::vector<FontData> data = {
#define TW_FONT_BEGIN(size) {size, {
#define TW_FONT_END \
  }                 \
  }                 \
  ,
#include "render/font-data.inc"
#undef TW_FONT_BEGIN
#undef TW_FONT_END
  };
  return data;
}

// A hexadecimal digit is a pixel; g..z repeat it 1..20 more times.
std::vector<std::uint8_t> expand(const char* pixels) {
  std::vector<std::uint8_t> coverage;
  for (const char* c = pixels; *c; ++c) {
    if (*c >= 'g')
      coverage.insert(coverage.end(), static_cast<std::size_t>(*c - 'g' + 1), coverage.back());
    else
      coverage.push_back(static_cast<std::uint8_t>(*c <= '9' ? *c - '0' : *c - 'a' + 10));
  }
  return coverage;
}

constexpr char32_t replacement = U'?';

// Length of a UTF-8 sequence by its first byte, 0 for a byte that starts none.
int sequence_length(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  if (first >= 0xF0 && first < 0xF5) return 4;
  return 0;
}

// The character whose sequence starts at `at`, which moves past it.
char32_t next_character(const std::string& text, std::size_t& at) {
  const auto first = static_cast<unsigned char>(text[at++]);
  const int length = sequence_length(first);
  if (length == 0) return replacement;
  if (length == 1) return first;
  char32_t character = first & (0x7Fu >> length);
  for (int i = 1; i < length; ++i, ++at) {
    if (at == text.size() || (static_cast<unsigned char>(text[at]) & 0xC0) != 0x80)
      return replacement;
    character = (character << 6) | (static_cast<unsigned char>(text[at]) & 0x3Fu);
  }
  return character;
}

}  // namespace

struct FontMaker {
  static std::vector<Font> make_all() {
    std::vector<Font> fonts;
    for (const FontData& data : font_data()) {
      Font font;
      font.size_ = data.size;
      for (const GlyphData& g : data.glyphs)
        font.glyphs_.push_back({g.width, g.height, g.left, g.top, g.advance, expand(g.pixels)});
      fonts.push_back(std::move(font));
    }
    return fonts;
  }
};

const Font& Font::nearest(int pixels) {
  static const std::vector<Font> fonts = FontMaker::make_all();
  const Font* best = &fonts.front();
  for (const Font& font : fonts)
    if (std::abs(font.size_ - pixels) < std::abs(best->size_ - pixels)) best = &font;
  return *best;
}

const Glyph& Font::glyph(char32_t character) const {
  if (character >= 32 && character < 127) return glyphs_[character - 32];
  if (character >= 160 && character < 256) return glyphs_[95 + character - 160];
  return glyph(replacement);
}

std::u32string decode_utf8(const std::string& text) {
  std::u32string characters;
  for (std::size_t at = 0; at < text.size();) characters += next_character(text, at);
  return characters;
}

}  // namespace tw
