// Forward dynamics of one multibody by several engines: what they have in common.
//
// In C++ 17: Simbody's headers are no C++ 20.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>

#include "multibody/tree.h"

namespace tw::test {

class DynamicsEngine {
 public:
  virtual ~DynamicsEngine() = default;
  // u' from q, u (as of Tree) and the joints' torques, under the gravity given at the start: all of
  // it, from the sines on.
  virtual void accelerations(const double* q, const double* u, const double* tau, double* rate) = 0;
};

using Links = std::vector<multibody::LinkSpec>;

// All joints; their laws are left out.
std::unique_ptr<DynamicsEngine> make_simbody(const Links& links, const Vec3& gravity);
// A chain or a tree below one link, which may be free, of revolute joints; a free link's u' are
// MuJoCo's own.
std::unique_ptr<DynamicsEngine> make_mujoco(const Links& links, const Vec3& gravity);

}  // namespace tw::test
