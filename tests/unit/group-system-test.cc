// The linear systems of contact groups against central differences.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "integrate/implicit/group-system.h"
#include "integrate/standing.h"
#include "support/anchored-spring.h"

namespace tw {
namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double in(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  Vec3 vec(double size) {
    const double x = in(-size, size), y = in(-size, size), z = in(-size, size);
    return {x, y, z};
  }
  Vec3 unit() { return vec(1).normalized(); }
  Quat turn() {
    const Vec3 v = vec(3);
    return rotation_by(v);
  }

 private:
  std::mt19937_64 engine_;
};

// slides along and turns about a line, at accelerating speed
class Slide : public Trajectory {
 public:
  Pose pose(double t) const override {
    return {Vec3(0.3 * t * t, 0.2 * t, 0), rotation_by(Vec3(0, 0, 0.5 * t * t))};
  }
  Twist twist(double t) const override { return {Vec3(0.6 * t, 0.2, 0), Vec3(0, 0, t)}; }
  MotionBounds bounds(double, double to) const override {
    MotionBounds bounds;
    bounds.path = bounds.acceleration = Aabb::everywhere();
    bounds.speed = 0.6 * to + 0.2;
    bounds.turn = to;
    bounds.valid_until = to;
    return bounds;
  }
};

enum class Regime { sticking, slipping, apart, deep };  // deep: where it hardens, or no more

struct Case {
  ContactFeature feature;
  FrictionLaw law;
  Regime regime;
};

GroupMember random_member(Draw& draw) {
  GroupMember m;
  m.mass = draw.in(0.5, 2);
  m.moments = Vec3(draw.in(0.1, 0.2), draw.in(0.2, 0.25), draw.in(0.15, 0.3));
  m.x = draw.vec(1);
  m.q = draw.turn();
  m.v = draw.vec(0.3);
  m.L = draw.vec(0.1);
  m.force = draw.vec(1);
  m.torque = draw.vec(0.1);
  // every other one in the wind, and on a spring to what moves
  if (draw.in(0, 1) < 0.5) {
    m.forces = with_law(with_torque(nullptr, draw.vec(0.1)), make_drag(0.3, 0.2));
    const Vec3 arm = draw.vec(0.3);
    m.forces = with_law(
        m.forces, test::spring_to(std::make_shared<Slide>(), draw.vec(0.5), arm, {20, 2, 0.4}));
  }
  return m;
}

// Semi-axes of an ellipsoid, in a body's frame.
Mat3 random_axes(Draw& draw) {
  const Vec3 semi_axes(draw.in(0.1, 0.3), draw.in(0.2, 0.5), draw.in(0.4, 0.8));
  return draw.turn().toRotationMatrix() * semi_axes.asDiagonal();
}

// Four members and two outside bodies (one moving); contacts of the kind between random pairs,
// loaded by about .02 m, in the regime by choice of mu and the velocity scale of friction, and far
// from the border between sticking and slipping, where differences see both.
GroupStart random_group(Draw& draw, const Case& kind) {
  GroupStart start;
  start.time = 1;
  start.end = 2;
  for (int i = 0; i < 4; ++i) start.members.push_back(random_member(draw));
  const Vec3 place = draw.vec(1);
  start.outside = {make_standing({place, draw.turn()}), std::make_shared<Slide>()};
  const int pairs[][2] = {{-1, 0}, {0, 1}, {1, -2}, {2, 1}, {2, 0}, {3, -2}, {0, 3}};
  for (const auto& pair : pairs) {
    GroupContact c;
    c.a = pair[0];
    c.b = pair[1];
    c.feature = kind.feature;
    c.normal = draw.unit();
    c.direction = draw.unit();
    c.point_b = draw.vec(0.5);
    c.radius_b = draw.in(0.05, 0.2);
    c.radius_a = draw.in(0.05, 0.2);
    c.law.k = draw.in(50, 100);
    c.law.hardening = kind.regime == Regime::deep ? 0.0015 : 0.03;
    c.law.b = 0.2;
    c.law.size = 0.5;
    c.law.kt = 0.8 * c.law.k;
    c.law.ct = draw.in(5, 10);
    const bool sticks =
        kind.regime == Regime::sticking || (kind.regime == Regime::deep && draw.in(0, 1) < 0.5);
    c.law.mu = sticks ? 1000 : 0.04;
    c.law.law = kind.law;
    // as deep as the springs of friction still harden, or not
    if (kind.regime == Regime::deep && draw.in(0, 1) < 0.5) c.law.hardening = 0.006;
    const bool flat =
        c.feature == ContactFeature::plane || c.feature == ContactFeature::tangent_plane;
    // held, or cut to what the lengths allow
    if (pair[0] % 2 == 0) {
      c.law.rolling = kind.regime == Regime::sticking ? 20 : 0.02;
      c.law.spinning = kind.regime == Regime::slipping ? 0.01 : 10;
      c.bend = draw.vec(0.3);
    }
    c.share = 0.5;
    c.stretch = draw.vec(0.01);

    // the reference point that gives the wanted gap
    const auto pose = [&](int body) {
      if (body < 0) return start.outside[static_cast<std::size_t>(~body)]->pose(start.time);
      const GroupMember& m = start.members[static_cast<std::size_t>(body)];
      return Pose{m.x, m.q};
    };
    const Pose a = pose(c.a), b = pose(c.b);
    const double gap = kind.regime == Regime::apart ? 0.02 : -0.02;
    const Vec3 core = b.q * c.point_b + b.p;
    Vec3 n = c.normal;
    if (c.feature == ContactFeature::line)
      n = Vec3(n - n.dot(c.direction) * c.direction).normalized();
    if (c.feature == ContactFeature::crossing) {
      // b's line in a's frame, from 30 to 150 degrees off a's; a point of it that is not nearest
      const Vec3 beside = c.direction.unitOrthogonal();
      const double angle = draw.in(pi / 6, 5 * pi / 6);
      const Vec3 other = std::cos(angle) * c.direction + std::sin(angle) * beside;
      n = c.direction.cross(other).normalized();
      c.other_direction = b.q.conjugate() * (a.q * other);
    }
    // the centre of b's circle in the place of the core point, so that the core point lies on it
    Vec3 center = c.point_b;
    if (c.feature == ContactFeature::rim) {
      const Vec3 tangent =
          std::cos(0.4) * c.direction.unitOrthogonal() + std::sin(0.4) * c.direction;
      n = c.direction.cross(tangent).normalized();
      const Vec3 beside = tangent.cross(n);
      const double angle = draw.in(0.3, 1.2);
      const Vec3 inward = std::cos(angle) * n + std::sin(angle) * beside;
      c.rim = draw.in(0.3, 0.6);
      c.other_direction = b.q.conjugate() * (a.q * inward.cross(tangent));
      center += b.q.conjugate() * (a.q * (c.rim * inward));
    }
    // the centres of ellipsoids where their points farthest along n are the core points
    Vec3 farthest_a = Vec3::Zero();
    const auto farthest = [](const Mat3& A, const Vec3& m) {
      return Vec3(A * (A.transpose() * m).normalized());
    };
    if (rolls(c.feature)) {
      const bool curved = c.feature == ContactFeature::curved;
      // a line, a ball or an ellipsoid
      const int shown = !curved ? -1 : draw.in(0, 3) < 1 ? 0 : draw.in(0, 2) < 1 ? 1 : 2;
      if (shown == 0) n = Vec3(n - n.dot(c.direction) * c.direction).normalized();
      if (shown > 0) c.direction.setZero();
      ContactEllipsoids ellipsoids;
      ellipsoids.b = random_axes(draw);
      center += farthest(ellipsoids.b, b.q.conjugate() * (a.q * n));
      if (shown == 2) {
        ellipsoids.a = random_axes(draw);
        farthest_a = farthest(ellipsoids.a, n);
      }
      c.ellipsoids = std::make_shared<ContactEllipsoids>(ellipsoids);
      if (!curved) c.radius_a = c.radius_b = 0;
    }
    c.normal = n;
    const double radii = c.radius_b + (c.feature == ContactFeature::plane ? 0 : c.radius_a);
    c.point_a = a.q.conjugate() * (core - a.p) - (gap + radii) * n - farthest_a;
    if (c.feature == ContactFeature::line) c.point_a += 0.3 * c.direction;
    if (c.feature == ContactFeature::rim) {
      c.point_a += 0.3 * c.direction;
      c.point_b = center;
    }
    if (rolls(c.feature)) c.point_b = center;
    if (c.feature == ContactFeature::crossing) {
      c.point_a += 0.3 * c.direction;
      c.point_b += 0.2 * c.other_direction;
    }
    if (flat) c.stretch -= n * n.dot(c.stretch);
    start.contacts.push_back(c);
  }
  // a spring, and a hold between two that are in contact, too
  for (const auto& [a, b] : {std::pair{3, 1}, std::pair{2, 0}}) {
    Bond bond;
    bond.arm_a = draw.vec(0.3);
    bond.arm_b = draw.vec(0.3);
    bond.spring = {40, 3, a == 3 ? 0.5 : 0};
    bond.holds = a == 2;
    if (bond.holds) bond.turn = {6, 0.5, draw.turn()};
    start.bonds.push_back({a, b, std::make_shared<Bond>(bond)});
  }
  return start;
}

struct Bench {
  explicit Bench(const GroupStart& start) : system(start) {
    const std::size_t slots = static_cast<std::size_t>(system.contact_packs().slots);
    scratch.members.resize(static_cast<std::size_t>(system.members()));
    scratch.bodies.resize(slots);
    scratch.changes.resize(slots);
    scratch.wrenches.resize(slots);
    scratch.linear.resize(static_cast<std::size_t>(system.packs()));
    scratch.sides.resize(static_cast<std::size_t>(system.packs()));
    scratch.right_side.resize(6 * start.members.size());
    system.set_outside(start.time, scratch);
    y.resize(static_cast<Eigen::Index>(system.size()));
    y.setZero();
    Eigen::Index at = 0;
    for (const GroupMember& m : start.members) {
      y.segment<3>(at) = m.x;
      y.segment<3>(at + 6) = m.v;
      y.segment<3>(at + 9) = m.L;
      at += 12;
    }
    for (const ContactPack& pack : system.contact_packs().packs)
      for (int axis = 0; axis < 3; ++axis)
        for (int lane = 0; lane < lane_count; ++lane, ++at)
          if (pack.contact[lane] >= 0)
            y[at] = start.contacts[static_cast<std::size_t>(pack.contact[lane])].stretch[axis];
    for (const ContactPack& pack : system.contact_packs().packs)
      if (pack.bend >= 0)
        for (int axis = 0; axis < 3; ++axis)
          for (int lane = 0; lane < lane_count; ++lane, ++at)
            if (pack.contact[lane] >= 0)
              y[at] = start.contacts[static_cast<std::size_t>(pack.contact[lane])].bend[axis];
  }
  Eigen::VectorXd slope(double time, const Eigen::VectorXd& state) {
    Eigen::VectorXd f(state.size());
    system.evaluate(time, state.data(), scratch, f.data());
    return f;
  }
  GroupSystem system;
  GroupScratch scratch;
  Eigen::VectorXd y;
};

Eigen::MatrixXd differences(Bench& bench, double time) {
  const Eigen::Index size = bench.y.size();
  Eigen::MatrixXd J(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    // fourth order
    const double d = bench.system.packs() > 0 ? 1e-5 : 1e-4;
    Eigen::VectorXd y = bench.y;
    const auto at = [&](double by) {
      y[j] = bench.y[j] + by * d;
      return bench.slope(time, y);
    };
    J.col(j) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * d);
  }
  return J;
}

// the worst residual of (sigma - J) k = r, J by differences, over the largest entry that takes part
double worst_residual(const GroupStart& start, Draw& draw, double sigma) {
  Bench bench(start);
  Eigen::VectorXd f(bench.y.size());
  bench.system.linearise(start.time, bench.y.data(), bench.scratch, f.data());
  // the normals that linearise leaves begin the search for the point of a rim and of what is
  // curved, whose last bits follow
  const ContactFeature feature = start.contacts.front().feature;
  const bool searched = feature == ContactFeature::rim || feature == ContactFeature::curved;
  EXPECT_LE((f - bench.slope(start.time, bench.y)).norm(), searched ? 1e-11 : 0);
  const Eigen::MatrixXd J = differences(bench, start.time);
  EXPECT_TRUE(bench.system.factor(sigma, bench.scratch));
  double worst = 0;
  for (int i = 0; i < 4; ++i) {
    Eigen::VectorXd r(bench.y.size());
    for (Eigen::Index j = 0; j < r.size(); ++j) r[j] = draw.in(-1, 1);
    // smooth contacts have no stretches
    if (start.contacts.front().law.law == FrictionLaw::smooth)
      r.segment(12 * bench.system.members(), 12 * bench.system.packs()).setZero();
    Eigen::VectorXd k = r;
    bench.system.solve(bench.scratch, k.data());
    const Eigen::VectorXd residual = sigma * k - J * k - r;
    const double scale = (J.cwiseAbs() * k.cwiseAbs()).maxCoeff() + r.cwiseAbs().maxCoeff();
    worst = std::max(worst, residual.cwiseAbs().maxCoeff() / scale);
  }
  return worst;
}

class GroupSystemTest : public testing::TestWithParam<Case> {};

TEST_P(GroupSystemTest, stage_solution_satisfies_the_differenced_jacobian_to_1e_8) {
  Draw draw(7);
  for (int i = 0; i < 20; ++i) {
    const GroupStart start = random_group(draw, GetParam());
    EXPECT_LT(worst_residual(start, draw, 30), 1e-8) << "case " << i;
    EXPECT_LT(worst_residual(start, draw, 3000), 1e-8) << "case " << i;
  }
}

TEST_P(GroupSystemTest, time_slope_is_that_of_the_outside_motion_to_1e_6) {
  Draw draw(8);
  for (int i = 0; i < 20; ++i) {
    const GroupStart start = random_group(draw, GetParam());
    Bench bench(start);
    Eigen::VectorXd f(bench.y.size()), slope(bench.y.size());
    bench.system.linearise(start.time, bench.y.data(), bench.scratch, f.data());
    bench.system.set_time_slope(start.time, 0.01, bench.y.data(), f.data(), bench.scratch,
                                slope.data());
    const double d = 1e-5;
    const Eigen::VectorXd expected =
        (bench.slope(start.time + d, bench.y) - bench.slope(start.time - d, bench.y)) / (2 * d);
    EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(),
              1e-6 * (1 + expected.cwiseAbs().maxCoeff()));
  }
}

// Of ten contacts every third presses at the start.
TEST(ContactPacks, hold_what_presses_apart_from_what_is_open) {
  GroupStart start;
  start.members.resize(10);
  for (int i = 0; i < 10; ++i) {
    GroupContact contact;
    contact.a = -1;
    contact.b = i;
    contact.pressed = i % 3 == 0;
    start.contacts.push_back(contact);
  }
  start.outside.push_back(make_standing({Vec3::Zero(), Quat::Identity()}));
  const ContactPacks packs = make_contact_packs(start);
  ASSERT_EQ(packs.packs.size(), 3u);
  for (const ContactPack& pack : packs.packs)
    for (int i = 0; i < pack.count; ++i)
      EXPECT_EQ(pack.contact[i] % 3 == 0, &pack == &packs.packs.front());
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_EQ(
        packs.packs[static_cast<std::size_t>(packs.places[i].pack)].contact[packs.places[i].lane],
        static_cast<int>(i));
}

constexpr ContactFeature features[] = {ContactFeature::plane, ContactFeature::line,
                                       ContactFeature::point, ContactFeature::crossing,
                                       ContactFeature::rim,   ContactFeature::tangent_plane,
                                       ContactFeature::curved};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const ContactFeature feature : features) {
    for (const Regime regime : {Regime::sticking, Regime::slipping, Regime::apart, Regime::deep})
      cases.push_back({feature, FrictionLaw::anchored, regime});
    cases.push_back({feature, FrictionLaw::smooth, Regime::slipping});
    cases.push_back({feature, FrictionLaw::smooth, Regime::apart});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(AllLaws, GroupSystemTest, testing::ValuesIn(all_cases()));

}  // namespace
}  // namespace tw
