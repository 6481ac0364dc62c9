// Building the tree.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/part-tree.h"

namespace tw {

PartTree::PartTree(std::span<const Aabb> boxes) {
  std::vector<std::uint32_t> parts;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty()) parts.push_back(i);
  nodes_.reserve(2 * parts.size());
  nodes_.emplace_back();
  split(0, boxes, parts);
}

void PartTree::split(std::uint32_t node, std::span<const Aabb> boxes,
                     std::span<std::uint32_t> parts) {
  Aabb box, centers;
  for (const std::uint32_t i : parts) {
    box.add(boxes[i]);
    centers.add(boxes[i].center());
  }
  nodes_[node].box = box;
  if (parts.size() == 1) {
    nodes_[node].first = parts[0];
    nodes_[node].is_leaf = true;
    return;
  }
  int axis = 0;
  centers.size().maxCoeff(&axis);
  const std::size_t middle = parts.size() / 2;
  const auto half = parts.begin() + static_cast<std::ptrdiff_t>(middle);
  std::nth_element(parts.begin(), half, parts.end(), [&](std::uint32_t i, std::uint32_t j) {
    const double a = boxes[i].center()[axis], b = boxes[j].center()[axis];
    return a < b || (a == b && i < j);
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(children + 2);
  split(children, boxes, parts.first(middle));
  split(children + 1, boxes, parts.subspan(middle));
}

}  // namespace tw
