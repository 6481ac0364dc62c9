// Four doubles side by side, and 3-vectors and 3 x 3 matrices of them: four contacts at a time.
//
// Each lane is computed by the same IEEE operations as a lone double, so that a lane's result does
// not depend on its neighbours.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#ifdef __AVX__
#include <immintrin.h>
#endif

// Vectors of lanes travel through memory when a function is called: always inline.
#define TW_LANES inline __attribute__((always_inline))
// the same of a lambda, behind its parameters
#define TW_LANES_LAMBDA __attribute__((always_inline))

namespace tw {

constexpr int lane_count = 4;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
// All bits set or none, lane by lane: what a comparison of Lanes yields.
using LaneMask = long long __attribute__((vector_size(lane_count * sizeof(long long))));

TW_LANES Lanes lanes(double value) { return Lanes{value, value, value, value}; }
TW_LANES Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
TW_LANES Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
// correctly rounded either way
TW_LANES Lanes sqrt(Lanes a) {
#ifdef __AVX__
  return _mm256_sqrt_pd(a);
#endif
  return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
TW_LANES bool any(LaneMask a) { return (a[0] | a[1] | a[2] | a[3]) != 0; }
TW_LANES double sum(Lanes a) { return (a[0] + a[1]) + (a[2] + a[3]); }

// A vector in each lane.
struct LaneVec {
  Lanes x, y, z;
};

TW_LANES LaneVec operator+(const LaneVec& a, const LaneVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
TW_LANES LaneVec operator-(const LaneVec& a, const LaneVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
TW_LANES LaneVec operator-(const LaneVec& a) { return {-a.x, -a.y, -a.z}; }
TW_LANES LaneVec operator*(Lanes s, const LaneVec& a) { return {s * a.x, s * a.y, s * a.z}; }
TW_LANES Lanes dot(const LaneVec& a, const LaneVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
TW_LANES LaneVec cross(const LaneVec& a, const LaneVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
TW_LANES LaneVec select(LaneMask mask, const LaneVec& a, const LaneVec& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

TW_LANES LaneVec broadcast(const double* v) { return {lanes(v[0]), lanes(v[1]), lanes(v[2])}; }
// each lane from its own place
TW_LANES LaneVec gather_vec(const double* a, const double* b, const double* c, const double* d) {
  return {Lanes{a[0], b[0], c[0], d[0]}, Lanes{a[1], b[1], c[1], d[1]},
          Lanes{a[2], b[2], c[2], d[2]}};
}

// One lane's vector, of any type that has x(), y() and z().
template <class Vector>
TW_LANES void set_lane(LaneVec& v, int lane, const Vector& value) {
  v.x[lane] = value.x();
  v.y[lane] = value.y();
  v.z[lane] = value.z();
}

// A matrix in each lane, by rows.
struct LaneMat {
  LaneVec row[3];
};

TW_LANES LaneVec operator*(const LaneMat& m, const LaneVec& a) {
  return {dot(m.row[0], a), dot(m.row[1], a), dot(m.row[2], a)};
}
TW_LANES LaneVec transposed_times(const LaneMat& m, const LaneVec& a) {
  return a.x * m.row[0] + a.y * m.row[1] + a.z * m.row[2];
}
TW_LANES LaneMat operator*(const LaneMat& m, const LaneMat& n) {
  return {{transposed_times(n, m.row[0]), transposed_times(n, m.row[1]),
           transposed_times(n, m.row[2])}};
}
TW_LANES LaneMat operator+(const LaneMat& m, const LaneMat& n) {
  return {{m.row[0] + n.row[0], m.row[1] + n.row[1], m.row[2] + n.row[2]}};
}
TW_LANES LaneMat operator-(const LaneMat& m, const LaneMat& n) {
  return {{m.row[0] - n.row[0], m.row[1] - n.row[1], m.row[2] - n.row[2]}};
}
TW_LANES LaneMat operator*(Lanes s, const LaneMat& m) {
  return {{s * m.row[0], s * m.row[1], s * m.row[2]}};
}
// a b^T
TW_LANES LaneMat outer(const LaneVec& a, const LaneVec& b) { return {{a.x * b, a.y * b, a.z * b}}; }
// m [a]x: row i is m_i x a
TW_LANES LaneMat times_cross(const LaneMat& m, const LaneVec& a) {
  return {{cross(m.row[0], a), cross(m.row[1], a), cross(m.row[2], a)}};
}
// [a]x m
TW_LANES LaneMat cross_times(const LaneVec& a, const LaneMat& m) {
  return {{a.y * m.row[2] - a.z * m.row[1], a.z * m.row[0] - a.x * m.row[2],
           a.x * m.row[1] - a.y * m.row[0]}};
}
TW_LANES LaneMat cross_lanes(const LaneVec& a) {
  const Lanes o = lanes(0);
  return {{{o, -a.z, a.y}, {a.z, o, -a.x}, {-a.y, a.x, o}}};
}
TW_LANES LaneMat scalar_matrix(Lanes s) {
  const Lanes o = lanes(0);
  return {{{s, o, o}, {o, s, o}, {o, o, s}}};
}

}  // namespace tw
