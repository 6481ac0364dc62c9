// Groups with known motions: blocks and balls on slopes, stacks, walls.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "integrate/arc/group-arc.h"
#include "integrate/standing.h"

namespace tw::group_scenes {

constexpr double g = 9.81;

// Contact of a cube or ball of `mass` and width `size` with the standing constants.
inline ContactConstants constants(double mass, double size, double mu,
                                  FrictionLaw law = FrictionLaw::anchored) {
  ContactParameters parameters;
  parameters.friction = mu;
  parameters.friction_law = law;
  return contact_constants(parameters, mass, size, g, false);
}

// Gravity in the frame of a plane that falls towards +x.
inline Vec3 slope_gravity(double angle) { return g * Vec3(std::sin(angle), 0, -std::cos(angle)); }

// An arc that can be looked at anywhere.
struct CompleteArc : GroupArc {
  explicit CompleteArc(GroupStart given) : GroupArc(std::move(given)) { extend(start().end); }
};

inline GroupStart on_the_ground(double end) {
  GroupStart start;
  start.end = end;
  start.outside = {make_standing({})};
  return start;
}

inline GroupMember cube(double mass, double side, const Vec3& x, const Vec3& gravity) {
  GroupMember m;
  m.mass = mass;
  m.moments = Vec3::Constant(mass * side * side / 6);
  m.radius = 0.5 * std::sqrt(3.0) * side;
  m.x = x;
  m.force = mass * gravity;
  return m;
}

inline GroupMember ball(double mass, double radius, const Vec3& x, const Vec3& gravity) {
  GroupMember m;
  m.mass = mass;
  m.moments = Vec3::Constant(0.4 * mass * radius * radius);
  m.radius = radius;
  m.x = x;
  m.force = mass * gravity;
  return m;
}

// The four lower corners of cube `b` (half side s) on the plane z = `height` of body `a`, at
// (x, y) offsets within [-reach, reach].
inline void add_corners(GroupStart& start, int a, int b, double s, double height, double reach,
                        const ContactConstants& law) {
  for (const double x : {-reach, reach})
    for (const double y : {-reach, reach}) {
      GroupContact c;
      c.a = a;
      c.b = b;
      c.point_a = Vec3(0, 0, height);
      c.point_b = Vec3(x, y, -s);
      c.share = 0.25;
      c.law = law;
      start.contacts.push_back(c);
    }
}

inline void add_ball_contact(GroupStart& start, int a, int b, double radius,
                             const ContactConstants& law) {
  GroupContact c;
  c.a = a;
  c.b = b;
  c.radius_b = radius;
  c.law = law;
  start.contacts.push_back(c);
}

// d with k d (1 + (d/dh)^2) = force, by Newton from d0.
inline double static_depth(const ContactConstants& law, double force) {
  double d = law.depth;
  for (int i = 0; i < 50; ++i) {
    const double r = d / law.hardening;
    d -= (law.k * d * (1 + r * r) - force) / (law.k * (1 + 3 * r * r));
  }
  return d;
}

// A cube on the slope at its static depth, at rest.
inline GroupStart cube_on_slope(double angle, double mu, double side, double end,
                                FrictionLaw law = FrictionLaw::anchored) {
  GroupStart start = on_the_ground(end);
  const ContactConstants c = constants(1, side, mu, law);
  const double depth = static_depth(c, g * std::cos(angle));
  start.members = {cube(1, side, Vec3(0, 0, 0.5 * side - depth), slope_gravity(angle))};
  add_corners(start, -1, 0, 0.5 * side, 0, 0.5 * side, c);
  return start;
}

// A ball on the slope at its static depth, at rest.
inline GroupStart ball_on_slope(double angle, double mu, double radius, double end,
                                FrictionLaw law = FrictionLaw::anchored) {
  GroupStart start = on_the_ground(end);
  const ContactConstants c = constants(1, 2 * radius, mu, law);
  const double depth = static_depth(c, g * std::cos(angle));
  start.members = {ball(1, radius, Vec3(0, 0, radius - depth), slope_gravity(angle))};
  add_ball_contact(start, -1, 0, radius, c);
  return start;
}

// `count` cubes of side .2 m on top of each other, just touching, all falling by `drop` m first.
inline GroupStart stack(int count, double mu, double end, double drop = 0) {
  const double side = 0.2;
  GroupStart start = on_the_ground(end);
  const ContactConstants c = constants(8, side, mu);
  for (int i = 0; i < count; ++i) {
    start.members.push_back(
        cube(8, side, Vec3(0, 0, (i + 0.5) * side + (i + 1) * drop), slope_gravity(0)));
    add_corners(start, i - 1, i, 0.5 * side, i == 0 ? 0 : 0.5 * side, 0.5 * side, c);
  }
  return start;
}

// A wall of rows of bricks (cubes of .2 m, every second row moved by half a side): `columns` a row.
inline GroupStart wall(int rows, int columns, double mu, double end, double drop = 0) {
  const double side = 0.2, s = 0.5 * side;
  GroupStart start = on_the_ground(end);
  const ContactConstants c = constants(8, side, mu);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int i = row * columns + column;
      const double shift = row % 2 == 0 ? 0 : s;
      start.members.push_back(
          cube(8, side, Vec3(column * side + shift, 0, (row + 0.5) * side + (row + 1) * drop),
               slope_gravity(0)));
      if (row == 0) {
        add_corners(start, -1, i, s, 0, s, c);
        continue;
      }
      // each half of the lower face lies on one brick
      for (const int half : {0, 1}) {
        const int below = (row - 1) * columns + column + (row % 2 == 0 ? half - 1 : half);
        if (below < (row - 1) * columns || below >= row * columns) continue;
        for (const double x : {0.0, half == 0 ? -s : s})
          for (const double y : {-s, s}) {
            GroupContact contact;
            contact.a = below;
            contact.b = i;
            contact.point_a = Vec3(0, 0, s);
            contact.point_b = Vec3(x, y, -s);
            contact.share = 0.25;
            contact.law = c;
            start.contacts.push_back(contact);
          }
      }
    }
  return start;
}

}  // namespace tw::group_scenes
