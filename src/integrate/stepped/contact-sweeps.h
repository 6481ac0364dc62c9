// Contacts of a step, solved by sweeps: Gauss-Seidel over impulses, four at a time.
//
// Velocities are whitened: z = M^1/2 (v, w) of each member, as the change since the step's start,
//   z = (sqrt(m) v, G R^T w),  G^T G = inertia in the member's frame
// so that a contact row with the direction d at the arm r is W = (d/sqrt(m), G^-T R^T (r x d)): the
// point's velocity along d is W.z, and an impulse p there adds W p to z.  (A link of a multibody
// has longer rows of the same kind.)
//
// A step is some substeps of hs = h/substeps; poses, arms and normals are those of its start, gaps
// move on:  gap = gap0 + t u0 + W.y,  y = sum of hs z.  In each substep: weight and constant
// forces, the impulses of the substep before (*warm start*), sweeps that close gaps no further than
// they are open and push sunk points out, the substep's motion, sweeps that leave only the
// velocities that contacts allow (*relaxing*: what pushed out leaves nothing behind).
//   open    p' = max(0, p - m (u + gap/hs))
//   sunk    p' = max(0, p - m k (u + max(rate gap, -push)) - s p)
// with rate, k, s of a spring and damper of frequency f and damping ratio zeta over a substep,
//   w = 2 pi f,  f = share/(h0/substeps),  rate = w/(2 zeta + hs w),
//   s = 1/(1 + hs w (2 zeta + hs w)),  k = 1 - s
// f goes by the step that is not halved, h0: halved steps would push out the harder what the longer
// one has pressed in, and give energy by that.
// Friction follows each normal impulse: p_t - m_t u_t, cut to mu p; m_t = 2/trace of the tangential
// block (solving the block and cutting then makes friction point along M u instead of u, and a
// block brakes 7 % late).  Restitution at the step's end: u = -e u0 where u0 < -threshold and the
// contact pressed.
//
// Order: sweep-order.h.
//
// Motion between the substeps' impulses goes from middle to middle (leapfrog): half a substep first
// and last, so that what slides evenly braked stops where it must.
//
// Source: E. Catto, "Solver2D" (2024), for soft steps that relax; M. Macklin et al., "Small steps
// in physics simulation" (SCA 2019), for substeps.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "integrate/stepped/step-lanes.h"
#include "integrate/stepped/sweep-order.h"
#include "math/vec.h"

namespace tw {

// One contact point at a step's start; world frame, from a to b.
struct StepContact {
  int a = -1;  // number of the member; -1: it is none (the ground, what is driven)
  int b = 0;
  Vec3 normal = Vec3::UnitZ();
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // m, from the centres of mass
  Vec3 velocity = Vec3::Zero();                     // m/s, of b's point against a's
  double gap = 0;                                   // m
  double friction = 0, restitution = 0;
  double impulse = 0;              // N s, of the last substep before, then of the last one
  Vec3 tangential = Vec3::Zero();  // N s, likewise, on b
  int pair = 0, point = 0;         // where its impulse is kept
};

struct SweepTimes {
  double step = 0;      // s
  double unhalved = 0;  // s, of which it may be a half: springs are as stiff as for that
  int substeps = 2;
  int pushing = 2, relaxing = 2;  // sweeps a substep
};

// A member as a step's start has it.
struct SweepMember {
  double inverse_root_mass = 0;  // kg^-1/2
  Mat3 turning = Mat3::Zero();   // G^-T R^T
  Vec3 push = Vec3::Zero();      // sqrt(m) times the acceleration of constant forces
  Vec3 twist = Vec3::Zero();     // the same by constant torques
};

class ContactSweeps {
 public:
  // Overwrites the impulses of the contacts.
  void solve(std::span<const SweepMember> members, const SweepTimes& times,
             std::span<StepContact> contacts);
  // Of a member: change of its velocity, whitened, and its motion by that change alone.
  Vec3 velocity(std::size_t member) const { return part(change_[member], 0); }
  Vec3 turning(std::size_t member) const { return part(change_[member], 3); }
  Vec3 shift(std::size_t member) const { return part(at_end_[member], 0); }
  Vec3 turn(std::size_t member) const { return part(at_end_[member], 3); }

 private:
  // Four contacts of one level.
  struct alignas(64) Batch {
    // rows of n, t1, t2, of b and, with its sign, of a
    Lanes of_b[3][6], of_a[3][6];
    Lanes start[3];  // velocities at the step's start along n, t1, t2
    Lanes gap0, gap, mass, tangential_mass, friction, restitution;
    Lanes normal, tangent1, tangent2, most;  // impulses; the largest normal one
    int a[lane_count], b[lane_count], contact[lane_count];
    bool two;  // they are between two members each; else none has an a
  };
  // Their tangents, for what reads impulses.
  struct Tangents {
    LaneVec t1, t2;
  };
  struct Spring {
    double rate, k, s;
  };

  static Vec3 part(const StepRow& row, std::size_t from) {
    return {row.at[from], row.at[from + 1], row.at[from + 2]};
  }
  void begin(std::span<const SweepMember> members);
  void batch(std::span<const StepContact> contacts, std::size_t members);
  void set(Batch& batch, Tangents& tangents, std::span<const StepContact> contacts) const;
  void drive(double time);
  void move(double time);
  template <class Visit>
  void each_batch(Visit&& visit);
  void warm_start();
  template <bool pushing>
  void sweep(double inverse_time, const Spring& spring, const Spring& spring_of_ground);
  void update_gaps(double time);
  void restitute();
  void tell(std::span<StepContact> contacts) const;

  std::vector<Batch> batches_;
  std::vector<Tangents> tangents_;
  // of members; the last one is nobody's
  std::vector<StepRow> change_, moved_, at_end_, drive_, frames_;
  SweepOrder order_;
  std::vector<int> places_;
};

}  // namespace tw
