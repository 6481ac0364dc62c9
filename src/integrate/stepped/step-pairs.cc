// Who of a cluster is near whom, and where they touch.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/step-pairs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/never.h"
#include "collision/broad/near-parts.h"

namespace tw {

namespace {

std::uint64_t parts_key(std::size_t a, std::size_t b) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b);
}

bool is_ball(const ConvexPart& part) { return part.kind == PartKind::sphere; }

}  // namespace

StepPairs::StepPairs(std::vector<StepBody>& bodies, int members, StepLaws laws, const Vec3& gravity,
                     double follow)
    : bodies_(bodies),
      members_(members),
      laws_(std::move(laws)),
      follow_(follow),
      gravity_(gravity),
      fits_(bodies.size()),
      near_(static_cast<std::size_t>(members)) {
  for (std::size_t i = near_.size(); i < bodies_.size(); ++i) {
    const StepBody& outside = bodies_[i];
    if (outside.motion) continue;
    if (outside.shape->bounded())
      hash_.place(static_cast<std::uint32_t>(i), outside.shape->bounds(outside.frame));
    else
      everywhere_.push_back(static_cast<int>(i));
  }
}

double StepPairs::size_of(const Pair& pair) const {
  return std::min(body(pair.a).size, body(pair.b).size);
}

double StepPairs::margin_of(const Pair& pair) const {
  const double margin = follow_ * size_of(pair);
  return pair.distance < -stepping::deep ? 0.1 * margin : margin;
}

// How far points of the two move against each other in the step to come.
double StepPairs::relative_travel(const Pair& pair) const {
  const StepBody &a = body(pair.a), &b = body(pair.b);
  return (b.to_move - a.to_move).norm() + a.to_turn + b.to_turn;
}

// ---- boxes ----

// Where a body is bound for in the step to come.
void StepPairs::set_out(StepBody& moving, double h) const {
  const Vec3 fall = moving.moves ? Vec3(gravity_ * (h * h)) : Vec3(Vec3::Zero());
  moving.to_move = h * moving.v + fall;
  moving.to_turn = h * moving.w.norm() * moving.radius;
  const Mat3 turn = rotation_by(0.5 * h * moving.w).toRotationMatrix();
  moving.ahead.R = turn * moving.frame.R;
  moving.ahead.p =
      moving.x + 0.5 * h * moving.v + 0.125 * fall + turn * (moving.frame.p - moving.x);
}

void StepPairs::refit(int number) {
  StepBody& moving = body(number);
  Fit& fit = fits_[static_cast<std::size_t>(number)];
  const double to_travel = moving.to_move.norm() + moving.to_turn;
  if (fit.made) {
    // the box as it was, moved along, and turned by as much
    const Vec3 moved = moving.frame.p - fit.x;
    const double turned =
        std::min(2.0, (moving.frame.R - fit.R).norm()) * moving.shape->radius_about_origin();
    const Vec3 room = Vec3::Constant(to_travel + turned);
    const Vec3 lo = fit.tight.lo + moved - room, hi = fit.tight.hi + moved + room;
    if ((lo.array() >= fit.box.lo.array()).all() && (hi.array() <= fit.box.hi.array()).all())
      return;
  }
  ++counts_.refits;
  fit.made = true;
  fit.x = moving.frame.p;
  fit.R = moving.frame.R;
  fit.tight = fit.box = moving.shape->bounds(moving.frame);
  const Vec3 ahead = moving.v * stepping::box_ahead;
  fit.box.grow(stepping::box_room * std::min(moving.size, moving.radius) + to_travel);
  fit.box.lo += ahead.cwiseMin(0);
  fit.box.hi += ahead.cwiseMax(0);
  hash_.place(static_cast<std::uint32_t>(number), fit.box);
  hash_.overlapping(static_cast<std::uint32_t>(number),
                    [&](std::uint32_t other) { add_near(number, static_cast<int>(other)); });
  for (const int other : everywhere_) add_near(number, other);
}

void StepPairs::add_near(int number, int other) {
  int b = std::max(number, other), a = std::min(number, other);
  if (b >= members_) std::swap(a, b);  // the one that moves
  if (b >= members_) return;
  const StepLaw law = laws_(a, b);
  if (!law.collide) return;
  const Shape &of_a = *body(a).shape, &of_b = *body(b).shape;
  if (of_a.part_count() == 1 && of_b.part_count() == 1) return add_pair(a, b, 0, 0, law);
  // as far as both may get before a box is made anew
  double reach = 0;
  for (const int number_of : {a, b}) {
    const Fit& one = fits_[static_cast<std::size_t>(number_of)];
    if (one.made) reach += (one.box.size() - one.tight.size()).norm();
  }
  visit_near_parts(of_a, body(a).frame, of_b, body(b).frame, reach,
                   [&](std::size_t i, std::size_t j) { add_pair(a, b, i, j, law); });
}

void StepPairs::add_pair(int a, int b, std::size_t part_a, std::size_t part_b, const StepLaw& law) {
  std::vector<Near>& list = near_[static_cast<std::size_t>(b)];
  const std::uint64_t parts = parts_key(part_a, part_b);
  const auto place = std::lower_bound(
      list.begin(), list.end(), std::pair(a, parts),
      [](const Near& near, const auto& wanted) { return std::pair(near.a, near.parts) < wanted; });
  if (place != list.end() && place->a == a && place->parts == parts) return;
  int number = static_cast<int>(pairs_.size());
  if (free_.empty()) {
    pairs_.emplace_back();
  } else {
    number = free_.back();
    free_.pop_back();
  }
  Pair& pair = pairs_[static_cast<std::size_t>(number)];
  std::vector<Point> points = std::move(pair.points);
  points.clear();
  pair = Pair();
  pair.points = std::move(points);
  pair.a = a;
  pair.b = b;
  pair.part_a = part_a;
  pair.part_b = part_b;
  pair.law = law;
  pair.is_round = is_ball(body(a).shape->part(part_a)) && is_ball(body(b).shape->part(part_b));
  list.insert(place, {Vec3::Zero(), -1, a, number, parts, false});
}

bool StepPairs::still_near(const Pair& pair) const {
  const StepBody& a = body(pair.a);
  const Fit &fit_a = fits_[static_cast<std::size_t>(pair.a)],
            &fit_b = fits_[static_cast<std::size_t>(pair.b)];
  if (fit_a.made) return fit_a.box.overlaps(fit_b.box);
  return !a.shape->bounded() || hash_.box(static_cast<std::uint32_t>(pair.a)).overlaps(fit_b.box);
}

// ---- looks ----

void StepPairs::look(double h) {
  for (StepBody& moving : bodies_)
    if (moving.moves || moving.motion) set_out(moving, h);
  for (int i = 0; i < static_cast<int>(bodies_.size()); ++i)
    if (i < members_ || body(i).motion) refit(i);
  for (int number = 0; number < members_; ++number) {
    std::vector<Near>& list = near_[static_cast<std::size_t>(number)];
    const StepBody& b = body(number);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      Near near = list[i];
      const StepBody& a = body(near.a);
      const auto along = [&](const Vec3& motion) {
        return near.live ? -motion.norm() : near.axis.dot(motion);
      };
      near.room += along(b.moved - a.moved) - (b.turned + a.turned);
      if (near.room + along(b.to_move - a.to_move) - (b.to_turn + a.to_turn) > 0) {
        ++(near.live ? counts_.follows : counts_.skips);
      } else if (near.live || still_near(pairs_[static_cast<std::size_t>(near.pair)])) {
        look_at_pair(near);
      } else {
        free_.push_back(near.pair);
        continue;
      }
      list[kept++] = near;
    }
    list.resize(kept);
  }
  for (StepBody& moving : bodies_) {
    moving.moved.setZero();
    moving.turned = 0;
  }
}

void StepPairs::look_at_pair(Near& near) {
  Pair& pair = pairs_[static_cast<std::size_t>(near.pair)];
  if (pair.touches && !pair.is_round && follows(near, pair)) {
    ++counts_.follows;
    return;
  }
  renew(near, pair);
  near.live = pair.touches;
}

// Whether the points still serve: the two have moved against each other by less than the margin.
bool StepPairs::follows(Near& near, const Pair& pair) const {
  const StepBody &a = body(pair.a), &b = body(pair.b);
  const Mat3 turned = a.frame.R.transpose() * b.frame.R;
  const Vec3 moved = a.frame.to_local(b.frame.p) - pair.placed;
  const double turn = (turned - pair.turned).norm() * b.radius;
  double motion = moved.norm() + turn;
  if (pair.on_face) {
    const double up = moved.dot(pair.face_normal);
    const double along = (moved - up * pair.face_normal).norm();
    const double room = std::min(pair.room - turn, size_of(pair));
    motion = std::abs(up) + turn + std::max(0.0, along - room);
  }
  near.room = std::min(margin_of(pair), pair.reach) - motion;
  return near.room >= 0 && motion + relative_travel(pair) <= pair.reach;
}

void StepPairs::log(int number, Pair& pair) {
  if (logged_ == log_.size()) log_.emplace_back();
  Logged& entry = log_[logged_++];
  entry.pair = number;
  entry.touched = pair.touches;
  if (pair.touches) entry.before = pair;
}

void StepPairs::renew(Near& near, Pair& pair) {
  thread_local PartLook look;
  if (logging_) log(near.pair, pair);
  ++counts_.looks;
  const StepBody &a = body(pair.a), &b = body(pair.b);
  const double relative = relative_travel(pair), size = size_of(pair);
  const double reach = relative + follow_ * size;
  const bool early = !pair.is_round && relative > stepping::look_ahead * size;
  const Frame& frame_a = early ? a.ahead : a.frame;
  const Frame& frame_b = early ? b.ahead : b.frame;
  look_at(a.shape->part(pair.part_a), frame_a, b.shape->part(pair.part_b), frame_b, reach,
          a.moves ? ReferenceChoice::larger : ReferenceChoice::of_a, pair.memory, look);
  pair.distance = look.distance;
  pair.touches = look.count > 0;
  if (!pair.touches) {
    pair.points.clear();
    pair.depth = 0;
    // seen in the middle of the step: as much nearer, perhaps, as they come apart until then
    near.axis = look.axis;
    near.room = look.distance - (early ? relative : 0);
    return;
  }
  pair.turned = a.frame.R.transpose() * b.frame.R;
  pair.placed = a.frame.to_local(b.frame.p);
  pair.reach = reach;
  pair.on_face = look.on_face;
  pair.room = look.room;
  if (look.on_face) {
    const Vec3& n = look.points[0].normal;
    pair.face_normal = look.points[0].reference_is_a ? n : Vec3(pair.turned * n);
  }
  keep_points(pair, look, reach);
  near.room = pair.is_round ? -1 : std::min(reach, margin_of(pair));
}

// The points of a look, each with the impulse of the one that was there.
void StepPairs::keep_points(Pair& pair, const PartLook& look, double reach) {
  thread_local std::vector<Point> fresh;
  fresh.clear();
  const StepBody &a = body(pair.a), &b = body(pair.b);
  const double near = stepping::same_point * std::min(a.moves ? a.radius : b.radius, b.radius);
  const auto core_of = [&](const LookPoint& p) {
    return (p.reference_is_a ? b : a).frame * p.core;
  };
  const bool is_lone = !look.on_face && look.count == 1;
  for (int i = 0; i < look.count; ++i) {
    const LookPoint& found = look.points[static_cast<std::size_t>(i)];
    Point point;
    point.at = found;
    point.is_lone = is_lone;
    Point* best = nullptr;
    double least = near;
    const Vec3 core = core_of(found);
    for (Point& old : pair.points) {
      if (old.at.feature == found.feature && old.at.reference_is_a == found.reference_is_a) {
        best = &old;
        break;
      }
      const double away = (core_of(old.at) - core).norm();
      if (away < least) least = away, best = &old;
    }
    if (best) {
      point.impulse = std::exchange(best->impulse, 0);
      point.tangential = std::exchange(best->tangential, Vec3(Vec3::Zero()));
    }
    fresh.push_back(point);
  }
  for (const Point& old : pair.points) {
    if (!old.is_lone || old.age >= stepping::kept_looks || fresh.size() >= most_look_points)
      continue;
    const auto is_it = [&](const Point& p) { return p.at.feature == old.at.feature; };
    if (std::any_of(fresh.begin(), fresh.end(), is_it)) continue;
    const StepBody &of = old.at.reference_is_a ? a : b, &other = old.at.reference_is_a ? b : a;
    const double gap = old.at.normal.dot(of.frame.to_local(other.frame * old.at.core)) -
                       old.at.offset - old.at.radius;
    if (gap > reach || gap < -stepping::look_ahead * size_of(pair)) continue;
    fresh.push_back(old);
    ++fresh.back().age;
  }
  pair.points.swap(fresh);
}

// ---- contacts ----

double StepPairs::gather(double depth, std::vector<StepContact>& contacts) {
  double worst = 0;
  deepest_ = 0;
  contacts.clear();
  for (const std::vector<Near>& list : near_)
    for (const Near& near : list) {
      if (!near.live) continue;
      Pair& pair = pairs_[static_cast<std::size_t>(near.pair)];
      const StepBody &a = body(pair.a), &b = body(pair.b);
      const double reach = relative_travel(pair);
      double deepest = 0;
      for (std::size_t i = 0; i < pair.points.size(); ++i) {
        Point& point = pair.points[i];
        const StepBody& of = point.at.reference_is_a ? a : b;
        const StepBody& other = point.at.reference_is_a ? b : a;
        const Vec3 n = of.frame.R * point.at.normal, core = other.frame * point.at.core;
        const double gap = n.dot(core - of.frame.p) - point.at.offset - point.at.radius;
        deepest = std::max(deepest, -gap);
        if (gap > reach) {
          point.impulse = 0;
          point.tangential.setZero();
          continue;
        }
        const Vec3 where = core - (point.at.radius + 0.5 * gap) * n;
        StepContact contact;
        contact.a = a.moves ? pair.a : -1;
        contact.b = pair.b;
        contact.normal = point.at.reference_is_a ? n : Vec3(-n);
        contact.arm_a = where - a.x;
        contact.arm_b = where - b.x;
        contact.velocity = b.v + b.w.cross(contact.arm_b) - a.v - a.w.cross(contact.arm_a);
        contact.gap = gap;
        contact.friction = pair.law.friction;
        contact.restitution = pair.law.restitution;
        contact.impulse = point.impulse;
        contact.tangential = point.tangential;
        contact.pair = near.pair;
        contact.point = static_cast<int>(i);
        contacts.push_back(contact);
      }
      if (deepest > depth && deepest > pair.depth + stepping::grown * depth)
        worst = std::max(worst, deepest);
      pair.depth = deepest;
      deepest_ = std::max(deepest_, deepest);
    }
  counts_.contacts += contacts.size();
  return worst;
}

void StepPairs::keep_impulses(std::span<const StepContact> contacts) {
  for (const StepContact& contact : contacts) {
    Point& point = pairs_[static_cast<std::size_t>(contact.pair)]
                       .points[static_cast<std::size_t>(contact.point)];
    point.impulse = contact.impulse;
    point.tangential = contact.tangential;
  }
}

// ---- taking back ----

void StepPairs::begin_log() {
  logged_ = 0;
  logging_ = true;
}

void StepPairs::take_back() {
  logging_ = false;
  while (logged_ > 0) {
    Logged& entry = log_[--logged_];
    Pair& pair = pairs_[static_cast<std::size_t>(entry.pair)];
    if (entry.touched) {
      std::swap(pair, entry.before);
    } else {
      pair.touches = false;
      pair.points.clear();
      pair.depth = 0;
    }
    for (Near& near : near_[static_cast<std::size_t>(pair.b)])
      if (near.pair == entry.pair) {
        near.axis.setZero();
        near.room = -1;
        near.live = pair.touches;
      }
  }
}

}  // namespace tw
