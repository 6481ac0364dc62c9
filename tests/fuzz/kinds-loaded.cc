// Kinds of scenes with loads: what carries and is struck, what is pressed by far more than weights,
// what begins as it came to rest.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "fuzz/draft.h"
#include "fuzz/kinds.h"
#include "fuzz/ties.h"

namespace tw::fuzz {
namespace {

// Bodies on each other in exact touch, on the ground, of densities of up to so many to one; returns
// the height of the uppermost, m.
double add_column(Draft& draft, int count, double unlike) {
  double level = 0;
  for (int i = 0; i < count; ++i) {
    const double width = draft.size * draft.random.real(0.6, 1),
                 height = draft.size * draft.random.real(0.2, 0.7);
    const bool last = i == count - 1;
    const Solid solid = last && draft.chance(0.3) ? ball(0.5 * height)
                        : draft.chance(0.3)       ? cylinder(0.5 * width, height)
                                                  : box({width, width, height});
    draft.add_moving({solid}, {0, 0, level + 0.5 * height}).density =
        100 * draft.log_uniform(1, unlike);
    level += height;
  }
  return level;
}

}  // namespace

void draw_struck(Draft& draft) {
  const double s = draft.size, half = s * draft.random.real(1.5, 3);
  draft.add_pit(half, 12 * s);
  if (draft.chance(0.4)) add_tree(draft, {-0.5 * half, 0, 2.5 * s}, 0.8 * half);
  const double top = add_column(draft, draft.whole(1, 4), 1e3);
  const auto column = loose(draft.scene);
  for (std::size_t i = 1; i < column.size(); ++i)
    if (draft.chance(0.3)) add_hold(draft, column[i - 1], column[i]);
  const int shots = draft.whole(1, 3);
  for (int i = 0; i < shots; ++i) {
    const bool from_above = draft.chance(0.7);
    const Vec3 at = from_above ? Vec3(draft.random.real(-0.2, 0.2) * s, 0, top + (1 + 1.5 * i) * s)
                               : Vec3(-0.8 * half, 0, (0.5 + 1.2 * i) * s);
    DescribedBody& shot = draft.add_moving(draft.shape(0.7 * s), at);
    shot.pose.q = draft.attitude();
    shot.density = 100 * draft.log_uniform(1, 1e3);
    shot.velocity = (from_above ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitX())) * draft.speed *
                    draft.log_uniform(0.1, 10);
  }
  draft.last(6);
}

void draw_pressed(Draft& draft) {
  const double s = draft.size, half = 2 * s;
  draft.add_pit(half, 8 * s);
  // below the ground: what it pulls at is pressed down, and stays where it is
  const std::size_t anchor = draft.add_fixed(ball(0.1 * s), {0, 0, -2 * s});
  add_column(draft, draft.whole(1, 3), 10);
  const auto column = loose(draft.scene);
  if (column.size() > 1 && draft.chance(0.3)) add_hold(draft, column[0], column[1]);
  const double weight = draft.speed * draft.speed / s * typical_mass(draft);
  DescribedBond pull;
  pull.a = draft.scene.bodies[anchor].name;
  pull.b = column.back();
  pull.spring.stiffness = weight / s * draft.log_uniform(1, 1e6);
  pull.spring.damping =
      std::sqrt(pull.spring.stiffness * typical_mass(draft)) * draft.log_uniform(1e-2, 1);
  pull.spring.rest = 0;
  draft.scene.bonds.push_back(pull);
  if (draft.chance(0.5)) {
    DescribedBody& shot = draft.add_moving(draft.shape(0.7 * s), {0.1 * s, 0, 4 * s});
    shot.pose.q = draft.attitude();
    shot.velocity = {0, 0, -draft.speed * draft.random.real(0, 3)};
  }
  draft.last(6);
}

void draw_rested(Draft& draft) {
  const double half = draft.size * draft.random.real(0.8, 1.6);
  draft.add_pit(half, 8 * draft.size);
  draft.pour(draft.whole(2, 7), half, 0.05 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size * draft.log_uniform(0.4, 0.95)); });
  draft.last(8);
}

}  // namespace tw::fuzz
