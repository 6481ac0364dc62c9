// Impulses passed on through contacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/propagation.h"

#include <map>

#include "base/constants.h"
#include "dynamics/impulse-solver.h"
#include "groups/joints/joints.h"
#include "groups/regroup/blow.h"

namespace tw {
namespace {

bool touches(const NewContact& c) {
  return c.gap <= c.reach() + answer::touching * c.contact.law.gap_scale();
}

}  // namespace

PassedOn pass_on_impulses(const Regrouping& work, const Contacts& contacts) {
  const Scene& scene = work.scene();
  // the bodies at the contacts: successors, and outside ones at this instant
  ImpulseSolver solver;
  std::map<BodyId, std::uint32_t> slots;
  std::vector<BodyId> ids;  // by slot
  const auto slot_of = [&](BodyId id) {
    const auto [at, is_new] = slots.try_emplace(id, 0);
    if (!is_new) return at->second;
    ids.push_back(id);
    const Successor* successor = work.successor_of(id);
    const PoseTwist point = successor ? successor->point : work.before.placed(id).point;
    const bool keeps_motion = work.lies_beyond(id);
    return at->second = solver.add(keeps_motion ? ImpulseSlot::border(point)
                                                : ImpulseSlot::of(scene.body(id), point));
  };
  const auto impulse_contact = [&](const NewContact& c) {
    return ImpulseContact{slot_of(c.tag.reference),
                          slot_of(c.tag.other),
                          c.normal,
                          c.point,
                          0,
                          c.contact.law.mu,
                          borne_by(scene, scene.body(c.tag.reference), scene.body(c.tag.other),
                                   c.contact.law, c.gap)};
  };

  std::vector<ImpulseContact> touching_now;
  for (const NewContact& c : contacts.all)
    if (touches(c)) touching_now.push_back(impulse_contact(c));
  JointImpulses joints(solver, work.now());
  for (std::uint32_t slot = 0; slot < solver.slot_count(); ++slot)
    if (solver.slot(slot).moves()) joints.add(*work.successor_of(ids[slot]), slot);
  joints.join();
  ImpulseResult result = solver.solve(touching_now, 0, guard::most_passed_on);
  if (result.left_over > 0) result = solver.settle(touching_now);
  PassedOn passed;
  if (const ImpulseContact* at = result.stopped_at) {
    for (const std::uint32_t slot : {at->a, at->b})
      if (solver.slot(slot).answer == Answer::border)
        passed.at_border.push_back(scene.process_of(ids[slot]));
    return passed;
  }
  passed.tally.kinematic_work = solver.work_of_held();
  passed.tally.impulses_given_up = result.left_over > 0;
  joints.take();
  for (std::uint32_t slot = 0; slot < solver.slot_count(); ++slot)
    if (solver.slot(slot).moves())
      take_velocities(*work.successor_of(ids[slot]), solver.slot(slot));

  for (const ContactPair& pair : contacts.pairs) {
    bool carries = false, fast = false;
    each_contact(pair, [&](std::uint32_t c) {
      const ImpulseContact contact = impulse_contact(contacts.all[c]);
      carries = carries || touches(contacts.all[c]);
      fast = fast || -solver.approach(contact) > contact.bears;
    });
    if (fast && !carries) passed.parted.push_back(pair.id);
  }
  return passed;
}

}  // namespace tw
