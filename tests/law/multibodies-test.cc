// Multibodies in a world: what must hold of them by the laws of mechanics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "multibody/joint-laws.h"
#include "multibody/limits.h"
#include "multibody/multibody.h"
#include "support/multibody-scenes.h"
#include "support/schedule.h"

namespace tw {
namespace {

using namespace test;

// A compound pendulum swings with the period of its elliptic integral.
TEST(Multibodies, a_pendulum_swings_as_the_elliptic_integral_says) {
  World world;
  world.set_accuracy(1e-9);
  const double length = 0.5, start = 1.0;
  const std::uint32_t rod = world.add_multibody(chain(1, length, Vec3(0, 0, 2)));
  set_joint(world, rod, 0, 0.5 * pi - start);  // 0 is level, pi/2 hangs
  const Multibody& multibody = world.multibody(rod);
  const BodyInfo& body = world.body(multibody.links[0]);
  // about the pivot: the rod's centre is half its length away
  const double thickness = 0.1 * length;
  const double inertia =
      body.mass * ((length * length + thickness * thickness) / 12 + length * length / 4);
  const double omega = std::sqrt(body.mass * 9.81 * 0.5 * length / inertia);
  const double period = 4 * std::comp_ellint_1(std::sin(0.5 * start)) / omega;
  world.advance(period);
  EXPECT_NEAR(world.joints(rod).q[0], 0.5 * pi - start, 1e-7);
  EXPECT_NEAR(world.joints(rod).u[0], 0, 1e-6);
  world.advance(1.5 * period);
  EXPECT_NEAR(world.joints(rod).q[0], 0.5 * pi + start, 1e-7);
}

// The error of the energy follows the accuracy that is asked for.
TEST(Multibodies, energy_is_kept_as_accurately_as_was_asked) {
  for (const double accuracy : {1e-4, 1e-6, 1e-8}) {
    World world;
    world.set_accuracy(accuracy);
    world.add_multibody(chain(5, 0.5, Vec3(0, 0, 5)));
    const double before = world.total_energy();
    world.advance(2);
    const double at_play = 5 * world.body(0).mass * 9.81 * 1.25;
    EXPECT_LT(std::abs(world.total_energy() - before), 10 * accuracy * at_play) << accuracy;
  }
}

// Floating, without gravity: momentum stays, whatever the joints do.
TEST(Multibodies, a_floating_tree_keeps_its_momentum) {
  World world;
  world.set_gravity(Vec3::Zero());
  const std::uint32_t number = world.add_multibody(car(Vec3(0, 0, 2)));
  world.edit(world.multibody(number).links[0], [](StateView& view) {
    view.change_joints([](MultibodyState& joints) {
      for (std::size_t k = 0; k < joints.u.size(); ++k)
        joints.u[k] = 0.3 * std::sin(1.0 + static_cast<double>(k));
    });
  });
  const Vec3 momentum = world.total_momentum();
  ASSERT_GT(momentum.norm(), 1);
  const double energy = world.total_energy();
  world.advance(5);
  EXPECT_LT((world.total_momentum() - momentum).norm(), 1e-6 * momentum.norm());
  EXPECT_NEAR(world.total_energy(), energy, 1e-5 * energy);
}

// Three rods in free flight that fold and unfold.
void add_floating_chain(World& world, const multibody::AxisSpec& law) {
  world.set_gravity(Vec3::Zero());
  MultibodyDef def = chain(3, 0.5, Vec3::Zero());
  def.free = true;
  for (LinkDef& link : def.links) {
    link.body.mass = 1;
    link.joint.axes[0] = law;
  }
  def.links[0].joint = {};
  const std::uint32_t number = world.add_multibody(def);
  set_velocity(world, number, 6, 2);
  set_velocity(world, number, 7, -3);
}

// Where joints strike their stops, lean on them and leave them, over and over: strikes take energy,
// nothing gives any, and momentum stays.
TEST(Multibodies, a_floating_chain_keeps_its_momentum_at_its_stops) {
  struct {
    double stiffness, limit, restitution, friction;
  } const cases[] = {
      {0, 0.3, 0, 0}, {0, 0.1, 0, 0}, {0, 0.05, 0.2, 0}, {3, 0.1, 0, 0}, {0, 0.3, 0, 0.05}};
  for (const auto& [stiffness, limit, restitution, friction] : cases) {
    World world;
    multibody::AxisSpec law;
    law.stiffness = stiffness;
    law.restitution = restitution;
    law.friction = friction;
    law.lower = -limit;
    law.upper = limit;
    add_floating_chain(world, law);
    const Vec3 momentum = world.total_momentum();
    ASSERT_GT(momentum.norm(), 1);
    const std::string of = show(stiffness) + " N m/rad, limit " + show(limit);
    double energy = world.total_energy();
    for (int i = 1; i <= 40; ++i) {
      world.advance(0.25 * i);
      const double now = world.total_energy();
      EXPECT_LT(now, energy * (1 + 2e-5)) << of << " at " << 0.25 * i;
      energy = std::min(energy, now);
    }
    EXPECT_LT((world.total_momentum() - momentum).norm(), 5e-5 * momentum.norm()) << of;
  }
}

// Springs at joints swing on for hundreds of swings, however stiff.
TEST(Multibodies, stiff_joints_swing_on) {
  for (const double stiffness : {3.0, 300.0, 3000.0}) {
    World world;
    multibody::AxisSpec law;
    law.stiffness = stiffness;
    add_floating_chain(world, law);
    const Vec3 momentum = world.total_momentum();
    const double energy = world.total_energy();
    world.advance(10);
    EXPECT_NEAR(world.total_energy(), energy, 3e-5 * energy) << stiffness;
    EXPECT_LT((world.total_momentum() - momentum).norm(), 1e-6 * momentum.norm()) << stiffness;
  }
}

// Wheels that stick: the path is the angle times the radius.
TEST(Multibodies, a_car_rolls_without_slip) {
  World world;
  add_floor(world);
  const std::uint32_t number = world.add_multibody(car(Vec3(0, 0, car_height)));
  set_velocity(world, number, 0, 2);
  world.advance(2);  // wheels have come up to speed
  const MultibodyState before = world.joints(number);
  world.advance(4);
  const MultibodyState after = world.joints(number);
  const double path = after.q[0] - before.q[0];
  EXPECT_GT(path, 1);
  for (std::size_t wheel = 7; wheel < 11; ++wheel)
    EXPECT_NEAR((after.q[wheel] - before.q[wheel]) * wheel_radius, path, 2e-3 * path);
  EXPECT_NEAR(after.q[2], car_height, 2e-3) << "it stands on its wheels";
}

TEST(Multibodies, a_chain_comes_to_rest_on_the_floor) {
  World world;
  add_floor(world);
  MultibodyDef def = chain(3, 0.5, Vec3(0, 0, 0.8));
  for (LinkDef& link : def.links) link.joint.axes[0].damping = 0.002;
  const std::uint32_t number = world.add_multibody(def);
  const double before = world.total_energy();
  world.advance(4);
  EXPECT_LT(world.total_energy(), before);
  for (const double u : world.joints(number).u) EXPECT_NEAR(u, 0, 1e-4);
  for (const BodyId link : world.multibody(number).links)
    EXPECT_GT(world.state(link).position.z(), -2e-3);
}

// Thrown against its stops an arm rests there, as deep as its weight bends them.
TEST(Multibodies, an_arm_rests_at_its_stops) {
  World world;
  MultibodyDef def = chain(2, 0.5, Vec3(0, 0, 3));
  for (LinkDef& link : def.links) {
    link.joint.axes[0].lower = -0.5;
    link.joint.axes[0].upper = link.parent.empty() ? 1.0 : 0.3;
    link.joint.axes[0].restitution = 0.5;
  }
  const std::uint32_t number = world.add_multibody(def);
  double before = world.total_energy();
  for (int i = 1; i <= 10; ++i) {
    world.advance(0.3 * i);
    const double now = world.total_energy();
    EXPECT_LT(now, before + 1e-4) << "at " << 0.3 * i << " s";
    before = now;
  }
  const MultibodyState joints = world.joints(number);
  EXPECT_NEAR(joints.q[0], 1.0, 2e-4);
  EXPECT_NEAR(joints.q[1], 0.3, 2e-4);
  EXPECT_GT(joints.q[0], 1.0);
  for (const double u : joints.u) EXPECT_NEAR(u, 0, 1e-9);
}

// A stopped joint bounces with the stop's restitution: a bar that falls from the level on a stop
// straight below it comes back to cos = e^2.  So it does on a hinge, and on a spherical joint whose
// limit is of all turning or of the swing of the bar.
TEST(Multibodies, a_stop_strikes_back_with_its_restitution) {
  using multibody::JointKind;
  for (const int kind : {0, 1, 2}) {
    World world;
    MultibodyDef def = chain(1, 0.5, Vec3(0, 0, 2));
    const double e = 0.6;
    multibody::JointSpec& joint = def.links[0].joint;
    if (kind > 0) joint.kind = multibody::JointKind::spherical;
    if (kind == 0) joint.axes[0].lower = -1;
    if (kind == 2) joint.swinging = Vec3(3, 0, 0);
    joint.axes[0].upper = 0.5 * pi;
    joint.axes[0].restitution = e;
    const std::uint32_t number = world.add_multibody(def);
    const multibody::Axis& axis = world.multibody(number).tree.axes()[0];
    double least = pi;
    bool struck = false;
    for (int i = 1; i < 150; ++i) {
      world.advance(0.01 * i);
      const MultibodyState joints = world.joints(number);
      const double rate = multibody::limited_rate(axis, joints.q, joints.u);
      struck = struck || rate < -0.1;
      if (struck && rate > 0.05) break;
      if (struck) least = std::min(least, multibody::limited(axis, joints.q));
    }
    // height from the bottom: 1 - sin q = e^2
    EXPECT_NEAR(1 - std::sin(least), e * e, 2e-3) << kind;
  }
}

// A rod that hangs in a cone and is whirled about the vertical too fast for the cone's angle leans
// on it from within and goes round evenly, for the cone pushes in no other direction: its moment of
// momentum about the vertical and its energy stay.  What turns about the rod itself is left alone.
TEST(Multibodies, a_rod_goes_round_in_its_cone) {
  for (const double spin : {0.0, 20.0}) {
    World world;
    world.set_accuracy(1e-9);
    const double angle = 0.8, rate = 9;  // a conical pendulum's would be 6.5 rad/s
    MultibodyDef def = chain(1, 0.5, Vec3(0, 0, 2));
    multibody::JointSpec& joint = def.links[0].joint;
    joint.kind = multibody::JointKind::spherical;
    joint.placement.q = rotation_by(Vec3(0, 0.5 * pi, 0));  // x hangs
    joint.swinging = Vec3::UnitX();
    joint.axes[0].upper = angle;
    const std::uint32_t number = world.add_multibody(def);
    // about y, out of the vertical towards world x
    const Quat out = rotation_by(Vec3(0, -(angle - 1e-9), 0));
    const Vec3 down = out.conjugate() * Vec3::UnitX(), rod = Vec3::UnitX();
    const Vec3 u = spin * rod - rate * (down - down.dot(rod) * rod);
    world.edit(world.multibody(number).links[0], [&](StateView& view) {
      view.change_joints([&](MultibodyState& joints) {
        multibody::set_quaternion(joints.q.data(), out);
        multibody::set_vector(joints.u.data(), u);
      });
    });
    world.advance(0.1);  // its stop is loaded by then
    const double energy = world.total_energy();
    world.advance(2);
    const MultibodyState joints = world.joints(number);
    const Vec3 end =
        Quat(rotation_by(Vec3(0, 0.5 * pi, 0)) * multibody::quaternion_at(joints.q.data())) * rod;
    const double swung = std::acos(-end.z()), round = std::atan2(end.y(), end.x());
    EXPECT_NEAR(swung, angle, 5e-4);
    EXPECT_GT(swung, angle);
    EXPECT_NEAR(multibody::vector_at(joints.u.data()).x(), spin, 1e-7);
    EXPECT_NEAR(world.total_energy(), energy, 4e-6);
    if (spin > 0) continue;
    EXPECT_NEAR(std::remainder(round - 2 * rate, 2 * pi), 0, 3e-3);
  }
}

// A servo holds against gravity at target - torque / stiffness, also where it is very stiff.
TEST(Multibodies, servos_hold_and_stiff_ones_cost_little) {
  double steps_of_soft = 0;
  for (const double stiffness : {1e2, 1e4, 1e6}) {
    World world;
    const std::uint32_t number = world.add_multibody(chain(1, 0.5, Vec3(0, 0, 2)));
    const BodyInfo& body = world.body(world.multibody(number).links[0]);
    const double torque = body.mass * 9.81 * 0.25;
    world.edit(body.id, [&](StateView& view) {
      view.change_joints([&](MultibodyState& joints) {
        const double inertia = body.mass * 0.25 / 3;
        joints.targets = {-0.3};
        joints.servos = {{stiffness, 2 * std::sqrt(stiffness * inertia)}};
      });
    });
    world.advance(3);
    const double q = world.joints(number).q[0];
    // gravity turns it down: q grows by torque cos q / stiffness
    EXPECT_NEAR(q, -0.3 + torque * std::cos(q) / stiffness, 1e-6) << stiffness;
    const double steps = static_cast<double>(count_of(world.statistics(), "implicit_steps"));
    if (steps_of_soft == 0) steps_of_soft = steps;
    EXPECT_LT(steps, 10 * steps_of_soft) << stiffness;
  }
}

// A torque beyond a joint's friction speeds it up by what is beyond, from the first: friction that
// lets go within a step is resolved.  It is less than its limit while it is smooth.
TEST(Multibodies, a_joint_breaks_away_from_its_friction) {
  constexpr double friction = 2, torque = 2.5;  // N m
  for (const multibody::JointKind kind :
       {multibody::JointKind::revolute, multibody::JointKind::spherical})
    for (const double accuracy : {1e-3, 1e-4, 1e-6}) {
      World world;
      world.set_gravity(Vec3::Zero());
      world.set_accuracy(accuracy);
      MultibodyDef def = chain(1, 1, Vec3(0, 0, 2));
      def.links[0].joint.kind = kind;
      def.links[0].joint.axes[0].friction = friction;
      const Multibody& rod = world.multibody(world.add_multibody(def));
      world.edit(rod.links[0], [&](StateView& view) {
        view.change_joints([&](MultibodyState& joints) {
          joints.torques.assign(joints.u.size(), 0);
          joints.torques[kind == multibody::JointKind::revolute ? 0 : 1] = torque;
        });
      });
      const double mass = world.body(rod.links[0]).mass, inertia = mass * (1.01 / 12 + 0.25);
      const double smooth = multibody::friction_speed(rod.tree.axes()[0]);
      for (const double t : {0.01, 0.1, 1.0}) {
        world.advance(t);
        const double u = world.state(rod.links[0]).angular_velocity.y();
        EXPECT_GT(u, (torque - friction) / inertia * t - 1e-5) << t << ", " << accuracy;
        EXPECT_LT(u, (torque - friction) / inertia * t + 3 * smooth) << t << ", " << accuracy;
      }
    }
}

// Two bars that turn about a joint whose friction brings its spring to rest away from where it
// would be: steps are short there for a while only.  (Slower than the tolerance and faster than
// friction's creep, such a joint went to and fro at the steps' own rate: 1e-7 s each, for seconds.)
TEST(Multibodies, a_dry_joint_settles_in_few_steps) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    World world;
    world.set_gravity(Vec3::Zero());
    MultibodyDef def = chain(2, 1, Vec3::Zero());
    def.free = true;
    def.links[0].joint = {};
    for (LinkDef& link : def.links)
      link.body.shape =
          place_shape(make_box(Vec3(1, 0.3, 0.3)), Pose{Vec3(0.5, 0, 0), Quat::Identity()});
    multibody::JointSpec& joint = def.links[1].joint;
    joint.kind = multibody::JointKind::spherical;
    joint.axes[0].friction = 60;
    joint.axes[0].stiffness = 600;
    const std::uint32_t number = world.add_multibody(def);
    for (std::size_t k = 3; k < 9; ++k)
      set_velocity(world, number, k, (k < 6 ? 1 : 3) * random.real(-1, 1));
    world.advance(5);
    EXPECT_LT(count_of(world.statistics(), "implicit_steps"), 1000) << seed;
  }
}

// A ball that strikes the end of a free rod of two welded halves does to it what it does to a rod.
TEST(Multibodies, links_that_are_welded_take_impulses_as_one_body) {
  const auto after = [](bool welded) {
    World world;
    world.set_gravity(Vec3::Zero());
    BodyDef ball;
    ball.shape = make_sphere(0.1);
    ball.position = Vec3(0.8, 0, -0.5);
    ball.velocity = Vec3(0, 0, 2);
    const BodyId striker = world.add_body(ball);
    if (welded) {
      MultibodyDef def = chain(2, 0.5, Vec3(0, 0, 0));
      def.free = true;
      def.links[1].joint.kind = multibody::JointKind::weld;
      world.add_multibody(def);
    } else {
      BodyDef rod;
      rod.shape =
          place_shape(make_box(Vec3(1, 0.05, 0.05)), Pose{Vec3(0.5, 0, 0), Quat::Identity()});
      world.add_body(rod);
    }
    world.advance(0.4);
    return world.state(striker).velocity;
  };
  EXPECT_LT((after(true) - after(false)).norm(), 1e-9);
}

// Links that rest feel at once what strikes a fellow.  A cylinder on a block with two balls welded
// to it swings down and strikes the floor with both, at one instant but for rounding; what carries
// the cylinder takes the first blow up, and may lift the second ball with it.  Without losses at
// impacts, what the blows leave in excess (8 % here, if a second finds the cylinder as the first
// had not touched it) would show.
TEST(Multibodies, strikes_at_one_instant_on_a_link_beside_resting_ones_give_no_energy) {
  World world;
  set_contact_for_all(world, 1, 0);
  add_floor(world);
  BodyDef block;
  block.name = "block";
  block.shape = make_box(Vec3(0.4, 1, 0.1));
  block.position = Vec3(0, 0, 0.05);
  block.fixed = true;
  world.add_body(block);
  MultibodyDef def;
  def.name = "three";
  def.free = true;
  def.position = Vec3(0, 0, 0.2);
  LinkDef rear;
  rear.name = "rear";
  const Quat sideways(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()));
  rear.body.shape = place_shape(make_cylinder(0.1, 0.4), Pose{Vec3::Zero(), sideways});
  def.links.push_back(rear);
  for (const double side : {0.2, -0.2}) {
    LinkDef ball;
    ball.name = side > 0 ? "left" : "right";
    ball.parent = "rear";
    ball.joint.kind = multibody::JointKind::weld;
    ball.joint.placement.p = Vec3(0.5, side, 0);
    ball.body.shape = make_sphere(0.1);
    def.links.push_back(ball);
  }
  world.add_multibody(def);
  world.advance(0.14);
  const double before = world.total_energy();
  world.advance(0.16);
  EXPECT_GE(count_of(world.statistics(), "collisions"), 1);
  EXPECT_LT(world.total_energy(), before + 1e-5);
}

// The schedule never changes the answer.
TEST(Multibodies, one_history_whatever_the_schedule) {
  const auto scene = [](World& world) {
    add_floor(world);
    set_velocity(world, world.add_multibody(car(Vec3(0, 0, car_height + 0.2))), 0, 2);
    MultibodyDef limited = chain(3, 0.3, Vec3(1.2, 0, 0.7));
    for (LinkDef& link : limited.links) {
      link.joint.axes[0].lower = -0.4;
      link.joint.axes[0].restitution = 0.4;
    }
    limited.name = "hung";
    world.add_multibody(limited);
    for (LinkDef& link : limited.links) {
      link.joint.kind = multibody::JointKind::spherical;
      link.joint.axes[0].lower = -std::numeric_limits<double>::infinity();
      link.joint.axes[0].upper = 0.3;
      if (link.name == "rod-1") link.joint.swinging = Vec3::UnitX();
    }
    limited.name = "loose";
    limited.position.y() = 1;
    world.add_multibody(limited);
  };
  const auto hash = [&](const Schedule& schedule) {
    World world;
    world.set_hash(true);
    apply(world, schedule);
    scene(world);
    advance_in_pieces(world, 1.0, schedule.pieces);
    return world.history_hash();
  };
  const std::string plain = hash({});
  Schedule check, undo, pieces;
  check.check = undo.undo_redo = true;
  pieces.pieces = 7;
  for (const Schedule& schedule : {check, undo, pieces}) EXPECT_EQ(hash(schedule), plain);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start *= 0.2;
    EXPECT_EQ(hash(schedule), plain) << describe(schedule);
  }
}

}  // namespace
}  // namespace tw
