// Draws the letters of a font once and for all, as the data that src/render/hud.cc compiles in.
//
//   c++ -std=c++20 make-font-atlas.cc $(pkg-config --cflags --libs freetype2) -o make-font-atlas
//   ./make-font-atlas /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf > ../src/render/font-data.inc
//
// Output: for every size, the rows `{code, width, height, left, top, advance, "pixels"}`.  A pixel
// is a hexadecimal digit of coverage; g..z repeat the pixel before 1..20 more times.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <ft2build.h>
#include FT_FREETYPE_H

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

constexpr int sizes[] = {12, 16, 22, 32};

std::string compress(const std::string& pixels) {
  std::string out;
  for (std::size_t i = 0; i < pixels.size();) {
    std::size_t run = 1;
    while (run < 21 && i + run < pixels.size() && pixels[i + run] == pixels[i]) ++run;
    out += pixels[i];
    if (run > 1) out += static_cast<char>('g' + static_cast<int>(run) - 2);
    i += run;
  }
  return out;
}

void print_glyph(FT_Face face, unsigned long code) {
  if (FT_Load_Char(face, code, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT)) std::exit(1);
  const FT_GlyphSlot slot = face->glyph;
  const FT_Bitmap& bitmap = slot->bitmap;
  std::string pixels;
  for (unsigned y = 0; y < bitmap.rows; ++y)
    for (unsigned x = 0; x < bitmap.width; ++x) {
      const int coverage = bitmap.buffer[static_cast<int>(y) * bitmap.pitch + static_cast<int>(x)];
      pixels += "0123456789abcdef"[(coverage * 15 + 127) / 255];
    }
  std::printf("{%lu, %u, %u, %d, %d, %ld, \"%s\"},\n", code, bitmap.width, bitmap.rows,
              slot->bitmap_left, slot->bitmap_top, (slot->advance.x + 32) / 64,
              compress(pixels).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  FT_Library library;
  FT_Face face;
  if (argc != 2 || FT_Init_FreeType(&library) || FT_New_Face(library, argv[1], 0, &face)) {
    std::fprintf(stderr, "usage: make-font-atlas FONT.ttf\n");
    return 1;
  }
  std::printf(
      "// Letters of %s, drawn by build-aux/make-font-atlas.cc: don't edit.\n"
      "// The DejaVu fonts are (c) Bitstream, Inc. and Tavmjong Bah, free under the\n"
      "// Bitstream Vera licence; DejaVu's own changes are in the public domain.\n",
      face->family_name);
  for (const int size : sizes) {
    FT_Set_Pixel_Sizes(face, 0, static_cast<unsigned>(size));
    std::printf("TW_FONT_BEGIN(%d)\n", size);
    for (unsigned long code = 32; code < 127; ++code) print_glyph(face, code);
    for (unsigned long code = 160; code < 256; ++code) print_glyph(face, code);
    std::printf("TW_FONT_END\n");
  }
  return 0;
}
