// Mass properties of a rigid body, resolved from what the user gave.
//
// Frames: B the body frame (the shape's), P the principal frame: origin at the centre of mass, axes
// along the principal axes of inertia.  The kernel integrates P; users see B.  Where the inertia
// tensor is already diagonal in B the axes of P are those of B, so nothing is rounded.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "geometry/shape.h"
#include "math/vec.h"

namespace tw {

// What the user gave; absent values come from the shape.
struct MassSpecification {
  std::optional<double> density;       // kg/m^3, default 1000
  std::optional<double> mass;          // kg; scales the shape's inertia
  std::optional<Mat3> inertia;         // kg m^2, about the centre of mass, axes of B
  std::optional<Vec3> center_of_mass;  // m, in B
};

struct RigidInertia {
  double mass = 0;              // kg
  Vec3 moments = Vec3::Zero();  // principal moments, kg m^2
  Pose X_BP;                    // P in B
};

// `name` is for messages.  Errors: a mass or density that is not positive, an inertia that is not
// symmetric positive definite or breaks I1 + I2 >= I3 (no mass distribution has it), an unbounded
// or absent shape without mass and inertia.
RigidInertia resolve_inertia(const MassSpecification& given, const Shape* shape,
                             const std::string& name);

}  // namespace tw
