// Kinds of scenes with what ties bodies together and what changes them: multibodies, springs,
// holds, callbacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/draft.h"
#include "fuzz/kinds.h"
#include "fuzz/ties.h"

namespace tw::fuzz {

void draw_chains(Draft& draft) {
  const double half = draft.size * draft.random.real(1.2, 2.2);
  draft.add_pit(half, 8 * draft.size);
  const int trees = draft.whole(1, 2);
  for (int i = 0; i < trees; ++i) add_tree(draft, {0, 0, draft.size * (0.8 + 0.9 * i)}, 1.7 * half);
  draft.pour(draft.whole(0, 6), half, 0.05 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size * draft.log_uniform(0.3, 0.9)); });
  draft.last(8);
}

void draw_bonds(Draft& draft) {
  const double half = draft.size * draft.random.real(1.1, 2.2);
  draft.add_pit(half, 8 * draft.size);
  const std::size_t post =
      draft.add_fixed(ball(0.2 * draft.size), {0.8 * half, 0.8 * half, 2 * draft.size});
  draft.pour(draft.whole(2, 9), half, 0.05 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size * draft.log_uniform(0.4, 0.9)); });
  const auto names = loose(draft.scene);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (draft.chance(0.2)) add_spring(draft, draft.scene.bodies[post].name, names[i]);
    if (i == 0 || draft.chance(0.3)) continue;
    if (draft.chance(0.6))
      add_spring(draft, names[i - 1], names[i]);
    else
      add_hold(draft, names[i - 1], names[i]);
  }
  draft.last(8);
}

void draw_called(Draft& draft) {
  const double half = draft.size * draft.random.real(1, 2);
  draft.add_pit(half, 8 * draft.size);
  std::string cart;
  if (draft.chance(0.4)) cart = add_cart(draft, {0, 0, 0.6 * draft.size}, 1.2 * draft.size);
  draft.pour(draft.whole(2, 8), half, 0.05 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size * draft.log_uniform(0.3, 0.9)); });
  auto& callbacks = draft.scene.callbacks;
  const auto names = loose(draft.scene);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (draft.chance(0.4)) callbacks.push_back(callback(draft, Deed::turn, {names[i]}));
    if (i == 0) continue;
    if (draft.chance(0.4))
      callbacks.push_back(callback(draft, Deed::feel, {names[i], names[i - 1]}));
    if (draft.chance(0.3))
      callbacks.push_back(callback(draft, Deed::grip, {names[i - 1], names[i]}));
  }
  if (!cart.empty()) {
    if (draft.chance(0.3)) callbacks.push_back(callback(draft, Deed::grip, {names[0], cart}));
    if (draft.chance(0.5)) {
      callbacks.push_back(callback(draft, Deed::reach, {cart}));
      callbacks.back().torque =
          weight_torque(draft, draft.size, draft.size) * draft.log_uniform(0.01, 0.3);
    }
  }
  draft.last(8);
}

void draw_tools(Draft& draft) {
  const double half = draft.size * draft.random.real(2, 4), size = draft.size;
  draft.add_pit(half, 8 * size);
  const int count = draft.whole(1, 3);
  for (int i = 0; i < count; ++i) {
    const double width = size * draft.random.real(0.4, 0.9),
                 flat = size * draft.log_uniform(0.03, 0.5);
    const Vec3 at((2.0 * i - count + 1) * 0.5 * size, size * draft.random.real(-0.7, 0.7),
                  0.5 * flat);
    switch (draft.random.below(3)) {
      case 0: draft.add_moving({cylinder(0.5 * width, flat)}, at); break;
      case 1: draft.add_moving({box({width, width * draft.random.real(0.3, 1), flat})}, at); break;
      default:
        draft.add_moving({box({width, 0.3 * width, flat}), box({0.3 * width, width, flat})}, at);
    }
  }
  add_tool(draft, {-0.85 * half + 0.5 * size, 0, size * draft.random.real(0.5001, 0.7)},
           size * draft.random.real(0.6, 1), draft.speed * draft.log_uniform(0.1, 1));
  draft.last(8);
}

void draw_sensed(Draft& draft) {
  draw_bonds(draft);
  const double g = draft.speed * draft.speed / draft.size;
  for (const DescribedBond& bond : draft.scene.bonds) {
    draft.scene.callbacks.push_back(callback(draft, Deed::lean, {bond.b, bond.a}));
    draft.scene.callbacks.back().torque = typical_mass(draft) * g * draft.log_uniform(0.01, 0.5);
  }
}

}  // namespace tw::fuzz
