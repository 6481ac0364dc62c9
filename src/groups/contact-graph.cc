// The contact graph: finding contacts and carrying them along.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contact-graph.h"
#include "collision/seams/seams.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "base/constants.h"
#include "base/parallel.h"
#include "dynamics/impact-law.h"
#include "geometry/polyhedron.h"
#include "groups/flush-ground.h"
#include "groups/followed-contact.h"
#include "groups/match-contacts.h"

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

// What is about a dynamic body: the fixed bodies, and the planes of the ground that it stands on,
// once one that is not dynamic is met.
struct Footing {
  NearGround ground;
  std::optional<std::vector<StandingPlane>> planes = std::nullopt;

  void meet(const Regrouping& work, const Body& mover, const Body& other) {
    if (!planes && !other.dynamic()) planes = planes_under(work, mover);
  }
};

// Two bodies that are to be looked at, and what was found: a pair with its contacts from 0 on.
struct Look {
  const PlacedBody *a, *b;
  const Footing* footing = nullptr;  // of the one that moves
  enum class Found : std::uint8_t { nothing, contact, as_before } found = Found::nothing;
  ContactPair pair;
  std::vector<NewContact> contacts;
  std::uint64_t manifolds = 0;
};

// Which pairs are to be in contact.
enum class Wanted : std::uint8_t {
  always,     // it comes to touch now
  new_touch,  // where it touches or may touch before the next check; what holds it does so at once
  touching,   // the same of one that may have been in contact before
};

// Whether two that come to touch so deep in each other may have been put there; what is deeper was
// pressed.
bool was_put_so(const Scene& scene, double depth, double size) {
  return depth > answer::start_depth * size &&
         (depth <= answer::start_overlap * size || scene.options.push_overlaps);
}

// Finds the contacts of a pair.
void look(const Regrouping& work, Look& look, double interval, Wanted wants) {
  const bool must = wants == Wanted::always;
  const PlacedBody &a = *look.a, &b = *look.b;
  const NearGround& ground = look.footing->ground;
  const Body& body_a = *a.body;
  const Body& body_b = *b.body;
  const std::uint64_t id = pair_id(body_a.id(), body_b.id());
  const PairBefore* before = work.pair_before(id);
  MassRange masses = work.masses;
  if (before) masses.add(before->pair->masses);
  const ContactScales scales = contact_scales(work.scene(), body_a, body_b, masses);
  const double reach = before ? reach_of(*before) : 0;
  const double size = scales.thickness, wanted = reach + scales.law.gap_scale();
  const double travel =
      2 * (a.surface_speed() + b.surface_speed()) * interval + scales.gravity * interval * interval;
  // new contacts no farther than boxes are sure to hold who is there
  const double held = answer::contact_margin * size;
  const double margin = before || must ? std::max(held, wanted) : held;
  const double depth = std::min(wanted, margin);
  const double search_distance = depth + std::min(travel, margin - depth);
  if (!must && far_apart(a, b, search_distance)) return;

  thread_local std::vector<ManifoldPoint> points;
  points.clear();
  ++look.manifolds;
  // faces of the ground are exact at seams
  const ReferenceChoice choice = !body_a.dynamic()   ? ReferenceChoice::of_a
                                 : !body_b.dynamic() ? ReferenceChoice::of_b
                                                     : ReferenceChoice::larger;
  const Surroundings& near = work.surroundings;
  const double distance = manifold_at_seams(
      *body_a.shape_P, a.frame, near.seam_neighbours(body_a, ground), *body_b.shape_P, b.frame,
      near.seam_neighbours(body_b, ground), search_distance, size, points, choice);
  const bool buried =
      body_a.dynamic() != body_b.dynamic() &&
      drop_low_sides(*look.footing->planes, body_a, a.frame, body_b, b.frame, points);
  for (ManifoldPoint& p : points) flatten(p, p.reference_is_a ? a : b, body_b);
  // it stays on the side that it came from
  if (before && is_pushed_through(points, *before, a, scales.law, work.now())) {
    look.found = Look::Found::as_before;
    return;
  }
  if (!must && !comes_into_contact(points, a, b, before, reach, interval, scales) &&
      !is_ghost(points, distance, buried || body_a.fixed() || body_b.fixed()))
    return;

  look.found = Look::Found::contact;
  ContactPair& fresh = look.pair;
  fresh = {id, 0, static_cast<std::uint32_t>(points.size()), false, {}};
  look.contacts.reserve(points.size());
  for (const ManifoldPoint& p : points) look.contacts.push_back(new_contact(p, a, b, scales.law));
  if (before) {
    fresh.has_borne_load = before->pair->has_borne_load;
    fresh.masses = before->pair->masses;
    match_old(work, look.contacts, fresh, *before);
  } else {
    for (NewContact& c : look.contacts) {
      start_unpressed(work, body_a, body_b, c);
      take_ground_offset(work, body_a, body_b, c);
    }
    // what overlaps when it comes to touch was put so: only what it goes deeper presses
    if (wants != Wanted::touching && was_put_so(work.scene(), -distance, scales.thickness))
      for (NewContact& c : look.contacts)
        c.contact.offset = std::min(c.contact.offset, unpressed(std::max(c.gap, distance), size));
  }
  if (wants != Wanted::touching) preload(work, look.contacts, fresh, a, b);
}

// Adds what was found.
void take(Regrouping& work, Look& look) {
  work.counters.manifolds += look.manifolds;
  if (look.found == Look::Found::as_before)
    carry(work, *work.pair_before(pair_id(look.a->body->id(), look.b->body->id())));
  if (look.found != Look::Found::contact) return;
  look.pair.first = static_cast<std::uint32_t>(work.contacts.size());
  work.contacts.insert(work.contacts.end(), look.contacts.begin(), look.contacts.end());
  work.pairs.push_back(look.pair);
}

// Who was in contact with whom, from either side; ascending.
using Partners = std::vector<std::pair<BodyId, BodyId>>;

Partners partners_before(const Regrouping& work) {
  Partners partners;
  partners.reserve(2 * work.pairs_before.size());
  for (const PairBefore& old : work.pairs_before) {
    partners.push_back({old.pair->a(), old.pair->b()});
    partners.push_back({old.pair->b(), old.pair->a()});
  }
  std::sort(partners.begin(), partners.end());
  return partners;
}

// Whom a body touches or may have come to touch; ascending.  Boxes hold whoever is as near as a new
// contact is looked for (what is in them beyond that hangs on the claims, and is found apart); an
// old one may reach farther, as a cushion's does that was pressed deep: it is looked at anyhow.
std::vector<BodyId> candidates_of(const Regrouping& work, const Body& body,
                                  const std::vector<ProcessId>& looked_at,
                                  const Partners& partners) {
  const Scene& scene = work.scene();
  const bool may_disable = scene.may_disable();
  std::vector<BodyId> candidates;
  candidates.reserve(16);
  const auto consider = [&](BodyId other) {
    const Body& partner = scene.body(other);
    if (partner.dynamic()) {
      // once, from the body that was added first
      if (other < body.id() && holds(looked_at, partner.process)) return;
      // with others new contacts are found by collision checks
      const Successor* successor = work.successor_of(partner.process);
      if (!successor || (!work.changes(successor) && !work.pair_before(pair_id(body.id(), other))))
        return;
    }
    if (may_disable && !scene.may_collide(body, partner)) return;
    candidates.push_back(other);
  };
  work.surroundings.visit_near(body.id(), consider);
  for (auto at =
           std::lower_bound(partners.begin(), partners.end(), std::pair{body.id(), BodyId{0}});
       at != partners.end() && at->first == body.id(); ++at)
    consider(at->second);
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  return candidates;
}

// What observers hear of a pair that came to touch together with others.
Collision fusion_of(const Regrouping& work, const ContactPair& pair) {
  Collision row = work.told_of(CollisionKind::fusion, pair);
  if (pair.count == 0) return row;
  const NewContact& first = work.contacts[pair.first];
  row.point = first.point;
  row.normal = first.tag.reference == row.body1 ? first.normal : Vec3(-first.normal);
  const Vec3 closing = work.placed(row.body1).velocity_at(first.point) -
                       work.placed(row.body2).velocity_at(first.point);
  row.speed = std::max(0.0, closing.dot(row.normal));
  return row;
}

}  // namespace

void refresh(Regrouping& work, const std::vector<ProcessId>& looked_at, double interval) {
  std::vector<Footing> footings;  // of each, as long as somebody looks
  footings.reserve(looked_at.size());
  const Partners partners = partners_before(work);
  std::vector<Look> looks;
  std::deque<PlacedBody> places;  // of those looked at together
  const bool together = Team::current();
  for (const ProcessId process : looked_at) {
    const PlacedBody here = placed(*work.successor_of(process));
    const Body& body = *here.body;
    if (!body.shape_P) continue;
    TW_ASSERT(body.dynamic(), body.info.name + " has a new arc and is not dynamic");
    const PlacedBody& mine = together ? places.emplace_back(here) : here;
    Footing& footing =
        footings.emplace_back(Footing{work.surroundings.ground_around(body, {mine.frame})});
    for (const BodyId other : candidates_of(work, body, looked_at, partners)) {
      const PlacedBody there = work.placed(other);
      const PlacedBody& theirs = together ? places.emplace_back(there) : there;
      const bool straight = body.id() < other;
      footing.meet(work, body, *theirs.body);
      Look pair{straight ? &mine : &theirs, straight ? &theirs : &mine, &footing, {}, {}, {}, 0};
      if (together) {
        looks.push_back(std::move(pair));
        continue;
      }
      look(work, pair, interval, Wanted::touching);
      take(work, pair);
    }
  }
  constexpr std::size_t grain = 8;
  each_in_parallel(looks.size(), grain,
                   [&](std::size_t i) { look(work, looks[i], interval, Wanted::touching); });
  for (Look& look : looks) take(work, look);
  const auto was_looked_at = [&](BodyId id) {
    return holds(looked_at, work.scene().process_of(id));
  };
  for (const PairBefore& old : work.pairs_before)
    if (!was_looked_at(old.pair->a()) && !was_looked_at(old.pair->b())) carry(work, old);
}

void fuse(Regrouping& work, double interval) {
  const auto meet = [&](const PlacedBody& a, const PlacedBody& b, Wanted wanted) {
    const PlacedBody& mover = a.body->dynamic() ? a : b;
    Footing footing{work.surroundings.ground_around(*mover.body, {mover.frame})};
    footing.meet(work, *mover.body, *(&mover == &a ? b : a).body);
    Look pair{&a, &b, &footing, {}, {}, {}, 0};
    look(work, pair, interval, wanted);
    if (pair.found == Look::Found::contact) ++work.tally.fusions;
    take(work, pair);
  };
  const PlacedBody first = placed(work.successors[0]), second = placed(work.successors[1]);
  meet(first, second, Wanted::always);
  // who strikes each other is told by the impact
  if (is_edit(work.key()) && work.reports_fusions)
    work.report.push_back(fusion_of(work, work.pairs.back()));
  if (!work.together) return;

  const std::uint64_t struck = pair_id(first.body->id(), second.body->id());
  for (const BodyId id : work.placed_bodies) {
    work.together->visit_touching(id, [&](BodyId other) {
      const Body& partner = work.scene().body(other);
      const std::uint64_t pair = pair_id(id, other);
      if ((partner.dynamic() && other < id) || pair == struck || work.pair_before(pair) ||
          !work.scene().may_collide(work.scene().body(id), partner) ||
          std::binary_search(work.left_out.begin(), work.left_out.end(), pair))
        return;
      const std::size_t count = work.pairs.size();
      meet(work.placed(std::min(id, other)), work.placed(std::max(id, other)), Wanted::new_touch);
      if (work.pairs.size() > count && work.reports_fusions)
        work.report.push_back(fusion_of(work, work.pairs.back()));
    });
  }
}

void carry(Regrouping& work, const PairBefore& old) {
  const ContactPair& pair = *old.pair;
  const Group& group = *old.owner;
  const double now = group.contact_time(work.now());
  for (const BodyId side : {pair.a(), pair.b()})
    if (const Successor* successor = work.successor_of(side); successor && successor->placed)
      return;
  // between runs somebody may have set them anew
  const Scene& scene = work.scene();
  if (is_edit(work.key()) && !scene.may_collide(scene.body(pair.a()), scene.body(pair.b()))) return;
  work.pairs.push_back({pair.id, static_cast<std::uint32_t>(work.contacts.size()), pair.count,
                        pair.has_borne_load, pair.masses});
  each_contact(pair, [&](std::uint32_t c) {
    const ContactForce f = group.arc->lone_contact_force(static_cast<int>(c), now);
    const GroupContact& known = group.arc->start().contacts[c];
    NewContact contact{known, group.tags[c], f.gap, f.normal, f.point, known.law};
    contact.share_before = known.share;
    // the side on which the other one is: what it was may have turned away with the body
    if (known.feature != ContactFeature::plane)
      contact.contact.normal = work.attitude(group.tags[c].reference).conjugate() * f.normal;
    contact.contact.stretch = group.arc->stretch(static_cast<int>(c), now);
    contact.contact.bend = group.arc->bend(static_cast<int>(c), now);
    work.contacts.push_back(contact);
  });
}

void collect_old(Regrouping& work) {
  Groups all;
  for (const auto& [process, i] : work.index()) {
    const Successor& successor = work.successors[i];
    if (!successor.body->dynamic()) continue;
    add_once(all, successor.data.group);
    if (!work.changes(&successor)) {
      work.has_border = work.has_border || successor.data.group;
      continue;
    }
    add_once(work.old, successor.data.group);
    work.masses.add(successor.body->mass);
  }
  if (work.has_border)
    for (const auto& group : all) work.masses.add(group->masses);

  for (const auto& [process, i] : work.index()) {
    const Successor& successor = work.successors[i];
    if (!work.changes(&successor) || !successor.data.group) continue;
    const Group& group = *successor.data.group;
    for (const std::uint32_t number : group.pairs_of(successor.data.member)) {
      const std::uint64_t id = group.pairs[number].id;
      const Before::Owned owned = work.before.owned(id);
      if (owned.pair) work.pairs_before.push_back({id, owned.owner, owned.pair});
    }
  }
  std::sort(work.pairs_before.begin(), work.pairs_before.end(),
            [](const PairBefore& x, const PairBefore& y) { return x.id < y.id; });
  // from either side
  const auto same = [](const PairBefore& x, const PairBefore& y) { return x.id == y.id; };
  work.pairs_before.erase(std::unique(work.pairs_before.begin(), work.pairs_before.end(), same),
                          work.pairs_before.end());
}

}  // namespace tw
