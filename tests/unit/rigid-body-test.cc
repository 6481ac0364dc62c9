// Mass properties resolved from what the user gave.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/rigid-body.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/scene.h"

namespace tw::test {
namespace {

Mat3 inertia_in_body_axes(const RigidInertia& r) {
  const Mat3 R = r.X_BP.q.toRotationMatrix();
  return R * r.moments.asDiagonal() * R.transpose();
}

TEST(RigidBody, density_defaults_to_that_of_water) {
  const ShapePtr box = make_box({1, 2, 3});
  const RigidInertia r = resolve_inertia({}, box.get(), "box");
  EXPECT_NEAR(r.mass, 6000, 1e-9);
  EXPECT_NEAR(r.moments.x(), 6000.0 / 12 * 13, 1e-8);
  EXPECT_NEAR(r.moments.y(), 6000.0 / 12 * 10, 1e-8);
  EXPECT_NEAR(r.moments.z(), 6000.0 / 12 * 5, 1e-8);
  EXPECT_EQ(r.X_BP.q.coeffs(), Quat::Identity().coeffs()) << "already diagonal: not rounded";
}

TEST(RigidBody, mass_scales_the_shape_s_inertia) {
  const ShapePtr ball = make_sphere(2);
  MassSpecification given;
  given.mass = 5;
  const RigidInertia r = resolve_inertia(given, ball.get(), "ball");
  EXPECT_EQ(r.mass, 5);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(r.moments[i], 0.4 * 5 * 4, 1e-14);
  EXPECT_EQ(r.moments.x(), r.moments.y());
  EXPECT_EQ(r.moments.x(), r.moments.z()) << "a sphere stays spherical";
}

TEST(RigidBody, principal_frame_diagonalises_any_inertia) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 squares(random.real(0.01, 1), random.real(0.01, 1), random.real(0.01, 1));
    const Vec3 moments = squares.sum() * Vec3::Ones() - squares;
    const Mat3 R = random_attitude(random).toRotationMatrix();
    Mat3 inertia = R * moments.asDiagonal() * R.transpose();
    inertia = (0.5 * (inertia + inertia.transpose())).eval();
    MassSpecification given;
    given.mass = 2;
    given.inertia = inertia;
    given.center_of_mass = random_vector(random, 1);
    const RigidInertia r = resolve_inertia(given, nullptr, "body");
    EXPECT_LT((inertia_in_body_axes(r) - inertia).norm(), 1e-14 * 10);
    EXPECT_EQ(r.X_BP.p, *given.center_of_mass);
    EXPECT_NEAR(r.X_BP.q.norm(), 1, 1e-15);
  }
}

TEST(RigidBody, given_center_of_mass_shifts_the_inertia) {
  const ShapePtr box = make_box({1, 1, 1});
  MassSpecification given;
  given.mass = 3;
  given.center_of_mass = Vec3(0.1, 0, 0);
  const RigidInertia r = resolve_inertia(given, box.get(), "box");
  EXPECT_NEAR(r.moments.x(), 0.5, 1e-15);
  EXPECT_NEAR(r.moments.y(), 0.5 + 3 * 0.01, 1e-15);
}

TEST(RigidBody, wrong_numbers_are_errors_that_name_the_body) {
  const ShapePtr ball = make_sphere(1);
  const ShapePtr half_space = make_half_space(Vec3::UnitZ(), 0);
  const auto message = [&](const MassSpecification& given, const Shape* shape) -> std::string {
    try {
      resolve_inertia(given, shape, "ball-7");
    } catch (const UserError& error) {
      return error.what();
    }
    return "no error";
  };
  std::vector<std::pair<MassSpecification, const Shape*>> wrong(9, {{}, ball.get()});
  wrong[0].first.mass = 0;
  wrong[1].first.mass = -1;
  wrong[2].first.density = -1;
  wrong[3].first.density = std::nan("");
  wrong[4].first.mass = wrong[4].first.density = 1;
  wrong[5].first.inertia = Vec3(1, 1, 5).asDiagonal();  // I1 + I2 < I3
  wrong[6].first.inertia = Vec3(1, -1, 1).asDiagonal();
  wrong[7].second = nullptr;
  wrong[8].second = half_space.get();
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    const std::string text = message(wrong[i].first, wrong[i].second);
    EXPECT_NE(text.find("ball-7"), std::string::npos) << i << ": " << text;
    EXPECT_NE(text.find("expected"), std::string::npos) << i << ": " << text;
  }
  Mat3 skew = Mat3::Identity();
  skew(0, 1) = 0.5;
  MassSpecification given;
  given.inertia = skew;
  EXPECT_NE(message(given, ball.get()).find("symmetric"), std::string::npos);
}

}  // namespace
}  // namespace tw::test
