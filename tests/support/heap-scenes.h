// Scenes in which contact groups form, break and come to rest: a heap in a pit, a tower hit by a
// ball, a moving platform, tiles with seams.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

#include "support/scenes.h"

namespace tw::test {

// A fixed box.
inline BodyId add_block(World& world, const Vec3& size, const Vec3& position) {
  BodyDef def;
  def.shape = make_box(size);
  def.position = position;
  def.fixed = true;
  return world.add_body(def);
}

inline BodyId add_box(World& world, const Vec3& size, const Vec3& position,
                      const Vec3& velocity = Vec3::Zero()) {
  return world.add_body(body_of(make_box(size), position, velocity));
}

// `count` boxes, balls and rocks of about 0.3 m fall in layers into a pit of 2 half metres' width.
inline Scene heap_scene(int count, double duration, double half = 0.7) {
  const auto fill_world = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    for (int axis = 0; axis < 2; ++axis) {
      add_wall(world, Vec3::Unit(axis), -half);
      add_wall(world, -Vec3::Unit(axis), -half);
    }
    Random random(23);
    const int across = static_cast<int>(2 * half / 0.6);
    for (int k = 0; k < count; ++k) {
      const Vec3 cell(k % across, k / across % across, k / (across * across));
      const Vec3 corner(-0.3 * (across - 1), -0.3 * (across - 1), 0.4);
      const double size = random.real(0.26, 0.36);
      const ShapePtr shapes[] = {make_box(size * Vec3(1, 0.8, 0.6)), make_sphere(0.5 * size),
                                 rock_shape(static_cast<std::uint64_t>(k))};
      BodyDef def = body_of(shapes[k % 3], corner + 0.6 * cell + random_vector(random, 0.02),
                            random_vector(random, 0.3));
      def.orientation = random_attitude(random);
      world.add_body(def);
    }
  };
  return {"heap-" + std::to_string(count), duration, fill_world};
}

// A tower of boxes that has stood for a while when a ball hits it.
inline Scene tower_scene(int boxes, double duration) {
  const auto fill_world = [=](World& world) {
    set_contact_for_all(world, 0.3, 0.5);
    add_block(world, {10, 10, 1}, {0, 0, -0.5});
    for (int i = 0; i < boxes; ++i) {
      const double aside = i % 2 ? 0.02 : -0.02;
      add_box(world, {0.4, 0.4, 0.3}, {aside, 0, 0.151 + 0.301 * i});
    }
    add_ball(world, 0.15, {-2.5, 0.05, 0.8}, {5, 0, 2});
  };
  return {"tower-" + std::to_string(boxes), duration, fill_world};
}

// A platform that rises and turns back under two boxes, a ball and a rock.
inline Scene platform_scene(double duration) {
  const auto fill_world = [](World& world) {
    set_contact_for_all(world, 0.1, 0.6);
    BodyDef platform;
    platform.shape = make_box({3, 3, 0.2});
    platform.motion = make_keyframes(
        {{0, {0, 0, -0.1}, {}}, {0.5, {0.2, 0, 0.0}, {}}, {1, {0, 0.3, -0.1}, {}}}, true);
    world.add_body(platform);
    add_box(world, {0.4, 0.4, 0.3}, {-0.8, 0, 0.16});
    add_box(world, {0.4, 0.4, 0.3}, {0.8, 0, 0.2});
    add_box(world, {0.3, 0.3, 0.3}, {0.8, 0.05, 0.55});
    add_ball(world, 0.2, {0, 0.8, 0.25}, {0.3, 0, 0});
    world.add_body(body_of(rock_shape(4), {0, -0.8, 0.5}, Vec3::Zero()));
  };
  return {"platform", duration, fill_world};
}

// Balls in a box that turns about a level axis, 2 rad/s.
inline Scene tumbler_scene(int count, double duration) {
  const auto fill_world = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    std::vector<ShapePtr> sides;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-0.55, 0.55})
        sides.push_back(place_shape(make_box(Vec3::Constant(1.2) - 1.1 * Vec3::Unit(axis)),
                                    {side * Vec3::Unit(axis), Quat::Identity()}));
    BodyDef box;
    box.shape = make_union(sides);
    std::vector<Keyframe> turns;
    for (int k = 0; k <= 4 * duration; ++k)
      turns.push_back({0.5 * k, Vec3::Zero(), rotation_by(Vec3(0, k, 0))});
    box.motion = make_keyframes(turns, false);
    world.add_body(box);
    Random random(41);
    for (int k = 0; k < count; ++k)
      add_ball(world, 0.07,
               0.2 * Vec3(k % 4 - 1.5, k / 4 % 4 - 1.5, k / 16 - 1) + random_vector(random, 0.02),
               Vec3::Zero());
  };
  return {"tumbler-" + std::to_string(count), duration, fill_world};
}

// Boxes and rocks that fall and slide over tiles: every step of theirs crosses a seam.
inline Scene tiles_scene(double duration) {
  const auto fill_world = [](World& world) {
    set_contact_for_all(world, 0.2, 0.2);
    for (int i = -3; i <= 3; ++i)
      for (int j = -2; j <= 2; ++j) add_block(world, {0.5, 0.5, 0.5}, {0.5 * i, 0.5 * j, -0.25});
    Random random(31);
    for (int k = 0; k < 8; ++k) {
      BodyDef def =
          body_of(k % 2 ? rock_shape(static_cast<std::uint64_t>(k)) : make_box({0.4, 0.3, 0.2}),
                  {-1.2 + 0.6 * (k % 4), -0.4 + 0.8 * (k / 4), 0.5},
                  Vec3(1.5, 0, 0) + random_vector(random, 0.2));
      if (k % 4 == 0) def.orientation = random_attitude(random);
      world.add_body(def);
    }
  };
  return {"tiles", duration, fill_world};
}

}  // namespace tw::test
