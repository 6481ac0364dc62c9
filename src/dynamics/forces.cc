// Forces on a rigid body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/forces.h"

#include <algorithm>

#include "base/hash.h"

namespace tw {
namespace {

class Drag final : public ForceLaw {
 public:
  Drag(double linear, double quadratic) : linear_(linear), quadratic_(quadratic) {}

  void add(double, const PoseTwist& body, Wrench& sum) const override {
    sum.force -= (linear_ + quadratic_ * body.v.norm()) * body.v;
  }
  // d(|v| v) = |v| dv + v v.dv/|v|
  void add_derivative(double, const PoseTwist& body, WrenchDerivative& sum) const override {
    const double speed = body.v.norm();
    auto block = sum.by_twist.topLeftCorner<3, 3>();
    block.diagonal().array() -= linear_ + quadratic_ * speed;
    if (speed > 0) block -= quadratic_ / speed * body.v * body.v.transpose();
  }
  std::uint64_t hash() const override {
    Hasher h;
    h.add(linear_);
    h.add(quadratic_);
    return h.value();
  }

 private:
  double linear_, quadratic_;
};

}  // namespace

Wrench ActingForces::wrench(double time, const PoseTwist& body) const {
  Wrench sum;
  sum.torque = torque_;
  for (const ForceLawPtr& law : laws_) law->add(time, body, sum);
  return sum;
}

WrenchDerivative ActingForces::derivative(double time, const PoseTwist& body) const {
  WrenchDerivative sum;
  for (const ForceLawPtr& law : laws_) law->add_derivative(time, body, sum);
  return sum;
}

double ActingForces::energy(double time, const PoseTwist& body) const {
  double sum = 0;
  for (const ForceLawPtr& law : laws_) sum += law->energy(time, body);
  return sum;
}

double ActingForces::longest_unlooked() const {
  double least = never;
  for (const ForceLawPtr& law : laws_) least = std::min(least, law->longest_unlooked());
  return least;
}

std::uint64_t ActingForces::hash() const {
  Hasher h;
  for (int i = 0; i < 3; ++i) h.add(torque_[i]);
  for (const ForceLawPtr& law : laws_) h.add(law->hash());
  return h.value();
}

ForcesPtr with_torque(const ForcesPtr& forces, const Vec3& torque) {
  const std::vector<ForceLawPtr> laws = forces ? forces->laws() : std::vector<ForceLawPtr>{};
  if (laws.empty() && torque.isZero(0)) return nullptr;
  return std::make_shared<ActingForces>(torque, laws);
}

ForcesPtr with_law(const ForcesPtr& forces, ForceLawPtr law) {
  std::vector<ForceLawPtr> laws = forces ? forces->laws() : std::vector<ForceLawPtr>{};
  laws.push_back(std::move(law));
  return std::make_shared<ActingForces>(forces ? forces->torque() : Vec3(Vec3::Zero()),
                                        std::move(laws));
}

ForcesPtr without_those_on(const ForcesPtr& forces, BodyId other) {
  std::vector<ForceLawPtr> laws = forces->laws();
  std::erase_if(laws, [&](const ForceLawPtr& law) { return law->hangs_on(other); });
  if (laws.empty()) return with_torque(nullptr, forces->torque());
  return std::make_shared<ActingForces>(forces->torque(), std::move(laws));
}

void add_differences(const ForceLaw& law, double time, const PoseTwist& body, double length,
                     double speed, WrenchDerivative& sum) {
  // the cube root of rounding balances the error of the difference
  constexpr double share = 0x1p-17;
  const auto column = [&](Mat6& matrix, int j, double step, auto&& change) {
    Wrench w[2];
    for (const int side : {0, 1}) {
      PoseTwist moved = body;
      change(moved, side == 0 ? -step : step);
      law.add(time, moved, w[side]);
    }
    matrix.col(j).head<3>() += (w[1].force - w[0].force) / (2 * step);
    matrix.col(j).tail<3>() += (w[1].torque - w[0].torque) / (2 * step);
  };
  for (int i = 0; i < 3; ++i) {
    column(sum.by_pose, i, share * length, [&](PoseTwist& p, double s) { p.x[i] += s; });
    column(sum.by_pose, 3 + i, share,
           [&](PoseTwist& p, double s) { p.q = Quat(Eigen::AngleAxisd(s, Vec3::Unit(i))) * p.q; });
    column(sum.by_twist, i, share * speed, [&](PoseTwist& p, double s) { p.v[i] += s; });
    column(sum.by_twist, 3 + i, share * speed / length,
           [&](PoseTwist& p, double s) { p.w[i] += s; });
  }
}

ForceLawPtr make_drag(double linear, double quadratic) {
  return std::make_shared<Drag>(linear, quadratic);
}

Vec3 SpringLaw::force(const Vec3& d, const Vec3& dv) const {
  if (rest == 0) return stiffness * d + damping * dv;
  const double l = d.norm();
  if (l == 0) return Vec3::Zero();
  const Vec3 u = d / l;
  return (stiffness * (l - rest) + damping * u.dot(dv)) * u;
}

// f = t u, t = k (l - rest) + c u.dv;  du = Q dd, Q = (1 - u u^T)/l;  dt = k u.dd + c dv.(Q dd) +
// c u.d(dv)
void SpringLaw::derivative(const Vec3& d, const Vec3& dv, Mat3& by_d, Mat3& by_dv) const {
  by_d.setZero();
  by_dv.setZero();
  if (rest == 0) {
    by_d.diagonal().setConstant(stiffness);
    by_dv.diagonal().setConstant(damping);
    return;
  }
  const double l = d.norm();
  if (l == 0) return;
  const Vec3 u = d / l;
  const double tension = stiffness * (l - rest) + damping * u.dot(dv);
  const Mat3 Q = (Mat3::Identity() - u * u.transpose()) / l;
  by_d = u * (stiffness * u + damping * (Q * dv)).transpose() + tension * Q;
  by_dv = damping * u * u.transpose();
}

double SpringLaw::energy(const Vec3& d) const {
  const double stretch = d.norm() - rest;
  return 0.5 * stiffness * stretch * stretch;
}

std::uint64_t SpringLaw::hash() const {
  Hasher h;
  h.add(stiffness);
  h.add(damping);
  h.add(rest);
  return h.value();
}

void add_force_at(const Vec3& r, const Vec3& f, Wrench& sum) {
  sum.force += f;
  sum.torque += r.cross(f);
}

// dd = -(dx - [r] dth), d(dv) = -(dv - [r] dw - [w][r] dth), dT = [f][r] dth + [r] df
void add_derivative_at(const Vec3& r, const Vec3& w, const Vec3& f, const Mat3& by_d,
                       const Mat3& by_dv, WrenchDerivative& sum) {
  const Mat3 arm = cross_matrix(r);
  const Mat3 by_x = -by_d, by_th = by_d * arm + by_dv * cross_matrix(w) * arm;
  const Mat3 by_v = -by_dv, by_w = by_dv * arm;
  sum.by_pose.topLeftCorner<3, 3>() += by_x;
  sum.by_pose.topRightCorner<3, 3>() += by_th;
  sum.by_pose.bottomLeftCorner<3, 3>() += arm * by_x;
  sum.by_pose.bottomRightCorner<3, 3>() += arm * by_th + cross_matrix(f) * arm;
  sum.by_twist.topLeftCorner<3, 3>() += by_v;
  sum.by_twist.topRightCorner<3, 3>() += by_w;
  sum.by_twist.bottomLeftCorner<3, 3>() += arm * by_v;
  sum.by_twist.bottomRightCorner<3, 3>() += arm * by_w;
}

}  // namespace tw
