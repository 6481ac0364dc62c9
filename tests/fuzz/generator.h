// Random scenes, each a function of its kind and seed alone.
//
// What a scene is about is drawn without dimension: speeds in sqrt(g size), spins in sqrt(g/size),
// durations in sqrt(size/g); the size itself is anything from a tenth of a millimetre to a
// kilometre.  Bodies begin apart, or in exact touch where the kind is about touch.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "fuzz/described-scene.h"

namespace tw::fuzz {

struct Kind {
  const char* name;
  const char* what;
  void (*draw)(class Draft&);
  bool settles = false;  // it begins as it stands when it has lasted once
};

std::span<const Kind> kinds();

// Errors: UserError for a kind that there isn't.
DescribedScene random_scene(const std::string& kind, std::uint64_t seed);

// Seeds of a run over all kinds take them in turn.
std::string kind_of_seed(std::uint64_t seed);

}  // namespace tw::fuzz
