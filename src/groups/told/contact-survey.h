// Reading the contacts of all groups at one instant.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "dynamics/scene.h"
#include "timeline/state.h"

namespace tw {

struct ContactForce;
struct ContactTag;

// A contact of a group at one instant.
struct ContactReading {
  BodyId body1 = 0, body2 = 0;   // body1 < body2
  Vec3 point = Vec3::Zero();     // where the force acts, world, m
  Vec3 normal = Vec3::UnitZ();   // unit, world, from body1 to body2
  double gap = 0;                // m; negative: depth
  double force = 0;              // N, on body2 along the normal, >= 0; 0: not in touch just now
  Vec3 friction = Vec3::Zero();  // N, on body2, world
  bool slipping = false;         // in touch, with the friction at its limit
  // N m, on body2, world, beside that of the forces: against rolling, and along the normal against
  // spinning.
  Vec3 torque = Vec3::Zero();
};

// Of a contact of a group, turned so that body1 < body2.
ContactReading reading_of(const ContactTag& tag, const ContactForce& force);

struct ContactSurvey {
  std::vector<ContactReading> contacts;  // by pair of bodies, then in the group's own order
  std::size_t groups = 0;
  std::size_t bodies_at_rest = 0;
};

// The state of a body that holds at the instant.
using StateOf = std::function<const State&(BodyId)>;

// Each pair's contacts once, as its owner has them (before.h).
ContactSurvey survey_contacts(const Scene& scene, const StateOf& state_of, double when);

// Energy of all contact springs, each pair's as its owner has it, J.
double elastic_energy(const Scene& scene, const StateOf& state_of, double when);

// The deepest contact of moving groups, m >= 0: what rests is as deep as it was when it came to
// rest, and what is squeezed is told by itself.
double deepest_contact(const Scene& scene, const StateOf& state_of, double when);

// The work that kinematic bodies do through contacts on the body of `state`, from the state to
// `until` along its arc, J: with that of impulses what an energy balance needs.
double contact_work(const Scene& scene, const State& state, double until);

}  // namespace tw
