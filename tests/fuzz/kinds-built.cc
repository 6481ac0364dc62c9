// Kinds of scenes that are built: exact touch, stacks, arches and card houses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "fuzz/draft.h"
#include "fuzz/kinds.h"

namespace tw::fuzz {
namespace {

// A block that flies at what was built, at a height, from the side x < 0.
void throw_block(Draft& draft, double distance, double height, double speeds) {
  const double edge = draft.size * draft.random.real(0.3, 0.8);
  DescribedBody& block = draft.add_moving({box(Vec3::Constant(edge))}, {-distance, 0, height});
  block.pose.q = draft.attitude();
  block.velocity = Vec3(speeds * draft.speed, 0, 0);
  block.density = draft.log_uniform(100, 10000);
}

void add_ground(Draft& draft, double reach) {
  if (draft.chance(0.5))
    draft.add_fixed(half_space(Vec3::UnitZ(), 0), Vec3::Zero());
  else
    draft.add_fixed(box(Vec3(200, 200, 2) * reach), {0, 0, -reach});
  draft.scene.room = {std::nullopt, Vec3(-100, -100, 0) * reach, Vec3(100, 100, 100) * reach};
}

}  // namespace

void draw_lattice(Draft& draft) {
  const double s = draft.size;
  const auto style = draft.random.below(4);
  std::vector<Solid> solids;
  Vec3 pitch = Vec3::Constant(s);
  Quat attitude = Quat::Identity();
  switch (style) {
    case 0: solids = {box(Vec3::Constant(s))}; break;
    case 1: solids = {ball(0.5 * s)}; break;
    case 2: solids = {cylinder(0.5 * s, s)}; break;  // upright
    default:                                         // lying, side by side and end to end
      solids = {cylinder(0.5 * s, s)};
      attitude = rotation_by({pi / 2, 0, 0});
  }
  const int nx = draft.whole(2, 8), ny = draft.whole(1, nx > 4 ? 2 : 3);
  const int nz = style == 0 || style == 2 ? draft.whole(1, 2) : 1;
  const bool floats = draft.chance(0.4);
  if (floats) draft.float_freely();
  add_ground(draft, 10 * s);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const Vec3 at = pitch.cwiseProduct(Vec3(i, j, k + 0.5));
        draft.add_moving(solids, at).pose.q = attitude;
      }
  switch (draft.random.below(3)) {
    case 0: break;  // everything rests
    case 1: {       // one of the same hits the row, straight or off the axis
      const double off = draft.chance(0.5) ? 0 : draft.random.real(0, 0.6) * s;
      DescribedBody& hitting = draft.add_moving(solids, {-2.5 * s, off, 0.5 * s});
      hitting.pose.q = attitude;
      hitting.velocity = Vec3(draft.random.real(0.3, 3) * draft.speed, 0, 0);
      break;
    }
    default:  // all move a little
      for (DescribedBody& body : draft.scene.bodies)
        if (body.dynamic()) body.velocity = draft.vector(0.3 * draft.speed);
  }
  draft.last(6);
}

void draw_stack(Draft& draft) {
  const double s = draft.size;
  add_ground(draft, 10 * s);
  const int count = draft.whole(2, 8);
  const double most = draft.log_uniform(1, 1e6), gap = draft.chance(0.5) ? 0 : 1e-5 * s;
  double level = 0;
  for (int i = 0; i < count; ++i) {
    const double width = s * draft.random.real(0.7, 1), height = s * draft.random.real(0.2, 0.6);
    const bool round = draft.chance(0.3);
    const Solid solid =
        round ? cylinder(0.5 * width, height) : box({width, s * draft.random.real(0.7, 1), height});
    level += gap;
    const double aside = 0.1 * s;
    const double x = draft.random.real(-aside, aside), y = draft.random.real(-aside, aside);
    DescribedBody& body = draft.add_moving({solid}, {x, y, level + 0.5 * height});
    body.pose.q = rotation_by({0, 0, draft.random.real(0, 2 * pi)});
    body.density = 100 * draft.log_uniform(1, most);
    level += height;
  }
  if (draft.chance(0.5)) {
    DescribedBody& falling =
        draft.add_moving(draft.shape(0.8 * s), {0.1 * s, 0, level + s * draft.random.real(0.5, 3)});
    falling.pose.q = draft.attitude();
    falling.density = 100 * draft.log_uniform(1, most);
  }
  draft.last(10);
}

// Equal wedges on a semicircle, a hair apart.
void draw_arch(Draft& draft) {
  const double s = draft.size;
  const int stones = draft.whole(4, 13);
  const double inner = 0.5 * s * stones / pi * 2, outer = inner * draft.random.real(1.25, 1.6);
  const double depth = s * draft.random.real(0.3, 1.2), shrink = 1 - 4e-6;
  add_ground(draft, 10 * s);
  for (int i = 0; i < stones; ++i) {
    const double from = pi * i / stones, to = pi * (i + 1) / stones, middle = 0.5 * (from + to);
    const double radius = 0.5 * (inner + outer);
    const Vec3 center(radius * std::cos(middle), 0, radius * std::sin(middle));
    std::vector<Vec3> corners;
    for (const double angle : {from, to})
      for (const double r : {inner, outer})
        for (const double y : {-0.5 * depth, 0.5 * depth}) {
          const Vec3 corner(r * std::cos(angle), y, r * std::sin(angle));
          corners.push_back(shrink * (corner - center));
        }
    draft.add_moving({hull(corners)}, center).density = 2400;
  }
  if (draft.chance(0.7))
    throw_block(draft, outer + 2 * s, std::max(0.75 * s, draft.random.real(0.3, 0.9) * outer),
                draft.log_uniform(0.5, 10));
  draft.last(10);
}

// Two cards that lean on each other.
static void add_tent(Draft& draft, const Vec3& card, double lean, const Vec3& base) {
  const double gap = 2e-5 * card.z();
  for (const double side : {-1.0, 1.0}) {
    const double height = card.z() * std::cos(lean) + card.x() * std::sin(lean);
    const Quat attitude = rotation_by(Vec3(0, -side * lean, 0));
    const Vec3 inner = attitude * Vec3(-side * 0.5 * card.x(), 0, 0.5 * card.z());
    DescribedBody& body =
        draft.add_moving({box(card)}, base + Vec3(side * gap - inner.x(), 0, 0.5 * height + gap));
    body.pose.q = attitude;
  }
}

void draw_cards(Draft& draft) {
  const double s = draft.size, thick = s / draft.log_uniform(15, 300);
  const Vec3 card(thick, 0.7 * s, s);
  const double lean = draft.random.real(0.2, 0.5);
  const double height = card.z() * std::cos(lean) + card.x() * std::sin(lean);
  const double half_base = card.z() * std::sin(lean) + card.x() * std::cos(lean) + 1e-3 * s;
  add_ground(draft, 10 * s);
  add_tent(draft, card, lean, {-half_base, 0, 0});
  add_tent(draft, card, lean, {half_base, 0, 0});
  const double level = height + 5e-5 * s;
  draft.add_moving({box({4 * half_base, 0.7 * s, thick})}, {0, 0, level + 0.5 * thick});
  add_tent(draft, card, lean, {0, 0, level + thick});
  if (draft.chance(0.6)) throw_block(draft, 3 * s, 0.8 * s, draft.log_uniform(0.5, 10));
  draft.last(8);
}

}  // namespace tw::fuzz
