// Starting timewarp-decompose, and reading its cells.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/convex-pieces.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "geometry/hull.h"
#include "geometry/mass-properties.h"
#include "import/bounded-process.h"
#include "import/joined-cells.h"

namespace tw {

namespace {

constexpr double height_by_triangles = 4;  // of the size, over the triangles: see the header
constexpr double nothing = 1e-9;           // of the volume: cells so small are left out

// ---- the program ----

// A file in memory.
class MemoryFile {
 public:
  MemoryFile() : file_(memfd_create("timewarp", MFD_CLOEXEC)) {
    TW_REQUIRE(file_ >= 0, std::string("no memory for a file: ") + std::strerror(errno));
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return file_; }
  void write_all(const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t written = write(file_, text.data() + at, text.size() - at);
      if (written < 0 && errno == EINTR) continue;
      TW_REQUIRE(written > 0, std::string("no memory for a file: ") + std::strerror(errno));
      at += static_cast<std::size_t>(written);
    }
    lseek(file_, 0, SEEK_SET);
  }
  std::vector<char> read_all() {
    lseek(file_, 0, SEEK_SET);
    std::vector<char> all, block(1 << 16);
    for (;;) {
      const ssize_t size = read(file_, block.data(), block.size());
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) return all;
      all.insert(all.end(), block.begin(), block.begin() + size);
    }
  }

 private:
  int file_;
};

// Beside this program, where it is installed, or of PATH.
std::string decomposer() {
  const std::string name = "timewarp-decompose";
  std::error_code ignored;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  for (const auto& folder : {self.parent_path(), std::filesystem::path(TW_BIN_DIR)})
    if (access((folder / name).c_str(), X_OK) == 0) return (folder / name).string();
  return name;
}

// As in any locale.
void append_number(std::string& text, double x) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
  text += ' ';
}

std::string input_of(const std::vector<Vec3>& points, const std::vector<ClosedSurface>& surfaces,
                     std::size_t most) {
  std::string text = std::to_string(most) + " " + std::to_string(surfaces.size()) + "\n";
  std::vector<std::size_t> number(points.size(), points.size());
  for (const ClosedSurface& surface : surfaces) {
    std::vector<std::size_t> used;
    for (const auto& triangle : surface.triangles)
      for (const std::size_t corner : triangle) {
        if (number[corner] < points.size()) continue;
        number[corner] = used.size();
        used.push_back(corner);
      }
    text += (surface.cavity ? "-1 " : "1 ") + std::to_string(used.size()) + " " +
            std::to_string(surface.triangles.size()) + "\n";
    for (const std::size_t point : used)
      for (const double x : points[point]) append_number(text, x);
    for (const auto& triangle : surface.triangles)
      for (const std::size_t corner : triangle) text += std::to_string(number[corner]) + " ";
    text += '\n';
    for (const std::size_t point : used) number[point] = points.size();
  }
  return text;
}

// In a process that has bounds: all that the program writes.
std::vector<char> run_decomposer(const std::string& what, const MemoryFile& input) {
  const std::string program = decomposer();
  MemoryFile output;
  const pid_t parent = getpid(), child = fork();
  TW_REQUIRE(child >= 0, what + ": no process can be started for timewarp-decompose");
  if (child == 0) {
    // it ends with its parent
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() == parent && dup2(input.descriptor(), STDIN_FILENO) >= 0 &&
        dup2(output.descriptor(), STDOUT_FILENO) >= 0)
      execlp(program.c_str(), program.c_str(), static_cast<char*>(nullptr));
    _exit(errno == ENOENT ? 127 : 126);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  TW_REQUIRE(code != 127,
             what +
                 ": timewarp-decompose, which splits what is not convex, is not there or cannot "
                 "be started; expected timewarp built with CGAL: on Debian, apt-get install "
                 "libcgal-dev, then configure and build again");
  TW_REQUIRE(code == 0, what + ": timewarp-decompose ended with status " + std::to_string(code));
  // ended as by its bounds: so is this process
  if (WIFSIGNALED(status)) std::raise(WTERMSIG(status));
  return output.read_all();
}

}  // namespace

ConvexPieces convex_pieces(const std::string& what, const std::vector<Vec3>& points,
                           const std::vector<ClosedSurface>& surfaces, std::size_t most) {
  MemoryFile input;
  input.write_all(input_of(points, surfaces, most));
  const Bounds bounds{.memory = std::uint64_t{4} << 30,
                      .seconds = 120,
                      .worker = "timewarp-decompose",
                      .expected = "fewer triangles, or #:convex-hull? #t"};
  const std::vector<char> written =
      done_within(bounds, what, [&] { return run_decomposer(what, input); });
  std::istringstream words(std::string(written.begin(), written.end()));
  words.imbue(std::locale::classic());
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
  words >> result.volume >> result.holes >> result.triangles >> count;
  std::vector<Polyhedron> cells;
  std::vector<MassProperties> masses;
  Aabb box;
  for (std::size_t i = 0; i < count && words; ++i) {
    std::size_t corners = 0;
    words >> corners;
    std::vector<Vec3> cell;
    for (std::size_t k = 0; k < corners && words; ++k) {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      cell.push_back(p);
    }
    try {
      Polyhedron hull = convex_hull(cell);
      const MassProperties mass = polyhedron_mass(hull);
      if (mass.volume <= nothing * result.volume) continue;
      box.add(hull.bounds());
      cells.push_back(std::move(hull));
      masses.push_back(mass);
    } catch (const UserError&) {
      // flat: it holds nothing
    }
  }
  std::string last;
  words >> last;
  TW_REQUIRE(first == "cells" && last == "end",
             what + ": what timewarp-decompose wrote is cut short");
  TW_REQUIRE(!cells.empty(),
             what + " has no decomposition; expected a surface that encloses a solid");
  std::vector<ShapePtr> pieces;
  const double height = height_by_triangles / static_cast<double>(most) * box.size().norm();
  for (const Polyhedron& piece : joined_cells(cells, height))
    pieces.push_back(make_hull(piece.vertices()));
  result.pieces = pieces.size();
  result.shape = make_union(pieces, summed_mass(masses));
  return result;
}

}  // namespace tw
