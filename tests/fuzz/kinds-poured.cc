// Kinds of scenes in which loose bodies fall, spin, roll or are shaken in a container.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "fuzz/draft.h"
#include "fuzz/kinds.h"

namespace tw::fuzz {
namespace {

// A box-shaped room of one body: six slabs, `inner` wide inside.
std::vector<Solid> hollow_box(const Vec3& inner, double thick) {
  std::vector<Solid> slabs;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 edges = inner + Vec3::Constant(2 * thick), at = Vec3::Zero();
      edges[axis] = thick;
      at[axis] = side * 0.5 * (inner[axis] + thick);
      slabs.push_back(placed(box(edges), at));
    }
  return slabs;
}

// Keyframes of a turn about y at a constant rate, rad/s.
std::vector<Keyframe> turning(const Vec3& position, double rate, double duration) {
  std::vector<Keyframe> frames;
  const double quarter = 0.5 * pi / std::abs(rate);
  for (int k = 0; k == 0 || (k - 1) * quarter < duration; ++k)
    frames.push_back(
        {k * quarter, position, rotation_by(Vec3(0, std::copysign(k * pi / 2, rate), 0))});
  return frames;
}

}  // namespace

void draw_heap(Draft& draft) {
  const double half = draft.size * draft.random.real(0.8, 2);
  const int count = draft.whole(4, 16);
  draft.add_pit(half, 20 * draft.size);
  draft.pour(count, half, 0.1 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size * draft.log_uniform(0.3, 1)); });
  draft.last(12);
}

void draw_round(Draft& draft) {
  const double half = draft.size * draft.random.real(0.8, 2);
  const int count = draft.whole(3, 14);
  draft.add_pit(half, 20 * draft.size);
  draft.pour(count, half, 0.1 * draft.size, 1.02 * draft.size, [&] {
    const double size = draft.size * draft.log_uniform(0.3, 1);
    return draft.chance(0.3) ? draft.shape(size) : std::vector<Solid>{draft.round_shape(size)};
  });
  draft.last(10);
}

// Mostly friction enough to roll; either length may be none, or far beyond what the width allows.
void draw_rolls(Draft& draft) {
  draw_round(draft);
  if (draft.chance(0.7)) draft.scene.friction = draft.random.real(0.3, 1.2);
  if (draft.chance(0.8)) draft.scene.rolling = draft.size * draft.log_uniform(1e-4, 1);
  if (draft.chance(0.8)) draft.scene.spinning = draft.size * draft.log_uniform(1e-4, 1);
}

// In the pit lies one that is fixed; a ball comes down on it, a hair beside the circle where its
// parts meet.
void draw_flush(Draft& draft) {
  const double half = draft.size * draft.random.real(0.8, 1.5), thin = 0.15 * draft.size;
  const int count = draft.whole(1, 5);
  draft.add_pit(half, 20 * draft.size);
  double seam;
  DescribedBody rail;
  rail.solids = draft.flush_rod(thin, draft.size, seam);
  rail.pose = Pose{{0, 0, 0.6 * draft.size}, rotation_by({0, pi / 2, 0})};
  rail.fixed = true;
  draft.add(rail, "rail");
  const double radius = thin * draft.log_uniform(0.3, 2), drop = thin * draft.log_uniform(1e-3, 3);
  const double beside = thin * draft.log_uniform(1e-5, 1e-2) * (draft.chance(0.5) ? 1 : -1);
  draft.add_moving({ball(radius)}, rail.pose.p + Vec3(seam + beside, 0, thin + radius + drop));
  draft.pour(count, half, 2 * draft.size, 1.02 * draft.size, [&] {
    const double size = draft.size * draft.log_uniform(0.3, 1);
    return draft.chance(0.3) ? draft.shape(size) : draft.flush_shape(size);
  });
  draft.last(10);
}

void draw_thin(Draft& draft) {
  const double half = draft.size * draft.random.real(0.8, 1.6);
  const int count = draft.whole(2, 6);
  draft.add_pit(half, 8 * draft.size);
  draft.pour(count, half, 0.1 * draft.size, 1.02 * draft.size,
             [&] { return std::vector<Solid>{draft.thin_shape(draft.size)}; });
  draft.last(8);
}

void draw_spin(Draft& draft) {
  const double half = draft.size * draft.random.real(1, 2);
  const int count = draft.whole(1, 5);
  draft.add_pit(half, 8 * draft.size);
  draft.pour(count, half, 0.05 * draft.size, 1.02 * draft.size,
             [&] { return draft.shape(draft.size); });
  // 1000 rad/s at a tenth of a metre
  for (DescribedBody& body : draft.scene.bodies)
    if (body.dynamic()) body.spin = draft.direction() * draft.log_uniform(1, 100) / draft.time;
  draft.last(6);
}

// The lid comes down to where the bodies' cells, one layer more than they need, still have room.
void draw_piston(Draft& draft) {
  const double half = draft.size * draft.random.real(1.1, 2), cell = 1.02 * draft.size;
  const int across = static_cast<int>(2 * half / cell);
  const int count = draft.whole(1, std::min(14, 3 * across * across));
  const double layers = std::ceil(static_cast<double>(count) / (across * across));
  const double top = (layers + 1) * cell;
  const double low = 0.85 * cell * (1 + static_cast<double>(count) / (across * across));
  draft.add_pit(half, 3 * top);
  draft.pour(count, half, 0.02 * draft.size, cell,
             [&] { return draft.shape(draft.size * draft.random.real(0.4, 0.9)); });
  DescribedBody lid;
  const double gap = 1e-3 * draft.size;
  lid.solids = {box({2 * (half - gap), 2 * (half - gap), draft.size})};
  const double stroke = draft.time * draft.log_uniform(2, 10);
  const double z_top = top + draft.size, z_low = std::min(low, top) + 0.5 * draft.size;
  for (int k = 0; k < 5; ++k)
    lid.keyframes.push_back({(k + 0.2) * stroke, {0, 0, k % 2 ? z_low : z_top}, std::nullopt});
  lid.smooth = draft.chance(0.7);
  draft.add(lid, "lid");
  draft.scene.room.hi.z() = z_top - 0.5 * draft.size;
  draft.scene.duration = std::min(4 * stroke, 20 * draft.time);
}

void draw_drum(Draft& draft) {
  const double radius = draft.size * draft.random.real(1.6, 3), length = 2.2 * draft.size;
  const int staves = draft.whole(6, 10);
  const double thick = radius * draft.random.real(0.05, 0.3), turn = 2 * pi / staves;
  DescribedBody drum;
  for (int k = 0; k < staves; ++k) {
    const Quat q = rotation_by(Vec3(0, k * turn, 0));
    const double width = 2 * (radius + thick) * std::tan(0.5 * turn);
    drum.solids.push_back(
        placed(box({width, length, thick}), q * Vec3(0, 0, radius + 0.5 * thick), q));
  }
  const double rate = draft.log_uniform(0.1, 1.5) / draft.time * (draft.chance(0.5) ? 1 : -1);
  draft.last(draft.random.real(3, 7));
  drum.keyframes = turning({0, 0, 2 * radius}, rate, draft.scene.duration);
  const std::size_t id = draft.add(drum, "drum");
  for (const double side : {-1.0, 1.0})
    draft.add_fixed(half_space({0, -side, 0}, -0.5 * length), Vec3::Zero());
  const double inner = radius / std::cos(0.5 * turn);
  draft.scene.room = {id, {-inner, -0.5 * length, -inner}, {inner, 0.5 * length, inner}};
  const double cell = draft.size, half = 0.6 * radius;
  const int across = std::max(1, static_cast<int>(2 * half / cell));
  const int count = draft.whole(2, 2 + across * across);
  for (int k = 0; k < count; ++k) {
    const Vec3 at(cell * (k % across - 0.5 * (across - 1)), (k / across % 2 - 0.5) * 1.05 * cell,
                  2 * radius + cell * (k / (2 * across) - 0.5 * (across - 1)));
    DescribedBody& body = draft.add_moving(draft.shape(0.9 * draft.size), at);
    draft.toss(body, 0.1);
  }
}

void draw_shaker(Draft& draft) {
  const double s = draft.size;
  const Vec3 inner = s * Vec3(draft.whole(2, 4), draft.whole(2, 4), draft.whole(2, 4));
  DescribedBody room;
  room.solids = hollow_box(inner, s * draft.random.real(0.05, 0.5));
  if (draft.chance(0.3)) draft.float_freely();
  draft.last(draft.random.real(5, 9));
  room.smooth = draft.chance(0.6);
  const double swing = draft.random.real(0.2, 2) * s, turn = draft.random.real(0, 1.5);
  double when = 0;
  for (int k = 0; k < 12 && (k == 0 || when < draft.scene.duration); ++k) {
    const Vec3 at = draft.vector(swing), turned = draft.vector(turn);
    if (k == 0)
      room.keyframes.push_back({0, Vec3::Zero(), Quat::Identity()});
    else
      room.keyframes.push_back({when, at, rotation_by(turned)});
    when += draft.time * draft.random.real(1, 4);
  }
  const std::size_t id = draft.add(room, "room");
  draft.scene.room = {id, -0.5 * inner, 0.5 * inner};
  const int nx = static_cast<int>(inner.x() / s + 0.5), ny = static_cast<int>(inner.y() / s + 0.5);
  const int nz = static_cast<int>(inner.z() / s + 0.5);
  const int count = draft.whole(1, std::min(12, nx * ny * nz));
  for (int k = 0; k < count; ++k) {
    const Vec3 cell(k % nx, k / nx % ny, k / (nx * ny));
    const Vec3 at = s * (cell + Vec3::Constant(0.5)) - 0.5 * inner;
    draft.toss(draft.add_moving(draft.shape(0.95 * s), at), 0.2);
  }
}

}  // namespace tw::fuzz
