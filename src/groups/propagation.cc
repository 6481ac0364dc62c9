// Impulses passed on through contacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/propagation.h"

#include <algorithm>
#include <deque>
#include <map>

#include "groups/resolution.h"

namespace tw {
namespace {

constexpr int most_impulses = 700;
// A gap below this share of the contact's depth counts as touch: found at the touch, up to
// rounding.
constexpr double touching = 1e-3;

}  // namespace

std::vector<ProcessId> propagate_impulses(Regrouping& work) {
  const Scene& scene = work.scene();
  std::vector<ProcessId> at_border;
  // the bodies in contact: successors, and outside ones at this instant
  std::map<BodyId, Resolved> resolved;
  std::deque<PoseTwist> outside_points;
  const auto body_at = [&](BodyId id) -> Resolved& {
    if (const auto known = resolved.find(id); known != resolved.end()) return known->second;
    const Successor* successor = work.successor_of(id);
    if (!successor) outside_points.push_back(work.before.placed(id).point);
    const PoseTwist& point = successor ? successor->point : outside_points.back();
    Resolved& body = resolved.try_emplace(id, scene.body(id), point).first->second;
    if (!work.changes(successor)) body.hold();
    return body;
  };
  const auto parting = [&](const NewContact& c) {
    return (body_at(c.tag.other).velocity_at(c.point) -
            body_at(c.tag.reference).velocity_at(c.point))
        .dot(c.normal);
  };

  // the fastest, as often as there is one
  for (int i = 0; i < most_impulses; ++i) {
    const NewContact* worst = nullptr;
    double excess = 0;
    for (const NewContact& c : work.contacts) {
      if (c.gap > touching * c.contact.law.depth) continue;
      const double slow = fusion_speed(scene, scene.body(c.tag.reference), scene.body(c.tag.other));
      const double beyond = -parting(c) - slow;
      if (beyond <= excess) continue;
      excess = beyond;
      worst = &c;
    }
    if (!worst) break;
    Resolved& reference = body_at(worst->tag.reference);
    Resolved& other = body_at(worst->tag.other);
    const Vec3 u = other.velocity_at(worst->point) - reference.velocity_at(worst->point);
    const Vec3 impulse =
        impact_impulse(reference.compliance(worst->point) + other.compliance(worst->point),
                       worst->normal, u, 0, worst->contact.law.mu);
    for (const BodyId id : {worst->tag.reference, worst->tag.other})
      if (work.lies_beyond(id)) at_border.push_back(scene.process_of(id));
    if (!at_border.empty()) return at_border;
    // of what is held only kinematic bodies move
    if (!reference.moves)
      work.tally.kinematic_work += impulse.dot(reference.velocity_at(worst->point));
    if (!other.moves) work.tally.kinematic_work -= impulse.dot(other.velocity_at(worst->point));
    reference.apply(-impulse, worst->point);
    other.apply(impulse, worst->point);
  }
  for (auto& [id, after] : resolved)
    if (Successor* successor = work.successor_of(id); successor && after.moves)
      take_velocities(*successor, after);

  // pairs that carry nothing and close fast
  std::erase_if(work.pairs, [&](const ContactPair& pair) {
    bool touches = false, fast = false;
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
      const NewContact& contact = work.contacts[c];
      const double slow =
          fusion_speed(scene, scene.body(contact.tag.reference), scene.body(contact.tag.other));
      touches = touches || contact.gap <= touching * contact.contact.law.depth;
      fast = fast || -parting(contact) > slow;
    }
    return fast && !touches;
  });
  return at_border;
}

}  // namespace tw
