// Scenes that break rigid-body simulators: unequal masses, tall stacks, thin, tiny and huge bodies,
// fast spin, stiff and soft springs, heaps.
//
// The floor is z = 0 unless a scene says otherwise.  SI units.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/scenes.h"
#include "support/stability.h"

namespace tw::test {

inline BodyDef named(BodyDef def, const std::string& name) {
  def.name = name;
  return def;
}

// ---- columns ----

// `count` cubes of 0.2 m on top of each other; the top one weighs `ratio` times as much as the
// others.  Each is let down by `drop` more than what is below it, m: at 0 all is placed touching.
inline void add_column(World& world, int count, double ratio, double drop = 0) {
  constexpr double edge = 0.2;
  for (int i = 0; i < count; ++i) {
    const double height = (i + 0.5) * edge + (i + 1) * drop;
    BodyDef cube = body_of(make_box(Vec3::Constant(edge)), {0, 0, height}, Vec3::Zero());
    cube.density = i == count - 1 ? 1000 * ratio : 1000;
    world.add_body(named(cube, "cube-" + std::to_string(i)));
  }
}

inline StabilityScene column_scene(int count, double ratio, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    add_floor(world);
    add_column(world, count, ratio);
  };
  const std::string name = ratio == 1 ? "stack-" + std::to_string(count)
                                      : "mass-" + show(ratio) + "-on-" + std::to_string(count - 1);
  const std::string what = ratio == 1 ? std::to_string(count) + " equal cubes"
                                      : "a cube " + show(ratio) + " times as heavy on " +
                                            std::to_string(count - 1) + " cubes";
  return {name, what, duration, true, fill};
}

// The heavy cube comes down on a light one at 2 m/s.
inline StabilityScene heavy_blow_scene(double ratio, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    add_floor(world);
    BodyDef light = body_of(make_box(Vec3::Constant(0.2)), {0, 0, 0.1}, Vec3::Zero());
    BodyDef heavy = body_of(make_box(Vec3::Constant(0.2)), {0.03, 0.02, 0.35}, {0, 0, -2});
    heavy.density = 1000 * ratio;
    world.add_body(named(light, "light"));
    world.add_body(named(heavy, "heavy"));
  };
  return {"blow-" + show(ratio), "a cube " + show(ratio) + " times as heavy falls on one at 2 m/s",
          duration, true, fill};
}

// The column with the pair's stiffness set, N/m.
inline StabilityScene stiffness_scene(double stiffness, double duration) {
  const auto fill = [=](World& world) {
    ContactSettings settings;
    settings.restitution = 0.2;
    settings.friction = 0.5;
    settings.stiffness = stiffness;
    world.set_contact({}, {}, settings);
    add_floor(world);
    add_column(world, 5, 1, 1e-5);
  };
  return {"stiffness-" + show(stiffness), "5 cubes of 8 kg, stiffness " + show(stiffness) + " N/m",
          duration, true, fill};
}

// ---- architecture ----

// A semicircular arch of inner radius 1 m: equal wedges, a hair apart, on the floor.
inline StabilityScene arch_scene(int stones, double thickness, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0, 0.7);
    add_floor(world);
    constexpr double gap = 1e-6;
    const double outer = 1 + thickness, depth = 0.4;
    for (int i = 0; i < stones; ++i) {
      const double from = pi * i / stones, to = pi * (i + 1) / stones;
      const double middle = 0.5 * (from + to), radius = 0.5 * (1 + outer);
      const Vec3 center(radius * std::cos(middle), 0, radius * std::sin(middle));
      std::vector<Vec3> corners;
      for (const double angle : {from, to})
        for (const double r : {1.0, outer})
          for (const double y : {-0.5 * depth, 0.5 * depth})
            corners.push_back(Vec3(r * std::cos(angle), y, r * std::sin(angle)) - center);
      for (Vec3& corner : corners) corner *= 1 - 4 * gap;
      BodyDef stone = body_of(make_hull(corners), center, Vec3::Zero());
      stone.density = 2400;
      world.add_body(named(stone, "stone-" + std::to_string(i)));
    }
  };
  return {"arch-" + std::to_string(stones),
          "semicircular arch of " + std::to_string(stones) + " stones, thickness " +
              show(thickness) + " of the inner radius",
          duration, true, fill};
}

// Two cards that lean on each other, `lean` from the vertical, with the feet on z = base.
inline void add_tent(World& world, const Vec3& card, double lean, const Vec3& base,
                     const std::string& name) {
  constexpr double gap = 2e-6;
  for (const double side : {-1.0, 1.0}) {
    // the inner top corner is at x = side * gap, the foot at z = 0
    const Vec3 half = 0.5 * card;
    const double height = card.z() * std::cos(lean) + card.x() * std::sin(lean);
    const Quat attitude = rotation_by(Vec3(0, -side * lean, 0));
    const Vec3 inner = attitude * Vec3(-side * half.x(), 0, half.z());
    BodyDef def = body_of(make_box(card), Vec3::Zero(), Vec3::Zero());
    def.orientation = attitude;
    def.position = base + Vec3(side * gap - inner.x(), 0, 0.5 * height + gap);
    world.add_body(named(def, name + (side < 0 ? "-left" : "-right")));
  }
}

// Two tents, a card across, a tent on top: 7 cards of `thickness`.
inline StabilityScene card_house_scene(double thickness, double friction, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0, friction);
    add_floor(world);
    const Vec3 card(thickness, 0.063, 0.088);
    constexpr double lean = 0.35;
    const double height = card.z() * std::cos(lean) + card.x() * std::sin(lean);
    const double half_base = card.z() * std::sin(lean) + card.x() * std::cos(lean) + 1e-4;
    add_tent(world, card, lean, {-half_base, 0, 0}, "lower-1");
    add_tent(world, card, lean, {half_base, 0, 0}, "lower-2");
    // wide enough for both ridges and the feet above
    const Vec3 roof(4 * half_base, 0.063, thickness);
    const double level = height + 4e-6;
    world.add_body(
        named(body_of(make_box(roof), {0, 0, level + 0.5 * thickness}, Vec3::Zero()), "roof"));
    add_tent(world, card, lean, {0, 0, level + thickness}, "upper");
  };
  return {
      "cards-" + show(1e3 * thickness) + "mm",
      "card house of 7 cards " + show(1e3 * thickness) + " mm thick, friction " + show(friction),
      duration, true, fill};
}

// ---- extremes of size and shape ----

// A ball, a cube and a cylinder dropped on a pile of three cubes, all `scale` times as large.
inline StabilityScene scale_scene(double scale) {
  const double second = std::sqrt(scale);  // times scale with the root of lengths
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.3, 0.5);
    add_floor(world);
    const auto add = [&](const std::string& name, const ShapePtr& shape, const Vec3& at,
                         const Vec3& turn) {
      BodyDef def = body_of(shape, scale * at, Vec3::Zero());
      def.orientation = rotation_by(turn);
      world.add_body(named(def, name));
    };
    for (int i = 0; i < 3; ++i)
      add("cube-" + std::to_string(i), make_box(Vec3::Constant(scale)), {0.05 * i, 0, 0.5 + i},
          Vec3::Zero());
    add("ball", make_sphere(0.5 * scale), {0.3, 0.2, 4.1}, Vec3::Zero());
    add("tumbler", make_box(scale * Vec3(1, 0.7, 0.5)), {1.7, 0.1, 2}, {0.4, 0.5, 0.6});
    add("drum", make_cylinder(0.4 * scale, 0.8 * scale), {-1.5, 0.2, 2}, {0.7, 0.2, 0});
  };
  // the ball may roll for ever
  return {"size-" + show(scale) + "m",
          "six bodies of " + show(scale) + " m: three cubes, ball, box, drum",
          10 * second,
          false,
          fill,
          500 / second};
}

// A cube of 1 mm between floor and a cube of 1 m: beside it, and on top of it.
inline StabilityScene unequal_sizes_scene(double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    add_floor(world);
    world.add_body(named(body_of(make_box(Vec3::Constant(1)), {0, 0, 0.5}, Vec3::Zero()), "large"));
    world.add_body(
        named(body_of(make_box(Vec3::Constant(1e-3)), {0.1, 0.2, 1.01}, Vec3::Zero()), "small"));
    world.add_body(named(body_of(make_sphere(0.5e-3), {0.3, 0, 1.0005}, {0.05, 0, 0}), "bead"));
  };
  return {"size-1:1000", "a cube and a bead of 1 mm on a cube of 1 m", duration, false, fill};
}

// A rod `ratio` times as long as thick, 1 m, thrown on the floor, and one across two blocks.
inline StabilityScene rod_scene(double ratio, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.3, 0.5);
    add_floor(world);
    const ShapePtr rod = make_box({1, 1 / ratio, 1 / ratio});
    BodyDef thrown = body_of(rod, {0, 0, 0.7}, {0.5, 0, 0}, {0, 1, 2});
    thrown.orientation = rotation_by(Vec3(0.1, 0.6, 0));
    world.add_body(named(thrown, "thrown"));
    for (const double x : {-0.4, 0.4})
      world.add_body(named(body_of(make_box({0.05, 0.05, 0.05}), {x, 2, 0.025}, Vec3::Zero()),
                           x < 0 ? "left" : "right"));
    world.add_body(named(body_of(rod, {0, 2, 0.05 + 0.5 / ratio + 1e-3}, Vec3::Zero()), "across"));
  };
  return {"rod-1:" + show(ratio),
          "rods 1 m long, 1/" + show(ratio) + " m thick: one thrown, one across two blocks",
          duration, true, fill};
}

// A coin of 24 mm, spun on its rim about the vertical.  Fast it stands, slow it wobbles (Euler's
// disc): without rolling resistance it loses little but what the law's damping takes.
inline StabilityScene coin_scene(double spin, double tilt, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.3, 0.4);
    add_floor(world);
    constexpr double radius = 0.012, thickness = 0.002;
    BodyDef coin =
        body_of(make_cylinder(radius, thickness), Vec3::Zero(), Vec3::Zero(), {0, 0, spin});
    coin.density = 8000;
    coin.orientation = rotation_by(Vec3(pi / 2 - tilt, 0, 0));
    coin.position.z() = radius * std::cos(tilt) + 0.5 * thickness * std::sin(tilt) + 1e-6;
    world.add_body(named(coin, "coin"));
  };
  return {
      "coin-" + show(spin),
      "a coin of 24 mm spun at " + show(spin) + " rad/s, " + show(tilt) + " rad off the vertical",
      duration,
      false,
      fill,
      2000};
}

// ---- friction ----

// A box on a slope `off` degrees steeper than the friction angle.
inline StabilityScene slope_scene(double off, double duration) {
  const auto fill = [=](World& world) {
    constexpr double friction = 0.5;
    const double angle = std::atan(friction) + off * pi / 180;
    set_contact_for_all(world, 0, friction);
    const Vec3 normal(std::sin(angle), 0, std::cos(angle));
    const Vec3 up(-std::cos(angle), 0, std::sin(angle));
    add_wall(world, normal, 0);
    BodyDef box = body_of(make_box({1, 1, 0.5}), 0.25 * normal + 20 * up, Vec3::Zero());
    box.orientation = rotation_by(Vec3(0, angle, 0));
    world.add_body(named(box, "box"));
  };
  const std::string sign = off > 0 ? "+" : "";
  return {"slope" + sign + show(off),
          "a box on a slope, friction angle " + sign + show(off) + " degrees", duration, off < 0,
          fill};
}

// A body that spins at `spin` while it rests on the floor.
inline StabilityScene spin_scene(const std::string& name, const ShapePtr& shape, double height,
                                 const Vec3& spin, bool rests, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.3, 0.3);
    add_floor(world);
    world.add_body(named(body_of(shape, {0, 0, height}, Vec3::Zero(), spin), name));
  };
  return {"spin-" + name, name + " spinning at " + show(spin.norm()) + " rad/s on the floor",
          duration,       rests,
          fill,           2000};
}

// ---- heaps ----

// A stone: the hull of 16 points on an ellipsoid.
inline ShapePtr random_stone(Random& random, double size) {
  std::vector<Vec3> points;
  for (int i = 0; i < 16; ++i)
    points.push_back(0.5 * size *
                     random_vector(random, 1).normalized().cwiseProduct(Vec3(1.2, 1, 0.8)));
  return make_hull(points);
}

struct HeapBody {
  std::string kind;
  ShapePtr shape;
};

inline HeapBody random_heap_body(Random& random, bool round, double size) {
  switch (random.below(round ? 4 : 2)) {
    case 0: return {"stone-", random_stone(random, size)};
    case 1: return {"box-", make_box(size * Vec3(1, 0.8, 0.6))};
    case 2: return {"ball-", make_sphere(0.5 * size)};
    default: return {"drum-", make_cylinder(0.4 * size, 0.8 * size)};
  }
}

// A floor in a pit of four walls, 2 m wide: round bodies cannot roll away.
inline void add_pit(World& world) {
  const auto add = [&](const std::string& name, const Vec3& edges, const Vec3& at) {
    BodyDef def;
    def.name = name;
    def.shape = make_box(edges);
    def.position = at;
    def.fixed = true;
    world.add_body(def);
  };
  add("ground", {6, 6, 1}, {0, 0, -0.5});
  for (const int axis : {0, 1})
    for (const double side : {-1.0, 1.0}) {
      Vec3 edges(3, 3, 6), at(0, 0, 3);
      edges[axis] = 0.5;
      at[axis] = 1.25 * side;
      add("wall-" + std::to_string(axis) + (side < 0 ? "-" : "+"), edges, at);
    }
}

// Stones and boxes and, where `round`, balls and drums, 0.3 to 0.45 m, dropped into the pit in
// layers of nine.  What is round may go on rolling: Coulomb's law has no rolling resistance.
inline StabilityScene heap_scene(int count, std::uint64_t seed, bool round, double restitution,
                                 double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, restitution, 0.5);
    add_pit(world);
    Random random(seed);
    for (int k = 0; k < count; ++k) {
      const double size = random.real(0.3, 0.45);
      const HeapBody body = random_heap_body(random, round, size);
      const Vec3 cell(k % 3 - 1, k / 3 % 3 - 1, k / 9);
      const Vec3 position = 0.6 * cell + Vec3(0, 0, 0.4) + random_vector(random, 0.05);
      BodyDef def = body_of(body.shape, position, Vec3::Zero());
      def.orientation = random_attitude(random);
      def.density = 2600;
      world.add_body(named(def, body.kind + std::to_string(k)));
    }
  };
  const std::string name = round ? "heap-" : "angular-heap-";
  return {name + std::to_string(seed) + (restitution == 0.2 ? "" : "-e" + show(restitution)),
          std::to_string(count) + (round ? " stones, boxes, balls, drums" : " stones and boxes") +
              " in a pit, restitution " + show(restitution),
          duration,
          !round && restitution < 1,
          fill,
          200};
}

}  // namespace tw::test
