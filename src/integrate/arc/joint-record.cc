// What an arc keeps of the joints of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/joint-record.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/index.h"
#include "math/root.h"
#include "math/rotation-vector.h"
#include "multibody/limits.h"

namespace tw {

using namespace multibody;

namespace {

// Parts of a step that have bounds of their own.
constexpr int parts = 4;
// Of a difference of velocities, relative.
constexpr double rounding = 1e-15;

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

// With velocities at the ends of a stretch: a function is nowhere further from its mean rate than
// half the length times the bound of the next.
void narrow(MotionRates& rates, const Vec3& v0, const Vec3& w0, const Vec3& v1, const Vec3& w1,
            double length) {
  const double half = 0.5 * length;
  const auto lessen = [&](double& value, double& change, double next, const Vec3& x0,
                          const Vec3& x1) {
    const double most = std::max(x0.norm(), x1.norm());
    change = std::min(change, ((x1 - x0).norm() + rounding * most) / length + half * next);
    value = std::min(value, most + half * change);
  };
  lessen(rates.turn, rates.turn_change, rates.turn_jerk, w0, w1);
  lessen(rates.speed, rates.acceleration, rates.jerk, v0, v1);
}

}  // namespace

PoseTwist link_point(const Multibody& multibody, const Kinematics& k, int link) {
  const Pose& principal = multibody.principal[index(link)];
  const tw::Frame frame = link_frame(multibody.tree, k, link);
  const LinkTwist twist = link_twist(multibody.tree, k, link);
  const Vec3 arm = frame.R * principal.p;
  return {frame.p + arm, (Quat(frame.R) * principal.q).normalized(), twist.v + twist.w.cross(arm),
          twist.w};
}

// From r0 to r1 of a step.
struct JointRecord::Stretch {
  int step;
  double r0, r1, length;  // s
};

// A multibody at both ends of a stretch.
struct JointRecord::Ends {
  const std::vector<NodeMotion>&begin, &end;
};

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

JointRecord::JointRecord(const Multibody& multibody, double start, double end,
                         const std::vector<double>& q, const std::vector<double>& u, int degree)
    : multibody_(&multibody),
      base_(multibody, end),
      n_(multibody.tree.nv()),
      path_(start, 2 * n_, degree),
      nodes_(q),
      nodes_u_(u) {}

void JointRecord::append(double time, std::vector<double> coefficients,
                         const std::vector<double>& q) {
  coefficients.resize(index(2 * n_ * (path_.degree() + 1)), 0.0);
  path_.append(time, coefficients);
  nodes_.insert(nodes_.end(), q.begin(), q.end());
  // the sum of its coefficients is a velocity at the end
  const std::size_t last = nodes_u_.size();
  nodes_u_.resize(last + index(n_), 0.0);
  for (int k = 0; k <= path_.degree(); ++k)
    for (int e = 0; e < n_; ++e)
      nodes_u_[last + index(e)] += coefficients[index(2 * n_ * k + n_ + e)];
  if (multibody_->touches) keep_bounds(path_.steps() - 1);
}

// All links of a multibody are asked for the same times, one after the other: the last answers are
// kept.
const JointRecord::Placed& JointRecord::placed(double time, Velocities which) const {
  constexpr std::size_t places = 64;
  thread_local std::vector<Placed> table(places);
  Placed& p = table[(serial_ * 2 + (which == Velocities::of_path)) % places];
  if (p.record == serial_ && p.time == time && p.which == which) return p;
  const bool of_path = which == Velocities::of_path && path_.steps() > 0;
  const int step = of_path ? path_.step_to(time) : path_.step_from(time);
  fill(step, step < 0 ? 0 : path_.fraction(step, time), time, of_path, p);
  p.record = serial_;
  p.time = time;
  p.which = which;
  return p;
}

// At a fraction of a step, with the rates of the path; until the next call.
const JointRecord::Placed& JointRecord::place_on_path(int step, double r) const {
  thread_local Placed places[2];
  thread_local int next = 0;
  next = 1 - next;
  fill(step, r, time_at(step, r), true, places[next]);
  return places[next];
}

double JointRecord::time_at(int step, double r) const {
  return r < 1 ? path_.time(step) + r * path_.length(step) : path_.time(step + 1);
}

// At `time`, the fraction r of a step; step -1: at the last node.  At a node what stands there is
// taken as it is, so that it makes no difference whether there is a next step already.
void JointRecord::fill(int step, double r, double time, bool of_path, Placed& p) const {
  const Tree& tree = multibody_->tree;
  const int at = step < 0 ? path_.steps() : step;
  p.q.assign(node(at), node(at) + tree.nq());
  p.u.assign(node_u(at), node_u(at) + n_);
  if (step >= 0 && (r > 0 || of_path)) {
    p.y.resize(index(2 * n_));
    path_.values(step, r, p.y.data());
    if (r > 0) displace(tree, {node(step), index(tree.nq())}, {p.y.data(), index(n_)}, p.q);
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
  BaseMotion around;
  base_.set(time, around);
  place(tree, p.q, p.u, around, *p.k);
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

MotionRates JointRecord::base_rates(const Stretch& stretch) const {
  return base_.most_rates(time_at(stretch.step, stretch.r0), time_at(stretch.step, stretch.r1));
}

MotionRates JointRecord::node_rates(int i, const MotionRates& parent, const Stretch& stretch,
                                    const Ends& ends) const {
  const Node& node = multibody_->tree.node(i);
  using Three = std::array<double, 3>;  // of orders 1, 2, 3
  const auto rate = [&](int dof) {
    return path_.rate_bounds(stretch.step, dof, stretch.r0, stretch.r1);
  };
  const auto all = [&](int dof) {
    const Three x = rate(dof), y = rate(dof + 1), z = rate(dof + 2);
    Three sum{};
    for (std::size_t k = 0; k < 3; ++k) sum[k] = Vec3(x[k], y[k], z[k]).norm();
    return sum;
  };
  // of the rotation vector z of what turns by itself: w = J(z) z', and its rates, |J'| < |z'|
  const auto turning = [&](int dof) {
    const auto [first, second, third] = all(dof);
    return Three{first, second + first * first, third + 3 * first * second + first * first * first};
  };
  const auto narrowed = [&](MotionRates rates) {
    const NodeMotion &a = ends.begin[index(i)], &b = ends.end[index(i)];
    narrow(rates, a.V.v + a.V.w.cross(a.r), a.V.w, b.V.v + b.V.w.cross(b.r), b.V.w, stretch.length);
    return rates;
  };
  if (node.kind == NodeKind::floating) {
    const auto w = turning(node.u + 3);
    const auto v = all(node.u);
    return narrowed({w[0], w[1], w[2], v[0], v[1], v[2]});
  }
  const double turn = parent.turn, change = parent.turn_change;
  if (node.kind == NodeKind::slider) {
    const auto arm = [&](const std::vector<NodeMotion>& nodes) {
      return (nodes[index(i)].r - nodes[index(node.parent)].r).norm();
    };
    const auto [first, second, third] = rate(node.u);
    MotionRates rates =
        parent.at(std::max(arm(ends.begin), arm(ends.end)) + 0.5 * stretch.length * first);
    rates.speed += first;
    rates.acceleration += second + 2 * turn * first;
    rates.jerk += third + 3 * turn * second + 3 * (change + turn * turn) * first;
    return narrowed(rates);
  }
  MotionRates rates = parent.at(node.X_PF.p.norm());
  const auto w = node.kind == NodeKind::ball ? turning(node.u) : rate(node.u);
  rates.turn += w[0];
  rates.turn_change += w[1] + turn * w[0];
  rates.turn_jerk += w[2] + 2 * turn * w[1] + (change + turn * turn) * w[0];
  return narrowed(rates);
}

// The link moves from a to b.
MotionBounds JointRecord::link_bounds(const MotionRates& node, int link, const Stretch& stretch,
                                      const PoseTwist& a, const PoseTwist& b) const {
  const Link& fixed = multibody_->tree.link(link);
  const double length = stretch.length;
  MotionRates rates = node.at((fixed.X_NL * fixed.center_of_mass).norm());
  narrow(rates, a.v, a.w, b.v, b.w, length);
  MotionBounds bounds;
  bounds.speed = rates.speed;
  bounds.turn = rates.turn;
  bounds.turn_change = rates.turn_change;
  // the way between is not further from the chord
  bounds.path.add(a.x);
  bounds.path.add(b.x);
  bounds.path.grow(0.125 * length * length * rates.acceleration);
  // about the mean, or, where that is less, about none
  const double most = std::max(a.v.norm(), b.v.norm());
  const double spread = 0.5 * length * rates.jerk + rounding * most / length;
  const bool about_mean = spread < rates.acceleration;
  const Vec3 mean = about_mean ? Vec3((b.v - a.v) / length) : Vec3(Vec3::Zero());
  const Vec3 reach = Vec3::Constant(about_mean ? spread : rates.acceleration);
  bounds.acceleration.add(Vec3(mean - reach));
  bounds.acceleration.add(Vec3(mean + reach));
  return bounds;
}

void JointRecord::keep_bounds(int step) {
  const Tree& tree = multibody_->tree;
  const double length = path_.length(step) / parts;
  std::vector<NodeMotion> before, after;
  std::vector<PoseTwist> links_before(multibody_->links.size()), links_after(links_before);
  std::vector<MotionRates> rates(index(tree.node_count()));
  kept_bounds_.resize(multibody_->links.size());
  const auto place_at = [&](double r, std::vector<NodeMotion>& nodes,
                            std::vector<PoseTwist>& links) {
    const Placed& p = place_on_path(step, r);
    nodes = p.k->nodes;
    for (int i = 0; i < tree.link_count(); ++i) links[index(i)] = link_point(*multibody_, *p.k, i);
  };
  place_at(0, after, links_after);
  for (int part = 0; part < parts; ++part) {
    before.swap(after);
    links_before.swap(links_after);
    const double r0 = static_cast<double>(part) / parts, r1 = (part + 1.0) / parts;
    place_at(r1, after, links_after);
    const Stretch stretch{step, r0, r1, length};
    rates[index(base_node)] = base_rates(stretch);
    for (int i = first_node; i < tree.node_count(); ++i)
      rates[index(i)] = node_rates(i, rates[index(tree.node(i).parent)], stretch, {before, after});
    for (int i = 0; i < tree.link_count(); ++i)
      kept_bounds_[index(i)].append(link_bounds(rates[index(tree.link(i).node)], i, stretch,
                                                links_before[index(i)], links_after[index(i)]));
  }
}

// Within a step.
MotionBounds JointRecord::short_bounds(int step, int link, double from, double to) const {
  const Tree& tree = multibody_->tree;
  const Stretch stretch{step, path_.fraction(step, from), path_.fraction(step, to), to - from};
  const Placed& p = place_on_path(step, stretch.r0);
  const std::vector<NodeMotion> before = p.k->nodes;
  const PoseTwist begin = link_point(*multibody_, *p.k, link);
  const Placed& after = place_on_path(step, stretch.r1);
  // the way from the base
  std::vector<int> way;
  for (int i = tree.link(link).node; i >= first_node; i = tree.node(i).parent) way.push_back(i);
  MotionRates rates = base_rates(stretch);
  for (auto at = way.rbegin(); at != way.rend(); ++at)
    rates = node_rates(*at, rates, stretch, {before, after.k->nodes});
  return link_bounds(rates, link, stretch, begin, link_point(*multibody_, *after.k, link));
}

MotionBounds JointRecord::bounds(int link, double from, double to) const {
  // of its part, below which a stretch has bounds of its own
  constexpr double short_share = 0.125;
  const int last = path_.step_to(to), first = std::min(std::max(path_.step_from(from), 0), last);
  MotionBounds result;
  if (from < to && first == last && to - from < short_share * path_.length(last) / parts) {
    result = short_bounds(last, link, from, to);
  } else if (kept_bounds_.empty()) {
    for (int i = first; i <= last; ++i)
      result.add(short_bounds(i, link, path_.time(i), path_.time(i + 1)));
  } else {
    const auto part_of = [&](int step, double time) {
      return step * parts +
             std::clamp(static_cast<int>(path_.fraction(step, time) * parts), 0, parts - 1);
    };
    const int end = part_of(last, to), begin = from < to ? part_of(first, from) : end;
    kept_bounds_[index(link)].add(index(begin), index(end + 1), result);
  }
  // rounding
  const double largest =
      std::max(result.path.lo.cwiseAbs().maxCoeff(), result.path.hi.cwiseAbs().maxCoeff());
  result.path.grow(1e-14 * largest);
  result.speed *= 1 + 1e-12;
  result.turn *= 1 + 1e-12;
  result.turn_change *= 1 + 1e-12;
  return result;
}

double JointRecord::limited(const Axis& axis, int step, double r) const {
  thread_local std::vector<double> y;
  y.resize(index(2 * n_));
  path_.values(step, r, y.data());
  if (axis.ball) {
    const Quat from = multibody::quaternion_at(node(step) + axis.q);
    const Quat q = from * short_rotation(multibody::vector_at(&y[index(axis.u)]));
    return multibody::limited_angle(axis, q.normalized()).angle;
  }
  return node(step)[axis.q] + y[index(axis.u)];
}

// Bound of its rate; an angle never grows faster than its rotation vector.
double JointRecord::limited_rate(const Axis& axis, int step, double r0, double r1) const {
  if (!axis.ball) return path_.rate_bounds(step, axis.u, r0, r1)[0];
  double squared = 0;
  for (int k = axis.u; k < axis.u + 3; ++k) {
    const double rate = path_.rate_bounds(step, k, r0, r1)[0];
    squared += rate * rate;
  }
  return std::sqrt(squared);
}

// Over a part of a step: halved until it is surely on one side, or too short to matter.  `least`:
// how far it may be from the limit, negative beyond.
double JointRecord::first_beyond(const Axis& axis, double side, double limit, double least,
                                 int step, double r0, double r1) const {
  constexpr double shortest = 1.0 / 4096;
  const auto gap = [&](double r) { return side * (limited(axis, step, r) - limit) - least; };
  const double middle = 0.5 * (r0 + r1);
  const double reach = 0.5 * (r1 - r0) * path_.length(step) * limited_rate(axis, step, r0, r1);
  if (gap(middle) > reach) return never;
  if (r1 - r0 > shortest) {
    const double first = first_beyond(axis, side, limit, least, step, r0, middle);
    return first < never ? first : first_beyond(axis, side, limit, least, step, middle, r1);
  }
  const double left = gap(r0), right = gap(r1);
  if (right >= 0) return never;
  const double r = left > 0 ? find_root(gap, r0, r1, left, right).left : r0;
  return path_.time(step) + r * path_.length(step);
}

double JointRecord::first_beyond(const Axis& axis, double side, double limit) const {
  if (path_.steps() == 0) return never;
  const double gap = side * (limited(axis, 0, 0) - limit);
  const double least = std::min(gap, 0.0) - multibody::stop_tolerance(axis, limit);
  for (int step = 0; step < path_.steps(); ++step)
    if (const double when = first_beyond(axis, side, limit, least, step, 0, 1); when < never)
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
  copy.nodes_u_.assign(node_u(first), nodes_u_.data() + nodes_u_.size());
  for (std::size_t link = 0; link < kept_bounds_.size(); ++link) {
    const BoundsTree& kept = kept_bounds_[link];
    copy.kept_bounds_[link] = {};
    for (std::size_t i = index(first * parts); i < kept.size(); ++i)
      copy.kept_bounds_[link].append(kept[i]);
  }
  return copy;
}

}  // namespace tw
