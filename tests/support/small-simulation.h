// Balls and fixed planes in a simulation without a loop: what the parts of the kernel share, filled
// by hand, so that each part can be tested by itself.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "geometry/shape.h"
#include "groups/regroup/regroup.h"
#include "kernel/loop/simulation.h"
#include "kernel/world/make-body.h"

namespace tw::test {

class SmallSimulation : public Simulation {
 public:
  SmallSimulation() { present.settings.gravity = Vec3::Zero(); }

  BodyId add_ball(double radius, const Vec3& position, const Vec3& velocity) {
    BodyDef def;
    def.shape = make_sphere(radius);
    def.position = position;
    def.velocity = velocity;
    return add(def);
  }
  // A fixed half-space n.x <= 0.
  BodyId add_plane(const Vec3& normal) {
    BodyDef def;
    def.shape = make_half_space(normal, 0);
    def.fixed = true;
    return add(def);
  }
  BodyId add(const BodyDef& def) {
    const BodyId id = static_cast<BodyId>(scene.bodies.size());
    auto body = make_body(def, id, "body-" + std::to_string(id));
    body->process = graph.add_process();
    processes.push_back({});
    processes.back().id = body->process;
    processes.back().bodies = {id};
    State& state = *graph.append(body->process, {present.time, 0, KeyKind::birth, id});
    make_birth(*body, def, present.settings.gravity, state);
    processes.back().claim = state.key;
    scene.first_bodies.push_back(id);
    scene.contacts.add_body(*body);
    scene.bodies.push_back(std::move(body));
    return id;
  }

  State& tail(BodyId id) { return *graph.tail(process_of(id)); }
  // A discontinuity that gives the body a new velocity.
  void turn(BodyId id, const Key& key, const Vec3& velocity) {
    Successor successor = make_successor(before(key), process_of(id), true);
    successor.data.v = velocity;
    let_fly(body(id), successor.data);
    static_cast<StateData&>(*graph.append(process_of(id), key)) = successor.data;
  }
};

}  // namespace tw::test
