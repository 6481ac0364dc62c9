// What a new contact has of an old one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/match-contacts.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <span>

#include "base/constants.h"
#include "groups/ends/foreseen.h"
#include "math/near-in-x.h"

namespace tw {
namespace {

// What is left of a contact's offset where it opens: as much less as it does, so that what was
// pressed together by a load does not float when the load is gone.  Springs only lose by it.  By
// the time in which the body follows: it sinks no faster than the contact swings, and what a check
// finds open that long would be taken off again and again.
double released(const Regrouping& work, const Group& before, const GroupContact& was, double gap) {
  if (!(was.offset > 0)) return std::max(was.offset, std::min(unpressed(gap, was.law.size), 0.0));
  const double swing = 2 * pi * std::sqrt(was.law.gap_scale() / work.scene().gravity_scale());
  const double share = std::min(1.0, (work.now() - before.arc->start().time) / swing);
  return std::max(0.0, was.offset - share * std::max(0.0, gap));
}

// Where what overlaps is to be pushed apart an offset that holds it as it is goes to 0, by how much
// since the arc began.
double pushed(const Regrouping& work, const Group& before, const ContactConstants& law,
              double offset) {
  const Scene& scene = work.scene();
  if (!pushes(scene, offset)) return offset;
  const double way = push_speed(scene, law.size) * (work.now() - before.arc->start().time);
  return std::min(0.0, offset + std::min(way, answer::most_pushed * law.gap_scale()));
}

// How deep the contacts of the body are that it had before, at most, m.
double deepest_before(const Regrouping& work, const Body& body) {
  const Successor* successor = body.dynamic() ? work.successor_of(body.id()) : nullptr;
  if (!successor || !successor->data.group) return 0;
  const Group& group = *successor->data.group;
  double depth = 0;
  for (const std::uint32_t number : group.pairs_of(successor->data.member))
    each_contact(group.pairs[number], [&](std::uint32_t c) {
      depth = std::max(depth, -group.contact_at(c, work.now()).gap);
    });
  return depth;
}

// Where a contact was before, and whether a new one is that.
struct OldPoint {
  ContactForce followed;
  bool taken = false;
};

constexpr std::uint32_t unmatched = 0xffffffffu;
// Of each new contact of the pair at hand its old one.
thread_local std::vector<std::uint32_t> old_of;

// Fills `old_of`, the nearest first: where a point becomes two, that which is where it was is it,
// whichever is found first.
void match_nearest(const Group& before, const ContactPair& old, std::vector<OldPoint>& there,
                   std::span<const NewContact> fresh, double farthest) {
  struct Match {
    double distance;
    std::uint32_t fresh, old;
    auto operator<=>(const Match&) const = default;
  };
  thread_local std::vector<Match> matches;
  matches.clear();
  thread_local NearInX near;
  near.set(old.count, [&](std::uint32_t o) { return there[o].followed.point.x(); });
  for (std::uint32_t c = 0; c < fresh.size(); ++c)
    // by the feature, one twice as far off is as near
    near.visit(fresh[c].point.x(), 2 * farthest, [&](std::uint32_t o) {
      const ContactTag& tag = before.tags[old.first + o];
      double distance = (there[o].followed.point - fresh[c].point).norm();
      if (tag.feature == fresh[c].tag.feature && tag.parts == fresh[c].tag.parts) distance *= 0.5;
      if (distance < farthest) matches.push_back({distance, c, o});
    });
  std::sort(matches.begin(), matches.end());
  old_of.assign(fresh.size(), unmatched);
  for (const Match& match : matches) {
    if (there[match.old].taken || old_of[match.fresh] != unmatched) continue;
    there[match.old].taken = true;
    old_of[match.fresh] = match.old;
  }
}

// A point that comes to a face which bears a load already presses as those beside it do: their
// stiffness is shared with it, and so is the depth that they count from.  False: there is none.
bool take_offset(const Regrouping& work, const Group& before, const ContactPair& old,
                 const std::vector<OldPoint>& there, NewContact& fresh) {
  double nearest = never;
  for (std::uint32_t o = 0; o < old.count; ++o) {
    if (before.tags[old.first + o].parts != fresh.tag.parts) continue;
    const ContactForce& followed = there[o].followed;
    if (std::abs(followed.normal.dot(fresh.normal)) < answer::same_normal) continue;
    const double distance = (followed.point - fresh.point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    const GroupContact& was = before.arc->start().contacts[old.first + o];
    fresh.law_before = was.law;
    fresh.contact.offset = released(work, before, was, fresh.gap);
  }
  return nearest < never;
}

}  // namespace

Vec3 turned_into(const Vec3& stretch, const Vec3& normal) {
  const Vec3 flat = stretch - normal * normal.dot(stretch);
  const double length = flat.norm();
  return length > 0 ? Vec3(flat * (stretch.norm() / length)) : Vec3(Vec3::Zero());
}

void start_unpressed(const Regrouping& work, const Body& a, const Body& b, NewContact& c) {
  double allowed = answer::born_depth * c.contact.law.gap_scale();
  if (-c.gap <= allowed) return;
  allowed = std::max({allowed, deepest_before(work, a), deepest_before(work, b)});
  c.contact.offset = std::min(0.0, c.gap + allowed);
}

void take_ground_offset(const Regrouping& work, const Body& a, const Body& b, NewContact& fresh) {
  if (a.dynamic() == b.dynamic()) return;
  const Body& mover = a.dynamic() ? a : b;
  const Successor* successor = work.successor_of(mover.id());
  if (!successor || !successor->data.group) return;
  const Group& group = *successor->data.group;
  const auto from_ground = [&](const ContactTag& tag, const Vec3& normal) {
    return tag.other == mover.id() ? normal : Vec3(-normal);
  };
  constexpr double in_one_plane = 1 - 0.5 * answer::coplanar * answer::coplanar;
  const Vec3 up = from_ground(fresh.tag, fresh.normal);
  const std::vector<GroupContact>& contacts = group.arc->start().contacts;
  // mostly there is none to take
  if (std::all_of(contacts.begin(), contacts.end(), [](auto& was) { return was.offset == 0; }))
    return;
  double nearest = never;
  const GroupContact* stands_on = nullptr;
  for (const std::uint32_t number : group.pairs_of(successor->data.member)) {
    const ContactPair& pair = group.pairs[number];
    if (work.scene().body(pair.other(mover.id())).dynamic()) continue;
    each_contact(pair, [&](std::uint32_t c) {
      const GroupContact& was = contacts[c];
      const ContactForce followed = group.lone_contact_at(c, work.now());
      if (from_ground(group.tags[c], followed.normal).dot(up) < in_one_plane) return;
      const double distance = (followed.point - fresh.point).norm();
      if (distance >= nearest) return;
      nearest = distance;
      stands_on = &was;
    });
  }
  if (!stands_on || stands_on->offset == 0) return;
  fresh.law_before = stands_on->law;
  fresh.contact.offset = released(work, group, *stands_on, fresh.gap);
}

void match_old(const Regrouping& work, std::vector<NewContact>& contacts, const ContactPair& pair,
               const PairBefore& before_it) {
  const ContactPair* old = before_it.pair;
  const Group& before = *before_it.owner;
  const GroupArc& arc = *before.arc;
  const double now = before.contact_time(work.now());
  const Body& body_a = work.scene().body(pair.a());
  const Body& body_b = work.scene().body(pair.b());
  const double size = std::min(body_a.least_width, body_b.least_width);
  thread_local std::vector<OldPoint> there;
  there.clear();
  if (pair.count > 0)
    each_contact(*old, [&](std::uint32_t c) {
      there.push_back({arc.contact_force(static_cast<int>(c), now)});
    });
  match_nearest(before, *old, there, std::span(contacts).subspan(pair.first, pair.count),
                answer::same_point * size);
  for (std::uint32_t c = 0; c < pair.count; ++c) {
    NewContact& fresh = contacts[pair.first + c];
    const std::uint32_t best = old_of[c];
    if (best == unmatched) {
      start_unpressed(work, body_a, body_b, fresh);
      if (!take_offset(work, before, *old, there, fresh))
        take_ground_offset(work, body_a, body_b, fresh);
      continue;
    }
    const ContactTag& tag = before.tags[old->first + best];
    const GroupContact& was = arc.start().contacts[old->first + best];
    fresh.law_before = was.law;
    fresh.share_before = was.share;
    fresh.foreseen = is_foreseen(fresh, there[best].followed, tag.reference, size);
    fresh.contact.offset = pushed(work, before, was.law, released(work, before, was, fresh.gap));
    // of another side of the body
    if (std::abs(there[best].followed.normal.dot(fresh.normal)) < answer::same_normal)
      start_unpressed(work, body_a, body_b, fresh);
    const Quat attitude = work.attitude(tag.reference),
               fresh_attitude = work.attitude(fresh.tag.reference);
    const int number = static_cast<int>(old->first + best);
    Vec3 stretch = attitude * arc.stretch(number, now);
    if (tag.reference != fresh.tag.reference) stretch = -stretch;
    fresh.contact.stretch = fresh_attitude.conjugate() * turned_into(stretch, fresh.normal);

    // the bend across the normal as the stretch; that along it stays so, whose normal ever it is
    const ContactConstants& law = fresh.contact.law;
    if (!(law.rolling > 0 || law.spinning > 0)) continue;
    const Vec3 bend = attitude * arc.bend(number, now);
    const double along = bend.dot(there[best].followed.normal);
    Vec3 across = bend - along * there[best].followed.normal;
    if (tag.reference != fresh.tag.reference) across = -across;
    fresh.contact.bend =
        fresh_attitude.conjugate() * (turned_into(across, fresh.normal) + along * fresh.normal);
  }
}

}  // namespace tw
