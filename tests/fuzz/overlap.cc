// Depth by all axes, in units of the smaller solid, about its centre.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/overlap.h"

#include <ccd/ccd.h>

#include <algorithm>
#include <limits>

#include "geometry/polyhedron.h"

namespace tw::fuzz {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int rim_corners = 24;

// Adds a unit vector unless it or its opposite is there.
void add_direction(std::vector<Vec3>& all, const Vec3& v) {
  const double length = v.norm();
  if (!(length > 0)) return;
  const Vec3 u = v / length;
  for (const Vec3& other : all)
    if (std::abs(std::abs(u.dot(other)) - 1) < 1e-13) return;
  all.push_back(u);
}

// Faces of hulls are Qhull's, as the world has them.
void add_polyhedron(Part& part, const Shape& shape) {
  const Polyhedron& core = *shape.parts().front().core;
  const Pose& X = part.solid.placement;
  for (const Vec3& v : core.vertices()) part.corners.push_back(X.q * v + X.p);
  for (const auto& face : core.faces()) add_direction(part.normals, X.q * face.normal);
  for (const auto& edge : core.edges())
    add_direction(part.edges, X.q * (core.vertex(edge.head) - core.vertex(edge.tail)));
}

void add_cylinder(Part& part) {
  const Quat& q = part.solid.placement.q;
  part.normals.push_back(q * Vec3::UnitZ());
  part.edges.push_back(q * Vec3::UnitZ());
  for (int i = 0; i < rim_corners / 2; ++i) {
    const double angle = 2 * pi * i / rim_corners;
    const Vec3 tangent = q * Vec3(std::cos(angle), std::sin(angle), 0);
    part.edges.push_back(tangent);
    part.normals.push_back(tangent);
  }
}

// What turns about an axis: tangents of its rims, and across them; of a cone its lines, too.
void add_cone(Part& part) {
  const Quat& q = part.solid.placement.q;
  const double r = part.solid.radius, h = part.solid.length;
  part.normals.push_back(q * Vec3::UnitZ());
  for (int i = 0; i < rim_corners; ++i) {
    const double angle = 2 * pi * i / rim_corners;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    add_direction(part.edges, q * Vec3(-out.y(), out.x(), 0));
    add_direction(part.edges, q * (r * out - h * Vec3::UnitZ()));
    add_direction(part.normals, q * (h * out + r * Vec3::UnitZ()));
  }
}

Vec3 extents_of(const Solid& solid) {
  switch (solid.kind) {
    case SolidKind::capsule: return Vec3(0, 0, solid.length) + Vec3::Constant(2 * solid.radius);
    case SolidKind::cone: return {2 * solid.radius, 2 * solid.radius, solid.length};
    case SolidKind::ellipsoid: return solid.edges;
    case SolidKind::ball: return Vec3::Constant(2 * solid.radius);
    case SolidKind::box: return solid.edges;
    case SolidKind::cylinder: return {2 * solid.radius, 2 * solid.radius, solid.length};
    default: break;
  }
  if (solid.kind == SolidKind::half_space) return Vec3::Constant(infinity);
  Vec3 lo = solid.points.front(), hi = lo;
  for (const Vec3& p : solid.points) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  return hi - lo;
}

Part part_of(const Solid& solid) {
  Part part;
  part.solid = solid;
  part.center = solid.placement.p;
  part.width = extents_of(solid).minCoeff();
  switch (solid.kind) {
    case SolidKind::ball: part.reach = solid.radius; break;
    case SolidKind::half_space: part.reach = infinity; break;
    case SolidKind::cylinder:
      part.reach = std::hypot(solid.radius, 0.5 * solid.length);
      add_cylinder(part);
      break;
    case SolidKind::capsule:
      part.reach = solid.radius + 0.5 * solid.length;
      add_cylinder(part);
      break;
    case SolidKind::cone:
      part.reach = std::max(std::hypot(solid.radius, 0.25 * solid.length), 0.75 * solid.length);
      add_cone(part);
      break;
    case SolidKind::ellipsoid:
      part.reach = 0.5 * solid.edges.maxCoeff();
      for (int i = 0; i < 3; ++i) part.normals.push_back(solid.placement.q * Vec3::Unit(i));
      break;
    default:
      add_polyhedron(
          part, solid.kind == SolidKind::box ? *make_box(solid.edges) : *make_hull(solid.points));
      part.center = Vec3::Zero();
      for (const Vec3& v : part.corners)
        part.center += v / static_cast<double>(part.corners.size());
      for (const Vec3& v : part.corners)
        part.reach = std::max(part.reach, (v - part.center).norm());
  }
  return part;
}

// A part in the world, in units of `unit` about `origin`.
struct PlacedPart {
  const Part& part;
  const Frame& frame;
  Vec3 origin;
  double unit;

  Vec3 map(const Vec3& x) const { return (frame.R * x + (frame.p - origin)) / unit; }
  Vec3 center() const { return map(part.center); }
  Vec3 turned(const Vec3& v) const { return frame.R * v; }

  Vec3 support(const Vec3& n) const {
    const Solid& solid = part.solid;
    if (solid.kind == SolidKind::ball) return center() + n * (solid.radius / unit / n.norm());
    const Vec3 local = frame.R.transpose() * n;
    if (solid.kind == SolidKind::cylinder) {
      const Vec3 d = solid.placement.q.conjugate() * local;
      const double radial = std::hypot(d.x(), d.y());
      Vec3 p(0, 0, d.z() > 0 ? 0.5 * solid.length : -0.5 * solid.length);
      if (radial > 0) p += Vec3(d.x(), d.y(), 0) * (solid.radius / radial);
      return map(solid.placement.q * p + solid.placement.p);
    }
    if (solid.kind == SolidKind::capsule || solid.kind == SolidKind::cone ||
        solid.kind == SolidKind::ellipsoid)
      return map(solid.placement.q * round_support(solid.placement.q.conjugate() * local) +
                 solid.placement.p);
    const Vec3* best = &part.corners.front();
    for (const Vec3& v : part.corners)
      if (v.dot(local) > best->dot(local)) best = &v;
    return map(*best);
  }
  double height(const Vec3& n) const { return n.dot(support(n)); }

 private:
  // Of a capsule, a cone or an ellipsoid, in its own frame.
  Vec3 round_support(const Vec3& d) const {
    const Solid& solid = part.solid;
    const Vec3 along = solid.length * Vec3::UnitZ();
    if (solid.kind == SolidKind::capsule)
      return solid.radius * d.normalized() + (d.z() > 0 ? 0.5 : -0.5) * along;
    if (solid.kind == SolidKind::ellipsoid) {
      const Vec3 semi = 0.5 * solid.edges;
      return semi.cwiseAbs2().cwiseProduct(d) / semi.cwiseProduct(d).norm();
    }
    const double across = std::hypot(d.x(), d.y());
    if (0.75 * solid.length * d.z() > solid.radius * across - 0.25 * solid.length * d.z())
      return 0.75 * along;
    const Vec3 out = across > 0 ? Vec3(d.x() / across, d.y() / across, 0) : Vec3::UnitX();
    return solid.radius * out - 0.25 * along;
  }
};

ccd_vec3_t to_ccd(const Vec3& v) {
  ccd_vec3_t out;
  ccdVec3Set(&out, v.x(), v.y(), v.z());
  return out;
}

void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const Vec3 n(direction->v[0], direction->v[1], direction->v[2]);
  *point = to_ccd(static_cast<const PlacedPart*>(object)->support(n));
}

void ccd_center(const void* object, ccd_vec3_t* point) {
  *point = to_ccd(static_cast<const PlacedPart*>(object)->center());
}

// The least overlap over the directions that were tried.
class LeastOverlap {
 public:
  LeastOverlap(const PlacedPart& a, const PlacedPart& b, double enough)
      : a_(a), b_(b), enough_(enough) {}

  // Tries a direction and its opposite.
  void try_axis(const Vec3& direction) {
    const double length = direction.norm();
    if (done() || !(length > 1e-12)) return;
    try_unit(direction / length);
    try_unit(-direction / length);
  }
  bool done() const { return least_ <= enough_; }
  double least() const { return least_; }

  void try_axes_of_polyhedra() {
    for (const Vec3& n : a_.part.normals) try_axis(a_.turned(n));
    for (const Vec3& n : b_.part.normals) try_axis(b_.turned(n));
    for (const Vec3& u : a_.part.edges)
      for (const Vec3& v : b_.part.edges) try_axis(a_.turned(u).cross(b_.turned(v)));
  }

  // From what is round to corners and edges: the directions of features that the rest lacks.
  void try_axes_of_round(const PlacedPart& round, const PlacedPart& other) {
    const SolidKind kind = round.part.solid.kind;
    const bool is_ball = kind == SolidKind::ball || kind == SolidKind::ellipsoid;
    const Vec3 center = round.center();
    for (const Vec3& corner : other.part.corners) {
      const Vec3 way = other.map(corner) - center;
      try_axis(way);
      if (!is_ball) {
        try_axis(across(round, way));
        try_axis(other.map(corner) - nearest_rim_point(round, other.map(corner)));
        continue;
      }
      if (kind == SolidKind::ellipsoid) try_axis(outward(round, way));
      for (const Vec3& edge : other.part.edges) {
        const Vec3 u = other.turned(edge);
        try_axis(way - u * u.dot(way));
        if (kind != SolidKind::ellipsoid) continue;
        // the point of the edge's line that is nearest in the metric of the ellipsoid
        const Vec3 m = outward(round, u);
        try_axis(outward(round, way - u * (m.dot(way) / m.dot(u))));
      }
    }
    const Vec3 between = other.center() - center;
    try_axis(between);
    if (is_ball) return;
    try_axis(across(round, between));
    try_axis(other.center() - nearest_rim_point(round, other.center()));
  }

  void try_axis_of_libccd() {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.center1 = ccd.center2 = ccd_center;
    ccd.max_iterations = 200;
    ccd.mpr_tolerance = 1e-6;
    ccd_real_t depth = 0;
    ccd_vec3_t n, position;
    if (ccdMPRPenetration(&a_, &b_, &ccd, &depth, &n, &position) == 0)
      try_axis(Vec3(n.v[0], n.v[1], n.v[2]));
    else  // no overlap: as good as a direction that shows it
      least_ = std::min(least_, 0.0);
  }

  // Pattern search downhill on the sphere from the best direction.
  void climb() {
    for (double step = 0.1; step > 1e-9 && !done();) {
      const Vec3 n = best_;
      const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
      const double before = least_;
      for (int i = 0; i < 8; ++i) {
        const double angle = pi / 4 * i;
        try_unit((n + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized());
      }
      if (!(least_ < before)) step *= 0.5;
    }
  }

 private:
  void try_unit(const Vec3& n) {
    const double overlap = a_.height(n) + b_.height(-n);
    if (overlap >= least_) return;
    least_ = overlap;
    best_ = n;
  }
  // The normal of the ellipsoid, of that size about its centre, on which x lies (from the centre).
  static Vec3 outward(const PlacedPart& ellipsoid, const Vec3& x) {
    const Solid& solid = ellipsoid.part.solid;
    const Quat& q = solid.placement.q;
    const Vec3 local = q.conjugate() * (ellipsoid.frame.R.transpose() * x);
    const Vec3 semi = solid.edges / solid.edges.maxCoeff();
    return ellipsoid.turned(q * local.cwiseQuotient(semi.cwiseAbs2()));
  }
  static Vec3 axis_of(const PlacedPart& cylinder) {
    return cylinder.turned(cylinder.part.solid.placement.q * Vec3::UnitZ());
  }
  static Vec3 across(const PlacedPart& cylinder, const Vec3& way) {
    const Vec3 axis = axis_of(cylinder);
    return way - axis * axis.dot(way);
  }
  static Vec3 nearest_rim_point(const PlacedPart& cylinder, const Vec3& x) {
    const Vec3 axis = axis_of(cylinder), way = x - cylinder.center();
    const Vec3 out = across(cylinder, way).normalized();
    const double side = axis.dot(way) > 0 ? 0.5 : -0.5;
    const Solid& solid = cylinder.part.solid;
    return cylinder.center() + (out * solid.radius + axis * side * solid.length) / cylinder.unit;
  }

  const PlacedPart& a_;
  const PlacedPart& b_;
  double enough_, least_ = infinity;
  Vec3 best_ = Vec3::UnitZ();
};

bool is_round(const Part& part) {
  const SolidKind kind = part.solid.kind;
  return kind != SolidKind::box && kind != SolidKind::hull && kind != SolidKind::half_space;
}

double below_plane(const Part& plane, const Frame& frame, const Part& part, const Frame& other) {
  const Vec3 n = frame.R * plane.solid.normal;
  const PlacedPart placed{part, other, other * part.center, 1};
  const double lowest = n.dot(other * part.center - frame.p) - placed.height(-n);
  return plane.solid.offset - lowest;
}

}  // namespace

namespace {

// What is under each of the two triangles of a cell, which have its diagonal of greater x and y in
// common.  It is as thick as it is taken for: a body does not get out below.
void add_hills(const Hills& hills, std::vector<Part>& parts) {
  for (std::size_t row = 0; row + 1 < hills.rows(); ++row)
    for (std::size_t column = 0; column + 1 < hills.columns; ++column)
      for (const std::size_t side : {0, 1}) {
        std::vector<Vec3> points{hills.corner(row, column),
                                 hills.corner(row + side, column + 1 - side),
                                 hills.corner(row + 1, column + 1)};
        double lowest = infinity;
        for (const Vec3& p : points) lowest = std::min(lowest, p.z());
        for (int i = 0; i < 3; ++i) {
          const Vec3& p = points[static_cast<std::size_t>(i)];
          points.push_back({p.x(), p.y(), lowest - hills.spacing});
        }
        parts.push_back(part_of(hull(points)));
        // what is wide is the ground, not its cells
        parts.back().width = infinity;
      }
}

}  // namespace

std::vector<Part> parts_of(const DescribedBody& body) {
  std::vector<Part> parts;
  if (body.hills) add_hills(*body.hills, parts);
  for (const Solid& solid : body.solids) parts.push_back(part_of(solid));
  return parts;
}

double least_width(const std::vector<Part>& parts) {
  double least = infinity;
  for (const Part& part : parts) least = std::min(least, part.width);
  return least;
}

double overlap(const Part& a, const Frame& frame_a, const Part& b, const Frame& frame_b,
               double enough) {
  if (b.solid.kind == SolidKind::half_space) return below_plane(b, frame_b, a, frame_a);
  if (a.solid.kind == SolidKind::half_space) return below_plane(a, frame_a, b, frame_b);
  const Vec3 origin = a.reach < b.reach ? frame_a * a.center : frame_b * b.center;
  const double apart = (frame_a * a.center - frame_b * b.center).norm();
  if (apart > a.reach + b.reach) return a.reach + b.reach - apart;

  const double unit = std::min(a.reach, b.reach);
  const PlacedPart placed_a{a, frame_a, origin, unit}, placed_b{b, frame_b, origin, unit};
  LeastOverlap search(placed_a, placed_b, enough / unit);
  search.try_axis(placed_b.center() - placed_a.center());
  search.try_axes_of_polyhedra();
  if (is_round(a)) search.try_axes_of_round(placed_a, placed_b);
  if (is_round(b)) search.try_axes_of_round(placed_b, placed_a);
  if (!search.done() && (is_round(a) || is_round(b))) {
    search.climb();
    search.try_axis_of_libccd();
    search.climb();
  }
  return search.least() * unit;
}

}  // namespace tw::fuzz
