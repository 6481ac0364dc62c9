// A tree of boxes over the parts of a shape that has many: which of them come near a box, and in
// which order of nearness.
//
// Boxes are split at the median of their centres along the axis where these spread most.
//
// Cost: 128 bytes a part; a query visits some twenty boxes and what it finds.
// Frames: the shape's own, metres.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "math/aabb.h"

namespace tw {

class PartTree {
 public:
  struct Node {
    Aabb box;  // of a leaf that of its part
    // of a leaf the number of its part; else its children are node(first) and node(first + 1)
    std::uint32_t first = 0;
    bool is_leaf = false;
  };

  // One finite box for each part; an empty box is of a part that does not exist.  Not all are
  // empty.
  explicit PartTree(std::span<const Aabb> boxes);

  const Node& root() const { return nodes_.front(); }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }

  // Calls visit(number) for all parts whose boxes overlap `box`, in no order.
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    visit_from(root(), box, visit);
  }

 private:
  template <class Visit>
  void visit_from(const Node& node, const Aabb& box, Visit& visit) const {
    if (!node.box.overlaps(box)) return;
    if (node.is_leaf) return static_cast<void>(visit(node.first));
    visit_from(nodes_[node.first], box, visit);
    visit_from(nodes_[node.first + 1], box, visit);
  }
  // Makes the node over these parts.
  void split(std::uint32_t node, std::span<const Aabb> boxes, std::span<std::uint32_t> parts);

  std::vector<Node> nodes_;
};

}  // namespace tw
