// Ground that goes on as a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/flush-ground.h"

#include <algorithm>

#include "base/constants.h"
#include "geometry/polyhedron.h"

namespace tw {
namespace {

bool is_parallel(const Vec3& a, const Vec3& b) { return a.dot(b) > seam::same_normal; }

// Whether a face of the part lies in the plane.
bool has_face_in(const StandingPlane& plane, const ConvexPart& part, const Frame& frame,
                 double size) {
  const Frame world = frame * part.placement;
  const Vec3 normal = world.R.transpose() * plane.normal;
  const double height = plane.height - plane.normal.dot(world.p);
  const auto& faces = part.core->faces();
  return std::any_of(faces.begin(), faces.end(), [&](const Polyhedron::Face& face) {
    return is_parallel(face.normal, normal) && std::abs(face.offset - height) < seam::flush * size;
  });
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

bool is_below_flush_face(const std::vector<StandingPlane>& planes, const ConvexPart& part,
                         const Frame& frame, const Vec3& point, const Vec3& outward, double size) {
  if (part.kind != PartKind::polyhedron) return false;
  return std::any_of(planes.begin(), planes.end(), [&](const StandingPlane& plane) {
    const double below = plane.height - plane.normal.dot(point);
    const double cosine = plane.normal.dot(outward);
    return std::abs(below) < seam::low * size && cosine < seam::sideways &&
           cosine > -seam::along_edge && has_face_in(plane, part, frame, size);
  });
}

bool drop_low_sides(const std::vector<StandingPlane>& planes, const Body& a, const Frame& frame_a,
                    const Body& b, const Frame& frame_b, std::vector<ManifoldPoint>& points) {
  if (planes.empty()) return false;
  const bool ground_is_a = !a.dynamic();
  const Body &ground = ground_is_a ? a : b, &mover = ground_is_a ? b : a;
  const auto parts_b = static_cast<int>(b.shape_P->part_count());
  const auto is_low = [&](const ManifoldPoint& p) {
    const int number = ground_is_a ? p.pair / parts_b : p.pair % parts_b;
    return is_below_flush_face(planes, ground.shape_P->part(static_cast<std::size_t>(number)),
                               ground_is_a ? frame_a : frame_b, p.core_point - p.radius * p.normal,
                               p.reference_is_a == ground_is_a ? p.normal : Vec3(-p.normal),
                               mover.least_width);
  };
  return std::erase_if(points, is_low) > 0;
}

}  // namespace tw
