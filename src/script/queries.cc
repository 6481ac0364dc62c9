// Scheme primitives: looking into the world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <limits>
#include <optional>

#include "collision/distance/ray.h"
#include "collision/distance/separation.h"
#include "script/primitive.h"
#include "script/states.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_queries)

namespace {

// What a body or view is made of and where.
struct PlacedShape {
  ShapePtr shape;  // null: it touches nothing
  Frame frame;
};

PlacedShape placed_shape(SCM object, const char* what) {
  const BodyState state = read_state(object, what);
  return {info_of(object).shape, Frame(Pose{state.position, state.orientation})};
}

PlacedShape with_shape(SCM object, const char* what) {
  PlacedShape placed = placed_shape(object, what);
  if (!placed.shape) throw BadValue{what, object, "a body that has a shape"};
  return placed;
}

}  // namespace

TW_PRIMITIVE(ray_cast, "%ray-cast", (SCM from, SCM direction, SCM most, SCM bodies),
             "Return (body point normal distance) of the first body that a ray meets, or #f.") {
  const Vec3 start = to_vec3(from, "from"), way = to_vec3(direction, "direction");
  const double length = scaled_norm(way);
  if (!(length > 0)) throw BadValue{"direction", direction, "a vector #(x y z) that is not zero"};
  const Vec3 unit = way / length;
  double farthest = std::numeric_limits<double>::infinity();
  if (scm_is_true(most)) farthest = to_finite(most, "max-distance");
  std::optional<RayHit> nearest;
  SCM met = SCM_BOOL_F;
  for (const SCM body : to_elements(bodies, "bodies", "a list of bodies or views")) {
    const PlacedShape placed = placed_shape(body, "ray-cast");
    if (!placed.shape) continue;
    const auto hit =
        cast_ray(*placed.shape, placed.frame, start, unit, nearest ? nearest->distance : farthest);
    if (!hit || (nearest && !(hit->distance < nearest->distance))) continue;
    nearest = hit;
    met = body;
  }
  if (!nearest) return SCM_BOOL_F;
  return scm_list_4(met, from_vec3(start + nearest->distance * unit), from_vec3(nearest->normal),
                    scm_from_double(nearest->distance));
}

TW_PRIMITIVE(closest_points, "%closest-points", (SCM a, SCM b),
             "Return (point-a point-b signed-distance) of two bodies or views.") {
  const PlacedShape first = with_shape(a, "closest-points");
  const PlacedShape second = with_shape(b, "closest-points");
  TW_REQUIRE(first.shape->bounded() || second.shape->bounded(),
             "closest-points got two half-spaces; expected one body with bounds at least");
  const Separation s = separation(*first.shape, first.frame, *second.shape, second.frame);
  return scm_list_3(from_vec3(s.point_a), from_vec3(s.point_b), scm_from_double(s.distance));
}

TW_PRIMITIVE(overlapping, "%overlapping", (SCM shape, SCM position, SCM orientation, SCM bodies),
             "Return those bodies that a shape placed there overlaps or touches.") {
  const ShapePtr probe = to_shape(shape, "the shape");
  Pose pose;
  if (scm_is_true(position)) pose.p = to_vec3(position, "position");
  if (scm_is_true(orientation)) pose.q = to_quat(orientation, "orientation");
  const Frame frame(pose);
  SCM list = SCM_EOL;
  for (const SCM body : to_elements(bodies, "bodies", "a list of bodies or views")) {
    const PlacedShape placed = placed_shape(body, "overlapping");
    if (!placed.shape) continue;
    if (separation(*probe, frame, *placed.shape, placed.frame).distance <= 0)
      list = scm_cons(body, list);
  }
  return scm_reverse(list);
}

TW_PRIMITIVE(bounding_box, "%bounding-box", (SCM body), "Return the least and greatest corner.") {
  const PlacedShape placed = with_shape(body, "bounding-box");
  const Aabb box = placed.shape->bounds(placed.frame);
  return scm_list_2(from_vec3(box.lo), from_vec3(box.hi));
}

TW_PRIMITIVE(all_poses, "%all-poses", (SCM world),
             "Return x y z qw qx qy qz of all bodies that aren't fixed, as one f64vector.") {
  require_outside_callbacks("all-poses");
  const World& w = to_world(world);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < w.body_count(); ++i) {
    const auto id = static_cast<BodyId>(i);
    if (w.body(id).removed || w.body(id).kind == BodyKind::fixed) continue;
    const BodyState s = w.state(id);
    const Vec3& p = s.position;
    const Quat& q = s.orientation;
    numbers.insert(numbers.end(), {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()});
  }
  SCM vector = scm_make_f64vector(scm_from_size_t(numbers.size()), scm_from_double(0));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    scm_f64vector_set_x(vector, scm_from_size_t(i), scm_from_double(numbers[i]));
  return vector;
}

}  // namespace tw
