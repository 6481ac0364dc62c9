// Delivery and the committed present without a loop: order, errors, and going on from a copy.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/report/delivery.h"

#include <gtest/gtest.h>

#include "support/small-simulation.h"

namespace tw::test {
namespace {

// Frames as they come: index, time, and where the first body is.
struct Frames : FrameSink {
  struct Frame {
    long index;
    double time, x;
    bool operator==(const Frame&) const = default;
  };
  std::vector<Frame> all;
  void frame(long index, double frame_time, std::span<const BodyPose> poses) override {
    all.push_back({index, frame_time, poses[0].state.position.x()});
  }
};

std::shared_ptr<const Report> report_at(double time, std::uint64_t id) {
  Collision told;
  told.time = time;
  told.key = {time, 1, KeyKind::impact, id};
  return std::make_shared<const Report>(Report{told});
}

struct DeliveryTest : testing::Test {
  SmallSimulation simulation;
  Delivery delivery{simulation};
  BodyId ball = simulation.add_ball(0.5, Vec3::Zero(), {1, 0, 0});

  void commit(double time, bool inclusive) {
    simulation.present.gvt = simulation.present.time = time;
    simulation.present.due = {time, inclusive};
  }
};

TEST_F(DeliveryTest, frame_at_the_present_time_waits_until_that_is_final) {
  const auto frames = std::make_shared<Frames>();
  delivery.add_sink(frames, 10);
  commit(0.2, false);
  EXPECT_TRUE(delivery.deliver(never));
  EXPECT_EQ(frames->all.size(), 2u);
  commit(0.2, true);
  delivery.deliver(never);
  EXPECT_EQ(frames->all.back(), (Frames::Frame{2, 0.2, 0.2}));
  EXPECT_EQ(delivery.first_needed(never), 3 / 10.0);
}

TEST_F(DeliveryTest, collisions_and_frames_come_in_order_of_time_and_the_collision_first) {
  std::vector<double> heard;
  const auto frames = std::make_shared<Frames>();
  delivery.add_sink(frames, 10);
  delivery.add_observer(
      [&](const Collision& c) {
        EXPECT_EQ(frames->all.size(), c.time <= 0.1 ? 1u : 2u);
        heard.push_back(c.time);
      },
      CollisionKind::collision);
  for (const double time : {0.15, 0.1, 0.05}) delivery.note(report_at(time, 0));
  delivery.sort_noted();
  commit(1, true);
  delivery.deliver(never);
  EXPECT_EQ(heard, (std::vector<double>{0.05, 0.1, 0.15}));
  EXPECT_EQ(delivery.undelivered(), 0u);
}

TEST_F(DeliveryTest, nothing_is_kept_for_nobody) {
  delivery.note(report_at(0.1, 0));
  delivery.sort_noted();
  EXPECT_EQ(delivery.undelivered(), 0u);
  EXPECT_FALSE(delivery.observed(CollisionKind::collision));
}

// What is noted after some of it has been delivered is put in order by itself.
TEST_F(DeliveryTest, commits_follow_each_other) {
  std::vector<std::uint64_t> heard;
  delivery.add_observer([&](const Collision& c) { heard.push_back(c.key.id); },
                        CollisionKind::collision);
  delivery.note(report_at(1, 2));
  delivery.note(report_at(1, 1));
  delivery.sort_noted();
  delivery.deliver(0);  // one thing
  EXPECT_EQ(heard, (std::vector<std::uint64_t>{1}));
  delivery.note(report_at(2, 4));
  delivery.note(report_at(2, 3));
  delivery.sort_noted();
  delivery.deliver(never);
  EXPECT_EQ(heard, (std::vector<std::uint64_t>{1, 2, 3, 4}));
}

// The committed present is one value: whoever goes on from a copy of it delivers the same frames.
TEST_F(DeliveryTest, frames_after_the_present_was_restored_are_the_same) {
  const auto frames = std::make_shared<Frames>();
  delivery.add_sink(frames, 30);
  for (const bool inclusive : {false, true}) {
    commit(0.5, inclusive);
    delivery.deliver(never);
    const Present kept = simulation.present;
    const std::size_t delivered = frames->all.size();
    commit(1, true);
    delivery.deliver(never);
    const std::vector<Frames::Frame> first(frames->all.begin() + static_cast<long>(delivered),
                                           frames->all.end());
    ASSERT_EQ(first.size(), inclusive ? 15u : 16u);

    frames->all.clear();
    simulation.present = kept;
    delivery.restart();
    EXPECT_TRUE(delivery.deliver(never));
    EXPECT_TRUE(frames->all.empty()) << "nothing is due that was delivered before";
    commit(1, true);
    delivery.deliver(never);
    EXPECT_EQ(frames->all, first);

    // back to the beginning
    simulation.present = Present();
    simulation.present.settings.gravity = Vec3::Zero();
    delivery.restart();
    frames->all.clear();
  }
}

}  // namespace
}  // namespace tw::test
