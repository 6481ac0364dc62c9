// The end test.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/end-test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/parallel.h"
#include "groups/components.h"
#include "groups/ends/check-times.h"
#include "groups/ends/pair-on-arc.h"
#include "integrate/arc/joint-record.h"
#include "math/root.h"

namespace tw {
namespace {

// When the pair came to be deeper than its contacts know by more than is allowed; `never` if it did
// not.  What has sunk far into a valley is no longer found there: so the stretch is gone through in
// quarters.  Where it was more at `from` already, which nothing told until now, since the last time
// that it was known not to be.
double unseen_touch(const PairOnArc& pair, double known, double from, double to, double allowed) {
  const auto excess = [&](double t) { return pair.unseen_depth(t) - allowed; };
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

// When the contacts of a pair stop telling the truth: the arc is looked at at several instants, and
// where one tells of a lie, in between.
class PairTest {
 public:
  PairTest(const Scene& scene, const Surroundings& surroundings, const Group& group,
           const ContactPair& pair, double end)
      : surroundings_(surroundings),
        group_(group),
        pair_(pair),
        along_(scene, group, pair, end),
        allowed_(answer::unseen_depth * along_.scales.law.gap_scale()),
        phantom_(answer::phantom_depth * along_.scales.law.gap_scale()),
        start_(group.arc->start().time),
        end_(end) {}

  // `never`: they do not.
  ArcEnd end() {
    const double travel = along_.travel(), length = end_ - start_;
    if (travel <= allowed_) return {};
    gaps().assign(group_.gaps.begin() + pair_.first,
                  group_.gaps.begin() + pair_.first + pair_.count);
    const int count = looks(travel);
    searched_to_ = start_;
    double from = start_;
    for (int i = 1; i <= count; ++i) {
      const double to = i < count ? start_ + length * i / count : end_;
      const ArcEnd found = look(from, to);
      if (found.time < never) return found;
      from = to;
    }
    return {};
  }

 private:
  // What the contacts tell at an instant.
  struct Told {
    ArcEnd closed_fast;  // before
    double known = 0;    // the least gap, no more than 0, m
    double least = never;
    ContactForce nearest;  // of that gap
    bool nearest_from_a = false;
  };

  // The gaps at the last look.
  static std::vector<double>& gaps() {
    thread_local std::vector<double> scratch;
    return scratch;
  }

  // Where checks are rarer than motion asks for, as often as they would be.
  int looks(double travel) const {
    const double unlooked =
        group_.doublings > 0 ? 2 * answer::most_travel : answer::travel_unlooked;
    return static_cast<int>(std::clamp(std::ceil(travel / (unlooked * along_.size())),
                                       along_.runs() ? answer::running_looks : 1.0,
                                       static_cast<double>(answer::most_looks)));
  }

  Told told(double from, double to) const {
    Told told;
    each_contact(pair_, [&](std::uint32_t c) {
      const int contact = static_cast<int>(c);
      const ContactForce there = group_.arc->contact_force(contact, to);
      const double last = there.gap;
      const double first = std::exchange(gaps()[c - pair_.first], last);
      told.known = std::min(told.known, last);
      if (last < told.least) {
        told.least = last;
        told.nearest = there;
        told.nearest_from_a = group_.tags[c].reference == pair_.a();
      }
      if (first > 0 && last < 0)
        told.closed_fast = earlier(
            told.closed_fast,
            {fast_touch(*group_.arc, contact, from, to, first, last, along_.scales.borne_speed),
             EndReason::fast});
    });
    return told;
  }

  ArcEnd look(double from, double to) {
    const Told at_end = told(from, to);
    ArcEnd end = at_end.closed_fast;
    double known = at_end.known;
    // most pairs are as deep as their contacts know, and one look along a normal says so
    const bool may_be_phantom = -known > phantom_;
    if (end.time == never && !may_be_phantom && at_end.least < never &&
        along_.is_no_deeper(allowed_ - known, at_end.nearest, at_end.nearest_from_a, to))
      return {};
    double deepest = along_.deepest(to, false), seen_to = to;
    if (answer::phantom_share * deepest - known > phantom_)
      end = earlier(end, {phantom_touch(along_, from, to, phantom_), EndReason::phantom});
    // only what comes before that end counts, and a phantom may hide it
    if (end.time < to) {
      seen_to = end.time;
      known = std::min(along_.represented(seen_to), 0.0);
      deepest = along_.deepest(seen_to, false);
    }
    if (known - deepest > allowed_) {
      along_.look_around(surroundings_, from, to);
      // what nobody saw when the arc began must not grow either
      if (unseen_before_ < 0) unseen_before_ = std::max(along_.unseen_depth(start_), 0.0);
      end = earlier(end,
                    {unseen_touch(along_, searched_to_, from, seen_to, unseen_before_ + allowed_),
                     EndReason::unseen});
      searched_to_ = seen_to;
    }
    return end;
  }

  const Surroundings& surroundings_;
  const Group& group_;
  const ContactPair& pair_;
  PairOnArc along_;
  const double allowed_, phantom_;  // m: how much deeper than is known, or less deep, it may be
  const double start_, end_;        // s
  double unseen_before_ = -1;       // m, when the arc began; < 0: not looked for
  double searched_to_ = 0;          // until then no contact was unseen
};

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

// What is joined ends together: links of one multibody, and both ends of a spring or a hold.
void end_together(const GroupStart& start, std::vector<ArcEnd>& ends) {
  if (start.trees.empty() && start.bonds.empty()) return;
  Components together(ends.size());
  const auto place = [](int member) { return static_cast<std::size_t>(member); };
  for (const GroupTree& tree : start.trees)
    for (const int member : tree.members) together.join(place(tree.members.front()), place(member));
  for (const GroupBond& bond : start.bonds) together.join(place(bond.a), place(bond.b));
  // roots come first
  for (std::size_t i = 0; i < ends.size(); ++i) {
    ArcEnd& first = ends[together.root(i)];
    first = earlier(first, ends[i]);
  }
  for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = ends[together.root(i)];
}

// Where the arc of each member ends; `whole`: where those of all do that nothing is found of.
std::vector<ArcEnd> find_ends(const Scene& scene, const Surroundings& surroundings,
                              const Group& group, const ArcEnd& whole) {
  constexpr std::size_t grain = 4;
  std::vector<ArcEnd> pair_ends(group.pairs.size());
  each_in_parallel(pair_ends.size(), grain, [&](std::size_t i) {
    pair_ends[i] = PairTest(scene, surroundings, group, group.pairs[i], whole.time).end();
  });
  std::vector<ArcEnd> ends(group.members.size(), whole);
  const std::vector<GroupTree>& trees = group.arc->start().trees;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    ArcEnd& end = ends[static_cast<std::size_t>(trees[t].members.front())];
    end = earlier(end, {stop_time(*group.arc, static_cast<int>(t)), EndReason::stop});
  }
  const double least = group.arc->start().time + least_arc(scene, group.members);
  for (std::size_t i = 0; i < pair_ends.size(); ++i) {
    if (!(pair_ends[i].time < whole.time)) continue;
    const ArcEnd found{std::max(pair_ends[i].time, least), pair_ends[i].reason};
    for (const BodyId side : {group.pairs[i].a(), group.pairs[i].b()}) {
      const int member = group.member_of(scene.process_of(side));
      if (member < 0) continue;
      ArcEnd& end = ends[static_cast<std::size_t>(member)];
      end = earlier(end, found);
    }
  }
  end_together(group.arc->start(), ends);
  return ends;
}

void note_effort(const Group& group, GroupCounters& counters) {
  const GroupCounts effort = group.arc->counts();
  if (effort.steps + effort.rejected > counters.dearest_arc.tried())
    counters.dearest_arc = {effort.steps, effort.rejected, group.arc->start().time, group.members};
  GroupEffort arc{group.members,           group.tags.size(),  1, effort.steps, effort.rejected,
                  group.arc->start().time, group.next_check(), {}};
  arc.ends.note(group.end().reason);
  counters.dearest_groups.note(arc);
}

}  // namespace

void test_end(const Scene& scene, const Surroundings& surroundings, Group& group,
              GroupCounters& counters) {
  if (group.found || group.at_rest) return;
  group.arc->extend_patiently(group.planned.time);
  const ArcEnd whole = earlier(group.planned, {group.arc->last(), EndReason::steps});
  std::vector<ArcEnd> ends = find_ends(scene, surroundings, group, whole);
  const ArcEnd first = *std::min_element(
      ends.begin(), ends.end(), [](const ArcEnd& x, const ArcEnd& y) { return x.time < y.time; });
  // (what was given up by then finds nothing done)
  group.found = whole;
  if (first.time < whole.time) {
    ++counters.early_ends;
    if (group.members.size() < answer::least_divided) {
      group.found = first;
      ends.assign(ends.size(), first);
    }
    group.arc->lower_ends(std::move(ends));
  }
  note_effort(group, counters);
}

}  // namespace tw
