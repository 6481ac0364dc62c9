// Motion of a kinematic body by a Scheme procedure of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/scm-motion.h"

#include <cmath>
#include <vector>

#include "base/limits.h"
#include "geometry/height-field.h"
#include "geometry/polyhedron.h"
#include "integrate/given/sampled-motion.h"
#include "math/rotation-vector.h"
#include "script/border.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_motions)

namespace {

// Farthest displacement of the surface of a ball whose centre moves by `shift` while it turns by
// `turn`: the points move within a disc of radius 2 r sin(angle/2) across the axis.
double ball_displacement(const Vec3& shift, const Vec3& turn, double radius) {
  const double angle = turn.norm();
  if (angle == 0) return shift.norm();
  const double along = shift.dot(turn) / angle;
  const double across = std::sqrt(std::max(0.0, shift.squaredNorm() - along * along));
  return std::hypot(along, across + 2 * radius * std::sin(0.5 * angle));
}

// Points on the surface of a round part, in its frame: the farthest is never farther than that.
std::vector<Vec3> surface_points(const ConvexPart& part) {
  constexpr int around = 16;
  std::vector<Vec3> points;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * pi * i / around;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    if (part.kind == PartKind::ellipsoid) {
      const Vec3 up(0, std::cos(angle), std::sin(angle));
      for (const Vec3& unit : {out, up}) points.push_back(part.semi_axes.cwiseProduct(unit));
      continue;
    }
    points.push_back((part.radius + part.margin) * out - part.half_length * Vec3::UnitZ());
    points.push_back((part.top_radius + part.margin) * out + part.half_length * Vec3::UnitZ());
  }
  if (part.margin > 0)
    for (const double end : {-1.0, 1.0})
      points.push_back(end * (part.half_length + part.margin) * Vec3::UnitZ());
  return points;
}

}  // namespace

ScmMotion::ScmMotion(SCM procedure, const std::string& name, double max_speed, ShapePtr shape)
    : procedure_(procedure),
      name_(name.empty() ? "a motion's procedure" : "the motion of " + name),
      max_speed_(max_speed),
      shape_(std::move(shape)) {
  TW_REQUIRE(std::isfinite(max_speed) && max_speed >= 0,
             "max-speed is " + show(max_speed) + "; expected a finite speed in m/s, not negative");
  TW_REQUIRE(max_speed <= speed_limit,
             "max-speed is " + show(max_speed) + " m/s; expected at most " + show(speed_limit));
  TW_REQUIRE(!shape_ || shape_->bounded(),
             "a " + shape_->kind_name() + " moves by a procedure; expected a bounded shape");
}

SCM ScmMotion::call(double time) const {
  SCM arguments[] = {scm_from_double(time)};
  try {
    return call_scheme(procedure_, arguments);
  } catch (const SchemeError& error) {
    throw SchemeError(std::string(error.what()) + "\n  in " + name_ + " at " + show(time) + " s",
                      error.place(), error.backtrace());
  }
}

Pose ScmMotion::pose(double time) const {
  const SCM result = call(time);
  constexpr const char* expected =
      "expected two values, position #(x y z) and orientation #(w x y z)";
  TW_REQUIRE(scm_c_nvalues(result) == 2, name_ + " returned one value; " + expected);
  try {
    const Vec3 position = to_vec3(scm_c_value_ref(result, 0), "position");
    TW_REQUIRE(position.cwiseAbs().maxCoeff() <= farthest,
               name_ + " returned a position with a coordinate of " +
                   show(position.cwiseAbs().maxCoeff()) + " m at " + show(time) +
                   " s; expected at most " + show(farthest) + " m");
    return {position, to_quat(scm_c_value_ref(result, 1), "orientation")};
  } catch (const BadValue& bad) {
    throw UserError(name_ + " returned a wrong " + bad.name + " at " + show(time) + " s; " +
                    expected);
  }
}

double ScmMotion::displacement(const Pose& from, const Pose& to) const {
  double most = 0;
  if (!shape_) return (to.p - from.p).norm();
  const Frame a(from), b(to);
  const Vec3 turn = turn_between(from.q, to.q);
  if (shape_->has_lazy_parts()) {
    // the corners of its box: a spike may go farther than the rim
    const Aabb& box = shape_->tree()->root().box;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner = box.corner(i);
      most = std::max(most, (b * corner - a * corner).norm());
    }
    return most;
  }
  for (const ConvexPart& part : shape_->parts()) {
    const Frame fa = part.in(a), fb = part.in(b);
    if (part.kind == PartKind::sphere)
      most = std::max(most, ball_displacement(fb.p - fa.p, turn, part.radius));
    else if (part.kind != PartKind::polyhedron)
      for (const Vec3& x : surface_points(part)) most = std::max(most, (fb * x - fa * x).norm());
    else
      for (const Vec3& vertex : part.core->vertices())
        most = std::max(most, (fb * vertex - fa * vertex).norm());
  }
  return most;
}

void ScmMotion::require_speed(double from, const Pose& before, double to, const Pose& after) const {
  const double moved = displacement(before, after);
  const double allowed = max_speed_ * (to - from);
  // rounding of the poses themselves, and of the times
  const double time_spacing = 0x1p-50 * std::max(std::abs(from), std::abs(to));
  const double slack = 1e-9 * allowed + 1e-12 * (1 + after.p.norm()) + time_spacing * max_speed_;
  TW_REQUIRE(moved <= allowed + slack,
             name_ + " is faster than its #:max-speed: it moves a point by " + show(moved) +
                 " m between " + show(from) + " s and " + show(to) + " s, at " +
                 show(moved / (to - from)) + " m/s; expected at most " + show(max_speed_) +
                 " m/s, or a larger #:max-speed");
}

TW_PRIMITIVE(procedure_motion, "%procedure-motion",
             (SCM procedure, SCM name, SCM max_speed, SCM shape),
             "Return a motion by a procedure of time, of the body called NAME.") {
  if (scm_is_false(max_speed))
    throw BadValue{
        "max-speed", max_speed,
        "a bound in m/s for every point of the surface, since the motion is a procedure"};
  auto motion =
      std::make_unique<ScmMotion>(procedure, text_of(name), to_real(max_speed, "max-speed"),
                                  scm_is_true(shape) ? to_shape(shape, "shape") : nullptr);
  return from_motion(std::make_shared<SampledMotion>(std::move(motion)), procedure);
}

}  // namespace tw
