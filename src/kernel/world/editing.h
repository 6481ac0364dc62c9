// Changes between runs: one body, or all that hang together with some.
//
// A change is a discontinuity at the present time; what is committed stays.  Where it is refused
// nothing has happened: errors come before anything enters, or what has entered is taken back.
// What changes nothing enters nothing, and the future stays as it is.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "kernel/world/callback.h"
#include "timeline/successor.h"

namespace tw {

class Discontinuities;
class GroupEvents;
class SuccessorView;
struct Simulation;

class Editing {
 public:
  Editing(Simulation& simulation, Discontinuities& discontinuities, GroupEvents& groups)
      : sim_(simulation), discontinuities_(discontinuities), groups_(groups) {}

  struct Edited {
    Key key;
    ProcessId process{};
    std::vector<BodyId> placed;  // elsewhere: the body, or the links of its multibody
  };
  // `change` gets a view of the body.
  Edited edit(BodyId id, const std::function<void(StateView&)>& change);
  // The last edit has not happened.
  void take_back(const Edited& edited);
  // The same of two at once, which stay where they are; they may be one.
  void edit_pair(BodyId a, BodyId b,
                 const std::function<void(SuccessorView&, SuccessorView&)>& change);
  // The two come into contact as they are, and all that was placed together with them.
  void bring_together(BodyId a, BodyId b);
  void set_gravity(const Vec3& gravity);
  // The groups of these take what was set since, and wake.
  void renew_groups(std::vector<BodyId> concerned);
  // Whoever touches the body, or hangs on it by a spring, gets an arc without it.
  void let_go_of(BodyId id);

 private:
  Key edit_key(const std::vector<ProcessId>& concerned) const;
  Key key_around(const std::vector<ProcessId>& edited) const;
  bool changes(const Key& key, const std::vector<Successor>& successors) const;
  void enter(const Key& key, std::vector<Successor>& successors);
  void edit_together(const std::function<bool(BodyId)>& concerned,
                     const std::function<void(Successor&)>& change);

  Simulation& sim_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
};

}  // namespace tw
