// Looking at two bodies for contacts: whether they are in contact, and at which points.
//
// Whether a pair is in contact is a function of the poses and velocities at the discontinuity, of
// whether it was before, and of the interval until the next check.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "groups/contacts/contacts.h"
#include "groups/contacts/flush-ground.h"
#include "groups/contacts/surroundings.h"

namespace tw {

// What is about a dynamic body: the fixed bodies, and the planes of the ground that it stands on,
// once one that is not dynamic is met.
struct Footing {
  NearGround ground;
  std::optional<std::vector<StandingPlane>> planes = std::nullopt;

  void meet(const Regrouping& work, const Body& mover, const Body& other);
};

// Two bodies that are to be looked at, the one with the lesser id first.
struct PairToLook {
  const PlacedBody *a, *b;
  const Footing* footing = nullptr;  // of the one that moves
};

// Which pairs are to be in contact.
enum class LookFor : std::uint8_t {
  always,     // it comes to touch now
  new_touch,  // where it touches or may touch before the next check; what holds it does so at once
  touching,   // the same of one that may have been in contact before
};

// What was found: a pair with its contacts from 0 on.
struct Look {
  enum class Found : std::uint8_t { nothing, contact, as_before } found = Found::nothing;
  ContactPair pair;
  std::vector<NewContact> contacts;
  std::uint64_t manifolds = 0;
};

// `interval`: until the next check, s.
Look look_at(const Regrouping& work, const PairToLook& two, double interval, LookFor what);

}  // namespace tw
