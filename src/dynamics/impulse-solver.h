// Impulses at several contacts at once: the velocities of bodies while a discontinuity changes
// them.
//
// Bodies stand in slots.  With x the centre of mass, v its velocity and w the angular velocity of a
// slot, an impulse P at the point p of slot j changes the twist of slot i by
//   (dv, dw)_i = Y_ij (P, (p - x_j) x P),
// so the velocity of the point q of slot i changes by K_ij P with
//   K_ij = [1, -[q - x_i]x] Y_ij [1; [p - x_j]x].
// A free body answers for itself alone, Y_ii = diag(1/m, I^-1); a held one not at all; bodies that
// joints join answer for each other, by blocks that are given.  A contact between the slots a and b
// with its unit normal n from a to b has u = v_b - v_a of its points, and an impulse P on b (-P on
// a) makes of it
//   u' = u + K P,  K = K_aa + K_bb - K_ab - K_ba.
//
// Of all contacts the one that approaches fastest beyond what it bears gets the impulse of the
// impact law, then again the fastest, until none is left: energy never grows on the way, but
// nothing bounds how many it takes, so there is a limit, and what is left over then is told.  A
// light body between a heavy one and the floor takes as many as the one is heavier.  What is left
// over can be settled at once: with A the changes of approach by unit impulses along the normals
// and u the velocities along them, the impulses are the l >= 0 with
//   A l + u + bears >= 0,  l.(A l + u + bears) = 0,
// which leave the least kinetic energy of all velocities at which nothing approaches faster than it
// bears; without restitution and friction.
//
// What carries a load already can not give way: it takes the blow up at once, however often an
// impulse would have to go to and fro.  Then all contacts, struck and carrying, answer together.
// With w0 the velocities before and Y P what impulses P change, the plastic blow P is
//   N >= 0,  u_n >= 0,  N.u_n = 0  at  w1 = w0 + Y P,   |T| <= mu N against the sliding,
// with N, T the parts of P along and across normals; P_c without friction where it is struck, P_f
// with it, |T| <= mu (N_f + e N_c) there.  Velocities afterwards are those of
//   P_f + e P_c:  w1_f + e (w1_c - w0),
// so each struck point leaves with e times its approach, what carried and sticks stays at rest, and
// what is struck ends its sliding where friction can.  Without friction no energy is gained,
// whatever e is, for w1 is what is nearest to w0 in the metric of the masses of all that is
// admitted, a cone, so that w0 - w1 and w1 are square to each other and
//   E(w1 + e (w1 - w0)) = E(w1) + e^2 E(w0 - w1) <= E(w0).
// Nor by P_c, whose friction works against u(w1):
//   E - E(w0) = (1 + e) P.u(w1) - (1 - e^2)/2 P.Y P <= 0  as  P.u(w1) <= 0.
// Source: J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics" (1988);
// where all that carries is at rest this is Poisson's restitution, at one point Newton's, too, and
// with friction Chatterjee and Ruina's (impact-law.h) but for the direction of sliding.  What the
// contacts take up, -P.(u_before + u_after)/2, is looked at: friction is left out where it would be
// negative.
//
// All in the world frame.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/contact-parameters.h"
#include "dynamics/impact-law.h"
#include "dynamics/placed-body.h"

namespace tw {

// How a slot answers an impulse.
enum class Answer : std::uint8_t {
  free,    // by its own mass
  joined,  // by the blocks of `join`, which move others, too
  held,    // not at all: fixed and kinematic bodies
  border   // it would, but keeps its motion: where an impulse would reach it the solver stops
};

struct ImpulseSlot {
  Vec3 x = Vec3::Zero(), v = Vec3::Zero(), w = Vec3::Zero();  // m, m/s, rad/s
  double inverse_mass = 0;                                    // 1/kg; 0 unless it is free
  Mat3 inverse_inertia = Mat3::Zero();
  Answer answer = Answer::held;

  // A dynamic body is free, any other held.
  static ImpulseSlot of(const Body& body, const PoseTwist& point);
  static ImpulseSlot border(const PoseTwist& point);

  bool moves() const { return answer == Answer::free || answer == Answer::joined; }
  Vec3 velocity_at(const Vec3& where) const { return v + w.cross(where - x); }
};

struct ImpulseContact {
  std::uint32_t a = 0, b = 0;   // slots
  Vec3 normal = Vec3::UnitZ();  // unit, from a to b
  Vec3 point = Vec3::Zero();    // m
  double restitution = 0, friction = 0;
  double bears = 0;  // m/s: an approach up to this needs no impulse; may be infinite
  ImpactLaw law = ImpactLaw::chatterjee_ruina;
};

// How a solution ended.
struct ImpulseResult {
  int impulses = 0;
  double left_over = 0;  // m/s, of the worst approach beyond what it bears after the last impulse
  const ImpulseContact* stopped_at = nullptr;  // at a border; without an impulse on it
};

class ImpulseSolver {
 public:
  // As new, with the room it has.
  void clear();
  std::uint32_t add(const ImpulseSlot& slot);
  const ImpulseSlot& slot(std::uint32_t index) const { return slots_[index]; }
  std::size_t slot_count() const { return slots_.size(); }
  // Y_ij: an impulse on slot `on` moves slot `of`, and both are joined from now on.
  void join(std::uint32_t of, std::uint32_t on, const Mat6& block);
  // The slots that an impulse on this one moves.
  std::vector<std::uint32_t> answering(std::uint32_t slot) const;
  // Joins free slots so that they answer as one rigid body, which moves on with their momentum and
  // angular momentum: what they swing against each other would be energy that holds give.
  void join_rigidly(std::span<const std::uint32_t> slots);
  // Joins two slots so that no impulse changes how they move against each other: a hold.  Either
  // may be held.
  void hold(std::uint32_t a, std::uint32_t b);

  // u.n, m/s: negative while the points approach.
  double approach(const ImpulseContact& c) const { return relative_velocity(c).dot(c.normal); }
  // The impulse of the impact law at this contact; nothing unless it approaches.
  void strike(const ImpulseContact& c);
  // Strikes the contact with the greatest approach beyond what it bears, of equal ones the first,
  // while that exceeds `negligible` (m/s, >= 0): `most_impulses` times at most.
  ImpulseResult solve(std::span<const ImpulseContact> contacts, double negligible,
                      int most_impulses);

  // The blow at the first `struck` contacts, with that restitution; the others carry.  All answer
  // together.  False, and nothing is changed, where no such impulses are found: between walls that
  // move against each other.
  bool strike_together(std::span<const ImpulseContact> contacts, std::size_t struck,
                       double restitution);

  // All that is left over, at once, unless it is between walls that move against each other.
  // Contacts at a border are left out, and what approaches at one of them afterwards is told as by
  // `solve`.
  ImpulseResult settle(std::span<const ImpulseContact> contacts);

  // What impulses change; of slots that were added since, as they were added.
  struct Moment {
    std::vector<ImpulseSlot> slots;
    std::vector<Vec6> received;
    double normal_impulse = 0, work_of_held = 0;
  };
  Moment moment() const { return {slots_, received_, normal_impulse_, work_of_held_}; }
  void return_to(const Moment& moment);

  // ---- what all impulses so far add up to ----
  // On a joined slot: the impulse, N s, and its moment about x, N m s, with those of the holds.
  std::vector<Vec6> received() const;
  double normal_impulse() const { return normal_impulse_; }  // N s, a sum of magnitudes
  // J: a held body does work with the force it exerts at its own speed.
  double work_of_held() const { return work_of_held_; }
  // The largest along its normal: where, and how fast the points approached before it.
  const ImpulseContact& largest() const { return largest_; }
  double largest_approach() const { return largest_approach_; }  // m/s, positive

 private:
  struct Block {
    std::uint32_t of;
    Mat6 Y;
  };
  // What a hold does: with p all impulses on the slots of the row, it gives b -share p and a the
  // opposite, at b's centre.
  struct Hold {
    std::uint32_t a, b;
    std::vector<std::uint32_t> slots;
    std::vector<Mat6> shares;
  };
  struct Excess {
    const ImpulseContact* contact = nullptr;
    double speed = 0;
  };
  Vec3 relative_velocity(const ImpulseContact& c) const {
    return slots_[c.b].velocity_at(c.point) - slots_[c.a].velocity_at(c.point);
  }
  Excess worst(std::span<const ImpulseContact> contacts, double negligible) const;
  Mat3 compliance(std::uint32_t slot, const Vec3& where) const;
  Mat3 cross_compliance(std::uint32_t of, std::uint32_t on, const Vec3& where) const;
  Mat3 compliance(const ImpulseContact& c) const;
  void apply(std::uint32_t slot, const Vec3& impulse, const Vec3& where);
  void exchange(const ImpulseContact& c, const Vec3& impulse);
  bool held_as_one(std::span<const ImpulseContact* const> contacts, double differ) const;
  Eigen::MatrixXd changes(std::span<const ImpulseContact> contacts,
                          std::span<const Mat3> frames) const;
  bool reaches_border(const ImpulseContact& c) const {
    return slots_[c.a].answer == Answer::border || slots_[c.b].answer == Answer::border;
  }

  std::vector<ImpulseSlot> slots_;
  std::vector<std::vector<Block>> blocks_;  // by the slot that is struck, as far as any is joined
  std::vector<Hold> holds_;
  std::vector<Vec6> received_;  // by slot, as far as any is joined
  double normal_impulse_ = 0, work_of_held_ = 0, largest_impulse_ = 0, largest_approach_ = 0;
  ImpulseContact largest_;
};

}  // namespace tw
