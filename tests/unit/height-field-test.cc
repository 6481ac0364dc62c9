// Height fields: the ground that they are, and their trees against all parts one by one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/height-field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "base/error.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/ray.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold.h"
#include "collision/seams/seams.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

// Some cells are flat, most are not.
ShapePtr random_field(Engine& random, std::size_t rows, std::size_t columns, double rough) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < rows * columns; ++i)
    heights.push_back(uniform(random, 0, 1) < 0.3 ? 0 : uniform(random, -rough, rough));
  return make_height_field(heights, columns, 0.5, 0.4);
}

std::vector<std::size_t> all_parts(const Shape& shape) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < shape.part_count(); ++i)
    if (!shape.height_field() || shape.height_field()->exists(i)) numbers.push_back(i);
  return numbers;
}

// The height of the ground where no cell but the one at x, y is looked at: bilinear on two
// triangles.
double ground_at(const HeightField& field, double x, double y) {
  const Vec3 first = field.corner(0, 0), step = field.corner(1, 1) - first;
  const double u = (x - first.x()) / step.x(), v = (y - first.y()) / step.y();
  const auto i = static_cast<std::size_t>(u), j = static_cast<std::size_t>(v);
  const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
  const double a = field.corner(j, i).z(), b = field.corner(j, i + 1).z();
  const double c = field.corner(j + 1, i + 1).z(), d = field.corner(j + 1, i).z();
  return s > t ? a + s * (b - a) + t * (c - b) : a + t * (d - a) + s * (c - d);
}

TEST(HeightField, is_solid_below_its_heights) {
  Engine random(1);
  const ShapePtr shape = random_field(random, 9, 12, 0.6);
  const HeightField& field = *shape->height_field();
  EXPECT_EQ(field.part_count(), 2u * 8 * 11);
  const ShapePtr probe = make_sphere(1e-6);
  for (int i = 0; i < 2000; ++i) {
    const double x = uniform(random, -2.7, 2.7), y = uniform(random, -1.55, 1.55);
    const double z = ground_at(field, x, y);
    const auto distance = [&](double height) {
      return signed_distance(*shape, Frame(), *probe, Frame(Mat3::Identity(), Vec3(x, y, height)));
    };
    ASSERT_NEAR(distance(z), -1e-6, 1e-12);
    ASSERT_GT(distance(z + 1e-3), 0);
    ASSERT_LT(distance(z - 1e-3), -1e-6);
    ASSERT_LT(distance(z - 0.9 * field.depth()), -1e-6);
  }
}

TEST(HeightField, has_one_part_where_cells_lie_in_a_plane) {
  // a plane, but for the last corner: two rows, three cells of the third, two triangles
  std::vector<double> heights;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) heights.push_back(0.1 * i - 0.37 * j);
  heights.back() += 0.01;
  const ShapePtr shape = make_height_field(heights, 5, 1, 1);
  EXPECT_EQ(all_parts(*shape), (std::vector<std::size_t>{0, 16, 22, 23}));
  EXPECT_EQ(shape->part(0).core->faces().size(), 6u);
  EXPECT_EQ(shape->part(23).core->faces().size(), 5u);
}

// Terraces and ramps: every cell is under one part alone.
TEST(HeightField, joined_cells_cover_the_ground_once) {
  Engine random(3);
  for (int k = 0; k < 20; ++k) {
    const std::size_t columns = 12, rows = 10;
    std::vector<double> heights(columns * rows);
    for (int terrace = 0; terrace < 4; ++terrace) {
      const auto from_row = static_cast<std::size_t>(uniform(random, 0, 9));
      const auto from_column = static_cast<std::size_t>(uniform(random, 0, 11));
      const double height = uniform(random, 0, 0.5), slope = uniform(random, -0.3, 0.3);
      for (std::size_t j = from_row; j < rows; ++j)
        for (std::size_t i = from_column; i < columns; ++i)
          heights[j * columns + i] = height + slope * static_cast<double>(i + 2 * j);
    }
    const ShapePtr shape = make_height_field(heights, columns, 0.5, 0.5);
    const HeightField& field = *shape->height_field();
    EXPECT_LT(all_parts(*shape).size(), 2 * (columns - 1) * (rows - 1) * 2 / 3);
    for (std::size_t j = 0; j + 1 < rows; ++j)
      for (std::size_t i = 0; i + 1 < columns; ++i)
        for (const double across : {0.25, 0.75}) {
          const Vec3 along = field.corner(j + 1, i + 1) - field.corner(j, i);
          const double x = field.corner(j, i).x() + across * along.x();
          const double y = field.corner(j, i).y() + (1 - across) * along.y();
          const double z = ground_at(field, x, y);
          Aabb line;
          line.add(Vec3(x, y, z - 0.4));
          line.add(Vec3(x, y, z + 1e-9));
          std::vector<std::size_t> under;
          field.tree().overlapping(line, [&](std::size_t number) {
            const ConvexPart& part = field.part(number);
            const Vec3 below = Vec3(x, y, z - 1e-6) - part.placement().p;
            int face;
            if (part.core->face_separation(below, face) <= 0) under.push_back(number);
          });
          EXPECT_EQ(under.size(), 1u) << x << " " << y;
        }
  }
}

TEST(HeightField, has_the_bounds_of_its_box) {
  const ShapePtr shape = make_height_field({0, 1, 2, 3, 4, 5}, 3, 2, 1);
  const Aabb box = shape->bounds(Frame());
  EXPECT_EQ(box.lo, Vec3(-2, -0.5, -2));
  EXPECT_EQ(box.hi, Vec3(2, 0.5, 5));
  EXPECT_EQ(shape->least_width(), 1);
  EXPECT_DOUBLE_EQ(shape->radius_about_origin(), Vec3(2, 0.5, 5).norm());
  const double half = std::sqrt(0.5);
  const Frame turned(Pose{{1, 2, 3}, Quat(half, 0, 0, half)});
  EXPECT_LT((shape->bounds(turned).lo - Vec3(0.5, 0, 1)).norm(), 1e-12);
}

TEST(HeightField, says_what_is_wrong_with_it) {
  EXPECT_THROW(make_height_field({0, 0, 0}, 3, 1, 1), UserError);
  EXPECT_THROW(make_height_field({0, 0, 0}, 1, 1, 1), UserError);
  EXPECT_THROW(make_height_field({0, 0, 0, 0}, 2, 0, 1), UserError);
  EXPECT_THROW(make_height_field({0, 0, 0, std::nan("")}, 2, 1, 1), UserError);
  const ShapePtr field = make_height_field({0, 0, 0, 0}, 2, 1, 1);
  EXPECT_THROW(make_union({field, make_sphere(1)}), UserError);
  EXPECT_THROW(place_shape(field, Pose()), UserError);
}

// Shapes with trees: a field, and a union of many parts.
std::vector<ShapePtr> shapes_with_trees(Engine& random) {
  std::vector<ShapePtr> parts;
  for (int i = 0; i < 60; ++i)
    parts.push_back(place_shape(i % 3 ? make_box({0.2, 0.3, 0.1}) : make_sphere(0.1),
                                Pose{random_vector(random, 1.5), random_rotation(random)}));
  const std::vector<ShapePtr> shapes{random_field(random, 8, 9, 0.4), make_union(parts)};
  for (const ShapePtr& shape : shapes) EXPECT_NE(shape->tree(), nullptr);
  return shapes;
}

std::vector<ShapePtr> shapes_without(Engine& random) {
  return {make_sphere(0.3),
          make_box({0.3, 0.2, 0.4}),
          random_rock(random, 20, {0.4, 0.3, 0.3}),
          make_capsule(0.1, 0.5),
          make_half_space({0.3, 0.2, -1}, -0.2),
          make_union({make_sphere(0.2), place_shape(make_box({1.5, 0.1, 0.1}), Pose())})};
}

TEST(PartTree, finds_the_least_distance_of_all_pairs) {
  Engine random(2);
  const std::vector<ShapePtr> with = shapes_with_trees(random), without = shapes_without(random);
  int overlaps = 0;
  for (int i = 0; i < 60; ++i)
    for (const ShapePtr& a : with)
      for (const ShapePtr& b : i % 6 ? without : with) {
        const Frame fa = random_frame(random, 1), fb = random_frame(random, 1.5);
        double least = std::numeric_limits<double>::infinity();
        for (const std::size_t p : all_parts(*a))
          for (const std::size_t q : all_parts(*b))
            least =
                std::min(least, part_separation(a->part(p), fa, b->part(q), fb, nullptr).distance);
        const Separation s = separation(*a, fa, *b, fb);
        ASSERT_EQ(s.distance, least);
        ASSERT_EQ(signed_distance(*a, fa, *b, fb), least);
        const Separation again =
            part_separation(a->part(static_cast<std::size_t>(s.part_a)), fa,
                            b->part(static_cast<std::size_t>(s.part_b)), fb, nullptr);
        ASSERT_EQ(again.distance, least);
        // the other way round, by the other's turn to look
        ASSERT_NEAR(separation(*b, fb, *a, fa).distance, least, 1e-12);
        overlaps += least < 0;
      }
  EXPECT_GT(overlaps, 100);
}

TEST(PartTree, finds_the_manifolds_of_all_pairs_in_order) {
  Engine random(3);
  const std::vector<ShapePtr> with = shapes_with_trees(random), without = shapes_without(random);
  const double reach = 0.02;
  std::size_t points = 0;
  for (int i = 0; i < 40; ++i)
    for (const ShapePtr& a : with)
      for (const ShapePtr& b : without) {
        const Frame fa = random_frame(random, 1), fb = random_frame(random, 1);
        std::vector<int> near;
        for (const std::size_t p : all_parts(*a))
          for (const std::size_t q : all_parts(*b))
            if (part_separation(a->part(p), fa, b->part(q), fb, nullptr).distance <= reach)
              near.push_back(pair_number(p, q, *b));
        std::vector<ManifoldPoint> found;
        manifold(*a, fa, *b, fb, reach, found);
        points += found.size();
        std::vector<int> pairs;
        for (const ManifoldPoint& p : found)
          if (pairs.empty() || pairs.back() != p.pair) pairs.push_back(p.pair);
        ASSERT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
        // points over a face beside it are found of pairs that are farther apart
        ASSERT_TRUE(std::includes(pairs.begin(), pairs.end(), near.begin(), near.end()));
      }
  EXPECT_GT(points, 1000u);
}

// A plane cell has one part and two numbers; a union may have more parts than a small field.
TEST(PartTree, finds_no_part_of_a_field_twice) {
  Engine random(6);
  const ShapePtr field = make_height_field(std::vector<double>(9, 0.0), 3, 1, 1);
  std::vector<ShapePtr> parts;
  for (int i = 0; i < 40; ++i)
    parts.push_back(
        place_shape(make_sphere(0.1), Pose{random_vector(random, 0.9), Quat::Identity()}));
  const ShapePtr many = make_union(parts);
  ASSERT_GT(many->part_count(), field->part_count());
  int seen = 0;
  const auto see = [&](std::size_t number) {
    EXPECT_TRUE(field->height_field()->exists(number)) << number;
    ++seen;
  };
  visit_near_parts(*field, Frame(), *many, Frame(), 0.1, [&](auto i, auto) { see(i); });
  visit_near_parts(*many, Frame(), *field, Frame(), 0.1, [&](auto, auto j) { see(j); });
  EXPECT_GT(seen, 20);
}

// One part as a shape.
ShapePtr alone(const ConvexPart& part) {
  if (part.kind == PartKind::sphere)
    return place_shape(make_sphere(part.radius), {part.placement().p, Quat::Identity()});
  std::vector<Vec3> corners;
  for (const Vec3& v : part.core->vertices()) corners.push_back(part.placement() * v);
  return make_hull(corners);
}

TEST(PartTree, finds_where_rays_enter) {
  Engine random(4);
  int hits = 0;
  for (const ShapePtr& shape : shapes_with_trees(random)) {
    std::vector<ShapePtr> parts;
    for (const std::size_t p : all_parts(*shape)) parts.push_back(alone(shape->part(p)));
    for (int i = 0; i < 500; ++i) {
      const Frame frame = random_frame(random, 0.5);
      const Vec3 from = random_vector(random, 3);
      const Vec3 way = (random_vector(random, 1.5) - from).normalized();
      const auto hit = cast_ray(*shape, frame, from, way, 4);
      std::optional<RayHit> nearest;
      for (const ShapePtr& part : parts) {
        const auto met = cast_ray(*part, frame, from, way, 4);
        if (met && (!nearest || met->distance < nearest->distance)) nearest = met;
      }
      ASSERT_EQ(hit.has_value(), nearest.has_value());
      if (!hit) continue;
      ++hits;
      ASSERT_NEAR(hit->distance, nearest->distance, 1e-12);
    }
  }
  EXPECT_GT(hits, 300);
}

// Several threads make parts at once: each part exists once.
TEST(HeightField, parts_are_made_by_several_threads) {
  Engine random(5);
  const ShapePtr shape = random_field(random, 40, 40, 1);
  std::vector<std::vector<const ConvexPart*>> seen(4);
  std::vector<std::thread> threads;
  for (auto& mine : seen)
    threads.emplace_back([&] {
      for (const std::size_t i : all_parts(*shape)) mine.push_back(&shape->part(i));
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& mine : seen) EXPECT_EQ(mine, seen[0]);
}

}  // namespace
}  // namespace tw::test
