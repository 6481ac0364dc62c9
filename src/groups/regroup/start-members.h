// The members of a group's arc at its start, and the tolerances of its steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/placed-body.h"
#include "dynamics/scene.h"
#include "integrate/arc/group-arc.h"
#include "timeline/state.h"

namespace tw {

class StartOfMembers {
 public:
  StartOfMembers(const Scene& scene, GroupStart& start) : scene_(scene), start_(start) {}
  // The next member, as its data have it; `joints`: of its multibody, where it is a link.
  void add(const Body& body, const PoseTwist& point, const StateData& data,
           const MultibodyStatePtr& joints);
  // After all, contacts and bonds, too.
  void set_tolerances();

 private:
  void add_link(const Body& body, const StateData& data, const MultibodyStatePtr& joints);

  const Scene& scene_;
  GroupStart& start_;
  double size_ = never, speed_ = 0, reach_ = 0;
  double slimness_ = 1;  // of the thinnest member
};

}  // namespace tw
