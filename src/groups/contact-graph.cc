// Linking: which pairs are in contact, at which points, and what becomes of their friction
// stretches.
//
// Whether a pair is linked is a function of the poses and velocities at the discontinuity, of
// whether it was linked before, and of the interval until the next check; candidates come from the
// spatial hash, whose boxes are grown so that none is missed.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "dynamics/impact-law.h"
#include "geometry/polyhedron.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

// Where gravity is 0 this stands in for it, m/s^2.
constexpr double standard_gravity = 9.81;
// A contact after a refresh is one before it if they are not farther apart, share of the smaller
// size.
constexpr double same_point = 0.1;

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

// The stretch of an old contact in the tangent plane of a new one, as long as before.
Vec3 turned_into(const Vec3& stretch, const Vec3& normal) {
  const Vec3 flat = stretch - normal * normal.dot(stretch);
  const double length = flat.norm();
  return length > 0 ? Vec3(flat * (stretch.norm() / length)) : Vec3(Vec3::Zero());
}

// An edge or corner of the ground whose normal is that of a face but for this, rad, is met as the
// face: beyond a seam the neighbour goes on with it.
constexpr double flat_angle = 1e-3;

void flatten(ManifoldPoint& p, const PlacedBody& reference, const Body& body_b) {
  if (p.kind == ReferenceFeature::plane || reference.body->dynamic()) return;
  const auto parts_b = static_cast<int>(body_b.shape_P->parts().size());
  const int number = reference.body == &body_b ? p.pair % parts_b : p.pair / parts_b;
  const ConvexPart& part = reference.body->shape_P->parts()[static_cast<std::size_t>(number)];
  if (part.kind != PartKind::polyhedron) return;
  for (const Polyhedron::Face& face : part.core->faces()) {
    const Vec3 normal = reference.frame.R * (part.placement.R * face.normal);
    if (normal.dot(p.normal) < 1 - 0.5 * flat_angle * flat_angle) continue;
    p.kind = ReferenceFeature::plane;
    p.normal = normal;
    p.gap = normal.dot(p.core_point - p.reference_point) - p.radius - p.reference_radius;
    p.radius += p.reference_radius;
    p.reference_radius = 0;
    return;
  }
}

}  // namespace

double Kernel::gravity_magnitude() const {
  const double g = options.gravity.norm();
  return g > 0 ? g : standard_gravity;
}

double Kernel::fusion_speed(const Body& a, const Body& b) const {
  const double size = std::min(a.least_width, b.least_width);
  const double by_default = std::max(1e-4, 0.07 * std::sqrt(gravity_magnitude() * size));
  return std::max(1e-9, contact_parameters(a.id(), b.id()).fusion_speed.value_or(by_default));
}

// The law of a pair in a group with these masses, kg.  The heaviest may lie on any of its contacts:
// they are never softer than for a thousandth of it (the law hardens by no more), nor stiffer than
// for a thousand times the lighter one: a bead on a lorry must not stop the clock.
ContactConstants Kernel::contact_law(const Body& a, const Body& b, double lightest,
                                     double heaviest) const {
  constexpr double unequal_masses = 100, most_unequal = 1000;
  const double size = std::min(a.least_width, b.least_width);
  const double mass = !a.dynamic() ? b.mass : !b.dynamic() ? a.mass : std::min(a.mass, b.mass);
  return contact_constants(contact_parameters(a.id(), b.id()),
                           std::clamp(heaviest / most_unequal, mass, most_unequal * mass), size,
                           gravity_magnitude(), heaviest > unequal_masses * lightest);
}

NewContact Kernel::new_contact(const ManifoldPoint& p, const PlacedBody& a, const PlacedBody& b,
                               const ContactConstants& law) const {
  const PlacedBody& reference = p.reference_is_a ? a : b;
  const PlacedBody& other = p.reference_is_a ? b : a;
  NewContact result;
  GroupContact& c = result.contact;
  c.feature = static_cast<ContactFeature>(p.kind);
  c.normal = reference.frame.R.transpose() * p.normal;
  c.direction = reference.frame.R.transpose() * p.direction;
  c.point_a = reference.frame.to_local(p.reference_point);
  c.point_b = other.frame.to_local(p.core_point);
  c.radius_a = p.reference_radius;
  c.radius_b = p.radius;
  c.law = law;
  result.tag = {reference.body->id(), other.body->id(), p.pair, p.feature};
  result.gap = p.gap;
  result.normal = p.normal;
  result.point = p.core_point - p.radius * p.normal;
  return result;
}

// On the points just found, in manifold_points_.
bool Kernel::comes_into_contact(const PlacedBody& a, const PlacedBody& b, bool linked_before,
                                double interval, const ContactConstants& law) const {
  const double slow = fusion_speed(*a.body, *b.body);
  const double drop = gravity_magnitude() * interval * interval;
  bool wanted = false, touches = false, fast = false;
  for (const ManifoldPoint& p : manifold_points_) {
    const PlacedBody& reference = p.reference_is_a ? a : b;
    const PlacedBody& other = p.reference_is_a ? b : a;
    const Vec3 where = p.core_point - p.radius * p.normal;
    const double parting = (other.velocity_at(where) - reference.velocity_at(where)).dot(p.normal);
    const bool comes = p.gap + 2 * std::min(parting, 0.0) * interval - drop <= 0;
    touches = touches || p.gap <= 0;
    fast = fast || (parting < -slow && comes);
    if (linked_before)
      wanted = wanted || p.gap <= law.depth || comes;
    else
      wanted = wanted || (comes && std::abs(parting) < slow) || (p.gap <= 0 && parting > -slow);
  }
  // what comes fast is for an impact, unless the pair carries a load already
  return wanted && (!fast || (linked_before && touches));
}

// Each new contact takes the stretch of the nearest old one; equal features count as half as far.
void Kernel::match_stretches(Regrouping& work, const NewContactPair& pair,
                             const PairBefore& before_it) const {
  const ContactPair* old = before_it.pair;
  const Group& before = *before_it.group;
  const GroupArc& arc = *before.arc;
  const double now = before.contact_time(work.key.time);
  const auto size_of = [&](BodyId id) { return bodies[id]->least_width; };
  const double size = std::min(size_of(first_of(pair.id)), size_of(second_of(pair.id)));
  std::vector<bool> taken(old->count, false);
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
    NewContact& fresh = work.contacts[c];
    double nearest = same_point * size;
    std::uint32_t best = old->count;
    for (std::uint32_t o = 0; o < old->count; ++o) {
      if (taken[o]) continue;
      const ContactTag& tag = before.tags[old->first + o];
      const Vec3 was = arc.contact_force(static_cast<int>(old->first + o), now).point;
      double distance = (was - fresh.point).norm();
      if (tag.feature == fresh.tag.feature && tag.parts == fresh.tag.parts) distance *= 0.5;
      if (distance >= nearest) continue;
      nearest = distance;
      best = o;
    }
    if (best == old->count) continue;
    taken[best] = true;
    const ContactTag& tag = before.tags[old->first + best];
    const auto attitude = [&](BodyId id) {
      const Successor* successor = work.successor_of(id);
      return successor ? successor->point.q : bodies[id]->motion->pose(work.key.time).q;
    };
    Vec3 stretch = attitude(tag.reference) * arc.stretch(static_cast<int>(old->first + best), now);
    if (tag.reference != fresh.tag.reference) stretch = -stretch;
    fresh.contact.stretch =
        attitude(fresh.tag.reference).conjugate() * turned_into(stretch, fresh.normal);
  }
}

// A spring that is born unloaded lets a body slide before it holds: so a new contact is given the
// stretch that holds what pulls along it, or, where that exceeds the cone, far more, which slides
// at once.
void Kernel::preload(Regrouping& work, const NewContactPair& pair, const PlacedBody& a,
                     const PlacedBody& b) const {
  if (pair.count == 0) return;
  const NewContact& first = work.contacts[pair.first];
  if (first.contact.law.law != FrictionLaw::anchored) return;

  // the middle of the contact, the pull and the slip there, of b against a
  Vec3 middle = Vec3::Zero();
  for (std::uint32_t c = 0; c < pair.count; ++c) middle += work.contacts[pair.first + c].point;
  middle /= pair.count;
  const bool straight = first.tag.reference == a.body->id();
  const Vec3 n = straight ? first.normal : Vec3(-first.normal);
  const auto pull = [&](const PlacedBody& s) {
    const Successor* successor = work.successor_of(s.body->id());
    const bool free = s.body->dynamic() && successor && !successor->data.group;
    return free ? successor->data.acceleration : Vec3(Vec3::Zero());
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
  const double cone = law.mu * pressing / n.dot(compliance * n);
  Vec3 force = along.norm() > 0
                   ? Vec3(along / along.normalized().dot(compliance * along.normalized()))
                   : Vec3(Vec3::Zero());
  const bool slides = law.ct * slip.norm() > cone;
  if (slides) force = cone * slip.normalized();
  constexpr double beyond = 10;
  if (slides || force.norm() > cone) force *= beyond * cone / force.norm();
  const Vec3 stretch = force / law.kt * (straight ? 1 : -1);
  for (std::uint32_t c = 0; c < pair.count; ++c) {
    NewContact& contact = work.contacts[pair.first + c];
    const Successor* successor = work.successor_of(contact.tag.reference);
    const Quat attitude = successor ? successor->point.q
                                    : bodies[contact.tag.reference]->motion->pose(work.key.time).q;
    contact.contact.stretch = attitude.conjugate() * turned_into(stretch, contact.normal);
  }
}

// Whether the two overlap although nothing that is exposed touches: a buried wall or edge of the
// ground.  Such a pair is linked, with no contact that presses, or its collision checks would see
// an overlap all the time.
bool Kernel::ghosts(const PlacedBody& a, const PlacedBody& b, double distance) const {
  if (distance > 0 || (!a.body->fixed() && !b.body->fixed())) return false;
  const auto touches = [](const ManifoldPoint& p) { return p.gap <= 0; };
  return std::none_of(manifold_points_.begin(), manifold_points_.end(), touches);
}

bool Kernel::connect(Regrouping& work, const PlacedBody& a, const PlacedBody& b, double interval,
                     bool must) {
  const Body& body_a = *a.body;
  const Body& body_b = *b.body;
  const double size = std::min(body_a.least_width, body_b.least_width);
  const ContactConstants law = contact_law(body_a, body_b, work.lightest, work.heaviest);
  const double travel = 2 * (a.surface_speed() + b.surface_speed()) * interval +
                        gravity_magnitude() * interval * interval;
  const double reach = law.depth + std::min(travel, contact_margin * size - law.depth);
  if (!must && far_apart(a, b, reach)) return false;

  manifold_points_.clear();
  ++counters.manifolds;
  // faces of the ground are exact at seams
  const ReferenceChoice choice = !body_a.dynamic()   ? ReferenceChoice::of_a
                                 : !body_b.dynamic() ? ReferenceChoice::of_b
                                                     : ReferenceChoice::larger;
  const double distance =
      manifold_at_seams(*body_a.shape_P, a.frame, around(body_a), *body_b.shape_P, b.frame,
                        around(body_b), reach, size, manifold_points_, choice);
  for (ManifoldPoint& p : manifold_points_) flatten(p, p.reference_is_a ? a : b, body_b);
  const std::uint64_t pair = pair_id(body_a.id(), body_b.id());
  const PairBefore* before = work.pair_before(pair);
  if (!must && !comes_into_contact(a, b, before, interval, law) && !ghosts(a, b, distance))
    return false;

  NewContactPair fresh{pair, static_cast<std::uint32_t>(work.contacts.size()),
                       static_cast<std::uint32_t>(manifold_points_.size()), false};
  for (const ManifoldPoint& p : manifold_points_)
    work.contacts.push_back(new_contact(p, a, b, law));
  if (before) {
    fresh.has_borne_load = before->pair->has_borne_load;
    match_stretches(work, fresh, *before);
  }
  if (must) preload(work, fresh, a, b);
  work.pairs.push_back(fresh);
  return true;
}

PlacedBody Kernel::placed(const Successor& successor) const {
  return PlacedBody(*successor.body, successor.point);
}

PlacedBody Kernel::placed_outside(const Body& body, double when) const {
  return PlacedBody(body, graph.head(body.process)->trajectory().at(when));
}

// The fixed bodies near a moving one: they bury each other's edges.
void Kernel::find_fixed_around(const Body& mover) {
  ground_.clear();
  if (mover.unbounded) return;
  grid.standing_around(mover.id(), [&](BodyId id) {
    if (may_collide(mover, *bodies[id])) ground_.push_back(id);
  });
  std::sort(ground_.begin(), ground_.end());
}

// The parts of the fixed bodies around a fixed one; of ground_.
std::vector<SeamNeighbour> Kernel::around(const Body& body) const {
  std::vector<SeamNeighbour> result;
  if (!body.fixed()) return result;
  for (const BodyId id : ground_) {
    if (id == body.id()) continue;
    const Frame frame(bodies[id]->motion->pose(0));
    for (const ConvexPart& part : bodies[id]->shape_P->parts()) result.push_back({&part, frame});
  }
  return result;
}

// All links of some of the bodies with new arcs, anew; those of the others as they stand.
void Kernel::refresh(Regrouping& work, const std::vector<BodyId>& bodies_looked_at,
                     double interval) {
  const auto looked_at = [&](BodyId id) {
    return std::binary_search(bodies_looked_at.begin(), bodies_looked_at.end(), id);
  };
  for (const BodyId id : bodies_looked_at) {
    const Body& body = *bodies[id];
    if (!body.shape_P) continue;
    candidates_.clear();
    const auto consider = [&](BodyId other) {
      const Body& partner = *bodies[other];
      if (partner.dynamic()) {
        if (other < id && looked_at(other)) return;
        // with others new contacts are found by collision checks
        const Successor* successor = work.successor_of(other);
        if (!successor || (!work.changes(successor) && !work.pair_before(pair_id(id, other))))
          return;
      }
      if (contacts_may_disable_ && !may_collide(body, partner)) return;
      candidates_.push_back(other);
    };
    grid.overlapping(id, consider);
    for (const BodyId other : unbounded) consider(other);
    std::sort(candidates_.begin(), candidates_.end());

    find_fixed_around(body);
    const PlacedBody mine = placed(*work.successor_of(id));
    for (const BodyId other : candidates_) {
      const Successor* successor = work.successor_of(other);
      const PlacedBody theirs =
          successor ? placed(*successor) : placed_outside(*bodies[other], work.key.time);
      const bool straight = id < other;
      connect(work, straight ? mine : theirs, straight ? theirs : mine, interval, false);
    }
  }
  for (const PairBefore& old : work.before)
    if (!looked_at(first_of(old.id)) && !looked_at(second_of(old.id))) carry(work, old);
}

}  // namespace tw
