// Exact volume integrals of convex solids at density 1.
//
// Source: second moments by the divergence theorem over tetrahedra, e.g. B. Mirtich, "Fast and
// accurate computation of polyhedral mass properties", J. Graphics Tools 1 (1996).
//
// Legend: V volume, c centroid, C = integral (x-c)(x-c)^T dV, inertia = trace(C) 1 - C.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/polyhedron.h"
#include "geometry/shape.h"

namespace tw {

MassProperties sphere_mass(double radius);
MassProperties box_mass(const Vec3& edges);
// About the z axis.
MassProperties cylinder_mass(double radius, double length);
// About the z axis; the length is that of the axis between the centres of the rounded ends.
MassProperties capsule_mass(double radius, double length);
// About the z axis, the centroid at the origin.
MassProperties cone_mass(double radius, double height);
MassProperties ellipsoid_mass(const Vec3& semi_axes);
MassProperties polyhedron_mass(const Polyhedron& polyhedron);
// The sum of several solids in one frame; an overlap counts twice.  Of nothing: all zero.
MassProperties summed_mass(const std::vector<MassProperties>& solids);
// The same solid moved by a rigid transform.
MassProperties placed_mass(const MassProperties& solid, const Frame& placement);

}  // namespace tw
