// Fixed plates that cross at their rims, as those of a hopper: what touches two of them is carried
// by both.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "collision/distance/separation.h"
#include "collision/seams/seams.h"
#include "convex-oracles.h"
#include "seam-ground.h"

namespace tw::test {
namespace {

constexpr double hole = 0.35, lip_height = 1.2, steep = 0.96;
const ShapePtr grain = make_box({0.15, 0.15, 0.15});

// Two plates, 55 degrees steep, with level lips along y and x that cross at (-hole, -hole,
// lip_height): the lip of each ends inside the other.
Ground rims() {
  Ground ground;
  for (const double quarter : {2.0, 3.0}) {
    const Mat3 turn = rotation_by(Vec3(0, 0, quarter * pi / 2)).toRotationMatrix();
    const Mat3 turned = turn * rotation_by(Vec3(0, -steep, 0)).toRotationMatrix();
    ground.add(make_box({2, 3.4, 0.06}),
               Frame(turned, turned * Vec3(1, 0, -0.03) + turn * Vec3(hole, 0, lip_height)));
  }
  return ground;
}

// What is nearest, and with which plate.
struct Nearest : Separation {
  std::size_t plate = 0;
};

Nearest nearest(const Ground& ground, const Frame& frame) {
  Nearest least;
  least.distance = 1e300;
  for (std::size_t i = 0; i < ground.shapes.size(); ++i) {
    const Separation s = separation(*ground.shapes[i], ground.frames[i], *grain, frame);
    if (s.distance < least.distance) least = {s, i};
  }
  return least;
}

// Moves on until something is 1e-7 m away; false where nothing is within the length.
bool touches(const Ground& ground, const Vec3& direction, double length, Frame& frame,
             Nearest& touch) {
  while (length > 0) {
    touch = nearest(ground, frame);
    if (touch.distance < 1e-7) return touch.distance > 0;
    const double step = 0.9 * touch.distance;
    frame.p += step * direction;
    length -= step;
  }
  return false;
}

// Whether the plate presses against the grain.
bool presses(const Ground& ground, std::size_t plate, const Frame& frame, const Vec3& normal,
             double depth) {
  Points points;
  manifold_at_seams(*ground.shapes[plate], ground.frames[plate], ground.around(plate), *grain,
                    frame, {}, 0, grain->least_width(), points, ReferenceChoice::of_a);
  for (const ManifoldPoint& p : points) {
    const Vec3 up = p.reference_is_a ? p.normal : Vec3(-p.normal);
    if (p.gap < -0.2 * depth && up.dot(normal) > 0.5) return true;
  }
  return false;
}

TEST(CrossingRims, a_grain_in_the_corner_is_carried_by_both_lips) {
  // the edges of least depth cross where each lip is buried in the other plate
  const Pose poses[] = {
      {{-0.29331124377393103, -0.30636854979241235, 1.3022132838625853},
       {0.35049630467907683, 0.62513876580647521, -0.45741981923055175, -0.52642280808049935}},
      {{-0.28819398147720033, -0.32151290966197238, 1.2990120005452073},
       {-0.30343511748021484, -0.58094816490507606, 0.65399974154872731, -0.37777069397637325}}};
  const Ground ground = rims();
  for (const Pose& pose : poses) {
    const Frame frame(Pose{pose.p, pose.q.normalized()});
    EXPECT_TRUE(presses(ground, 0, frame, Vec3::UnitX(), 0.9e-3));
    EXPECT_TRUE(presses(ground, 1, frame, Vec3::UnitY(), 0.9e-3));
  }
}

TEST(CrossingRims, what_touches_two_plates_is_carried_by_both) {
  const Ground ground = rims();
  Engine random(3);
  constexpr double depth = 1e-3;
  int both = 0, lost = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 from(uniform(random, 0.05, 1), uniform(random, 0.05, 1), uniform(random, 0.05, 1));
    const Vec3 corner(uniform(random, -0.45, -0.3), uniform(random, -0.45, -0.3),
                      uniform(random, 1.18, 1.3));
    Frame frame(Pose{corner + 0.6 * from.normalized(), random_rotation(random)});
    const Vec3 along = random_direction(random);
    Nearest first, second;
    if (!touches(ground, -from.normalized(), 0.7, frame, first)) continue;
    // a little off, and along the first plate until the second one is met
    frame.p += 5e-5 * first.normal;
    const Vec3 slide = (along - along.dot(first.normal) * first.normal).normalized();
    if (!touches(ground, slide, 0.3, frame, second) || second.plate == first.plate) continue;
    const std::size_t plate = first.plate;
    const Separation still = separation(*ground.shapes[plate], ground.frames[plate], *grain, frame);
    if (still.distance > 0.2 * depth || still.normal.dot(first.normal) < 0.99) continue;
    // into both
    const double cosine = first.normal.dot(second.normal);
    frame.p -= (depth + still.distance) / (1 + cosine) * (first.normal + second.normal);
    ++both;
    lost += presses(ground, first.plate, frame, first.normal, depth) ? 0 : 1;
    lost += presses(ground, second.plate, frame, second.normal, depth) ? 0 : 1;
  }
  EXPECT_GT(both, 60);
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace tw::test
