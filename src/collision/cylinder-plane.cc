// A cylinder on a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/cylinder-plane.h"

#include <algorithm>

#include "base/constants.h"
#include "collision/face-contact.h"

namespace tw {

namespace {

// sides this near, relative to the radius, are met
constexpr double slack = 1e-12;

// What has to be known of one point besides where it is.
struct Found {
  FacePoint place;
  double radius;  // of the ball about its core
};

void emit(const Found& found, const Ground& ground, FeatureMode mode, ManifoldPoint p,
          std::vector<ManifoldPoint>& out) {
  p.normal = ground.normal;
  p.gap = found.place.gap;
  p.radius = found.radius;
  p.core_point = found.place.point + found.radius * ground.normal;
  p.reference_point = found.place.point - found.place.gap * ground.normal;
  p.feature =
      feature_name(p.pair, mode, {ground.name, found.place.key, p.reference_is_a ? 1u : 0u});
  out.push_back(p);
}

void lie(const PlacedCylinder& c, const Ground& ground, double rolling, const Vec3& down,
         double reach, const ManifoldPoint& p, std::vector<ManifoldPoint>& out) {
  const Vec3 tail = c.center - c.half_length * c.axis + c.radius * down;
  const Vec3 along = 2 * c.half_length * c.axis;
  // the part of the lowest line over the outline; its ends are named by what cuts them
  double from = 0;
  double to = 1;
  std::uint64_t name_from = 0;
  std::uint64_t name_to = 1;
  std::uint64_t number = 2;
  for (const Polyhedron::Side& side : ground.sides) {
    const double start = side.inward.dot(tail) - side.offset;
    const double rise = side.inward.dot(along);
    const double edge = rise != 0 ? -start / rise : 0;
    if (rise > 0 && edge > from) {
      from = edge;
      name_from = number;
    } else if (rise < 0 && edge < to) {
      to = edge;
      name_to = number;
    } else if (rise == 0 && start < -slack * c.radius) {
      return;
    }
    ++number;
  }
  if (from > to) return;
  const auto add = [&](double t, std::uint64_t name) {
    Found found{{tail + t * along, 0, name}, rolling};
    found.place.gap = ground.normal.dot(found.place.point - ground.point);
    if (found.place.gap <= reach) emit(found, ground, FeatureMode::lying, p, out);
  };
  add(from, name_from);
  if (to > from) add(to, name_to);
}

void stand(const PlacedCylinder& c, const Ground& ground, double rolling, const Vec3& down,
           double reach, const ManifoldPoint& p, std::vector<ManifoldPoint>& out) {
  thread_local std::vector<ClipCorner> polygon;
  thread_local std::vector<FacePoint> points;
  const double end = ground.normal.dot(c.axis) > 0 ? -1 : 1;
  const Vec3 cap = c.center + end * c.half_length * c.axis;
  const Vec3 beside = c.axis.cross(down);
  polygon.clear();
  for (int k = 0; k < patch::rim_points; ++k) {
    const double angle = 2 * pi * k / patch::rim_points;
    const Vec3 point = cap + c.radius * (std::cos(angle) * down + std::sin(angle) * beside);
    polygon.push_back({point, ground.normal.dot(point - ground.point), k});
  }
  for (std::size_t i = 0; i < ground.sides.size() && !polygon.empty(); ++i)
    clip_by_side(polygon, ground.sides[i], static_cast<int>(i), slack * c.radius);
  // names: a point of the rim by its number; a cut by the two edges or sides that meet
  points.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (polygon[i].height > reach) continue;
    const int before = polygon[i > 0 ? i - 1 : polygon.size() - 1].next;
    const int after = polygon[i].next;
    const bool on_rim = after >= 0 && before == (after + patch::rim_points - 1) % patch::rim_points;
    const auto word = [](int next) {
      return static_cast<std::uint64_t>(next < 0 ? 1000 + ~next : next);
    };
    const std::uint64_t key = on_rim ? word(after) : (word(before) + 1) << 20 | word(after);
    points.push_back({polygon[i].point, polygon[i].height, key});
  }
  thin_face_points(points, patch::most_points);
  for (const FacePoint& point : points) {
    // the lowest rolls, the others are fixed in the cylinder
    const bool lowest = rolling > 0 && point.key == 0;
    emit({point, lowest ? rolling : 0}, ground,
         rolling > 0 ? FeatureMode::rim : FeatureMode::standing, p, out);
  }
}

}  // namespace

PlacedCylinder::PlacedCylinder(const ConvexPart& part, const Frame& frame)
    : radius(part.radius), half_length(part.half_length) {
  const Frame world = frame * part.placement;
  center = world.p;
  axis = world.R.col(2);
  across = world.R.col(0);
}

double PlacedCylinder::rolling_radius(const Vec3& normal, Vec3& down) const {
  const Vec3 square = normal - axis.dot(normal) * axis;
  const double sine = square.norm();
  if (sine < patch::standing_flat) {
    down = across;
    return 0;
  }
  down = -square / sine;
  return radius / sine;
}

void cylinder_on_ground(const PlacedCylinder& cylinder, const Ground& ground, double reach,
                        ManifoldPoint p, std::vector<ManifoldPoint>& out) {
  Vec3 down;
  const double rolling = cylinder.rolling_radius(ground.normal, down);
  const bool stands = rolling == 0 || cylinder.radius < patch::standing * rolling;
  (stands ? stand : lie)(cylinder, ground, rolling, down, reach, p, out);
}

}  // namespace tw
