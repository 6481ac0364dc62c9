// Scenes that tests share: gases, lattices, cradles, floors, molecules in a box, paddles.
//
// Lattices and cradles have many impacts at the same instant, to the bit or up to rounding: there
// the order within one instant decides, and a schedule that leaks into the answer shows.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

#include "integrate/given/keyframes.h"
#include "support/case-file.h"
#include "support/motions.h"
#include "support/scene.h"

namespace tw::test {

// The table gas-N (100 or 200): elastic spheres in a box, 2 s.
inline Scene gas_scene(int count) {
  const std::string name = "gas-" + std::to_string(count);
  const Case c = read_case(name);
  return {name, c.duration, [c](World& world) { fill(world, c); }};
}

// Three spheres along a bent line: an atoms molecule.
inline ShapePtr molecule_shape() {
  Pose left, right;
  left.p = Vec3(-0.2, 0.15, 0);
  right.p = Vec3(0.2, 0.15, 0);
  return make_union({make_sphere(0.25), place_shape(make_sphere(0.15), left),
                     place_shape(make_sphere(0.15), right)});
}

// The hull of random points near a sphere of 0.3 m.
inline ShapePtr rock_shape(std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < 14; ++i)
    points.push_back(random.real(0.22, 0.3) * random_vector(random, 1).normalized());
  return make_hull(points);
}

// count bodies in a box of `side` metres: spheres, molecules, boxes and rocks in turn.
inline Scene mixture_scene(int count, double side, double friction, double duration) {
  const auto fill_world = [=](World& world) {
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, friction);
    add_walls(world, 0, side);
    const std::vector<ShapePtr> shapes = {make_sphere(0.3), molecule_shape(),
                                          make_box({0.5, 0.4, 0.3}), rock_shape(3)};
    Random random(7);
    const int rows = static_cast<int>(std::ceil(std::cbrt(count)));
    const double spacing = side / rows;
    for (int k = 0; k < count; ++k) {
      const Vec3 cell(k % rows, k / rows % rows, k / (rows * rows));
      BodyDef def = body_of(shapes[static_cast<std::size_t>(k) % shapes.size()],
                            spacing * (cell + Vec3::Constant(0.5)), random_vector(random, 2));
      def.angular_velocity = random_vector(random, 3);
      def.orientation = random_attitude(random);
      world.add_body(def);
    }
  };
  return {"mixture-" + std::to_string(count), duration, fill_world};
}

// n^3 balls on a grid, each with a unit velocity along an axis, between walls at half a spacing.
// With spacing 1 all times are multiples of 1/8 s to the bit.
inline Scene lattice_scene(int n, double spacing, double duration) {
  const auto fill_world = [=](World& world) {
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    add_walls(world, -0.5 * spacing, (n - 0.5) * spacing);
    Random random(11);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          add_ball(world, 0.25, spacing * Vec3(i, j, k), random_axis(random));
  };
  return {"lattice-" + std::to_string(n) + "-" + show(spacing), duration, fill_world};
}

// The same with cubes: no pair is predicted exactly, all impacts are face on.
inline Scene cube_lattice_scene(int n, double spacing, double duration) {
  const auto fill_world = [=](World& world) {
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    add_walls(world, -0.5 * spacing, (n - 0.5) * spacing);
    Random random(12);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          world.add_body(
              body_of(make_box({0.5, 0.5, 0.5}), spacing * Vec3(i, j, k), random_axis(random)));
  };
  return {"cubes-" + std::to_string(n) + "-" + show(spacing), duration, fill_world};
}

// Five touching balls between two that hit them at the same instant, and walls that send them back.
inline Scene cradle_scene(double duration) {
  const auto fill_world = [](World& world) {
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    add_wall(world, Vec3::UnitX(), -4);
    add_wall(world, -Vec3::UnitX(), -4);
    for (int i = -2; i <= 2; ++i) add_ball(world, 0.25, {0.5 * i, 0, 0}, Vec3::Zero());
    add_ball(world, 0.25, {-3, 0, 0}, {1, 0, 0});
    add_ball(world, 0.25, {3, 0, 0}, {-1, 0, 0});
  };
  return {"cradle", duration, fill_world};
}

// 36 balls that fall on a floor between four walls, e = 0.8.
inline Scene floor_scene(double duration) {
  const auto fill_world = [](World& world) {
    set_contact_for_all(world, 0.8, 0.2);
    add_wall(world, Vec3::UnitZ(), 0);
    for (int axis = 0; axis < 2; ++axis) {
      add_wall(world, Vec3::Unit(axis), -0.5);
      add_wall(world, -Vec3::Unit(axis), -5.5);
    }
    Random random(5);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const Vec3 position(i, j, random.real(1, 3));
        add_ball(world, 0.3, position, random_vector(random, 2), random_vector(random, 3));
      }
  };
  return {"floor", duration, fill_world};
}

// A paddle that swings through a box of balls and boxes, and a divider that closes and lifts.
inline Scene paddle_scene(double duration) {
  const auto fill_world = [](World& world) {
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0.2);
    add_walls(world, 0, 6);
    const auto quarter = [](double turns) { return rotation_by(Vec3(0, 0, turns * pi / 2)); };
    BodyDef paddle;
    paddle.shape = make_box({2, 0.1, 1});
    paddle.motion = make_keyframes({{0, {3, 3, 3}, quarter(0)},
                                    {1, {3, 3.5, 3}, quarter(1)},
                                    {2, {3, 2.5, 3}, quarter(2)},
                                    {3, {3, 3, 3}, quarter(3)}},
                                   true);
    world.add_body(paddle);
    BodyDef divider;
    divider.shape = make_box({0.1, 5.9, 2.9});
    divider.motion = make_keyframes({{0, {1.2, 3, 1.5}, {}},
                                     {0.5, {1.2, 3, 1.5}, {}},
                                     {1.5, {0.9, 3, 1.5}, {}},
                                     {2.5, {0.9, 3, 3.5}, {}}},
                                    false);
    world.add_body(divider);
    Random random(21);
    for (int k = 0; k < 40; ++k) {
      const Vec3 cell(k % 4, k / 4 % 4, k / 16);
      const Vec3 position = Vec3(0.5, 0.75, 0.75) + cell.cwiseProduct(Vec3(1.65, 1.5, 1.5));
      const Vec3 velocity = random_vector(random, 1.5), spin = random_vector(random, 2);
      if ((position - Vec3(3, 3, 3)).cwiseAbs().maxCoeff() < 1.3) continue;
      const ShapePtr shape = k % 3 == 0 ? make_box({0.3, 0.3, 0.4}) : make_sphere(0.2);
      world.add_body(body_of(shape, position, velocity, spin));
    }
  };
  return {"paddle", duration, fill_world};
}

// Balls and boxes on a tray that sways by a procedure of time, with a kink at 0.4 s, and a bat that
// turns among them.
inline Scene procedure_scene(double duration) {
  const auto fill_world = [](World& world) {
    set_contact_for_all(world, 0.4, 0.3);
    BodyDef tray;
    tray.shape = make_box({3, 3, 0.2});
    tray.motion = Sampled([](double t) {
                    const double rise = t < 0.4 ? 0.5 * t : 0.2 - 0.2 * (t - 0.4);
                    return Pose{{0.1 * std::sin(5 * t), 0, rise},
                                rotation_by(Vec3(0, 0.1 * std::sin(2 * t), 0))};
                  }).motion;
    world.add_body(tray);
    BodyDef bat;
    bat.shape = make_box({1.2, 0.1, 0.3});
    bat.motion = Sampled([](double t) {
                   return Pose{{0, 0, 0.7}, rotation_by(Vec3(0, 0, 3 * t + std::cos(t)))};
                 }).motion;
    world.add_body(bat);
    Random random(11);
    for (int k = 0; k < 16; ++k) {
      const Vec3 position(0.6 * (k % 4) - 0.9, 0.6 * (k / 4) - 0.9, random.real(0.3, 0.4));
      if (std::abs(position.y()) < 0.4 && std::abs(position.x()) < 0.8) continue;
      const ShapePtr shape = k % 3 == 0 ? make_box({0.2, 0.2, 0.3}) : make_sphere(0.1);
      world.add_body(body_of(shape, position, random_vector(random, 1), random_vector(random, 3)));
    }
  };
  return {"procedure", duration, fill_world};
}

}  // namespace tw::test
