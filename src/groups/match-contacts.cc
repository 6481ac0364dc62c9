// What a new contact has of an old one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/match-contacts.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <span>

#include "base/constants.h"
#include "groups/foreseen.h"

namespace tw {
namespace {

// What is left of a contact's offset where it opens: as much less as it does, so that what was
// pressed together by a load does not float when the load is gone.  Springs only lose by it.
double released(double offset, double gap) {
  return offset > 0 ? std::max(0.0, offset - std::max(0.0, gap))
                    : std::max(offset, std::min(gap, 0.0));
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
  for (std::uint32_t c = 0; c < fresh.size(); ++c)
    for (std::uint32_t o = 0; o < old.count; ++o) {
      const ContactTag& tag = before.tags[old.first + o];
      double distance = (there[o].followed.point - fresh[c].point).norm();
      if (tag.feature == fresh[c].tag.feature && tag.parts == fresh[c].tag.parts) distance *= 0.5;
      if (distance < farthest) matches.push_back({distance, c, o});
    }
  std::sort(matches.begin(), matches.end());
  old_of.assign(fresh.size(), unmatched);
  for (const Match& match : matches) {
    if (there[match.old].taken || old_of[match.fresh] != unmatched) continue;
    there[match.old].taken = true;
    old_of[match.fresh] = match.old;
  }
}

// A point that comes to a face which bears a load already presses as those beside it do: their
// stiffness is shared with it, and so is the depth that they count from.
void take_offset(const Group& before, const ContactPair& old, const std::vector<OldPoint>& there,
                 NewContact& fresh) {
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
    fresh.contact.offset = released(was.offset, fresh.gap);
  }
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
      take_offset(before, *old, there, fresh);
      continue;
    }
    const ContactTag& tag = before.tags[old->first + best];
    const GroupContact& was = arc.start().contacts[old->first + best];
    fresh.law_before = was.law;
    fresh.share_before = was.share;
    fresh.foreseen = is_foreseen(fresh, there[best].followed, tag.reference, size);
    fresh.contact.offset = released(was.offset, fresh.gap);
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
