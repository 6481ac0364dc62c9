// What ties bodies together while a scene is drawn: multibodies, springs, holds, callbacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "fuzz/draft.h"

namespace tw::fuzz {

// Of the weight of a beam about its end, N m.
double weight_torque(const Draft& draft, double length, double width);
// Of a typical body of a heap, kg.
double typical_mass(const Draft& draft);

// Return its first link.
std::string add_cart(Draft& draft, const Vec3& middle, double length);
// What is dragged along x over the ground, from `start` on, at about this speed (m/s): it hangs on
// two links without a shape that slide along x and z.
void add_tool(Draft& draft, const Vec3& start, double size, double speed);
// A star, a cart or a chain.
void add_tree(Draft& draft, const Vec3& middle, double reach);
void add_spring(Draft& draft, const std::string& a, const std::string& b);
void add_hold(Draft& draft, const std::string& a, const std::string& b);

// Loose bodies by name, without links.
std::vector<std::string> loose(const DescribedScene& scene);
// With a period and a start; its strength is to be said.
DescribedCallback callback(Draft& draft, Deed deed, std::vector<std::string> targets);

}  // namespace tw::fuzz
