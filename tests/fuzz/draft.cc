// Units, shapes and pits of random scenes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/draft.h"

#include "base/constants.h"
#include "base/hash.h"

namespace tw::fuzz {
namespace {

std::uint64_t stream_of(const std::string& kind, std::uint64_t seed) {
  Hasher hasher;
  for (const char letter : kind) hasher.add(static_cast<std::uint64_t>(letter));
  hasher.add(seed);
  return hasher.value();
}

}  // namespace

Draft::Draft(const std::string& kind, std::uint64_t seed) : random(stream_of(kind, seed)) {
  scene.kind = kind;
  scene.seed = seed;
  scene.size = size = log_uniform(1e-4, 1e3);
  // where gravity grows with the size the time unit is that of a metre
  const double g = answer::standard_gravity * (chance(0.25) ? size : 1);
  scene.gravity = Vec3(0, 0, -g);
  speed = std::sqrt(g * size);
  scene.time_unit = time = size / speed;
  const double friction = random.real(0, 1.2), restitution = random.real();
  switch (random.below(6)) {
    case 0: scene.friction = 0; break;
    case 1: scene.friction = 2; break;
    default: scene.friction = friction;
  }
  switch (random.below(6)) {
    case 0: scene.restitution = 0; break;
    case 1: scene.restitution = 1; break;
    default: scene.restitution = restitution;
  }
  if (chance(0.125)) scene.accuracy = 1e-4;
}

int Draft::whole(int least, int most) {
  return least + static_cast<int>(random.below(static_cast<std::uint64_t>(most - least + 1)));
}

double Draft::log_uniform(double least, double most) {
  return std::exp(random.real(std::log(least), std::log(most)));
}

Vec3 Draft::vector(double most) {
  const double x = random.real(-most, most), y = random.real(-most, most);
  const double z = random.real(-most, most);
  return {x, y, z};
}

Vec3 Draft::direction() {
  for (;;) {
    const Vec3 v = vector(1);
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}

Quat Draft::attitude() {
  const Vec3 axis = direction();
  return rotation_by(random.real(0, 2 * pi) * axis);
}

std::size_t Draft::add(DescribedBody body, const std::string& name) {
  body.name = name + "-" + std::to_string(scene.bodies.size());
  scene.bodies.push_back(std::move(body));
  return scene.bodies.size() - 1;
}

std::size_t Draft::add_fixed(const Solid& solid, const Vec3& position, const Quat& orientation) {
  DescribedBody body;
  body.solids = {solid};
  body.pose = Pose{position, orientation};
  body.fixed = true;
  return add(body, "fixed");
}

DescribedBody& Draft::add_moving(std::vector<Solid> solids, const Vec3& position) {
  static const char* const names[] = {"ball",       "box",     "cylinder", "hull",
                                      "half-space", "capsule", "cone",     "ellipsoid"};
  DescribedBody body;
  body.solids = std::move(solids);
  body.pose.p = position;
  const char* const name =
      body.solids.size() > 1 ? "union" : names[static_cast<std::size_t>(body.solids.front().kind)];
  return scene.bodies[add(body, name)];
}

Solid Draft::rock(double diameter, int points) {
  std::vector<Vec3> cloud;
  for (int i = 0; i < points; ++i) {
    const Vec3 way = direction();
    cloud.push_back(0.5 * diameter * random.real(0.75, 1) * way);
  }
  return hull(cloud);
}

std::vector<Solid> Draft::union_shape(double diameter) {
  const double d = diameter;
  switch (random.below(3)) {
    case 0: {  // an L of two boxes that share a face
      const double w = random.real(0.15, 0.3) * d;
      return {placed(box({0.6 * d, w, w}), Vec3::Zero()),
              placed(box({w, w, 0.3 * d}), {0.3 * d - 0.5 * w, 0, 0.5 * w + 0.15 * d})};
    }
    case 1: {  // a dumbbell
      const double r = random.real(0.1, 0.2) * d;
      return {placed(ball(r), {0.5 * d - r, 0, 0}), placed(ball(r), {r - 0.5 * d, 0, 0}),
              placed(cylinder(0.4 * r, d - 2 * r), Vec3::Zero(), rotation_by({0, pi / 2, 0}))};
    }
    default: {  // a cross of two bars
      const double w = random.real(0.08, 0.2) * d;
      return {placed(box({0.9 * d, w, w}), Vec3::Zero()),
              placed(box({w, 0.9 * d, w}), Vec3::Zero())};
    }
  }
}

std::vector<Solid> Draft::flush_rod(double radius, double length, double& seam) {
  const double r = radius;
  seam = 0;
  switch (random.below(3)) {
    case 0:  // a bead on it
      seam = random.real(-0.5, 0.5) * length;
      return {cylinder(r, length), placed(ball(r), {0, 0, seam})};
    case 1:  // round ends
      seam = 0.5 * length;
      return {cylinder(r, length), placed(ball(r), {0, 0, seam}), placed(ball(r), {0, 0, -seam})};
    default:  // an egg
      return {cylinder(r, length), ellipsoid({2 * r, 2 * r, random.real(0.3, 0.9) * length})};
  }
}

std::vector<Solid> Draft::flush_shape(double diameter) {
  const double d = diameter, r = random.real(0.05, 0.2) * d, length = d - 2 * r;
  const auto bone = [&](double reach, double turn) {
    return placed(capsule(r, reach), rotation_by({0, 0, turn}) * Vec3(0.5 * reach, 0, 0),
                  rotation_by({0, 0, turn}) * rotation_by({0, pi / 2, 0}));
  };
  switch (random.below(4)) {
    case 0: return {bone(0.5 * length, 0), bone(0.5 * length, random.real(0.5, 3))};
    case 1: {  // a ring of bones
      const int count = whole(5, 10);
      const double turn = 2 * pi / count, middle = 0.5 * length * std::cos(0.5 * turn);
      std::vector<Solid> ring;
      for (int i = 0; i < count; ++i)
        ring.push_back(placed(capsule(r, length * std::sin(0.5 * turn)),
                              rotation_by({0, 0, i * turn}) * Vec3(middle, 0, 0),
                              rotation_by({0, 0, i * turn}) * rotation_by({pi / 2, 0, 0})));
      return ring;
    }
    case 2: {  // a bar with rounded ends
      const double high = random.real(0.5, 3) * r;
      return {box({length, 2 * r, high}), placed(cylinder(r, high), {0.5 * length, 0, 0}),
              placed(cylinder(r, high), {-0.5 * length, 0, 0})};
    }
    default: {
      double seam;
      return flush_rod(r, length, seam);
    }
  }
}

std::vector<Solid> Draft::shape(double diameter) {
  const double d = diameter;
  switch (random.below(6)) {
    case 0: {
      const double x = random.real(0.2, 1), y = random.real(0.2, 1), z = random.real(0.2, 1);
      return {box(d * Vec3(x, y, z).normalized())};
    }
    case 1: return {ball(0.5 * d * random.real(0.5, 1))};
    case 2: {
      const double angle = random.real(0.15, pi / 2 - 0.15);
      return {cylinder(0.5 * d * std::cos(angle), d * std::sin(angle))};
    }
    case 3: return {rock(d, whole(5, 8))};
    case 4: return {rock(d, whole(12, 24))};
    default: return union_shape(d);
  }
}

Solid Draft::round_shape(double diameter) {
  const double d = diameter, angle = random.real(0.15, pi / 2 - 0.15);
  switch (random.below(4)) {
    case 0: {
      const double radius = 0.5 * d * random.real(0.1, 0.9);
      return capsule(radius, d - 2 * radius);
    }
    case 1: return cone(0.5 * d * std::cos(angle), 0.75 * d * std::sin(angle));
    case 2: {
      const double y = random.real(0.2, 1), z = random.real(0.2, 1);
      return ellipsoid(d * Vec3(1, y, z));
    }
    default: return cylinder(0.5 * d * std::cos(angle), d * std::sin(angle));
  }
}

Solid Draft::thin_shape(double diameter) {
  const double d = 0.95 * diameter, ratio = log_uniform(100, 1000);
  switch (random.below(4)) {
    case 0: return box({d, d / ratio, d / ratio});
    case 1: return box({0.8 * d, 0.6 * d, d / ratio});
    case 2: return cylinder(0.5 * d / ratio, d);
    default: return cylinder(0.5 * d, d / ratio);
  }
}

void Draft::toss(DescribedBody& body, double speeds) {
  body.pose.q = attitude();
  body.velocity = vector(speeds * speed);
  body.spin = vector(speeds / time);
  if (chance(0.5)) body.density = log_uniform(100, 10000);
}

void Draft::add_pit(double half, double height) {
  const auto style = random.below(3);
  scene.room = {std::nullopt, {-half, -half, 0}, {half, half, 1e3 * height}};
  if (style == 0) {
    add_fixed(half_space(Vec3::UnitZ(), 0), Vec3::Zero());
    for (int axis = 0; axis < 2; ++axis)
      for (const double side : {-1.0, 1.0})
        add_fixed(half_space(side * Vec3::Unit(axis), -half), Vec3::Zero());
    return;
  }
  scene.room.rim = height;
  const double thick = 0.5 * half, foot = style == 1 ? thick : 0;
  add_fixed(box({4 * half, 4 * half, 2 * thick}), {0, 0, -thick});
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 edges(4 * half, 4 * half, height + foot), at(0, 0, 0.5 * (height - foot));
      edges[axis] = thick;
      at[axis] = side * (half + 0.5 * thick);
      add_fixed(box(edges), at);
    }
}

}  // namespace tw::fuzz
