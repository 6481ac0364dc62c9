// Contacts drawn over the finished picture: a short line along the normal of each.
//
// Contacts lie between bodies, where nothing of them would be seen; so the lines are drawn over
// what hides them, and fade with the depth at which they lie behind it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "render/blend.h"
#include "render/draw-list.h"
#include "render/image.h"
#include "render/view.h"

namespace tw {

inline constexpr Ink sticking_ink{84, 226, 255}, slipping_ink{255, 84, 164};

// The depth of what is seen, rows from the bottom: near_distance over the distance along the view;
// 0 is the sky.  May have several samples a pixel each way.
struct DepthPicture {
  int width = 0, height = 0;
  std::vector<float> depth;
};

// Contacts up to `fade` (m) behind what is seen are drawn fully, from twice that on faintly.
// Contacts that reach behind the eye or are not finite are left out.
void draw_contacts(Image& image, std::span<const DrawContact> contacts, const View& view,
                   const DepthPicture& seen, double fade);

}  // namespace tw
