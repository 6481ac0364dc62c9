// What acts at the joints: torques, damping, friction, springs, servos, stops.
//
// Of a scalar coordinate, T = sum of
//   given        tau
//   damping      -c u
//   friction     -f u / sqrt(u^2 + v0^2), v0 its friction_speed
//   spring       -k (q - rest)
//   servo        kp (target - q) + kd (target velocity - u), cut to +-max torque
//   stop         k d (1 + H s^4) (1 + b d') where positive, else 0; d the depth beyond the limit
//                (H s^4: dynamics/second-hardening.h)
// Of a spherical joint the same with vectors in the link's frame: of the angle, the vector
// 2 e.w e.vec() of the quaternion e from rest (target) to the joint's position, sin(angle) axis,
// whose potential k (1 - cos angle) is smooth everywhere; friction and the cut by length; the stop
// along the direction by which its limited angle (limits.h) grows.
//
// Laws are smooth but where a servo is cut and a stop comes loose; derivatives there are those of
// the branch taken.
//
// Source: the stop: K. Hunt, F. Crossley, Coefficient of restitution interpreted as damping in
// vibroimpact, J. Appl. Mech. 42 (1975); b = 1.5 (1 - e)/v.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include "multibody/coordinates.h"

namespace tw::multibody {

// A servo of one axis; of a spherical joint at all three.
struct ServoGains {
  double stiffness = 0;                                         // N m/rad or N/m
  double damping = 0;                                           // N m s/rad or N s/m
  double max_torque = std::numeric_limits<double>::infinity();  // N m or N
  bool operator==(const ServoGains&) const = default;
};

enum class Stop : std::uint8_t { none, lower, upper };

// What a state gives the joints; an empty span: none of it.
struct Inputs {
  In torques;                          // nv
  std::span<const ServoGains> servos;  // by axis
  In targets;                          // nq, with servos
  In target_velocities;                // nv; empty: 0
  std::span<const Stop> stops;         // by axis: which limit the joint leans on
};

// Errors, naming the joint's link: gains that are negative or not finite (NaN torque limits, too),
// torques and targets that are not finite, spans of a wrong length.
void require_inputs(const Tree& tree, const Inputs& inputs);

// tau (nv) at positions q (nq) and velocities u (nv).
void joint_torques(const Tree& tree, In q, In u, const Inputs& inputs, Out tau);

// Adds dtau/dz (z a displacement) and dtau/du to Kq and Ku, nv x nv, column by column.
void add_joint_derivatives(const Tree& tree, In q, In u, const Inputs& inputs, Out Kq, Out Ku);

// Potential of the springs, J; not of servos and stops.
double spring_energy(const Tree& tree, In q);

// v0, rad/s or m/s.
double friction_speed(const Axis& axis);
// By how much the torques at the joints are off their tangents at `from` when these have moved on
// by the displacement z (nv) to `to`: of friction that lets go (of joints that are faster by then),
// of stops that open, of servos whose torque is cut by then; elsewhere 0.  False: there is none.
struct JointMotion {
  In q, u;  // nq and nv numbers
};
bool unforeseen_torques(const Tree& tree, const JointMotion& from, const JointMotion& to, In z,
                        const Inputs& inputs, Out tau);
// The largest error of a joint with friction against how fast it moves, or slides at least: beyond
// 1 it is nothing but error which way friction acts.
double friction_doubt(const Tree& tree, In u, In error);
// dT/dd of the stop that it leans on, or would begin to, at positions q and rest, N m/rad or N/m.
double stop_rigidity(const Axis& axis, Stop stop, In q);
// b, s/rad or s/m, of an axis' stop: restitution e at stop_speed.
double stop_damping(const Axis& axis);
// What is slower than this at its stop leans on it, rad/s or m/s.
double stop_speed(const Axis& axis);
// How near its limit it is at its stop, rad or m.
double stop_tolerance(const Axis& axis, double limit);

}  // namespace tw::multibody
