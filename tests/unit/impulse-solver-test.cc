// Several contacts at once: closed forms, conservation, the limit, and bodies joined to others.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impulse-solver.h"
#include "unit/impulse-energy.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace tw {
namespace {

using test::energy;

ImpulseSlot ball(double mass, double radius, const Vec3& x, const Vec3& v,
                 const Vec3& w = Vec3::Zero()) {
  ImpulseSlot slot{x, v, w};
  slot.inverse_mass = 1 / mass;
  slot.inverse_inertia = Mat3::Identity() / (0.4 * mass * radius * radius);
  slot.answer = Answer::free;
  return slot;
}

ImpulseSlot ground() { return {}; }

Vec3 momentum(const ImpulseSolver& solver) {
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < solver.slot_count(); ++i)
    if (solver.slot(i).moves()) sum += solver.slot(i).v / solver.slot(i).inverse_mass;
  return sum;
}

// about the origin
Vec3 angular_momentum(const ImpulseSolver& solver) {
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < solver.slot_count(); ++i) {
    const ImpulseSlot& s = solver.slot(i);
    if (s.moves()) sum += s.inverse_inertia.inverse() * s.w + s.x.cross(s.v) / s.inverse_mass;
  }
  return sum;
}

// A row of balls along x, each touching the next.
struct Row {
  ImpulseSolver solver;
  std::vector<ImpulseContact> contacts;
  Row(const std::vector<double>& masses, double first_speed, double restitution) {
    for (std::size_t i = 0; i < masses.size(); ++i)
      solver.add(ball(masses[i], 0.5, Vec3(static_cast<double>(i), 0, 0),
                      Vec3(i == 0 ? first_speed : 0, 0, 0)));
    for (std::uint32_t i = 0; i + 1 < masses.size(); ++i)
      contacts.push_back({i, i + 1, Vec3::UnitX(), Vec3(i + 0.5, 0, 0), restitution, 0});
  }
};

TEST(ImpulseSolver, a_ball_leaves_the_ground_with_its_restitution) {
  ImpulseSolver solver;
  const auto plane = solver.add(ground());
  const auto sphere = solver.add(ball(3, 0.5, Vec3(0, 0, 0.5), Vec3(0, 0, -4)));
  const ImpulseContact c{plane, sphere, Vec3::UnitZ(), Vec3::Zero(), 0.75, 0};
  const ImpulseResult result = solver.solve(std::span(&c, 1), 0, 10);
  EXPECT_EQ(result.impulses, 1);
  EXPECT_EQ(result.left_over, 0);
  EXPECT_NEAR((solver.slot(sphere).v - Vec3(0, 0, 3)).norm(), 0, 1e-15);
  EXPECT_NEAR(solver.normal_impulse(), 3 * 7, 1e-14);
  EXPECT_EQ(solver.largest_approach(), 4);
  EXPECT_EQ(solver.largest().point, c.point);
}

// v' = 5/7 v where it comes to roll; v' = v - mu (1+e) vn where it slides on
TEST(ImpulseSolver, friction_rolls_a_ball_or_slides_it_on_the_cone) {
  for (const double friction : {1.0, 0.1}) {
    ImpulseSolver solver;
    const auto plane = solver.add(ground());
    const auto sphere = solver.add(ball(3, 0.5, Vec3(0, 0, 0.5), Vec3(2, 0, -1)));
    const ImpulseContact c{plane, sphere, Vec3::UnitZ(), Vec3::Zero(), 0.5, friction};
    solver.solve(std::span(&c, 1), 0, 10);
    const double along = friction == 1.0 ? 2 * 5.0 / 7 : 2 - 0.1 * 1.5 * 1;
    EXPECT_NEAR((solver.slot(sphere).v - Vec3(along, 0, 0.5)).norm(), 0, 1e-14);
    if (friction == 1.0) {
      EXPECT_NEAR(solver.slot(sphere).w.y(), along / 0.5, 1e-14);
    }
  }
}

TEST(ImpulseSolver, a_row_of_equal_balls_hands_its_speed_to_the_last) {
  Row row(std::vector<double>(7, 2.0), 3, 1);
  const ImpulseResult result = row.solver.solve(row.contacts, 0, 100);
  EXPECT_EQ(result.impulses, 6);
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_NEAR(row.solver.slot(i).v.x(), 0, 1e-15);
  EXPECT_NEAR(row.solver.slot(6).v.x(), 3, 1e-14);
}

// from one to the next 2 m_i / (m_i + m_i+1); each lighter than the last, so nothing comes back
TEST(ImpulseSolver, a_row_of_ever_lighter_balls_whips) {
  const std::vector<double> masses{8, 4, 2, 1};
  Row row(masses, 1, 1);
  row.solver.solve(row.contacts, 0, 100);
  double speed = 1;
  for (std::size_t i = 0; i + 1 < masses.size(); ++i)
    speed *= 2 * masses[i] / (masses[i] + masses[i + 1]);
  EXPECT_NEAR(row.solver.slot(3).v.x(), speed, 1e-14);
}

TEST(ImpulseSolver, without_restitution_a_row_goes_on_together) {
  Row row({1, 2, 3}, 6, 0);
  const ImpulseResult result = row.solver.solve(row.contacts, 1e-12, 200);
  EXPECT_EQ(result.left_over, 0);
  EXPECT_GT(result.impulses, 10);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_NEAR(row.solver.slot(i).v.x(), 1, 1e-11);
}

TEST(ImpulseSolver, impulses_keep_the_momentum_and_never_add_energy) {
  for (const double restitution : {0.0, 0.6, 1.0}) {
    // four balls of a tetrahedron that fly together, spinning
    ImpulseSolver solver;
    const Vec3 corners[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const double radius = std::sqrt(2.0);
    for (int i = 0; i < 4; ++i)
      solver.add(ball(1 + i, radius, corners[i], -0.3 * (i + 1) * corners[i],
                      Vec3(0.2 * i, 0.1, -0.3 * i)));
    std::vector<ImpulseContact> contacts;
    for (std::uint32_t a = 0; a < 4; ++a)
      for (std::uint32_t b = a + 1; b < 4; ++b)
        contacts.push_back({a, b, (corners[b] - corners[a]).normalized(),
                            0.5 * (corners[a] + corners[b]), restitution, 0.4});
    const Vec3 p = momentum(solver), L = angular_momentum(solver);
    double least = energy(solver);
    for (int i = 0; i < 100; ++i) {
      const ImpulseResult one = solver.solve(contacts, 1e-12, 1);
      EXPECT_LE(energy(solver), least + 1e-14);
      least = std::min(least, energy(solver));
      if (one.impulses == 0) break;
    }
    for (const ImpulseContact& c : contacts) EXPECT_GE(solver.approach(c), -1e-12);
    EXPECT_NEAR((momentum(solver) - p).norm(), 0, 1e-14);
    EXPECT_NEAR((angular_momentum(solver) - L).norm(), 0, 1e-14);
  }
}

// A ball as heavy as may be moves the other as a held one does, which counts the work it does.
TEST(ImpulseSolver, a_held_body_is_one_without_end_of_mass) {
  const auto bounce = [](const ImpulseSlot& wall) {
    ImpulseSolver solver;
    const auto a = solver.add(wall), b = solver.add(ball(2, 0.5, Vec3(0.5, 0, 0), Vec3(-1, 3, 0)));
    const ImpulseContact c{a, b, Vec3::UnitX(), Vec3::Zero(), 0.8, 0.2};
    const double before = energy(solver);
    solver.solve(std::span(&c, 1), 0, 1);
    EXPECT_NEAR((solver.slot(a).v - wall.v).norm(), 0, 1e-100);
    if (wall.answer == Answer::held) {
      EXPECT_LT(energy(solver) - before, solver.work_of_held());
    }
    return solver;
  };
  ImpulseSlot held;
  held.v = Vec3(2, 0, 0);
  const ImpulseSolver with_held = bounce(held);
  const ImpulseSolver with_heavy = bounce(ball(1e300, 1, Vec3::Zero(), held.v));
  EXPECT_NEAR((with_held.slot(1).v - with_heavy.slot(1).v).norm(), 0, 1e-15);
  EXPECT_NEAR((with_held.slot(1).w - with_heavy.slot(1).w).norm(), 0, 1e-15);
  // m (1+e) (approach of 3) at 2 m/s
  EXPECT_NEAR(with_held.work_of_held(), 2 * 1.8 * 3 * 2, 1e-13);
  EXPECT_EQ(with_heavy.work_of_held(), 0);
}

TEST(ImpulseSolver, what_a_contact_bears_gets_no_impulse) {
  Row row({1, 1, 1}, 1, 0);
  for (ImpulseContact& c : row.contacts) c.bears = 0.6;
  // 1, 0, 0 -> 1/2, 1/2, 0: neither pair approaches faster than it bears
  EXPECT_EQ(row.solver.solve(row.contacts, 0, 100).impulses, 1);
  EXPECT_EQ(row.solver.slot(1).v.x(), 0.5);
  EXPECT_EQ(row.solver.slot(2).v.x(), 0);
}

TEST(ImpulseSolver, of_equally_bad_contacts_the_first_comes_first) {
  for (const bool swapped : {false, true}) {
    // both neighbours fly at the middle one
    ImpulseSolver solver;
    for (int i = 0; i < 3; ++i) solver.add(ball(1, 0.5, Vec3(i, 0, 0), Vec3(1 - i, 0, 0)));
    std::vector<ImpulseContact> contacts{{0, 1, Vec3::UnitX(), Vec3(0.5, 0, 0), 0, 0},
                                         {1, 2, Vec3::UnitX(), Vec3(1.5, 0, 0), 0, 0}};
    if (swapped) std::swap(contacts[0], contacts[1]);
    solver.solve(contacts, 0, 1);
    EXPECT_EQ(solver.slot(swapped ? 2 : 0).v.x(), swapped ? -0.5 : 0.5);
    EXPECT_EQ(solver.slot(swapped ? 0 : 2).v.x(), swapped ? 1 : -1);
  }
}

TEST(ImpulseSolver, what_the_limit_leaves_over_is_told) {
  for (const int most : {0, 5, 6}) {
    Row row(std::vector<double>(7, 1.0), 3, 1);
    const ImpulseResult result = row.solver.solve(row.contacts, 0, most);
    EXPECT_EQ(result.impulses, most);
    EXPECT_EQ(result.left_over, most == 6 ? 0 : 3);
    EXPECT_EQ(result.stopped_at, nullptr);
  }
}

TEST(ImpulseSolver, it_stops_before_an_impulse_on_a_border) {
  Row row({1, 1}, 1, 0);
  const auto at_border = row.solver.add(ImpulseSlot::border({Vec3(2, 0, 0)}));
  row.contacts.push_back({1, at_border, Vec3::UnitX(), Vec3(1.5, 0, 0), 0, 0});
  const ImpulseResult result = row.solver.solve(row.contacts, 0, 100);
  EXPECT_EQ(result.impulses, 1);
  EXPECT_EQ(result.stopped_at, &row.contacts.back());
  EXPECT_EQ(row.solver.slot(1).v.x(), 0.5);
  EXPECT_EQ(row.solver.slot(at_border).v.x(), 0);
}

TEST(ImpulseSolver, blocks_of_a_free_body_say_the_same_as_its_mass) {
  const auto strike = [](bool by_blocks) {
    ImpulseSolver solver;
    const auto plane = solver.add(ground());
    ImpulseSlot slot = ball(3, 0.5, Vec3(0.1, 0.2, 0.6), Vec3(1, 2, -3), Vec3(4, 5, 6));
    slot.inverse_inertia(0, 1) = slot.inverse_inertia(1, 0) = 0.3;
    const auto body = solver.add(slot);
    if (by_blocks) {
      Mat6 Y = Mat6::Zero();
      Y.topLeftCorner<3, 3>() = slot.inverse_mass * Mat3::Identity();
      Y.bottomRightCorner<3, 3>() = slot.inverse_inertia;
      solver.join(body, body, Y);
    }
    const ImpulseContact c{plane, body, Vec3::UnitZ(), Vec3(0.3, -0.1, 0), 0.4, 0.3};
    solver.solve(std::span(&c, 1), 0, 1);
    Vec6 twist;
    twist << solver.slot(body).v, solver.slot(body).w;
    return twist;
  };
  EXPECT_NEAR((strike(true) - strike(false)).norm(), 0, 1e-13);
}

// A massless lever turns about z through the origin, with m1 at (-l1, 0, 0) and m2 at (l2, 0, 0).
// One coordinate, the rate r: v1 = -l1 r, v2 = l2 r along y, and I r' = -l1 P1 + l2 P2: so
//   Y_11 = l1^2/I, Y_12 = Y_21 = -l1 l2/I, Y_22 = l2^2/I,  I = m1 l1^2 + m2 l2^2, all in (y, y).
struct Lever {
  double m1 = 2, m2 = 3, l1 = 1, l2 = 0.5;
  double I = m1 * l1 * l1 + m2 * l2 * l2;
  ImpulseSolver solver;
  std::uint32_t end1, end2;
  explicit Lever(double rate) {
    end1 = solver.add({Vec3(-l1, 0, 0), Vec3(0, -l1 * rate, 0)});
    end2 = solver.add({Vec3(l2, 0, 0), Vec3(0, l2 * rate, 0)});
    const auto block = [](double yy) {
      Mat6 Y = Mat6::Zero();
      Y(1, 1) = yy;
      return Y;
    };
    solver.join(end1, end1, block(l1 * l1 / I));
    solver.join(end1, end2, block(-l1 * l2 / I));
    solver.join(end2, end1, block(-l1 * l2 / I));
    solver.join(end2, end2, block(l2 * l2 / I));
  }
  double rate() const { return solver.slot(end2).v.y() / l2; }
};

// a ball falls on one end: two masses, m and I/l1^2, that meet along y
TEST(ImpulseSolver, a_ball_on_a_lever_meets_the_mass_of_both_its_ends) {
  Lever lever(0.25);
  const double m = 1.5, e = 0.6, M = lever.I / (lever.l1 * lever.l1);
  const Vec3 end(-lever.l1, 0, 0);
  const auto falling = lever.solver.add(ball(m, 0.2, end + Vec3(0, 0.2, 0), Vec3(0, -2, 0)));
  const ImpulseContact c{lever.end1, falling, Vec3::UnitY(), end, e, 0};
  lever.solver.solve(std::span(&c, 1), 0, 1);
  const double v = -2, V = -0.25 * lever.l1;
  const double P = (1 + e) * (V - v) * m * M / (m + M);
  EXPECT_NEAR(lever.solver.slot(falling).v.y(), v + P / m, 1e-14);
  EXPECT_NEAR(lever.solver.slot(lever.end1).v.y(), V - P / M, 1e-14);
  // the other end goes up, by the ratio of the arms
  EXPECT_NEAR(lever.solver.slot(lever.end2).v.y(), -(V - P / M) * lever.l2 / lever.l1, 1e-14);
}

// one ball comes from above on each end, the impulse on the one throws the other
TEST(ImpulseSolver, impulses_on_both_ends_of_a_lever_reach_each_other) {
  Lever lever(0);
  const Vec3 end1(-lever.l1, 0, 0), end2(lever.l2, 0, 0);
  const auto on1 = lever.solver.add(ball(4, 0.2, end1 + Vec3(0, 0.2, 0), Vec3(0, -3, 0)));
  const auto on2 = lever.solver.add(ball(1, 0.2, end2 + Vec3(0, 0.2, 0), Vec3(0, -1, 0)));
  const std::vector<ImpulseContact> contacts{{lever.end1, on1, Vec3::UnitY(), end1, 0, 0},
                                             {lever.end2, on2, Vec3::UnitY(), end2, 0, 0}};
  const ImpulseResult result = lever.solver.solve(contacts, 1e-13, 1000);
  EXPECT_EQ(result.left_over, 0);
  // without restitution both stay on: (I + 4 l1^2 + 1 l2^2) r = 4 * 3 l1 - 1 * 1 l2
  const double rate = (4 * 3 * lever.l1 - 1 * 1 * lever.l2) /
                      (lever.I + 4 * lever.l1 * lever.l1 + lever.l2 * lever.l2);
  EXPECT_NEAR(lever.rate(), rate, 1e-12);
  EXPECT_NEAR(lever.solver.slot(on1).v.y(), -lever.l1 * rate, 1e-12);
  EXPECT_NEAR(lever.solver.slot(on2).v.y(), lever.l2 * rate, 1e-12);
}

// Two carriages on one rail along x, which carries them both (mass as of one body across): what
// they do to each other along the rail is what two free ones would, and the rail feels nothing.
TEST(ImpulseSolver, joined_bodies_may_strike_each_other) {
  const double m1 = 2, m2 = 3, e = 0.5;
  ImpulseSolver solver;
  const auto one = solver.add({Vec3::Zero(), Vec3(4, 1, 0)});
  const auto two = solver.add({Vec3(1, 0, 0), Vec3(-1, 1, 0)});
  const auto block = [&](double along) {
    Mat6 Y = Mat6::Zero();
    Y.diagonal().head<3>() = Vec3(along, 1 / (m1 + m2), 1 / (m1 + m2));
    return Y;
  };
  solver.join(one, one, block(1 / m1));
  solver.join(two, two, block(1 / m2));
  solver.join(one, two, block(0));
  solver.join(two, one, block(0));
  const ImpulseContact c{one, two, Vec3::UnitX(), Vec3(0.5, 0, 0), e, 0};
  EXPECT_EQ(solver.solve(std::span(&c, 1), 0, 10).impulses, 1);
  const double P = (1 + e) * 5 * m1 * m2 / (m1 + m2);
  EXPECT_NEAR((solver.slot(one).v - Vec3(4 - P / m1, 1, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((solver.slot(two).v - Vec3(-1 + P / m2, 1, 0)).norm(), 0, 1e-14);
}

// Two rods with a ball joint between their ends: their compliance is M^-1 less what the joint
// holds, Y = W - W J^T (J W J^T)^-1 J W.  The joint stays closed, and a ball that strikes one of
// them without loss takes with it just what momentum and energy allow.
TEST(ImpulseSolver, rods_with_a_joint_between_them_keep_it_closed) {
  const double mass = 2;
  const Vec3 moments(0.1, 1.2, 1.3);  // along x and across
  using Mat12 = Eigen::Matrix<double, 12, 12>;
  Mat12 M = Mat12::Zero();
  for (const int i : {0, 6}) {
    M.diagonal().segment<3>(i).setConstant(mass);
    M.diagonal().segment<3>(i + 3) = moments;
  }
  const Vec3 centres[] = {{-1, 0, 0}, {1, 0, 0}};  // the joint is at the origin
  Eigen::Matrix<double, 3, 12> J;
  J << Mat3::Identity(), cross_matrix(centres[0]), -Mat3::Identity(), -cross_matrix(centres[1]);
  const Mat12 W = M.inverse();
  const Mat12 Y = W - W * J.transpose() * (J * W * J.transpose()).inverse() * J * W;

  ImpulseSolver solver;
  for (const Vec3& x : centres) solver.add({x, Vec3::Zero()});
  for (std::uint32_t i : {0u, 1u})
    for (std::uint32_t j : {0u, 1u}) solver.join(i, j, Y.block<6, 6>(6 * i, 6 * j));
  const Vec3 at(1.6, 0.1, 0);
  const auto flying = solver.add(ball(1, 0.3, at + Vec3(0, 0.3, 0), Vec3(1, -5, 2)));
  const ImpulseContact c{1, flying, Vec3::UnitY(), at, 1, 0};
  const double flew = 0.5 * solver.slot(flying).v.squaredNorm();
  EXPECT_EQ(solver.solve(std::span(&c, 1), 0, 10).impulses, 1);

  EXPECT_NEAR(solver.approach(c), 5, 1e-13);
  Eigen::Matrix<double, 12, 1> u;
  u << solver.slot(0).v, solver.slot(0).w, solver.slot(1).v, solver.slot(1).w;
  EXPECT_GT(solver.slot(0).v.norm(), 0.01);  // the other rod is thrown
  EXPECT_NEAR((J * u).norm(), 0, 1e-13);
  EXPECT_NEAR(
      (mass * (solver.slot(0).v + solver.slot(1).v) + solver.slot(flying).v - Vec3(1, -5, 2))
          .norm(),
      0, 1e-13);
  EXPECT_NEAR(0.5 * u.dot(M * u) + 0.5 * solver.slot(flying).v.squaredNorm(), flew, 1e-12);
}

// A heavy ball comes down on a light one on the floor: n impulses leave ((M - m)/(M + m))^n of the
// speed, settled it stands still, and each contact has got what stops it.
TEST(ImpulseSolver, what_is_left_over_is_settled_at_once) {
  for (const double heavy : {1e3, 1e6, 1e9}) {
    ImpulseSolver solver;
    solver.add(ground());
    solver.add(ball(1, 0.5, Vec3(0, 0, 0.5), Vec3::Zero()));
    solver.add(ball(heavy, 0.5, Vec3(0, 0, 1.5), Vec3(0, 0, -2)));
    const ImpulseContact contacts[] = {{0, 1, Vec3::UnitZ(), Vec3::Zero(), 0, 0.3},
                                       {1, 2, Vec3::UnitZ(), Vec3(0, 0, 1), 0, 0.3}};
    EXPECT_GT(solver.solve(contacts, 0, 100).left_over, 0);
    const ImpulseResult result = solver.settle(contacts);
    EXPECT_EQ(result.left_over, 0);
    EXPECT_EQ(result.stopped_at, nullptr);
    for (const std::uint32_t i : {1u, 2u}) EXPECT_NEAR(solver.slot(i).v.norm(), 0, 2e-6);
    EXPECT_NEAR(solver.normal_impulse(), 4 * heavy, 2e-6 * heavy);
  }
}

// What is borne is left, what parts is not pulled, and momentum and energy are as they must be.
TEST(ImpulseSolver, settling_leaves_the_least_energy) {
  ImpulseSolver solver;
  for (int i = 0; i < 4; ++i)
    solver.add(ball(std::pow(10, i), 0.5, Vec3(i, 0.1 * i * i, 0), Vec3(3 - i, 0.2 * i, 0)));
  solver.add(ball(1, 0.5, Vec3(4, 1.6, 0), Vec3(5, 0, 0)));
  std::vector<ImpulseContact> contacts;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Vec3 way = solver.slot(i + 1).x - solver.slot(i).x;
    contacts.push_back({i, i + 1, way.normalized(), solver.slot(i).x + 0.5 * way, 0, 0, 0.01});
  }
  const Vec3 p = momentum(solver), L = angular_momentum(solver);
  const double before = energy(solver);
  EXPECT_EQ(solver.settle(contacts).left_over, 0);
  EXPECT_NEAR((momentum(solver) - p).norm(), 0, 1e-11 * p.norm());
  EXPECT_NEAR((angular_momentum(solver) - L).norm(), 0, 1e-11 * L.norm());
  EXPECT_LT(energy(solver), before);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(solver.approach(contacts[i]), -0.01, 1e-7) << i;
  EXPECT_GT(solver.approach(contacts[3]), 1);
}

TEST(ImpulseSolver, does_not_settle_between_walls_that_come_together) {
  ImpulseSolver solver;
  solver.add({Vec3::Zero(), Vec3(1, 0, 0)});
  solver.add(ball(1, 0.5, Vec3(0.5, 0, 0), Vec3::Zero()));
  solver.add({Vec3(1, 0, 0), Vec3(-1, 0, 0)});
  const ImpulseContact contacts[] = {{0, 1, Vec3::UnitX(), Vec3::Zero()},
                                     {1, 2, Vec3::UnitX(), Vec3(1, 0, 0)}};
  EXPECT_EQ(solver.settle(contacts).left_over, 1);
  EXPECT_EQ(solver.slot(1).v, Vec3::Zero());
}

TEST(ImpulseSolver, settling_stops_at_a_border) {
  ImpulseSolver solver;
  solver.add(ImpulseSlot::border({}));
  solver.add(ball(1, 0.5, Vec3(0.5, 0, 0), Vec3::Zero()));
  solver.add(ball(1, 0.5, Vec3(1.5, 0, 0), Vec3(-1, 0, 0)));
  const ImpulseContact contacts[] = {{0, 1, Vec3::UnitX(), Vec3::Zero()},
                                     {1, 2, Vec3::UnitX(), Vec3(1, 0, 0)}};
  const ImpulseResult result = solver.settle(contacts);
  EXPECT_EQ(result.stopped_at, &contacts[0]);
}

}  // namespace
}  // namespace tw
