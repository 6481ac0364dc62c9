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

  // u.n, m/s: negative while the points approach.
  double approach(const ImpulseContact& c) const { return relative_velocity(c).dot(c.normal); }
  // The impulse of the impact law at this contact; nothing unless it approaches.
  void strike(const ImpulseContact& c);
  // Strikes the contact with the greatest approach beyond what it bears, of equal ones the first,
  // while that exceeds `negligible` (m/s, >= 0): `most_impulses` times at most.
  ImpulseResult solve(std::span<const ImpulseContact> contacts, double negligible,
                      int most_impulses);

  // All that is left over, at once, unless it is between walls that move against each other.
  // Contacts at a border are left out, and what approaches at one of them afterwards is told as by
  // `solve`.
  ImpulseResult settle(std::span<const ImpulseContact> contacts);

  // ---- what all impulses so far add up to ----
  // On a joined slot: the impulse, N s, and its moment about x, N m s.
  const Vec6& received(std::uint32_t slot) const { return received_[slot]; }
  double normal_impulse() const { return normal_impulse_; }  // N s, a sum of magnitudes
  // J: a held body does work with the force it exerts at its own speed.
  double work_of_held() const { return work_of_held_; }
  // The largest along its normal: where, and how fast the points approached before it.
  const ImpulseContact& largest() const { return largest_; }
  double largest_approach() const { return largest_approach_; }  // m/s, positive

 private:
  struct Block {
    std::uint32_t of, on;
    Mat6 Y;
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
  bool reaches_border(const ImpulseContact& c) const {
    return slots_[c.a].answer == Answer::border || slots_[c.b].answer == Answer::border;
  }

  std::vector<ImpulseSlot> slots_;
  std::vector<Block> blocks_;   // of joined slots
  std::vector<Vec6> received_;  // by slot, as far as any is joined
  double normal_impulse_ = 0, work_of_held_ = 0, largest_impulse_ = 0, largest_approach_ = 0;
  ImpulseContact largest_;
};

}  // namespace tw
