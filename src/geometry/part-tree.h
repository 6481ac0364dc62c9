// A tree of boxes over the parts of a shape that has many: which of them come near a box, and in
// which order of nearness.
//
// Boxes are split at the median of their centres along the axis where these spread most.
//
// Cost: 32 to 64 bytes a part; a query visits some twenty boxes and what it finds.
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
    Aabb box;
    // of a leaf: its parts are numbers()[first], numbers()[first + 1] ..; else its children are
    // nodes()[first] and nodes()[first + 1]
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: not a leaf
  };

  // One finite box for each part; an empty box is of a part that does not exist.  Not all are
  // empty.
  explicit PartTree(std::span<const Aabb> boxes);

  const Node& root() const { return nodes_.front(); }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  // The parts of a leaf, ascending.
  std::span<const std::uint32_t> parts(const Node& leaf) const {
    return {numbers_.data() + leaf.first, leaf.count};
  }

  // Calls visit(number) for all parts of those leaves whose boxes overlap `box`, in no order.
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    visit_from(root(), box, visit);
  }

 private:
  template <class Visit>
  void visit_from(const Node& node, const Aabb& box, Visit& visit) const {
    if (!node.box.overlaps(box)) return;
    if (node.count == 0) {
      visit_from(nodes_[node.first], box, visit);
      visit_from(nodes_[node.first + 1], box, visit);
      return;
    }
    for (const std::uint32_t number : parts(node)) visit(number);
  }
  void split(std::uint32_t node, std::span<const Aabb> boxes, std::uint32_t from, std::uint32_t to);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace tw
