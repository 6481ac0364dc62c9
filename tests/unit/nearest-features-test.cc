// Signed distance by climbing against the separating axis test and GJK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/nearest-features.h"

#include <gtest/gtest.h>

#include "collision/distance/axis-climb.h"
#include "collision/distance/gjk.h"
#include "collision/distance/part-pairs.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

// What the full search says.
double searched_distance(const CorePair& cores) {
  const CoreDistance core = core_distance(cores.a, cores.b, cores.b_in_a, nullptr);
  return core.overlap ? least_axis(cores.a, cores.b, cores.b_in_a, 0).distance : core.distance;
}

Separation part_zero(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b,
                     const Frame& frame_b) {
  return part_separation(a->parts()[0], frame_a, b->parts()[0], frame_b, nullptr);
}

// b thrown at a along a straight line until it is `depth` deep: faces, edges and vertices meet as
// they do in free flight.  `aligned`: a face of b is first turned against one of a, up to 1e-16 ..
// 1e-2 rad.
struct Throw {
  Frame frame_a, frame_b;

  Throw(Engine& random, const ShapePtr& a, const ShapePtr& b, double depth, bool aligned) {
    for (bool hit = false; !hit;) {
      frame_a = random_frame(random, 1);
      frame_b = random_frame(random, 1);
      const Vec3 along = random_direction(random);
      frame_b.p = frame_a.p - 5 * along;
      if (aligned) turn_face_against(random, *a->parts()[0].core, *b->parts()[0].core);
      for (int i = 0; i < 60 && !hit; ++i) {
        const Separation s = part_zero(a, frame_a, b, frame_b);
        const double speed = -s.normal.dot(along);
        if (speed < 1e-3) break;
        hit = s.distance < 1e-9;
        frame_b.p += (s.distance / speed) * along;
      }
    }
    frame_b.p -= depth * part_zero(a, frame_a, b, frame_b).normal;
  }
  void turn_face_against(Engine& random, const Polyhedron& a, const Polyhedron& b) {
    int face = 0;
    a.face_separation(frame_a.to_local(frame_b.p), face);
    const Vec3 n = frame_a.R * a.face(face).normal;
    const Vec3 m = frame_b.R * b.faces()[random() % b.faces().size()].normal;
    frame_b.R = Quat::FromTwoVectors(m, -n).normalized().toRotationMatrix() * Mat3(frame_b.R);
    const double tilt = std::pow(10, uniform(random, -16, -2));
    frame_b.R = rotation_by(tilt * random_direction(random)).toRotationMatrix() * Mat3(frame_b.R);
  }
};

TEST(NearestFeatures, distance_equals_that_of_the_full_search_on_1e5_shallow_poses) {
  Engine random(1);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  int overlaps = 0;
  int rough = 0;
  for (int round = 0; round < 1000; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const double depth = (random() % 4 == 0 ? -1 : 1) * std::pow(10, uniform(random, -9, -2));
        const Throw pose(random, a, b, depth, random() % 2 == 0);
        const CorePair cores(a->parts()[0], pose.frame_a, b->parts()[0], pose.frame_b);
        const NearestFeatures near = nearest_features(cores.a, cores.b, cores.b_in_a, 1);
        const double error = std::abs(near.distance - searched_distance(cores));
        // nearly parallel edges at touch: GJK ends a little early
        ASSERT_LT(error, 2e-10) << near.distance;
        rough += error > 4e-14 ? 1 : 0;
        overlaps += near.distance < 0 ? 1 : 0;
        // the witnesses span the distance
        ASSERT_NEAR(near.normal.dot(near.point_b - near.point_a), near.distance, 1e-11);
      }
  EXPECT_GT(overlaps, 60000);
  EXPECT_LT(rough, 30);
}

TEST(NearestFeatures, most_shallow_contacts_are_proven_without_a_search) {
  Engine random(2);
  int proven = 0;
  const int poses = 1000;
  for (int i = 0; i < poses; ++i) {
    const ShapePtr a = random_rock(random, 16, {0.4, 0.3, 0.3});
    const ShapePtr b = random_rock(random, 16, {0.3, 0.4, 0.2});
    const Throw pose(random, a, b, 1e-4, false);
    const CorePair cores(a->parts()[0], pose.frame_a, b->parts()[0], pose.frame_b);
    proven += climb_to_axis(cores.a, cores.b, cores.b_in_a).end == ClimbEnd::proven ? 1 : 0;
  }
  EXPECT_GT(proven, 970);
}

TEST(NearestFeatures, deep_overlaps_are_answered_as_by_the_full_search) {
  Engine random(3);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (int round = 0; round < 50; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 0.3);
        const Frame frame_b = random_frame(random, 0.3);
        const CorePair cores(a->parts()[0], frame_a, b->parts()[0], frame_b);
        ASSERT_NEAR(nearest_features(cores.a, cores.b, cores.b_in_a, 10).distance,
                    searched_distance(cores), 1e-14);
      }
}

TEST(NearestFeatures, beyond_the_reach_the_distance_is_a_lower_bound_above_it) {
  Engine random(4);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  int far = 0;
  for (int round = 0; round < 20; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 1);
        const Frame frame_b = random_frame(random, 1);
        const CorePair cores(a->parts()[0], frame_a, b->parts()[0], frame_b);
        const double truth = searched_distance(cores);
        const double found = nearest_features(cores.a, cores.b, cores.b_in_a, 0.1).distance;
        ASSERT_EQ(found > 0.1, truth > 0.1);
        ASSERT_LE(found, truth + 1e-14);
        far += truth > 0.1 ? 1 : 0;
      }
  EXPECT_GT(far, 500);
}

}  // namespace
}  // namespace tw::test
