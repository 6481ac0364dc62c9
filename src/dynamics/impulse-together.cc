// A blow that what carries takes up at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impulse-solver.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/constants.h"
#include "math/nonnegative.h"

namespace tw {
namespace {

using Index = Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Columns: the normal and two directions across it.
Mat3 frame_of(const Vec3& normal) {
  const Vec3 t = normal.unitOrthogonal();
  Mat3 R;
  R << normal, t, normal.cross(t);
  return R;
}

// A step of Newton's method, J x = F, where most rows of J are the identity's, of what takes no
// part: they are solved at once, the others with each other.
class Equations {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

 public:
  explicit Equations(const VectorXd& own) : F(own), rows_(own.size(), own.size()) {}

  VectorXd F;  // one that was given no row: its own unknown
  Rows::RowXpr add(Index number) {
    numbers_.push_back(number);
    return last();
  }
  Rows::RowXpr last() { return rows_.row(static_cast<Index>(numbers_.size()) - 1); }

  // `shortest`: of the steps that J allows.
  VectorXd step(bool shortest) const {
    VectorXd x = F;
    if (numbers_.empty()) return x;
    const auto rows = rows_.topRows(static_cast<Index>(numbers_.size()));
    x(numbers_).setZero();
    const MatrixXd J = rows(Eigen::all, numbers_);
    VectorXd left = F(numbers_) - rows * x;
    if (shortest) {
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors;
      factors.setThreshold(regular);
      left = VectorXd(factors.compute(J).solve(left));
    } else {
      left = VectorXd(J.partialPivLu().solve(left));
    }
    x(numbers_) = left;
    return x;
  }

 private:
  static constexpr double regular = 1e-12;

  Rows rows_;
  std::vector<Index> numbers_;
};

// The plastic blow: u0 velocities at the contacts before, by threes in their frames, A their
// changes by unit impulses.  The impulses P = (N, T) of each contact, with u = u0 + A P, solve
//   N = max(0, N - r u_n),   T = z cut to the length mu (N + extra),  z = T - r u_t,
// for any r > 0 (the reciprocal of what the contact answers itself): Newton's method on that, whose
// derivative is that of the branch taken, so that it ends after a few steps on the very solution.
// Source: P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to
// Newton like solution methods", Comput. Methods Appl. Mech. Engrg. 92 (1991).
class PlasticBlow {
 public:
  PlasticBlow(const MatrixXd& A, const VectorXd& u0, std::span<const ImpulseContact> contacts)
      : A_(A), u0_(u0), contacts_(contacts), n_(u0.size() / 3) {}

  // The impulses without friction, by threes; nothing where there are none that leave no approach.
  std::optional<VectorXd> plain() const {
    MatrixXd normals(n_, n_);
    VectorXd sides(n_), scale(n_);
    for (Index i = 0; i < n_; ++i) {
      scale[i] = A_(3 * i, 3 * i) > 0 ? 1 / std::sqrt(A_(3 * i, 3 * i)) : 0;
      sides[i] = scale[i] * u0_[3 * i];
      for (Index j = 0; j < n_; ++j) normals(i, j) = A_(3 * i, 3 * j);
    }
    normals = scale.asDiagonal() * normals * scale.asDiagonal();
    const double size = sides.cwiseAbs().maxCoeff();
    std::optional<VectorXd> x = newton_along(normals, sides, size);
    const bool exact = x.has_value();
    if (!x) x = solve_nonnegative(normals + soft * MatrixXd::Identity(n_, n_), sides, 1e-14 * size);
    if (!x || !x->allFinite()) return std::nullopt;
    VectorXd impulses = VectorXd::Zero(3 * n_);
    for (Index i = 0; i < n_; ++i) impulses[3 * i] = scale[i] * (*x)[i];
    return exact ? impulses : with_friction(impulses, n_, VectorXd::Zero(3 * n_));
  }

  // The same with friction at the contacts from `first` on, where normal impulses will be more by
  // `extra`; from impulses that are near.  Where Newton's method goes round in circles it begins
  // again from what sweeps come to, which have to do in the end.
  VectorXd with_friction(const VectorXd& near, Index first, const VectorXd& extra) const {
    VectorXd at = near;
    for (int start = 0; start < guard::most_friction_starts; ++start) {
      if (const std::optional<VectorXd> found = newton(at, first, extra)) return *found;
      at = sweeps(at, first, extra);
    }
    return at;
  }

  // What contacts take up by these impulses, J.
  double taken_up(const VectorXd& impulses) const {
    return -impulses.dot(u0_ + 0.5 * (A_ * impulses));
  }

 private:
  double friction_of(Index contact, Index first) const {
    return contact < first ? 0 : contacts_[static_cast<std::size_t>(contact)].friction;
  }

  // Along scaled normals alone.
  static std::optional<VectorXd> newton_along(const MatrixXd& normals, const VectorXd& sides,
                                              double size) {
    const Index n = sides.size();
    VectorXd x = VectorXd::Zero(n);
    for (int round = 0; round < guard::most_friction_rounds; ++round) {
      Equations equations(x);
      const VectorXd slope = normals * x + sides;
      for (Index i = 0; i < n; ++i) {
        if (!(normals(i, i) > 0) || !(x[i] - slope[i] > 0)) continue;
        equations.F[i] = slope[i];
        equations.add(i) = normals.row(i);
        equations.last()[i] += soft;
      }
      if (equations.F.cwiseAbs().maxCoeff() <= rounding * size) return x;
      x -= equations.step(false);
      if (!x.allFinite()) return std::nullopt;
    }
    return std::nullopt;
  }

  std::optional<VectorXd> newton(VectorXd impulses, Index first, const VectorXd& extra) const {
    const double size = impulses.cwiseAbs().maxCoeff();
    for (int round = 0; round < guard::most_friction_rounds; ++round) {
      const bool quick = round < quick_rounds;
      const double held = quick ? soft : 0;
      Equations equations(impulses);
      VectorXd& F = equations.F;
      const VectorXd u = u0_ + A_ * impulses;
      for (Index i = 0; i < n_; ++i) {
        const double mu = friction_of(i, first);
        const Index n = 3 * i, t = n + 1;
        if (!(A_(n, n) > 0)) continue;
        const double r = 1 / A_(n, n);
        if (!(impulses[n] - r * u[n] > 0)) continue;
        F[n] = r * u[n];
        equations.add(n) = r * A_.row(n);
        equations.last()[n] += held;
        const double bound = mu * (impulses[n] + extra[n]), answers = A_(t, t) + A_(t + 1, t + 1);
        if (!(bound > 0) || !(answers > 0)) continue;
        const double rt = 1 / answers;
        const Eigen::Vector2d T = impulses.segment<2>(t), z = T - rt * u.segment<2>(t);
        const double length = z.norm();
        // sticks: no velocity across; slips: along d, by the bound
        Eigen::Matrix2d turns = Eigen::Matrix2d::Identity(), stays = held * turns;
        Eigen::Vector2d by_normal = Eigen::Vector2d::Zero();
        F.segment<2>(t) = rt * u.segment<2>(t);
        if (length > bound) {
          const Eigen::Vector2d d = z / length;
          F.segment<2>(t) = T - bound * d;
          turns = bound / length * (Eigen::Matrix2d::Identity() - d * d.transpose());
          stays = Eigen::Matrix2d::Identity() - turns;
          by_normal = mu * d;
        }
        const Eigen::Matrix2Xd across = rt * turns * A_.middleRows<2>(t);
        for (Index k = 0; k < 2; ++k) {
          equations.add(t + k) = across.row(k);
          equations.last().segment<2>(t) += stays.row(k);
          equations.last()[n] -= by_normal[k];
        }
      }
      if (F.cwiseAbs().maxCoeff() <= rounding * size) return impulses;
      impulses -= equations.step(!quick);
      if (!impulses.allFinite()) return std::nullopt;
    }
    return std::nullopt;
  }

  // One contact after the other, as if it were alone.
  VectorXd sweeps(VectorXd impulses, Index first, const VectorXd& extra) const {
    VectorXd u = u0_ + A_ * impulses;
    bool changes = true;
    for (int sweep = 0; changes && sweep < guard::most_friction_sweeps; ++sweep) {
      changes = false;
      for (Index i = 0; i < n_; ++i) {
        const Index n = 3 * i, t = n + 1;
        const double answers = A_(t, t) + A_(t + 1, t + 1);
        if (!(A_(n, n) > 0)) continue;
        Vec3 next = impulses.segment<3>(n);
        next[0] = std::max(0.0, next[0] - u[n] / A_(n, n));
        const double bound = friction_of(i, first) * (next[0] + extra[n]);
        if (answers > 0) next.tail<2>() -= u.segment<2>(t) / answers;
        const double length = next.tail<2>().norm();
        if (length > bound) next.tail<2>() *= bound / length;
        const Vec3 change = next - impulses.segment<3>(n);
        // most of what carries takes no part
        if (change == Vec3::Zero()) continue;
        changes = true;
        u += A_.middleCols<3>(n) * change;
        impulses.segment<3>(n) = next;
      }
    }
    return impulses;
  }

  // Where more contacts carry than there are freedoms, many impulses do: each is held back by this
  // share of what it moves itself, so that they are shared evenly; what that leaves the next step
  // takes.  Among unequal masses that would take many: after so many rounds steps are the shortest
  // instead.
  static constexpr double soft = 1e-5;
  static constexpr int quick_rounds = 12;
  static constexpr double rounding = 1e-14;

  const MatrixXd& A_;
  const VectorXd& u0_;
  std::span<const ImpulseContact> contacts_;
  Index n_;
};

}  // namespace

// A, by threes in the contacts' frames: by unit impulses on bodies at rest.
MatrixXd ImpulseSolver::changes(std::span<const ImpulseContact> contacts,
                                std::span<const Mat3> frames) const {
  const auto n = static_cast<Index>(contacts.size());
  MatrixXd A(3 * n, 3 * n);
  ImpulseSolver probe = *this;
  for (Index j = 0; j < n; ++j) {
    const ImpulseContact& struck = contacts[static_cast<std::size_t>(j)];
    for (int k = 0; k < 3; ++k) {
      for (ImpulseSlot& slot : probe.slots_) slot.v = slot.w = Vec3::Zero();
      const Vec3 unit = frames[static_cast<std::size_t>(j)].col(k);
      probe.apply(struck.a, -unit, struck.point);
      probe.apply(struck.b, unit, struck.point);
      for (Index i = 0; i < n; ++i)
        A.block<3, 1>(3 * i, 3 * j + k) =
            frames[static_cast<std::size_t>(i)].transpose() *
            probe.relative_velocity(contacts[static_cast<std::size_t>(i)]);
    }
  }
  return A;
}

bool ImpulseSolver::strike_together(std::span<const ImpulseContact> contacts, std::size_t struck,
                                    double restitution) {
  if (contacts.empty()) return false;
  const auto n = static_cast<Index>(contacts.size());
  std::vector<Mat3> frames;
  VectorXd u(3 * n);
  double fastest = 0;
  bool rough = false;
  for (Index i = 0; i < n; ++i) {
    const ImpulseContact& c = contacts[static_cast<std::size_t>(i)];
    frames.push_back(frame_of(c.normal));
    u.segment<3>(3 * i) = frames.back().transpose() * relative_velocity(c);
    fastest = std::max(fastest, -u[3 * i]);
    rough = rough || c.friction > 0;
  }
  std::vector<const ImpulseContact*> all;
  for (const ImpulseContact& c : contacts) all.push_back(&c);
  if (!held_as_one(all, answer::settled_share * fastest)) return false;
  const MatrixXd A = changes(contacts, frames);
  const PlasticBlow blow(A, u, contacts);
  const std::optional<VectorXd> plain = blow.plain();
  if (!plain) return false;
  VectorXd impulses = (1 + restitution) * *plain;
  if (rough) {
    const auto first = static_cast<Index>(struck);
    VectorXd extra = VectorXd::Zero(3 * n);
    const VectorXd carried = blow.with_friction(*plain, first, extra);
    if (blow.taken_up((1 + restitution) * carried) >= 0) {
      extra.head(3 * first) = restitution * carried.head(3 * first);
      const VectorXd sum = blow.with_friction(carried, 0, extra) + restitution * carried;
      impulses = blow.taken_up(sum) >= 0 ? sum : VectorXd((1 + restitution) * carried);
    }
  }
  const double told = normal_impulse_;
  for (Index i = 0; i < n; ++i) {
    const Vec3 impulse = frames[static_cast<std::size_t>(i)] * impulses.segment<3>(3 * i);
    exchange(contacts[static_cast<std::size_t>(i)], impulse);
  }
  // what carries only passes it on
  normal_impulse_ = told;
  for (std::size_t i = 0; i < struck; ++i) normal_impulse_ += impulses[3 * static_cast<Index>(i)];
  return true;
}

}  // namespace tw
