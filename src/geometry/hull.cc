// The convex hull of points, by Qhull.
//
// Source: C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull algorithm for convex hulls",
// ACM Trans. Math. Software 22 (1996).  Only the combinatorics is taken from Qhull; planes are
// computed anew from the points.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/hull.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace tw {

namespace {

// below this ratio of thickness to extent points count as flat: the planes of thinner solids
// would be known to fewer than 7 digits
constexpr double flat_ratio = 1e-9;

// Qhull's text output, kept from the terminal.
class CapturedText {
 public:
  CapturedText() : file_(open_memstream(&text_, &size_)) {}
  ~CapturedText() {
    if (file_ != nullptr) std::fclose(file_);
    std::free(text_);
  }
  CapturedText(const CapturedText&) = delete;
  CapturedText& operator=(const CapturedText&) = delete;

  FILE* file() const { return file_; }
  std::string first_line() {
    std::fflush(file_);
    const std::string all(text_, size_);
    return all.substr(0, all.find('\n'));
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  FILE* file_ = nullptr;
};

// One run of Qhull, freed whatever happens.
class QhullRun {
 public:
  QhullRun() : qh_(std::make_unique<qhT>()) { qh_zero(qh_.get(), text_.file()); }
  ~QhullRun() {
    qh_freeqhull(qh_.get(), !qh_ALL);
    int current_long = 0;
    int total_long = 0;
    qh_memfreeshort(qh_.get(), &current_long, &total_long);
  }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;

  void run(std::vector<Vec3>& points) {
    // facets that rounding cannot tell apart are merged by default; Pp: no precision warnings
    char options[] = "qhull Pp";
    const int code = qh_new_qhull(qh_.get(), 3, static_cast<int>(points.size()), points[0].data(),
                                  False, options, text_.file(), text_.file());
    TW_REQUIRE(code == 0, "the hull of " + std::to_string(points.size()) +
                              " points can't be computed: " + text_.first_line());
  }

  // The facets' vertices as numbers of points, in cyclic order.
  std::vector<std::vector<int>> polygons() {
    std::vector<std::vector<int>> result;
    qhT* qh = qh_.get();  // Qhull's macros want this name
    facetT* facet;
    FORALLfacets {
      std::vector<int> polygon;
      setT* corners = qh_facet3vertex(qh, facet);
      vertexT* vertex;
      vertexT** vertexp;
      FOREACHvertex_(corners) polygon.push_back(qh_pointid(qh, vertex->point));
      qh_settempfree(qh, &corners);
      result.push_back(std::move(polygon));
    }
    return result;
  }

 private:
  CapturedText text_;
  std::unique_ptr<qhT> qh_;
};

// Extents of the points along the principal axes of their covariance, least first.
Vec3 principal_extents(const std::vector<Vec3>& centred) {
  Mat3 covariance = Mat3::Zero();
  for (const Vec3& p : centred) covariance += p * p.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
  Vec3 lo = Vec3::Constant(1e300);
  Vec3 hi = Vec3::Constant(-1e300);
  for (const Vec3& p : centred) {
    const Vec3 along = solver.eigenvectors().transpose() * p;
    lo = lo.cwiseMin(along);
    hi = hi.cwiseMax(along);
  }
  return hi - lo;
}

void require_solid(const std::vector<Vec3>& centred) {
  Vec3 extents = principal_extents(centred);
  std::sort(extents.data(), extents.data() + 3);
  const std::string count = "the " + std::to_string(centred.size()) + " points of a hull ";
  TW_REQUIRE(extents[2] > 0, count + "all coincide; expected points that span a solid");
  const auto thin = [&extents](int axis) { return !(extents[axis] > flat_ratio * extents[2]); };
  TW_REQUIRE(!thin(1), count + "lie on a line " + show(extents[2]) + " m long and " +
                           show(extents[1]) + " m wide; expected points that span a solid");
  TW_REQUIRE(!thin(0), count + "are flat: " + show(extents[0]) + " m thick, " + show(extents[1]) +
                           " m by " + show(extents[2]) +
                           " m wide; expected points that span a solid");
}

// Points relative to the middle of their bounding box, where Qhull's rounding is least.
std::vector<Vec3> centred_points(const std::vector<Vec3>& points) {
  Aabb box;
  for (const Vec3& p : points) box.add(p);
  std::vector<Vec3> centred = points;
  for (Vec3& p : centred) p -= box.center();
  return centred;
}

// Turns every polygon to counter-clockwise seen from outside and to begin at its least vertex.
void orient(const std::vector<Vec3>& centred, std::vector<std::vector<int>>& polygons) {
  const auto point = [&centred](int i) -> const Vec3& {
    return centred[static_cast<std::size_t>(i)];
  };
  Vec3 inside = Vec3::Zero();
  double corners = 0;
  for (const auto& polygon : polygons)
    for (int i : polygon) {
      inside += point(i);
      corners += 1;
    }
  inside /= corners;
  for (auto& polygon : polygons) {
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      area +=
          (point(polygon[i]) - point(polygon[0])).cross(point(polygon[i + 1]) - point(polygon[0]));
    if (area.dot(point(polygon[0]) - inside) < 0) std::reverse(polygon.begin(), polygon.end());
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  }
  std::sort(polygons.begin(), polygons.end());
}

// Nothing where the joined facets bend.
std::optional<Polyhedron> hull_of(const std::vector<Vec3>& points) {
  std::vector<Vec3> centred = centred_points(points);
  QhullRun qhull;
  qhull.run(centred);
  std::vector<std::vector<int>> polygons = qhull.polygons();
  orient(centred, polygons);

  // keep the points that are corners, in the order of the points
  std::vector<int> number(points.size(), -1);
  for (const auto& polygon : polygons)
    for (int i : polygon) number[static_cast<std::size_t>(i)] = 0;
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (number[i] == 0) {
      number[i] = static_cast<int>(vertices.size());
      vertices.push_back(points[i]);
    }
  for (auto& polygon : polygons)
    for (int& i : polygon) i = number[static_cast<std::size_t>(i)];
  try {
    return Polyhedron(std::move(vertices), polygons);
  } catch (const UserError&) {
    return std::nullopt;
  }
}

// Grids of that share of the size, in bits: 1e-9 to 6e-5.
constexpr int finest_grid = 30, coarsest_grid = 14, grid_step = 4;

// Each once, at the nearest point of a grid: exact numbers.
std::vector<Vec3> on_grid(const std::vector<Vec3>& points, double step) {
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::vector<Vec3> snapped;
  for (const Vec3& p : points)
    snapped.push_back(step * (p / step).unaryExpr([](double x) { return std::round(x) + 0.0; }));
  std::sort(snapped.begin(), snapped.end(), before);
  snapped.erase(std::unique(snapped.begin(), snapped.end()), snapped.end());
  return snapped;
}

}  // namespace

Polyhedron convex_hull(const std::vector<Vec3>& points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    TW_REQUIRE(is_finite(points[i]), "point " + std::to_string(i) + " of a hull is (" +
                                         show(points[i].x()) + " " + show(points[i].y()) + " " +
                                         show(points[i].z()) + "); expected finite numbers");
  TW_REQUIRE(points.size() >= 4,
             "a hull needs at least 4 points; got " + std::to_string(points.size()));
  const std::vector<Vec3> centred = centred_points(points);
  require_solid(centred);
  if (auto found = hull_of(points)) return *std::move(found);
  double size = 0;
  for (const Vec3& p : centred) size = std::max(size, p.cwiseAbs().maxCoeff());
  const double whole = std::exp2(std::ceil(std::log2(size)));
  for (int bits = finest_grid; bits >= coarsest_grid; bits -= grid_step)
    if (auto found = hull_of(on_grid(points, std::ldexp(whole, -bits)))) return *std::move(found);
  throw UserError("the hull of " + std::to_string(points.size()) +
                  " points can't be computed: its facets bend");
}

}  // namespace tw
