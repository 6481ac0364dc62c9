// Who is squeezed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/told/squeezed.h"

#include <algorithm>
#include <span>

#include "base/constants.h"
#include "dynamics/point-law.h"

namespace tw {
namespace {

// One contact as the body sees it that it pushes.
struct Push {
  BodyId body = 0, by = 0;
  Vec3 normal = Vec3::Zero();  // into the body, unit, world
  Vec3 force = Vec3::Zero();   // on it, world, N
  Vec3 point = Vec3::Zero();
  double depth = 0;  // m
  double share = 0;  // of the thinner one's thickness
  // Whether it presses deeper than a contact's limit, and the body is the one that is told of.
  bool overloaded = false;
};

// Of its springs, on the other body, N.  A body in a corner with friction is held by forces that
// are opposite where the normals are not.
Vec3 spring_force_of(const NewContact& c, const Quat& reference) {
  const GroupContact& contact = c.contact;
  const ContactConstants& law = c.law_before ? *c.law_before : contact.law;
  PointMotion at;
  at.normal = c.normal;
  at.depth = contact.offset - c.gap;
  at.stretch = reference * contact.stretch;
  return point_force(law, contact.share, at).force(c.normal);
}

// The cosine of the angle between them; 0 where there is no force.
double cosine(const Push& x, const Push& y) {
  const double sizes = x.force.norm() * y.force.norm();
  return sizes > 0 ? x.force.dot(y.force) / sizes : 0;
}

// Two that push a body against each other.
struct Squeeze {
  const Push *one = nullptr, *two = nullptr;

  explicit operator bool() const { return one; }
  double depth() const { return std::max(one->depth, two->depth); }
  double share() const { return std::max(one->share, two->share); }
};

// Of all successors with new arcs, by body; none where no contact is deep enough.
class Pushes {
 public:
  Pushes(const Regrouping& work, const Contacts& contacts) : work_(work) {
    if (std::none_of(contacts.all.begin(), contacts.all.end(), is_deep)) return;
    for (const ContactPair& pair : contacts.pairs)
      each_contact(pair, [&](std::uint32_t c) {
        const NewContact& contact = contacts.all[c];
        if (!(contact.gap < 0)) return;
        const ContactTag& tag = contact.tag;
        const Vec3 force = spring_force_of(contact, work.attitude(tag.reference));
        const double depth = -contact.gap, share = share_of(contact);
        const bool over = is_overloaded(contact), other = is_thinner(tag.other, tag.reference);
        add({tag.other, tag.reference, contact.normal, force, contact.point, depth, share,
             over && other});
        add({tag.reference, tag.other, -contact.normal, -force, contact.point, depth, share,
             over && !other});
      });
    std::stable_sort(all_.begin(), all_.end(),
                     [](const Push& x, const Push& y) { return x.body < y.body; });
  }
  bool empty() const { return all_.empty(); }
  std::span<const Push> on(BodyId body) const {
    const auto [first, last] =
        std::equal_range(all_.begin(), all_.end(), Push{body},
                         [](const Push& x, const Push& y) { return x.body < y.body; });
    return {first, last};
  }
  // What presses it beyond the limit of a contact, by forces that no contact makes or by what gives
  // way: twice the same, the deepest.
  Squeeze overload(BodyId body, double least) const {
    Squeeze deepest;
    for (const Push& push : on(body))
      if (push.overloaded && push.share >= least && (!deepest || push.share > deepest.share()))
        deepest = {&push, &push};
    return deepest;
  }
  // The two that push it against each other, one by as great a share as `least` and `held` on both
  // sides: those with the greatest.
  Squeeze squeeze(BodyId body, double least, bool held) const {
    const std::span<const Push> pushes = on(body);
    Squeeze deepest;
    for (std::size_t i = 0; i < pushes.size(); ++i)
      for (std::size_t j = i + 1; j < pushes.size(); ++j) {
        const Squeeze found{&pushes[i], &pushes[j]};
        if (found.share() < least || !oppose(pushes[i], pushes[j])) continue;
        if (deepest && found.share() <= deepest.share()) continue;
        if (held && !(is_held(pushes[i]) && is_held(pushes[j]))) continue;
        deepest = found;
      }
    return deepest;
  }

 private:
  static double share_of(const NewContact& c) { return -c.gap / c.contact.law.size; }
  // Whether it could keep a body squeezed.
  static bool is_deep(const NewContact& c) { return share_of(c) >= 0.5 * answer::squeezed_share; }
  static bool is_overloaded(const NewContact& c) {
    const ContactConstants& law = c.law_before ? *c.law_before : c.contact.law;
    return c.contact.offset - c.gap > law.firm.limit;
  }
  // Of two in contact one gives way: the one that moves, or the thinner one.
  bool is_thinner(BodyId one, BodyId other) const {
    const Body &a = work_.scene().body(one), &b = work_.scene().body(other);
    if (!a.dynamic() || !b.dynamic()) return a.dynamic();
    return a.thickness < b.thickness || (a.thickness == b.thickness && a.mass < b.mass);
  }
  // Of all forces on the body within 60 degrees of this one, N.
  double side(const Push& push) const {
    Vec3 sum = Vec3::Zero();
    for (const Push& beside : on(push.body))
      if (cosine(push, beside) > 0.5) sum += beside.force;
    return sum.norm();
  }
  // More than 120 degrees apart, and neither side is small beside the other, however many points it
  // has.
  bool oppose(const Push& x, const Push& y) const {
    if (!(cosine(x, y) < -0.5)) return false;
    const double one = side(x), two = side(y);
    return std::min(one, two) >= answer::squeezed_force_share * std::max(one, two);
  }
  void add(const Push& push) {
    if (work_.changes(push.body)) all_.push_back(push);
  }
  // Whether who pushes does not give way, seen from the body that is pushed.
  bool is_held(const Push& push) const {
    std::vector<BodyId> seen{push.body};
    std::vector<const Push*> open{&push};
    while (!open.empty()) {
      const Push& last = *open.back();
      open.pop_back();
      if (!work_.scene().body(last.by).dynamic()) return true;
      if (std::find(seen.begin(), seen.end(), last.by) != seen.end()) continue;
      seen.push_back(last.by);
      for (const Push& behind : on(last.by))
        if (cosine(behind, last) > 0.5) open.push_back(&behind);
    }
    return false;
  }

  const Regrouping& work_;
  std::vector<Push> all_;
};

Collision report_of(const Regrouping& work, const Squeeze& squeeze) {
  const Push& deeper = *(squeeze.one->share >= squeeze.two->share ? squeeze.one : squeeze.two);
  const Push& first = *(squeeze.one->by <= squeeze.two->by ? squeeze.one : squeeze.two);
  const Push& second = *(&first == squeeze.one ? squeeze.two : squeeze.one);
  Collision row;
  row.kind = CollisionKind::squeezed;
  row.key = work.key();
  row.time = work.now();
  row.body1 = first.by;
  row.body2 = second.by;
  row.point = deeper.point;
  row.normal = first.normal;
  row.squeezed = deeper.body;
  row.depth = deeper.depth;
  row.depth_share = deeper.share;
  return row;
}

}  // namespace

Told note_squeezed(const Regrouping& work, const Contacts& contacts) {
  Told told;
  const Pushes pushes(work, contacts);
  for (Successor& successor : work.successors) {
    if (!work.changes(&successor) || !successor.body->dynamic()) continue;
    double& since = successor.data.squeezed_since;
    const bool before = since < never;
    if (!before && pushes.empty()) continue;
    const Body& body = *successor.body;
    const double least = before ? 0.5 * answer::squeezed_share : answer::squeezed_share;
    Squeeze squeeze = pushes.squeeze(body.id(), least, !before);
    if (!squeeze && !pushes.squeeze(body.id(), 0, true))
      squeeze = pushes.overload(body.id(), before ? 0 : answer::firm_share);
    if (!squeeze) {
      since = never;
      continue;
    }
    told.tally.note_squeezed(squeeze.depth(), squeeze.share());
    if (before) continue;
    since = work.now();
    ++told.tally.squeezed;
    told.report.push_back(report_of(work, squeeze));
  }
  return told;
}

}  // namespace tw
