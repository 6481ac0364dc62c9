// Drag, springs, torques and forces by procedures under adversary schedulers, in pieces, with every
// discontinuity taken back once: one history.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "determinism/compare-schedules.h"
#include "integrate/given/keyframes.h"
#include "support/callback-scenes.h"

namespace tw::test {
namespace {

// A swirl about the z axis that changes with time.
class Swirl final : public ForceProcedure {
 public:
  std::uint64_t number() const override { return 7; }
  Wrench force(double time, const BodyState& body) override {
    const Vec3 across = Vec3::UnitZ().cross(body.position);
    return {40 * std::sin(3 * time) * across - 5 * body.velocity, Vec3(0, 0, 0.5)};
  }
};

// Boxes and balls in a room, in the air and on the floor: every kind of force, impacts between
// driven and flying bodies, contact groups of driven bodies, a mover that shakes springs, callbacks
// that set torques.
void fill_driven_room(World& world) {
  Random random(5);
  add_walls(world, -1.2, 1.2);
  BodyDef shaker;
  shaker.shape = make_sphere(0.05);
  shaker.position = {0, 0, 1};
  shaker.motion = make_keyframes(
      {{0, {0, 0, 1.1}, {}}, {0.4, {0.3, 0, 1.0}, {}}, {0.8, {-0.3, 0.2, 1.1}, {}}}, true);
  const BodyId anchor = world.add_body(shaker);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 12; ++i) {
    const Vec3 place(0.7 * (i % 3) - 0.7, 0.7 * (i / 3 % 2) - 0.35, 0.75 * (i / 6) - 0.7);
    const Vec3 velocity = random_vector(random, 1), turn = random_vector(random, 3);
    BodyDef def =
        body_of(i % 2 ? make_sphere(0.15) : make_box({0.2, 0.25, 0.3}), place, velocity, turn);
    def.density = 300;
    bodies.push_back(world.add_body(def));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i % 3 == 0) world.add_drag(bodies[i], 2, 1);
    if (i % 4 == 1) {
      SpringDef spring;
      spring.a = bodies[i];
      spring.at_a = {0.05, 0.1, 0};
      spring.b = i % 8 == 1 ? anchor : 0;
      spring.at_b = i % 8 == 1 ? Vec3(0, 0, 0) : Vec3(0, 0, 0.5);
      spring.stiffness = 60;
      spring.damping = 1;
      world.add_spring(spring);
    }
    if (i == 2 || i == 7) world.add_force(bodies[i], std::make_shared<Swirl>());
  }
  add_callback(world, {bodies[0], bodies[6]}, 0.05, 0.13,
               [](double, std::span<StateView* const> targets) {
                 for (StateView* view : targets)
                   view->set_applied_torque(0.4 * view->state().velocity);
                 return std::nullopt;
               });
}

TEST(ForceSchedules, forces_of_every_kind_in_a_room) {
  Schedule pieces, undo, check;
  pieces.pieces = 7;
  undo.undo_redo = true;
  check.check = true;
  check.adversary = adversary_schedule(3).adversary;
  expect_one_history({"driven room, other ways", 1.2, fill_driven_room}, {pieces, undo, check}, 4);
  const Tally tally =
      expect_one_history({"driven room", 1.2, fill_driven_room}, adversaries(12), 4);
  EXPECT_GT(tally.rollbacks, 12u);
}

}  // namespace
}  // namespace tw::test
