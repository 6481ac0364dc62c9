// Contacts: which pairs are in contact from a discontinuity on, and at which points.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "groups/group.h"
#include "groups/regroup/regrouping.h"

namespace tw {

// A contact on its way into a group, with what it looks like now (world frame).
struct NewContact {
  GroupContact contact;  // a and b not yet set
  ContactTag tag;
  double gap = 0;               // m
  Vec3 normal = Vec3::UnitZ();  // from the reference body to the other
  Vec3 point = Vec3::Zero();
  std::optional<ContactConstants> law_before;  // none: nothing of it was there
  double share_before = 1;
  bool foreseen = false;  // it is where the one before was followed to (foreseen.h)

  // The gap up to which it presses, but for the law's own depth, m.
  double reach() const { return std::max(contact.offset, 0.0); }
};

// How fast overlaps are pushed apart, m/s.
inline double push_speed(const Scene& scene, double size) {
  return answer::push_share * std::sqrt(scene.gravity_scale() * size);
}
// Whether a contact with that offset holds an overlap that is to be pushed apart.
inline bool pushes(const Scene& scene, double offset) {
  return scene.options.push_overlaps && offset < 0;
}

struct Contacts {
  std::vector<ContactPair> pairs;  // their contacts in a row of `all`
  std::vector<NewContact> all;
  std::uint64_t manifolds = 0;  // that it took to find them
  Told told;                    // who came to touch

  void sort() {
    std::sort(pairs.begin(), pairs.end(),
              [](const ContactPair& x, const ContactPair& y) { return x.id < y.id; });
  }
  // Takes these pairs out.  `gone`: in the order of the pairs.
  void part(const std::vector<std::uint64_t>& gone) {
    auto next = gone.begin();
    std::erase_if(pairs, [&](const ContactPair& pair) {
      const bool parts = next != gone.end() && *next == pair.id;
      next += parts;
      return parts;
    });
  }
  // Once sorted; null: the two are not in contact.
  const ContactPair* find(std::uint64_t pair) const {
    const auto at =
        std::lower_bound(pairs.begin(), pairs.end(), pair,
                         [](const ContactPair& p, std::uint64_t id) { return p.id < id; });
    return at != pairs.end() && at->id == pair ? &*at : nullptr;
  }
  // Whether one of the pair's contacts holds an overlap that is to be pushed apart.
  bool pushes_apart(const Scene& scene, const ContactPair& pair) const {
    bool any = false;
    each_contact(pair, [&](std::uint32_t c) { any = any || pushes(scene, all[c].contact.offset); });
    return any;
  }
};

}  // namespace tw
