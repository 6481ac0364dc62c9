// Ground that goes on as a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/flush-ground.h"

#include <algorithm>

#include "base/constants.h"
#include "base/never.h"
#include "collision/distance/support-core.h"
#include "geometry/polyhedron.h"

namespace tw {
namespace {

// A convex part of a body, and the body's frame.
struct PlacedPart {
  const ConvexPart& part;
  const Frame& frame;
};

bool is_parallel(const Vec3& a, const Vec3& b) { return a.dot(b) > seam::same_normal; }

// Whether a face of the part lies in the plane.
bool has_face_in(const StandingPlane& plane, const PlacedPart& ground, double size) {
  const ConvexPart& part = ground.part;
  const Frame world = part.in(ground.frame);
  const Vec3 normal = world.R.transpose() * plane.normal;
  const double height = plane.height - plane.normal.dot(world.p);
  const auto& faces = part.core->faces();
  return std::any_of(faces.begin(), faces.end(), [&](const Polyhedron::Face& face) {
    return is_parallel(face.normal, normal) && std::abs(face.offset - height) < seam::flush * size;
  });
}

// The least of direction.x over the part, m.
double lowest_along(const Vec3& direction, const PlacedPart& p) {
  if (p.part.kind == PartKind::half_space) return -never;
  const Frame world = p.part.in(p.frame);
  if (p.part.kind == PartKind::sphere) return direction.dot(world.p) - p.part.radius;
  const SupportCore core(p.part, world);
  return direction.dot(core.support(-direction)) - core.margin;
}

// At `point` (world), with the normal `outward` of the ground (unit, world); `size`: of the body
// that stands, m.
bool is_below_flush_face(const std::vector<StandingPlane>& planes, const PlacedPart& ground,
                         const PlacedPart& standing, const Vec3& point, const Vec3& outward,
                         double size) {
  if (ground.part.kind != PartKind::polyhedron) return false;
  return std::any_of(planes.begin(), planes.end(), [&](const StandingPlane& plane) {
    const double below = plane.height - plane.normal.dot(point);
    const double cosine = plane.normal.dot(outward);
    return std::abs(below) < seam::low * size && cosine < seam::sideways &&
           cosine > -seam::along_edge &&
           lowest_along(plane.normal, standing) > plane.height - seam::low * size &&
           has_face_in(plane, ground, size);
  });
}

// `normal`: from a to b.
bool is_low_side(const std::vector<StandingPlane>& planes, const PairPlace& pair, int parts,
                 const Vec3& point, const Vec3& normal) {
  const std::size_t number = static_cast<std::size_t>(parts), of_b = pair.b.shape_P->part_count();
  const PlacedPart part_a{pair.a.shape_P->part(number / of_b), pair.frame_a};
  const PlacedPart part_b{pair.b.shape_P->part(number % of_b), pair.frame_b};
  return pair.a.dynamic()
             ? is_below_flush_face(planes, part_b, part_a, point, -normal, pair.a.least_width)
             : is_below_flush_face(planes, part_a, part_b, point, normal, pair.b.least_width);
}

}  // namespace

std::vector<StandingPlane> standing_planes(const Scene& scene, const Group& group,
                                           const Body& member, double when) {
  std::vector<StandingPlane> planes;
  const int number = group.member_of(member.process);
  if (number < 0) return planes;
  for (const std::uint32_t i : group.pairs_of(static_cast<std::uint32_t>(number))) {
    const ContactPair& pair = group.pairs[i];
    if (pair.a() != member.id() && pair.b() != member.id()) continue;
    if (scene.body(pair.other(member.id())).dynamic()) continue;
    each_contact(pair, [&](std::uint32_t c) {
      const GroupContact& contact = group.arc->start().contacts[c];
      if (contact.feature != ContactFeature::plane) return;
      const ContactForce f = group.contact_at(c, when);
      if (f.gap > group.reach_of(c) + contact.law.gap_scale()) return;
      // the point lies on the body that has no plane
      const bool on_ground = group.tags[c].reference != member.id();
      const Vec3 normal = on_ground ? f.normal : Vec3(-f.normal);
      const double height = normal.dot(f.point) - (on_ground ? f.gap : 0);
      const auto same = [&](const StandingPlane& known) {
        return is_parallel(known.normal, normal) &&
               std::abs(known.height - height) < seam::same_point * member.least_width;
      };
      if (std::none_of(planes.begin(), planes.end(), same)) planes.push_back({normal, height});
    });
  }
  return planes;
}

bool drop_low_sides(const std::vector<StandingPlane>& planes, const PairPlace& pair,
                    std::vector<ManifoldPoint>& points) {
  return !planes.empty() &&
         std::erase_if(points, [&](const ManifoldPoint& p) {
           return is_low_side(planes, pair, p.pair, p.core_point - p.radius * p.normal,
                              p.reference_is_a ? p.normal : Vec3(-p.normal));
         }) > 0;
}

bool drop_low_sides(const std::vector<StandingPlane>& planes, const PairPlace& pair,
                    std::vector<ContactPoint>& points) {
  return !planes.empty() && std::erase_if(points, [&](const ContactPoint& c) {
                              return is_low_side(planes, pair, c.pair, c.point, c.normal);
                            }) > 0;
}

}  // namespace tw
