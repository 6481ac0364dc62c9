// What ties bodies together and what changes them, as forms of a scene.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "fuzz/described-scene.h"

namespace tw::fuzz {

// Of a body that counts.
inline const char* const slots_text = " #:slots '((count . 0))";

std::string text(const Vec3& v);
std::string text(const Quat& q);
std::string shape_text(const DescribedBody& body);

// The multibody whose first link is number `first`, which becomes the number of what follows it.
std::string multibody_text(const DescribedScene& scene, std::size_t& first);
std::string bonds_text(const DescribedScene& scene);
std::string forces_text(const DescribedScene& scene);
std::string servos_text(const DescribedScene& scene);
std::string callbacks_text(const DescribedScene& scene);

}  // namespace tw::fuzz
