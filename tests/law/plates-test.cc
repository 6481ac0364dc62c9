// Plates that meet at their inner edges alone: a trough with nothing beneath its bottom edge.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/scene.h"
#include "support/stability.h"

namespace tw::test {
namespace {

struct Mover {
  const char* name;
  ShapePtr shape;
  std::vector<Vec3> points;  // of its surface, that must stay over the plates
  double size;               // least width, m
  Quat tip_down = Quat::Identity();
};

Mover hull_mover(const char* name, double half, double size) {
  const std::vector<Vec3> corners = {
      {0, 0, -0.1}, {half, 0, 0.1}, {-half, half, 0.1}, {-half, -half, 0.1}};
  return {name, make_hull(corners), corners, size};
}

// The bottom edge is the y axis; the plates overlap there by so much along each.
void add_trough(World& world, double tilt, double overlap, bool one_union) {
  std::vector<ShapePtr> parts;
  for (const double side : {-1.0, 1.0}) {
    BodyDef plate;
    plate.shape = make_box({1, 2, 0.1});
    plate.orientation = rotation_by(Vec3(0, -side * tilt, 0));
    plate.position = plate.orientation * Vec3(side * (0.5 - overlap), 0, -0.05);
    plate.fixed = true;
    parts.push_back(place_shape(plate.shape, {plate.position, plate.orientation}));
    if (!one_union) world.add_body(plate);
  }
  if (!one_union) return;
  BodyDef trough;
  trough.shape = make_union(parts);
  trough.fixed = true;
  world.add_body(trough);
}

// Tips fall into it at all attitudes: they stay over both plates, no energy comes of it.
TEST(Plates, hold_tips_over_the_edge_where_they_meet) {
  const Mover movers[] = {
      hull_mover("tetrahedron", 0.1, 0.1),
      hull_mover("needle", 0.01, 0.01),
      {"cone", make_cone(0.05, 0.2), {{0, 0, 0.15}}, 0.1, rotation_by(Vec3(pi, 0, 0))}};
  Random random(5);
  for (const Mover& mover : movers)
    for (const double tilt : {0.35, 0.25 * pi, 1.1})
      for (const double overlap : {-1e-6, 0.0, 1e-5})
        for (const bool one_union : {false, true}) {
          World world;
          set_contact_for_all(world, 0, random.real(0, 1));
          add_trough(world, tilt, overlap, one_union);
          BodyDef def;
          def.shape = mover.shape;
          const Vec3 lean(random.real(-0.4, 0.4), random.real(-0.4, 0.4), random.real(-3, 3));
          def.orientation = rotation_by(lean) * mover.tip_down;
          def.position = Vec3(random.real(-0.02, 0.02), random.real(-0.5, 0.5), 0.35);
          def.velocity = Vec3(random.real(-0.3, 0.3), random.real(-0.2, 0.2), 0);
          const BodyId id = world.add_body(def);
          const double start = world.total_energy(), scale = world.body(id).mass * 9.81 * 0.35;
          for (int k = 1; k <= 60; ++k) {
            world.advance(0.02 * k);
            EXPECT_LT(world.total_energy(), start + 1e-3 * scale) << mover.name;
            const BodyState state = world.state(id);
            double least = 0;
            for (const double side : {-1.0, 1.0})
              for (const Vec3& point : mover.points) {
                const Vec3 normal(-side * std::sin(tilt), 0, std::cos(tilt));
                least = std::min(least, normal.dot(state.position + state.orientation * point));
              }
            ASSERT_GT(least, -0.02 * mover.size - std::abs(overlap))
                << mover.name << " tilt " << tilt << " overlap " << overlap << " at "
                << world.time();
          }
        }
}

// Round bodies fall over the ends of the plates, where they are held by the plates' end edges:
// these go on beneath the other plate.
TEST(Plates, hold_round_bodies_over_their_ends) {
  Random random(8);
  const auto fall = [](double tilt, const ShapePtr& shape, const Vec3& place,
                       const Quat& attitude) {
    World world;
    add_trough(world, tilt, 0, false);
    BodyDef def;
    def.shape = shape;
    def.position = place;
    def.orientation = attitude;
    world.add_body(def);
    const double start = world.total_energy();
    for (int k = 1; k <= 160; ++k) {
      world.advance(0.01 * k);
      ASSERT_LT(world.total_energy(), start + 1e-6);
      StabilityOutcome outcome;
      measure_depths(world, outcome);
      ASSERT_LT(outcome.deepest, 2e-3)
          << shape->kind_name() << " at tilt " << tilt << " and " << world.time();
    }
  };
  // one that went 4 cm deep, and gained 2000 times its energy
  fall(0.5, make_cylinder(0.1, 0.15), {0.077088766728117, 0.918171188559892, 0.45},
       Quat(0.4643850824118429, -0.45605745773643724, 0.7402892360590331, 0.16831499473147643));
  for (int i = 0; i < 60; ++i) {
    const double length = random.real(0.05, 0.35);
    const ShapePtr shape = i % 3 == 0   ? make_cylinder(random.real(0.03, 0.13), length)
                           : i % 3 == 1 ? make_cone(0.1, length)
                                        : make_capsule(random.real(0.01, 0.06), length);
    fall(random.real(0.15, 1.25), shape,
         {random.real(-0.05, 0.05), (i % 2 == 0 ? 1 : -1) * random.real(0.9, 1.05), 0.7},
         random_attitude(random));
  }
}

// Each plate runs on beyond the bottom edge, buried in the other: its end face there is no slope. A
// third of the cones met it millimetres deep, and some stopped dead.
TEST(Plates, that_run_on_in_each_other_have_no_ends_there) {
  Random random(9);
  for (int i = 0; i < 40; ++i) {
    World world;
    set_contact_for_all(world, 0, 0);
    add_trough(world, 0.2, 0.02, i % 2 == 0);
    BodyDef def;
    def.shape = i % 4 < 3 ? make_cone(0.06, 0.12) : make_cylinder(0.06, 0.12);
    def.position = {random.real(-0.2, 0.2), random.real(-0.4, 0.4), 0.2};
    def.orientation = random_attitude(random);
    def.velocity = {random.real(-0.5, 0.5), random.real(-0.2, 0.2), 0};
    def.angular_velocity = random_vector(random, 3);
    world.add_body(def);
    for (int k = 1; k <= 100; ++k) {
      world.advance(0.02 * k);
      // as the contacts have it, which no true distance is
      for (const ContactReading& contact : world.survey_contacts(world.time()).contacts)
        ASSERT_GT(contact.gap, -4e-4) << i;
    }
  }
}

}  // namespace
}  // namespace tw::test
