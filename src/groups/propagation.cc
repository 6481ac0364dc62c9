// Impulses passed on through contacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/propagation.h"

#include <algorithm>
#include <map>

#include "base/constants.h"
#include "dynamics/impulse-solver.h"
#include "groups/joints.h"

namespace tw {
namespace {

bool touches(const NewContact& c) {
  return c.gap <= c.reach() + answer::touching * c.contact.law.gap_scale();
}

// Beyond the depth where it hardens no more a spring bears any speed: it stops what comes within
// sqrt(d0/g)/2000.  Impulses on a body that is squeezed there would go to and fro between the walls
// without end, and leave it with a velocity that it does not have.  Not so among unequal masses,
// whose contacts harden within a tenth of that: the heavy press the light as deep by mere weight,
// and a blow on them would drive the light through the floor.
double borne_by(const Scene& scene, const NewContact& c) {
  const ContactConstants& law = c.contact.law;
  const double hardening =
      std::max(law.hardening, answer::hardening_depths * answer::depth_share * law.size);
  if (-c.gap > answer::hardest_ratio * hardening) return never;
  const double slow = fusion_speed(scene, scene.body(c.tag.reference), scene.body(c.tag.other));
  return borne_speed(slow, law.depth, scene.gravity_scale());
}

}  // namespace

std::vector<ProcessId> propagate_impulses(Regrouping& work) {
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
    return ImpulseContact{slot_of(c.tag.reference), slot_of(c.tag.other), c.normal, c.point, 0,
                          c.contact.law.mu,         borne_by(scene, c)};
  };

  std::vector<ImpulseContact> touching_now;  // last of all where the two struck each other
  for (const NewContact& c : work.contacts)
    if (touches(c)) touching_now.push_back(impulse_contact(c));
  if (!work.struck_at.empty()) {
    const BodyId a = work.successors[0].body->id(), b = work.successors[1].body->id();
    const ContactParameters& law = scene.contacts.between(a, b);
    const double slow = fusion_speed(scene, scene.body(a), scene.body(b));
    for (const ContactPoint& c : work.struck_at)
      touching_now.push_back({slot_of(a), slot_of(b), c.normal, c.point, law.restitution,
                              law.friction, slow, law.impact_law});
  }
  const int most = work.struck_at.empty() ? guard::most_passed_on : guard::most_struck_again;
  JointImpulses joints(solver, work.now());
  for (std::uint32_t slot = 0; slot < solver.slot_count(); ++slot)
    if (solver.slot(slot).moves()) joints.add(*work.successor_of(ids[slot]), slot);
  joints.join();
  ImpulseResult result = solver.solve(touching_now, 0, most);
  if (result.left_over > 0) result = solver.settle(touching_now);
  if (const ImpulseContact* at = result.stopped_at) {
    std::vector<ProcessId> at_border;
    for (const std::uint32_t slot : {at->a, at->b})
      if (solver.slot(slot).answer == Answer::border)
        at_border.push_back(scene.process_of(ids[slot]));
    return at_border;
  }
  work.tally.kinematic_work += solver.work_of_held();
  const auto still_approaches = [&](const ImpulseContact& c) {
    return -solver.approach(c) > c.bears;
  };
  if (std::any_of(touching_now.end() - static_cast<std::ptrdiff_t>(work.struck_at.size()),
                  touching_now.end(), still_approaches))
    for (const std::size_t i : {0, 1}) work.successors[i].data.impacts.unsettled_time = work.now();
  else if (result.left_over > 0)
    ++work.tally.impulses_given_up;
  joints.take();
  for (std::uint32_t slot = 0; slot < solver.slot_count(); ++slot)
    if (solver.slot(slot).moves())
      take_velocities(*work.successor_of(ids[slot]), solver.slot(slot));

  // pairs that carry nothing and close fast
  std::erase_if(work.pairs, [&](const ContactPair& pair) {
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
