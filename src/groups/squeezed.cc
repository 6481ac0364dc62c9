// Who is squeezed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/squeezed.h"

#include <algorithm>
#include <span>

#include "base/constants.h"

namespace tw {
namespace {

// One contact as the body sees it that it pushes.
struct Push {
  BodyId body = 0, by = 0;
  Vec3 along = Vec3::Zero();  // unit, world: the force on the body
  Vec3 point = Vec3::Zero();
  double depth = 0;  // m
};

bool opposes(const Push& x, const Push& y) { return x.along.dot(y.along) < -0.5; }

// Two that push a body against each other.
struct Squeeze {
  const Push *one = nullptr, *two = nullptr;

  explicit operator bool() const { return one; }
  double depth() const { return std::max(one->depth, two->depth); }
  double both_depth() const { return std::min(one->depth, two->depth); }
};

// Of all successors with new arcs, those that could keep somebody squeezed; by body.
class Pushes {
 public:
  explicit Pushes(const Regrouping& work) : work_(work) {
    for (const ContactPair& pair : work.pairs)
      each_contact(pair, [&](std::uint32_t c) {
        const NewContact& contact = work.contacts[c];
        if (!(contact.gap < 0)) return;
        const ContactTag& tag = contact.tag;
        add({tag.other, tag.reference, contact.normal, contact.point, -contact.gap});
        add({tag.reference, tag.other, -contact.normal, contact.point, -contact.gap});
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
  // The deepest two, each as deep as `least`, that push it against each other, `held` on both
  // sides.
  Squeeze squeeze(BodyId body, double least, bool held) const {
    const std::span<const Push> pushes = on(body);
    Squeeze deepest;
    for (std::size_t i = 0; i < pushes.size(); ++i)
      for (std::size_t j = i + 1; j < pushes.size(); ++j) {
        const Squeeze found{&pushes[i], &pushes[j]};
        if (found.both_depth() < least || !opposes(pushes[i], pushes[j])) continue;
        if (deepest && found.both_depth() <= deepest.both_depth()) continue;
        if (held && !(is_held(pushes[i]) && is_held(pushes[j]))) continue;
        deepest = found;
      }
    return deepest;
  }

 private:
  double width(BodyId body) const { return work_.scene().body(body).least_width; }
  void add(const Push& push) {
    if (!work_.changes(push.body)) return;
    if (push.depth >= 0.5 * answer::squeezed_share * width(push.body)) all_.push_back(push);
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
        if (behind.along.dot(last.along) > 0.5) open.push_back(&behind);
    }
    return false;
  }

  const Regrouping& work_;
  std::vector<Push> all_;
};

Collision report_of(const Regrouping& work, const Squeeze& squeeze) {
  const Push& deeper = *(squeeze.one->depth >= squeeze.two->depth ? squeeze.one : squeeze.two);
  const Push& first = *(squeeze.one->by <= squeeze.two->by ? squeeze.one : squeeze.two);
  const Push& second = *(&first == squeeze.one ? squeeze.two : squeeze.one);
  Collision row;
  row.kind = CollisionKind::squeezed;
  row.key = work.key();
  row.time = work.now();
  row.body1 = first.by;
  row.body2 = second.by;
  row.point = deeper.point;
  row.normal = first.along;
  row.squeezed = deeper.body;
  row.depth = deeper.depth;
  row.depth_share = deeper.depth / work.scene().body(deeper.body).least_width;
  return row;
}

}  // namespace

void note_squeezed(Regrouping& work) {
  const Pushes pushes(work);
  for (Successor& successor : work.successors) {
    if (!work.changes(&successor) || !successor.body->dynamic()) continue;
    double& since = successor.data.squeezed_since;
    const bool before = since < never;
    if (!before && pushes.empty()) continue;
    const Body& body = *successor.body;
    const double least = answer::squeezed_share * body.least_width;
    const Squeeze squeeze = pushes.squeeze(body.id(), before ? 0.5 * least : least, !before);
    if (!squeeze) {
      since = never;
      continue;
    }
    work.tally.note_squeezed(squeeze.depth(), squeeze.depth() / body.least_width);
    if (before) continue;
    since = work.now();
    ++work.tally.squeezed;
    work.report.push_back(report_of(work, squeeze));
  }
}

}  // namespace tw
