// A pair of bodies in contact along the arc of its group.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/pair-on-arc.h"

#include <algorithm>

#include "base/error.h"
#include "collision/distance/overlap-along.h"
#include "dynamics/placed-body.h"

namespace tw {

const Trajectory& PairOnArc::trajectory(const Body& body) const {
  if (const int member = group_.member_of(body.process); member >= 0)
    return group_.arc->trajectory(member);
  const auto at = std::find(group_.outside.begin(), group_.outside.end(), body.id());
  TW_ASSERT(at != group_.outside.end(),
            body.info.name + " is in contact and neither member nor outside");
  return *group_.arc->start().outside[static_cast<std::size_t>(at - group_.outside.begin())];
}

void PairOnArc::look_around(const Surroundings& surroundings, double from, double to) {
  if (!a.fixed() && !b.fixed()) return;
  const Body& mover = a.dynamic() ? a : b;
  const Trajectory& path = trajectory(mover);
  ground_ = PairGround(surroundings, a, b,
                       surroundings.ground_around(mover, {path.frame(from), path.frame(to)}));
}

double PairOnArc::deepest(double when, bool at_seams) const {
  thread_local std::vector<ManifoldPoint> points;
  points.clear();
  const Frame frame_a = trajectory(a).frame(when), frame_b = trajectory(b).frame(when);
  if (!at_seams) {
    manifold(*a.shape_P, frame_a, *b.shape_P, frame_b, 0, points);
  } else {
    std::vector<StandingPlane> planes;
    if (a.dynamic() != b.dynamic())
      planes = standing_planes(scene_, group_, a.dynamic() ? a : b, when);
    pair_manifold({a, frame_a, b, frame_b}, ground_, planes, 0, points);
  }
  double least = 0;
  for (const ManifoldPoint& p : points) least = std::min(least, p.gap);
  return least;
}

bool PairOnArc::is_no_deeper(double depth, const ContactForce& contact, bool reference_is_a,
                             double when) const {
  const Vec3 normal = reference_is_a ? contact.normal : Vec3(-contact.normal);
  return overlap_along(normal, *a.shape_P, trajectory(a).frame(when), *b.shape_P,
                       trajectory(b).frame(when)) <= depth;
}

double PairOnArc::represented(double when) const {
  double least = never;
  each_contact(pair_, [&](std::uint32_t c) {
    least = std::min(least, group_.arc->contact_force(static_cast<int>(c), when).gap);
  });
  return least;
}

bool PairOnArc::runs() const {
  bool any = false;
  each_contact(pair_, [&](std::uint32_t c) {
    const ContactFeature feature = group_.arc->start().contacts[c].feature;
    any = any || feature == ContactFeature::crossing || feature == ContactFeature::rim;
  });
  return any;
}

double PairOnArc::travel() const {
  double sum = 0;
  const double from = group_.arc->start().time, to = end_;
  for (const Body* body : {&a, &b}) {
    if (body->fixed()) continue;
    const MotionBounds bounds = trajectory(*body).bounds(from, to);
    sum += bounds.path.size().norm();
    // a plane that moves does not turn, and has no radius
    if (bounds.turn > 0) sum += (to - from) * turning_speed(*body, from, to, bounds.turn);
  }
  return sum;
}

// How fast surface points move against the centre, m/s.  Bounds know no axes: what is slender is
// asked at three times, and may be twice as fast in between.
double PairOnArc::turning_speed(const Body& body, double from, double to, double turn) const {
  const double bound = turn * body.radius;
  if (body.slender_axis < 0) return bound;
  double most = 0;
  for (const double when : {from, 0.5 * (from + to), to})
    most = std::max(most, PlacedBody(body, trajectory(body).path_at(when)).turning_speed());
  return std::min(bound, 2 * most);
}

}  // namespace tw
