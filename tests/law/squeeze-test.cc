// What is squeezed between walls that come nearer than it is wide: overlap is shared, time goes on,
// and what the walls leave comes back with them.
//
// Beyond 10 dh a contact is a spring beside a damper, so a depth d that nothing holds any more goes
// at d/tau, tau = 10 dh b = 20 sqrt(d0/g), and what it throws has the energy m (d/tau)^2/2 at most,
// however much the walls had put in.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "law/squeezed-bodies.h"
#include "support/heap-scenes.h"
#include "support/stability.h"

namespace tw::test {
namespace {

constexpr double gap = 0.1;
constexpr double depth = 0.5 * (width - gap);  // on either side

double time_of_return() { return 20 * std::sqrt(2.5e-4 * width / g); }

// A wall stands with its face at 0; another, `thickness` thick, comes down to `least` from the
// first in [0, 1], stays until 2, and goes back in `back` seconds.
struct Press {
  World world;
  BodyId body, wall;

  explicit Press(const ShapePtr& shape, double least = gap, double back = 0.5,
                 double thickness = 0.2) {
    set_contact_for_all(world, 0.3, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef fixed;
    fixed.shape = make_box({0.2, 2, 2});
    fixed.position = {-0.1, 0, 0};
    fixed.fixed = true;
    world.add_body(fixed);
    body = world.add_body(body_of(shape, {0.11, 0, 0.1}, Vec3::Zero()));
    BodyDef moving;
    moving.shape = make_box({thickness, 2, 2});
    const Vec3 far(0.4 + 0.5 * thickness, 0, 0), near(least + 0.5 * thickness, 0, 0);
    moving.motion =
        make_keyframes({{0, far, {}}, {1, near, {}}, {2, near, {}}, {2 + back, far, {}}}, true);
    wall = world.add_body(moving);
  }
  double x() const { return world.state(body).position.x(); }
  double speed() const { return world.state(body).velocity.norm(); }
  // Energy beyond what there was at the start and what the walls gave, J.
  double gain() const {
    const auto table = world.statistics();
    return number_of(table, "energy_end") - number_of(table, "energy_start") -
           number_of(table, "kinematic_work");
  }
};

struct Squeezed {
  std::string name;
  ShapePtr shape;
};

std::vector<Squeezed> shapes() {
  return {{"box", make_box({width, width, width})},
          {"ball", make_sphere(0.5 * width)},
          {"drum", make_cylinder(0.5 * width, width)}};
}

TEST(Squeeze, overlap_is_shared_evenly_and_the_body_goes_as_the_middle_does) {
  for (const Squeezed& kind : shapes()) {
    Press press(kind.shape);
    press.world.advance(0.7);
    const double wall_speed = press.world.state(press.wall).velocity.x();
    EXPECT_NEAR(press.world.state(press.body).velocity.x(), 0.5 * wall_speed, 1e-3) << kind.name;
    press.world.advance(1.9);
    EXPECT_NEAR(press.x(), 0.5 * gap, 1e-5) << kind.name;
    EXPECT_LT(press.speed(), 1e-3) << kind.name;
    const auto table = press.world.statistics();
    EXPECT_LE(count_of(table, "impulses_given_up"), 10) << kind.name;
    EXPECT_LT(number_of(table, "cpu_seconds"), 1.9) << kind.name;
  }
}

TEST(Squeeze, what_the_wall_leaves_follows_it_and_has_come_out_when_it_has_gone) {
  for (const Squeezed& kind : shapes()) {
    Press press(kind.shape);
    double gain = 0, fastest = 0;
    for (int i = 1; i <= 60; ++i) {
      press.world.advance(i / 20.0);
      // the walls' work comes back to them while they go
      EXPECT_LT(press.gain(), gain + 1e-3) << kind.name << " at " << press.world.time();
      gain = std::min(gain, press.gain());
      if (i > 40) fastest = std::max(fastest, press.speed());
      // half way back: the wall has left 0.2 m, and the body is out of both
      if (i == 45) {
        EXPECT_GT(press.x(), 0.5 * width - 1e-3) << kind.name;
      }
    }
    EXPECT_LT(fastest, 1.01 * depth / time_of_return()) << kind.name;
    EXPECT_LT(number_of(press.world.statistics(), "energy_end"),
              0.1 + number_of(press.world.statistics(), "energy_start"))
        << kind.name << ": springs that hold nothing are loaded";
  }
}

// The wall goes at 30 m/s.  What is left of 1.6e5 J is m (d/tau)^2/2, here 4.9 J for the box.
TEST(Squeeze, what_nothing_holds_any_more_comes_out_at_the_depth_over_its_time) {
  for (const Squeezed& kind : shapes()) {
    Press press(kind.shape, gap, 0.01);
    press.world.advance(1.9);
    EXPECT_GT(number_of(press.world.statistics(), "energy_end"), 5e3) << kind.name;
    press.world.advance(2.02);
    const double expected = depth / time_of_return();
    EXPECT_NEAR(press.speed(), expected, 0.1 * expected) << kind.name;
    press.world.advance(2 + 2 * time_of_return());
    EXPECT_GT(press.x(), 0.5 * width - 0.01 * width) << kind.name;
  }
}

// The shortest way out of the moving wall, 0.05 m thick, is on its far side then: both walls would
// push the same way.  Its contact is about four times as stiff as that with the thick one.
TEST(Squeeze, what_a_thin_wall_has_pushed_through_stays_on_its_side) {
  for (const Squeezed& kind : shapes()) {
    Press press(kind.shape, -0.1, 0.5, 0.05);
    press.world.advance(1.9);
    EXPECT_NEAR(press.x(), 0.5 * width - 0.8 * (width + 0.1), 0.03) << kind.name;
    press.world.advance(3);
    EXPECT_GT(press.x(), 0.5 * width - 1e-3) << kind.name;
    EXPECT_LT(press.x(), 0.4) << kind.name;
  }
}

// A plate comes down on what lies on the floor: what it strikes it strikes again at once, as fast.
TEST(Squeeze, what_a_plate_pins_to_the_floor_is_a_contact_at_once) {
  for (const Squeezed& kind : shapes()) {
    World world;
    set_contact_for_all(world, 0.3, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    const BodyId body = world.add_body(body_of(kind.shape, {0, 0, 0.5 * width}, Vec3::Zero()));
    BodyDef plate;
    plate.shape = make_box({1, 1, 0.2});
    plate.motion = make_keyframes({{0, {0, 0, 0.6}, {}}, {1, {0, 0, 0.2}, {}}}, false);
    world.add_body(plate);
    world.advance(1.5);
    EXPECT_NEAR(world.state(body).position.z(), 0.25 * width, 1e-3) << kind.name;
    const auto table = world.statistics();
    EXPECT_LT(count_of(table, "collisions"), 100) << kind.name;
    EXPECT_EQ(count_of(table, "soft_after_repeats"), 0) << kind.name;
  }
}

// Nowhere at all to go: the walls' faces meet and pass each other, in walls as thick as the body.
TEST(Squeeze, between_walls_that_meet_it_stays_in_the_middle_and_comes_back) {
  for (const Squeezed& kind : shapes())
    for (const double least : {0.001, -0.05, -0.1}) {
      Press press(kind.shape, least);
      press.world.advance(1.9);
      EXPECT_NEAR(press.x(), 0.5 * least, 1e-4) << kind.name << " at " << least;
      press.world.advance(3);
      EXPECT_GT(press.x(), 0.5 * width - 1e-3) << kind.name << " from " << least;
      EXPECT_LT(press.x(), 0.4) << kind.name << " from " << least;
    }
}

}  // namespace
}  // namespace tw::test
