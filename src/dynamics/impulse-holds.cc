// Slots that holds join: no impulse changes how they move against each other.
//
// Free ones are one rigid body: with its mass and inertia C^-1 at its centre and X_i what makes a
// twist there one at the centre of slot i,  Y_ij = X_i C X_j^T.  Of two that answer by other blocks
// already, as links do, the hold is taken in:
// with B the map from the velocities of all slots that are joined to a or b to the twist of b
// against a, at b's centre, the hold gives  l = -S^-1 B Y p  for impulses p,  S = B Y B^T,  on b,
// the opposite on a, so that  Y' = Y - Y B^T S^-1 B Y  answers in the place of Y.  Where others
// hold the two already, S is singular: what no impulse of the hold changes is left out.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impulse-solver.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace tw {
namespace {

// The twist at a point that lies r from the centre, by that of the centre; its transpose carries a
// wrench at the point to the centre.
Mat6 at_offset(const Vec3& r) {
  Mat6 X = Mat6::Identity();
  X.topRightCorner<3, 3>() = -cross_matrix(r);
  return X;
}

// S^+, in units in which a length is 1: `length` makes turning comparable with moving.
Mat6 inverse_of(const Mat6& S, double length) {
  constexpr double counts = 1e-9;
  Vec6 units;
  units << Vec3::Ones(), Vec3::Constant(length);
  const Mat6 scaled = units.asDiagonal() * S * units.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(0.5 * (scaled + scaled.transpose()));
  const double least = counts * solver.eigenvalues().maxCoeff();
  Mat6 sum = Mat6::Zero();
  for (int i = 0; i < 6; ++i)
    if (const double value = solver.eigenvalues()[i]; value > least) {
      const Vec6 axis = solver.eigenvectors().col(i);
      sum += axis * axis.transpose() / value;
    }
  return units.asDiagonal() * sum * units.asDiagonal();
}

}  // namespace

void ImpulseSolver::join_rigidly(std::span<const std::uint32_t> slots) {
  if (slots.size() < 2) return;
  // mass, centre, inertia and motion of the whole
  double mass = 0;
  Vec3 centre = Vec3::Zero(), v = Vec3::Zero(), spin = Vec3::Zero();
  for (const std::uint32_t number : slots) {
    const ImpulseSlot& slot = slots_[number];
    mass += 1 / slot.inverse_mass;
    centre += slot.x / slot.inverse_mass;
    v += slot.v / slot.inverse_mass;
  }
  centre /= mass;
  v /= mass;
  Mat3 inertia = Mat3::Zero();
  for (const std::uint32_t number : slots) {
    const ImpulseSlot& slot = slots_[number];
    const Mat3 own = slot.inverse_inertia.inverse(), r = cross_matrix(slot.x - centre);
    inertia += own - r * r / slot.inverse_mass;
    spin += own * slot.w + r * (slot.v - v) / slot.inverse_mass;
  }
  const Vec3 w = inertia.inverse() * spin;
  for (const std::uint32_t number : slots) {
    ImpulseSlot& slot = slots_[number];
    slot.v = v + w.cross(slot.x - centre);
    slot.w = w;
  }
  Mat6 whole = Mat6::Zero();
  whole.topLeftCorner<3, 3>() = Mat3::Identity() / mass;
  whole.bottomRightCorner<3, 3>() = inertia.inverse();
  for (const std::uint32_t on : slots) {
    const Mat6 by_whole = whole * at_offset(slots_[on].x - centre).transpose();
    for (const std::uint32_t of : slots) join(of, on, at_offset(slots_[of].x - centre) * by_whole);
  }
}

void ImpulseSolver::hold(std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t slot : {a, b})
    if (slots_[slot].answer == Answer::free) {
      Mat6 own = Mat6::Zero();
      own.topLeftCorner<3, 3>() = slots_[slot].inverse_mass * Mat3::Identity();
      own.bottomRightCorner<3, 3>() = slots_[slot].inverse_inertia;
      join(slot, slot, own);
    }
  blocks_.resize(slots_.size());

  // all that answers a or b
  Hold made{a, b, {}, {}};
  for (const std::uint32_t slot : {a, b})
    for (const Block& block : blocks_[slot]) made.slots.push_back(block.of);
  std::sort(made.slots.begin(), made.slots.end());
  made.slots.erase(std::unique(made.slots.begin(), made.slots.end()), made.slots.end());

  const Mat6 from_a = at_offset(slots_[b].x - slots_[a].x);
  const auto block_of = [&](std::uint32_t of, std::uint32_t on) {
    for (const Block& block : blocks_[on])
      if (block.of == of) return block.Y;
    return Mat6(Mat6::Zero());
  };
  // B Y, by slot that is struck
  std::vector<Mat6> seen;
  for (const std::uint32_t on : made.slots)
    seen.push_back(block_of(b, on) - from_a * block_of(a, on));
  const auto seen_on = [&](std::uint32_t slot) {
    const auto at = std::lower_bound(made.slots.begin(), made.slots.end(), slot);
    return at != made.slots.end() && *at == slot
               ? seen[static_cast<std::size_t>(at - made.slots.begin())]
               : Mat6(Mat6::Zero());
  };
  const Mat6 S = seen_on(b) - seen_on(a) * from_a.transpose();
  // a length: how far the two turn by what moves them
  const double moves = S.topLeftCorner<3, 3>().trace(), turns = S.bottomRightCorner<3, 3>().trace();
  if (!(moves > 0 || turns > 0)) return;
  const Mat6 inverse = inverse_of(S, moves > 0 && turns > 0 ? std::sqrt(moves / turns) : 1);
  for (const Mat6& B : seen) made.shares.push_back(inverse * B);
  for (std::size_t on = 0; on < made.slots.size(); ++on)
    for (std::size_t of = 0; of < made.slots.size(); ++of) {
      const Mat6 change = -seen[of].transpose() * made.shares[on];
      std::vector<Block>& row = blocks_[made.slots[on]];
      const auto at = std::find_if(row.begin(), row.end(),
                                   [&](const Block& block) { return block.of == made.slots[of]; });
      if (at != row.end())
        at->Y += change;
      else
        row.push_back({made.slots[of], change});
    }
  holds_.push_back(std::move(made));
}

std::vector<Vec6> ImpulseSolver::received() const {
  std::vector<Vec6> all = received_;
  // the last hold answered first
  for (auto hold = holds_.rbegin(); hold != holds_.rend(); ++hold) {
    Vec6 given = Vec6::Zero();
    for (std::size_t i = 0; i < hold->slots.size(); ++i)
      given -= hold->shares[i] * all[hold->slots[i]];
    const Mat6 from_a = at_offset(slots_[hold->b].x - slots_[hold->a].x);
    if (slots_[hold->b].moves()) all[hold->b] += given;
    if (slots_[hold->a].moves()) all[hold->a] -= from_a.transpose() * given;
  }
  return all;
}

}  // namespace tw
