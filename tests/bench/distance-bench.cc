// Signed distances of every pair of shapes: the worst errors over random and degenerate poses, and
// what a query costs beside libccd's test for overlap and, where it is installed, FCL's signed
// distance.  Prints the Markdown tables that doc/numerics/distances.md has rows of.
//
//   distance-bench [POSES A PAIR [TOLERANCE]]
//
// 3000 poses without; FCL's tolerance as a share of the larger body's size, 1e-6 without.
//
// Sizes are 1e-3 to 1e3 m, those of a pair within 1:10 of each other, proportions 1 to 1:1000.
// Nothing is compared with another answer: bodies that are apart by d have two points so far apart
// and a slab of that width between them; a depth d is the width of the slab along its axis, and
// climbing from there and from random axes finds no better one.  Errors are shares of the larger
// body's size.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <ccd/ccd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "bench/distance-fcl.h"
#include "collision/distance/ellipsoid-point.h"
#include "collision/distance/frustum-point.h"
#include "collision/distance/round-distance.h"
#include "collision/distance/separation.h"
#include "geometry/polyhedron.h"
#include "unit/convex-oracles.h"

namespace tw::test {
namespace {

struct Solid {
  ShapePtr shape;
  Frame frame;

  const ConvexPart& part() const { return shape->parts()[0]; }
  SupportCore core() const { return SupportCore(part(), frame * part().placement()); }
  double margin() const { return part().kind == PartKind::sphere ? part().radius : part().margin; }
  Vec3 support(const Vec3& n) const {
    if (part().kind == PartKind::sphere)
      return frame * part().placement().p + margin() * n.normalized();
    return core().support(n) + margin() * n.normalized();
  }
  double size() const { return 2 * part().bound_radius; }
  double outside(const Vec3& point) const {
    const Vec3 local = (frame * part().placement()).to_local(point);
    int face = 0;
    switch (part().kind) {
      case PartKind::sphere: return local.norm() - part().radius;
      case PartKind::frustum: return nearest_on_frustum(part(), local).distance;
      case PartKind::ellipsoid: return nearest_on_ellipsoid(part().semi_axes, local).distance;
      default: return part().core->face_separation(local, face);
    }
  }
};

double slab(const Solid& a, const Solid& b, const Vec3& n) {
  return n.dot(b.support(-n) - a.support(n));
}

constexpr const char* names[] = {"ball", "box", "hull", "cylinder", "cone", "capsule", "ellipsoid"};
constexpr int kinds = 7;

ShapePtr shape_of(int kind, double size, double ratio, Engine& random) {
  const bool flat = random() % 2 == 0;
  const double thin = size * ratio;
  switch (kind) {
    case 0: return make_sphere(0.5 * size);
    case 1: return make_box(flat ? Vec3(size, 0.7 * size, thin) : Vec3(size, thin, 0.7 * thin));
    case 2: {
      const Vec3 widths = flat ? Vec3(size, 0.7 * size, thin) : Vec3(size, thin, 0.7 * thin);
      return random_rock(random, 16, 0.5 * widths);
    }
    case 3: return flat ? make_cylinder(0.5 * size, thin) : make_cylinder(0.5 * thin, size);
    case 4: return flat ? make_cone(0.5 * size, thin) : make_cone(0.5 * thin, size);
    case 5: return make_capsule(0.5 * thin, size);
    default:
      return make_ellipsoid(0.5 *
                            (flat ? Vec3(size, 0.7 * size, thin) : Vec3(size, thin, 0.7 * thin)));
  }
}

void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const Vec3 x = static_cast<const Solid*>(object)->support(
      {direction->v[0], direction->v[1], direction->v[2]});
  ccdVec3Set(point, x.x(), x.y(), x.z());
}

void ccd_center(const void* object, ccd_vec3_t* point) {
  const Solid& solid = *static_cast<const Solid*>(object);
  const Vec3 x = solid.frame * solid.part().bound_center;
  ccdVec3Set(point, x.x(), x.y(), x.z());
}

// The same for FCL; `kind` is a place in `names`.
FclSolid plain(const Solid& solid, int kind) {
  const ConvexPart& part = solid.part();
  FclSolid out;
  out.kind = static_cast<FclSolid::Kind>(kind);
  switch (out.kind) {
    case FclSolid::Kind::ball: out.sizes = {part.radius}; break;
    case FclSolid::Kind::box:
      for (int k = 0; k < 3; ++k) out.sizes[static_cast<std::size_t>(k)] = 2 * part.half_edges[k];
      break;
    case FclSolid::Kind::hull:
      for (const Vec3& x : part.core->vertices()) out.vertices.push_back({x.x(), x.y(), x.z()});
      for (const Polyhedron::Face& face : part.core->faces()) {
        out.faces.push_back(face.count);
        for (int k = 0; k < face.count; ++k) out.faces.push_back(part.core->corner(face.first + k));
        ++out.face_count;
      }
      break;
    case FclSolid::Kind::ellipsoid:
      for (int k = 0; k < 3; ++k) out.sizes[static_cast<std::size_t>(k)] = part.semi_axes[k];
      break;
    default: out.sizes = {part.radius + part.margin, 2 * part.half_length};
  }
  const Frame frame = solid.frame * part.placement();
  Eigen::Map<Mat3>(out.rotation.data()) = frame.R;
  Eigen::Map<Vec3>(out.position.data()) = frame.p;
  return out;
}

struct Worst {
  double apart = 0, points = 0, depth = 0;
  long poses = 0, overlaps = 0, ccd_disagrees = 0;
  double ours = 0, theirs = 0;  // ns
};

// What FCL is asked, and ours to compare with.
struct Questions {
  std::vector<FclQuery> queries;
  std::vector<double> distances, sizes;  // m; the larger body's
  double cost = 0;                       // of ours, ns a query
};

#ifdef TW_FCL
// Prints a row: what FCL's two solvers cost, where they give no answer, and how far theirs is from
// ours as a share of the size, apart and overlapping: the worst, and how many beyond 1e-4.
void print_fcl(const char* a, const char* b, const Questions& questions) {
  std::printf("| %s, %s | %.0f |", a, b, questions.cost);
  for (const FclSolver solver : {FclSolver::libccd, FclSolver::own}) {
    const std::vector<FclAnswer> answers = fcl_distances(questions.queries, solver);
    double cost = 0, apart = 0, depth = 0;
    long given = 0, far = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (!answers[i].given) continue;
      ++given;
      cost += answers[i].cost;
      const double distance = questions.distances[i];
      const double error = std::abs(answers[i].distance - distance) / questions.sizes[i];
      double& worst = distance > 0 ? apart : depth;
      worst = std::max(worst, error);
      if (!(error < 1e-4)) ++far;
    }
    std::printf(" %.0f | %.0e | %.0e | %ld | %zu |", cost / static_cast<double>(given), apart,
                depth, far, answers.size() - static_cast<std::size_t>(given));
  }
  std::printf("\n");
  std::fflush(stdout);
}
#endif

double best_slab(const Solid& a, const Solid& b, const Vec3& start, Engine& random) {
  double best = -1e300;
  for (int from = 0; from < 4; ++from) {
    Vec3 n = from == 0 ? start : random_direction(random);
    double here = slab(a, b, n);
    for (double step = 0.3; step > 1e-8; step *= 0.7)
      for (int k = 0; k < 6; ++k) {
        const Vec3 m = (n + step * random_direction(random)).normalized();
        if (const double there = slab(a, b, m); there > here) {
          here = there;
          n = m;
        }
      }
    best = std::max(best, here);
  }
  return best;
}

double judge(const Solid& a, const Solid& b, Engine& random, Worst& worst) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return 1e9 * std::chrono::duration<double>(Clock::now() - start).count();
  };
  const double size = std::max(a.size(), b.size());
  auto start = Clock::now();
  const Separation s = part_separation(a.part(), a.frame, b.part(), b.frame, nullptr);
  worst.ours += since(start);
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = ccd_support;
  ccd.center1 = ccd.center2 = ccd_center;
  ccd.max_iterations = 500;
  ccd.mpr_tolerance = 1e-10;
  start = Clock::now();
  const bool overlap = ccdMPRIntersect(&a, &b, &ccd) != 0;
  worst.theirs += since(start);
  ++worst.poses;
  if (overlap != (s.distance < 0) && std::abs(s.distance) > 1e-8 * size) ++worst.ccd_disagrees;
  const double width = slab(a, b, s.normal);
  const auto note = [size](double& most, double error) { most = std::max(most, error / size); };
  if (s.distance > 0) {
    note(worst.apart, std::abs(width - s.distance));
    note(worst.apart, std::abs((s.point_b - s.point_a).norm() - s.distance));
    note(worst.points, std::max(a.outside(s.point_a), b.outside(s.point_b)));
  } else {
    ++worst.overlaps;
    note(worst.depth, std::abs(width - s.distance));
    if (worst.overlaps % 4 == 0) note(worst.depth, best_slab(a, b, s.normal, random) - s.distance);
  }
  return s.distance;
}

// Degenerate: axes parallel or square to each other, nearest features in exact touch.
Worst worst_of(int kind_a, int kind_b, int poses, double tolerance, Questions& questions) {
  Engine random(static_cast<std::uint64_t>(100 * kind_a + kind_b));
  Worst worst;
  for (int i = 0; i < poses; ++i) {
    const double size = std::pow(10, uniform(random, -3, 3));
    const auto ratio = [&] { return std::pow(10, -uniform(random, 0, 3)); };
    Solid a{shape_of(kind_a, size, ratio(), random), Frame()};
    Solid b{shape_of(kind_b, size * std::pow(10, uniform(random, -1, 0)), ratio(), random),
            Frame()};
    const bool degenerate = i % 100 == 0;
    if (degenerate) {
      const Vec3 axis = Vec3::Unit(static_cast<int>(random() % 3));
      b.frame.R = rotation_by(0.5 * pi * axis).toRotationMatrix();
      if (random() % 2) b.frame.R.setIdentity();
      b.frame.p = 2 * size * Vec3::Unit(static_cast<int>(random() % 3));
    } else {
      a.frame = random_frame(random, size);
      b.frame =
          Frame(Pose{a.frame.p + 2 * size * random_direction(random), random_rotation(random)});
    }
    const Separation far = part_separation(a.part(), a.frame, b.part(), b.frame, nullptr);
    const double thin = std::min(a.shape->least_width(), b.shape->least_width());
    double gap = thin * std::pow(10, uniform(random, -9, 1)) * (random() % 2 ? 1 : -1);
    if (gap < -0.3 * thin) gap = -0.3 * thin;
    if (degenerate) gap = i % 200 ? 0 : -0.01 * thin;
    b.frame.p -= (far.distance - gap) * far.normal;
    const double distance = judge(a, b, random, worst);
    const double larger = std::max(a.size(), b.size());
    questions.queries.push_back({plain(a, kind_a), plain(b, kind_b), tolerance * larger});
    questions.distances.push_back(distance);
    questions.sizes.push_back(larger);
  }
  return worst;
}

int print_tables(int poses, [[maybe_unused]] double tolerance) {
  std::printf(
      "| pair | poses | apart | points | overlaps | depth | ns | libccd, ns | sign differs |\n");
  std::printf("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  std::vector<Questions> of_pairs;
  for (int i = 0; i < kinds; ++i)
    for (int j = i; j < kinds; ++j) {
      const Worst w = worst_of(i, j, poses, tolerance, of_pairs.emplace_back());
      const double n = static_cast<double>(w.poses);
      of_pairs.back().cost = w.ours / n;
      std::printf("| %s, %s | %ld | %.0e | %.0e | %ld | %.0e | %.0f | %.0f | %ld |\n", names[i],
                  names[j], w.poses, w.apart, w.points, w.overlaps, w.depth, w.ours / n,
                  w.theirs / n, w.ccd_disagrees);
      std::fflush(stdout);
    }
#ifdef TW_FCL
  std::printf(
      "\n| pair | ours, ns | FCL, ns | apart | depth | > 1e-4 | none | own, ns | apart | depth | > "
      "1e-4 | "
      "none |\n");
  std::printf(
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  std::size_t pair = 0;
  for (int i = 0; i < kinds; ++i)
    for (int j = i; j < kinds; ++j) print_fcl(names[i], names[j], of_pairs[pair++]);
#endif
  return 0;
}

}  // namespace
}  // namespace tw::test

int main(int count, char** arguments) {
  const int poses = count > 1 ? std::atoi(arguments[1]) : 3000;
  const double tolerance = count > 2 ? std::atof(arguments[2]) : 1e-6;
  if (poses <= 0 || !(tolerance > 0)) {
    std::fprintf(stderr,
                 "distance-bench: expected positive numbers of poses and for FCL's tolerance\n");
    return 2;
  }
  return tw::test::print_tables(poses, tolerance);
}
