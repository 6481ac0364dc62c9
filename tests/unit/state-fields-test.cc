// The list of a state's fields: what it is compared by, and what a difference is called.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/state-fields.h"

#include <gtest/gtest.h>

#include "groups/group.h"
#include "kernel/check/state-image.h"

namespace tw::test {
namespace {

struct OneBody {
  SceneOptions options;
  Scene scene{options};
  State state;

  OneBody() {
    scene.bodies.push_back(std::make_unique<Body>());
    scene.bodies[0]->info.name = "ball-3";
    scene.first_bodies = {0};
    state.v = {1, 0, 0};
  }
  StateImage image() const {
    StateImage result;
    result.add(state);
    return result;
  }
};

struct SomeSlots : Slots {
  std::uint64_t hash() const override { return 7; }
};

// Changes the last word of a field.
void change(double& x) { x = std::isfinite(x) ? x + 1 : 0; }
template <class T>
requires std::integral<T>
void change(T& n) { n = !n; }
void change(Vec3& v) { v.z() += 1; }
void change(Quat& q) { q.w() += 1; }
void change(Key& key) { key.id += 1; }
void change(ImpactRun& run) { change(run.partner); }
void change(Tally& tally) { tally.depth += 1; }
void change(SlotsPtr& slots) { slots = std::make_shared<SomeSlots>(); }
void change(ForcesPtr& forces) { forces = with_law(forces, make_drag(1, 2)); }
void change(std::exception_ptr& error) { error = std::make_exception_ptr(UserError("stop")); }
void change(std::shared_ptr<const Report>& report) {
  report = std::make_shared<const Report>(Report{Collision{}});
}
void change(MultibodyStatePtr& joints) {
  joints =
      std::make_shared<const MultibodyState>(MultibodyState{{0.5}, {0}, {}, {}, {}, {}, {}, {}});
}
// of another group than the first member's: its own fields are compared once
void change(std::shared_ptr<Group>& group) { group = std::make_shared<Group>(); }

TEST(StateFields, difference_is_named_with_body_and_both_values) {
  OneBody one;
  const StateImage before = one.image();
  EXPECT_EQ(one.image().first_difference(one.scene, before), "");
  one.state.v.x() = 1.0000001;
  EXPECT_EQ(one.image().first_difference(one.scene, before),
            "velocity of ball-3: 1.0000001, before 1");
}

TEST(StateFields, states_that_one_image_lacks_are_a_difference) {
  OneBody one;
  const StateImage with = one.image(), without;
  EXPECT_EQ(with.first_difference(one.scene, without), "process of ball-3: 0, before none");
  EXPECT_EQ(without.first_difference(one.scene, with), "process of ball-3: none, before 0");
}

// Each field of the list, changed alone, is what the comparison names and changes the checksum.
TEST(StateFields, each_field_of_the_list_counts) {
  std::vector<std::string> names;
  OneBody one;
  for_each_field(one.state, [&](const char* name, FieldUse, auto&) { names.push_back(name); });
  ASSERT_GE(names.size(), 19u);
  for (const std::string& changed : names) {
    OneBody other;
    other.state.member = one.state.member = 1;
    const StateImage before = other.image();
    const std::uint64_t checksum = state_checksum(other.state);
    for_each_field(other.state, [&](const char* name, FieldUse, auto& field) {
      if (name == changed) change(field);
    });
    const std::string difference = other.image().first_difference(other.scene, before);
    EXPECT_EQ(difference.substr(0, difference.find(" of ball-3")), changed);
    EXPECT_NE(state_checksum(other.state), checksum) << changed;
  }
}

}  // namespace
}  // namespace tw::test
