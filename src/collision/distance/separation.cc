// Signed distance of placed shapes: the table of pairs of kinds, and the least over all parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/separation.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/work-count.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/ellipsoid-point.h"
#include "collision/distance/frustum-point.h"
#include "collision/distance/gjk.h"
#include "collision/distance/part-pairs.h"
#include "collision/distance/round-distance.h"
#include "collision/manifold/clip.h"

namespace tw {

namespace {

using Query = Separation (*)(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                             const Frame& frame_b, SimplexCache* cache);

// Two spheres around points, whose centres are `apart` from a to b.
Separation spheres(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                   const Frame& frame_b, SimplexCache*) {
  const Vec3 center_a = frame_a * a.placement().p;
  const Vec3 center_b = frame_b * b.placement().p;
  const Vec3 apart = center_b - center_a;
  const double length = apart.norm();
  Separation result;
  // concentric spheres: any direction is least; z
  if (length > 0) result.normal = apart / length;
  result.distance = length - (a.radius + b.radius);
  result.point_a = center_a + a.radius * result.normal;
  result.point_b = center_b - b.radius * result.normal;
  return result;
}

// A box (its core's frame) and a point: outside the vector from the nearest point, inside the
// nearest face.
CoreDistance box_to_point(const Vec3& half_edges, const Vec3& point) {
  CoreDistance result;
  const Vec3 nearest = point.cwiseMax(-half_edges).cwiseMin(half_edges);
  const Vec3 apart = point - nearest;
  result.distance = apart.norm();
  result.point_a = nearest;
  if (result.distance > 0) {
    result.normal = apart / result.distance;
    return result;
  }
  int axis = 0;
  result.distance = (point.cwiseAbs() - half_edges).maxCoeff(&axis);
  result.normal = (point[axis] < 0 ? -1 : 1) * Vec3::Unit(axis);
  result.point_a = point - result.distance * result.normal;
  return result;
}

// A polyhedron and a point in its frame, signed.
CoreDistance polyhedron_to_point(const Polyhedron& core, const Vec3& point, SimplexCache* cache) {
  const double touch = touch_ratio * core.radius();
  CoreDistance result = core_distance(core, point, cache);
  if (!result.overlap && result.distance > touch) return result;
  if (cache != nullptr) {
    result = core_distance(core, point, nullptr);
    if (!result.overlap && result.distance > touch) return result;
  }
  // touching or inside: the nearest face plane
  int face = 0;
  const double height = core.face_separation(point, face);
  if (result.overlap || height <= 0) result.distance = height;
  result.normal = core.face(face).normal;
  result.point_a = point - result.distance * result.normal;
  return result;
}

// A part and a ball, by what `nearest_to` finds for the ball's centre in the part's frame.
template <class NearestTo>
Separation near_sphere(const ConvexPart& a, const Frame& frame_a, const ConvexPart& sphere,
                       const Frame& frame_s, const NearestTo& nearest_to) {
  const Frame world_a = a.in(frame_a);
  const Vec3 center = frame_s * sphere.placement().p;
  const CoreDistance near = nearest_to(world_a.to_local(center));
  Separation result;
  result.distance = near.distance - sphere.radius;
  result.normal = world_a.R * near.normal;
  result.point_a = world_a * near.point_a;
  result.point_b = center - sphere.radius * result.normal;
  return result;
}

Separation polyhedron_sphere(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                             const Frame& frame_b, SimplexCache* cache) {
  return near_sphere(a, frame_a, b, frame_b, [&](const Vec3& center) {
    return a.is_box ? box_to_point(a.half_edges, center)
                    : polyhedron_to_point(*a.core, center, cache);
  });
}

// The witness points of an axis of penetration, in A's frame.
void axis_witness(const CorePair& pair, const LeastAxis& axis, Vec3& on_a, Vec3& on_b) {
  if (axis.kind == AxisKind::edges) return crossing_of_edges(pair, axis, on_a, on_b);
  thread_local std::vector<ClippedPoint> points;
  const bool of_a = axis.kind == AxisKind::face_a;
  const double everything = std::numeric_limits<double>::infinity();
  if (of_a)
    clip_face(pair.a, axis.feature_a, pair.b, pair.b_in_a, axis.feature_b, everything, 64, points);
  else
    clip_face(pair.b, axis.feature_b, pair.a, pair.a_in_b(), axis.feature_a, everything, 64,
              points);
  // the deepest point of the clipped face, or the deepest vertex where rounding left nothing
  ClippedPoint deepest;
  if (points.empty()) {
    deepest.point = of_a ? pair.b_in_a * pair.b.vertex(axis.feature_b)
                         : pair.a_in_b() * pair.a.vertex(axis.feature_a);
    deepest.gap = axis.distance;
  } else {
    deepest = *std::min_element(points.begin(), points.end(),
                                [](const auto& p, const auto& q) { return p.gap < q.gap; });
  }
  if (of_a) {
    on_b = deepest.point;
    on_a = on_b - deepest.gap * axis.normal;
  } else {
    on_a = pair.b_in_a * deepest.point;
    on_b = on_a + deepest.gap * axis.normal;
  }
}

Separation separate_cores(const CorePair& pair, const CoreDistance& core) {
  Separation result;
  result.distance = core.distance;
  result.normal = pair.world_a.R * core.normal;
  result.point_a = pair.world_a * core.point_a;
  result.point_b = pair.world_a * (core.point_a + core.distance * core.normal);
  return result;
}

Separation polyhedra(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                     const Frame& frame_b, SimplexCache* cache) {
  const CorePair pair(a, frame_a, b, frame_b);
  const double touch = touch_ratio * pair.size();
  CoreDistance core = core_distance(pair.a, pair.b, pair.b_in_a, cache);
  if (!core.overlap && core.distance > touch) return separate_cores(pair, core);
  if (cache != nullptr) {
    core = core_distance(pair.a, pair.b, pair.b_in_a, nullptr);
    if (!core.overlap && core.distance > touch) return separate_cores(pair, core);
  }
  const LeastAxis axis = least_axis(pair.a, pair.b, pair.b_in_a, core.overlap ? 0 : core.distance);
  Separation result;
  // just apart GJK knows the distance, but only the axis knows the normal
  result.distance = core.overlap || axis.distance <= 0 ? axis.distance : core.distance;
  result.normal = pair.world_a.R * axis.normal;
  Vec3 on_a, on_b;
  axis_witness(pair, axis, on_a, on_b);
  result.point_a = pair.world_a * on_a;
  result.point_b = pair.world_a * on_b;
  return result;
}

// Height of a point over the plane of a half-space; its world normal and offset are reused by all.
struct Plane {
  Vec3 normal;
  Vec3 origin;
  double offset;

  Plane(const ConvexPart& part, const Frame& frame)
      : normal(frame.R * part.normal), origin(frame.p), offset(part.offset) {}
  double height(const Vec3& point) const { return normal.dot(point - origin) - offset; }
};

Separation half_space_sphere(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                             const Frame& frame_b, SimplexCache*) {
  const Plane plane(a, frame_a);
  const Vec3 center = frame_b * b.placement().p;
  Separation result;
  result.distance = plane.height(center) - b.radius;
  result.normal = plane.normal;
  result.point_b = center - b.radius * plane.normal;
  result.point_a = result.point_b - result.distance * plane.normal;
  return result;
}

Separation half_space_polyhedron(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                                 const Frame& frame_b, SimplexCache* cache) {
  const Plane plane(a, frame_a);
  const Frame world_b = b.in(frame_b);
  const Vec3 down = -(world_b.R.transpose() * plane.normal);
  // hill climbing starts at the last vertex; near touch it starts cold, for ties
  const int start = cache != nullptr && cache->count > 0 ? cache->vertex_b[0] : 0;
  const int vertex = b.core->support(down, start);
  Separation result;
  result.normal = plane.normal;
  result.point_b = world_b * b.core->vertex(vertex);
  result.distance = plane.height(result.point_b);
  if (cache != nullptr) {
    cache->count = 1;
    cache->vertex_b[0] = vertex;
    if (result.distance <= touch_ratio * b.core->radius())
      return half_space_polyhedron(a, frame_a, b, frame_b, nullptr);
  }
  result.point_a = result.point_b - result.distance * plane.normal;
  return result;
}

// Two half-spaces overlap without end unless their normals are exactly opposite.
Separation half_spaces(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                       const Frame& frame_b, SimplexCache*) {
  const Plane plane_a(a, frame_a);
  const Plane plane_b(b, frame_b);
  Separation result;
  result.normal = plane_a.normal;
  result.point_a = plane_a.origin + plane_a.offset * plane_a.normal;
  result.point_b = plane_b.origin + plane_b.offset * plane_b.normal;
  result.distance = plane_a.normal == -plane_b.normal ? plane_a.height(result.point_b)
                                                      : -std::numeric_limits<double>::infinity();
  return result;
}

// A frustum or an ellipsoid.
Separation half_space_round(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                            const Frame& frame_b, SimplexCache*) {
  const Plane plane(a, frame_a);
  const SupportCore core(b, b.in(frame_b));
  Separation result;
  result.normal = plane.normal;
  result.point_b = core.support(-plane.normal);
  if (core.margin > 0) result.point_b -= core.margin * plane.normal;
  result.distance = plane.height(result.point_b);
  result.point_a = result.point_b - result.distance * plane.normal;
  return result;
}

Separation frustum_sphere(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                          const Frame& frame_b, SimplexCache*) {
  return near_sphere(a, frame_a, b, frame_b, [&a](const Vec3& center) {
    const NearestOnFrustum near = nearest_on_frustum(a, center);
    return CoreDistance{false, near.distance, near.normal, near.point};
  });
}

Separation ellipsoid_sphere(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                            const Frame& frame_b, SimplexCache*) {
  return near_sphere(a, frame_a, b, frame_b, [&a](const Vec3& center) {
    const NearestOnEllipsoid near = nearest_on_ellipsoid(a.semi_axes, center);
    return CoreDistance{false, near.distance, near.normal, near.point};
  });
}

bool is_segment(const ConvexPart& part) {
  return part.kind == PartKind::frustum && part.radius == 0 && part.top_radius == 0;
}

// By their axes, which have no volume between them that a polytope could expand in.
Separation capsules(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                    const Frame& frame_b) {
  const Frame world_a = a.in(frame_a);
  const Frame world_b = b.in(frame_b);
  const Vec3 axis_a = world_a.R.col(2), axis_b = world_b.R.col(2);
  Vec3 on_a, on_b;
  nearest_on_segments(world_a.p - a.half_length * axis_a, 2 * a.half_length * axis_a,
                      world_b.p - b.half_length * axis_b, 2 * b.half_length * axis_b, on_a, on_b);
  const Vec3 apart = on_b - on_a;
  const double length = apart.norm();
  Separation result;
  // axes that cross: square to both
  const Vec3 across = axis_a.cross(axis_b);
  result.normal = length > 0          ? Vec3(apart / length)
                  : across.norm() > 0 ? Vec3(across.normalized())
                                      : axis_a.unitOrthogonal();
  result.distance = length - (a.margin + b.margin);
  result.point_a = on_a + a.margin * result.normal;
  result.point_b = on_b - b.margin * result.normal;
  return result;
}

// A frustum or an ellipsoid, and a polyhedron or another of these, in the frame of A's core.
Separation round_cores(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                       const Frame& frame_b, SimplexCache*) {
  if (is_segment(a) && is_segment(b)) return capsules(a, frame_a, b, frame_b);
  const Frame world_a = a.in(frame_a);
  const Frame world_b = b.in(frame_b);
  const Mat3 back = world_a.R.transpose();
  const RoundDistance core =
      round_distance(SupportCore(a, Frame()),
                     SupportCore(b, Frame(back * world_b.R, back * (world_b.p - world_a.p))));
  Separation result;
  result.distance = core.distance;
  result.normal = world_a.R * core.normal;
  result.point_a = world_a * core.point_a;
  result.point_b = world_a * core.point_b;
  return result;
}

// The other order of a pair.
template <Query query>
Separation swapped(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                   const Frame& frame_b, SimplexCache* cache) {
  Separation result = query(b, frame_b, a, frame_a, cache);
  result.normal = -result.normal;
  std::swap(result.point_a, result.point_b);
  return result;
}

// The table of pairs of kinds; rows and columns: sphere, polyhedron, half-space, frustum,
// ellipsoid.
constexpr Query queries[5][5] = {
    {spheres, swapped<polyhedron_sphere>, swapped<half_space_sphere>, swapped<frustum_sphere>,
     swapped<ellipsoid_sphere>},
    {polyhedron_sphere, polyhedra, swapped<half_space_polyhedron>, round_cores, round_cores},
    {half_space_sphere, half_space_polyhedron, half_spaces, half_space_round, half_space_round},
    {frustum_sphere, round_cores, swapped<half_space_round>, round_cores, round_cores},
    {ellipsoid_sphere, round_cores, swapped<half_space_round>, round_cores, round_cores},
};

// A lower bound of the distance of two parts by their bounding balls, lowered by what rounding can
// do to either side of the comparison with a distance.
double ball_bound(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                  const Frame& frame_b) {
  constexpr double rounding = 1e-13;
  const bool plane_a = a.kind == PartKind::half_space;
  const bool plane_b = b.kind == PartKind::half_space;
  if (plane_a && plane_b) return -std::numeric_limits<double>::infinity();
  if (plane_b) return ball_bound(b, frame_b, a, frame_a);
  const Vec3 center_b = frame_b * b.bound_center;
  if (plane_a) {
    const double height = Plane(a, frame_a).height(center_b);
    return height - b.bound_radius -
           rounding * (std::abs(height) + std::abs(a.offset) + b.bound_radius);
  }
  const double apart = (center_b - frame_a * a.bound_center).norm();
  const double radii = a.bound_radius + b.bound_radius;
  return apart - radii - rounding * (apart + radii);
}

// The distance of `polyhedra`, cold, without witnesses.
double polyhedra_distance(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                          const Frame& frame_b) {
  ++work_count.distance_queries;
  const CorePair pair(a, frame_a, b, frame_b);
  const CoreDistance core = core_distance(pair.a, pair.b, pair.b_in_a, nullptr);
  if (!core.overlap && core.distance > touch_ratio * pair.size()) return core.distance;
  const double least =
      least_axis(pair.a, pair.b, pair.b_in_a, core.overlap ? 0 : core.distance).distance;
  return core.overlap || least <= 0 ? least : core.distance;
}

double part_distance(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                     const Frame& frame_b) {
  if (a.kind == PartKind::polyhedron && b.kind == PartKind::polyhedron)
    return polyhedra_distance(a, frame_a, b, frame_b);
  return part_separation(a, frame_a, b, frame_b, nullptr).distance;
}

}  // namespace

Separation part_separation(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                           const Frame& frame_b, SimplexCache* cache) {
  ++work_count.distance_queries;
  return queries[static_cast<int>(a.kind)][static_cast<int>(b.kind)](a, frame_a, b, frame_b, cache);
}

namespace {

// The gap between two boxes, lowered by what rounding can do to it.  What is in boxes that overlap
// may overlap by any depth.
double box_gap(const Aabb& a, const Aabb& b) {
  constexpr double rounding = 1e-13;
  if (a.overlaps(b)) return -std::numeric_limits<double>::infinity();
  const Vec3 gap = (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0);
  const double reach = std::max(a.lo.cwiseAbs().maxCoeff(), a.hi.cwiseAbs().maxCoeff());
  return gap.norm() - rounding * (reach + (b.hi - b.lo).norm());
}

// The least separation of one part of each of two shapes so far.  Ties: the first pair.
struct NearestParts {
  const Shape& a;
  const Frame& frame_a;
  const Shape& b;
  const Frame& frame_b;
  Separation least = {.distance = std::numeric_limits<double>::infinity()};

  // Whether parts apart by this could be nearer, or first.
  bool may_hold(double bound) const { return !(bound > least.distance); }
  void try_parts(std::size_t i, std::size_t j) {
    const ConvexPart& part_a = a.part(i);
    const ConvexPart& part_b = b.part(j);
    if (!may_hold(ball_bound(part_a, frame_a, part_b, frame_b))) return;
    if (b.tree() && !may_hold(gap_over_face(part_a, frame_a, part_b, frame_b).gap)) return;
    if (a.tree() && !may_hold(gap_over_face(part_b, frame_b, part_a, frame_a).gap)) return;
    Separation s = part_separation(part_a, frame_a, part_b, frame_b, nullptr);
    s.part_a = static_cast<int>(i);
    s.part_b = static_cast<int>(j);
    const bool first = std::pair(s.part_a, s.part_b) < std::pair(least.part_a, least.part_b);
    if (s.distance < least.distance || (s.distance == least.distance && first)) least = s;
  }
};

// All parts of one shape beneath a node of its tree, whose box is `gap` away, against part `few` of
// the other, whose box in the tree's frame is given: the nearest boxes first.
void search(NearestParts& nearest, const PartTree& tree, const PartTree::Node& node, double gap,
            bool of_b, std::size_t few, const Aabb& box) {
  if (!nearest.may_hold(gap)) return;
  if (node.is_leaf)
    return of_b ? nearest.try_parts(few, node.first) : nearest.try_parts(node.first, few);
  const PartTree::Node *near = &tree.node(node.first), *far = &tree.node(node.first + 1);
  double near_gap = box_gap(near->box, box), far_gap = box_gap(far->box, box);
  if (far_gap < near_gap) {
    std::swap(near, far);
    std::swap(near_gap, far_gap);
  }
  search(nearest, tree, *near, near_gap, of_b, few, box);
  search(nearest, tree, *far, far_gap, of_b, few, box);
}

Separation separation_by_trees(const Shape& a, const Frame& frame_a, const Shape& b,
                               const Frame& frame_b) {
  NearestParts nearest{a, frame_a, b, frame_b};
  const bool in_b = searches_second(a, b);
  const Shape& many = in_b ? b : a;
  const Shape& few = in_b ? a : b;
  const Frame frame = in_b ? seen_from(frame_b, frame_a) : seen_from(frame_a, frame_b);
  for (std::size_t i = 0; i < few.part_count(); ++i) {
    if (!few.has_part(i)) continue;
    const Aabb box = part_bounds(few.part(i), frame);
    const PartTree::Node& root = many.tree()->root();
    search(nearest, *many.tree(), root, box_gap(root.box, box), in_b, i, box);
  }
  return nearest.least;
}

}  // namespace

Separation separation(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b) {
  if (a.tree() || b.tree()) return separation_by_trees(a, frame_a, b, frame_b);
  const std::vector<ConvexPart>& parts_a = a.parts();
  const std::vector<ConvexPart>& parts_b = b.parts();
  Separation best = part_separation(parts_a[0], frame_a, parts_b[0], frame_b, nullptr);
  for (std::size_t i = 0; i < parts_a.size(); ++i)
    for (std::size_t j = i == 0 ? 1 : 0; j < parts_b.size(); ++j) {
      if (ball_bound(parts_a[i], frame_a, parts_b[j], frame_b) > best.distance) continue;
      const Separation found = part_separation(parts_a[i], frame_a, parts_b[j], frame_b, nullptr);
      if (!(found.distance < best.distance)) continue;
      best = found;
      best.part_a = static_cast<int>(i);
      best.part_b = static_cast<int>(j);
    }
  return best;
}

double signed_distance(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b) {
  if (a.tree() || b.tree()) return separation_by_trees(a, frame_a, b, frame_b).distance;
  const std::vector<ConvexPart>& parts_a = a.parts();
  const std::vector<ConvexPart>& parts_b = b.parts();
  double least = part_distance(parts_a[0], frame_a, parts_b[0], frame_b);
  for (std::size_t i = 0; i < parts_a.size(); ++i)
    for (std::size_t j = i == 0 ? 1 : 0; j < parts_b.size(); ++j)
      if (!(ball_bound(parts_a[i], frame_a, parts_b[j], frame_b) > least))
        least = std::min(least, part_distance(parts_a[i], frame_a, parts_b[j], frame_b));
  return least;
}

}  // namespace tw
