// Building the tree.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/part-tree.h"

namespace tw {

namespace {

constexpr std::uint32_t most_in_leaf = 2;

}  // namespace

PartTree::PartTree(std::span<const Aabb> boxes) {
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty()) numbers_.push_back(i);
  nodes_.reserve(numbers_.size());
  nodes_.emplace_back();
  split(0, boxes, 0, static_cast<std::uint32_t>(numbers_.size()));
}

void PartTree::split(std::uint32_t node, std::span<const Aabb> boxes, std::uint32_t from,
                     std::uint32_t to) {
  Aabb box, centers;
  for (std::uint32_t i = from; i < to; ++i) {
    box.add(boxes[numbers_[i]]);
    centers.add(boxes[numbers_[i]].center());
  }
  nodes_[node].box = box;
  const auto at = [&](std::uint32_t i) { return numbers_.begin() + i; };
  if (to - from <= most_in_leaf) {
    nodes_[node].first = from;
    nodes_[node].count = to - from;
    std::sort(at(from), at(to));
    return;
  }
  int axis = 0;
  centers.size().maxCoeff(&axis);
  const std::uint32_t middle = from + (to - from) / 2;
  std::nth_element(at(from), at(middle), at(to), [&](std::uint32_t i, std::uint32_t j) {
    const double a = boxes[i].center()[axis], b = boxes[j].center()[axis];
    return a < b || (a == b && i < j);
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(children + 2);
  split(children, boxes, from, middle);
  split(children + 1, boxes, middle, to);
}

}  // namespace tw
