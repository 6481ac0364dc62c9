// Stronge's impact law.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/stronge-law.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/never.h"
#include "dynamics/impact-law.h"
#include "math/root.h"

namespace tw {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

constexpr double stopped = 1e-9;      // of |u|: what slides no faster has stopped
constexpr double settled = 1e-9;      // of K: directions that turn no faster do not turn
constexpr double counts = 1e-12;      // of K: answers
constexpr double fineness = 1. / 16;  // of the time in which a direction may turn by a radian
constexpr int most_steps = 10000, most_rounds = most_steps + 100;

// How far it has come.
struct Progress {
  double p = 0;           // N s, normal
  Vec2 q = Vec2::Zero();  // N s, of friction
  double work = 0;        // J, W
  double least = 0;       // J, W_min
  double normal = 0;      // m/s, u.n
  Vec2 sliding{0, 0};     // m/s, s
};

class ImpactCourse {
 public:
  // K and u along two tangents and n.
  ImpactCourse(const Mat3& K, const Vec3& u, double restitution, double friction)
      : tangential_(K.topLeftCorner<2, 2>()),
        coupling_(K.topRightCorner<2, 1>()),
        direct_(K(2, 2)),
        scale_(K.trace()),
        start_(u),
        keeps_(1 - restitution * restitution),
        mu_(friction),
        // |ds/dp| differs between directions by no more than this
        bend_(mu_ * (tangential_ - 0.5 * tangential_.trace() * Mat2::Identity()).norm() +
              coupling_.norm()) {
    at_.normal = u.z();
    at_.sliding = u.head<2>();
  }

  // False: no impulse ends it.
  bool run() {
    for (int rounds = 0; !over(); ++rounds) {
      if (rounds > most_rounds) return false;
      const double speed = at_.sliding.norm();
      if (speed <= stopped * start_.norm()) return from_rest();
      const Vec2 e = at_.sliding / speed;
      const Vec2 rate = slope(e);
      if (std::abs(across(e, rate)) <= settled * scale_ || rounds > most_steps)
        straight(-mu_ * e, rate.dot(e) < 0 ? speed / -rate.dot(e) : never);
      else
        turn();
    }
    return true;
  }
  Vec3 impulse() const { return {at_.q.x(), at_.q.y(), at_.p}; }

 private:
  static double across(const Vec2& e, const Vec2& x) { return e.x() * x.y() - e.y() * x.x(); }
  double target() const { return keeps_ * at_.least; }
  bool over() const { return at_.normal >= 0 && at_.work >= target(); }
  // ds/dp while it slides along e
  Vec2 slope(const Vec2& e) const { return coupling_ - mu_ * (tangential_ * e); }

  enum class Stop { none, turns, ends };  // from compression to restitution, or the impact itself
  void take(double dp, const Vec2& dq, double dwork, Stop stop) {
    at_.p += dp;
    at_.q += dq;
    at_.work += dwork;
    at_.normal = start_.z() + direct_ * at_.p + coupling_.dot(at_.q);
    at_.sliding = start_.head<2>() + tangential_ * at_.q + coupling_ * at_.p;
    if (stop == Stop::turns) at_.normal = 0;
    if (stop == Stop::ends) at_.work = target();
    if (at_.normal < 0 || stop == Stop::turns) at_.least = std::min(at_.least, at_.work);
  }

  // Goes on with constant friction f for `most` of p at most, all quadratics: to rest, to the turn
  // from compression to restitution, or to the end.
  void straight(const Vec2& f, double most) {
    const double gain = direct_ + coupling_.dot(f), v = at_.normal;
    double dp = most;
    Stop stop = Stop::none;
    if (v < 0) {
      if (gain > 0 && -v / gain <= dp) dp = -v / gain, stop = Stop::turns;
    } else {
      // v dp + gain dp^2/2 = need, the first root; where it falls back before, to v = 0
      const double need = target() - at_.work, disc = v * v + 2 * gain * need;
      const double to_end = disc >= 0 ? 2 * need / (v + std::sqrt(disc)) : never;
      if (to_end <= dp)
        dp = to_end, stop = Stop::ends;
      else if (gain < 0)
        dp = std::min(dp, std::max(2 * v / -gain, 0.0));
    }
    take(dp, f * dp, dp * (v + 0.5 * gain * dp), stop);
    if (dp == most) at_.sliding.setZero();
  }

  // What slides turns and slows down as one flow over t, dp = |s| dt: with s = exp(l) (cos a, sin
  // a)
  //   a' = e_across.ds/dp,  l' = e.ds/dp,  p' = exp(l),  q' = -mu e p',  W' = u.n p'
  // whose right sides stay finite where it stops: l falls without end.
  using Flow = Eigen::Matrix<double, 6, 1>;  // a, l, p, q, W; the last four since the step's start
  Flow rates(const Flow& y) const {
    const Vec2 e(std::cos(y[0]), std::sin(y[0])), rate = slope(e);
    const double speed = std::exp(y[1]);
    const double normal = at_.normal + direct_ * y[2] + coupling_.dot(Vec2(y[3], y[4]));
    Flow f;
    f << across(e, rate), e.dot(rate), speed, -mu_ * speed * e, normal * speed;
    return f;
  }
  Flow step(const Flow& y, double h) const {
    const Flow k1 = rates(y), k2 = rates(y + 0.5 * h * k1), k3 = rates(y + 0.5 * h * k2),
               k4 = rates(y + h * k3);
    return y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  void turn() {
    Flow y = Flow::Zero();
    y[0] = std::atan2(at_.sliding.y(), at_.sliding.x());
    y[1] = std::log(at_.sliding.norm());
    const double h = fineness / (bend_ + std::abs(rates(y)[1]));
    const auto normal_after = [&](const Flow& to) {
      return at_.normal + direct_ * to[2] + coupling_.dot(Vec2(to[3], to[4]));
    };
    Flow to = step(y, h);
    const auto cut_where = [&](const auto& value) {
      const double at =
          find_root([&](double part) { return value(step(y, part)); }, 0.0, h, value(y), value(to))
              .right;
      to = step(y, at);
    };
    const double goal = target() - at_.work;
    Stop stop = Stop::none;
    if (at_.normal < 0 && normal_after(to) >= 0) {
      stop = Stop::turns;
      cut_where(normal_after);
    } else if (at_.normal >= 0 && to[5] >= goal) {
      stop = Stop::ends;
      cut_where([&](const Flow& y_at) { return y_at[5] - goal; });
    }
    take(to[2], {to[3], to[4]}, to[5], stop);
  }

  // It has stopped sliding: sticks, or slides away, in either case with the same friction to the
  // end.
  bool from_rest() {
    const Eigen::SelfAdjointEigenSolver<Mat2> axes(tangential_);
    const Vec2 c = axes.eigenvectors().transpose() * coupling_, k = axes.eigenvalues();
    // along the axes: e of a given acceleration g; what no impulse changes is left out
    const double least = counts * scale_;
    const auto along = [&](double g) {
      Vec2 e = Vec2::Zero();
      for (int i = 0; i < 2; ++i)
        if (std::abs(c[i]) > least) e[i] = c[i] / (mu_ * std::max(k[i], least) + g);
      return e;
    };
    const auto excess = [&](double g) { return along(g).norm() - 1; };
    // |e| falls as g grows, to 1 at most at |c|
    Vec2 e = along(0);
    if (e.norm() > 1)
      e = along(find_root(excess, 0.0, c.norm(), excess(0), excess(c.norm())).right).normalized();
    const Vec2 f = -mu_ * (axes.eigenvectors() * e);
    if (!(direct_ + coupling_.dot(f) > least)) return false;
    at_.sliding.setZero();
    while (!over()) straight(f, never);
    return true;
  }

  Mat2 tangential_;
  Vec2 coupling_;
  double direct_, scale_;
  Vec3 start_;
  double keeps_, mu_, bend_;
  Progress at_;
};

}  // namespace

Vec3 stronge_impulse(const Mat3& K, const Vec3& n, const Vec3& u, double restitution,
                     double friction) {
  // without friction both laws are Newton's
  const Vec3 other = impact_impulse(K, n, u, restitution, friction);
  if (friction == 0 || other.isZero()) return other;
  Mat3 axes;
  axes.col(0) = n.unitOrthogonal();
  axes.col(1) = n.cross(axes.col(0));
  axes.col(2) = n;
  const Mat3 K_n = axes.transpose() * (0.5 * (K + K.transpose())) * axes;
  ImpactCourse course(K_n, axes.transpose() * u, restitution, friction);
  return course.run() ? Vec3(axes * course.impulse()) : other;
}

}  // namespace tw
