// Scenes that strain what came after bodies and contacts: joints, stops, servos, moving bases,
// holds, closed loops, springs, force procedures, height fields, round shapes, rolling friction,
// fine hulls, procedures, policies.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "support/motions.h"
#include "support/stability-scenes.h"

namespace tw::test {

// ---- multibodies ----

// `links` rods of `length` along x from a hinge at `position`, on hinges along y; the last weighs
// `ratio` times as much as the others.
inline MultibodyDef rod_chain(int links, double length, double ratio, const Vec3& position) {
  MultibodyDef def;
  def.name = "chain";
  def.position = position;
  for (int i = 0; i < links; ++i) {
    LinkDef link;
    link.name = "rod-" + std::to_string(i);
    if (i > 0) link.parent = "rod-" + std::to_string(i - 1);
    link.joint.axis = Vec3::UnitY();
    if (i > 0) link.joint.placement.p = Vec3(length, 0, 0);
    link.body.shape = place_shape(make_box(Vec3(0.9 * length, 0.1 * length, 0.1 * length)),
                                  Pose{Vec3(0.5 * length, 0, 0), Quat::Identity()});
    link.body.density = i == links - 1 ? 1000 * ratio : 1000;
    def.links.push_back(link);
  }
  return def;
}

// Let go level; half of it comes to lie on the floor.
inline StabilityScene fallen_chain_scene(int links, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    add_floor(world);
    world.add_multibody(rod_chain(links, 3.0 / links, 1, {0, 0, 1.5}));
  };
  return {"chain-" + std::to_string(links),
          "a chain of " + std::to_string(links) + " rods, 3 m, falls on the floor 1.5 m below",
          duration, false, fill};
}

// It swings freely.
inline StabilityScene heavy_chain_scene(double ratio, double duration) {
  const auto fill = [=](World& world) { world.add_multibody(rod_chain(5, 0.2, ratio, {0, 0, 2})); };
  return {"chain-mass-" + show(ratio),
          "a chain of 5 rods swings, the last " + show(ratio) + " times as heavy", duration, false,
          fill};
}

// Three flaps that fall from level onto stops 0.5 rad below, each 30 times as heavy as the last.
inline StabilityScene flaps_scene(double restitution, double duration) {
  const auto fill = [=](World& world) {
    for (int i = 0; i < 3; ++i) {
      MultibodyDef flap = rod_chain(1, 0.5, 1, {0, 1.0 * i, 1});
      flap.name = "flap-" + std::to_string(i);
      flap.links[0].body.density = 1000 * std::pow(30.0, i);
      flap.links[0].joint.axes[0].upper = 0.5;
      flap.links[0].joint.axes[0].restitution = restitution;
      world.add_multibody(flap);
    }
  };
  return {"stops-e" + show(restitution),
          "three flaps of 1:30:900 fall on their stops, restitution " + show(restitution), duration,
          true, fill};
}

// An arm of five rods held level by servos, the last `ratio` times as heavy.
inline StabilityScene servo_scene(double ratio, double stiffness, double duration) {
  const auto fill = [=](World& world) {
    const std::uint32_t arm = world.add_multibody(rod_chain(5, 0.2, ratio, {0, 0, 2}));
    world.advance(0);
    world.edit(world.multibody(arm).links[0], [&](StateView& view) {
      view.change_joints([&](MultibodyState& joints) {
        joints.servos.assign(5, {stiffness, 0.01 * stiffness});
        joints.targets.assign(5, 0.0);
      });
    });
  };
  StabilityScene scene{"servos-" + show(stiffness),
                       "an arm of 5 rods held level by servos of " + show(stiffness) +
                           " N m/rad, the last " + show(ratio) + " times as heavy",
                       duration, true, fill};
  scene.driven = true;
  return scene;
}

// Five rods whirl, each within a cone of half a radian about the one before.
inline StabilityScene cones_scene(double restitution, double duration) {
  const auto fill = [=](World& world) {
    MultibodyDef chain = rod_chain(5, 0.2, 1, {0, 0, 2});
    chain.orientation = rotation_by(Vec3(0, 0.5 * pi, 0));
    for (LinkDef& link : chain.links) {
      link.joint.kind = multibody::JointKind::spherical;
      link.joint.swinging = Vec3::UnitX();
      link.joint.axes[0].upper = 0.5;
      link.joint.axes[0].restitution = restitution;
    }
    const std::uint32_t number = world.add_multibody(chain);
    world.advance(0);
    world.edit(world.multibody(number).links[0], [](StateView& view) {
      view.change_joints([](MultibodyState& joints) {
        for (std::size_t i = 0; i < joints.u.size(); ++i) joints.u[i] = i % 3 == 0 ? 0 : 4;
      });
    });
  };
  return {"cones-e" + show(restitution),
          "five rods whirl, each in a cone of 0.5 rad about the one before, restitution " +
              show(restitution),
          duration, false, fill};
}

// Five rods fall from the level, with friction at each joint of 0.5 N m times the ratio.
inline StabilityScene dry_chain_scene(double ratio, double duration) {
  const auto fill = [=](World& world) {
    MultibodyDef chain = rod_chain(5, 0.2, ratio, {0, 0, 2});
    for (LinkDef& link : chain.links) link.joint.axes[0].friction = 0.5 * ratio;
    world.add_multibody(chain);
  };
  return {"dry-" + show(ratio),
          "the chain of 5 rods, the last " + show(ratio) + " times as heavy, with joint friction",
          duration, false, fill};
}

// Three rods on a hinge, the last `ratio` times as heavy, whose end is held to where it begins.
inline StabilityScene loop_scene(double ratio, double duration) {
  const auto fill = [=](World& world) {
    BodyDef post;
    post.name = "post";
    post.shape = make_box(Vec3::Constant(0.1));
    post.position = {0.4, 0.5, 2};
    post.fixed = true;
    const BodyId end = world.add_body(post);
    const std::uint32_t bars = world.add_multibody(rod_chain(3, 0.3, ratio, {0, 0, 2}));
    world.advance(0);
    const std::vector<BodyId>& links = world.multibody(bars).links;
    world.edit(links[0], [](StateView& view) {
      view.change_joints([](MultibodyState& joints) { joints.q = {1.2, -1.0, -1.0}; });
    });
    HoldDef hold;
    hold.at = Vec3(0.3, 0, 0);
    world.attach(links[2], end, hold);
  };
  return {"loop-" + show(ratio),
          "three rods on a hinge, the last " + show(ratio) + " times as heavy, its end held",
          duration, false, fill};
}

// A procedure's motion of a body as large as a metre.
inline TrajectoryPtr motion_of(std::function<Pose(double)> pose) {
  return std::make_shared<SampledMotion>(std::make_unique<FunctionMotion>(std::move(pose), 100));
}

// A chain that hangs on a block shaken up and down by 10 cm at 8 Hz, 13 times what gravity pulls.
inline StabilityScene shaken_base_scene(double duration) {
  const auto fill = [=](World& world) {
    BodyDef block;
    block.name = "block";
    block.shape = make_box(Vec3::Constant(0.1));
    block.motion = motion_of([](double t) {
      return Pose{Vec3(0, 0, 2 + 0.05 * (1 - std::cos(2 * pi * 8 * t))), Quat::Identity()};
    });
    MultibodyDef chain = rod_chain(4, 0.2, 1, {0, 0.12, 0});
    chain.base = world.add_body(block);
    world.add_multibody(chain);
  };
  StabilityScene scene{"base-shaken", "a chain of 4 rods on a base shaken by 10 cm at 8 Hz",
                       duration, false, fill};
  scene.driven = true;
  return scene;
}

// ---- springs and holds ----

// Cubes of 0.2 m `gap` apart, each held to the one before, the first to a fixed one; the last
// weighs `ratio` times as much as the others.
inline StabilityScene held_beam_scene(int count, double ratio, double gap, double duration) {
  const auto fill = [=](World& world) {
    constexpr double edge = 0.2;
    BodyId before = no_body;
    for (int i = 0; i <= count; ++i) {
      BodyDef cube =
          body_of(make_box(Vec3::Constant(edge)), {(edge + gap) * i, 0, 2}, Vec3::Zero());
      cube.density = i == count ? 1000 * ratio : 1000;
      if (i == 0) {
        cube.density.reset();
        cube.fixed = true;
      }
      const BodyId now = world.add_body(named(cube, "cube-" + std::to_string(i)));
      if (i > 0) world.attach(now, before);
      before = now;
    }
  };
  return {"held-" + show(ratio) + (gap < 0.01 ? "-touching" : ""),
          "a beam of " + std::to_string(count) + " cubes held to each other, " + show(1e3 * gap) +
              " mm apart, the last " + show(ratio) + " times as heavy",
          duration, false, fill};
}

// Balls of 1 and `ratio` in turn hang on springs below each other.
inline StabilityScene spring_column_scene(double ratio, double stiffness, double duration) {
  const auto fill = [=](World& world) {
    BodyDef hook;
    hook.name = "hook";
    hook.shape = make_sphere(0.02);
    hook.position = {0, 0, 10};
    hook.fixed = true;
    BodyId above = world.add_body(hook);
    for (int i = 0; i < 6; ++i) {
      BodyDef ball = body_of(make_sphere(0.05), {0.02 * i, 0, 9.7 - 0.3 * i}, Vec3::Zero());
      ball.density = i % 2 == 0 ? 1000 : 1000 * ratio;
      const BodyId now = world.add_body(named(ball, "ball-" + std::to_string(i)));
      SpringDef spring;
      spring.a = above;
      spring.b = now;
      spring.stiffness = stiffness;
      world.add_spring(spring);
      above = now;
    }
  };
  return {"springs-" + show(ratio),
          "six balls of 1:" + show(ratio) + " in turn on springs of " + show(stiffness) + " N/m",
          duration, false, fill};
}

// Pulls to a point by a spring that nothing but its procedure knows.
class Pull final : public ForceProcedure {
 public:
  Pull(const Vec3& to, double stiffness) : to_(to), stiffness_(stiffness) {}
  Wrench force(double, const BodyState& body) override {
    return {stiffness_ * (to_ - body.position), Vec3::Zero()};
  }
  std::uint64_t number() const override { return 1; }

 private:
  Vec3 to_;
  double stiffness_;  // N/m
};

// A box that a procedure draws down onto the floor and along it.
inline StabilityScene drawn_box_scene(double stiffness, double duration) {
  const auto fill = [=](World& world) {
    set_contact_for_all(world, 0.2, 0.5);
    add_floor(world);
    const BodyId box = world.add_body(
        named(body_of(make_box({0.3, 0.2, 0.2}), {0, 0, 0.3}, Vec3(0, 1, 0)), "box"));
    world.add_force(box, std::make_shared<Pull>(Vec3(0.2, 0, 0.05), stiffness));
  };
  StabilityScene scene{
      "drawn-" + show(stiffness),
      "a box of 12 kg drawn onto the floor by a procedure, " + show(stiffness) + " N/m", duration,
      false, fill};
  scene.driven = true;
  return scene;
}

// ---- shapes ----

// Hills in a hollow, on which heaps come down.
inline void add_hollow(World& world) {
  constexpr int cells = 40;
  constexpr double spacing = 0.15;
  std::vector<double> heights;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double x = spacing * (i - cells / 2), y = spacing * (j - cells / 2);
      heights.push_back(0.2 * (x * x + y * y) + 0.1 * std::sin(4 * x) * std::cos(3 * y) + 0.2);
    }
  BodyDef ground;
  ground.name = "hollow";
  ground.shape = make_height_field(heights, cells + 1, spacing, spacing);
  ground.fixed = true;
  world.add_body(ground);
}

enum class HeapOf { mixed, round, fine };

// Of capsules, cones and ellipsoids; or hulls of 200 corners, as of meshes.
inline HeapBody feature_body(Random& random, HeapOf kind, double size) {
  if (kind == HeapOf::mixed) return random_heap_body(random, true, size);
  if (kind == HeapOf::fine) {
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i)
      points.push_back(0.5 * size *
                       random_vector(random, 1).normalized().cwiseProduct(Vec3(1.2, 1, 0.8)));
    return {"hull-", make_hull(points)};
  }
  switch (random.below(3)) {
    case 0: return {"capsule-", make_capsule(0.3 * size, 0.6 * size)};
    case 1: return {"cone-", make_cone(0.5 * size, size)};
    default: return {"ellipsoid-", make_ellipsoid(0.5 * size * Vec3(1.2, 1, 0.7))};
  }
}

struct FeatureHeap {
  std::string name, what;
  HeapOf kind = HeapOf::mixed;
  int count = 30;
  bool hollow = false;          // on hills, else in the pit
  double rolling_friction = 0;  // m, and spinning
  bool stirred = false;         // by a wall that comes and goes
  std::string policy = {};      // empty: timewarp
};

inline void add_pusher(World& world) {
  BodyDef pusher;
  pusher.name = "pusher";
  pusher.shape = make_box({0.2, 1.9, 2});
  pusher.motion = motion_of([](double t) {
    return Pose{Vec3(-1 + 0.15 * (1 - std::cos(2 * pi * t)), 0, 1.1), Quat::Identity()};
  });
  world.add_body(pusher);
}

inline StabilityScene feature_heap_scene(const FeatureHeap& heap, double duration) {
  const auto fill = [=](World& world) {
    ContactSettings settings;
    settings.restitution = 0.2;
    settings.friction = 0.5;
    if (heap.rolling_friction > 0)
      settings.rolling_friction = settings.spinning_friction = heap.rolling_friction;
    world.set_contact({}, {}, settings);
    if (!heap.policy.empty()) world.set_policy(heap.policy);
    heap.hollow ? add_hollow(world) : add_pit(world);
    if (heap.stirred) add_pusher(world);
    Random random(1);
    for (int k = 0; k < heap.count; ++k) {
      const double size = random.real(0.3, 0.45);
      const HeapBody body = feature_body(random, heap.kind, size);
      const Vec3 cell(k % 3 - 1, k / 3 % 3 - 1, k / 9);
      const Vec3 position = 0.6 * cell + Vec3(0, 0, 0.9) + random_vector(random, 0.03);
      BodyDef def = body_of(body.shape, position, Vec3::Zero());
      def.orientation = random_attitude(random);
      def.density = 2600;
      world.add_body(named(def, body.kind + std::to_string(k)));
    }
  };
  StabilityScene scene{heap.name, heap.what, duration, heap.rolling_friction > 0, fill, 200};
  scene.driven = heap.stirred;
  return scene;
}

inline std::vector<StabilityScene> feature_scenes() {
  std::vector<StabilityScene> all;
  all.push_back(fallen_chain_scene(20, 15));
  for (const double ratio : {1e3, 1e6}) all.push_back(heavy_chain_scene(ratio, 10));
  for (const double e : {0.0, 0.9}) all.push_back(flaps_scene(e, 20));
  for (const double stiffness : {1e3, 1e6}) all.push_back(servo_scene(10, stiffness, 20));
  for (const double e : {0.0, 0.9}) all.push_back(cones_scene(e, 10));
  for (const double ratio : {1.0, 1e3}) all.push_back(dry_chain_scene(ratio, 10));
  all.push_back(shaken_base_scene(20));
  for (const double ratio : {1.0, 100.0}) all.push_back(held_beam_scene(10, ratio, 0.05, 20));
  all.push_back(held_beam_scene(10, 100, 0.002, 20));
  for (const double ratio : {1.0, 1e3}) all.push_back(loop_scene(ratio, 10));
  for (const double ratio : {1.0, 1e3}) all.push_back(spring_column_scene(ratio, 1e5, 10));
  for (const double stiffness : {1e3, 1e5}) all.push_back(drawn_box_scene(stiffness, 10));
  const FeatureHeap heaps[] = {
      {"hills", "30 stones, boxes, balls, drums on hills of cells of 15 cm", HeapOf::mixed, 30,
       true},
      {"round", "30 capsules, cones, ellipsoids in a pit", HeapOf::round},
      {"round-rolling", "the same with 1 cm of rolling and spinning friction", HeapOf::round, 30,
       false, 0.01},
      {"hills-rolling", "30 stones, boxes, balls, drums on hills, the same friction", HeapOf::mixed,
       30, true, 0.01},
      {"fine", "12 hulls of 200 corners in a pit", HeapOf::fine, 12},
      {"stirred", "20 stones, boxes, balls, drums, a wall comes and goes by 30 cm once a second",
       HeapOf::mixed, 20, false, 0, true},
      {"policy-timewarp", "12 stones, boxes, balls, drums in a pit", HeapOf::mixed, 12},
      {"policy-retroactive", "the same, in steps of 1/30 s", HeapOf::mixed, 12, false, 0, false,
       "retroactive:0.0333333"},
      {"policy-conservative", "the same, conservatively", HeapOf::mixed, 12, false, 0, false,
       "conservative"},
  };
  for (const FeatureHeap& heap : heaps) all.push_back(feature_heap_scene(heap, 10));
  return all;
}

}  // namespace tw::test
