// In which order the contacts of a step are solved, and which of them side by side.
//
// Those farthest from the ground come first: contacts between the ground and a member are at
// distance 0, and one between two members at the sum of their distances, counted by members on the
// shortest way down, and 1.  So a sweep hands the weight of a pile down through all of it, where
// another order would take as many sweeps as it is high: piles stand still with few.  At one
// distance the order is that of the contacts.
//
// A contact's level is one more than the highest of those before it that share a member with it.
// What is of one level shares none: solved level by level, side by side in each, impulses are those
// of one contact after the other, bit for bit.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tw {

struct StepContact;

class SweepOrder {
 public:
  void arrange(std::span<const StepContact> contacts, std::size_t members);
  // Numbers of contacts, in their order, and of each its level.
  const std::vector<int>& order() const { return order_; }
  const std::vector<int>& levels() const { return levels_; }
  int level_count() const { return level_count_; }

 private:
  void find_distances(std::span<const StepContact> contacts, std::size_t members);
  void sort(std::span<const StepContact> contacts);

  std::vector<int> order_, levels_;
  int level_count_ = 0;
  std::vector<int> distance_;  // of each member from the ground; -1: no way leads down
  // scratch: neighbours of members in rows; a queue; where the contacts of a distance go; of each
  // member the last level that it has a contact in
  std::vector<int> first_, neighbours_, queue_, places_, last_;
};

}  // namespace tw
