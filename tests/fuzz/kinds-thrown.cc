// Kinds of scenes in which bodies are thrown at walls, seams, grooves and ramps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "fuzz/draft.h"
#include "fuzz/kinds.h"

namespace tw::fuzz {

void draw_bullet(Draft& draft) {
  const double s = draft.size, width = 10 * s, thick = width * draft.random.real(0.01, 0.03);
  if (draft.chance(0.5)) draft.float_freely();
  // some rooms turn their walls' edges to the axes' corners
  const Quat turned = draft.chance(0.5) ? draft.attitude() : Quat(1, 0, 0, 0);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 edges = Vec3::Constant(width + 2 * thick), at = Vec3::Zero();
      edges[axis] = thick;
      at[axis] = side * 0.5 * (width + thick);
      draft.add_fixed(box(edges), turned * at, turned);
    }
  draft.scene.room = {std::size_t{0}, Vec3::Zero(), Vec3::Zero()};
  // in the frame of the first wall, which stands at -x
  draft.scene.room.lo = Vec3(0.5 * thick, -0.5 * width, -0.5 * width);
  draft.scene.room.hi = Vec3(width + 0.5 * thick, 0.5 * width, 0.5 * width);
  const double speed = draft.log_uniform(3, 300) * draft.speed;
  const int count = draft.whole(1, 4);
  for (int k = 0; k < count; ++k) {
    const Vec3 at((k % 2 - 0.5) * 3 * s, (k / 2 - 0.5) * 3 * s, draft.random.real(-3, 3) * s);
    const double diameter = s * draft.log_uniform(0.05, 1);
    DescribedBody& body = draft.add_moving(
        draft.chance(0.3) ? std::vector<Solid>{draft.thin_shape(s)} : draft.shape(diameter), at);
    draft.toss(body, 0);
    body.velocity = draft.direction() * speed;
    body.spin = draft.vector(3) * (draft.chance(0.3) ? speed / s : 1 / draft.time);
  }
  // a dozen crossings
  draft.scene.time_unit = draft.time = std::min(draft.time, width / speed);
  draft.last(12);
}

// What slides over tiles or falls on them: anything, with some speed along them.
static void throw_over(Draft& draft, int count, double reach, double level, double speeds) {
  const double s = draft.size;
  for (int k = 0; k < count; ++k) {
    const double x = draft.random.real(-0.3, 0.3) * reach;
    const Vec3 at(x, (k % 3 - 1) * 1.1 * s, level + (0.6 + 1.1 * (k / 3)) * s);
    DescribedBody& body = draft.add_moving(draft.shape(s), at);
    if (draft.chance(0.6)) body.pose.q = draft.attitude();
    body.velocity = draft.vector(0.2 * draft.speed);
    body.velocity.x() += speeds * draft.speed * draft.random.real(-1, 1);
  }
}

void draw_seam(Draft& draft) {
  const double s = draft.size, tile = s * draft.log_uniform(0.3, 2),
               thick = draft.chance(0.5) ? 0.1 * tile : tile;
  const int across = 8;
  const double reach = 0.5 * across * tile;
  DescribedBody joined;
  joined.fixed = true;
  const bool one_body = draft.chance(0.5);
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const Vec3 at(tile * (i + 0.5) - reach, tile * (j + 0.5) - reach, -0.5 * thick);
      const Solid solid = box({tile, tile, thick});
      if (one_body)
        joined.solids.push_back(placed(solid, at));
      else
        draft.add_fixed(solid, at);
    }
  if (one_body) draft.add(joined, "tiles");
  // nobody leaves the tiles
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0})
      draft.add_fixed(half_space(side * Vec3::Unit(axis), -std::max(reach, 2.2 * s)), Vec3::Zero());
  const double edge = std::max(reach, 2.2 * s);
  draft.scene.room = {
      std::nullopt, {-edge, -edge, reach < edge ? -1e6 * s : 0}, {edge, edge, 1e3 * s}};
  throw_over(draft, draft.whole(1, 6), reach, 0, 2);
  draft.last(8);
}

// Two wedges, one union or two bodies, whose common edge is the bottom of a V.
void draw_groove(Draft& draft) {
  const double s = draft.size, angle = draft.random.real(0.1, 1.2), length = 4 * s;
  const double wide = 3 * s, high = wide * std::tan(angle), deep = 0.5 * s;
  std::vector<Solid> wedges;
  for (const double side : {-1.0, 1.0}) {
    std::vector<Vec3> corners;
    for (const double y : {-length, length})
      for (const auto& [x, z] :
           {std::pair{0.0, 0.0}, {0.0, -deep}, {side * wide, -deep}, {side * wide, high}})
        corners.push_back({x, y, z});
    wedges.push_back(hull(corners));
  }
  if (draft.chance(0.6)) {
    DescribedBody joined;
    joined.fixed = true;
    joined.solids = wedges;
    draft.add(joined, "groove");
  } else {
    for (const Solid& wedge : wedges) draft.add_fixed(wedge, Vec3::Zero());
  }
  for (const double side : {-1.0, 1.0}) {
    draft.add_fixed(half_space({-side, 0, 0}, -wide), Vec3::Zero());
    draft.add_fixed(half_space({0, -side, 0}, -length), Vec3::Zero());
  }
  draft.scene.room = {std::nullopt, {-wide, -length, 0}, {wide, length, 1e3 * s}};
  const int count = draft.whole(1, 4);
  for (int k = 0; k < count; ++k) {
    // a spike there clears both slopes
    const double clear = (0.75 + 0.35 * std::sin(angle)) / std::cos(angle) * s;
    const Vec3 at(draft.random.real(-0.3, 0.3) * s, (k % 3 - 1) * 1.2 * s,
                  clear + 1.2 * (k / 3) * s + (draft.chance(0.5) ? 0 : high));
    if (draft.chance(0.4)) {
      // a spike, its tip down, that may stand in the bottom edge
      const double b = 0.25 * s;
      const Solid spike = hull({{b, -b, 0.2 * s},
                                {b, b, 0.2 * s},
                                {-b, b, 0.2 * s},
                                {-b, -b, 0.2 * s},
                                {0, 0, -0.7 * s}});
      DescribedBody& body = draft.add_moving({spike}, at);
      if (k == 0) body.pose.p = Vec3(0, at.y(), 0.7 * s + 1e-4 * s);
      body.velocity = draft.vector(0.3 * draft.speed);
      if (k == 0) body.velocity.z() = 0;
      continue;
    }
    DescribedBody& body = draft.add_moving(draft.shape(s), at);
    body.pose.q = draft.attitude();
    body.velocity = draft.vector(draft.speed);
  }
  draft.last(8);
}

// Something with a sharp end, within a ball of this diameter about the origin.
static Solid pointed(Draft& draft, double d) {
  const double b = 0.5 * d * draft.log_uniform(0.05, 0.7), h = 0.35 * d;
  switch (draft.random.below(3)) {
    case 0: return hull({{b, b, h}, {-b, b, h}, {0, -b, h}, {0, 0, -h}});
    case 1: return hull({{b, -b, h}, {b, b, h}, {-b, b, h}, {-b, -b, h}, {0, 0, -h}});
    default: return cone(b, 2 * h);
  }
}

// Plates that meet at their inner edges alone: two of them in a V, or staves of half a pipe; one
// union or several bodies.
void draw_plates(Draft& draft) {
  const double s = draft.size, length = 2.5 * s, thick = s * draft.log_uniform(0.05, 0.5);
  std::vector<Solid> plates;
  double wide = 0, bottom = 0;
  if (draft.chance(0.6)) {
    const double tilt = draft.random.real(0.2, 1.3), across = 4 * s;
    for (const double side : {-1.0, 1.0}) {
      const Quat q = rotation_by({0, -side * tilt, 0});
      plates.push_back(placed(box({across, 2 * length, thick}),
                              q * Vec3(0.5 * side * across, 0, -0.5 * thick), q));
    }
    wide = across * std::cos(tilt);
  } else {
    const int staves = draft.whole(4, 12);
    const double radius = s * draft.random.real(1.2, 3), turn = pi / staves;
    for (int k = 0; k < staves; ++k) {
      const Quat q = rotation_by({0, (k + 0.5) * turn - 0.5 * pi, 0});
      plates.push_back(placed(box({2 * radius * std::tan(0.5 * turn), 2 * length, thick}),
                              Vec3(0, 0, radius) + q * Vec3(0, 0, -radius - 0.5 * thick), q));
    }
    wide = radius;
    bottom = radius - radius / std::cos(0.5 * turn);
  }
  if (draft.chance(0.5)) {
    DescribedBody joined;
    joined.fixed = true;
    joined.solids = plates;
    draft.add(joined, "plates");
  } else {
    for (const Solid& plate : plates) draft.add_fixed(plate, Vec3::Zero());
  }
  for (const double side : {-1.0, 1.0}) {
    draft.add_fixed(half_space({-side, 0, 0}, -wide), Vec3::Zero());
    draft.add_fixed(half_space({0, -side, 0}, -length), Vec3::Zero());
  }
  draft.scene.room = {std::nullopt, {-wide, -length, bottom}, {wide, length, 1e3 * s}};
  const int count = draft.whole(1, 4);
  for (int k = 0; k < count; ++k) {
    const Vec3 at(draft.random.real(-0.2, 0.2) * s, (k % 3 - 1) * 1.2 * s,
                  (4.2 + 1.2 * (k / 3)) * s);
    const bool is_pointed = draft.chance(0.6);
    DescribedBody& body =
        draft.add_moving(is_pointed ? std::vector<Solid>{pointed(draft, s)} : draft.shape(s), at);
    body.pose.q = draft.attitude();
    if (is_pointed && draft.chance(0.7)) body.pose.q = rotation_by(draft.vector(0.4));
    body.velocity = draft.vector(draft.speed);
    body.velocity.z() = -draft.random.real(0, 1) * draft.speed;
  }
  draft.last(8);
}

void draw_ramp(Draft& draft) {
  const double s = draft.size, angle = draft.random.real(0.1, 1.2);
  const Quat tilt = rotation_by({0, angle, 0});
  const double length = 10 * s, thick = draft.chance(0.5) ? 0.1 * s : 2 * s;
  draft.add_fixed(half_space(Vec3::UnitZ(), 0), Vec3::Zero());
  // its upper face ends in the floor at x = 0
  draft.add_fixed(box({length, 6 * s, thick}), tilt * Vec3(-0.45 * length, 0, -0.5 * thick), tilt);
  draft.add_fixed(box({draft.size * draft.random.real(0.05, 1), 40 * s, 4 * s}),
                  {draft.random.real(3, 6) * s, 0, 1.9 * s});
  draft.scene.room = {std::nullopt, Vec3(-1e3, -1e3, 0) * s, Vec3(1e3, 1e3, 1e3) * s};
  const int count = draft.whole(1, 6);
  for (int k = 0; k < count; ++k) {
    const double up = 2 + 1.2 * (k / 3);
    const Vec3 at = tilt * Vec3(-up * s, (k % 3 - 1) * 1.2 * s, s * draft.random.real(0.55, 1));
    DescribedBody& body = draft.add_moving(draft.shape(s), at);
    body.pose.q = draft.chance(0.5) ? draft.attitude() : tilt;
    body.velocity = tilt * Vec3(draft.random.real(0, 2) * draft.speed, 0, 0);
  }
  draft.last(12);
}

static void draw_ground(Draft& draft, bool as_mesh) {
  const double s = draft.size, half = s * draft.random.real(1, 2.5);
  Hills hills;
  hills.as_mesh = as_mesh;
  hills.spacing = s * draft.log_uniform(0.25, 2);
  const auto cells = static_cast<std::size_t>(std::ceil(2 * (half + s) / hills.spacing));
  hills.columns = cells + 1;
  const double rough = hills.spacing * draft.random.real(0.05, 0.8);
  const auto style = draft.random.below(3);
  const double wave = draft.random.real(1, 4) / s, slant = draft.random.real(-0.4, 0.4);
  for (std::size_t row = 0; row <= cells; ++row)
    for (std::size_t column = 0; column <= cells; ++column) {
      const double x = hills.spacing * static_cast<double>(column),
                   y = hills.spacing * static_cast<double>(row);
      switch (style) {
        case 0:  // every corner by itself
          hills.heights.push_back(draft.random.real(-rough, rough));
          break;
        case 1:  // waves on a slope
          hills.heights.push_back(slant * (x - half) +
                                  rough * std::sin(wave * x) * std::cos(wave * y));
          break;
        default:  // plains and steps
          hills.heights.push_back(draft.chance(0.7) ? 0 : rough);
          break;
      }
    }
  const auto [lowest, highest] = std::minmax_element(hills.heights.begin(), hills.heights.end());
  const double low = *lowest, high = *highest;
  DescribedBody ground;
  ground.hills = hills;
  ground.fixed = true;
  draft.add(ground, "hills");
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0})
      draft.add_fixed(half_space(side * Vec3::Unit(axis), -half), Vec3::Zero());
  draft.scene.room = {std::nullopt, {-half, -half, low}, {half, half, 1e3 * s}};
  draft.pour(draft.whole(2, 9), half, high + 0.1 * s, 1.02 * s, [&] {
    const double size = s * draft.log_uniform(0.3, 1);
    return draft.chance(0.3) ? std::vector<Solid>{draft.round_shape(size)} : draft.shape(size);
  });
  for (DescribedBody& body : draft.scene.bodies)
    if (body.dynamic()) body.velocity += draft.vector(draft.speed);
  draft.last(10);
}

void draw_hills(Draft& draft) { draw_ground(draft, false); }

void draw_meshes(Draft& draft) { draw_ground(draft, true); }

// Three walls, the lean ones no more than 30 degrees off square to the floor, each of which runs on
// beneath the others or ends with the room; bodies slide into the corner and push each other there.
void draw_corner(Draft& draft) {
  const double s = draft.size, length = 8 * s, thick = s * draft.log_uniform(0.1, 1);
  const bool is_lean = draft.chance(0.5);
  Mat3 edges = Mat3::Identity();
  if (is_lean)
    for (const auto& [row, column] : {std::pair{0, 2}, {1, 2}, {0, 1}})
      edges(row, column) = draft.random.real(-0.5, 0.5);
  for (int k = 0; k < 3; ++k) {
    Vec3 lo = Vec3::Zero(), hi = length * Vec3(2, 2, 1);
    lo[k] = -thick;
    hi[k] = 0;
    for (int j = 0; j < 3; ++j)
      if (j != k && draft.chance(0.4)) lo[j] = -thick;
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
      corners.push_back(edges * corner);
    }
    draft.add_fixed(hull(corners), Vec3::Zero());
  }
  for (int axis = 0; axis < 2; ++axis)
    draft.add_fixed(half_space(-Vec3::Unit(axis), -length), Vec3::Zero());
  const double least = is_lean ? -length : 0;
  draft.scene.room = {std::nullopt, {least, least, 0}, {length, length, 1e3 * s}, 0.8 * length};
  // along the diagonal, the first one nearest to the corner
  const int count = draft.whole(1, 3);
  for (int k = 0; k < count; ++k) {
    const Vec3 at = edges * Vec3(1.5 + 1.2 * k, 1.5 + 1.2 * k, 0.7) * s;
    const bool is_pointed = k == 0 && draft.chance(0.7);
    DescribedBody& body =
        draft.add_moving(is_pointed ? std::vector<Solid>{pointed(draft, s)} : draft.shape(s), at);
    body.pose.q = draft.attitude();
    const Vec3 towards = -draft.random.real(0.3, 3) * draft.speed * at.normalized();
    body.velocity = towards + draft.vector(0.3 * draft.speed);
    body.velocity.z() = -draft.random.real(0, 0.5) * draft.speed;
  }
  draft.last(8);
}

}  // namespace tw::fuzz
