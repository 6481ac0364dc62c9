// Signed distance against feature enumeration, libccd and closed forms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/separation.h"
#include "base/work-count.h"

#include <gtest/gtest.h>

#include "convex-oracles.h"

namespace tw::test {
namespace {

constexpr double size_of_zoo = 2.5;

Separation parts(const ShapePtr& a, const Frame& frame_a, const ShapePtr& b, const Frame& frame_b) {
  return part_separation(a->parts()[0], frame_a, b->parts()[0], frame_b, nullptr);
}

// Frames of a and b at which the distance is `gap` to rounding: b is first put far away, then moved
// along the line of nearest points.  (Moving on by less than the depth of a feature overlaps them.)
struct GapPose {
  Frame frame_a, frame_b;

  GapPose(Engine& random, const ShapePtr& a, const ShapePtr& b, double gap) {
    frame_a = random_frame(random, 1);
    frame_b = random_frame(random, 1);
    frame_b.p = frame_a.p + 4 * random_direction(random);
    const Separation apart = parts(a, frame_a, b, frame_b);
    frame_b.p -= (apart.distance - gap) * apart.normal;
  }
};

template <class Visit>
void for_random_pairs(std::uint64_t seed, int rounds, Visit visit) {
  Engine random(seed);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (int round = 0; round < rounds; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) visit(random, a, b);
}

TEST(Separation, distance_equals_that_of_all_feature_pairs_to_rounding) {
  double worst = 0;
  for_random_pairs(1, 6, [&worst](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    const double gap = std::pow(10, uniform(random, -12, 0));
    const GapPose pose(random, a, b, gap);
    const Separation s = parts(a, pose.frame_a, b, pose.frame_b);
    const WorldFeatures world_a(a->parts()[0], pose.frame_a);
    const WorldFeatures world_b(b->parts()[0], pose.frame_b);
    const double truth = brute_distance(world_a, world_b);
    ASSERT_NEAR(s.distance, truth, 1e-14) << "gap " << gap;
    worst = std::max(worst, std::abs(s.distance - truth));
  });
  RecordProperty("worst_error", std::to_string(worst));
  EXPECT_LT(worst, 4e-15 * size_of_zoo);
}

TEST(Separation, depth_equals_the_least_over_all_axes_to_rounding) {
  double worst = 0;
  for_random_pairs(2, 3, [&worst](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    const bool shallow = uniform(random, 0, 1) < 0.5;
    GapPose pose(random, a, b, -std::pow(10, uniform(random, -9, -2)));
    if (!shallow) pose.frame_b.p = pose.frame_a.p + random_vector(random, 0.3);
    const WorldFeatures world_a(a->parts()[0], pose.frame_a);
    const WorldFeatures world_b(b->parts()[0], pose.frame_b);
    const double truth = brute_axis(world_a, world_b);
    if (truth > 0) return;
    const Separation s = parts(a, pose.frame_a, b, pose.frame_b);
    ASSERT_NEAR(s.distance, truth, 1e-14);
    // the normal is an axis of that depth, and the witnesses lie along it
    ASSERT_NEAR(gap_along(world_a, world_b, s.normal), truth, 1e-12);
    ASSERT_NEAR((s.point_b - s.point_a - s.distance * s.normal).norm(), 0, 1e-11);
    worst = std::max(worst, std::abs(s.distance - truth));
  });
  EXPECT_LT(worst, 4e-15 * size_of_zoo);
}

TEST(Separation, the_distance_alone_has_the_same_bits) {
  for_random_pairs(11, 4, [](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    for (const double gap : {0.3, 1e-6, 1e-12, 0.0, -1e-6, -0.05}) {
      const GapPose pose(random, a, b, gap);
      ASSERT_EQ(signed_distance(*a, pose.frame_a, *b, pose.frame_b),
                separation(*a, pose.frame_a, *b, pose.frame_b).distance)
          << gap;
    }
  });
}

TEST(Separation, sign_agrees_with_libccd_on_thousands_of_poses) {
  int overlaps = 0;
  int poses = 0;
  for_random_pairs(3, 40, [&](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    const Frame frame_a = random_frame(random, 0.5);
    const Frame frame_b = random_frame(random, 0.5);
    const Separation s = parts(a, frame_a, b, frame_b);
    if (std::abs(s.distance) < 1e-9) return;
    const WorldFeatures world_a(a->parts()[0], frame_a);
    const WorldFeatures world_b(b->parts()[0], frame_b);
    ASSERT_EQ(s.distance < 0, CcdOracle::overlap(world_a, world_b)) << s.distance;
    // libccd's depth is some translation that separates, hence at least ours
    const double bound = CcdOracle::depth_bound(world_a, world_b);
    if (s.distance < -1e-6) {
      ASSERT_GE(bound, -s.distance - 1e-7);
    }
    overlaps += s.distance < 0 ? 1 : 0;
    ++poses;
  });
  EXPECT_GT(overlaps, 500);
  EXPECT_GT(poses - overlaps, 500);
}

TEST(Separation, nearly_parallel_faces_and_edges_keep_all_digits) {
  Engine random(13);
  const std::vector<ShapePtr> zoo = {make_box({1, 1, 1}), make_box({2, 1, 0.05}),
                                     prism(6, 0.5, 0.5), prism(40, 0.5, 0.2)};
  for (int round = 0; round < 150; ++round)
    for (const ShapePtr& a : zoo)
      for (const ShapePtr& b : zoo) {
        const Frame frame_a = random_frame(random, 1);
        // aligned up to a tilt of 1e-16 .. 1e-2, perhaps turned by an eighth or a quarter
        const double tilt = std::pow(10, uniform(random, -16, -2));
        const Quat turn = rotation_by(pi / 4 * static_cast<double>(random() % 3) *
                                      Vec3::Unit(static_cast<int>(random() % 3)));
        const double gap = (random() % 3 == 0 ? -1 : 1) * std::pow(10, uniform(random, -15, -1));
        Frame frame_b(frame_a.R * turn.toRotationMatrix() *
                          rotation_by(tilt * random_direction(random)).toRotationMatrix(),
                      frame_a.p + 4 * (frame_a.R * Vec3::Unit(static_cast<int>(random() % 3)) +
                                       0.1 * random_direction(random)));
        const Separation apart = parts(a, frame_a, b, frame_b);
        frame_b.p -= (apart.distance - gap) * apart.normal;
        const Separation s = parts(a, frame_a, b, frame_b);
        const WorldFeatures world_a(a->parts()[0], frame_a);
        const WorldFeatures world_b(b->parts()[0], frame_b);
        ASSERT_NEAR(s.normal.norm(), 1, 1e-14);
        if (s.distance > 1e-14) {
          ASSERT_NEAR(s.distance, brute_distance(world_a, world_b), 1e-14) << tilt << " " << gap;
        } else {
          // not less than any axis tried by brute force, and attained by its own normal
          ASSERT_GE(s.distance, brute_axis(world_a, world_b) - 1e-14) << tilt << " " << gap;
          ASSERT_NEAR(s.distance, gap_along(world_a, world_b, s.normal), 5e-13);
        }
      }
}

TEST(Separation, witness_points_lie_on_both_surfaces_along_the_normal) {
  for_random_pairs(4, 4, [](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    const double gap = std::pow(10, uniform(random, -6, 0));
    const GapPose pose(random, a, b, gap);
    const Separation s = parts(a, pose.frame_a, b, pose.frame_b);
    ASSERT_NEAR(s.normal.norm(), 1, 1e-14);
    ASSERT_NEAR((s.point_b - s.point_a - s.distance * s.normal).norm(), 0, 1e-14);
    int face = 0;
    ASSERT_NEAR(a->parts()[0].core->face_separation(pose.frame_a.to_local(s.point_a), face), 0,
                1e-13);
    ASSERT_NEAR(b->parts()[0].core->face_separation(pose.frame_b.to_local(s.point_b), face), 0,
                1e-13);
  });
}

TEST(Separation, swapping_the_parts_negates_the_normal_and_keeps_the_distance) {
  for_random_pairs(5, 6, [](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    const double sign = uniform(random, 0, 1) < 0.3 ? -1 : 1;
    const double gap = sign * std::pow(10, uniform(random, -13, sign < 0 ? -2.5 : 0.0));
    const GapPose pose(random, a, b, gap);
    const Separation ab = parts(a, pose.frame_a, b, pose.frame_b);
    const Separation ba = parts(b, pose.frame_b, a, pose.frame_a);
    ASSERT_NEAR(ab.distance, ba.distance, 1e-14) << gap;
    // corners of needles and plates nearly tie between axes; where they do, both are right
    const WorldFeatures world_a(a->parts()[0], pose.frame_a);
    const WorldFeatures world_b(b->parts()[0], pose.frame_b);
    const double normals_differ = (ab.normal + ba.normal).norm();
    if (normals_differ > 1e-14 + 4e-15 / std::abs(ab.distance)) {
      ASSERT_NEAR(gap_along(world_a, world_b, ab.normal), gap_along(world_a, world_b, -ba.normal),
                  2e-12)
          << gap;
    }
  });
}

TEST(Separation, a_warm_start_returns_what_a_cold_start_returns) {
  Engine random(6);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (const ShapePtr& a : zoo)
    for (const ShapePtr& b : zoo) {
      SimplexCache cache;
      GapPose pose(random, a, b, 0.05);
      const Vec3 spin = random_vector(random, 0.05);
      const Vec3 drift = random_vector(random, 0.005);
      for (int step = 0; step < 40; ++step) {
        const Separation warm =
            part_separation(a->parts()[0], pose.frame_a, b->parts()[0], pose.frame_b, &cache);
        const Separation cold = parts(a, pose.frame_a, b, pose.frame_b);
        ASSERT_NEAR(warm.distance, cold.distance, 1e-15 * size_of_zoo);
        if (cold.distance < 1e-9) {
          ASSERT_EQ(warm.distance, cold.distance);
          ASSERT_EQ(warm.normal, cold.normal);
          ASSERT_EQ(warm.point_a, cold.point_a);
        }
        pose.frame_b.R = rotation_by(spin).toRotationMatrix() * pose.frame_b.R;
        pose.frame_b.p += drift;
      }
    }
}

TEST(Separation, distance_has_no_jump_on_the_way_through_touch) {
  for_random_pairs(7, 2, [](Engine& random, const ShapePtr& a, const ShapePtr& b) {
    GapPose pose(random, a, b, 1e-7);
    const Vec3 toward =
        parts(a, pose.frame_a, b, pose.frame_b).normal + 0.3 * random_direction(random);
    double last = parts(a, pose.frame_a, b, pose.frame_b).distance;
    // strides from 1e-8 down to 1e-12 and up again, across gaps 1e-7 .. -1e-7
    for (int step = 0; step < 120; ++step) {
      const double stride = std::pow(10, -8 - 2 * (1 + std::cos(step * 0.4)));
      const Vec3 before = pose.frame_b.p;
      pose.frame_b.p -= stride * toward;
      const double moved = (pose.frame_b.p - before).norm();
      const double now = parts(a, pose.frame_a, b, pose.frame_b).distance;
      ASSERT_LE(std::abs(now - last), moved + 2e-14) << "at " << last;
      last = now;
    }
  });
}

TEST(Separation, normals_at_touch_are_exact_whatever_the_gap) {
  // a cube's corner over a face, tilted: the normal is the face's
  const ShapePtr cube = make_box({1, 1, 1});
  Frame corner_down;
  corner_down.R = Quat::FromTwoVectors(Vec3(-1, -1, -1), Vec3(0.1, 0.2, -1)).toRotationMatrix();
  const double low = cube->bounds(corner_down).lo.z();
  for (double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 0.0, -1e-14, -1e-12, -1e-9, -1e-6, -1e-3}) {
    corner_down.p = Vec3(0.05, 0.02, 0.5 - low + gap);
    const Separation s = parts(cube, Frame(), cube, corner_down);
    EXPECT_NEAR(s.distance, gap, 1e-15) << gap;
    EXPECT_NEAR((s.normal - Vec3::UnitZ()).norm(), 0, 1e-14) << gap;
  }
}

TEST(Separation, normals_of_crossing_edges_are_exact_whatever_the_gap) {
  // two cubes on edge, the upper one turned by a right angle and a bit
  const ShapePtr cube = make_box({1, 1, 1});
  Frame lower, upper;
  const Mat3 on_edge = rotation_by(pi / 4 * Vec3::UnitX()).toRotationMatrix();
  lower.R = on_edge;
  upper.R = rotation_by(1.3 * Vec3::UnitZ()).toRotationMatrix() * on_edge;
  for (double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 0.0, -1e-14, -1e-12, -1e-9, -1e-6, -1e-3}) {
    upper.p = Vec3(0.1, 0.05, std::sqrt(2.0) + gap);
    const Separation s = parts(cube, lower, cube, upper);
    EXPECT_NEAR(s.distance, gap, 1e-15) << gap;
    EXPECT_NEAR((s.normal - Vec3::UnitZ()).norm(), 0, 1e-14) << gap;
    EXPECT_NEAR(std::abs(s.point_a.y()), 0, 1e-14);
  }
}

TEST(Separation, degenerate_poses_never_give_nan) {
  Engine random(8);
  const std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  const auto check = [](const Separation& s) {
    ASSERT_TRUE(std::isfinite(s.distance));
    ASSERT_NEAR(s.normal.norm(), 1, 1e-14);
    ASSERT_TRUE(is_finite(s.point_a) && is_finite(s.point_b));
  };
  for (const ShapePtr& a : zoo) {
    const Aabb box = a->bounds(Frame());
    // identical poses, and stacked face on face, edge on edge, corner on corner
    for (int code = 0; code < 27; ++code)
      for (double factor : {0.0, 0.5, 0.9999999, 1.0, 1.0000001}) {
        Frame moved;
        const Vec3 steps(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
        moved.p = factor * box.size().cwiseProduct(steps);
        check(parts(a, Frame(), a, moved));
      }
  }
  const ShapePtr sphere = make_sphere(0.5);
  check(parts(sphere, Frame(), sphere, Frame()));
  for (const ShapePtr& a : zoo) {
    Frame at;
    at.p = a->parts()[0].bound_center;
    check(parts(a, Frame(), sphere, at));
    // the centre on each vertex, edge and face of the core
    const Polyhedron& core = *a->parts()[0].core;
    const auto sphere_at = [&](const Vec3& p) {
      check(parts(sphere, Frame(Mat3::Identity(), p), a, Frame()));
    };
    for (const Vec3& v : core.vertices()) sphere_at(v);
    for (const auto& e : core.edges()) sphere_at(0.5 * (core.vertex(e.tail) + core.vertex(e.head)));
    for (const auto& f : core.faces())
      sphere_at((core.vertex(core.corner(f.first)) + core.vertex(core.corner(f.first + 1)) +
                 core.vertex(core.corner(f.first + 2))) /
                3);
  }
}

TEST(Separation, stacked_cubes_touch_along_the_stack) {
  // libccd answers NaN here (its issue 25)
  const ShapePtr cube = make_box({2, 2, 2});
  for (double height : {1.9, 2.0, 2.0 + 1e-12, 2.1}) {
    const Separation s = parts(cube, Frame(), cube, Frame(Mat3::Identity(), {0, 0, height}));
    EXPECT_NEAR(s.distance, height - 2, 1e-15);
    EXPECT_EQ(s.normal, Vec3::UnitZ());
  }
}

TEST(Separation, spheres_have_their_closed_form) {
  const ShapePtr a = make_sphere(0.5);
  const ShapePtr b = make_sphere(0.25);
  const Separation s = parts(a, Frame(), b, Frame(Mat3::Identity(), {0, 3, 4}));
  EXPECT_DOUBLE_EQ(s.distance, 4.25);
  EXPECT_NEAR((s.normal - Vec3(0, 0.6, 0.8)).norm(), 0, 1e-16);
  EXPECT_NEAR((s.point_a - Vec3(0, 0.3, 0.4)).norm(), 0, 1e-15);
  EXPECT_NEAR((s.point_b - Vec3(0, 2.85, 3.8)).norm(), 0, 1e-15);
}

TEST(Separation, sphere_and_polyhedron_agree_with_features_and_faces) {
  Engine random(9);
  for (const ShapePtr& shape : polyhedron_zoo(random))
    for (int i = 0; i < 300; ++i) {
      const double radius = uniform(random, 0.01, 0.5);
      const ShapePtr sphere = make_sphere(radius);
      const Frame frame = random_frame(random, 1);
      Frame at;
      at.p = frame.p + random_vector(random, 1);
      const WorldFeatures world(shape->parts()[0], frame);
      int face = 0;
      double truth = shape->parts()[0].core->face_separation(frame.to_local(at.p), face);
      if (truth > 0) {
        truth = 1e300;
        for (std::size_t f = 0; f < world.faces.size(); ++f)
          truth = std::min(truth, point_polygon(at.p, world.faces[f], world.normals[f]));
        for (const auto& e : world.edges)
          truth = std::min(truth, point_segment(at.p, e.first, e.second));
      }
      const Separation s = parts(shape, frame, sphere, at);
      ASSERT_NEAR(s.distance, truth - radius, 5e-15);
      ASSERT_NEAR((s.point_b - (at.p - radius * s.normal)).norm(), 0, 1e-15);
      const Separation swapped = parts(sphere, at, shape, frame);
      ASSERT_EQ(swapped.distance, s.distance);
      ASSERT_EQ(swapped.normal, -s.normal);
    }
}

TEST(Separation, half_space_measures_the_lowest_point) {
  Engine random(10);
  for (const ShapePtr& shape : polyhedron_zoo(random))
    for (int i = 0; i < 50; ++i) {
      const Vec3 normal = random_direction(random);
      const ShapePtr ground = make_half_space(normal, 0.3);
      const Frame frame_g = random_frame(random, 2);
      const Frame frame = random_frame(random, 2);
      double truth = 1e300;
      for (const Vec3& v : WorldFeatures(shape->parts()[0], frame).vertices)
        truth = std::min(truth, normal.dot(frame_g.to_local(v)) - 0.3);
      SimplexCache cache;
      for (int repeat = 0; repeat < 2; ++repeat) {
        const Separation s =
            part_separation(ground->parts()[0], frame_g, shape->parts()[0], frame, &cache);
        ASSERT_NEAR(s.distance, truth, 4e-15);
        ASSERT_NEAR((s.normal - frame_g.R * normal).norm(), 0, 1e-15);
      }
    }
}

TEST(Separation, opposite_half_spaces_leave_a_slab_and_others_overlap) {
  const ShapePtr floor = make_half_space({0, 0, 1}, -1);
  const ShapePtr ceiling = make_half_space({0, 0, -2}, -3);
  const ShapePtr wall = make_half_space({1, 0, 0}, 0);
  EXPECT_DOUBLE_EQ(parts(floor, Frame(), ceiling, Frame()).distance, 4);
  EXPECT_EQ(parts(floor, Frame(), wall, Frame()).distance,
            -std::numeric_limits<double>::infinity());
}

TEST(Separation, of_unions_is_the_least_over_parts_and_skips_distant_ones) {
  Engine random(11);
  std::vector<ShapePtr> pieces;
  for (int i = 0; i < 6; ++i) {
    const ShapePtr piece = i % 2 == 0 ? make_sphere(0.2) : random_rock(random, 12, {0.3, 0.2, 0.2});
    const Vec3 position = random_vector(random, 1.5);
    pieces.push_back(place_shape(piece, {position, random_rotation(random)}));
  }
  const ShapePtr shape = make_union(pieces);
  unsigned long long queries = 0;
  for (int i = 0; i < 300; ++i) {
    const Frame frame_a = random_frame(random, 1.5);
    const Frame frame_b = random_frame(random, 1.5);
    Separation truth;
    truth.distance = 1e300;
    for (std::size_t p = 0; p < 6; ++p)
      for (std::size_t q = 0; q < 6; ++q) {
        Separation s =
            part_separation(shape->parts()[p], frame_a, shape->parts()[q], frame_b, nullptr);
        s.part_a = static_cast<int>(p);
        s.part_b = static_cast<int>(q);
        if (s.distance < truth.distance) truth = s;
      }
    const unsigned long long before = work_count.distance_queries;
    const Separation s = separation(*shape, frame_a, *shape, frame_b);
    queries += work_count.distance_queries - before;
    // to the last bit
    ASSERT_EQ(s.distance, truth.distance);
    ASSERT_EQ(s.part_a, truth.part_a);
    ASSERT_EQ(s.part_b, truth.part_b);
    ASSERT_EQ(s.normal, truth.normal);
  }
  EXPECT_LT(queries, 300 * 18);
}

TEST(Separation, ties_take_the_first_pair_of_parts) {
  const ShapePtr ball = make_sphere(0.5);
  const ShapePtr pair = make_union({place_shape(ball, {{0, 1, 0}, Quat::Identity()}),
                                    place_shape(ball, {{0, -1, 0}, Quat::Identity()})});
  const Separation s = separation(*pair, Frame(), *ball, Frame(Mat3::Identity(), {3, 0, 0}));
  EXPECT_EQ(s.part_a, 0);
}

TEST(Separation, distance_scales_with_the_unit_of_length) {
  for (double unit : {1e-6, 1e-3, 1e3, 1e6}) {
    Engine random(12);
    Engine same(12);
    const ShapePtr a = random_rock(random, 30, Vec3::Constant(0.5));
    const ShapePtr scaled = random_rock(same, 30, Vec3::Constant(0.5 * unit));
    for (int i = 0; i < 100; ++i) {
      const Frame frame_a = random_frame(random, 0.6);
      const Frame frame_b = random_frame(random, 0.6);
      const double d = parts(a, frame_a, a, frame_b).distance;
      const double scaled_d = parts(scaled, Frame(frame_a.R, unit * frame_a.p), scaled,
                                    Frame(frame_b.R, unit * frame_b.p))
                                  .distance;
      ASSERT_NEAR(scaled_d, unit * d, 3e-15 * unit);
    }
  }
}

// Drums with one axis, end to end or deep in each other: differences of parallel faces, which have
// no volume in some places.  Known: the least of what the caps and the walls overlap by.
TEST(Separation, drums_with_parallel_axes_are_as_deep_as_caps_and_walls_say) {
  Engine random(29);
  const ShapePtr drum = make_cylinder(0.5, 1);
  double worst_touch = 0, worst_deep = 0;
  for (int i = 0; i < 20000; ++i) {
    const Frame first = random_frame(random, 1);
    const Vec3 off = std::pow(10, uniform(random, -13, -7)) * random_direction(random);
    const Separation touch =
        parts(drum, first, drum, first * Frame(Mat3::Identity(), Vec3(0, 0, 1) + off));
    worst_touch = std::max(worst_touch, std::abs(touch.distance - off.z()));

    const Vec3 inside = uniform(random, 0, 0.4) * random_direction(random);
    const Separation deep = parts(drum, first, drum, first * Frame(Mat3::Identity(), inside));
    const double exact = std::min(1 - std::abs(inside.z()), 1 - inside.head<2>().norm());
    worst_deep = std::max(worst_deep, std::abs(deep.distance + exact));
  }
  EXPECT_LT(worst_touch, 1e-12);
  EXPECT_LT(worst_deep, 1e-8);
}

// Side by side: what lies along a line slides past the other for as long as it does, if distance
// and normal are exact.
TEST(Separation, drums_side_by_side_touch_to_the_last_digits) {
  Engine random(31);
  const ShapePtr drum = make_cylinder(0.04, 0.08);
  double worst_distance = 0, worst_normal = 0;
  for (int i = 0; i < 2000; ++i) {
    const Frame first = random_frame(random, 1);
    const double angle = uniform(random, 0, 2 * pi);
    const Vec3 aside(std::cos(angle), std::sin(angle), 0);
    const Vec3 off(0.08 * aside.x(), 0.08 * aside.y(), uniform(random, -0.06, 0.06));
    const Separation touch = parts(drum, first, drum, first * Frame(Mat3::Identity(), off));
    worst_distance = std::max(worst_distance, std::abs(touch.distance));
    worst_normal = std::max(worst_normal, (touch.normal - first.R * aside).norm());
  }
  EXPECT_LT(worst_distance, 1e-15);
  EXPECT_LT(worst_normal, 1e-14);
}

}  // namespace
}  // namespace tw::test
