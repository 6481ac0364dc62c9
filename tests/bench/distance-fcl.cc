// FCL's signed distances, see distance-fcl.h.
//
// Nothing of ours that includes Eigen may be included here: this file is compiled as FCL's library
// was (the compiler's own instruction set, with Eigen's packets), since that decides how Eigen's
// matrices are aligned.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/distance-fcl.h"

#include <fcl/narrowphase/distance.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace tw::test {
namespace {

using Geometry = std::unique_ptr<fcl::CollisionGeometryd>;

Geometry geometry_of(const FclSolid& solid) {
  const auto& s = solid.sizes;
  switch (solid.kind) {
    case FclSolid::Kind::ball: return std::make_unique<fcl::Sphered>(s[0]);
    case FclSolid::Kind::box: return std::make_unique<fcl::Boxd>(s[0], s[1], s[2]);
    case FclSolid::Kind::cylinder: return std::make_unique<fcl::Cylinderd>(s[0], s[1]);
    case FclSolid::Kind::cone: return std::make_unique<fcl::Coned>(s[0], s[1]);
    case FclSolid::Kind::capsule: return std::make_unique<fcl::Capsuled>(s[0], s[1]);
    case FclSolid::Kind::ellipsoid: return std::make_unique<fcl::Ellipsoidd>(s[0], s[1], s[2]);
    case FclSolid::Kind::hull: break;
  }
  auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
  for (const auto& x : solid.vertices) vertices->emplace_back(x[0], x[1], x[2]);
  return std::make_unique<fcl::Convexd>(vertices, solid.face_count,
                                        std::make_shared<const std::vector<int>>(solid.faces));
}

fcl::Transform3d placement_of(const FclSolid& solid) {
  fcl::Transform3d placement = fcl::Transform3d::Identity();
  for (int k = 0; k < 9; ++k)
    placement.linear()(k % 3, k / 3) = solid.rotation[static_cast<std::size_t>(k)];
  for (int k = 0; k < 3; ++k)
    placement.translation()[k] = solid.position[static_cast<std::size_t>(k)];
  return placement;
}

FclAnswer answer_to(const FclQuery& query, FclSolver solver) {
  const Geometry a = geometry_of(query.a), b = geometry_of(query.b);
  const fcl::Transform3d place_a = placement_of(query.a), place_b = placement_of(query.b);
  const fcl::DistanceRequestd request(
      true, true, 0, 0, query.tolerance,
      solver == FclSolver::libccd ? fcl::GJKSolverType::GST_LIBCCD : fcl::GJKSolverType::GST_INDEP);
  fcl::DistanceResultd result;
  const auto start = std::chrono::steady_clock::now();
  try {
    fcl::distance(a.get(), place_a, b.get(), place_b, request, result);
  } catch (const std::exception&) {
    return {};
  }
  const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start;
  return {true, result.min_distance, 1e9 * past.count()};
}

}  // namespace

std::vector<FclAnswer> fcl_distances(const std::vector<FclQuery>& queries, FclSolver solver) {
  // answers that children write and the parent reads; all zero at first
  const std::size_t bytes = queries.size() * sizeof(FclAnswer) + sizeof(std::size_t);
  void* shared = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) {
    std::perror("distance-bench: memory for the answers of FCL");
    std::exit(1);
  }
  auto& next = *static_cast<volatile std::size_t*>(shared);
  auto* answers = reinterpret_cast<FclAnswer*>(static_cast<std::size_t*>(shared) + 1);

  // a child goes on behind the query that ended the one before it
  while (next < queries.size()) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) {
      std::perror("distance-bench: a process for FCL");
      std::exit(1);
    }
    if (child == 0) {
      // what it says of poses that it cannot do is counted, not shown
      if (!std::freopen("/dev/null", "w", stderr)) _exit(1);
      while (next < queries.size()) {
        const std::size_t query = next;
        next = query + 1;
        alarm(5);
        answers[query] = answer_to(queries[query], solver);
      }
      _exit(0);
    }
    waitpid(child, nullptr, 0);
  }
  std::vector<FclAnswer> all(answers, answers + queries.size());
  munmap(shared, bytes);
  return all;
}

}  // namespace tw::test
