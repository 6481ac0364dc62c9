// Impacts: from two arcs that meet to two new states.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/impact.h"

#include <algorithm>

#include "base/constants.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold.h"
#include "collision/seams/seams.h"
#include "dynamics/contact-scales.h"
#include "dynamics/impulse-solver.h"
#include "groups/contacts/pair-manifold.h"
#include "groups/joints/joints.h"
#include "groups/regroup/blow.h"
#include "groups/regroup/regrouping.h"

namespace tw {
namespace {

ContactPoint sphere_contact(const Body& a, const PoseTwist& pa, const Body& b,
                            const PoseTwist& pb) {
  ContactPoint c;
  if (a.is_fixed_plane) {
    c.normal = a.plane_normal;
    c.point = pb.x - b.sphere_radius * c.normal;
  } else if (b.is_fixed_plane) {
    c.normal = -b.plane_normal;
    c.point = pa.x + a.sphere_radius * c.normal;
  } else {
    const Vec3 r = pb.x - pa.x;
    const double distance = r.norm();
    c.gap = distance - a.sphere_radius - b.sphere_radius;
    if (distance > 0) c.normal = r / distance;
    c.point = 0.5 * ((pa.x + a.sphere_radius * c.normal) + (pb.x - b.sphere_radius * c.normal));
  }
  return c;
}

bool simple(const Body& body) { return body.sphere_radius >= 0 || body.is_fixed_plane; }

// The run of impacts after one more at `now`; impacts at one instant count once.
ImpactRun continued(const ImpactRun& run, BodyId partner, double now, double tau) {
  ImpactRun next = run;
  next.partner = partner;
  if (now == run.last_time) return next;
  next.count = now - run.last_time < tau ? run.count + 1 : 0;
  next.last_time = now;
  return next;
}

// Where the two touch.
void find_impact_points(const Scene& scene, const Successor& a, const Successor& b,
                        std::vector<ContactPoint>& points) {
  const Body& body_a = *a.body;
  const Body& body_b = *b.body;
  points.clear();
  if (simple(body_a) && simple(body_b)) {
    points.push_back(sphere_contact(body_a, a.point, body_b, b.point));
    return;
  }
  const double size = std::min(body_a.least_width, body_b.least_width);
  const Frame fa(a.point.q.toRotationMatrix(), a.point.x);
  const Frame fb(b.point.q.toRotationMatrix(), b.point.x);
  touching_points(*body_a.shape_P, fa, *body_b.shape_P, fb,
                  answer::touch_per_accuracy * scene.options.accuracy * size, points);
  if (!points.empty()) return;
  const Separation s = separation(*body_a.shape_P, fa, *body_b.shape_P, fb);
  points.push_back({0.5 * (s.point_a + s.point_b), s.normal, s.distance, 0});
}

// Of the ground, on which the one that moves stands; none where both move or none does.
std::vector<StandingPlane> planes_under(const Scene& scene, const Key& key, const Successor& a,
                                        const Successor& b) {
  if (a.body->dynamic() == b.body->dynamic()) return {};
  const Successor &ground = a.body->dynamic() ? b : a, &mover = a.body->dynamic() ? a : b;
  if (!mover.data.group || ground.body->unbounded) return {};
  const Group& group = *mover.data.group;
  return standing_planes(scene, group, *mover.body, group.contact_time(key.time));
}

// Leaves the sides of such ground out; true if nothing else is left.
bool drop_sides(const std::vector<StandingPlane>& planes, const Successor& a, const Successor& b,
                std::vector<ContactPoint>& found) {
  if (planes.empty()) return false;
  const Frame frame_a(a.point.q.toRotationMatrix(), a.point.x);
  const Frame frame_b(b.point.q.toRotationMatrix(), b.point.x);
  drop_low_sides(planes, {*a.body, frame_a, *b.body, frame_b}, found);
  return found.empty();
}

// At seams of the ground: points that neighbours of the fixed body bury give way to those that
// support; true if there are none.
bool drop_ghosts(const Scene& scene, const Surroundings& surroundings, const Successor& a,
                 const Successor& b, const std::vector<StandingPlane>& planes,
                 std::vector<ContactPoint>& found) {
  const Successor* fixed = a.body->fixed() ? &a : b.body->fixed() ? &b : nullptr;
  if (!fixed || fixed->body->unbounded) return false;
  const Successor& mover = fixed == &a ? b : a;
  const NearGround ground = surroundings.ground_around(*mover.body, {placed(mover).frame});
  const Shape& shape = *fixed->body->shape_P;
  if (ground.bodies.size() < 2 && shape.part_count() < 2) return false;
  const std::vector<SeamNeighbour> others = surroundings.seam_neighbours(*fixed->body, ground);
  const Frame frame(fixed->point.q.toRotationMatrix(), fixed->point.x);
  const double size = std::min(a.body->least_width, b.body->least_width);
  const std::size_t parts_b = b.body->shape_P->part_count();
  // of the fixed body's own parts those that come near the mover
  std::vector<std::uint32_t> own;
  parts_around(shape, frame, ground.place, own);
  const auto is_ghost = [&](const ContactPoint& c) {
    const auto pair = static_cast<std::size_t>(c.pair);
    const std::size_t number = fixed == &a ? pair / parts_b : pair % parts_b;
    std::vector<SeamNeighbour> neighbours = others;
    for (const std::uint32_t i : own)
      if (i != number) neighbours.push_back({&shape.part(i), frame});
    const Vec3 outward = fixed == &a ? c.normal : Vec3(-c.normal);
    const Vec3 on_fixed = c.point - 0.5 * c.gap * outward;
    return buried_edge(shape.part(number), frame, on_fixed, outward, neighbours, size);
  };
  if (std::erase_if(found, is_ghost) == 0 || !found.empty()) return false;

  // another axis may support
  std::vector<ManifoldPoint> points;
  const PlacedBody side_a = placed(a), side_b = placed(b);
  pair_manifold({*a.body, side_a.frame, *b.body, side_b.frame},
                PairGround(surroundings, *a.body, *b.body, ground), planes,
                answer::touch_per_accuracy * scene.options.accuracy * size, points);
  for (const ManifoldPoint& p : points)
    found.push_back({p.core_point - p.radius * p.normal,
                     p.reference_is_a ? p.normal : Vec3(-p.normal), p.gap, p.pair});
  return found.empty();
}

// Whether a kinematic body has struck another again and again at this instant, as fast as at first:
// it has it against something that does not give way, and would strike it for ever.  Notes this
// strike.
bool is_pinned(const Key& key, double fastest, Successor& a, Successor& b) {
  const Successor* wall = a.body->kinematic() ? &a : b.body->kinematic() ? &b : nullptr;
  if (!wall) return false;
  ImpactRun& run = (wall == &a ? b : a).data.impacts;
  const bool again = run.wall == wall->body->id() && run.wall_time == key.time &&
                     fastest >= answer::undiminished * run.wall_speed;
  run.strikes = again ? run.strikes + 1 : 1;
  run.wall = wall->body->id();
  run.wall_time = key.time;
  run.wall_speed = fastest;
  return run.strikes > answer::pinned_strikes;
}

// Slow and pressed together, or a quick run of impacts: counts this one.  `fastest`: approach, m/s.
bool is_soft(const Scene& scene, const Key& key, const Vec3& normal, double fastest, Successor& a,
             Successor& b) {
  const double mass_a = a.body->dynamic() ? a.body->mass : b.body->mass;
  const double mass_b = b.body->dynamic() ? b.body->mass : a.body->mass;
  const ContactScales scales =
      contact_scales(scene, *a.body, *b.body, {std::min(mass_a, mass_b), std::max(mass_a, mass_b)});
  const double slow = scales.fusion_speed;
  if (key.microstep > 1 && fastest <= guard::grazing * slow) return true;
  if (is_pinned(key, fastest, a, b)) return true;
  if (key.microstep > guard::most_repeated) {
    (a.enters() ? a : b).data.tally.declared_soft = 1;
    return true;
  }

  // what a group carries does not fall away from what comes to lie on it
  const auto pull = [&](const Successor& d) { return free_acceleration(d, key.time); };
  const bool pressed = a.data.group || b.data.group || (pull(b) - pull(a)).dot(normal) < 0;

  // what comes back to the same partner is pressed by its own motion, as a disc is that rolls
  const auto comes_back = [](const Successor& d, const Successor& partner) {
    return !d.body->dynamic() || d.data.impacts.partner == partner.body->id();
  };
  const bool presses = pressed || (comes_back(a, b) && comes_back(b, a));
  // what nothing presses together may knock about in a corner for a while; a true collapse goes on
  // to ever shorter intervals
  const double tau = std::min(slow / scales.gravity, scales.bounce_time()) *
                     (presses ? 1 : answer::free_run_share);
  bool quick = true;
  for (const auto& [successor, partner] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    if (!successor->body->dynamic()) continue;
    successor->data.impacts =
        continued(successor->data.impacts, partner->body->id(), key.time, tau);
    quick = quick && successor->data.impacts.count >= answer::soft_run;
  }
  return (pressed && fastest < slow) || quick;
}

}  // namespace

namespace {

Collision collision(CollisionKind kind, const Key& key, const std::vector<Successor>& successors,
                    const Vec3& point, const Vec3& normal, double speed, double impulse) {
  return {
      kind,  key,    successors[0].body->id(), successors[1].body->id(), key.time, point, normal,
      speed, impulse};
}

// Two that nothing else touches or holds.
Blow strike_alone(const Key& key, const BlowAt& at, Successor& a, Successor& b) {
  thread_local ImpulseSolver solver;
  solver.clear();
  const std::uint32_t slot_a = solver.add(ImpulseSlot::of(*a.body, a.point));
  const std::uint32_t slot_b = solver.add(ImpulseSlot::of(*b.body, b.point));
  JointImpulses joints(solver, key.time);
  joints.add(a, slot_a);
  joints.add(b, slot_b);
  joints.join();
  thread_local std::vector<ImpulseContact> contacts;
  contacts.clear();
  for (const ContactPoint& c : at.points)
    contacts.push_back({slot_a, slot_b, c.normal, c.point, at.law->restitution, at.law->friction, 0,
                        at.law->impact_law});
  const double threshold = answer::residual_approach * at.speed;
  if (contacts.size() > 1)
    for (const ImpulseContact& middle : centroids(at.points, contacts))
      if (solver.approach(middle) < -threshold) solver.strike(middle);
  const ImpulseResult result = solver.solve(contacts, threshold, guard::most_impulses);
  joints.take();
  if (a.body->dynamic()) take_velocities(a, solver.slot(slot_a));
  if (b.body->dynamic()) take_velocities(b, solver.slot(slot_b));
  Blow blow;
  blow.largest = solver.largest();
  blow.approach = solver.largest_approach();
  blow.impulse = solver.normal_impulse();
  blow.held_work = solver.work_of_held();
  blow.left_over = blow.given_up = result.left_over > 0;
  return blow;
}

}  // namespace

std::variant<Impact, Waits> compute_impact(const Before& before, const Surroundings& surroundings,
                                           const Known& known, const Wanted& wanted,
                                           std::vector<Successor>& successors) {
  const Scene& scene = before.scene();
  const Key& key = before.key();
  Successor &a = successors[0], &b = successors[1];
  // scratch: a gas has no time for the heap
  thread_local std::vector<ContactPoint> points;
  find_impact_points(scene, a, b, points);
  Impact impact;
  // nothing to hit: the two are followed as a contact while they pass the seam
  const std::vector<StandingPlane> planes = planes_under(scene, key, a, b);
  impact.soft =
      drop_sides(planes, a, b, points) || drop_ghosts(scene, surroundings, a, b, planes, points);
  if (impact.soft) return impact;
  BlowAt at{points, &scene.contacts.between(a.body->id(), b.body->id())};
  // what is told once stands on the first state that enters the graph
  Tally& tally = (a.enters() ? a : b).data.tally;
  for (const ContactPoint& c : points) {
    at.speed = std::max(
        at.speed, -(b.point.velocity_at(c.point) - a.point.velocity_at(c.point)).dot(c.normal));
    tally.note_gap(c.gap);
  }
  const ContactPoint& first = points.front();
  if (is_soft(scene, key, first.normal, at.speed, a, b)) {
    if (wanted.fusion)
      impact.told =
          collision(CollisionKind::fusion, key, successors, first.point, first.normal, at.speed, 0);
    impact.soft = true;
    return impact;
  }

  Blow blow;
  if (touches_groups(successors)) {
    std::variant<Blow, Waits> taken = take_up(before, known, at, successors);
    if (const Waits* waits = std::get_if<Waits>(&taken)) return *waits;
    blow = std::get<Blow>(taken);
  } else {
    blow = strike_alone(key, at, a, b);
  }
  // successors may have been added
  Successor& noted = successors[0].enters() ? successors[0] : successors[1];
  if (blow.given_up) noted.data.tally.impulses_given_up = 1;
  noted.data.tally.kinematic_work = blow.held_work;
  if (key.microstep > guard::most_microsteps) {
    const UserError error("more than " + std::to_string(guard::most_microsteps) + " impacts at " +
                          show(key.time) + " s between " + successors[0].body->info.name + " and " +
                          successors[1].body->info.name + "; expected them to part");
    successors[0].data.error = successors[1].data.error = std::make_exception_ptr(error);
  }
  if (wanted.collision)
    impact.told = collision(CollisionKind::collision, key, successors, blow.largest.point,
                            blow.largest.normal, blow.approach, blow.impulse);
  // what still approaches after so many impulses stays in contact
  impact.soft = blow.left_over;
  return impact;
}

}  // namespace tw
