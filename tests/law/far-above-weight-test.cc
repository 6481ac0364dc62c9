// What presses with a million weights is borne: by contacts within 1 % of the thinner one's width,
// by stops of joints within 1e-3, by holds; it lies still, goes no faster when the force has gone
// than its own contact lets it, and what is beyond is told.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "law/squeezed-bodies.h"
#include "support/heap-scenes.h"
#include "support/multibody-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

void push(World& world, BodyId body, const Vec3& force) {
  world.edit(body, [&](StateView& view) { view.set_applied_force(force); });
}

std::int64_t told(const World& world) { return count_of(world.statistics(), "squeezed"); }

BodyDef kilogram(const ShapePtr& shape, const Vec3& position) {
  BodyDef def = body_of(shape, position, Vec3::Zero());
  def.mass = 1;
  return def;
}

// Looks every millisecond until then.
template <class Look>
void watch(World& world, double until, const Look& look) {
  while (world.time() < until) {
    world.advance(std::min(until, world.time() + 1e-3));
    look();
  }
}

TEST(FarAboveWeight, a_force_on_one_body_presses_it_less_than_a_hundredth_of_its_width) {
  const ShapePtr shapes[] = {make_box(Vec3::Constant(width)), make_sphere(0.5 * width),
                             make_cylinder(0.5 * width, width)};
  for (const double gravity : {g, 0.0})
    for (const ShapePtr& shape : shapes)
      for (const double weights : {1e3, 1e4, 1e5, 1e6}) {
        World world;
        world.set_gravity(Vec3(0, 0, -gravity));
        add_wall(world, Vec3::UnitZ(), 0);
        const BodyId body = world.add_body(kilogram(shape, {0, 0, 0.5 * width}));
        world.advance(0.5);
        push(world, body, Vec3(0, 0, -weights * g));
        double deepest = 0, fastest = 0;
        const auto depth = [&] { return 0.5 * width - world.state(body).position.z(); };
        watch(world, 0.7, [&] { deepest = std::max(deepest, depth()); });
        // without gravity nothing lies there before, and what comes to lie starts loaded
        if (gravity > 0) {
          EXPECT_GT(deepest, 1e-3 * width) << weights;
        }
        EXPECT_LT(deepest, 0.01 * width) << weights;
        EXPECT_LT(world.state(body).velocity.norm(), 1e-3 * std::sqrt(g * width)) << weights;
        EXPECT_EQ(told(world), 0) << weights;
        // the force goes: N = h k (d + tau d') lets it out at d/tau at most
        push(world, body, Vec3::Zero());
        const double tau = 20 * std::sqrt(2.5e-4 * width / g);
        double energy = world.total_energy();
        watch(world, 0.8, [&] {
          EXPECT_LT(world.total_energy() - energy, 1e-6 * g * width) << weights;
          energy = world.total_energy();
          fastest = std::max(fastest, world.state(body).velocity.norm());
        });
        EXPECT_LT(fastest, 0.01 * width / tau) << weights;
      }
}

TEST(FarAboveWeight, a_force_on_a_stack_presses_no_two_of_it_deeper) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  std::vector<BodyId> boxes;
  for (int i = 0; i < 4; ++i)
    boxes.push_back(
        world.add_body(kilogram(make_box(Vec3::Constant(width)), {0, 0, width * (i + 0.5)})));
  world.advance(0.5);
  push(world, boxes.back(), Vec3(0, 0, -1e6 * g));
  watch(world, 1, [&] {
    double below = 0;
    for (const BodyId box : boxes) {
      const double bottom = world.state(box).position.z() - 0.5 * width;
      ASSERT_LT(below - bottom, 0.01 * width) << box << " at " << world.time();
      below = bottom + width;
    }
  });
}

// Two boxes in the void, and a spring between their middles.
TEST(FarAboveWeight, a_spring_pulls_two_together_no_nearer) {
  for (const double weights : {1e3, 1e6}) {
    World world;
    world.set_gravity(Vec3::Zero());
    const ShapePtr box = make_box(Vec3::Constant(width));
    SpringDef spring;
    spring.a = world.add_body(kilogram(box, {0, 0, 0}));
    spring.b = world.add_body(kilogram(box, {width, 0, 0}));
    spring.stiffness = weights * g / width;
    spring.rest = 0;
    world.advance(0.1);
    world.add_spring(spring);
    double nearest = width;
    watch(world, 0.6, [&] {
      const Vec3 apart = world.state(spring.b).position - world.state(spring.a).position;
      nearest = std::min(nearest, apart.x());
    });
    EXPECT_GT(nearest, 0.99 * width) << weights;
  }
}

// A ram of 4 kg on a slide presses a ball.
TEST(FarAboveWeight, a_ram_presses_a_ball_no_deeper) {
  World world;
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId ball = world.add_body(kilogram(make_sphere(0.5 * width), {0, 0, 0.5 * width}));
  MultibodyDef def;
  def.position = {0, 0, 1.6 * width};
  LinkDef ram;
  ram.name = "ram";
  ram.joint.kind = multibody::JointKind::prismatic;
  ram.joint.axis = -Vec3::UnitZ();
  ram.body.shape = make_box(Vec3::Constant(width));
  ram.body.mass = 4;
  def.links.push_back(ram);
  const std::uint32_t press = world.add_multibody(def);
  const BodyId head = world.multibody(press).links[0];
  world.advance(0.5);
  world.edit(head, [](StateView& view) {
    view.change_joints([](MultibodyState& joints) { joints.torques = {8e5}; });
  });
  watch(world, 1, [&] {
    const double z = world.state(ball).position.z(), top = world.state(head).position.z();
    ASSERT_GT(z, 0.49 * width);
    ASSERT_GT(top - z, 0.99 * width);
  });
}

// 0.2 kg and 10 cm, as wrists of robots are.
TEST(FarAboveWeight, a_motor_drives_its_joint_no_further_than_its_stop) {
  for (const bool slides : {false, true})
    for (const double torque : {0.1, 1.0, 10.0, 100.0, slides ? 1e5 : 1e4}) {
      World world;
      MultibodyDef def;
      LinkDef link;
      link.name = "hand";
      using multibody::JointKind;
      link.joint.kind = slides ? JointKind::prismatic : JointKind::revolute;
      link.joint.axis = slides ? Vec3::UnitX() : Vec3::UnitY();
      link.joint.axes[0].lower = -0.1;
      link.joint.axes[0].upper = 0.1;
      const Vec3 middle(0.05, 0, 0);
      link.body.shape = place_shape(make_box({0.1, 0.03, 0.03}), Pose{middle, Quat::Identity()});
      link.body.mass = 0.2;
      def.links.push_back(link);
      const std::uint32_t arm = world.add_multibody(def);
      world.edit(world.multibody(arm).links[0], [&](StateView& view) {
        view.change_joints([&](MultibodyState& joints) { joints.torques = {torque}; });
      });
      world.advance(2);
      const double soon = world.joints(arm).q[0];
      EXPECT_LT(soon, 0.1 + 1e-3) << torque;
      EXPECT_GT(soon, 0.1) << torque;
      world.advance(4);
      EXPECT_NEAR(world.joints(arm).q[0], soon, 1e-7) << torque << ": it creeps";
      // nothing is left of what it stored
      world.edit(world.multibody(arm).links[0], [](StateView& view) {
        view.change_joints([](MultibodyState& joints) { joints.torques = {0}; });
      });
      world.advance(4.05);
      EXPECT_GT(world.joints(arm).q[0], 0.1 - 1e-3) << torque << ": it is flung";
    }
}

// One that holds another against a force.
TEST(FarAboveWeight, a_hold_gives_way_by_less_than_a_hundredth) {
  for (const double weights : {1e2, 1e4, 1e6}) {
    World world;
    world.set_gravity(Vec3::Zero());
    const ShapePtr box = make_box(Vec3::Constant(width));
    const BodyId a = world.add_body(kilogram(box, {0, 0, 0}));
    const BodyId b = world.add_body(kilogram(box, {1.5 * width, 0, 0}));
    world.attach(a, b);
    world.advance(0.1);
    push(world, a, Vec3(-weights * g, 0, 0));
    push(world, b, Vec3(weights * g, 0, 0));
    watch(world, 0.6, [&] {
      const double apart = (world.state(b).position - world.state(a).position).norm();
      ASSERT_LT(apart - 1.5 * width, 0.01 * width) << weights << " at " << world.time();
    });
  }
}

// A sheet of 1 mm on the floor and a cube of up to a million times its mass.
struct SheetUnderCube {
  World world;
  BodyId sheet = 0;
  static constexpr double thin = 1e-3;

  SheetUnderCube(double ratio, double above) {
    set_contact_for_all(world, 0.3, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def = body_of(make_box({0.4, 0.4, thin}), {0, 0, 0.5 * thin}, Vec3::Zero());
    def.mass = 1.6e-3;
    sheet = world.add_body(def);
    BodyDef cube = body_of(make_box(Vec3::Constant(0.3)), {0.02, 0.01, 0.15 + thin}, Vec3::Zero());
    cube.mass = 1.6e-3 * ratio;
    if (above > 0) cube.orientation = rotation_by({0.1, 0.03, 0});
    cube.position.z() += above;
    world.add_body(cube);
  }
  // Of its deepest corner in the floor, share of its thickness.
  double depth() const {
    const BodyState state = world.state(sheet);
    double lowest = 1;
    for (const double x : {-0.2, 0.2})
      for (const double y : {-0.2, 0.2})
        lowest =
            std::min(lowest, (state.position + state.orientation * Vec3(x, y, -0.5 * thin)).z());
    return -lowest / thin;
  }
};

TEST(FarAboveWeight, a_sheet_bears_a_million_times_its_mass) {
  for (const double ratio : {1e3, 1e4, 1e6}) {
    SheetUnderCube lies(ratio, 0);
    watch(lies.world, 0.3, [&] { ASSERT_LT(lies.depth(), 0.01) << ratio; });
    SheetUnderCube falls(ratio, 0.12);
    watch(falls.world, 0.3, [&] { ASSERT_LT(falls.depth(), 0.01) << ratio; });
  }
}

// A hundred million weights are more than a contact bears.
TEST(FarAboveWeight, what_is_beyond_is_told) {
  World world;
  const BodyId floor = add_wall(world, Vec3::UnitZ(), 0);
  const BodyId box = world.add_body(kilogram(make_box(Vec3::Constant(width)), {0, 0, 0.5 * width}));
  std::vector<Collision> rows;
  world.add_collision_observer([&](const Collision& row) { rows.push_back(row); },
                               CollisionKind::squeezed);
  world.advance(0.5);
  push(world, box, Vec3(0, 0, -1e8 * g));
  world.advance(1);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].squeezed, box);
  EXPECT_EQ(rows[0].body1, floor);
  EXPECT_EQ(rows[0].body2, floor);
  EXPECT_GE(rows[0].depth_share, 0.01);
}

}  // namespace
}  // namespace tw::test
