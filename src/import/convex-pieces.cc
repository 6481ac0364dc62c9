// Starting timewarp-decompose, and joining its cells.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/convex-pieces.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <queue>
#include <sstream>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "geometry/hull.h"
#include "geometry/mass-properties.h"
#include "import/bounded-process.h"
#include "math/aabb.h"

namespace tw {

namespace {

constexpr double joined_more = 1.2;  // of the volume, by the triangles: what joining two may add
constexpr double nothing = 1e-7;     // of the volume: cells so small are left out

// ---- the program ----

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporary_file() {
  File file(std::tmpfile(), &std::fclose);
  TW_REQUIRE(file, "a temporary file cannot be made; expected room in /tmp");
  return file;
}

// Beside this program, as where it is built and where it is installed; else of PATH.
std::string decomposer() {
  const std::string name = "timewarp-decompose";
  std::error_code error;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
  return !error && access(beside.c_str(), X_OK) == 0 ? beside.string() : name;
}

void write_input(std::FILE* file, const std::vector<Vec3>& points,
                 const std::vector<ClosedSurface>& surfaces, std::size_t most) {
  std::fprintf(file, "%zu\n%zu\n", most, surfaces.size());
  for (const ClosedSurface& surface : surfaces) {
    std::vector<std::size_t> number(points.size(), points.size());
    std::vector<std::size_t> used;
    for (const auto& triangle : surface.triangles)
      for (const std::size_t corner : triangle) {
        if (number[corner] < points.size()) continue;
        number[corner] = used.size();
        used.push_back(corner);
      }
    std::fprintf(file, "%d %zu %zu\n", surface.cavity ? -1 : 1, used.size(),
                 surface.triangles.size());
    for (const std::size_t point : used) {
      const Vec3& p = points[point];
      std::fprintf(file, "%.17g %.17g %.17g\n", p.x(), p.y(), p.z());
    }
    for (const auto& [a, b, c] : surface.triangles)
      std::fprintf(file, "%zu %zu %zu\n", number[a], number[b], number[c]);
  }
  std::rewind(file);
}

// In a process that has bounds: all that the program writes.
std::vector<char> run_decomposer(std::FILE* input) {
  const std::string program = decomposer();
  const File output = temporary_file();
  const pid_t parent = getpid(), child = fork();
  TW_REQUIRE(child >= 0, "no process can be started for " + program);
  if (child == 0) {
    // it ends with its parent
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() == parent && dup2(fileno(input), STDIN_FILENO) >= 0 &&
        dup2(fileno(output.get()), STDOUT_FILENO) >= 0)
      execlp(program.c_str(), program.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  TW_REQUIRE(!(WIFEXITED(status) && WEXITSTATUS(status) == 127),
             "timewarp-decompose, which splits what is not convex, is not there; expected timewarp "
             "built with CGAL: on Debian, apt-get install libcgal-dev, then configure and build "
             "again");
  // ended as by its bounds: so is this process
  if (WIFSIGNALED(status)) std::raise(WTERMSIG(status));
  std::rewind(output.get());
  std::vector<char> all, block(1 << 16);
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), output.get()))
    all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
  return all;
}

// ---- joining cells ----

struct Cell {
  std::vector<Vec3> points;  // the corners of its hull
  double hull = 0;           // the volume of that
  double own = 0;            // that of the cells in it
  Aabb bounds;
  int version = 0;
  bool gone = false;
};

// None where it is flat.
std::optional<Cell> hull_cell(std::vector<Vec3> points) {
  try {
    const Polyhedron hull = convex_hull(points);
    Cell cell;
    cell.points = hull.vertices();
    cell.hull = cell.own = polyhedron_mass(hull).volume;
    for (const Vec3& point : cell.points) cell.bounds.add(point);
    return cell;
  } catch (const UserError&) {
    return std::nullopt;
  }
}

std::vector<Vec3> points_of_both(const Cell& a, const Cell& b) {
  std::vector<Vec3> points = a.points;
  points.insert(points.end(), b.points.begin(), b.points.end());
  return points;
}

// Cells join two by two, those first that add least: at most the share `most` of the whole volume.
class Joining {
 public:
  Joining(std::vector<Cell> cells, double size, double most)
      : cells_(std::move(cells)), near_(1e-6 * size), most_(most) {
    for (const Cell& cell : cells_) whole_ += cell.own;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      for (std::size_t j = i + 1; j < cells_.size(); ++j) look_at(i, j);
    while (!pairs_.empty()) {
      const Pair pair = pairs_.top();
      pairs_.pop();
      const Cell &a = cells_[pair.i], &b = cells_[pair.j];
      if (!a.gone && !b.gone && a.version == pair.version_i && b.version == pair.version_j)
        join(pair.i, pair.j);
    }
  }

  std::vector<Cell> take() {
    std::erase_if(cells_,
                  [&](const Cell& cell) { return cell.gone || cell.own <= nothing * whole_; });
    return std::move(cells_);
  }

 private:
  struct Pair {
    double more;
    std::size_t i, j;
    int version_i, version_j;
    bool operator<(const Pair& other) const {
      return std::tuple(more, i, j) > std::tuple(other.more, other.i, other.j);
    }
  };

  void look_at(std::size_t i, std::size_t j) {
    const Cell &a = cells_[i], &b = cells_[j];
    Aabb wide = a.bounds;
    wide.grow(near_);
    if (!wide.overlaps(b.bounds)) return;
    const std::optional<Cell> both = hull_cell(points_of_both(a, b));
    if (!both) return;
    const double more = both->hull - a.own - b.own;
    if (more <= most_ * whole_) pairs_.push({more, i, j, a.version, b.version});
  }

  void join(std::size_t i, std::size_t j) {
    Cell& kept = cells_[i];
    Cell both = *hull_cell(points_of_both(kept, cells_[j]));
    both.own = kept.own + cells_[j].own;
    both.version = kept.version + 1;
    kept = std::move(both);
    cells_[j] = {};
    cells_[j].gone = true;
    for (std::size_t k = 0; k < cells_.size(); ++k)
      if (k != i && !cells_[k].gone) look_at(std::min(i, k), std::max(i, k));
  }

  std::vector<Cell> cells_;
  std::priority_queue<Pair> pairs_;
  double near_, most_, whole_ = 0;
};

}  // namespace

ConvexPieces convex_pieces(const std::string& what, const std::vector<Vec3>& points,
                           const std::vector<ClosedSurface>& surfaces, std::size_t most) {
  const File input = temporary_file();
  write_input(input.get(), points, surfaces, most);
  const Bounds bounds{.memory = std::uint64_t{4} << 30,
                      .seconds = 120,
                      .worker = "its decomposition",
                      .expected = "fewer triangles, or #:convex-hull? #t"};
  const std::vector<char> written =
      done_within(bounds, what, [&] { return run_decomposer(input.get()); });
  std::istringstream words(std::string(written.begin(), written.end()));
  std::string first;
  words >> first;
  if (first == "error") {
    std::string why;
    std::getline(words, why);
    throw UserError(what + why +
                    "; expected a surface that encloses a solid, to be decomposed, or "
                    "#:convex-hull? #t");
  }
  ConvexPieces result;
  std::size_t count = 0;
  words >> result.surface_volume >> result.holes >> result.triangles >> count;
  std::vector<Cell> cells;
  Aabb bounds_of_all;
  for (std::size_t i = 0; i < count && words; ++i) {
    std::size_t corners = 0;
    words >> corners;
    std::vector<Vec3> cell;
    for (std::size_t k = 0; k < corners && words; ++k) {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      cell.push_back(p);
      bounds_of_all.add(p);
    }
    if (auto hull = hull_cell(std::move(cell))) cells.push_back(*std::move(hull));
  }
  TW_REQUIRE(first == "cells" && words && !cells.empty(),
             what + " has no decomposition; expected a surface that encloses a solid");
  for (const Cell& cell :
       Joining(std::move(cells), bounds_of_all.size().norm(), joined_more / double(most)).take()) {
    result.pieces.push_back(make_hull(cell.points));
    result.volume += cell.hull;
  }
  return result;
}

}  // namespace tw
