// What an arc keeps of its steps: states at the nodes and the dense output between them.
//
// Links of multibodies have records of their own (joint-record.h); the others are counted here. Per
// node and member x, v, L, w, q (16 numbers), per pack of contacts the stretches (12), per pack
// that resists rolling the bends (12).  Per step and member theta and theta' at its end (6) and D3,
// D4 for v, L (12; as of rodas4.h), per row of stretches or bends D3, D4 (24),
// and where some contact is not of the plane kind the normals at the step's start (12).
//
// Positions and rotation vectors are the cubics with the nodes' values and rates: order 3 as the
// dense output of the method, but with continuous rates, so that pose rates and bounds on their
// change suffice for certificates across nodes.
//
// An arc may have thousands of steps (bodies that swing on springs), and certificates ask for the
// bounds of all that is left of it at each of theirs: those of full blocks of steps are kept.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "integrate/arc/bounds-tree.h"
#include "integrate/implicit/group-system.h"
#include "integrate/implicit/lanes.h"

namespace tw {

class GroupRecord {
 public:
  GroupRecord(const GroupStart& start, const GroupSystem& system);
  // A copy of what one member (0 there) does from the step that `from` lies in on; its answers have
  // the same bits.
  GroupRecord stretch_of(int member, double from) const;

  int steps() const { return static_cast<int>(times_.size()) - 1; }
  double start() const { return times_.front(); }
  double reached() const { return times_.back(); }
  // How many it holds: its memory in doubles.
  std::size_t numbers() const { return nodes_.size() + steps_.size(); }
  double time(int node) const { return times_[static_cast<std::size_t>(node)]; }

  // y of the step that begins at the last node, theta = 0; sets the attitudes of the system.
  void load_last(GroupSystem& system, double* y) const;
  // Appends the step to `time`: y1, D3, D4 in the layout of group-system.h; the system's attitudes
  // and sides are those of the step's start.
  void append(double time, const GroupSystem& system, const double* y1, const double* d3,
              const double* d4);

  // The step that holds `time`, its start included (-1: at or after the last node) or its end
  // included.
  int step_from(double time) const;
  int step_to(double time) const;

  // At a time in [start, reached].
  Vec3 position(int member, double time) const { return position_of(slot(member), place(time)); }
  void velocities(int member, double time, Vec3& v, Vec3& L) const {
    velocities_of(slot(member), place(time), v, L);
  }
  LaneVec stretch(int pack, double time) const { return row(pack, time); }
  // Zero where the pack has none.
  LaneVec bend(const ContactPack& pack, double time) const {
    return pack.bend < 0 ? LaneVec{} : row(packs_ + pack.bend, time);
  }
  LaneVec side(int pack, double time) const;
  void pose_rates(int member, double time, Vec3& dx, Vec3& w) const;
  Pose pose(int member, double time) const {
    const Place at = place(time);
    return {position_of(slot(member), at), attitude_of(slot(member), at)};
  }
  // Pose, velocity and angular momentum.
  void motion(int member, double time, Vec3& x, Quat& q, Vec3& v, Vec3& L) const {
    const Place at = place(time);
    x = position_of(slot(member), at);
    q = attitude_of(slot(member), at);
    velocities_of(slot(member), at, v, L);
  }
  // Pose and rates by one look-up of the step; the same bits.
  PoseTwist path_at(int member, double time) const;
  Twist rates(int member, double time) const {
    Twist rates;
    pose_rates(member, time, rates.v, rates.w);
    return rates;
  }
  // As GroupArc::bounds; from <= to, both in [start, reached], at least one step.
  MotionBounds bounds(int member, double from, double to) const;
  // As Trajectory's; `never` where it would take long.
  double turn_change_across(const Vec3& n, int member, double from, double to) const;

 private:
  using Row = std::vector<double>;
  // Cubic (1-r) y0 + r (y1 + (1-r)(D3 + r D4)) of a step; lanes are x, y, z, and one that is 0.
  struct Cubic {
    Lanes y0, y1, d3, d4;
    Lanes value(double r) const {
      const Lanes rest = lanes(1 - r), at = lanes(r);
      return rest * y0 + at * (y1 + rest * (d3 + at * d4));
    }
    // by r
    Lanes rate(double r) const {
      return y1 - y0 + lanes(1 - 2 * r) * d3 + lanes(r * (2 - 3 * r)) * d4;
    }
    Lanes second(double r) const { return lanes(-2) * d3 + lanes(2 - 6 * r) * d4; }
  };

  const double* node(int i) const {
    return nodes_.data() + node_size_ * static_cast<std::size_t>(i);
  }
  const double* step(int i) const {
    return steps_.data() + step_size_ * static_cast<std::size_t>(i);
  }
  GroupRecord() = default;
  // The fraction r of the step that follows a node.  At r = 0 what stands at the node is taken as
  // it is, so that it makes no difference whether there is a next step already: of a cubic a -0
  // would become 0.
  struct Place {
    int node;
    double r;
  };
  Place place(double time) const;
  // Slots are numbers among the members that move by themselves.
  int slot(int member) const {
    return slots_.empty() ? member : slots_[static_cast<std::size_t>(member)];
  }
  Vec3 position_of(int slot, Place at) const;
  Quat attitude_of(int slot, Place at) const;
  void velocities_of(int slot, Place at, Vec3& v, Vec3& L) const;
  LaneVec row(int number, double time) const;
  double fraction(int i, double time) const;
  double length(int i) const { return time(i + 1) - time(i); }
  Cubic path(int step, int slot) const;
  Cubic rotation(int step, int slot) const;
  const double* slot_node(int node, int slot) const;
  const double* slot_step(int step, int slot) const;
  void add_step_bounds(int step, int slot, double from, double to, MotionBounds& bounds) const;
  // After each step: where a block is complete.
  void keep_bounds();

  int count_ = 0, packs_ = 0, rows_ = 0;  // slots; packs; rows of stretches, then of bends
  std::vector<int> slots_;                // of each member, -1: a link; empty: none is one
  bool with_sides_ = false;
  std::size_t node_size_ = 0, step_size_ = 0;
  std::vector<double> times_;
  Row nodes_, steps_;
  std::vector<LaneVec> first_sides_;
  std::vector<BoundsTree> kept_bounds_;  // of each slot, by blocks of steps
};

}  // namespace tw
