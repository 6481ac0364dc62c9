// What a new contact has of an old one: its friction stretch, its bend, and the depth that it
// counts from.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/contacts/contacts.h"

namespace tw {

// The stretch of an old contact in the tangent plane of a new one, as long as before.
Vec3 turned_into(const Vec3& stretch, const Vec3& normal);

// The offset with which an overlap presses nothing: a hair more than it is deep, or steps would see
// a spring that begins where they do.
inline double unpressed(double gap, double size) { return gap - answer::start_depth * size; }

// A contact that is found deeper than a load would press it, and than the two were in contact with
// anything before, presses from there on: a spring that is born so deep would throw them apart.
void start_unpressed(const Regrouping& work, const Body& a, const Body& b, NewContact& c);

// Of a body that comes to another piece of the ground a contact presses as the nearest one that
// stands there with the same normal: it counts from the same depth.
void take_ground_offset(const Regrouping& work, const Body& a, const Body& b, NewContact& fresh);

// Each new contact takes the stretch and the offset of the nearest old one; equal features count as
// half as far.
void match_old(const Regrouping& work, std::vector<NewContact>& contacts, const ContactPair& pair,
               const PairBefore& before_it);

}  // namespace tw
