// FCL's signed distances, for distance-bench: plain numbers go in and out, since FCL's matrices are
// laid out for another instruction set than ours.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace tw::test {

// A convex solid about its origin, along z where it has an axis (a cone's tip at +z), placed.  m.
struct FclSolid {
  enum class Kind { ball, box, hull, cylinder, cone, capsule, ellipsoid };
  Kind kind = Kind::ball;
  // radius; the edges; -; radius and length (a capsule's without its caps); the semi-axes
  std::array<double, 3> sizes{};
  std::vector<std::array<double, 3>> vertices;  // of a hull
  std::vector<int> faces;  // of a hull: for each the number of its corners and these
  int face_count = 0;
  std::array<double, 9> rotation{};  // by columns
  std::array<double, 3> position{};
};

struct FclQuery {
  FclSolid a, b;
  double tolerance = 0;  // m
};

enum class FclSolver { libccd, own };

struct FclAnswer {
  // False: it threw, an assertion of its own stopped it, or it took more than five seconds.
  bool given = false;
  double distance = 0;  // m
  double cost = 0;      // ns
};

// In processes of their own, as FCL's assertions end the one they fail in.
std::vector<FclAnswer> fcl_distances(const std::vector<FclQuery>& queries, FclSolver solver);

}  // namespace tw::test
