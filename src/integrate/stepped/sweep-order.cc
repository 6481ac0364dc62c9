// The order of contacts in a sweep.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/sweep-order.h"

#include <algorithm>

#include "integrate/stepped/contact-sweeps.h"

namespace tw {

namespace {

std::size_t at(int number) { return static_cast<std::size_t>(number); }

}  // namespace

// Breadth first from whoever touches the ground.
void SweepOrder::find_distances(std::span<const StepContact> contacts, std::size_t members) {
  distance_.assign(members, -1);
  first_.assign(members + 1, 0);
  queue_.clear();
  for (const StepContact& contact : contacts) {
    if (contact.a >= 0) {
      ++first_[at(contact.a)];
      ++first_[at(contact.b)];
    } else if (distance_[at(contact.b)] < 0) {
      distance_[at(contact.b)] = 0;
      queue_.push_back(contact.b);
    }
  }
  int sum = 0;
  for (int& first : first_) first = sum += first;
  neighbours_.resize(at(sum));
  for (const StepContact& contact : contacts) {
    if (contact.a < 0) continue;
    neighbours_[at(--first_[at(contact.a)])] = contact.b;
    neighbours_[at(--first_[at(contact.b)])] = contact.a;
  }
  for (std::size_t head = 0; head < queue_.size(); ++head) {
    const int member = queue_[head];
    for (int i = first_[at(member)]; i < first_[at(member) + 1]; ++i) {
      const int other = neighbours_[at(i)];
      if (distance_[at(other)] >= 0) continue;
      distance_[at(other)] = distance_[at(member)] + 1;
      queue_.push_back(other);
    }
  }
}

// By counting: what is farthest comes first.
void SweepOrder::sort(std::span<const StepContact> contacts) {
  const auto distance = [&](const StepContact& contact) {
    if (contact.a < 0) return 0;
    return std::max(0, distance_[at(contact.a)] + distance_[at(contact.b)] + 1);
  };
  int farthest = 0;
  for (const StepContact& contact : contacts) farthest = std::max(farthest, distance(contact));
  places_.assign(at(farthest) + 1, 0);
  for (const StepContact& contact : contacts) ++places_[at(distance(contact))];
  int before = 0;
  for (std::size_t i = places_.size(); i-- > 0;) {
    const int count = places_[i];
    places_[i] = before;
    before += count;
  }
  order_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i)
    order_[at(places_[at(distance(contacts[i]))]++)] = static_cast<int>(i);
}

void SweepOrder::arrange(std::span<const StepContact> contacts, std::size_t members) {
  find_distances(contacts, members);
  sort(contacts);
  last_.assign(members, -1);
  levels_.resize(contacts.size());
  level_count_ = 0;
  for (const int number : order_) {
    const StepContact& contact = contacts[at(number)];
    int level = last_[at(contact.b)];
    if (contact.a >= 0) level = std::max(level, last_[at(contact.a)]);
    ++level;
    last_[at(contact.b)] = level;
    if (contact.a >= 0) last_[at(contact.a)] = level;
    levels_[at(number)] = level;
    level_count_ = std::max(level_count_, level + 1);
  }
}

}  // namespace tw
