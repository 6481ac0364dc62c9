// A scene of boxes on a floor and the states before a key: all that contact groups are decided by,
// without a world, a loop or events; and what their phases are asked one by one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "groups/contacts/contacts.h"
#include "groups/ends/check-times.h"
#include "groups/ends/end-test.h"
#include "groups/regroup/regroup.h"
#include "integrate/standing.h"

namespace tw::test {

class SmallScene {
 public:
  SceneOptions options;
  tw::Scene scene{options};
  StateGraph graph;
  BroadPhase grid;
  std::vector<BodyId> unbounded;
  Surroundings surroundings{scene, grid, unbounded};
  GroupCounters counters;

  // A fixed half-space z <= 0.
  BodyId add_floor() {
    Body& body = add(make_half_space(Vec3::UnitZ(), 0), BodyKind::fixed, Pose());
    body.unbounded = body.is_fixed_plane = true;
    body.plane_normal = Vec3::UnitZ();
    unbounded.push_back(body.id());
    return body.id();
  }
  // A cube of 1 kg, born at time 0.
  BodyId add_cube(double edge, const Vec3& x, const Vec3& v = Vec3::Zero(),
                  const Vec3& w = Vec3::Zero(), const Quat& q = Quat::Identity()) {
    Body& body = add(make_box(Vec3::Constant(edge)), BodyKind::dynamic, {x, q});
    body.mass = body.info.mass = 1;
    body.moments = Vec3::Constant(edge * edge / 6);
    State& state = *graph.head(body.process);
    state.x = x;
    state.q = q;
    state.v = v;
    state.L = angular_momentum(body, q, w);
    state.acceleration = options.gravity;
    let_fly(body, state);
    return body.id();
  }
  BodyId add_fixed_box(const Vec3& edges, const Vec3& x) {
    return add(make_box(edges), BodyKind::fixed, {x, Quat::Identity()}).id();
  }

  // A contact by hand, of a plane of `reference` with a point of `other`: those of a pair in a row.
  NewContact& touch(Contacts& contacts, BodyId reference, BodyId other, const Vec3& point,
                    const Vec3& normal, double gap = 0) const {
    const Body &a = scene.body(reference), &b = scene.body(other);
    MassRange masses;
    for (const Body* body : {&a, &b})
      if (body->dynamic()) masses.add(body->mass);
    const std::uint64_t pair = pair_id(reference, other);
    if (contacts.pairs.empty() || contacts.pairs.back().id != pair)
      contacts.pairs.push_back(
          {pair, static_cast<std::uint32_t>(contacts.all.size()), 0, false, masses});
    ++contacts.pairs.back().count;
    NewContact contact;
    contact.contact.law = contact_scales(scene, a, b, masses).law;
    contact.tag.reference = reference;
    contact.tag.other = other;
    contact.gap = gap;
    contact.normal = normal;
    contact.point = point;
    return contacts.all.emplace_back(contact);
  }

  ProcessId process(BodyId id) const { return scene.process_of(id); }
  std::vector<ProcessId> processes(const std::vector<BodyId>& ids) const {
    std::vector<ProcessId> result;
    for (const BodyId id : ids) insert(result, process(id));
    return result;
  }
  const State& tail(BodyId id) const { return *graph.tail(process(id)); }
  const Group& group_of(BodyId id) const { return *tail(id).group; }
  Before before(const Key& key) const { return Before(scene, graph, key); }

  // Regroups after a discontinuity that gives these new arcs, `change`d, and enters what follows.
  template <class Change>
  std::vector<Successor> regroup(const Key& key, Cause cause, const std::vector<BodyId>& struck,
                                 Change change) {
    std::vector<Successor> given;
    for (const BodyId id : struck) {
      // nobody looks at an arc whose end is not known
      if (Group* group = graph.tail(process(id))->group.get())
        test_end(scene, surroundings, *group, counters);
      given.push_back(make_successor(before(key), process(id), scene.body(id).dynamic()));
      change(given.back());
    }
    const auto all = [](ProcessId) { return true; };
    auto result = tw::regroup(before(key), surroundings, all, {cause}, given, counters);
    std::vector<Successor> made = std::move(std::get<Regrouped>(result).successors);
    enter(key, made);
    return made;
  }
  std::vector<Successor> regroup(const Key& key, Cause cause, const std::vector<BodyId>& struck) {
    return regroup(key, cause, struck, [](Successor&) {});
  }

  // The two come to touch, softly.
  std::vector<Successor> fuse(BodyId a, BodyId b, double when, std::uint32_t microstep = 1) {
    return regroup({when, microstep, KeyKind::impact, pair_id(a, b)}, Cause::fusion,
                   {std::min(a, b), std::max(a, b)});
  }
  // The check of the group that the body is in, where its arc ends.
  std::vector<Successor> check(BodyId id, const std::vector<BodyId>& members) {
    Group& group = *graph.tail(process(id))->group;
    test_end(scene, surroundings, group, counters);
    Key key = group_check_key(group, group.next_check());
    key.id = number(process(members.front()));
    return regroup(key, Cause::check, members);
  }

 private:
  Body& add(const ShapePtr& shape, BodyKind kind, const Pose& pose) {
    auto body = std::make_unique<Body>();
    const BodyId id = static_cast<BodyId>(scene.bodies.size());
    body->info.id = id;
    body->info.name = "body-" + std::to_string(id);
    body->info.kind = kind;
    body->contact = {id, ""};
    body->shape_P = shape;
    body->radius = shape->radius_about_origin();
    body->least_width = shape->least_width();
    body->thickness = shape->thickness();
    if (kind != BodyKind::dynamic) body->motion = make_standing(pose);
    body->process = graph.add_process();
    scene.first_bodies.push_back(id);
    scene.contacts.add_body(*body);
    State* state = graph.append(body->process, {0, 0, KeyKind::birth, id});
    state->arc_key = state->key;
    state->follows = body->motion;
    if (shape->bounded()) {
      Aabb box = shape->bounds(Frame(pose));
      box.grow(0.2 * body->least_width);
      grid.place(id, box, kind == BodyKind::fixed);
    }
    scene.bodies.push_back(std::move(body));
    return *scene.bodies.back();
  }

  void enter(const Key& key, const std::vector<Successor>& successors) {
    std::vector<State*> ring;
    for (const Successor& successor : successors) {
      if (!successor.enters()) continue;
      State* state = graph.append(successor.process(), key);
      static_cast<StateData&>(*state) = successor.data;
      if (successor.starts_arc() && !state->group) let_fly(*successor.body, *state);
      ring.push_back(state);
    }
    graph.close_ring(ring);
  }
};

// What the phases of a regrouping are asked, and all that it refers to.
struct Question {
  Before before;
  RegroupRequest request;
  PlacedNow placed_now;
  std::vector<Successor> successors;
  Regrouping work;

  // The first get new arcs, those at the border keep theirs.
  Question(const SmallScene& small, const Key& key, Cause cause, const std::vector<BodyId>& changed,
           const std::vector<BodyId>& border = {})
      : before(small.before(key)),
        request{cause},
        successors(make_successors(before, changed, border)),
        work(before, small.surroundings, request, placed_now, successors) {}
  Question(const Question&) = delete;
  Question& operator=(const Question&) = delete;

  Successor& of(BodyId id) { return *work.successor_of(id); }
  void set_velocity(BodyId id, const Vec3& v) { of(id).data.v = of(id).point.v = v; }

 private:
  static std::vector<Successor> make_successors(const Before& before,
                                                const std::vector<BodyId>& changed,
                                                const std::vector<BodyId>& border) {
    std::vector<Successor> result;
    const auto add = [&](BodyId id, bool new_arc) {
      result.push_back(make_successor(before, before.scene().process_of(id), new_arc));
    };
    for (const BodyId id : changed) add(id, true);
    for (const BodyId id : border) {
      add(id, false);
      result.back().role = Role::border;
      result.back().data.changed = false;
    }
    return result;
  }
};

// Cubes of 0.1 m in a row on the floor, all in one group since time 0, at rest against each other
// with this gap.
struct Row : SmallScene {
  BodyId floor = add_floor();
  std::vector<BodyId> cubes;

  explicit Row(int count, double gap = 0) {
    for (int i = 0; i < count; ++i) cubes.push_back(add_cube(0.1, {(0.1 + gap) * i, 0, 0.05}));
    // first each with the floor, then with its neighbour
    std::uint32_t microstep = 0;
    for (const BodyId cube : cubes) fuse(floor, cube, 0, ++microstep);
    for (int i = 1; i < count; ++i) fuse(cubes[index(i - 1)], cubes[index(i)], 0, ++microstep);
    // then all join
    regroup({0, 99, KeyKind::group_check, 0}, Cause::check, cubes);
  }
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  Key after() const { return {0, 100, KeyKind::impact, 0}; }
};

}  // namespace tw::test
