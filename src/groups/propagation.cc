// After a blow on a member of a group: what touches it and is now approached too fast for a spring
// gets an impulse without restitution, fastest first; what does not touch yet is left to collision
// checks.
//
// Source: doc/numerics.md, "Contact groups".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <map>

#include "dynamics/impulse-solver.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

constexpr int most_impulses = 700;
// A gap below this share of the contact's depth counts as touch: found at the touch, up to
// rounding.
constexpr double touching = 1e-3;

bool touches(const NewContact& c) { return c.gap <= touching * c.contact.law.depth; }

}  // namespace

// Bodies at the border that an impulse would reach; then nothing is as it should be.
std::vector<BodyId> Kernel::propagate_impulses(Regrouping& work) const {
  // the bodies at the contacts: successors, and outside ones at this instant
  ImpulseSolver solver;
  std::map<BodyId, std::uint32_t> slots;
  std::vector<BodyId> ids;  // by slot
  const auto slot_of = [&](BodyId id) {
    const auto [at, is_new] = slots.try_emplace(id, 0);
    if (!is_new) return at->second;
    ids.push_back(id);
    const Successor* successor = work.successor_of(id);
    const PoseTwist point =
        successor ? successor->point : placed_outside(*bodies[id], work.key.time).point;
    const bool keeps_motion = bodies[id]->dynamic() && !work.changes(successor);
    return at->second = solver.add(keeps_motion ? ImpulseSlot::border(point)
                                                : ImpulseSlot::of(*bodies[id], point));
  };
  const auto impulse_contact = [&](const NewContact& c) {
    const double slow = fusion_speed(*bodies[c.tag.reference], *bodies[c.tag.other]);
    return ImpulseContact{slot_of(c.tag.reference),
                          slot_of(c.tag.other),
                          c.normal,
                          c.point,
                          0,
                          c.contact.law.mu,
                          slow};
  };

  std::vector<ImpulseContact> touching_now;
  for (const NewContact& c : work.contacts)
    if (touches(c)) touching_now.push_back(impulse_contact(c));
  const ImpulseResult result = solver.solve(touching_now, 0, most_impulses);
  if (const ImpulseContact* at = result.stopped_at) {
    std::vector<BodyId> at_border;
    for (const std::uint32_t slot : {at->a, at->b})
      if (solver.slot(slot).answer == Answer::border) at_border.push_back(ids[slot]);
    return at_border;
  }
  work.tally.kinematic_work += solver.work_of_held();
  if (result.left_over > 0) ++work.tally.impulses_given_up;
  for (std::uint32_t slot = 0; slot < solver.slot_count(); ++slot)
    if (solver.slot(slot).moves())
      take_velocities(*work.successor_of(ids[slot]), solver.slot(slot));

  // pairs that carry nothing and close fast
  std::erase_if(work.pairs, [&](const NewContactPair& pair) {
    bool carries = false, fast = false;
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
      const ImpulseContact contact = impulse_contact(work.contacts[c]);
      carries = carries || touches(work.contacts[c]);
      fast = fast || -solver.approach(contact) > contact.bears;
    }
    return fast && !carries;
  });
  return {};
}

}  // namespace tw
