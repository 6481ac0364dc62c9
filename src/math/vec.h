// Vectors, quaternions, matrices and rigid transforms: the names used everywhere.
//
// Frames: a quaternion or matrix written q_WB, R_WB maps coordinates of frame B to frame W.
// Quaternions are kept unaligned, so that the layout of states does not depend on -march.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

// Eigen's packet code rounds differently from its scalar code (fused multiply-add), and which of
// the two computes an element of a 3 x 3 matrix depends on the address of the object: the same run
// twice would give other bits.  So no packets; 3-vectors gain nothing from them.
#ifndef EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_VECTORIZE
#endif

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#ifdef EIGEN_VECTORIZE
#error "Eigen was included before math/vec.h, with packets; include math/vec.h first"
#endif

namespace tw {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

constexpr double pi = 3.14159265358979323846;

// A rigid transform: x_W = q * x_B + p.
struct Pose {
  Vec3 p = Vec3::Zero();
  Quat q = Quat::Identity();
};

// The same with the rotation as a matrix, for code that maps many points.
struct Frame {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();

  Frame() = default;
  Frame(const Mat3& rotation, const Vec3& position) : R(rotation), p(position) {}
  explicit Frame(const Pose& pose) : R(pose.q.toRotationMatrix()), p(pose.p) {}

  Vec3 operator*(const Vec3& x) const { return R * x + p; }
  // Inverse transform of a point.
  Vec3 to_local(const Vec3& x) const { return R.transpose() * (x - p); }
  Frame operator*(const Frame& other) const { return {R * other.R, R * other.p + p}; }
};

inline Pose operator*(const Pose& a, const Pose& b) { return {a.q * b.p + a.p, a.q * b.q}; }

inline bool is_finite(const Vec3& v) { return std::isfinite(v.x() + v.y() + v.z()); }
inline bool is_finite(const Quat& q) { return std::isfinite(q.w() + q.x() + q.y() + q.z()); }

// |v| without overflow or underflow on the way.  (Eigen's stableNorm sums in an order that depends
// on the operand's address, and so do its vectorised reductions: the build turns vectorisation
// off.)
inline double scaled_norm(const Vec3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return v.norm();
  // by a power of two: exact
  const double scale = std::ldexp(1.0, std::ilogb(largest));
  return scale * (v / scale).norm();
}

// The rotation by |v| radians about v, exact for small |v| too: exp(v/2) as a quaternion.
inline Quat rotation_by(const Vec3& v) {
  const double angle = v.norm();
  // sin(angle/2)/angle; below 1e-4 the series is exact to rounding
  const double s = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const double c = std::cos(0.5 * angle);
  return Quat(c, s * v.x(), s * v.y(), s * v.z());
}

// The matrix with cross_matrix(a) * b == a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace tw
