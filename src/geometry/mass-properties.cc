// Exact volume integrals of convex solids at density 1.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/mass-properties.h"

namespace tw {

namespace {

Mat3 inertia_from_moments(const Mat3& second_moments) {
  const Mat3 inertia = second_moments.trace() * Mat3::Identity() - second_moments;
  // symmetric to the last bit
  return 0.5 * (inertia + inertia.transpose());
}

}  // namespace

MassProperties sphere_mass(double radius) {
  MassProperties mass;
  // V = 4/3 pi r^3, I = 2/5 V r^2
  mass.volume = 4.0 / 3.0 * pi * radius * radius * radius;
  mass.inertia = 0.4 * mass.volume * radius * radius * Mat3::Identity();
  return mass;
}

MassProperties box_mass(const Vec3& edges) {
  MassProperties mass;
  mass.volume = edges.prod();
  // I_x = V (y^2 + z^2) / 12 and cyclic
  const Vec3 squares = edges.cwiseAbs2();
  mass.inertia =
      (mass.volume / 12.0 * (Vec3::Constant(squares.sum()) - squares)).eval().asDiagonal();
  return mass;
}

MassProperties cylinder_mass(double radius, double length) {
  MassProperties mass;
  mass.volume = pi * radius * radius * length;
  // I_x = V (3 r^2 + l^2) / 12, I_z = V r^2 / 2
  const double across = mass.volume * (3 * radius * radius + length * length) / 12.0;
  mass.inertia = Vec3(across, across, 0.5 * mass.volume * radius * radius).asDiagonal();
  return mass;
}

MassProperties capsule_mass(double radius, double length) {
  // a cylinder, and half a ball at either end: with 3/8 r from their flat sides to their centroids
  // I_x = V_b (2/5 r^2 + l^2/4 + 3/8 l r)
  MassProperties mass = cylinder_mass(radius, length);
  const double balls = 4.0 / 3.0 * pi * radius * radius * radius;
  const double across =
      balls * (0.4 * radius * radius + 0.25 * length * length + 0.375 * length * radius);
  mass.volume += balls;
  mass.inertia += Vec3(across, across, 0.4 * balls * radius * radius).asDiagonal();
  return mass;
}

MassProperties cone_mass(double radius, double height) {
  MassProperties mass;
  mass.volume = pi * radius * radius * height / 3.0;
  // I_x = 3/20 V (r^2 + h^2/4), I_z = 3/10 V r^2
  const double across = 0.15 * mass.volume * (radius * radius + 0.25 * height * height);
  mass.inertia = Vec3(across, across, 0.3 * mass.volume * radius * radius).asDiagonal();
  return mass;
}

MassProperties ellipsoid_mass(const Vec3& semi_axes) {
  MassProperties mass;
  mass.volume = 4.0 / 3.0 * pi * semi_axes.prod();
  // I_x = V (b^2 + c^2) / 5 and cyclic
  const Vec3 squares = semi_axes.cwiseAbs2();
  mass.inertia =
      (0.2 * mass.volume * (Vec3::Constant(squares.sum()) - squares)).eval().asDiagonal();
  return mass;
}

MassProperties polyhedron_mass(const Polyhedron& polyhedron) {
  // tetrahedra from the polyhedron's middle to a fan of triangles on each face
  const Vec3& origin = polyhedron.center();
  double six_volume = 0;
  Vec3 first = Vec3::Zero();   // 24 times the first moment about the origin
  Mat3 second = Mat3::Zero();  // 120 times the second moment about the origin
  for (const Polyhedron::Face& face : polyhedron.faces())
    for (int i = 1; i + 1 < face.count; ++i) {
      const Vec3 a = polyhedron.vertex(polyhedron.corner(face.first)) - origin;
      const Vec3 b = polyhedron.vertex(polyhedron.corner(face.first + i)) - origin;
      const Vec3 c = polyhedron.vertex(polyhedron.corner(face.first + i + 1)) - origin;
      // for a tetrahedron 0abc: V = det/6, first = V (a+b+c)/4,
      // second = V/20 (aa + bb + cc + (a+b+c)(a+b+c))
      const double det = a.dot(b.cross(c));
      const Vec3 sum = a + b + c;
      six_volume += det;
      first += det * sum;
      second +=
          det * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
  MassProperties mass;
  mass.volume = six_volume / 6.0;
  const Vec3 offset = first / 24.0 / mass.volume;
  mass.centroid = origin + offset;
  // Huygens and Steiner: moments about the centroid
  mass.inertia = inertia_from_moments(second / 120.0 - mass.volume * offset * offset.transpose());
  return mass;
}

MassProperties summed_mass(const std::vector<MassProperties>& solids) {
  MassProperties sum;
  for (const MassProperties& solid : solids) {
    sum.volume += solid.volume;
    sum.centroid += solid.volume * solid.centroid;
  }
  if (sum.volume == 0) return MassProperties{};
  sum.centroid /= sum.volume;
  for (const MassProperties& solid : solids) {
    // parallel axes: I + V (d.d 1 - d d^T)
    const Vec3 d = solid.centroid - sum.centroid;
    sum.inertia +=
        solid.inertia + solid.volume * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  return sum;
}

MassProperties placed_mass(const MassProperties& solid, const Frame& placement) {
  MassProperties placed;
  placed.volume = solid.volume;
  placed.centroid = placement * solid.centroid;
  const Mat3 turned = placement.R * solid.inertia * placement.R.transpose();
  placed.inertia = 0.5 * (turned + turned.transpose());
  return placed;
}

}  // namespace tw
