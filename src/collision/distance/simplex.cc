// The point of a simplex nearest to the origin.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/simplex.h"

#include <utility>

namespace tw {

namespace {

// below this ratio of height to longest side, squared, a triangle counts as its sides
constexpr double sliver = 1e-28;

// a plane through the newest point that passes the origin or the last corner within this ratio of
// their distance, squared, leaves open on which side they are
constexpr double flat_square = 1e-20;

// The best face found so far, by numbers of points in the simplex.
struct NearestFace {
  double square = 1e300;  // |v|^2
  int count = 0;
  std::array<int, 3> index{};
  std::array<double, 3> lambda{};
  Vec3 v = Vec3::Zero();
};

void try_point(const Simplex& s, int i, NearestFace& best) {
  const Vec3& w = s.points[static_cast<std::size_t>(i)].w;
  const double square = w.squaredNorm();
  if (!(square < best.square)) return;
  best = {square, 1, {i, 0, 0}, {1, 0, 0}, w};
}

void try_segment(const Simplex& s, int i, int j, NearestFace& best) {
  const Vec3& p = s.points[static_cast<std::size_t>(i)].w;
  const Vec3& q = s.points[static_cast<std::size_t>(j)].w;
  const Vec3 e = q - p;
  const double along = -p.dot(e);
  const double length = e.squaredNorm();
  if (!(along > 0)) return try_point(s, i, best);
  if (!(along < length)) return try_point(s, j, best);
  const double t = along / length;
  // t is rounded at the scale of e; what that leaves of v along e would tilt the next search
  Vec3 v = p + t * e;
  v -= (v.dot(e) / length) * e;
  const double square = v.squaredNorm();
  if (!(square < best.square)) return;
  best = {square, 2, {i, j, 0}, {1 - t, t, 0}, v};
}

void try_triangle(const Simplex& s, int i, int j, int k, NearestFace& best) {
  const Vec3& p = s.points[static_cast<std::size_t>(i)].w;
  Vec3 e = s.points[static_cast<std::size_t>(j)].w - p;
  Vec3 f = s.points[static_cast<std::size_t>(k)].w - p;
  if (f.squaredNorm() > e.squaredNorm()) {
    e.swap(f);
    std::swap(j, k);
  }
  // g and p_g: the parts of f and p square to the longer side e.  However thin the triangle, the
  // nearest point p_g + lambda_f g then errs by no more than rounding of the corners.
  const double ee = e.squaredNorm();
  const double f_along = f.dot(e) / ee;
  const double p_along = p.dot(e) / ee;
  const Vec3 g = f - f_along * e;
  const Vec3 p_g = p - p_along * e;
  const double gg = g.squaredNorm();
  if (!(gg > sliver * ee)) {
    try_segment(s, i, j, best);
    try_segment(s, j, k, best);
    try_segment(s, k, i, best);
    return;
  }
  const double lambda_f = -p_g.dot(g) / gg;
  const double lambda_e = -p_along - lambda_f * f_along;
  const double lambda_p = 1 - lambda_e - lambda_f;
  if (!(lambda_p > 0 && lambda_e > 0 && lambda_f > 0)) {
    // beyond one side: the nearest point is on that side; beyond two: on either
    if (!(lambda_f > 0)) try_segment(s, i, j, best);
    if (!(lambda_p > 0)) try_segment(s, j, k, best);
    if (!(lambda_e > 0)) try_segment(s, k, i, best);
    return;
  }
  Vec3 v = p_g + lambda_f * g;
  v -= (v.dot(g) / gg) * g;
  v -= (v.dot(e) / ee) * e;
  double square = v.squaredNorm();
  if (square < gg) {
    // nearer than the triangle is high: its normal knows the direction better
    const Vec3 n = e.cross(g);
    v = n * (n.dot(p) / n.squaredNorm());
    square = v.squaredNorm();
  }
  if (square < best.square) best = {square, 3, {i, j, k}, {lambda_p, lambda_e, lambda_f}, v};
}

// Whether the plane through i, j and the newest point does not clearly have the origin and point
// `inner` on the same side.
bool beyond(const Simplex& s, int i, int j, int inner) {
  const Vec3& top = s.points[3].w;
  const Vec3 down = s.points[static_cast<std::size_t>(inner)].w - top;
  const Vec3 n = (s.points[static_cast<std::size_t>(i)].w - top)
                     .cross(s.points[static_cast<std::size_t>(j)].w - top);
  const double origin_height = -n.dot(top);
  const double inner_height = n.dot(down);
  if (!(origin_height * inner_height > 0)) return true;
  const double limit = flat_square * n.squaredNorm();
  return origin_height * origin_height < limit * top.squaredNorm() ||
         inner_height * inner_height < limit * down.squaredNorm();
}

void keep(Simplex& s, const NearestFace& best) {
  // indices may come in any order: gather first
  std::array<SimplexPoint, 3> kept;
  for (std::size_t i = 0; i < static_cast<std::size_t>(best.count); ++i) {
    kept[i] = s.points[static_cast<std::size_t>(best.index[i])];
    s.lambda[i] = best.lambda[i];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(best.count); ++i) s.points[i] = kept[i];
  s.count = best.count;
  s.v = best.v;
}

}  // namespace

bool reduce(Simplex& simplex) {
  NearestFace best;
  switch (simplex.count) {
    case 1: try_point(simplex, 0, best); break;
    case 2: try_segment(simplex, 0, 1, best); break;
    case 3: try_triangle(simplex, 0, 1, 2, best); break;
    default: {
      if (beyond(simplex, 0, 1, 2)) try_triangle(simplex, 0, 1, 3, best);
      if (beyond(simplex, 1, 2, 0)) try_triangle(simplex, 1, 2, 3, best);
      if (beyond(simplex, 2, 0, 1)) try_triangle(simplex, 2, 0, 3, best);
      if (best.count == 0) return true;
    }
  }
  keep(simplex, best);
  return false;
}

}  // namespace tw
