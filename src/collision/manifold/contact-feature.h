// What one body shows the other at a contact, that a contact group can follow.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// What follows from each: integrate/arc/group-arc.h.
enum class ContactFeature : unsigned char {
  plane,
  line,
  point,
  crossing,
  rim,
  tangent_plane,
  curved
};

}  // namespace tw
