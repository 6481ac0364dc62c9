// What a multibody may be made of: the checks of one link by itself.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/tree-checks.h"

#include <Eigen/Eigenvalues>

#include "base/error.h"
#include "base/limits.h"

namespace tw::multibody {
namespace {

// A limit of a spherical joint: where the angle is 0 or pi it has no direction.
constexpr double least_angle = 1e-3, greatest_angle = 3;  // rad

// Axes of a universal joint are square, and inertia is symmetric, up to rounding of what was typed.
constexpr double typed = 1e-9;

std::string show(const Vec3& v) {
  return "(" + tw::show(v.x()) + " " + tw::show(v.y()) + " " + tw::show(v.z()) + ")";
}

void require_at_least_0(double value, const std::string& what) {
  TW_REQUIRE(std::isfinite(value) && value >= 0 && value <= greatest_stiffness,
             what + " is " + tw::show(value) + "; expected a number from 0 to " +
                 tw::show(greatest_stiffness));
}

void require_finite(const Vec3& v, const std::string& what) {
  TW_REQUIRE(is_finite(v) && v.cwiseAbs().maxCoeff() <= greatest_length,
             what + " is " + show(v) + "; expected three numbers of magnitude up to " +
                 tw::show(greatest_length));
}

void require_axis(const AxisSpec& axis, bool ball, const std::string& joint) {
  require_at_least_0(axis.damping, "damping of " + joint);
  require_at_least_0(axis.friction, "friction of " + joint);
  require_at_least_0(axis.stiffness, "stiffness of " + joint);
  TW_REQUIRE(std::isfinite(axis.rest),
             "rest of " + joint + " is " + tw::show(axis.rest) + "; expected a finite number");
  TW_REQUIRE(axis.lower < axis.upper, "limits of " + joint + " are " + tw::show(axis.lower) +
                                          " and " + tw::show(axis.upper) +
                                          "; expected the lower one first");
  if (ball) {
    TW_REQUIRE(std::isinf(axis.lower), "the lower limit of " + joint + " is " +
                                           tw::show(axis.lower) +
                                           "; expected none, as the joint is spherical");
    TW_REQUIRE(
        std::isinf(axis.upper) || (axis.upper >= least_angle && axis.upper <= greatest_angle),
        "the limit of " + joint + " is " + tw::show(axis.upper) + "; expected an angle from " +
            tw::show(least_angle) + " to " + tw::show(greatest_angle) +
            " rad, as the joint is spherical");
  }
  TW_REQUIRE(axis.restitution >= 0 && axis.restitution <= 1, "restitution of " + joint + " is " +
                                                                 tw::show(axis.restitution) +
                                                                 "; expected a number from 0 to 1");
  if (axis.stop_stiffness)
    TW_REQUIRE(
        *axis.stop_stiffness >= least_stiffness && *axis.stop_stiffness <= greatest_stiffness,
        "stop stiffness of " + joint + " is " + tw::show(*axis.stop_stiffness) +
            "; expected a positive number up to " + tw::show(greatest_stiffness));
}

void require_unit(const Quat& q, const std::string& what) {
  TW_REQUIRE(is_finite(q) && std::abs(q.norm() - 1) < typed,
             what + " is (" + tw::show(q.w()) + " " + tw::show(q.x()) + " " + tw::show(q.y()) +
                 " " + tw::show(q.z()) + "); expected a unit quaternion");
}

void require_direction(const Vec3& axis, const std::string& what) {
  const double length = scaled_norm(axis);
  TW_REQUIRE(std::isfinite(length) && length >= least_length && length <= greatest_length,
             what + " is " + show(axis) + "; expected a vector that is not zero");
}

void require_joint(const JointSpec& joint, const std::string& name) {
  const std::string of = "the joint of " + name;
  require_finite(joint.placement.p, "position of " + of);
  require_unit(joint.placement.q, "orientation of " + of);
  const bool single = joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
  if (single || joint.kind == JointKind::universal) require_direction(joint.axis, "axis of " + of);
  if (joint.kind == JointKind::universal) {
    require_direction(joint.second, "second axis of " + of);
    const double cosine = joint.axis.normalized().dot(joint.second.normalized());
    TW_REQUIRE(std::abs(cosine) < typed, "axes of " + of + " are " + show(joint.axis) + " and " +
                                             show(joint.second) +
                                             "; expected two that are square to each other");
    require_axis(joint.axes[1], false, of);
  }
  if (joint.kind == JointKind::spherical) {
    require_unit(joint.rest_attitude, "rest of " + of);
    if (joint.swinging) require_direction(*joint.swinging, "axis of " + of);
  }
  if (joint.kind != JointKind::weld && joint.kind != JointKind::free)
    require_axis(joint.axes[0], joint.kind == JointKind::spherical, of);
}

// Some distribution of mass has it, rods and points included: no moment is negative or exceeds the
// sum of the other two.
void require_inertia(const LinkSpec& spec) {
  const std::string of = "inertia of " + spec.name;
  const double largest = spec.inertia.cwiseAbs().maxCoeff();
  TW_REQUIRE(std::isfinite(largest) && largest <= greatest_inertia,
             of + " has an element " + tw::show(largest) + "; expected numbers up to " +
                 tw::show(greatest_inertia) + " kg m^2");
  const double skew = (spec.inertia - spec.inertia.transpose()).cwiseAbs().maxCoeff();
  TW_REQUIRE(skew <= typed * largest,
             of + " differs from its transpose by " + tw::show(skew) + "; expected it symmetric");
  const Mat3 symmetric = 0.5 * (spec.inertia + spec.inertia.transpose());
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(symmetric).eigenvalues();
  TW_REQUIRE(
      moments[0] >= -typed * largest && moments[0] + moments[1] >= moments[2] - typed * largest,
      of + " has principal moments " + show(moments) +
          "; expected none that is negative or exceeds the sum of the other two");
  TW_REQUIRE(spec.mass > 0 || largest == 0,
             of + " has an element " + tw::show(largest) + "; expected 0, as its mass is 0");
}

}  // namespace

void require_link(const LinkSpec& spec) {
  TW_REQUIRE(!spec.name.empty(), "a link has no name; expected one");
  require_joint(spec.joint, spec.name);
  TW_REQUIRE(std::isfinite(spec.mass) &&
                 (spec.mass == 0 || (spec.mass >= least_mass && spec.mass <= greatest_mass)),
             "mass of " + spec.name + " is " + tw::show(spec.mass) +
                 "; expected 0 or a number from " + tw::show(least_mass) + " to " +
                 tw::show(greatest_mass));
  require_finite(spec.center_of_mass, "centre of mass of " + spec.name);
  require_inertia(spec);
}

}  // namespace tw::multibody
