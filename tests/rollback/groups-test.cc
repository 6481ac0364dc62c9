// Contact groups in the state graph: figure 4 of the paper, rollback through fusions and fissions,
// and how long groups live.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>

#include "rollback/kernel-access.h"
#include "support/counter.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

using Members = std::vector<BodyId>;

// Figure 4 with bodies that fall: a lies on the floor, b comes to lie on a, c hits b hard and
// bounces, settles on b, rolls off its edge, and comes to lie on the floor.  `far` lies on the same
// floor, `flier` flies: they have no part in it.
struct Figure4 {
  explicit Figure4(const Schedule& schedule = Schedule()) {
    apply(world, schedule);
    set_contact_for_all(world, 0.4, 0.5);
    floor = add_block(world, {10, 10, 1}, {0, 0, -0.5});
    a = add_box(world, {0.4, 0.4, 0.2}, {0, 0, 0.101});
    b = add_box(world, {0.3, 0.3, 0.1}, {0.02, 0, 0.255});
    c = add_ball(world, 0.06, {-0.08, 0.01, 0.45}, {0.35, 0, 0});
    far = add_box(world, {0.3, 0.3, 0.3}, {3, 0, 0.2});
    flier = add_ball(world, 0.1, {-3, 0, 0.5}, {0, 0, 8});
  }
  World world;
  BodyId floor = 0, a = 0, b = 0, c = 0, far = 0, flier = 0;
};

constexpr double figure_end = 2;

// The groups that the body was in, one after the other; {} while it was isolated.
std::vector<Members> residences(const KernelTest& kernel, BodyId id) {
  std::vector<Members> result;
  for (const State* s : kernel.states(id)) {
    const Members now = s->group ? members_of(*s->group) : Members();
    if (result.empty() || result.back() != now) result.push_back(now);
  }
  return result;
}

// A state by name, so that it can be spoken of after it is gone.
using Name = std::tuple<BodyId, double, std::uint32_t, int, std::uint64_t>;

Name name_of(const State& s) {
  return {number(s.process), s.key.time, s.key.microstep, static_cast<int>(s.key.kind), s.key.id};
}

std::set<Name> names_in(World& world) {
  std::set<Name> names;
  for (BodyId id = 0; id < world.body_count(); ++id)
    for (const State* s : KernelTest(world).states(id)) names.insert(name_of(*s));
  return names;
}

// What hangs on the state: what follows it in its queue, and its ring; by search.
std::set<Name> hanging_on(const State* first) {
  std::set<Name> found;
  std::vector<const State*> open{first};
  while (!open.empty()) {
    const State* s = open.back();
    open.pop_back();
    if (!s || !found.insert(name_of(*s)).second) continue;
    open.push_back(s->next);
    for (const State* r = s->ring; r != s; r = r->ring) open.push_back(r);
  }
  return found;
}

TEST(Groups, figure_4_fusions_collisions_and_fissions_come_in_order) {
  Figure4 scene;
  KernelTest kernel(scene.world);
  kernel.begin();
  kernel.run_uncommitted(figure_end);
  const Members pair{scene.a, scene.b}, all{scene.a, scene.b, scene.c}, lone{scene.c};
  const auto of_c = residences(kernel, scene.c), of_a = residences(kernel, scene.a);

  const auto find = [](const std::vector<Members>& where, const Members& what, std::size_t from) {
    while (from < where.size() && where[from] != what) ++from;
    return from;
  };
  const std::size_t fused = find(of_c, all, 0);
  ASSERT_LT(fused, of_c.size()) << "c never fused";
  const std::size_t landed = find(of_c, lone, fused);
  ASSERT_LT(landed, of_c.size()) << "c never came to lie on the floor";
  EXPECT_LT(find(of_c, {}, fused), landed) << "c was never free after the fission";
  const std::size_t paired = find(of_a, pair, 0);
  EXPECT_LT(paired, find(of_a, all, 0)) << "a and b were no group before c came";
  EXPECT_LT(find(of_a, pair, find(of_a, all, 0)), of_a.size()) << "a and b are no group at the end";

  // hard blows: c stays isolated, a and b stay a group
  int blows = 0;
  for (const State* s : kernel.states(scene.c))
    if (s->key.kind == KeyKind::impact && !s->group && s->ring != s) {
      ++blows;
      EXPECT_EQ(s->ring->group ? members_of(*s->ring->group) : Members(), pair);
    }
  EXPECT_GE(blows, 1);
  // the fixed floor links nothing together
  for (const State* s : kernel.states(scene.far)) {
    if (s->group) {
      EXPECT_EQ(members_of(*s->group), Members{scene.far});
    }
  }
  EXPECT_EQ(validate_residences(scene.world.kernel().simulation), "");
}

// From every discontinuity of every member: what is removed is what hangs on it, and the run that
// goes on ends in the same graph, and in the same history.
TEST(Groups, figure_4_with_forced_rollbacks_at_each_stage_ends_in_the_same_state_graph) {
  Figure4 expected;
  KernelTest reference(expected.world);
  reference.begin();
  reference.run_uncommitted(figure_end);
  const std::uint64_t checksum = graph_checksum(expected.world.kernel().simulation.graph);
  std::vector<std::pair<BodyId, Key>> stages;
  for (const BodyId id : {expected.a, expected.b, expected.c}) {
    const auto states = reference.states(id);
    for (std::size_t i = 1; i < states.size(); ++i)
      if (long_tests() || states[i]->key.kind == KeyKind::impact || i % 5 == 0)
        stages.push_back({id, states[i]->key});
  }
  EXPECT_GT(stages.size(), 40u);
  expected.world.advance(figure_end + 0.2);
  const std::string history = expected.world.history_hash();

  for (const auto& [id, key] : stages) {
    Figure4 scene;
    KernelTest kernel(scene.world);
    kernel.begin();
    kernel.run_uncommitted(figure_end);
    ASSERT_EQ(graph_checksum(scene.world.kernel().simulation.graph), checksum);

    const std::set<Name> before = names_in(scene.world);
    const State* first = nullptr;
    for (const State* s : kernel.states(id))
      if (s->key == key) first = s;
    ASSERT_TRUE(first);
    const std::set<Name> gone = hanging_on(first);
    for (const Name& name : gone)
      EXPECT_TRUE(std::get<0>(name) != scene.far && std::get<0>(name) != scene.flier);
    EXPECT_EQ(kernel.roll_back(id, key), gone.size());
    std::set<Name> left;
    std::set_difference(before.begin(), before.end(), gone.begin(), gone.end(),
                        std::inserter(left, left.end()));
    EXPECT_EQ(names_in(scene.world), left) << show(key);
    EXPECT_EQ(validate_residences(scene.world.kernel().simulation), "") << show(key);
    EXPECT_EQ(validate_state_graph(scene.world.kernel().simulation), "") << show(key);
    EXPECT_EQ(KernelTest(scene.world).validate_event_queue(), "") << show(key);

    kernel.run_uncommitted(figure_end);
    EXPECT_EQ(graph_checksum(scene.world.kernel().simulation.graph), checksum) << show(key);
    scene.world.advance(figure_end + 0.2);
    EXPECT_EQ(scene.world.history_hash(), history) << show(key);
  }
}

// A rollback of one member takes the states of its group from all members, and leaves a group on
// the same floor alone.
TEST(Groups, rollback_of_one_member_removes_the_states_of_its_group_from_all) {
  Figure4 scene;
  KernelTest kernel(scene.world);
  kernel.begin();
  kernel.run_uncommitted(0.6);
  ASSERT_EQ(residences(kernel, scene.b).back(), (Members{scene.a, scene.b, scene.c}));
  const std::size_t far_states = kernel.states(scene.far).size();
  const std::size_t flier_states = kernel.states(scene.flier).size();
  // the group check before the last
  Key key = kernel.tail(scene.b).prev->key;
  ASSERT_EQ(key.kind, KeyKind::group_check);
  kernel.roll_back(scene.b, key);
  for (const BodyId id : {scene.a, scene.b, scene.c}) {
    EXPECT_LT(kernel.tail(id).key, key);
    EXPECT_EQ(kernel.tail(id).group, kernel.tail(scene.a).group);
  }
  EXPECT_EQ(kernel.states(scene.far).size(), far_states);
  EXPECT_EQ(kernel.states(scene.flier).size(), flier_states);
}

// A group lives as long as a state names it: until a rollback, or until GVT passes its end.
TEST(Groups, groups_are_freed_by_rollback_and_by_gvt) {
  Figure4 scene;
  KernelTest kernel(scene.world);
  kernel.begin();
  kernel.run_uncommitted(0.6);
  std::vector<std::weak_ptr<Group>> groups;
  for (const State* s : kernel.states(scene.a))
    if (s->group && (groups.empty() || groups.back().lock() != s->group))
      groups.push_back(s->group);
  ASSERT_GT(groups.size(), 4u);
  kernel.roll_back(scene.a, kernel.tail(scene.a).key);
  EXPECT_TRUE(groups.back().expired());
  EXPECT_FALSE(groups[groups.size() - 2].expired());
  scene.world.advance(0.7);
  for (const auto& group : groups) EXPECT_TRUE(group.expired());
}

TEST(Groups, long_runs_keep_few_states) {
  World world;
  const Scene scene = heap_scene(8, long_tests() ? 20 : 4);
  scene.fill(world);
  world.advance(scene.duration);
  EXPECT_LT(count_of(world.statistics(), "peak_states"), 2500);
  EXPECT_LT(world.kernel().simulation.graph.state_count(), 300u);
  EXPECT_GT(count_of(world.statistics(), "groups"), 500);
}

// Two boxes carried by one platform stay two groups.
TEST(Groups, kinematic_platform_links_nothing_together) {
  World world;
  platform_scene(1).fill(world);
  // neither does a callback that is handed the platform together with both boxes
  add_callback(world, {0, 1, 2}, 0.425, 0.25, [](double, std::span<StateView* const> targets) {
    for (StateView* view : targets.subspan(1))
      view->set_velocity(view->state().velocity + Vec3(0, 0.05, 0));
    return std::nullopt;
  });
  KernelTest kernel(world);
  bool seen[2] = {false, false};
  for (int i = 1; i <= 20; ++i) {
    world.advance(0.05 * i);
    const BodyId left = 1, right = 2, on_top = 3;
    const Group* l = kernel.tail(left).group.get();
    const Group* r = kernel.tail(right).group.get();
    if (l) {
      EXPECT_EQ(members_of(*l), Members{left});
      seen[0] = true;
    }
    if (r) {
      EXPECT_TRUE(members_of(*r) == Members{right} || members_of(*r) == (Members{right, on_top}));
      seen[1] = seen[1] || members_of(*r).size() == 2;
    }
  }
  EXPECT_TRUE(seen[0] && seen[1]);
}

// What lies on a platform that stands still for a while goes along when it moves.
TEST(Groups, platform_that_stood_still_takes_its_load_along) {
  World world;
  set_contact_for_all(world, 0, 0.8);
  BodyDef platform;
  platform.shape = make_box({3, 3, 0.2});
  platform.motion = make_keyframes(
      {{0, {0, 0, -0.1}, {}}, {2, {0, 0, -0.1}, {}}, {3, {0.6, 0, -0.1}, {}}}, false);
  world.add_body(platform);
  const BodyId box = add_box(world, {0.4, 0.4, 0.3}, {0, 0, 0.15});
  world.advance(4);
  EXPECT_NEAR(world.state(box).position.x(), 0.6, 0.02);
}

// A hard blow on the lower of two boxes: the group goes on with the same members, and momentum too.
TEST(Groups, hard_impact_on_a_member_leaves_the_group_living) {
  World world;
  set_contact_for_all(world, 0.5, 0.3);
  add_block(world, {10, 10, 1}, {0, 0, -0.5});
  const BodyId lower = add_box(world, {0.4, 0.4, 0.2}, {0, 0, 0.1});
  const BodyId upper = add_box(world, {0.4, 0.4, 0.2}, {0, 0, 0.3});
  const BodyId ball = add_ball(world, 0.05, {-1, 0, 0.3}, {4, 0, 0.75});
  KernelTest kernel(world);
  kernel.begin();
  while (kernel.tail(ball).key.kind != KeyKind::impact &&
         world.kernel().simulation.queue.top_priority() < 1)
    world.kernel().process_next();
  const State& struck = kernel.tail(ball);
  ASSERT_EQ(struck.key.kind, KeyKind::impact);
  EXPECT_FALSE(struck.group);
  int ring = 1;
  for (const State* s = struck.ring; s != &struck; s = s->ring) {
    ++ring;
    ASSERT_TRUE(s->group);
    EXPECT_EQ(members_of(*s->group), (Members{lower, upper}));
    EXPECT_EQ(s->group->key, struck.key);
  }
  EXPECT_EQ(ring, 3) << "the blow stands in the queues of ball and both members";
  world.advance(1);
  EXPECT_LT(world.state(ball).velocity.x(), 0);
}

// A tilted box falls over one edge onto another that the group knew nothing of: however rare the
// checks, the edge is met where it comes down.
TEST(Groups, feature_that_comes_down_between_checks_is_met) {
  World world;
  world.set_group_check_rate(8);
  set_contact_for_all(world, 0, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  const Vec3 half(0.2, 0.2, 0.1);
  BodyDef def = body_of(make_box(2 * half), Vec3::Zero(), Vec3::Zero());
  def.orientation = rotation_by(Vec3(0, 0.3, 0));
  def.position.z() = 0.2 * std::sin(0.3) + 0.1 * std::cos(0.3) + 1e-6;
  const BodyId box = world.add_body(def);
  const auto lowest = [&] {
    const BodyState s = world.state(box);
    const Mat3 R = s.orientation.toRotationMatrix();
    return s.position.z() - R.row(2).cwiseAbs().dot(half);
  };
  double deepest = 0;
  for (int i = 1; i <= 400; ++i) {
    world.advance(0.002 * i);
    deepest = std::min(deepest, lowest());
  }
  EXPECT_GT(deepest, -1e-3);
  EXPECT_NEAR(world.state(box).position.z(), 0.1, 1e-3) << "the box lies flat";
}

// A member that slowly nears a block is linked to it by the group check before they touch: the
// boxes of members reach far enough.  Coming through a collision check instead would make it a
// fusion.
TEST(Groups, slow_neighbour_is_linked_before_it_touches) {
  World world;
  set_contact_for_all(world, 0.2, 0);
  const BodyId floor = add_wall(world, Vec3::UnitZ(), 0);
  const BodyId block = add_block(world, {0.4, 1, 1}, {0.61, 0, 0.5});
  const BodyId box = add_box(world, {0.4, 0.4, 0.4}, {0.2, 0, 0.2}, {0.05, 0, 0});
  std::vector<std::pair<BodyId, BodyId>> fusions;
  world.add_collision_observer(
      [&](const Collision& c) {
        fusions.push_back({c.body1, c.body2});
      },
      CollisionKind::fusion);
  world.advance(0.199);
  EXPECT_EQ(fusions, (std::vector<std::pair<BodyId, BodyId>>{{floor, box}}));
  EXPECT_LT(world.state(box).position.x(), 0.21);
  EXPECT_TRUE(KernelTest(world).tail(box).group->find(pair_id(block, box)));
}

// A contact that breaks is told once, with its bodies, and so is each fusion.
TEST(Groups, fusions_and_fissions_are_told_one_row_a_contact) {
  Figure4 scene;
  std::vector<Collision> fusions, fissions;
  scene.world.add_collision_observer([&](const Collision& c) { fusions.push_back(c); },
                                     CollisionKind::fusion);
  scene.world.add_collision_observer([&](const Collision& c) { fissions.push_back(c); },
                                     CollisionKind::fission);
  scene.world.advance(figure_end);
  const auto rows = [](const std::vector<Collision>& all, BodyId x, BodyId y) {
    return std::count_if(all.begin(), all.end(),
                         [&](const Collision& c) { return c.body1 == x && c.body2 == y; });
  };
  EXPECT_GE(rows(fusions, scene.floor, scene.a), 1);
  EXPECT_GE(rows(fusions, scene.a, scene.b), 1);
  EXPECT_GE(rows(fusions, scene.b, scene.c), 1);
  EXPECT_GE(rows(fusions, scene.floor, scene.c), 1);
  EXPECT_EQ(rows(fissions, scene.b, scene.c), rows(fusions, scene.b, scene.c));
  EXPECT_EQ(rows(fissions, scene.floor, scene.a), 0);
  for (const Collision& c : fissions) {
    EXPECT_EQ(c.kind, CollisionKind::fission);
    EXPECT_NEAR(c.normal.norm(), 1, 1e-9);
    EXPECT_EQ(c.impulse, 0);
  }
  EXPECT_EQ(count_of(scene.world.statistics(), "fusions"),
            static_cast<std::int64_t>(fusions.size()));
}

}  // namespace
}  // namespace tw::test
