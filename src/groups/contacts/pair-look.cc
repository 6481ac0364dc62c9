// Looking at two bodies for contacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/pair-look.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "dynamics/impact-law.h"
#include "geometry/polyhedron.h"
#include "groups/contacts/followed-contact.h"
#include "groups/contacts/match-contacts.h"
#include "groups/contacts/pair-manifold.h"

namespace tw {
namespace {

// Whether bounding balls prove a gap above `reach`.
bool far_apart(const PlacedBody& a, const PlacedBody& b, double reach) {
  if (a.body->unbounded || b.body->unbounded) {
    const PlacedBody& plane = a.body->unbounded ? a : b;
    const PlacedBody& other = a.body->unbounded ? b : a;
    if (!plane.body->is_fixed_plane) return false;
    const double height = plane.body->plane_normal.dot(other.point.x) - plane.body->plane_offset;
    return height - other.body->radius > reach;
  }
  const double radii = a.body->radius + b.body->radius + reach;
  return (a.point.x - b.point.x).squaredNorm() > radii * radii;
}

// The part that a point is on, of the body named; `body_b` is the second of the pair.
const ConvexPart& part_at(const ManifoldPoint& p, const Body& body, const Body& body_b) {
  const auto parts_b = static_cast<int>(body_b.shape_P->part_count());
  const int number = &body == &body_b ? p.pair % parts_b : p.pair / parts_b;
  return body.shape_P->part(static_cast<std::size_t>(number));
}

void flatten(ManifoldPoint& p, const PlacedBody& reference, const Body& body_b) {
  if (p.kind == ContactFeature::plane || p.kind == ContactFeature::tangent_plane ||
      reference.body->dynamic())
    return;
  const ConvexPart& part = part_at(p, *reference.body, body_b);
  if (part.kind != PartKind::polyhedron) return;
  for (const Polyhedron::Face& face : part.core->faces()) {
    const Vec3 normal = reference.frame.R * (part.placement().R * face.normal);
    if (normal.dot(p.normal) < 1 - 0.5 * answer::flat_angle * answer::flat_angle) continue;
    p.kind =
        p.kind == ContactFeature::curved ? ContactFeature::tangent_plane : ContactFeature::plane;
    p.normal = normal;
    p.gap = normal.dot(p.core_point - p.reference_point) - p.radius - p.reference_radius;
    p.radius += p.reference_radius;
    p.reference_radius = 0;
    return;
  }
}

NewContact new_contact(const ManifoldPoint& p, const PlacedBody& a, const PlacedBody& b,
                       const ContactConstants& law) {
  const PlacedBody& reference = p.reference_is_a ? a : b;
  const PlacedBody& other = p.reference_is_a ? b : a;
  NewContact result;
  result.contact = followed_contact(p, reference.frame, part_at(p, *reference.body, *b.body),
                                    other.frame, part_at(p, *other.body, *b.body));
  result.contact.law = law;
  result.tag = {reference.body->id(), other.body->id(), p.pair, p.feature, p.flatness, p.beyond};
  result.gap = p.gap;
  result.normal = p.normal;
  result.point = p.core_point - p.radius * p.normal;
  return result;
}

// Whether the pair is in contact until the next check, by the points where it is or may be.
// `before`: whether it was; `reach`: the gap up to which its contacts pressed.
bool comes_into_contact(const std::vector<ManifoldPoint>& points, const PlacedBody& a,
                        const PlacedBody& b, bool before, double reach, double interval,
                        const ContactScales& scales) {
  const double slow = scales.fusion_speed;
  const double drop = scales.gravity * interval * interval;
  bool wanted = false, touches = false, fast = false;
  for (const ManifoldPoint& p : points) {
    const PlacedBody& reference = p.reference_is_a ? a : b;
    const PlacedBody& other = p.reference_is_a ? b : a;
    const Vec3 where = p.core_point - p.radius * p.normal;
    const double parting = (other.velocity_at(where) - reference.velocity_at(where)).dot(p.normal);
    const bool comes = p.gap + 2 * std::min(parting, 0.0) * interval - drop <= 0;
    touches = touches || p.gap <= reach;
    fast = fast || (parting < -slow && comes);
    if (before)
      wanted = wanted || p.gap <= reach + scales.law.gap_scale() || comes;
    else
      wanted = wanted || (comes && std::abs(parting) < slow) || (p.gap <= 0 && parting > -slow);
  }
  // what comes fast is for an impact, unless the pair carries a load already
  return wanted && (!fast || (before && touches));
}

// A spring that is born unloaded lets a body slide before it holds: so a new contact is given the
// stretch that holds what pulls along it, or, where that exceeds the cone, somewhat more than the
// cone's, which slides at once.
void preload(const Regrouping& work, std::vector<NewContact>& contacts, const ContactPair& pair,
             const PlacedBody& a, const PlacedBody& b) {
  if (pair.count == 0) return;
  const NewContact& first = contacts[pair.first];
  if (first.contact.law.law != FrictionLaw::anchored) return;

  // the middle of the contact, the pull and the slip there, of b against a
  Vec3 middle = Vec3::Zero();
  for (std::uint32_t c = 0; c < pair.count; ++c) middle += contacts[pair.first + c].point;
  middle /= pair.count;
  const bool straight = first.tag.reference == a.body->id();
  const Vec3 n = straight ? first.normal : Vec3(-first.normal);
  const auto pull = [&](const PlacedBody& s) {
    const Successor* successor = work.successor_of(s.body->id());
    const bool free = s.body->dynamic() && successor && !successor->data.group;
    return free ? free_acceleration(*successor, work.now()) : Vec3(Vec3::Zero());
  };
  const Vec3 acceleration = pull(b) - pull(a);
  const double pressing = -acceleration.dot(n);
  if (!(pressing > 0)) return;
  const Vec3 along = acceleration + n * pressing;
  const Vec3 relative = b.velocity_at(middle) - a.velocity_at(middle);
  const Vec3 slip = relative - n * relative.dot(n);

  // three points or more keep the bodies from turning, fewer let them roll
  Mat3 compliance = Mat3::Zero();
  for (const PlacedBody* s : {&a, &b}) {
    if (!s->body->dynamic()) continue;
    const Mat3 turning =
        pair.count > 2 ? Mat3(Mat3::Zero()) : inverse_inertia_world(*s->body, s->point.q);
    compliance += contact_compliance(1 / s->body->mass, turning, middle - s->point.x);
  }
  const ContactConstants& law = first.contact.law;
  const double load = pressing / n.dot(compliance * n), cone = law.mu * load;
  Vec3 force = along.norm() > 0
                   ? Vec3(along / along.normalized().dot(compliance * along.normalized()))
                   : Vec3(Vec3::Zero());
  const bool slides = law.ct * slip.norm() > cone;
  if (slides) force = cone * slip.normalized();
  if (slides || force.norm() > cone) force *= answer::preload_beyond * cone / force.norm();
  // once it lies as deep as that load presses it
  const double grip = friction_grip(law, spring_depth(law, 1, load));
  const Vec3 stretch = force / (grip * law.kt) * (straight ? 1 : -1);
  for (std::uint32_t c = 0; c < pair.count; ++c) {
    NewContact& contact = contacts[pair.first + c];
    const Quat attitude = work.attitude(contact.tag.reference);
    contact.contact.stretch = attitude.conjugate() * turned_into(stretch, contact.normal);
  }
}

double reach_of(const PairBefore& old) {
  double reach = 0;
  each_contact(*old.pair,
               [&](std::uint32_t c) { reach = std::max(reach, old.owner->reach_of(c)); });
  return reach;
}

// The planes of the ground on which it stands.
std::vector<StandingPlane> planes_under(const Regrouping& work, const Body& mover) {
  const Successor* successor = work.successor_of(mover.id());
  if (!successor || !successor->data.group) return {};
  const Group& group = *successor->data.group;
  return standing_planes(work.scene(), group, mover, group.contact_time(work.now()));
}

// Whether the two overlap although nothing that is exposed touches: a buried wall or edge of the
// ground.  Such a pair is in contact, with no contact that presses, or its collision checks would
// see an overlap all the time.
bool is_ghost(const std::vector<ManifoldPoint>& points, double distance, bool may_be_buried) {
  if (distance > 0 || !may_be_buried) return false;
  const auto touches = [](const ManifoldPoint& p) { return p.gap <= 0; };
  return std::none_of(points.begin(), points.end(), touches);
}

// Whether two parts were pushed so far into each other that the shortest way out is now on the
// other side: as that of a body whose middle has passed the middle of a wall.  Convex ones that
// were not meet from one side alone.
bool is_pushed_through(const std::vector<ManifoldPoint>& points, const PairBefore& before_it,
                       const PlacedBody& a, const ContactConstants& law, double now) {
  const auto deepest = std::min_element(points.begin(), points.end(),
                                        [](const auto& x, const auto& y) { return x.gap < y.gap; });
  if (deepest == points.end() || -deepest->gap < answer::hardest_ratio * law.hardening)
    return false;
  const Group& group = *before_it.owner;
  double depth = 0;
  Vec3 before = Vec3::Zero();  // from a to b, at the deepest
  each_contact(*before_it.pair, [&](std::uint32_t c) {
    if (group.tags[c].parts != deepest->pair) return;
    const ContactForce f = group.lone_contact_at(c, now);
    if (-f.gap <= depth) return;
    depth = -f.gap;
    before = group.tags[c].reference == a.body->id() ? f.normal : Vec3(-f.normal);
  });
  const Vec3 fresh = deepest->reference_is_a ? deepest->normal : Vec3(-deepest->normal);
  return before.dot(fresh) < -0.5;
}

// Whether two that come to touch so deep in each other may have been put there; what is deeper was
// pressed.
bool was_put_so(const Scene& scene, double depth, double size) {
  return depth > answer::start_depth * size &&
         (depth <= answer::start_overlap * size || scene.options.push_overlaps);
}

// How far apart two may be that are looked at, and what of it.
struct Reach {
  double pressed = 0;  // the gap up to which their contacts pressed, m
  double search = 0;   // how far points are looked for, m
};

Reach reach_for(const PairToLook& two, const PairBefore* before, const ContactScales& scales,
                double interval, bool must) {
  Reach reach;
  if (before) reach.pressed = reach_of(*before);
  const double wanted = reach.pressed + scales.law.gap_scale();
  const double travel = 2 * (two.a->surface_speed() + two.b->surface_speed()) * interval +
                        scales.gravity * interval * interval;
  // new contacts no farther than boxes are sure to hold who is there
  const double held = answer::contact_margin * scales.thickness;
  const double margin = before || must ? std::max(held, wanted) : held;
  const double depth = std::min(wanted, margin);
  reach.search = depth + std::min(travel, margin - depth);
  return reach;
}

// What a pair that was in no contact begins with; `distance`: of the two, m.
void begin_contacts(const Regrouping& work, const PairToLook& two, const ContactScales& scales,
                    double distance, bool is_new, std::vector<NewContact>& contacts) {
  for (NewContact& c : contacts) {
    start_unpressed(work, *two.a->body, *two.b->body, c);
    take_ground_offset(work, *two.a->body, *two.b->body, c);
  }
  // what overlaps when it comes to touch was put so: only what it goes deeper presses
  if (!is_new || !was_put_so(work.scene(), -distance, scales.thickness)) return;
  for (NewContact& c : contacts)
    c.contact.offset =
        std::min(c.contact.offset, unpressed(std::max(c.gap, distance), scales.thickness));
}

}  // namespace

void Footing::meet(const Regrouping& work, const Body& mover, const Body& other) {
  if (!planes && !other.dynamic()) planes = planes_under(work, mover);
}

Look look_at(const Regrouping& work, const PairToLook& two, double interval, LookFor what) {
  const bool must = what == LookFor::always, is_new = what != LookFor::touching;
  const PlacedBody &a = *two.a, &b = *two.b;
  const Body &body_a = *a.body, &body_b = *b.body;
  const std::uint64_t id = pair_id(body_a.id(), body_b.id());
  const PairBefore* before = work.pair_before(id);
  MassRange masses = work.masses;
  if (before) masses.add(before->pair->masses);
  const ContactScales scales = contact_scales(work.scene(), body_a, body_b, masses);
  const Reach reach = reach_for(two, before, scales, interval, must);
  Look look;
  if (!must && far_apart(a, b, reach.search)) return look;

  thread_local std::vector<ManifoldPoint> points;
  points.clear();
  look.manifolds = 1;
  static const std::vector<StandingPlane> none;
  const auto& planes = two.footing->planes;
  const auto [distance, buried] =
      pair_manifold({body_a, a.frame, body_b, b.frame},
                    PairGround(work.surroundings, body_a, body_b, two.footing->ground),
                    planes ? *planes : none, reach.search, points);
  for (ManifoldPoint& p : points) flatten(p, p.reference_is_a ? a : b, body_b);
  // it stays on the side that it came from
  if (before && is_pushed_through(points, *before, a, scales.law, work.now())) {
    look.found = Look::Found::as_before;
    return look;
  }
  if (!must && !comes_into_contact(points, a, b, before, reach.pressed, interval, scales) &&
      !is_ghost(points, distance, buried || body_a.fixed() || body_b.fixed()))
    return look;

  look.found = Look::Found::contact;
  look.pair = {id, 0, static_cast<std::uint32_t>(points.size()), false, {}};
  look.contacts.reserve(points.size());
  for (const ManifoldPoint& p : points) look.contacts.push_back(new_contact(p, a, b, scales.law));
  if (before) {
    look.pair.has_borne_load = before->pair->has_borne_load;
    look.pair.masses = before->pair->masses;
    match_old(work, look.contacts, look.pair, *before);
  } else {
    begin_contacts(work, two, scales, distance, is_new, look.contacts);
  }
  if (is_new) preload(work, look.contacts, look.pair, a, b);
  return look;
}

}  // namespace tw
