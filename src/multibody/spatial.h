// Spatial vectors: motions, forces and inertias of rigid bodies about one point, in world axes.
//
// Frames: all of one computation are about the same point O of space (Kinematics::origin) and along
// the world's axes, so that going from link to link costs no transformation.  A motion (w; v) is an
// angular velocity and the velocity of the body's point at O; a force (n; f) is a torque about O
// and a force.
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapter 2.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw::multibody {

struct Motion {
  Vec3 w = Vec3::Zero();  // rad/s
  Vec3 v = Vec3::Zero();  // m/s

  Motion operator+(const Motion& o) const { return {w + o.w, v + o.v}; }
  Motion operator-(const Motion& o) const { return {w - o.w, v - o.v}; }
  Motion operator*(double s) const { return {w * s, v * s}; }
  Motion& operator+=(const Motion& o) { return w += o.w, v += o.v, *this; }
  void add(const Motion& o, double s) { w += s * o.w, v += s * o.v; }
  Vec6 vector() const { return (Vec6() << w, v).finished(); }
};

struct Force {
  Vec3 n = Vec3::Zero();  // N m
  Vec3 f = Vec3::Zero();  // N

  Force operator+(const Force& o) const { return {n + o.n, f + o.f}; }
  Force operator-(const Force& o) const { return {n - o.n, f - o.f}; }
  Force operator-() const { return {-n, -f}; }
  Force& operator+=(const Force& o) { return n += o.n, f += o.f, *this; }
  Force& operator-=(const Force& o) { return n -= o.n, f -= o.f, *this; }
  void add(const Force& o, double s) { n += s * o.n, f += s * o.f; }
  Vec6 vector() const { return (Vec6() << n, f).finished(); }
};

// Power of a force on a motion, W.
inline double dot(const Motion& m, const Force& f) { return m.w.dot(f.n) + m.v.dot(f.f); }

// The rate of b, fixed in what moves with a: a x b.
inline Motion cross(const Motion& a, const Motion& b) {
  return {a.w.cross(b.w), a.w.cross(b.v) + a.v.cross(b.w)};
}
// The same of a force: a x* b.
inline Force cross(const Motion& a, const Force& b) {
  return {a.w.cross(b.n) + a.v.cross(b.f), a.w.cross(b.f)};
}

// A symmetric 3 x 3 matrix.
struct Sym3 {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  Vec3 operator*(const Vec3& a) const {
    return {xx * a.x() + xy * a.y() + xz * a.z(), xy * a.x() + yy * a.y() + yz * a.z(),
            xz * a.x() + yz * a.y() + zz * a.z()};
  }
  Sym3& operator+=(const Sym3& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    return *this;
  }
  // Adds s a a^T.
  void add_square(const Vec3& a, double s) {
    const double x = s * a.x(), y = s * a.y(), z = s * a.z();
    xx += x * a.x(), xy += x * a.y(), xz += x * a.z();
    yy += y * a.y(), yz += y * a.z(), zz += z * a.z();
  }
  // Adds s (b a^T + a b^T).
  void add_product(const Vec3& a, const Vec3& b, double s) {
    const Vec3 t = s * a;
    xx += 2 * t.x() * b.x(), yy += 2 * t.y() * b.y(), zz += 2 * t.z() * b.z();
    xy += t.x() * b.y() + t.y() * b.x();
    xz += t.x() * b.z() + t.z() * b.x();
    yz += t.y() * b.z() + t.z() * b.y();
  }
  void add_diagonal(double s) { xx += s, yy += s, zz += s; }
  Mat3 matrix() const {
    Mat3 m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
  static Sym3 of(const Mat3& m) { return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)}; }
};

// R S R^T.
inline Sym3 turned(const Mat3& R, const Sym3& S) {
  const Vec3 x = S * R.row(0).transpose(), y = S * R.row(1).transpose();
  const Vec3 z = S * R.row(2).transpose();
  const auto a = R.row(0), b = R.row(1), c = R.row(2);
  return {a.dot(x), b.dot(x), c.dot(x), b.dot(y), c.dot(y), c.dot(z)};
}

// Inertia of a rigid body about O: mass, first moment m c, second moments about O.
struct RigidBodyInertia {
  double m = 0;           // kg
  Vec3 h = Vec3::Zero();  // kg m
  Sym3 J;                 // kg m^2

  // From the moments about the centre of mass c.
  static RigidBodyInertia about(double mass, const Vec3& c, const Sym3& moments) {
    RigidBodyInertia I{mass, mass * c, moments};
    I.J.add_diagonal(c.dot(I.h));
    I.J.add_square(c, -mass);
    return I;
  }
  Force operator*(const Motion& a) const {
    return {J * a.w + h.cross(a.v), m * a.v - h.cross(a.w)};
  }
  RigidBodyInertia& operator+=(const RigidBodyInertia& o) {
    m += o.m, h += o.h, J += o.J;
    return *this;
  }
};

// Inertia of a link whose descendants may move at their joints: any symmetric 6 x 6 matrix
// (J, H; H^T, M).
struct ArticulatedInertia {
  Sym3 J, M;
  Mat3 H = Mat3::Zero();

  void set(const RigidBodyInertia& I) {
    J = I.J;
    M = {I.m, 0, 0, I.m, 0, I.m};
    H << 0, -I.h.z(), I.h.y(), I.h.z(), 0, -I.h.x(), -I.h.y(), I.h.x(), 0;
  }
  Force operator*(const Motion& a) const {
    return {J * a.w + H * a.v, H.transpose() * a.w + M * a.v};
  }
  ArticulatedInertia& operator+=(const ArticulatedInertia& o) {
    J += o.J, M += o.M, H += o.H;
    return *this;
  }
  // Adds s U U^T.
  void add_square(const Force& U, double s) {
    J.add_square(U.n, s), M.add_square(U.f, s);
    const Vec3 n = s * U.n;
    for (int c = 0; c < 3; ++c) H.col(c) += U.f[c] * n;
  }
};

// Half the matrix of Coriolis terms, doubled: 2B m = V x* (I m) - I (V x m) + m x* (I V).  About
// the point O it is (L, 0; -2 [f]x, 0) with f the momentum and
// L = [w]x J - J [w]x - v h^T - h v^T + 2 (v.h) - [n]x, n the angular momentum.
struct CoriolisMatrix {
  Sym3 symmetric;
  Vec3 n = Vec3::Zero(), f = Vec3::Zero();

  static CoriolisMatrix of(const RigidBodyInertia& I, const Motion& V) {
    CoriolisMatrix B;
    const Force momentum = I * V;
    B.n = momentum.n, B.f = momentum.f;
    // [w]x J + its transpose
    const Mat3 turning = cross_matrix(V.w) * I.J.matrix();
    B.symmetric = Sym3::of(turning + turning.transpose());
    B.symmetric.add_product(V.v, I.h, -1);
    B.symmetric.add_diagonal(2 * V.v.dot(I.h));
    return B;
  }
  CoriolisMatrix& operator+=(const CoriolisMatrix& o) {
    symmetric += o.symmetric, n += o.n, f += o.f;
    return *this;
  }
  Force operator*(const Motion& m) const {
    return {symmetric * m.w - n.cross(m.w), -2 * f.cross(m.w)};
  }
  // (2B)^T m: of what it returns only products with motions are meant.
  Force transposed(const Motion& m) const {
    return {symmetric * m.w + n.cross(m.w) + 2 * f.cross(m.v), Vec3::Zero()};
  }
};

}  // namespace tw::multibody
