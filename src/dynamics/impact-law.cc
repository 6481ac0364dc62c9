// Chatterjee and Ruina's impact law.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impact-law.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace tw {

namespace {

// K^+ u.  K of free bodies is regular; that of links with few freedoms may not be: what no impulse
// changes is left out.
Vec3 stopping(const Mat3& K, const Vec3& u) {
  constexpr double regular = 1e-14, counts = 1e-10;
  const double trace = K.trace();
  if (K.determinant() > regular * trace * trace * trace) return K.inverse() * u;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (K + K.transpose()));
  const double least = counts * solver.eigenvalues().maxCoeff();
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (const double value = solver.eigenvalues()[i]; value > least) {
      const Vec3 axis = solver.eigenvectors().col(i);
      sum += axis * (axis.dot(u) / value);
    }
  return sum;
}

}  // namespace

Vec3 impact_impulse(const Mat3& K, const Vec3& n, const Vec3& u, double restitution,
                    double friction) {
  const double approach = u.dot(n);
  if (!(approach < 0)) return Vec3::Zero();

  // P_I, its normal part p1 > 0; joints may be such that the contact cannot answer
  constexpr double answers = 1e-12;
  const double along = n.dot(K * n);
  if (!(along > answers * K.trace())) return Vec3::Zero();
  const double p1 = -approach / along;
  const Vec3 bounce = (1 + restitution) * p1 * n;
  if (friction == 0) return bounce;

  // P_II - P_I, split along the normal and across
  const Vec3 p2 = -stopping(K, u);
  const Vec3 extra = p2 - p1 * n;
  const double extra_n = n.dot(extra);
  const double tangent = (p2 - n.dot(p2) * n).norm();

  // inside the cone: stick
  const Vec3 stick = bounce + extra;
  if (tangent <= friction * n.dot(stick)) return stick;

  // slide: on the cone; the denominator is positive because the sticking impulse lies outside
  const double kappa = friction * (1 + restitution) * p1 / (tangent - friction * extra_n);
  return bounce + kappa * extra;
}

}  // namespace tw
