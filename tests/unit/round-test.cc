// Cylinders, cones, capsules, ellipsoids: mass, bounds, and signed distance proven by its own
// witnesses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "collision/distance/ellipsoid-point.h"
#include "collision/distance/frustum-point.h"
#include "collision/distance/round-distance.h"
#include "collision/distance/separation.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

SupportCore placed(const ShapePtr& shape, const Frame& frame) {
  const ConvexPart& part = shape->parts()[0];
  return SupportCore(part, part.in(frame));
}

Separation parts(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b, const Frame& frame_b) {
  return part_separation(a->parts()[0], frame_a, b->parts()[0], frame_b, nullptr);
}

std::vector<ShapePtr> round_zoo() {
  return {make_cylinder(0.5, 1),
          make_cylinder(0.5, 0.05),
          make_cylinder(0.03, 1.5),
          make_capsule(0.2, 1),
          make_capsule(0.4, 0.05),
          make_cone(0.5, 1),
          make_cone(0.6, 0.1),
          make_cone(0.05, 1),
          make_ellipsoid({0.5, 0.3, 0.2}),
          make_ellipsoid({0.6, 0.6, 0.06}),
          make_ellipsoid({0.05, 0.05, 0.8})};
}

double margins(const ShapePtr& a, const ShapePtr& b) {
  return a->parts()[0].margin + b->parts()[0].margin;
}

// s(n) of the shapes, margins counted.
double slab(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b, const Frame& frame_b,
            const Vec3& n) {
  return distance_along(placed(a, frame_a), placed(b, frame_b), n) - margins(a, b);
}

// How far the point lies outside a core: positive outside.
double outside(const ShapePtr& shape, const Frame& frame, const Vec3& point) {
  const ConvexPart& part = shape->parts()[0];
  const Vec3 local = part.in(frame).to_local(point);
  if (part.kind == PartKind::frustum) return nearest_on_frustum(part, local).distance;
  if (part.kind == PartKind::ellipsoid) return nearest_on_ellipsoid(part.semi_axes, local).distance;
  int face = 0;
  return part.core->face_separation(local, face);
}

TEST(Cylinder, mass_is_that_of_the_closed_form_and_of_a_fine_prism) {
  const MassProperties m = make_cylinder(0.5, 2)->mass_properties();
  EXPECT_DOUBLE_EQ(m.volume, 0.5 * pi);
  EXPECT_DOUBLE_EQ(m.inertia(2, 2), m.volume * 0.125);
  EXPECT_DOUBLE_EQ(m.inertia(0, 0), m.volume * (0.75 + 4) / 12);
  EXPECT_EQ(m.centroid, Vec3::Zero());
  const MassProperties fine = prism(720, 0.5, 1)->mass_properties();
  EXPECT_NEAR((m.inertia - fine.inertia).norm(), 0, 1e-4 * m.inertia.norm());
}

// A hull of points all over the surface.
ShapePtr fine_hull(const ShapePtr& shape) {
  const ConvexPart& part = shape->parts()[0];
  const SupportCore core(part, part.placement());
  std::vector<Vec3> points;
  constexpr int rings = 60, around = 60;
  for (int i = 0; i <= rings; ++i)
    for (int k = 0; k < around; ++k) {
      const double up = pi * (i / double(rings) - 0.5), angle = 2 * pi * k / around;
      const Vec3 n(std::cos(up) * std::cos(angle), std::cos(up) * std::sin(angle), std::sin(up));
      const bool smooth = part.kind == PartKind::ellipsoid;
      points.push_back(smooth ? Vec3(part.semi_axes.cwiseProduct(n))
                              : Vec3(core.support(n) + part.margin * n));
    }
  return make_hull(points);
}

TEST(Round, mass_is_that_of_a_fine_hull) {
  for (const ShapePtr& shape : round_zoo()) {
    const MassProperties exact = shape->mass_properties();
    const MassProperties fine = fine_hull(shape)->mass_properties();
    EXPECT_NEAR(fine.volume, exact.volume, 0.02 * exact.volume) << shape->kind_name();
    EXPECT_NEAR((fine.centroid - exact.centroid).norm(), 0, 0.01 * shape->radius_about_origin());
    EXPECT_LT((fine.inertia - exact.inertia).norm(), 0.03 * exact.inertia.norm())
        << shape->kind_name();
  }
  // to all digits: of a ball, and of a cone that is a quarter of a cylinder's volume above it
  EXPECT_NEAR(make_ellipsoid({1, 1, 1})->mass_properties().inertia(1, 1),
              make_sphere(1)->mass_properties().inertia(1, 1), 1e-15);
  EXPECT_DOUBLE_EQ(make_cone(2, 3)->mass_properties().volume, 4 * pi);
  EXPECT_DOUBLE_EQ(make_capsule(1, 3)->mass_properties().volume, (3 + 4.0 / 3) * pi);
}

TEST(Round, bounds_and_radii_hold_the_surface_and_no_more) {
  Engine random(11);
  for (const ShapePtr& shape : round_zoo())
    for (int i = 0; i < 10; ++i) {
      const Pose pose{random_vector(random, 1), random_rotation(random)};
      const ShapePtr moved = place_shape(shape, pose);
      const ConvexPart& part = moved->parts()[0];
      const SupportCore core(part, part.placement());
      const Vec3 line = random_direction(random);
      const Aabb box = moved->bounds(Frame());
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
          const Vec3 n = sign * Vec3::Unit(axis);
          EXPECT_NEAR((core.support(n) + part.margin * n)[axis],
                      sign > 0 ? box.hi[axis] : box.lo[axis], 1e-14);
        }
      for (int k = 0; k < 2000; ++k) {
        const Vec3 n = random_direction(random), x = core.support(n) + part.margin * n;
        EXPECT_LE(x.norm(), moved->radius_about_origin() * (1 + 1e-14));
        EXPECT_LE(x.cross(line).norm(), moved->radius_about_line(line) * (1 + 1e-14));
        EXPECT_LE((x - part.bound_center).norm(), part.bound_radius * (1 + 1e-14));
      }
    }
}

TEST(Round, the_nearest_point_of_an_ellipsoid_is_on_it_and_none_is_nearer) {
  Engine random(12);
  for (int i = 0; i < 20000; ++i) {
    const auto length = [&] { return std::pow(10, uniform(random, -1.5, 1.5)); };
    Vec3 s(length(), length(), length());
    Vec3 y = length() * random_vector(random, 1).cwiseProduct(s);
    if (i % 5 == 0) y[i % 3] = 0;
    if (i % 7 == 0) y[i % 3] = y[(i + 1) % 3] = 0;
    if (i % 11 == 0) s[1] = s[0];
    const NearestOnEllipsoid near = nearest_on_ellipsoid(s, y);
    const double size = s.maxCoeff() + y.norm();
    ASSERT_NEAR(near.normal.norm(), 1, 1e-14);
    ASSERT_NEAR((near.point.cwiseQuotient(s).norm() - 1) * near.point.norm(), 0, 1e-12 * size);
    ASSERT_EQ(near.distance < 0, y.cwiseQuotient(s).norm() < 1);
    for (int k = 0; k < 10; ++k) {
      const Vec3 other =
          (near.point.cwiseQuotient(s) + (k % 2 ? 1e-3 : 2.0) * random_vector(random, 1))
              .normalized()
              .cwiseProduct(s);
      ASSERT_GE((other - y).norm(), std::abs(near.distance) - 1e-13 * size);
    }
  }
}

TEST(Cylinder, bounds_and_radius_are_those_of_its_rims) {
  Engine random(1);
  const ShapePtr shape = make_cylinder(0.3, 0.8);
  EXPECT_DOUBLE_EQ(shape->least_width(), 0.6);
  EXPECT_DOUBLE_EQ(shape->radius_about_origin(), 0.5);
  for (int i = 0; i < 50; ++i) {
    const Pose pose{random_vector(random, 1), random_rotation(random)};
    const ShapePtr moved = place_shape(shape, pose);
    const Frame frame(pose);
    Aabb rims;
    double farthest = 0;
    for (int k = 0; k < 4000; ++k) {
      const double angle = 2 * pi * k / 4000;
      for (double z : {-0.4, 0.4}) {
        const Vec3 x = frame * Vec3(0.3 * std::cos(angle), 0.3 * std::sin(angle), z);
        rims.add(x);
        farthest = std::max(farthest, x.norm());
      }
    }
    EXPECT_NEAR((moved->bounds(Frame()).lo - rims.lo).norm(), 0, 1e-6);
    EXPECT_NEAR((moved->bounds(Frame()).hi - rims.hi).norm(), 0, 1e-6);
    EXPECT_NEAR(moved->radius_about_origin(), farthest, 1e-6);
    EXPECT_GE(moved->radius_about_origin(), farthest);
  }
}

TEST(Cylinder, refuses_lengths_that_are_not_positive) {
  EXPECT_THROW(make_cylinder(0, 1), UserError);
  EXPECT_THROW(make_cylinder(1, -1), UserError);
  EXPECT_THROW(make_cylinder(std::nan(""), 1), UserError);
  EXPECT_EQ(make_cylinder(1, 1)->kind_name(), "cylinder");
}

TEST(Cylinder, distance_to_a_ball_and_a_half_space_is_the_closed_form) {
  const ShapePtr cylinder = make_cylinder(0.5, 2);
  const ShapePtr ball = make_sphere(0.1);
  const auto at = [](double x, double y, double z) { return Frame(Mat3::Identity(), {x, y, z}); };
  EXPECT_DOUBLE_EQ(parts(cylinder, Frame(), ball, at(0.8, 0, 0.3)).distance, 0.2);
  EXPECT_DOUBLE_EQ(parts(ball, at(0, -0.8, 0.3), cylinder, Frame()).distance, 0.2);
  EXPECT_DOUBLE_EQ(parts(cylinder, Frame(), ball, at(0.2, 0, 1.3)).distance, 0.2);
  EXPECT_DOUBLE_EQ(parts(cylinder, Frame(), ball, at(0.5 + 0.3, 0, 1 + 0.4)).distance, 0.4);
  EXPECT_DOUBLE_EQ(parts(cylinder, Frame(), ball, at(0.45, 0, 0)).distance, -0.15);
  const ShapePtr half_space = make_half_space({0, 0, 1}, 0);
  EXPECT_DOUBLE_EQ(parts(half_space, Frame(), cylinder, at(0, 0, 1.25)).distance, 0.25);
  Frame lying(rotation_by({pi / 2, 0, 0}).toRotationMatrix(), {0, 0, 0.7});
  EXPECT_NEAR(parts(cylinder, lying, half_space, Frame()).distance, 0.2, 1e-15);
  Frame tilted(rotation_by({0.3, 0, 0}).toRotationMatrix(), {0, 0, 0});
  EXPECT_NEAR(parts(half_space, Frame(), cylinder, tilted).distance,
              -(std::cos(0.3) + 0.5 * std::sin(0.3)), 1e-15);
}

// Distances above zero are proven: two points of the bodies are so far apart, and a slab of that
// width separates them.
TEST(Round, distance_is_proven_by_a_slab_and_two_points) {
  Engine random(2);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  int cases = 0;
  double worst = 0;
  for (int round = 0; round < 60; ++round)
    for (const ShapePtr& a : round_zoo()) {
      for (const ShapePtr& b : round_zoo()) zoo.push_back(b);
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 1);
        Frame frame_b = random_frame(random, 1);
        frame_b.p = frame_a.p + 4 * random_direction(random);
        const Separation far = parts(a, frame_a, b, frame_b);
        frame_b.p -= (far.distance - std::pow(10, uniform(random, -6, -1))) * far.normal;
        const Separation s = parts(a, frame_a, b, frame_b);
        if (s.distance <= 0) continue;
        const double width = slab(a, frame_a, b, frame_b, s.normal.normalized());
        ASSERT_NEAR(width, s.distance, 1e-11) << a->kind_name() << " " << b->kind_name();
        ASSERT_NEAR((s.point_b - s.point_a).norm(), s.distance, 1e-11);

        const auto is_egg = [](const ShapePtr& x) { return x->kind_name() == "ellipsoid"; };
        const double allowed = is_egg(a) || is_egg(b) ? 1e-8 : 1e-11;
        ASSERT_LT(outside(a, frame_a, s.point_a), allowed)
            << a->kind_name() << " " << b->kind_name();
        ASSERT_LT(outside(b, frame_b, s.point_b), allowed)
            << a->kind_name() << " " << b->kind_name();
        worst = std::max(worst, std::abs(width - s.distance));
        ++cases;
      }
      zoo.resize(10);
    }
  EXPECT_GT(cases, 10000);
  RecordProperty("worst_slab", std::to_string(worst));
}

// The rim of a disc in the face of a wide plate, to rounding: no more is known of a direction than
// that they touch, and both centres lie in nearly one plane.
TEST(Cylinder, a_rim_that_touches_a_wide_face_to_rounding_is_not_deep) {
  Engine random(7);
  const Vec3 edges(953.4171115238494, 572.0502669143095, 9.534171115238493);
  const ShapePtr plate = make_box(edges), disc = make_cylinder(46.8765404984617, 17.33209996074106);
  const Frame on(Pose{{-424.0948451486165, 0, 65.11248423879162},
                      Quat(0.9966622115176161, 0, 0.0816359977755808, 0)});
  const Vec3 up = on.R.col(2);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 x(-111.28631381140133, -113.56932216404056, 28.0430116924613);
    const Quat q(0.9898350000669067, -0.001740050856522191, 0.07596562510236635,
                 -0.12022008429696898);
    Quat near(q.coeffs() + 1e-15 * Eigen::Vector4d(uniform(random, -1, 1), uniform(random, -1, 1),
                                                   uniform(random, -1, 1), uniform(random, -1, 1)));
    const Frame frame(Pose{x + 4e-14 * random_vector(random, 1), near.normalized()});
    const double along = frame.R.col(2).dot(up), half = disc->parts()[0].half_length;
    const double low = up.dot(frame.p - on.p) - 0.5 * edges.z() - half * along -
                       disc->parts()[0].radius * std::sqrt(1 - along * along);
    worst = std::max(worst, std::abs(parts(plate, on, disc, frame).distance - low));
  }
  EXPECT_LT(worst, 1e-11);
}

// No axis of many separates by less than the depth.
TEST(Round, depth_is_the_least_of_many_axes_and_that_of_its_own) {
  Engine random(3);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  int overlaps = 0;
  for (int round = 0; round < 6; ++round)
    for (const ShapePtr& a : round_zoo()) {
      for (const ShapePtr& b : round_zoo()) zoo.push_back(b);
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 1);
        Frame frame_b = random_frame(random, 1);
        frame_b.p = frame_a.p + 4 * random_direction(random);
        const Separation far = parts(a, frame_a, b, frame_b);
        const bool shallow = random() % 3 != 0;
        frame_b.p -=
            (far.distance + std::pow(10, uniform(random, -9, shallow ? -3 : -1))) * far.normal;
        const Separation s = parts(a, frame_a, b, frame_b);
        if (s.distance > 0) continue;
        ++overlaps;
        const auto along = [&](const Vec3& n) { return slab(a, frame_a, b, frame_b, n); };
        ASSERT_NEAR(along(s.normal), s.distance, margins(a, b) > 0 ? 1e-12 : 1e-14)
            << a->kind_name() << " " << b->kind_name();
        ASSERT_LT(std::abs(outside(a, frame_a, s.point_a)), 1e-5);
        // climbing from there and from random axes finds nothing better
        double best = s.distance;
        for (int start = 0; start < 20; ++start) {
          Vec3 n = start == 0 ? s.normal : random_direction(random);
          double here = along(n);
          for (double step = 0.3; step > 1e-9; step *= 0.8)
            for (int k = 0; k < 8; ++k) {
              const Vec3 m = (n + step * random_direction(random)).normalized();
              const double there = along(m);
              if (there > here) {
                here = there;
                n = m;
              }
            }
          best = std::max(best, here);
        }
        ASSERT_LE(best, s.distance + 1e-11) << a->kind_name() << " " << b->kind_name();
      }
      zoo.resize(10);
    }
  EXPECT_GT(overlaps, 700);
}

// Thin discs, cones and ellipsoids, tips and rims, moved into exact touch with each other and with
// boxes: the witness points are on both.  Some were half the size away.
TEST(Round, witnesses_of_thin_ones_in_touch_are_on_both) {
  Engine random(16);
  const auto thin_one = [&]() -> ShapePtr {
    const double thin = std::pow(10, -uniform(random, 0, 3));
    const bool flat = random() % 2 == 0;
    const double radius = 0.5 * (flat ? 1 : thin), length = flat ? thin : 1;
    switch (random() % 4) {
      case 0: return make_box({2 * radius, 1.4 * radius, length});
      case 1: return make_cylinder(radius, length);
      case 2: return make_cone(radius, length);
      default: return make_ellipsoid({radius, 0.7 * radius, 0.5 * length});
    }
  };
  for (int i = 0; i < 4000; ++i) {
    const ShapePtr a = thin_one(), b = thin_one();
    if (a->parts()[0].core && b->parts()[0].core) continue;
    const bool square = i % 2 == 0;
    const Frame frame_a = square ? Frame() : random_frame(random, 1);
    Frame frame_b = frame_a;
    if (square)
      frame_b.R =
          rotation_by(0.5 * pi * Vec3::Unit(static_cast<int>(random() % 3))).toRotationMatrix();
    else
      frame_b.R = random_rotation(random).toRotationMatrix();
    frame_b.p +=
        2 * (square ? Vec3::Unit(static_cast<int>(random() % 3)) : random_direction(random));
    const Separation far = parts(a, frame_a, b, frame_b);
    frame_b.p -= far.distance * far.normal;
    const Separation near = parts(a, frame_a, b, frame_b);
    EXPECT_LT(std::abs(near.distance), 2e-8) << i;
    EXPECT_LT(outside(a, frame_a, near.point_a), 1e-6) << i;
    EXPECT_LT(outside(b, frame_b, near.point_b), 1e-6) << i;
  }
}

TEST(Cylinder, normals_of_faces_caps_and_sides_are_exact) {
  Engine random(4);
  const ShapePtr box = make_box({2, 2, 1});
  const ShapePtr cylinder = make_cylinder(0.3, 0.8);
  for (int i = 0; i < 200; ++i) {
    const double depth = (i % 4 - 1) * std::pow(10, uniform(random, -9, -3));
    const Frame world = random_frame(random, 1);
    const Mat3 spin = rotation_by({0, 0, uniform(random, 0, 6)}).toRotationMatrix();
    // standing, then lying
    const Frame standing(spin, {uniform(random, -0.5, 0.5), 0, 0.5 + 0.4 - depth});
    const Mat3 lie = spin * rotation_by({pi / 2, 0, 0}).toRotationMatrix();
    const Frame lying(lie, {0, uniform(random, -0.5, 0.5), 0.5 + 0.3 - depth});
    for (const Frame& place : {standing, lying}) {
      const Separation s = parts(box, world, cylinder, world * place);
      ASSERT_NEAR(s.distance, -depth, 1e-14);
      ASSERT_NEAR((s.normal - world.R.col(2)).norm(), 0, 1e-14);
    }
  }
}

TEST(Cylinder, symmetric_overlaps_have_the_depth_of_the_nearest_way_out) {
  const ShapePtr can = make_cylinder(0.5, 2);
  const ShapePtr rod = make_cylinder(0.1, 1);
  const ShapePtr box = make_box({2, 2, 2});
  const auto depth = [](const ShapePtr& a, const ShapePtr& b, const Frame& frame_b) {
    const Separation s = parts(a, Frame(), b, frame_b);
    EXPECT_NEAR(distance_along(placed(a, Frame()), placed(b, frame_b), s.normal), s.distance,
                1e-14);
    return -s.distance;
  };
  const auto at = [](double x, double y, double z) { return Frame(Mat3::Identity(), {x, y, z}); };
  const Frame crossed(rotation_by({pi / 2, 0, 0}).toRotationMatrix(), {0, 0, 0});
  // one in the other, about the same axis; then shifted along it, and beside it
  EXPECT_NEAR(depth(can, rod, at(0, 0, 0)), 0.6, 1e-11);
  EXPECT_NEAR(depth(can, rod, at(0, 0, 1.4)), 0.1, 1e-12);
  EXPECT_NEAR(depth(can, rod, at(0.55, 0, 0)), 0.05, 1e-11);
  EXPECT_NEAR(depth(rod, rod, at(0, 0, 0)), 0.2, 1e-11);
  EXPECT_NEAR(depth(rod, rod, crossed), 0.2, 1e-11);
  EXPECT_NEAR(depth(can, rod, crossed), 0.6, 1e-11);
  EXPECT_NEAR(depth(box, rod, at(0, 0, 0)), 1.1, 1e-11);
  EXPECT_NEAR(depth(box, can, crossed), 1.5, 1e-11);
  EXPECT_NEAR(depth(box, rod, at(0.95, 0.2, 0)), 0.15, 1e-11);
  // touching to the last bit
  EXPECT_NEAR(depth(can, rod, at(0.6, 0, 0)), 0, 1e-12);
  EXPECT_NEAR(depth(can, rod, at(0, 0, 1.5)), 0, 1e-12);
  EXPECT_NEAR(depth(box, rod, at(0, 0, 1.5)), 0, 1e-12);
}

}  // namespace
}  // namespace tw::test
