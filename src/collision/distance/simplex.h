// The point of a simplex nearest to the origin: the inner step of GJK.
//
// Legend: w_i = a_i - b_i are points of the Minkowski difference A - B, v = sum lambda_i w_i is the
// nearest point.
//
// Accuracy: v errs by the rounding of the points, however thin the triangles are; over a triangle
// higher than |v| it is the projection on the triangle's plane, so that its direction keeps all
// digits however near the origin is.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "math/vec.h"

namespace tw {

struct SimplexPoint {
  Vec3 w;
  int a = 0;  // vertex of A
  int b = 0;  // vertex of B
};

struct Simplex {
  int count = 0;
  std::array<SimplexPoint, 4> points;
  std::array<double, 4> lambda{};
  Vec3 v = Vec3::Zero();
};

// Reduces the simplex to the least face that holds its point nearest to the origin and sets lambda
// and v.  In a simplex of four the last point is the newest, and the face of the other three is
// taken to lie beyond it.  Returns true where four points enclose the origin; then nothing is
// changed.
bool reduce(Simplex& simplex);

}  // namespace tw
