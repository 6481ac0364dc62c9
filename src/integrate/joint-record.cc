// What an arc keeps of the joints of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/joint-record.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/constants.h"
#include "math/root.h"
#include "math/rotation-vector.h"

namespace tw {

using namespace multibody;

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// The velocities that the rate of a displacement means.
void velocities_of(const Tree& tree, const double* z, const double* rate, double* u) {
  std::copy_n(rate, tree.nv(), u);
  for (int i = first_node; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const int k = node.u;
    if (node.kind == NodeKind::ball)
      set_vector(u + k, angular_velocity(-vector_at(z + k), vector_at(rate + k)));
    else if (node.kind == NodeKind::floating)
      set_vector(u + k + 3, angular_velocity(vector_at(z + k + 3), vector_at(rate + k + 3)));
  }
}

// How fast a frame may move and turn, and how fast that may change.
struct Rates {
  double turn = 0, turn_change = 0, speed = 0, acceleration = 0;

  // Of a point at this distance from the origin.
  Rates at(double arm) const {
    return {turn, turn_change, speed + turn * arm,
            acceleration + (turn_change + turn * turn) * arm};
  }
  // With what the middle of a stretch of this half length shows.
  void narrow(const Vec3& v, const Vec3& w, double half) {
    turn = std::min(turn, w.norm() + half * turn_change);
    speed = std::min(speed, v.norm() + half * acceleration);
  }
};

}  // namespace

PoseTwist link_point(const Multibody& multibody, const Kinematics& k, int link) {
  const Pose& principal = multibody.principal[index(link)];
  const tw::Frame frame = link_frame(multibody.tree, k, link);
  const LinkTwist twist = link_twist(multibody.tree, k, link);
  const Vec3 arm = frame.R * principal.p;
  return {frame.p + arm, (Quat(frame.R) * principal.q).normalized(), twist.v + twist.w.cross(arm),
          twist.w};
}

struct JointRecord::Placed {
  std::uint64_t record = 0;
  double time = 0;
  Velocities which = Velocities::integrated;
  std::unique_ptr<Kinematics> k;
  std::vector<double> y, z, u, q;
};

std::uint64_t JointRecord::next_serial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

JointRecord::JointRecord(const Multibody& multibody, double start, const std::vector<double>& q,
                         const std::vector<double>& u, int degree)
    : multibody_(&multibody),
      n_(multibody.tree.nv()),
      path_(start, 2 * n_, degree),
      nodes_(q),
      last_u_(u) {}

void JointRecord::append(double time, const std::vector<double>& coefficients,
                         const std::vector<double>& q) {
  path_.append(time, coefficients);
  nodes_.insert(nodes_.end(), q.begin(), q.end());
  // their sum is the value at the end
  std::fill(last_u_.begin(), last_u_.end(), 0.0);
  for (int k = 0; k <= path_.degree(); ++k)
    for (int e = 0; e < n_; ++e) last_u_[index(e)] += coefficients[index(2 * n_ * k + n_ + e)];
}

// All links of a multibody are asked for the same times, one after the other: the last answers are
// kept.
const JointRecord::Placed& JointRecord::placed(double time, Velocities which) const {
  constexpr std::size_t places = 64;
  thread_local std::vector<Placed> table(places);
  Placed& p = table[(serial_ * 2 + (which == Velocities::of_path)) % places];
  if (p.record == serial_ && p.time == time && p.which == which) return p;
  const Tree& tree = multibody_->tree;
  p.q.resize(index(tree.nq()));
  p.u.resize(index(n_));
  const bool of_path = which == Velocities::of_path && path_.steps() > 0;
  const int step = of_path ? path_.step_to(time) : path_.step_from(time);
  if (step < 0) {
    std::copy_n(node(path_.steps()), tree.nq(), p.q.begin());
    p.u = last_u_;
  } else {
    p.y.resize(index(2 * n_));
    const double r = path_.fraction(step, time);
    path_.values(step, r, p.y.data());
    displace(tree, {node(step), index(tree.nq())}, {p.y.data(), index(n_)}, p.q);
    if (of_path) {
      p.z = p.y;
      path_.rates(step, r, p.y.data());
      velocities_of(tree, p.z.data(), p.y.data(), p.u.data());
    } else {
      std::copy_n(p.y.begin() + n_, n_, p.u.begin());
    }
  }
  // kept work spaces fit one tree each
  if (!p.k || p.k->nodes.size() != index(tree.node_count()) || p.k->axes.size() != index(n_))
    p.k = std::make_unique<Kinematics>(tree);
  Surroundings around;
  around.base = multibody_->base;
  place(tree, p.q, p.u, around, *p.k);
  p.record = serial_;
  p.time = time;
  p.which = which;
  return p;
}

void JointRecord::joints(double time, std::vector<double>& q, std::vector<double>& u) const {
  const Placed& p = placed(time, Velocities::integrated);
  q = p.q;
  u = p.u;
}

PoseTwist JointRecord::at(int link, double time) const {
  return link_point(*multibody_, *placed(time, Velocities::integrated).k, link);
}

Pose JointRecord::pose(int link, double time) const {
  const PoseTwist point = at(link, time);
  return {point.x, point.q};
}

Twist JointRecord::rates(int link, double time) const {
  const PoseTwist point = link_point(*multibody_, *placed(time, Velocities::of_path).k, link);
  return {point.v, point.w};
}

void JointRecord::add_step_bounds(int step, int link, double from, double to,
                                  MotionBounds& bounds) const {
  const Tree& tree = multibody_->tree;
  const double begin = std::max(from, path_.time(step)), end = std::min(to, path_.time(step + 1));
  const double r0 = path_.fraction(step, begin), r1 = path_.fraction(step, end);
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const Placed& p = placed(middle, Velocities::of_path);
  const auto rate = [&](int k, int order) { return path_.bound(step, k, order, r0, r1); };
  const auto both = [&](int k, int order) {
    return std::sqrt(rate(k, order) * rate(k, order) + rate(k + 1, order) * rate(k + 1, order) +
                     rate(k + 2, order) * rate(k + 2, order));
  };

  // the way from the base
  const Link& fixed = tree.link(link);
  std::vector<int> way;
  for (int i = fixed.node; i >= first_node; i = tree.node(i).parent) way.push_back(i);
  Rates rates;
  for (auto at = way.rbegin(); at != way.rend(); ++at) {
    const Node& node = tree.node(*at);
    const NodeMotion& motion = p.k->node(*at);
    const double first = rate(node.u, 1), second = rate(node.u, 2);
    double arm = node.X_PF.p.norm();
    if (node.kind == NodeKind::slider)
      arm = (motion.r - p.k->node(node.parent).r).norm() + half * first;
    const double turn = rates.turn;
    if (node.kind != NodeKind::floating) rates = rates.at(arm);
    if (node.kind == NodeKind::hinge) {
      rates.turn += first;
      rates.turn_change += second + turn * first;
    } else if (node.kind == NodeKind::slider) {
      rates.speed += first;
      rates.acceleration += second + 2 * turn * first;
    } else {
      const int at_rotation = node.u + (node.kind == NodeKind::floating ? 3 : 0);
      const double w = both(at_rotation, 1);
      rates.turn += w;
      rates.turn_change += both(at_rotation, 2) + (w + turn) * w;
      if (node.kind == NodeKind::floating) {
        rates.speed += both(node.u, 1);
        rates.acceleration += both(node.u, 2);
      }
    }
    rates.narrow(motion.V.v + motion.V.w.cross(motion.r), motion.V.w, half);
  }
  const PoseTwist point = link_point(*multibody_, *p.k, link);
  rates = rates.at((fixed.X_NL * fixed.center_of_mass).norm());
  rates.narrow(point.v, point.w, half);

  const Vec3 reach =
      half * point.v.cwiseAbs() + Vec3::Constant(0.5 * half * half * rates.acceleration);
  bounds.path.add(Vec3(point.x - reach));
  bounds.path.add(Vec3(point.x + reach));
  bounds.speed = std::max(bounds.speed, rates.speed);
  bounds.turn = std::max(bounds.turn, rates.turn);
  bounds.turn_change = std::max(bounds.turn_change, rates.turn_change);
  for (const double sign : {-1.0, 1.0})
    bounds.acceleration.add(Vec3(Vec3::Constant(sign * rates.acceleration)));
}

MotionBounds JointRecord::bounds(int link, double from, double to) const {
  MotionBounds result;
  const int last = path_.step_to(to), first = std::min(std::max(path_.step_from(from), 0), last);
  for (int i = from < to ? first : last; i <= last; ++i) add_step_bounds(i, link, from, to, result);
  // rounding
  const double largest =
      std::max(result.path.lo.cwiseAbs().maxCoeff(), result.path.hi.cwiseAbs().maxCoeff());
  result.path.grow(1e-14 * largest);
  result.speed *= 1 + 1e-12;
  result.turn *= 1 + 1e-12;
  result.turn_change *= 1 + 1e-12;
  return result;
}

double JointRecord::value(const Axis& axis, int step, double r) const {
  thread_local std::vector<double> y;
  y.resize(index(2 * n_));
  path_.values(step, r, y.data());
  return node(step)[axis.q] + y[index(axis.u)];
}

// Over a part of a step: halved until it is surely on one side, or too short to matter.
double JointRecord::first_beyond(const Axis& axis, double side, double limit, int step, double r0,
                                 double r1, bool& inside) const {
  constexpr double shortest = 1.0 / 4096;
  const double tolerance = answer::stop_tolerance * (1 + std::abs(limit));
  const auto gap = [&](double r) { return side * (value(axis, step, r) - limit) + tolerance; };
  const double middle = 0.5 * (r0 + r1), here = gap(middle);
  const double reach = 0.5 * (r1 - r0) * path_.length(step) * path_.bound(step, axis.u, 1, r0, r1);
  if (here > reach) return inside = true, never;
  if (!inside && here < -reach) return never;
  if (r1 - r0 > shortest) {
    const double first = first_beyond(axis, side, limit, step, r0, middle, inside);
    return first < never ? first : first_beyond(axis, side, limit, step, middle, r1, inside);
  }
  const double left = gap(r0), right = gap(r1);
  if (right >= 0) return inside = true, never;
  if (!inside && !(left >= 0)) return never;
  const double r = left > 0 ? find_root(gap, r0, r1, left, right).left : r0;
  return path_.time(step) + r * path_.length(step);
}

double JointRecord::first_beyond(const Axis& axis, double side, double limit) const {
  bool inside = false;
  for (int step = 0; step < path_.steps(); ++step)
    if (const double when = first_beyond(axis, side, limit, step, 0, 1, inside); when < never)
      return when;
  return never;
}

JointRecord JointRecord::stretch(double from) const {
  const int first = std::max(0, path_.step_from(from));
  JointRecord copy = *this;
  copy.serial_ = next_serial();
  if (path_.steps() == 0) return copy;
  copy.path_ = path_.stretch(from);
  copy.nodes_.assign(node(first), nodes_.data() + nodes_.size());
  return copy;
}

}  // namespace tw
