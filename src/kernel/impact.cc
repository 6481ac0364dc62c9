// Impacts: from two arcs that meet to two new states.
//
// Single points by the impact law; face-on: at the manifold's centroid first, then the worst
// approacher first, at most 200 impulses (dynamics/impulse-solver.h).  A soft impact leaves the
// motion as it is: the two fuse (groups/region.cc).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "collision/seams/seams.h"
#include "dynamics/impulse-solver.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

// A residual approach below this share of the first one is rounding.
constexpr double residual_approach = 1e-12;

// Replaces each manifold of several points by its centroid, the others stay.
std::vector<ContactPoint> centroids(const std::vector<ContactPoint>& points) {
  std::vector<ContactPoint> result;
  for (std::size_t i = 0; i < points.size();) {
    ContactPoint c = points[i];
    Vec3 sum = Vec3::Zero();
    std::size_t j = i;
    for (; j < points.size() && points[j].pair == c.pair; ++j) sum += points[j].point;
    c.point = sum / static_cast<double>(j - i);
    result.push_back(c);
    i = j;
  }
  return result;
}

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
ImpactRun continued(const ImpactRun& run, double now, double tau) {
  if (now == run.last_time) return run;
  if (now - run.last_time < tau) return {run.count + 1, now};
  return {0, now};
}

}  // namespace

bool Kernel::wants_collision(const Body& a, const Body& b) const {
  if (observed(CollisionKind::collision)) return true;
  for (const CollisionCallbackDef& def : collision_callbacks)
    if (match_specificity(def.a, def.b, a.contact, b.contact)) return true;
  return false;
}

// Where the two touch.
void Kernel::find_impact_points(const Successor& a, const Successor& b) {
  const Body& body_a = *a.body;
  const Body& body_b = *b.body;
  contact_points_.clear();
  if (simple(body_a) && simple(body_b)) {
    contact_points_.push_back(sphere_contact(body_a, a.point, body_b, b.point));
    return;
  }
  const double size = std::min(body_a.least_width, body_b.least_width);
  const Frame fa(a.point.q.toRotationMatrix(), a.point.x);
  const Frame fb(b.point.q.toRotationMatrix(), b.point.x);
  touching_points(*body_a.shape_P, fa, *body_b.shape_P, fb,
                  answer::touch_per_accuracy * present.settings.accuracy * size, contact_points_);
  if (!contact_points_.empty()) return;
  const Separation s = separation(*body_a.shape_P, fa, *body_b.shape_P, fb);
  contact_points_.push_back({0.5 * (s.point_a + s.point_b), s.normal, s.distance, 0});
}

// At seams of the ground: points that neighbours of the fixed body bury give way to those that
// support; true if there are none.
bool Kernel::drop_ghosts(const Successor& a, const Successor& b) {
  const Successor* fixed = a.body->fixed() ? &a : b.body->fixed() ? &b : nullptr;
  if (!fixed || fixed->body->unbounded) return false;
  const Successor& mover = fixed == &a ? b : a;
  const std::vector<BodyId> ground = surroundings_.ground_around(*mover.body);
  const auto& parts = fixed->body->shape_P->parts();
  if (ground.size() < 2 && parts.size() < 2) return false;
  const std::vector<SeamNeighbour> others = surroundings_.seam_neighbours(*fixed->body, ground);
  const Frame frame(fixed->point.q.toRotationMatrix(), fixed->point.x);
  const double size = std::min(a.body->least_width, b.body->least_width);
  const std::size_t parts_b = b.body->shape_P->parts().size();
  const auto is_ghost = [&](const ContactPoint& c) {
    const auto pair = static_cast<std::size_t>(c.pair);
    const std::size_t number = fixed == &a ? pair / parts_b : pair % parts_b;
    std::vector<SeamNeighbour> neighbours = others;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (i != number) neighbours.push_back({&parts[i], frame});
    const Vec3 outward = fixed == &a ? c.normal : Vec3(-c.normal);
    const Vec3 on_fixed = c.point - 0.5 * c.gap * outward;
    return buried_edge(parts[number], frame, on_fixed, outward, neighbours, size);
  };
  if (std::erase_if(contact_points_, is_ghost) == 0 || !contact_points_.empty()) return false;

  // another axis may support
  std::vector<ManifoldPoint> points;
  const PlacedBody side_a = placed(a), side_b = placed(b);
  manifold_at_seams(*a.body->shape_P, side_a.frame, surroundings_.seam_neighbours(*a.body, ground),
                    *b.body->shape_P, side_b.frame, surroundings_.seam_neighbours(*b.body, ground),
                    answer::touch_per_accuracy * present.settings.accuracy * size, size, points);
  for (const ManifoldPoint& p : points)
    contact_points_.push_back({p.core_point - p.radius * p.normal,
                               p.reference_is_a ? p.normal : Vec3(-p.normal), p.gap, p.pair});
  return contact_points_.empty();
}

// Slow and pressed together, or a quick run of impacts: counts this one.  `fastest`: approach, m/s.
bool Kernel::is_soft(const Key& key, Successor& a, Successor& b, double fastest) const {
  const double mass_a = a.body->dynamic() ? a.body->mass : b.body->mass;
  const double mass_b = b.body->dynamic() ? b.body->mass : a.body->mass;
  const ContactScales scales =
      contact_scales(scene, *a.body, *b.body, {std::min(mass_a, mass_b), std::max(mass_a, mass_b)});
  const double slow = scales.fusion_speed;
  if (key.microstep > 1 && fastest <= guard::grazing * slow) return true;
  if (key.microstep > guard::most_repeated) {
    (a.enters() ? a : b).data.tally.declared_soft = 1;
    return true;
  }

  // what a group carries does not fall away from what comes to lie on it
  const auto pull = [](const Successor& d) {
    return d.body->dynamic() ? d.data.acceleration : Vec3(Vec3::Zero());
  };
  const bool pressed =
      a.data.group || b.data.group || (pull(b) - pull(a)).dot(contact_points_.front().normal) < 0;

  // what nothing presses together may knock about in a corner for a while; a true collapse goes on
  // to ever shorter intervals
  const double tau = std::min(slow / scales.gravity, scales.bounce_time()) *
                     (pressed ? 1 : answer::free_run_share);
  bool quick = true;
  for (Successor* successor : {&a, &b}) {
    if (!successor->body->dynamic()) continue;
    successor->data.impacts = continued(successor->data.impacts, key.time, tau);
    quick = quick && successor->data.impacts.count >= answer::soft_run;
  }
  return (pressed && fastest < slow) || quick;
}

// Fills the drafts with the motion after the impact; a soft one leaves it as it is.
bool Kernel::compute_impact(const Key& key, Successor& a, Successor& b,
                            std::optional<Collision>& collision) {
  find_impact_points(a, b);
  // nothing to hit: the two are followed as a contact while they pass the seam
  if (drop_ghosts(a, b)) return true;
  const ContactParameters& contact = scene.contacts.between(a.body->id(), b.body->id());
  // what is told once stands on the first state that enters the graph
  Tally& tally = (a.enters() ? a : b).data.tally;
  ImpulseSolver solver;
  const std::uint32_t slot_a = solver.add(ImpulseSlot::of(*a.body, a.point));
  const std::uint32_t slot_b = solver.add(ImpulseSlot::of(*b.body, b.point));
  const auto contact_at = [&](const ContactPoint& c) {
    return ImpulseContact{slot_a, slot_b, c.normal, c.point, contact.restitution, contact.friction};
  };
  std::vector<ImpulseContact> contacts;
  contacts.reserve(contact_points_.size());
  double worst = 0;
  for (const ContactPoint& c : contact_points_) {
    contacts.push_back(contact_at(c));
    worst = std::min(worst, solver.approach(contacts.back()));
    tally.note_gap(c.gap);
  }
  const ContactPoint first = contact_points_.front();
  const auto describe = [&](CollisionKind kind, const Vec3& point, const Vec3& normal, double speed,
                            double impulse) {
    collision =
        Collision{kind, key, a.body->id(), b.body->id(), key.time, point, normal, speed, impulse};
  };
  if (is_soft(key, a, b, -worst)) {
    if (observed(CollisionKind::fusion))
      describe(CollisionKind::fusion, first.point, first.normal, -worst, 0);
    return true;
  }

  // impulses
  const double threshold = residual_approach * -worst;
  if (contact_points_.size() > 1) {
    for (const ContactPoint& c : centroids(contact_points_))
      if (const ImpulseContact at = contact_at(c); solver.approach(at) < -threshold)
        solver.strike(at);
  }
  const ImpulseResult result = solver.solve(contacts, threshold, guard::most_impulses);
  if (result.left_over > 0) tally.impulses_given_up = 1;
  if (key.microstep > guard::most_microsteps) {
    const UserError error("more than " + std::to_string(guard::most_microsteps) + " impacts at " +
                          show(key.time) + " s between " + a.body->info.name + " and " +
                          b.body->info.name + "; expected them to part");
    a.data.error = b.data.error = std::make_exception_ptr(error);
  }

  // new arcs
  if (a.body->dynamic()) take_velocities(a, solver.slot(slot_a));
  if (b.body->dynamic()) take_velocities(b, solver.slot(slot_b));
  tally.kinematic_work = solver.work_of_held();
  if (wants_collision(*a.body, *b.body))
    describe(CollisionKind::collision, solver.largest().point, solver.largest().normal,
             solver.largest_approach(), solver.normal_impulse());
  // what still approaches after so many impulses stays in contact
  return result.left_over > 0;
}

// Every callback that matches, in order of registration.
void Kernel::run_collision_callbacks(const Collision& collision, Successor& a, Successor& b) {
  for (const CollisionCallbackDef& def : collision_callbacks) {
    if (!match_specificity(def.a, def.b, a.body->contact, b.body->contact)) continue;
    // the sides in the order given; where both match either way, the body added first comes first
    const bool straight =
        side_matches(def.a, a.body->contact) && side_matches(def.b, b.body->contact);
    SuccessorView view_a(a, collision.key, false, present.settings.gravity);
    SuccessorView view_b(b, collision.key, false, present.settings.gravity);
    ++present.counters.callbacks_run;
    if (straight)
      def.callback->run(collision, false, view_a, view_b);
    else
      def.callback->run(collision, true, view_b, view_a);
  }
}

Progress Kernel::process_impact(std::uint32_t index) {
  const Key key = pairs[index].impact;
  Body& body_a = *scene.bodies[pairs[index].a];
  Body& body_b = *scene.bodies[pairs[index].b];

  // only after the claims of the receivers, and of those they touch, have reached its time
  std::vector<ProcessId> struck;
  bool all_known = true;
  for (const Body* body : {&body_a, &body_b}) {
    if (body->dynamic()) insert(struck, body->process);
    all_known = await(body->process, key) && all_known;
  }
  if (!all_known || !await(region_of(before(key), struck, false), key)) return Progress::try_again;

  std::vector<Successor> successors;
  successors.push_back(make_successor(before(key), body_a.process, body_a.dynamic()));
  successors.push_back(make_successor(before(key), body_b.process, body_b.dynamic()));
  std::optional<Collision> collision;
  const bool soft = compute_impact(key, successors[0], successors[1], collision);

  // callbacks see the drafts; their errors stop the receivers, speculatively
  if (collision && collision->kind == CollisionKind::collision && !successors[0].data.error &&
      !collision_callbacks.empty()) {
    try {
      run_collision_callbacks(*collision, successors[0], successors[1]);
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      successors[0].data.error = successors[1].data.error = std::current_exception();
    }
  }
  if (collision)
    (successors[0].enters() ? successors[0] : successors[1]).data.report =
        std::make_shared<const Report>(Report{*collision});
  if (successors[0].data.error)
    stop_group_mates(key, successors);
  else if ((soft || successors[0].data.group || successors[1].data.group) &&
           regroup(key, successors, soft ? Cause::fusion : Cause::impact) == Progress::try_again)
    return Progress::try_again;
  enter_discontinuity(key, successors);
  return Progress::done;
}

}  // namespace tw
