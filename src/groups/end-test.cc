// The end test.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/end-test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/parallel.h"
#include "collision/overlap-along.h"
#include "collision/seams/seams.h"
#include "groups/check-times.h"
#include "groups/components.h"
#include "groups/flush-ground.h"
#include "integrate/joint-record.h"
#include "math/root.h"

namespace tw {
namespace {

// A pair of bodies whose contacts do not tell the truth beyond this time, s.
struct EarlyEnd {
  double time = 0;
  std::uint64_t pair = 0;
};

// A pair of bodies along the arc.
struct PairOnArc {
  const Scene& scene;
  Group& group;
  const ContactPair& pair;
  const Body& a;
  const Body& b;
  std::vector<SeamNeighbour> around_a, around_b;  // of the one that is ground

  const Trajectory& trajectory(const Body& body) const {
    if (const int member = group.member_of(body.process); member >= 0)
      return group.arc->trajectory(member);
    const auto at = std::find(group.outside.begin(), group.outside.end(), body.id());
    TW_ASSERT(at != group.outside.end(),
              body.info.name + " is in contact and neither member nor outside");
    return *group.arc->start().outside[static_cast<std::size_t>(at - group.outside.begin())];
  }
  // The depth of the deepest point, m, as a negative gap; 0: none.  `at_seams`: ghosts left out.
  double deepest(double when, bool at_seams) const {
    thread_local std::vector<ManifoldPoint> points;
    points.clear();
    const double size = std::min(a.least_width, b.least_width);
    const Frame frame_a = trajectory(a).frame(when), frame_b = trajectory(b).frame(when);
    if (at_seams)
      manifold_at_seams(*a.shape_P, frame_a, around_a, *b.shape_P, frame_b, around_b, 0, size,
                        points);
    else
      manifold(*a.shape_P, frame_a, *b.shape_P, frame_b, 0, points);
    if (at_seams && a.dynamic() != b.dynamic())
      drop_low_sides(standing_planes(scene, group, a.dynamic() ? a : b, when), a, frame_a, b,
                     frame_b, points);
    double least = 0;
    for (const ManifoldPoint& p : points) least = std::min(least, p.gap);
    return least;
  }
  // Whether it is surely no deeper than `depth`, m, as it overlaps no more along a contact's
  // normal.
  bool is_no_deeper(double depth, const ContactForce& contact, bool reference_is_a,
                    double when) const {
    const Vec3 normal = reference_is_a ? contact.normal : Vec3(-contact.normal);
    return overlap_along(normal, *a.shape_P, trajectory(a).frame(when), *b.shape_P,
                         trajectory(b).frame(when)) <= depth;
  }
  // The least gap that its contacts know of
  double represented(double when) const {
    double least = never;
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
      least = std::min(least, group.arc->contact_force(static_cast<int>(c), when).gap);
    return least;
  }
  // Whether a contact's point runs along a line or a rim: it may be elsewhere soon, and back again.
  bool runs() const {
    const std::vector<GroupContact>& contacts = group.arc->start().contacts;
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
      if (contacts[c].feature == ContactFeature::crossing ||
          contacts[c].feature == ContactFeature::rim)
        return true;
    return false;
  }
  // How far any surface point may have moved, m.
  double travel() const {
    double sum = 0;
    const double from = group.arc->start().time, to = group.next_check;
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
  double turning_speed(const Body& body, double from, double to, double turn) const {
    const double bound = turn * body.radius;
    if (body.slender_axis < 0) return bound;
    double most = 0;
    for (const double when : {from, 0.5 * (from + to), to})
      most = std::max(most, PlacedBody(body, trajectory(body).path_at(when)).turning_speed());
    return std::min(bound, 2 * most);
  }
};

// How much deeper the pair is than its contacts know, m.
double unseen_depth(const PairOnArc& pair, double when) {
  return std::min(pair.represented(when), 0.0) - pair.deepest(when, true);
}

// When that came to be more than is allowed; `never` if it did not.  What has sunk far into a
// valley is no longer found there: so the stretch is gone through in quarters.  Where it was more
// at `from` already, which nothing told until now, since the last time that it was known not to be.
double unseen_touch(const PairOnArc& pair, double known, double from, double to, double allowed) {
  const auto excess = [&](double t) { return unseen_depth(pair, t) - allowed; };
  const double fine = answer::end_resolution * allowed;
  constexpr int quarters = 4;
  double begin = from, first = excess(from);
  if (first >= 0) return known < from ? unseen_touch(pair, known, known, from, allowed) : never;
  for (int i = 1; i <= quarters; ++i) {
    const double end = i < quarters ? from + (to - from) * i / quarters : to;
    const double last = excess(end);
    if (last > 0) return find_root(excess, begin, end, first, last, fine).left;
    begin = end;
    first = last;
  }
  return never;
}

// When the contacts of the pair came to claim a depth that is not there, which went on to `to`. The
// point of a rim, or of two lines that cross, runs away where they come to be parallel, and a ball
// that stands for a rim knows nothing of where the face under it ends.
double phantom_touch(const PairOnArc& pair, double from, double to, double allowed) {
  const auto excess = [&](double t) {
    return answer::phantom_share * pair.deepest(t, false) - pair.represented(t) - allowed;
  };
  const double first = excess(from), last = excess(to);
  if (first >= 0 || last <= 0) return never;
  return find_root(excess, from, to, first, last, answer::end_resolution * allowed).left;
}

// When a contact whose gap goes from `first` > 0 to `last` < 0 closes, if faster than `slow`; else
// `never`.
double fast_touch(const GroupArc& arc, int contact, double from, double to, double first,
                  double last, double slow) {
  const auto gap = [&](double t) { return arc.contact_force(contact, t).gap; };
  const double when = find_root(gap, from, to, first, last).left;
  const ContactForce f = arc.contact_force(contact, when);
  return -f.velocity.dot(f.normal) > slow ? when : never;
}

// When the contacts of a pair stop telling the truth; the next check if they do not.
double early_end(const Scene& scene, const Surroundings& surroundings, Group& group,
                 const ContactPair& pair) {
  const Body &a = scene.body(pair.a()), &b = scene.body(pair.b());
  PairOnArc along{scene, group, pair, a, b, {}, {}};
  const ContactScales scales = contact_scales(scene, a, b, pair.masses);
  const double allowed = answer::unseen_depth * scales.law.gap_scale();
  const double phantom = answer::phantom_depth * scales.law.gap_scale();
  const double travel = along.travel(), size = std::min(a.least_width, b.least_width);
  if (travel <= allowed) return group.next_check;

  const double start = group.arc->start().time, length = group.next_check - start;
  // where checks are rarer than motion asks for, as often as they would be
  const double unlooked = group.doublings > 0 ? 2 * answer::most_travel : answer::travel_unlooked;
  const int looks = static_cast<int>(std::clamp(std::ceil(travel / (unlooked * size)),
                                                along.runs() ? answer::running_looks : 1.0,
                                                static_cast<double>(answer::most_looks)));
  thread_local std::vector<double> gaps;  // at the last look
  gaps.assign(group.gaps.begin() + pair.first, group.gaps.begin() + pair.first + pair.count);
  double from = start, unseen_before = -1, searched_to = start;
  for (int i = 1; i <= looks; ++i) {
    const double to = i < looks ? start + length * i / looks : group.next_check;
    double end = never, known = 0, least = never;
    ContactForce nearest;
    bool nearest_from_a = false;
    each_contact(pair, [&](std::uint32_t c) {
      const int contact = static_cast<int>(c);
      const ContactForce there = group.arc->contact_force(contact, to);
      const double last = there.gap;
      const double first = std::exchange(gaps[c - pair.first], last);
      known = std::min(known, last);
      if (last < least) {
        least = last;
        nearest = there;
        nearest_from_a = group.tags[c].reference == pair.a();
      }
      if (first > 0 && last < 0)
        end = std::min(end,
                       fast_touch(*group.arc, contact, from, to, first, last, scales.borne_speed));
    });
    // most pairs are as deep as their contacts know, and one look along a normal says so
    const bool may_be_phantom = -known > phantom;
    if (end == never && !may_be_phantom && least < never &&
        along.is_no_deeper(allowed - known, nearest, nearest_from_a, to)) {
      from = to;
      continue;
    }
    double deepest = along.deepest(to, false), seen_to = to;
    if (answer::phantom_share * deepest - known > phantom)
      end = std::min(end, phantom_touch(along, from, to, phantom));
    // only what comes before that end counts, and a phantom may hide it
    if (end < to) {
      seen_to = end;
      known = std::min(along.represented(end), 0.0);
      deepest = along.deepest(end, false);
    }
    if (known - deepest > allowed) {
      if (a.fixed() || b.fixed()) {
        const Body& mover = a.dynamic() ? a : b;
        const Trajectory& path = along.trajectory(mover);
        const NearGround ground =
            surroundings.ground_around(mover, {path.frame(from), path.frame(to)});
        along.around_a = surroundings.seam_neighbours(a, ground);
        along.around_b = surroundings.seam_neighbours(b, ground);
      }
      // what nobody saw when the arc began must not grow either
      if (unseen_before < 0) unseen_before = std::max(unseen_depth(along, start), 0.0);
      end = std::min(end, unseen_touch(along, searched_to, from, seen_to, unseen_before + allowed));
      searched_to = seen_to;
    }
    if (end < never) return std::min(end, group.next_check);
    from = to;
  }
  return group.next_check;
}

// When a joint of the multibody gets to one of its stops that it does not lean on; `never`: none
// does.
double stop_time(const GroupArc& arc, int number) {
  const GroupTree& tree = arc.start().trees[static_cast<std::size_t>(number)];
  const auto& axes = tree.multibody->tree.axes();
  const JointRecord& record = arc.joints_record(number);
  double first = never;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto look = [&](multibody::Stop stop, double side, double limit) {
      const bool leans = !tree.state->stops.empty() && tree.state->stops[i] == stop;
      if (!leans && std::isfinite(limit))
        first = std::min(first, record.first_beyond(axes[i], side, limit));
    };
    look(multibody::Stop::lower, 1, axes[i].law.lower);
    look(multibody::Stop::upper, -1, axes[i].law.upper);
  }
  return first;
}

void end_at_stops(Group& group, std::vector<double>& ends) {
  const std::vector<GroupTree>& trees = group.arc->start().trees;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    double& first = ends[static_cast<std::size_t>(trees[t].members.front())];
    first = std::min(first, stop_time(*group.arc, static_cast<int>(t)));
  }
}

// What is joined ends together: links of one multibody, and both ends of a spring or a hold.
void end_together(const GroupStart& start, std::vector<double>& ends) {
  if (start.trees.empty() && start.bonds.empty()) return;
  Components together(ends.size());
  const auto place = [](int member) { return static_cast<std::size_t>(member); };
  for (const GroupTree& tree : start.trees)
    for (const int member : tree.members) together.join(place(tree.members.front()), place(member));
  for (const GroupBond& bond : start.bonds) together.join(place(bond.a), place(bond.b));
  // roots come first
  for (std::size_t i = 0; i < ends.size(); ++i) {
    double& first = ends[together.root(i)];
    first = std::min(first, ends[i]);
  }
  for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = ends[together.root(i)];
}

}  // namespace

void test_end(const Scene& scene, const Surroundings& surroundings, Group& group,
              GroupCounters& counters) {
  if (group.end_tested || group.at_rest) return;
  group.arc->extend_patiently(group.next_check);
  group.next_check = std::min(group.next_check, group.arc->last());
  group.end_tested = true;
  const GroupCounts effort = group.arc->counts();
  if (effort.steps + effort.rejected > counters.dearest_arc.tried())
    counters.dearest_arc = {effort.steps, effort.rejected, group.arc->start().time, group.members};
  counters.dearest_groups.note({group.members, group.tags.size(), 1, effort.steps, effort.rejected,
                                group.arc->start().time, group.next_check});
  constexpr std::size_t grain = 4;
  std::vector<double> pair_ends(group.pairs.size());
  each_in_parallel(pair_ends.size(), grain, [&](std::size_t i) {
    pair_ends[i] = early_end(scene, surroundings, group, group.pairs[i]);
  });
  std::vector<EarlyEnd> early_ends;
  for (std::size_t i = 0; i < pair_ends.size(); ++i)
    if (pair_ends[i] < group.next_check) early_ends.push_back({pair_ends[i], group.pairs[i].id});
  std::vector<double> at_stops(group.members.size(), group.next_check);
  end_at_stops(group, at_stops);
  const double first_stop = *std::min_element(at_stops.begin(), at_stops.end());
  if (early_ends.empty() && !(first_stop < group.next_check)) return;
  ++counters.early_ends;

  const double least =
      std::min(group.next_check, group.arc->start().time + least_arc(scene, group.members));
  for (EarlyEnd& early : early_ends) early.time = std::max(early.time, least);
  if (group.members.size() < answer::least_divided) {
    group.next_check = std::min(group.next_check, first_stop);
    for (const EarlyEnd& early : early_ends)
      group.next_check = std::min(group.next_check, early.time);
    group.arc->lower_ends(std::vector<double>(group.members.size(), group.next_check));
    return;
  }
  std::vector<double> ends = at_stops;
  for (const EarlyEnd& early : early_ends)
    for (const BodyId side : {first_of(early.pair), second_of(early.pair)}) {
      const int member = group.member_of(scene.process_of(side));
      if (member < 0) continue;
      double& end = ends[static_cast<std::size_t>(member)];
      end = std::min(end, early.time);
    }
  end_together(group.arc->start(), ends);
  group.arc->lower_ends(std::move(ends));
}

}  // namespace tw
