// Motion of a kinematic body by a Scheme procedure of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/scm-motion.h"

#include <cmath>
#include <vector>

#include "base/limits.h"
#include "geometry/polyhedron.h"
#include "script/border.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_motions)

namespace {

// s: of the differences that give velocities; balances rounding against the third derivative
constexpr double difference_step = 0x1p-17;

// Rotation vector from one orientation to another, |angle| <= pi.
Vec3 turn_between(const Quat& from, const Quat& to) {
  Quat d = to * from.conjugate();
  if (d.w() < 0) d.coeffs() = -d.coeffs();
  const double s = d.vec().norm();
  if (s < 1e-12) return 2 * d.vec();
  return 2 * std::atan2(s, d.w()) / s * d.vec();
}

// Farthest displacement of the surface of a ball whose centre moves by `shift` while it turns by
// `turn`: the points move within a disc of radius 2 r sin(angle/2) across the axis.
double ball_displacement(const Vec3& shift, const Vec3& turn, double radius) {
  const double angle = turn.norm();
  if (angle == 0) return shift.norm();
  const double along = shift.dot(turn) / angle;
  const double across = std::sqrt(std::max(0.0, shift.squaredNorm() - along * along));
  return std::hypot(along, across + 2 * radius * std::sin(0.5 * angle));
}

// Points around both rims of a cylinder: the farthest of them is never farther than its surface.
std::vector<Vec3> rim_points(const ConvexPart& part) {
  constexpr int around = 16;
  std::vector<Vec3> points;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * pi * i / around;
    for (const double end : {-part.half_length, part.half_length})
      points.push_back({part.radius * std::cos(angle), part.radius * std::sin(angle), end});
  }
  return points;
}

}  // namespace

ScmMotion::ScmMotion(SCM procedure, double max_speed, ShapePtr shape)
    : procedure_(procedure), max_speed_(max_speed), shape_(std::move(shape)) {
  TW_REQUIRE(std::isfinite(max_speed) && max_speed >= 0,
             "max-speed is " + show(max_speed) + "; expected a finite speed in m/s, not negative");
  TW_REQUIRE(max_speed <= speed_limit,
             "max-speed is " + show(max_speed) + " m/s; expected at most " + show(speed_limit));
  TW_REQUIRE(!shape_ || shape_->bounded(),
             "a " + shape_->kind_name() + " moves by a procedure; expected a bounded shape");
  // two surface points a width apart differ in velocity by at most twice the bound
  angular_speed_ = shape_ ? 2 * max_speed / shape_->least_width() : 0;
  // the origin may lie outside the body
  const double reach = shape_ ? shape_->radius_about_origin() : 0;
  origin_speed_ = max_speed + angular_speed_ * reach;
}

Pose ScmMotion::call(double time) const {
  SCM arguments[] = {scm_from_double(time)};
  const SCM result = call_scheme(procedure_, arguments);
  constexpr const char* expected =
      "expected two values, position #(x y z) and orientation #(w x y z)";
  TW_REQUIRE(scm_c_nvalues(result) == 2,
             std::string("a motion's procedure returned one value; ") + expected);
  try {
    const Vec3 position = to_vec3(scm_c_value_ref(result, 0), "position");
    TW_REQUIRE(position.cwiseAbs().maxCoeff() <= farthest,
               "a motion's procedure returned a position with a coordinate of " +
                   show(position.cwiseAbs().maxCoeff()) + " m at " + show(time) +
                   " s; expected at most " + show(farthest) + " m");
    return {position, to_quat(scm_c_value_ref(result, 1), "orientation")};
  } catch (const BadValue& bad) {
    throw UserError(std::string("a motion's procedure returned a wrong ") + bad.name + " at " +
                    show(time) + " s; " + expected);
  }
}

double ScmMotion::displacement(const Pose& from, const Pose& to) const {
  double most = 0;
  if (!shape_) return (to.p - from.p).norm();
  const Frame a(from), b(to);
  const Vec3 turn = turn_between(from.q, to.q);
  for (const ConvexPart& part : shape_->parts()) {
    const Frame fa = a * part.placement, fb = b * part.placement;
    if (part.kind == PartKind::sphere)
      most = std::max(most, ball_displacement(fb.p - fa.p, turn, part.radius));
    else if (part.kind == PartKind::cylinder)
      for (const Vec3& rim : rim_points(part)) most = std::max(most, (fb * rim - fa * rim).norm());
    else
      for (const Vec3& vertex : part.core->vertices())
        most = std::max(most, (fb * vertex - fa * vertex).norm());
  }
  return most;
}

void ScmMotion::verify(double time, const Pose& pose) const {
  if (!has_last_) return;
  const double moved = displacement(last_pose_, pose);
  const double allowed = max_speed_ * std::abs(time - last_time_);
  // rounding of the poses themselves
  const double slack = 1e-9 * allowed + 1e-12 * (1 + pose.p.norm());
  TW_REQUIRE(moved <= allowed + slack, "a motion's procedure moved a point by " + show(moved) +
                                           " m between " + show(last_time_) + " s and " +
                                           show(time) + " s; expected at most max-speed, " +
                                           show(max_speed_) + " m/s");
}

Pose ScmMotion::pose(double time) const {
  if (has_last_ && time == last_time_) return last_pose_;
  const Pose result = call(time);
  verify(time, result);
  has_last_ = true;
  last_time_ = time;
  last_pose_ = result;
  return result;
}

Twist ScmMotion::twist(double time) const {
  const Pose before = call(time - difference_step), after = call(time + difference_step);
  return {(after.p - before.p) / (2 * difference_step),
          turn_between(before.q, after.q) / (2 * difference_step)};
}

MotionBounds ScmMotion::bounds(double from, double to) const {
  MotionBounds bounds;
  bounds.speed = origin_speed_;
  bounds.acceleration = bounds.path = Aabb::everywhere();
  bounds.turn = angular_speed_;
  bounds.valid_until = to;
  if (to == never) return bounds;
  bounds.path = {};
  bounds.path.add(pose(0.5 * (from + to)).p);
  bounds.path.grow(0.5 * origin_speed_ * (to - from));
  return bounds;
}

TW_PRIMITIVE(procedure_motion, "%procedure-motion", (SCM procedure, SCM max_speed, SCM shape),
             "Return a motion by a procedure of time.") {
  if (scm_is_false(max_speed))
    throw BadValue{
        "max-speed", max_speed,
        "a bound in m/s for every point of the surface, since the motion is a procedure"};
  return from_motion(
      std::make_shared<ScmMotion>(procedure, to_real(max_speed, "max-speed"),
                                  scm_is_true(shape) ? to_shape(shape, "shape") : nullptr),
      procedure);
}

}  // namespace tw
