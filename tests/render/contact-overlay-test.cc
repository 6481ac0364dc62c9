// Contacts are drawn where they are, in the colour of what they do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/contact-overlay.h"

#include <cmath>
#include <limits>

#include "picture-tools.h"

namespace tw::test {
namespace {

DrawContact contact_at(const Vec3& point, bool slipping = false) {
  return {point, Vec3::UnitZ(), 0.4, slipping};
}

Image picture_with(const std::vector<DrawContact>& contacts, Quality quality = Quality::draft) {
  DrawFrame frame = frame_at(0);
  frame.contacts = contacts;
  return Renderer(small_settings(quality), ball_over_ground()).draw(frame);
}

// The pixels that differ from the picture without contacts, and by how much.
struct Traces {
  int pixels = 0, change = 0;
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
};

Traces traces_of(const Image& image, const Image& bare) {
  Traces traces;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int change = 0;
      for (int i = 0; i < 3; ++i) change += std::abs(image.pixel(x, y)[i] - bare.pixel(x, y)[i]);
      if (change == 0) continue;
      ++traces.pixels;
      traces.change += change;
      traces.left = std::min(traces.left, x + 0.5);
      traces.right = std::max(traces.right, x + 0.5);
      traces.top = std::min(traces.top, y + 0.5);
      traces.bottom = std::max(traces.bottom, y + 0.5);
    }
  return traces;
}

View view_of_scene() {
  Renderer renderer(small_settings(), ball_over_ground());
  renderer.draw(frame_at(0));
  return renderer.view();
}

TEST(ContactOverlay, a_line_lies_along_the_normal_about_its_point) {
  TW_SKIP_WITHOUT_OPENGL();
  const Image bare = picture_with({});
  const Traces traces = traces_of(picture_with({contact_at({1, 0, 0.6})}), bare);
  const View view = view_of_scene();
  const auto top = view.project({1, 0, 0.8}), bottom = view.project({1, 0, 0.4});
  ASSERT_TRUE(top && bottom);
  // its width and outline reach two pixels farther
  EXPECT_NEAR(traces.top, top->y(), 3);
  EXPECT_NEAR(traces.bottom, bottom->y(), 3);
  EXPECT_NEAR(0.5 * (traces.left + traces.right), top->x(), 1.5);
  EXPECT_LT(traces.right - traces.left, 7);
}

TEST(ContactOverlay, colours_tell_slipping_from_sticking) {
  TW_SKIP_WITHOUT_OPENGL();
  const auto at = view_of_scene().project({1, 0, 0.6});
  ASSERT_TRUE(at);
  const int x = static_cast<int>(at->x()), y = static_cast<int>(at->y());
  const Image sticks = picture_with({contact_at({1, 0, 0.6})});
  const Image slips = picture_with({contact_at({1, 0, 0.6}, true)});
  EXPECT_GT(green(sticks, x, y), red(sticks, x, y) + 40);
  EXPECT_GT(red(slips, x, y), green(slips, x, y) + 40);
}

TEST(ContactOverlay, what_bodies_hide_shows_through_faintly_at_every_quality) {
  TW_SKIP_WITHOUT_OPENGL();
  for (const Quality quality : {Quality::draft, Quality::normal, Quality::best}) {
    const Image bare = picture_with({}, quality);
    const View view = view_of_scene();
    // on one ray of sight: in front of the ball, and far behind it
    const Vec3 to_ball = Vec3(0, 0, 1.5) - view.eye;
    DrawContact near = contact_at(view.eye + 0.8 * to_ball);
    DrawContact far = contact_at(view.eye + 1.6 * to_ball);
    far.length = 2 * near.length;
    const Traces in_front = traces_of(picture_with({near}, quality), bare);
    const Traces behind = traces_of(picture_with({far}, quality), bare);
    EXPECT_GT(behind.pixels, 10);
    EXPECT_LT(behind.change, 0.5 * in_front.change);
  }
}

TEST(ContactOverlay, what_cannot_be_seen_changes_nothing) {
  TW_SKIP_WITHOUT_OPENGL();
  const Image bare = picture_with({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // behind the eye, beside the picture, nowhere
  const Image image = picture_with({contact_at({0, -9, 3}), contact_at({400, 0, 0}),
                                    contact_at({0, 0, -1e300}), contact_at({nan, 0, 0})});
  EXPECT_EQ(hash_of(image), hash_of(bare));
}

TEST(ContactOverlay, the_nearer_of_two_lines_is_on_top_in_whatever_order_they_come) {
  TW_SKIP_WITHOUT_OPENGL();
  const DrawContact near = contact_at({0.9, -1, 0.6}), far = contact_at({1, 0, 0.6}, true);
  EXPECT_EQ(hash_of(picture_with({near, far})), hash_of(picture_with({far, near})));
  EXPECT_NE(hash_of(picture_with({near})), hash_of(picture_with({near, far})));
}

}  // namespace
}  // namespace tw::test
