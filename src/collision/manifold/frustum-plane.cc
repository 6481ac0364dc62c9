// A frustum on a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/manifold/frustum-plane.h"

#include <algorithm>

#include "base/constants.h"
#include "collision/manifold/face-contact.h"

namespace tw {

namespace {

// sides this near, relative to the radius, are met
constexpr double met = 1e-12;

// Of a point on a circle about the axis: how it rolls.  When the circle is level what is lowest of
// it is anywhere.
ManifoldPoint rolling(ManifoldPoint p, const PlacedFrustum& c, const Tilt& tilt, double radius,
                      const Vec3& center) {
  p.radius = c.rolling_radius(radius, tilt);
  if (!(radius > 0 && tilt.sine > patch::level)) return p;
  p.kind = ContactFeature::tangent_plane;
  p.rim = radius;
  p.rim_center = center;
  p.other_direction = c.axis;
  return p;
}

// `p` has its radius, and what it shares with others.
void emit(const FacePoint& place, const Ground& ground, FeatureMode mode, ManifoldPoint p,
          std::vector<ManifoldPoint>& out) {
  p.normal = ground.normal;
  p.gap = place.gap;
  p.core_point = place.point + p.radius * ground.normal;
  p.reference_point = place.point - place.gap * ground.normal;
  p.feature = feature_name(p.pair, mode, {ground.name, place.key, p.reference_is_a ? 1u : 0u});
  out.push_back(p);
}

void lie(const PlacedFrustum& c, const Ground& ground, const Tilt& tilt, double reach,
         const ManifoldPoint& p, std::vector<ManifoldPoint>& out) {
  const double widening = c.top_radius - c.bottom_radius;
  const Vec3 tail = c.end(false) + c.bottom_radius * tilt.down - c.margin * ground.normal;
  const Vec3 along = 2 * c.half_length * c.axis + widening * tilt.down;
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
    } else if (rise == 0 && start < -met * c.widest()) {
      return;
    }
    ++number;
  }
  if (from > to) return;
  const std::size_t before = out.size();
  thread_local std::vector<FacePoint> higher;
  higher.clear();
  const auto add = [&](double t, std::uint64_t name) {
    FacePoint place{tail + t * along, 0, name};
    place.gap = ground.normal.dot(place.point - ground.point);
    if (place.gap > reach) {
      higher.push_back({place.point, place.gap});
      return;
    }
    const Vec3 center = c.end(false) + 2 * t * c.half_length * c.axis;
    emit(place, ground, FeatureMode::lying,
         rolling(p, c, tilt, c.bottom_radius + t * widening, center), out);
  };
  add(from, name_from);
  if (to > from) add(to, name_to);
  // where the lower end is at a side of the outline, what is steeper is seen as it stands there
  const bool cut = (ground.normal.dot(along) > 0 ? name_from : name_to) > 1;
  lie_on_each_other(ground.parallel, cut ? patch::level : patch::aligned_sine, higher, before, out);
}

void stand(const PlacedFrustum& c, bool on_top, const Ground& ground, const Tilt& tilt,
           double reach, const ManifoldPoint& p, std::vector<ManifoldPoint>& out) {
  thread_local std::vector<ClipCorner> polygon;
  thread_local std::vector<FacePoint> points;
  const double radius = c.end_radius(on_top);
  const Vec3 cap = c.end(on_top);
  const Vec3 beside = c.axis.cross(tilt.down);
  polygon.clear();
  for (int k = 0; k < patch::rim_points; ++k) {
    const double angle = 2 * pi * k / patch::rim_points;
    const Vec3 point = cap + radius * (std::cos(angle) * tilt.down + std::sin(angle) * beside);
    polygon.push_back({point, ground.normal.dot(point - ground.point), k});
  }
  for (std::size_t i = 0; i < ground.sides.size() && !polygon.empty(); ++i)
    clip_by_side(polygon, ground.sides[i], static_cast<int>(i), met * radius);
  // names: a point of the rim by its number; a cut by the two edges or sides that meet
  points.clear();
  thread_local std::vector<FacePoint> higher;
  higher.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (polygon[i].height > reach) {
      higher.push_back({polygon[i].point, polygon[i].height});
      continue;
    }
    const int before = polygon[i > 0 ? i - 1 : polygon.size() - 1].next;
    const int after = polygon[i].next;
    const bool on_rim = after >= 0 && before == (after + patch::rim_points - 1) % patch::rim_points;
    const auto word = [](int next) {
      return static_cast<std::uint64_t>(next < 0 ? 1000 + ~next : next);
    };
    const std::uint64_t key = on_rim ? word(after) : (word(before) + 1) << 20 | word(after);
    points.push_back({polygon[i].point, polygon[i].height, key});
  }
  thin_face_points(points, patch::most_points, reach);
  const std::size_t before = out.size();
  for (const FacePoint& point : points) {
    // the lowest rolls, the others are fixed in the frustum
    const bool lowest = !tilt.upright() && point.key == 0;
    emit(point, ground, tilt.upright() ? FeatureMode::standing : FeatureMode::rim,
         lowest ? rolling(p, c, tilt, radius, cap) : p, out);
  }
  lie_on_each_other(ground.parallel, patch::aligned_sine, higher, before, out);
}

}  // namespace

PlacedFrustum::PlacedFrustum(const ConvexPart& part, const Frame& frame)
    : bottom_radius(part.radius),
      top_radius(part.top_radius),
      half_length(part.half_length),
      margin(part.margin) {
  const Frame world = part.in(frame);
  center = world.p;
  axis = world.R.col(2);
  across = world.R.col(0);
}

double PlacedFrustum::radius_at(const Vec3& point) const {
  const double up = 0.5 + 0.5 * axis.dot(point - center) / half_length;
  return bottom_radius + std::clamp(up, 0.0, 1.0) * (top_radius - bottom_radius);
}

Tilt PlacedFrustum::tilt(const Vec3& normal) const {
  const Vec3 square = normal - axis.dot(normal) * axis;
  const double sine = square.norm();
  if (sine < patch::standing_flat) return {across, 0};
  return {-square / sine, sine};
}

void frustum_on_ground(const PlacedFrustum& frustum, const Ground& ground, double reach,
                       const ManifoldPoint& p, std::vector<ManifoldPoint>& out) {
  const Tilt tilt = frustum.tilt(ground.normal);
  const bool on_top = !(ground.normal.dot(frustum.axis) > 0);
  const double radius = frustum.end_radius(on_top);
  // a tip lies however steeply
  const bool stands =
      radius > 0 && (tilt.upright() || radius < patch::standing * (radius / tilt.sine));
  if (stands)
    stand(frustum, on_top, ground, tilt, reach, p, out);
  else
    lie(frustum, ground, tilt, reach, p, out);
}

}  // namespace tw
