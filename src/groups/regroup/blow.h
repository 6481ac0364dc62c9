// A blow on what is in contact, held or joined: who takes it up.
//
// What *carries* a load, the ground under a cube, a stop that is leant on, or a hold that was not
// made to give way, belongs to the blow, and all answer together (dynamics/impulse-solver.h).  What
// merely touches, as the balls of a cradle do, takes a blow of its own afterwards with the
// restitution of its pair, the fastest first, so that the answer is the same as if the two had not
// been in contact.  What is not reached by either keeps its motion.
//
// A function of what stands before the key.
//
// Source: doc/numerics/impacts.md, "Blows on what lies".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "collision/distance/separation.h"
#include "groups/regroup/regroup.h"

namespace tw {

// Where the first two successors strike each other.
struct BlowAt {
  std::span<const ContactPoint> points;  // normals from the first to the second
  const ContactParameters* law = nullptr;
  double speed = 0;  // m/s, > 0: the fastest approach of the points
};

struct Blow {
  ImpulseContact largest;  // of the two: where the impulse was largest
  double approach = 0;     // m/s, there
  double impulse = 0;      // N s, along normals
  double held_work = 0;    // J, of bodies that no impulse moves
  bool left_over = false;  // the two approach still
  bool given_up = false;   // somebody does
};

// Gives the two, and whom else the blow reaches, who is added to the successors with a new arc,
// their velocities.  Or whose arcs must be known first; then nothing is changed.
std::variant<Blow, Waits> take_up(const Before& before, const Known& known, const BlowAt& at,
                                  std::vector<Successor>& successors);

// Of the contacts at these points, each manifold of several as one at its centroid.
std::vector<ImpulseContact> centroids(std::span<const ContactPoint> points,
                                      std::span<const ImpulseContact> contacts);

// m/s: the approach that a contact bears without an impulse, at that gap (m).
double borne_by(const Scene& scene, const Body& a, const Body& b, const ContactConstants& law,
                double gap);

}  // namespace tw
