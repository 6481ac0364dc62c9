// What a scene does not need costs nothing: counters prove it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>

#include "kernel/world/world.h"

namespace tw::test {
namespace {

std::map<std::string, std::int64_t> counts(const World& world) {
  std::map<std::string, std::int64_t> result;
  for (const auto& [name, value] : world.statistics())
    if (const auto* n = std::get_if<std::int64_t>(&value)) result[name] = *n;
  return result;
}

// A water-like union: never predicted exactly, so each active pair needs queries.
ShapePtr molecule() {
  Pose left, right;
  left.p = Vec3(-0.2, 0, 0.1);
  right.p = Vec3(0.2, 0, 0.1);
  return make_union({make_sphere(0.2), place_shape(make_box(Vec3(0.2, 0.2, 0.2)), left),
                     place_shape(make_sphere(0.1), right)});
}

// Molecules on a line, `spacing` apart, all with the same velocity but for a spin.
void add_line(World& world, double spacing) {
  world.set_gravity(Vec3(0, 0, -9.81));
  for (int i = 0; i < 12; ++i) {
    BodyDef def;
    def.shape = molecule();
    def.position = Vec3(spacing * i, 0, 0);
    def.velocity = Vec3(0, 3, 5);
    def.angular_velocity = Vec3(1, 2, 0.1 * i);
    world.add_body(def);
  }
}

TEST(CostsNothing, pairs_whose_boxes_stay_apart_make_no_distance_query) {
  World world;
  add_line(world, 5);
  world.advance(2);
  const auto n = counts(world);
  EXPECT_EQ(n.at("distance_queries"), 0);
  EXPECT_EQ(n.at("checks"), 0);
  EXPECT_GT(n.at("claims"), 12);
}

TEST(CostsNothing, pairs_that_may_not_collide_make_no_distance_query) {
  World world;
  ContactSettings apart;
  apart.collide = false;
  world.set_contact({}, {}, apart);
  add_line(world, 0.7);
  world.advance(2);
  EXPECT_EQ(counts(world).at("distance_queries"), 0);
  EXPECT_EQ(counts(world).at("checks"), 0);
}

TEST(CostsNothing, near_pairs_are_checked_and_queried) {
  World world;
  add_line(world, 0.62);
  world.advance(2);
  EXPECT_GT(counts(world).at("checks"), 0);
  EXPECT_GT(counts(world).at("distance_queries"), 0);
}

class CountingSink : public FrameSink {
 public:
  void frame(long index, double, std::span<const BodyPose> poses) override {
    EXPECT_EQ(index, frames++);
    bodies += static_cast<long>(poses.size());
  }
  long frames = 0, bodies = 0;
};

// Frames are read off arcs that are final: no event, no claim, no check, no arc more.
TEST(CostsNothing, frames_add_no_work_to_the_stepping_loop) {
  std::map<std::string, std::int64_t> without, with;
  for (const bool drawn : {false, true}) {
    World world;
    add_line(world, 0.7);
    const auto sink = std::make_shared<CountingSink>();
    if (drawn) world.add_frame_sink(sink, 1000);
    world.advance(2);
    (drawn ? with : without) = counts(world);
    EXPECT_EQ(sink->frames, drawn ? 2001 : 0);
    EXPECT_EQ(sink->bodies, drawn ? 2001 * 12 : 0);
  }
  for (const char* name : {"events", "claims", "checks", "distance_queries", "integrations"})
    EXPECT_EQ(without.at(name), with.at(name)) << name;
}

TEST(CostsNothing, a_body_at_rest_without_gravity_hardly_claims) {
  World world;
  world.set_gravity(Vec3::Zero());
  BodyDef def;
  def.shape = molecule();
  world.add_body(def);
  world.advance(60);
  EXPECT_LT(counts(world).at("events"), 20);
}

}  // namespace
}  // namespace tw::test
