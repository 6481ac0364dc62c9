// Solids and ground from mesh files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/solid-file.h"

// coordinates as they are written, not rounded to single precision
#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <sstream>

#include "base/error.h"
#include "geometry/mesh-faces.h"
#include "geometry/polyhedron.h"
#include "import/mesh-file.h"
#include "import/solid-pieces.h"

namespace tw {
namespace {

// how deep a dent may be, relative to the size
constexpr double flat = 1e-4;

struct Mesh {
  std::vector<Vec3> points;
  std::vector<MeshObject> objects;
};

// The reader takes for 0 what is no number.
void require_numbers(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "v") continue;
    for (int i = 0; i < 3; ++i) {
      const bool there = static_cast<bool>(words >> word);
      // as in any locale
      double value = 0;
      const char *begin = word.data() + (word[0] == '+'), *end = word.data() + word.size();
      const auto read = std::from_chars(begin, end, value);
      TW_REQUIRE(there && read.ec == std::errc() && read.ptr == end && std::isfinite(value),
                 file + ":" + std::to_string(number) + ": coordinate of a vertex is " +
                     (there ? word : "missing") + "; expected three finite numbers");
    }
  }
}

Mesh read_obj(const std::string& file) {
  std::error_code ignored;
  TW_REQUIRE(std::filesystem::is_regular_file(file, ignored),
             "the mesh " + file + " is missing; expected a file that can be read");
  require_numbers(file);
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  tinyobj::ObjReader reader;
  TW_REQUIRE(reader.ParseFromFile(file, config),
             "the mesh " + file + " cannot be read: " +
                 reader.Error().substr(0, reader.Error().find('\n')) + "; expected an OBJ file");
  Mesh mesh;
  const std::vector<double>& x = reader.GetAttrib().vertices;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3)
    mesh.points.emplace_back(x[i], x[i + 1], x[i + 2]);
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    MeshObject object{shape.name, {}};
    const std::vector<tinyobj::index_t>& corners = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      object.triangles.push_back({static_cast<std::size_t>(corners[i].vertex_index),
                                  static_cast<std::size_t>(corners[i + 1].vertex_index),
                                  static_cast<std::size_t>(corners[i + 2].vertex_index)});
    for (const tinyobj::index_t& corner : corners)
      TW_REQUIRE(corner.vertex_index >= 0 &&
                     static_cast<std::size_t>(corner.vertex_index) < mesh.points.size(),
                 "the mesh " + file + " has a face with the corner " +
                     std::to_string(corner.vertex_index + 1) + ", and " +
                     std::to_string(mesh.points.size()) +
                     " vertices; expected corners that are there");
    if (!object.triangles.empty()) mesh.objects.push_back(std::move(object));
  }
  return mesh;
}

Mesh read_any(const std::string& file) {
  Mesh mesh;
  for (const NamedTriangles& part : mesh_triangles(file)) {
    MeshObject object{part.name, {}};
    for (std::size_t i = 0; i + 2 < part.corners.size(); i += 3)
      object.triangles.push_back(
          {mesh.points.size() + i, mesh.points.size() + i + 1, mesh.points.size() + i + 2});
    mesh.points.insert(mesh.points.end(), part.corners.begin(), part.corners.end());
    mesh.objects.push_back(std::move(object));
  }
  return mesh;
}

// For each point the first one at the same place.
std::vector<std::size_t> same_places(const std::vector<Vec3>& points) {
  std::map<std::array<double, 3>, std::size_t> first;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < points.size(); ++i)
    places.push_back(
        first.emplace(std::array{points[i].x(), points[i].y(), points[i].z()}, i).first->second);
  return places;
}

// An object's triangles by what hangs together, in the order of their first ones.
std::vector<MeshObject> connected(const MeshObject& object, std::size_t points) {
  std::vector<std::size_t> root(points);
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [a, b, c] : object.triangles) {
    root[find(b)] = find(a);
    root[find(c)] = find(a);
  }
  std::map<std::size_t, std::size_t> number;
  std::vector<MeshObject> parts;
  for (const auto& triangle : object.triangles) {
    const auto [found, fresh] = number.emplace(find(triangle[0]), parts.size());
    if (fresh) parts.push_back({object.name, {}});
    parts[found->second].triangles.push_back(triangle);
  }
  return parts;
}

// How far the hull stands out over the plane of a triangle, on the side where it does so less, at
// most, relative to its size: 0 for convex objects.
double deepest_dent(const MeshObject& object, const std::vector<Vec3>& points, const Shape& hull) {
  const std::vector<Vec3>& corners = hull.parts()[0].core->vertices();
  const double size = 2 * hull.parts()[0].bound_radius;
  double deepest = 0;
  for (const auto& [a, b, c] : object.triangles) {
    const Vec3 normal = (points[b] - points[a]).cross(points[c] - points[a]);
    const double area = normal.norm();
    if (!(area > 1e-12 * size * size)) continue;
    double above = 0, below = 0;
    for (const Vec3& corner : corners) {
      const double height = normal.dot(corner - points[a]) / area;
      above = std::max(above, height);
      below = std::max(below, -height);
    }
    deepest = std::max(deepest, std::min(above, below) / size);
  }
  return deepest;
}

// A closed surface with much less within it than its hull, however shallow its dents are: walls.
bool is_thin_walled(const MeshObject& object, const std::vector<Vec3>& points, const Shape& hull) {
  return is_closed(object.triangles) &&
         std::abs(volume_within(object, points)) < 0.9 * hull.mass_properties().volume;
}

std::string title(const MeshObject& object, std::size_t number, std::size_t count) {
  if (!object.name.empty()) return "the object " + object.name;
  return count == 1 ? "it" : "its object " + std::to_string(number + 1);
}

ShapePtr hull_of(const MeshObject& object, const std::vector<Vec3>& points) {
  std::vector<Vec3> corners;
  for (const auto& triangle : object.triangles)
    for (const std::size_t corner : triangle) corners.push_back(points[corner]);
  return make_hull(corners);
}

// In the frame and unit of the shape; at least one triangle.
Mesh read_mesh(const std::string& file, const SolidOptions& options) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Mesh mesh = suffix == ".obj" ? read_obj(file) : read_any(file);
  TW_REQUIRE(!mesh.objects.empty(),
             "the mesh " + file + " has no faces; expected some that enclose a volume");
  for (Vec3& point : mesh.points) {
    TW_REQUIRE(is_finite(point),
               "the mesh " + file + " has a vertex that is not finite; expected numbers");
    if (options.y_up) point = Vec3(point.x(), -point.z(), point.y());
    point = point.cwiseProduct(options.scale);
  }
  return mesh;
}

}  // namespace

void mend_triangles(const std::string& where, const MeshFaults& faults, Mending& mending) {
  if (faults.thin > 0)
    mending.mend(where, several(faults.thin, "triangle") + " without an area", "left out",
                 "three corners apart from each other and not in a line");
  if (faults.doubled > 0)
    mending.mend(where,
                 several(faults.doubled, "triangle") + " on others" +
                     (faults.back_to_back > 0
                          ? ", " + std::to_string(faults.back_to_back) + " of them back to back"
                          : ""),
                 "left out: what is beneath the front of the first one is solid",
                 "one triangle at a place");
  if (faults.turned > 0)
    mending.mend(where,
                 several(faults.turned, "triangle") + " facing the other way than those around",
                 "turned", "corners counter-clockwise from outside");
  if (faults.crowded_sides > 0)
    mending.mend(where, several(faults.crowded_sides, "side") + " of more than two triangles",
                 "none of them is taken for the other's neighbour", "two triangles at a side");
}

void GroundReader::add(const std::string& file, const SolidOptions& options, const Pose& pose) {
  const Mesh mesh = read_mesh(file, options);
  const auto first = static_cast<std::uint32_t>(points_.size());
  for (const Vec3& p : mesh.points) points_.push_back(pose.q * p + pose.p);
  // a scale of odd sign turns all of them inside out
  const bool mirrored = options.scale.prod() < 0;
  for (const MeshObject& object : mesh.objects)
    for (const auto& [a, b, c] : object.triangles)
      triangles_.push_back({first + static_cast<std::uint32_t>(a),
                            first + static_cast<std::uint32_t>(mirrored ? c : b),
                            first + static_cast<std::uint32_t>(mirrored ? b : c)});
  files_.push_back({file, triangles_.size()});
}

// A closed surface without dents has the volume of its hull; one that is open has less, seen from
// the hull's middle.
static bool is_its_hull(const std::vector<Vec3>& points, std::span<const MeshTriangle> triangles) {
  std::vector<Vec3> corners;
  for (const MeshTriangle& t : triangles)
    for (const std::uint32_t corner : t) corners.push_back(points[corner]);
  try {
    const ShapePtr hull = make_hull(corners);
    const MassProperties& mass = hull->mass_properties();
    double volume = 0;
    for (const MeshTriangle& t : triangles) {
      const Vec3 a = points[t[0]] - mass.centroid, b = points[t[1]] - mass.centroid,
                 c = points[t[2]] - mass.centroid;
      volume += a.dot(b.cross(c)) / 6;
    }
    return std::abs(std::abs(volume) - mass.volume) <= flat * mass.volume;
  } catch (const UserError&) {
    return false;
  }
}

bool GroundReader::is_convex() const {
  std::size_t first = 0;
  for (const File& file : files_) {
    if (!is_its_hull(points_, std::span(triangles_).subspan(first, file.end - first))) return false;
    first = file.end;
  }
  return true;
}

ShapePtr GroundReader::shape() {
  const std::string what =
      "the mesh " + files_.front().name + (files_.size() > 1 ? " and others: " : ": ");
  MeshFaults faults;
  try {
    ShapePtr shape = make_mesh(points_, triangles_, &faults);
    mend_triangles(what, faults, mending_);
    return shape;
  } catch (const UserError& error) {
    throw UserError(what + error.what());
  }
}

namespace {

// The hull of each part, or its pieces; null where that is flat, or a cavity of another.
std::vector<ShapePtr> hulls_of(const std::string& file, const std::vector<Vec3>& points,
                               const std::vector<MeshObject>& parts, const SolidOptions& options,
                               Mending& mending) {
  std::vector<ShapePtr> shapes;
  std::size_t flat_parts = 0;
  std::string first_flat;
  std::vector<std::optional<std::size_t>> hosts(parts.size());
  if (options.decompose > 0) hosts = hosts_of_cavities(parts, points);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (hosts[i]) {
      shapes.push_back(nullptr);
      continue;
    }
    const std::string what = title(parts[i], i, parts.size());
    try {
      shapes.push_back(hull_of(parts[i], points));
    } catch (const UserError& error) {
      // a stray triangle, a sheet
      if (flat_parts++ == 0) first_flat = what + " has no hull: " + error.what();
      shapes.push_back(nullptr);
      continue;
    }
    if (options.hulls) continue;
    const double dent = deepest_dent(parts[i], points, *shapes.back());
    const bool dented = dent > flat;
    if (options.decompose == 0)
      TW_REQUIRE(
          !dented && !is_thin_walled(parts[i], points, *shapes.back()),
          "the mesh " + file + ": " + what + " isn't convex: " +
              (dented ? "its hull stands " + show(dent) + " of its size over one of its faces"
                      : "it encloses less than its hull") +
              "; expected objects that are convex each, which make a union, or #:concave? #t "
              "for ground as it is, #:decompose #t for convex pieces, or #:convex-hull? #t "
              "for the hull of each");
    else if (dented || std::find(hosts.begin(), hosts.end(), i) != hosts.end() ||
             is_thin_walled(parts[i], points, *shapes.back()))
      shapes.back() = decomposed("the mesh " + file + ": " + what, i, parts, points, hosts,
                                 options.decompose, mending);
  }
  if (flat_parts == shapes.size())
    throw UserError("the mesh " + file + ": " + first_flat + ", or #:concave? #t for ground");
  if (flat_parts > 0) {
    std::string others;
    if (flat_parts > 1)
      others = std::to_string(flat_parts) + " of " + std::to_string(parts.size()) +
               " parts have no hull, the first: ";
    mending.mend("the mesh " + file + ": ", others, UserError(first_flat),
                 flat_parts > 1 ? "they are left out" : "it is left out");
  }
  return shapes;
}

ShapePtr united(std::vector<ShapePtr> shapes) {
  std::erase(shapes, nullptr);
  if (shapes.empty()) return nullptr;
  return shapes.size() == 1 ? shapes[0] : make_union(shapes);
}

// What hangs together by common places; for each part the number of its object.
std::vector<MeshObject> parts_of(Mesh& mesh, std::vector<std::size_t>& objects) {
  const std::vector<std::size_t> places = same_places(mesh.points);
  std::vector<MeshObject> parts;
  for (std::size_t i = 0; i < mesh.objects.size(); ++i) {
    for (auto& triangle : mesh.objects[i].triangles)
      for (std::size_t& corner : triangle) corner = places[corner];
    const std::vector<MeshObject> pieces = connected(mesh.objects[i], mesh.points.size());
    parts.insert(parts.end(), pieces.begin(), pieces.end());
    objects.resize(parts.size(), i);
  }
  return parts;
}

// The names of a file, those that come again or are missing with numbers.
std::vector<std::string> names_of(const std::vector<MeshObject>& objects) {
  std::set<std::string> taken;
  for (const MeshObject& object : objects) taken.insert(object.name);
  std::map<std::string, int> times;
  std::vector<std::string> names;
  for (const MeshObject& object : objects) {
    std::string name = object.name.empty() ? "object" : object.name;
    int& time = times[name];
    if (++time > 1 || object.name.empty()) {
      const std::string stem = name + "-";
      while (!taken.insert(name = stem + std::to_string(time)).second) ++time;
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace

ShapePtr read_solid(const std::string& file, const SolidOptions& options, Mending& mending) {
  Mesh mesh = read_mesh(file, options);
  std::vector<std::size_t> objects;
  const std::vector<MeshObject> parts = parts_of(mesh, objects);
  return united(hulls_of(file, mesh.points, parts, options, mending));
}

std::vector<NamedShape> read_objects(const std::string& file, const SolidOptions& options,
                                     Mending& mending) {
  Mesh mesh = read_mesh(file, options);
  std::vector<std::size_t> objects;
  const std::vector<MeshObject> parts = parts_of(mesh, objects);
  // a file that names nothing has its parts as objects
  const bool whole = mesh.objects.size() == 1;
  const std::vector<ShapePtr> hulls = hulls_of(file, mesh.points, parts, options, mending);
  const std::vector<std::string> names = names_of(whole ? parts : mesh.objects);
  std::vector<NamedShape> named;
  for (std::size_t i = 0, next = 0; i < parts.size(); i = next) {
    for (next = i + 1; !whole && next < parts.size() && objects[next] == objects[i];) ++next;
    const auto from = hulls.begin() + static_cast<std::ptrdiff_t>(i),
               to = hulls.begin() + static_cast<std::ptrdiff_t>(next);
    if (const ShapePtr shape = united({from, to}))
      named.push_back({names[whole ? i : objects[i]], shape});
  }
  return named;
}

}  // namespace tw
