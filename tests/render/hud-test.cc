// The time stands in the picture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/hud.h"

#include "picture-tools.h"
#include "render/font.h"

namespace tw::test {
namespace {

Image grey(int width, int height) {
  Image image{width, height, {}};
  image.rgb.assign(static_cast<std::size_t>(3 * width * height), 128);
  return image;
}

Image with_time(double time) {
  Image image = grey(320, 240);
  draw_hud(image, {time, {}, "", 0});
  return image;
}

TEST(Hud, its_pixels_change_with_the_time_only) {
  EXPECT_NE(hash_of(with_time(1.25)), hash_of(with_time(1.5)));
  EXPECT_EQ(hash_of(with_time(1.25)), hash_of(with_time(1.25)));
  EXPECT_EQ(time_text(1.25), "t = 1.250 s");
}

TEST(Hud, the_panel_is_at_the_upper_left_and_holds_white_letters) {
  const Image image = with_time(3);
  bool white = false;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 120; ++x) white |= brightness(image, x, y) > 700;
  EXPECT_TRUE(white);
  EXPECT_EQ(brightness(image, 319, 239), 3 * 128);
}

TEST(Hud, lines_a_footer_and_a_scale_bar_appear) {
  Image image = grey(320, 240);
  draw_hud(image, {3, {"300 rocks", "caf\xc3\xa9"}, "title", 20});
  EXPECT_NE(hash_of(image), hash_of(with_time(3)));
  // the bar is 2 m = 40 pixels long: the greatest of 1, 2, 5 ... in a seventh of the width
  int bar = 0;
  for (int x = 0; x < 160; ++x) bar += brightness(image, x, 240 - 9 - 1) > 600;
  EXPECT_EQ(bar, 40);
}

TEST(Hud, a_line_has_its_own_colour) {
  Image image = grey(320, 240);
  draw_hud(image, {3, {HudLine("slipping", {255, 0, 0})}, "", 0});
  bool red_letters = false;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 160; ++x) red_letters |= red(image, x, y) > 100 + green(image, x, y);
  EXPECT_TRUE(red_letters);
}

TEST(Hud, what_does_not_fit_is_cut_off) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(20, 60), std::pair(600, 48)}) {
    Image image = grey(width, height);
    draw_hud(image, {1e300, {std::string(1000, 'x')}, std::string(1000, 'y'), 1e-3});
    EXPECT_EQ(image.rgb.size(), static_cast<std::size_t>(3 * width * height));
  }
}

TEST(Font, every_size_has_every_letter) {
  for (const int size : {12, 16, 22, 32}) {
    const Font& font = Font::nearest(size);
    EXPECT_EQ(font.size(), size);
    for (char32_t c = 33; c < 256; ++c) {
      const Glyph& glyph = font.glyph(c);
      EXPECT_EQ(glyph.coverage.size(), static_cast<std::size_t>(glyph.width * glyph.height));
      EXPECT_GT(glyph.advance, 0);
    }
  }
}

TEST(Font, utf8_is_decoded_and_errors_become_question_marks) {
  EXPECT_EQ(decode_utf8("a\xc3\xa9\xe2\x82\xac"), U"a\u00e9\u20ac");
  EXPECT_EQ(decode_utf8("\xff!\xc3"), U"?!?");
  const Font& font = Font::nearest(16);
  EXPECT_EQ(&font.glyph(U'\u20ac'), &font.glyph(U'?'));
}

}  // namespace
}  // namespace tw::test
