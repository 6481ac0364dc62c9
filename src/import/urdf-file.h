// What stands in a URDF file, each element with its line.
//
// Elements that say nothing about bodies and joints, those of Gazebo, of ROS control and of other
// programs, are passed over.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/mending.h"
#include "math/vec.h"

namespace tw::urdf {

enum class GeometryKind { box, sphere, cylinder, capsule, plane, mesh };

struct Geometry {
  GeometryKind kind = GeometryKind::box;
  int line = 0;
  Vec3 size = Vec3::Zero();       // edges, m; of a plane its normal; of a mesh its scale
  double radius = 0, length = 0;  // m; a capsule's length is that of its cylinder
  std::string file;               // of a mesh, as it is written
};

// <collision> or <visual>.
struct Piece {
  Geometry geometry;
  Pose origin;  // in the link's frame
  std::optional<Vec3> color;
};

struct Inertial {
  int line = 0, mass_line = 0, inertia_line = 0;
  Pose origin;
  double mass = 0;              // kg
  std::optional<Mat3> inertia;  // kg m^2, about the origin, its axes
};

struct Link {
  std::string name;
  int line = 0;
  std::optional<Inertial> inertial;
  std::vector<Piece> collisions, visuals;
};

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating, spherical };

struct Limit {
  int line = 0;
  std::optional<double> lower, upper;      // rad or m
  std::optional<double> effort, velocity;  // N m or N, rad/s or m/s
};

struct Mimic {
  int line = 0;
  std::string joint;
  double multiplier = 1, offset = 0;
};

struct Joint {
  std::string name;
  int line = 0;
  JointType type = JointType::fixed;
  std::string parent, child;  // links
  Pose origin;                // in the parent's frame
  Vec3 axis = Vec3::UnitX();
  std::optional<Limit> limit;
  std::optional<Mimic> mimic;
  double damping = 0, friction = 0;
};

struct Robot {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
};

// Errors: UserError with file and line: no file, no XML, macros of xacro, no <robot>, elements and
// values that cannot be read; of a <visual> that is mended: it is left out.
Robot read_file(const std::string& file, Mending& mending);

}  // namespace tw::urdf
