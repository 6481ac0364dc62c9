// Mass properties of a rigid body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/rigid-body.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/error.h"
#include "base/limits.h"

namespace tw {
namespace {

// Off-diagonal elements below this share of the largest moment are rounding, not inertia.
constexpr double diagonal_tolerance = 1e-14;

// A mass or a density.
void require_mass(const std::optional<double>& value, const std::string& what) {
  if (!value) return;
  TW_REQUIRE(std::isfinite(*value) && *value > 0,
             what + " is " + show(*value) + "; expected a positive number");
  TW_REQUIRE(*value >= least_mass && *value <= greatest_mass,
             what + " is " + show(*value) + "; expected a number from " + show(least_mass) +
                 " to " + show(greatest_mass));
}

// I about the centre of mass + the shift to another point: the parallel axis theorem.
Mat3 shifted(const Mat3& inertia, double mass, const Vec3& d) {
  return inertia + mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

// Principal moments and axes of a symmetric tensor.
void diagonalise(const Mat3& inertia, Vec3& moments, Quat& axes) {
  const double largest = inertia.diagonal().cwiseAbs().maxCoeff();
  const double off =
      std::max({std::abs(inertia(0, 1)), std::abs(inertia(0, 2)), std::abs(inertia(1, 2))});
  if (off <= diagonal_tolerance * largest) {
    moments = inertia.diagonal();
    axes = Quat::Identity();
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  Mat3 R = solver.eigenvectors();
  if (R.determinant() < 0) R.col(2) = -R.col(2);
  moments = solver.eigenvalues();
  axes = Quat(R).normalized();
}

// Moments that differ by rounding alone are equal: spheres and cubes stay spherical.
void merge_equal_moments(Vec3& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = i + 1; j < 3; ++j)
      if (std::abs(m[i] - m[j]) <= 4e-16 * std::max(m[i], m[j])) m[j] = m[i];
}

void check_moments(const Vec3& m, const std::string& name) {
  const double sum = m.sum(), largest = m.maxCoeff();
  TW_REQUIRE(is_finite(m) && m.minCoeff() > 0,
             "inertia of " + name + " has principal moments " + show(m[0]) + ", " + show(m[1]) +
                 ", " + show(m[2]) + "; expected three positive numbers of kg m^2");
  TW_REQUIRE(m.minCoeff() >= least_inertia && largest <= greatest_inertia,
             "inertia of " + name + " has principal moments " + show(m[0]) + ", " + show(m[1]) +
                 ", " + show(m[2]) + "; expected numbers from " + show(least_inertia) + " to " +
                 show(greatest_inertia) + " kg m^2");
  TW_REQUIRE(sum - largest >= largest * (1 - 1e-9),
             "inertia of " + name + " has principal moments " + show(m[0]) + ", " + show(m[1]) +
                 ", " + show(m[2]) +
                 "; expected none to exceed the sum of the other two (no body has that)");
}

}  // namespace

RigidInertia resolve_inertia(const MassSpecification& given, const Shape* shape,
                             const std::string& name) {
  require_mass(given.density, "density of " + name);
  require_mass(given.mass, "mass of " + name);
  TW_REQUIRE(!given.density || !given.mass,
             "both #:density and #:mass are given for " + name + "; expected one of them");
  const bool bounded = shape && !shape->is_ground();
  TW_REQUIRE(bounded || (given.mass && given.inertia),
             name +
                 (!shape             ? " has no shape"
                  : shape->bounded() ? " is a " + shape->kind_name()
                                     : " has an unbounded shape") +
                 "; expected #:mass and #:inertia, or a bounded #:shape, or #:fixed? #t");

  // centre of mass and inertia about it, body axes
  RigidInertia result;
  Vec3 center = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  if (bounded) {
    const MassProperties& unit = shape->mass_properties();
    const double density = given.mass ? *given.mass / unit.volume : given.density.value_or(1000);
    result.mass = density * unit.volume;
    if (given.mass) result.mass = *given.mass;
    center = given.center_of_mass.value_or(unit.centroid);
    inertia = shifted(density * unit.inertia, result.mass, center - unit.centroid);
  } else {
    result.mass = *given.mass;
    center = given.center_of_mass.value_or(Vec3::Zero());
  }
  require_mass(result.mass, "mass of " + name);
  TW_REQUIRE(is_finite(center), "center of mass of " + name + " is not finite");
  TW_REQUIRE(center.cwiseAbs().maxCoeff() <= greatest_length,
             "center of mass of " + name + " is " + show(center.norm()) +
                 " m from the origin; expected coordinates of at most " + show(greatest_length) +
                 " m");
  if (given.inertia) inertia = *given.inertia;
  TW_REQUIRE(inertia.allFinite() && (inertia - inertia.transpose()).norm() <= 1e-9 * inertia.norm(),
             "inertia of " + name + " is not a symmetric tensor of finite numbers");

  diagonalise(inertia, result.moments, result.X_BP.q);
  merge_equal_moments(result.moments);
  check_moments(result.moments, name);
  result.X_BP.p = center;
  return result;
}

}  // namespace tw
