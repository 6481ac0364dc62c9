// The scene: what a world is made of, and what stays as it is while a run goes on.
//
// Whoever decides how bodies move asks this, the states and nothing else: so a decision can be
// tested without a world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "dynamics/body.h"
#include "dynamics/contact-book.h"

namespace tw {

struct Multibody;

// What users set, as far as the motion depends on it.
struct SceneOptions {
  Vec3 gravity{0, 0, -9.81};    // m/s^2
  double accuracy = 1e-6;       // relative
  double group_check_rate = 0;  // Hz, the finest; 0: by the sizes of the members
  bool cash_karp = false;       // isolated bodies never fly in closed form: the paper's integrator
  bool push_overlaps = false;   // what overlaps at the start is pushed apart
};

struct Scene {
  explicit Scene(const SceneOptions& settings) : options(settings) {}

  std::vector<std::unique_ptr<Body>> bodies;            // by number
  std::vector<BodyId> first_bodies;                     // of each process, by number
  std::vector<std::shared_ptr<Multibody>> multibodies;  // in the order in which they came
  ContactBook contacts;
  const SceneOptions& options;

  const Body& body(BodyId id) const { return *bodies[id]; }
  ProcessId process_of(BodyId id) const { return bodies[id]->process; }
  // The body of a process that has one.
  const Body& body_of(ProcessId process) const { return *bodies[first_bodies[number(process)]]; }
  // The magnitude of gravity, or the standard one where there is none: the scale of what is slow,
  // m/s^2, > 0.
  double gravity_scale() const;
  static bool are_neighbours(const Body& a, const Body& b) {
    return !a.neighbours.empty() &&
           std::binary_search(a.neighbours.begin(), a.neighbours.end(), b.id());
  }
  // Whether some pairs may not touch, or neighbours may.
  bool may_disable() const { return contacts.may_disable() || !multibodies.empty(); }
  // Whether the two may touch at all; neighbours only by a rule that names both.
  bool may_collide(const Body& a, const Body& b) const {
    if (a.info.removed || b.info.removed || (a.never_moves() && b.never_moves())) return false;
    const ContactParameters& p = contacts.between(a.id(), b.id());
    return p.collide && (p.collide_names_both || !are_neighbours(a, b));
  }
};

}  // namespace tw
