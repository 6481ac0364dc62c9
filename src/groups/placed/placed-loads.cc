// Loads at the start.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/placed/placed-loads.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/constants.h"
#include "base/index.h"
#include "dynamics/impact-law.h"
#include "dynamics/point-law.h"
#include "groups/contacts/match-contacts.h"
#include "integrate/implicit/body-matrix.h"

namespace tw {
namespace {

using Mat36 = Eigen::Matrix<double, 3, 6>;

// Rolling and spinning friction of a contact that touches: a torque on b against the turn of b
// against a, d = Ja u_a + Jb u_b again.
struct TurnSpring {
  Mat36 Ja = Mat36::Zero(), Jb = Mat36::Zero();
  double k = 0, rolling = 0, spinning = 0;
  Vec3 torque = Vec3::Zero();
  // -dM by the turn, and dM by the load
  Mat3 slope = Mat3::Zero();
  Vec3 by_load = Vec3::Zero();

  bool resists() const { return k > 0; }
  void set(const Vec3& n, const Vec3& turn, double load, bool holds);
};

// M = -K turn, its part across n cut to rho_r N and that along n to rho_s N.
void TurnSpring::set(const Vec3& n, const Vec3& turn, double load, bool holds) {
  const Mat3 along = n * n.transpose(), across = Mat3::Identity() - along;
  torque.setZero();
  slope.setZero();
  by_load.setZero();
  const Vec3 roll = -k * (across * turn);
  const double length = roll.norm(), most_roll = rolling * load;
  if (length < most_roll || (holds && rolling > 0)) {
    torque += roll;
    slope += k * across;
  } else if (load > 0 && length > 0) {
    const Vec3 e = roll / length;
    torque += most_roll * e;
    slope += most_roll * k / length * (across - e * e.transpose());
    by_load += rolling * e;
  }
  const double spin = -k * n.dot(turn), most_spin = spinning * load;
  if (std::abs(spin) < most_spin || (holds && spinning > 0)) {
    torque += spin * n;
    slope += k * along;
  } else if (load > 0) {
    torque += std::copysign(most_spin, spin) * n;
    by_load += std::copysign(spinning, spin) * n;
  }
}

// A contact that touches.  Rotations are counted as the way of the farthest point.
struct Spring {
  int a = -1, b = -1;  // members; -1: an outside body
  Vec3 n = Vec3::UnitZ();
  Mat36 Ja = Mat36::Zero(), Jb = Mat36::Zero();  // d = Ja u_a + Jb u_b
  double k = 0, kt = 0, mu = 0;
  double overlap = 0;      // m, as placed
  std::size_t number = 0;  // of the contact
  // where the two slide already: which way friction acts on b, unit; else zero
  Vec3 sliding = Vec3::Zero();
  // at the present displacements, world frame, on b
  Vec3 force = Vec3::Zero(), friction = Vec3::Zero();
  Mat3 slope = Mat3::Zero();  // -df/dd
  double load = 0;
  bool slips = false;
  TurnSpring turning;
  // -df by the turn and -dM by d, its transpose, and the energy, J: of those that are pressed alone
  Mat3 by_turn = Mat3::Zero();
  double energy = 0;

  void press(const Vec3& d, const Vec3& turn, bool holds);
};

// Of a spring that is pressed as deep as it was placed: of all forces and torques in the cone, with
// no more than so many times the load of that depth, the nearest in energy to
//   N = k (depth - n.d),  F = -kt (1 - n n^T) d,  M = -K turn.
// The derivative of a convex potential: where there is a balance, there is one that is found.
void Spring::press(const Vec3& d, const Vec3& turn, bool holds) {
  struct Grip {
    Mat3 of;       // which part of the way or the turn
    double k, mu;  // N/m and 1, or N m/rad and m
    Vec3 wanted = Vec3::Zero(), e = Vec3::Zero();
    double length = 0;
  };
  const Mat3 along = n * n.transpose(), across = Mat3::Identity() - along;
  Grip grips[3] = {
      {across, kt, mu}, {across, turning.k, turning.rolling}, {along, turning.k, turning.spinning}};
  for (Grip& grip : grips) {
    if (!(grip.k > 0)) grip.mu = 0;
    if (grip.mu == 0) continue;
    grip.wanted = -grip.k * (grip.of * (&grip == grips ? d : turn));
    grip.length = grip.wanted.norm();
    if (grip.length > 0) grip.e = grip.wanted / grip.length;
  }
  const double pressing = k * (overlap - n.dot(d));
  const double most = guard::balance_most_pressed * k * overlap;
  // N + sum of mu (mu N - length)/k over what would slip = pressing, k times: from below
  load = pressing;
  double yields = 1 / k;
  for (int round = 0; !holds && round < 4; ++round) {
    double sum = pressing / k;
    yields = 1 / k;
    for (const Grip& grip : grips) {
      if (!(grip.mu > 0 && grip.length > grip.mu * load)) continue;
      sum += grip.mu * grip.length / grip.k;
      yields += grip.mu * grip.mu / grip.k;
    }
    load = sum / yields;
  }
  const bool follows = holds || (load > 0 && load < most);
  if (!holds) load = std::clamp(load, 0.0, most);
  energy = load * (pressing - 0.5 * load) / k;
  // dN = -(grows.dd + rolls.dturn) / yields
  Vec3 grows = n, rolls = Vec3::Zero();
  friction = turning.torque = Vec3::Zero();
  slope = turning.slope = Mat3::Zero();
  for (const Grip& grip : grips) {
    const bool is_way = &grip == grips;
    if (!(grip.mu > 0) || !(load > 0 || holds)) continue;
    Vec3 held = grip.wanted;
    Mat3 stiff = grip.k * grip.of;
    if (!holds && grip.length > grip.mu * load) {
      const double share = grip.mu * load / grip.length;
      held *= share;
      stiff = share * grip.k * (grip.of - grip.e * grip.e.transpose());
      (is_way ? grows : rolls) += grip.mu * grip.e;
    }
    (is_way ? friction : turning.torque) += held;
    (is_way ? slope : turning.slope) += stiff;
    energy += held.dot(grip.wanted - 0.5 * held) / grip.k;
  }
  by_turn.setZero();
  if (follows) {
    slope += grows * grows.transpose() / yields;
    turning.slope += rolls * rolls.transpose() / yields;
    by_turn = grows * rolls.transpose() / yields;
  }
  force = load * n + friction;
  slips = false;
}

class Balance {
 public:
  // `depth`: to which the softest contact carries its body, m.
  Balance(const GroupStart& start, std::vector<Spring> springs, double depth, double gravity)
      : start_(start),
        springs_(std::move(springs)),
        depth_(depth),
        gravity_(gravity),
        matrix_(members(), pairs()) {
    const std::size_t count = start.members.size();
    u_.assign(count, Vec6::Zero());
    mass_.resize(count);
    for (const GroupMember& m : start.members) {
      Vec6 weight;
      Wrench acting{m.force, m.torque};
      if (m.forces) {
        const Wrench more = m.forces->wrench(start.time, {m.x, m.q, m.v, Vec3::Zero()});
        acting.force += more.force;
        acting.torque += more.torque;
      }
      weight << acting.force, acting.torque / m.radius;
      weight_.push_back(weight);
    }
  }

  // False: no forces were found.
  bool solve() {
    const bool found = at_once() || by_degrees();
    const bool slides = std::any_of(springs_.begin(), springs_.end(),
                                    [](const Spring& s) { return !s.sliding.isZero(); });
    if ((found && stands()) || slides) return found;
    // what was at rest on springs as deep as they are placed stands on those
    const auto unloaded = std::tuple(springs_, u_, from_, rate_);
    pressed_ = true;
    if (at_once() && stands()) return true;
    std::tie(springs_, u_, from_, rate_) = unloaded;
    return found;
  }
  const std::vector<Spring>& springs() const { return springs_; }
  // Whether the contact begins to slide: not where others hold what slips a little.
  bool slides(const Spring& s) const {
    if (!s.sliding.isZero()) return true;
    const Vec3 d = way(s, u_) - way(s, from_);
    return s.slips && rate_ * (d - s.n.dot(d) * s.n).norm() > guard::balance_slide * gravity_;
  }

 private:
  // Whether nothing begins to move.
  bool stands() const {
    double fastest = 0;
    for (std::size_t i = 0; i < u_.size(); ++i)
      fastest = std::max(fastest, rate_ * (u_[i] - from_[i]).norm());
    return fastest <= guard::balance_stands * gravity_;
  }

  // All that touch hold and stick at first.
  bool at_once() {
    std::fill(u_.begin(), u_.end(), Vec6::Zero());
    soften(guard::balance_softness);
    for (int round = 0; round < guard::balance_rounds; ++round)
      if (!settle(round == 0)) return false;
    return true;
  }

  // Where Newton's steps do not find there: with inertia that gives way step by step.
  bool by_degrees() {
    std::fill(u_.begin(), u_.end(), Vec6::Zero());
    for (double softness = 1; softness <= guard::balance_softness; softness *= 4) {
      soften(softness);
      if (!settle(softness == 1)) return false;
    }
    return true;
  }

  void soften(double softness) {
    rate_ = gravity_ / (softness * depth_);
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      const GroupMember& m = start_.members[i];
      const Mat3 R = m.q.toRotationMatrix();
      mass_[i].setZero();
      mass_[i].topLeftCorner<3, 3>() = rate_ * m.mass * Mat3::Identity();
      mass_[i].bottomRightCorner<3, 3>() =
          rate_ / (m.radius * m.radius) * (R * m.moments.asDiagonal() * R.transpose());
    }
  }

  int members() const { return static_cast<int>(start_.members.size()); }
  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> pairs;
    for (const Spring& s : springs_)
      if (s.a >= 0 && s.b >= 0) pairs.emplace_back(s.a, s.b);
    return pairs;
  }

  static Vec3 way(const Spring& s, const std::vector<Vec6>& u) { return way(s, s.Ja, s.Jb, u); }
  static Vec3 way(const Spring& s, const Mat36& Ja, const Mat36& Jb, const std::vector<Vec6>& u) {
    Vec3 d = Vec3::Zero();
    if (s.a >= 0) d += Ja * u[index(s.a)];
    if (s.b >= 0) d += Jb * u[index(s.b)];
    return d;
  }

  void set_forces(bool all_hold) {
    for (Spring& s : springs_) {
      const Mat3 along = s.n * s.n.transpose(), across = Mat3::Identity() - along;
      const Vec3 d = way(s, u_);
      if (pressed_) {
        s.press(d, way(s, s.turning.Ja, s.turning.Jb, u_), all_hold);
        continue;
      }
      s.load = std::max(0.0, -s.k * s.n.dot(d));
      if (TurnSpring& t = s.turning; t.resists())
        t.set(s.n, way(s, t.Ja, t.Jb, u_), s.load, all_hold);
      if (!s.sliding.isZero()) {
        s.friction = s.mu * s.load * s.sliding;
        s.slope = all_hold || s.load > 0 ? Mat3(s.k * (s.n + s.mu * s.sliding) * s.n.transpose())
                                         : Mat3(Mat3::Zero());
        s.force = s.load * s.n + s.friction;
        continue;
      }
      const Vec3 wanted = -s.kt * (across * d);
      const double length = wanted.norm(), limit = s.mu * s.load;
      s.slips = !all_hold && s.load > 0 && length > limit;
      if (all_hold || (s.load > 0 && !s.slips)) {
        s.friction = wanted;
        s.slope = s.k * along;
        if (!all_hold || s.mu > 0) s.slope += s.kt * across;
      } else if (s.load > 0) {
        // F = mu N e
        const Vec3 e = wanted / length;
        s.friction = limit * e;
        s.slope = s.k * along + s.mu * s.k * e * s.n.transpose() +
                  limit * s.kt / length * (across - e * e.transpose());
      } else {
        s.friction = Vec3::Zero();
        s.slope = Mat3::Zero();
      }
      s.force = s.load * s.n + s.friction;
    }
  }

  // What is left over; its length in weights of the members, as the scale of gravity has them.
  double set_residual() {
    rest_ = weight_;
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] -= mass_[i] * (u_[i] - from_[i]);
    for (const Spring& s : springs_) {
      if (s.a >= 0) rest_[index(s.a)] += s.Ja.transpose() * s.force;
      if (s.b >= 0) rest_[index(s.b)] += s.Jb.transpose() * s.force;
      const TurnSpring& t = s.turning;
      if (!t.resists()) continue;
      if (s.a >= 0) rest_[index(s.a)] += t.Ja.transpose() * t.torque;
      if (s.b >= 0) rest_[index(s.b)] += t.Jb.transpose() * t.torque;
    }
    double sum = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      const double weight = start_.members[i].mass * gravity_;
      sum += rest_[i].squaredNorm() / (weight * weight);
    }
    return std::sqrt(sum);
  }

  void add_block(int row, int column, const Mat6& block) {
    double* to = matrix_.at(matrix_.offset(row, column));
    for (int c = 0; c < 6; ++c)
      for (int r = 0; r < 6; ++r) to[6 * c + r] += block(r, c);
  }

  // What Newton's method makes least where springs are pressed, J.
  double energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < u_.size(); ++i) {
      const Vec6 way = u_[i] - from_[i];
      sum += 0.5 * way.dot(mass_[i] * way) - weight_[i].dot(u_[i]);
    }
    for (const Spring& s : springs_) sum += s.energy;
    return sum;
  }

  bool step() {
    matrix_.clear(numbers_);
    for (int i = 0; i < members(); ++i) add_block(i, i, mass_[index(i)]);
    for (const Spring& s : springs_) {
      const Mat36* J[2] = {&s.Ja, &s.Jb};
      const int body[2] = {s.a, s.b};
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
          if (body[y] >= 0 && body[x] >= 0)
            add_block(body[y], body[x], J[y]->transpose() * s.slope * *J[x]);
      const TurnSpring& t = s.turning;
      if (!t.resists()) continue;
      // dN = -k n.dd, where it presses
      Mat3 by_way = s.by_turn.transpose();
      if (!pressed_ && s.load > 0) by_way = s.k * t.by_load * s.n.transpose();
      const Mat36* turn[2] = {&t.Ja, &t.Jb};
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
          if (body[y] >= 0 && body[x] >= 0)
            add_block(body[y], body[x],
                      turn[y]->transpose() * (t.slope * *turn[x] + by_way * *J[x]) +
                          J[y]->transpose() * s.by_turn * *turn[x]);
    }
    right_.resize(6 * start_.members.size());
    for (std::size_t i = 0; i < rest_.size(); ++i)
      std::copy_n(rest_[i].data(), 6, right_.data() + 6 * i);
    if (!matrix_.factor() || !matrix_.solve(right_.data())) return false;
    return true;
  }

  void go(const std::vector<Vec6>& from, double share) {
    for (std::size_t i = 0; i < u_.size(); ++i)
      u_[i] = from[i] + share * Eigen::Map<const Vec6>(right_.data() + 6 * i);
  }

  // The displacements from `from_` on.  `anew`: from none, where all that touch hold and stick.
  bool settle(bool anew) {
    from_ = u_;
    set_forces(anew);
    double left = set_residual();
    for (int i = 0; i < guard::balance_steps; ++i) {
      if (!step()) return false;
      // as far as less is left over
      const std::vector<Vec6> here = u_;
      const double before = anew && i == 0 ? never : left;
      const double energy_before = pressed_ ? energy() : -never;
      for (double share = 1; share >= guard::least_balance_step; share *= 0.5) {
        go(here, share);
        set_forces(false);
        left = set_residual();
        if (left < before || energy() < energy_before) break;
      }
      if (left <= guard::balance_residual) return true;
    }
    return false;
  }

  const GroupStart& start_;
  std::vector<Spring> springs_;
  double depth_, gravity_, rate_ = 0;  // 1/tau^2
  bool pressed_ = false;               // springs begin as deep as they are placed
  BodyMatrix matrix_;
  BodyMatrix::Numbers numbers_;
  std::vector<Mat6> mass_;
  std::vector<Vec6> weight_, u_, from_, rest_;
  std::vector<double> right_;
};

bool touches(const NewContact& c, double size) {
  return c.gap <= c.reach() + answer::start_gap * size;
}

// By more than touch.
bool overlaps(const NewContact& c) { return c.gap < -answer::start_depth * c.contact.law.size; }

// Of the lighter one that moves, N.
double lighter_weight(const Scene& scene, const ContactTag& tag) {
  double mass = never;
  for (const BodyId id : {tag.reference, tag.other})
    if (const Body& body = scene.body(id); body.dynamic()) mass = std::min(mass, body.mass);
  return scene.gravity_scale() * mass;
}

// The pairs of two moving bodies that came to touch now and carry nothing, ascending: not those
// that overlap, which are in contact until they have parted.
std::vector<std::uint64_t> unloaded_pairs(const Regrouping& work,
                                          const std::vector<Spring>& springs,
                                          const std::vector<NewContact>& contacts) {
  std::vector<std::uint64_t> unloaded;
  if (!work.request.together) return unloaded;
  const Scene& scene = work.scene();
  const std::uint64_t struck =
      pair_id(work.successors[0].body->id(), work.successors[1].body->id());
  std::vector<std::uint64_t> carrying;
  const auto pair_of = [](const NewContact& c) { return pair_id(c.tag.reference, c.tag.other); };
  for (const Spring& s : springs) {
    const NewContact& c = contacts[s.number];
    if (s.load > answer::carried_share * lighter_weight(scene, c.tag))
      carrying.push_back(pair_of(c));
  }
  for (const NewContact& c : contacts)
    if (overlaps(c)) carrying.push_back(pair_of(c));
  std::sort(carrying.begin(), carrying.end());
  for (const NewContact& c : contacts) {
    const std::uint64_t pair = pair_of(c);
    if (!scene.body(c.tag.reference).dynamic() || !scene.body(c.tag.other).dynamic()) continue;
    if (pair == struck || work.pair_before(pair)) continue;
    if (!std::binary_search(carrying.begin(), carrying.end(), pair)) unloaded.push_back(pair);
  }
  std::sort(unloaded.begin(), unloaded.end());
  unloaded.erase(std::unique(unloaded.begin(), unloaded.end()), unloaded.end());
  return unloaded;
}

double smaller_size(const Scene& scene, const ContactTag& tag) {
  return std::min(scene.body(tag.reference).least_width, scene.body(tag.other).least_width);
}

// J; `n`: a's frame.
double energy_of(const GroupContact& c, const Vec3& n, double gap) {
  PointMotion at;
  at.normal = n;
  at.depth = c.offset - gap;
  at.stretch = c.stretch;
  at.bend = c.bend;
  return point_energy(c.law, c.share, at);
}

Spring spring_of(const GroupStart& start, const NewContact& c, std::size_t number) {
  const GroupContact& contact = start.contacts[number];
  Spring s;
  s.number = number;
  s.n = c.normal;
  s.k = contact.share * contact.law.k;
  if (contact.law.law == FrictionLaw::anchored && contact.law.ct > 0) {
    s.kt = contact.share * contact.law.kt;
    s.mu = contact.law.mu;
  }
  const auto jacobian = [&](int member, double sign) {
    const GroupMember& m = start.members[static_cast<std::size_t>(member)];
    const Vec3 r = c.point - m.x;
    Mat36 J;
    J.leftCols<3>() = sign * Mat3::Identity();
    // th x r = -[r]x th
    J.rightCols<3>() = -sign / m.radius * cross_matrix(r);
    return J;
  };
  if (contact.a >= 0) s.Ja = jacobian(s.a = contact.a, -1);
  if (contact.b >= 0) s.Jb = jacobian(s.b = contact.b, 1);

  const ContactConstants& law = contact.law;
  if (!(law.ct > 0 && (law.rolling > 0 || law.spinning > 0))) return s;
  TurnSpring& t = s.turning;
  t.k = contact.share * law.kt * law.squared_lever();
  t.rolling = law.rolling;
  t.spinning = law.spinning;
  const auto turn = [&](int member, double sign) {
    return Mat3(sign / start.members[static_cast<std::size_t>(member)].radius * Mat3::Identity());
  };
  if (contact.a >= 0) t.Ja.rightCols<3>() = turn(contact.a, -1);
  if (contact.b >= 0) t.Jb.rightCols<3>() = turn(contact.b, 1);
  return s;
}

}  // namespace

double placed_speed(const Scene& scene, double size) {
  return std::sqrt(2 * answer::start_depth * size * scene.gravity_scale());
}

double placed_at(const State& state) {
  if (state.group) return state.group->placed_at;
  const bool was_put = state.arc_key.kind == KeyKind::birth || is_edit(state.arc_key);
  return was_put ? state.arc_time : -never;
}

bool is_just_placed(const Scene& scene, const Body& body, const State& state, double now) {
  const double time_to_fall = placed_speed(scene, body.least_width) / scene.gravity_scale();
  return now - placed_at(state) <= time_to_fall;
}

bool are_placed(const Before& before, const std::vector<ProcessId>& struck) {
  const Scene& scene = before.scene();
  return std::any_of(struck.begin(), struck.end(), [&](ProcessId process) {
    return is_just_placed(scene, scene.body_of(process), before.state(process), before.key().time);
  });
}

std::vector<BodyId> placed_with(const Before& before, const std::vector<ProcessId>& struck,
                                const PlacedTogether* together) {
  std::vector<BodyId> bodies;
  for (const ProcessId process : struck) bodies.push_back(before.scene().body_of(process).id());
  return together ? together->hanging_together(before.scene(), std::move(bodies)) : bodies;
}

PlacedLoads load_placed(const Regrouping& work, GroupStart& start,
                        const std::vector<NewContact>& contacts) {
  const Scene& scene = work.scene();
  PlacedLoads loads;
  std::vector<Spring> springs;
  double depth = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const NewContact& c = contacts[i];
    const double size = smaller_size(scene, c.tag);
    if (!touches(c, size)) continue;
    const Vec3 relative = work.placed(c.tag.other).velocity_at(c.point) -
                          work.placed(c.tag.reference).velocity_at(c.point);
    const double closing = relative.dot(c.normal);
    // what parts and does not press has no load
    if (closing > placed_speed(scene, size) && c.gap >= c.contact.offset) continue;
    if (std::abs(closing) > placed_speed(scene, size)) return loads;
    depth = std::max(depth, start.contacts[i].law.depth);
    springs.push_back(spring_of(start, c, i));
    springs.back().overlap = std::max(0.0, -c.gap);
    const Vec3 slip = relative - closing * c.normal;
    if (slip.norm() > placed_speed(scene, size)) springs.back().sliding = -slip.normalized();
  }
  if (springs.empty()) return loads;
  Balance balance(start, std::move(springs), depth, scene.gravity_scale());
  if (!balance.solve()) return loads;
  loads.unloaded = unloaded_pairs(work, balance.springs(), contacts);
  if (!loads.unloaded.empty()) return loads;

  for (const Spring& s : balance.springs()) {
    GroupContact& c = start.contacts[s.number];
    const NewContact& looks = contacts[s.number];
    const Quat into = work.attitude(looks.tag.reference).conjugate();
    loads.energy -= energy_of(c, into * looks.normal, looks.gap);
    // what is left of a load after the balance is rounding: an overlap that it held would begin
    // where steps do
    const bool bears = s.load > guard::balance_residual * lighter_weight(scene, looks.tag);
    c.offset = bears             ? spring_depth(c.law, c.share, s.load) + looks.gap
               : overlaps(looks) ? unpressed(looks.gap, c.law.size)
                                 : std::min(looks.gap, 0.0);
    c.stretch = Vec3::Zero();
    const double grip = friction_grip(c.law, c.offset - looks.gap);
    if (s.kt > 0) {
      const double beyond = balance.slides(s) ? answer::preload_beyond : 1;
      c.stretch = into * Vec3(-beyond / (grip * s.kt) * s.friction);
    }
    if (s.turning.resists()) c.bend = into * Vec3(-1 / (grip * s.turning.k) * s.turning.torque);
    loads.energy += energy_of(c, into * looks.normal, looks.gap);
  }
  return loads;
}

}  // namespace tw
