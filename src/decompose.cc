// timewarp-decompose: a closed surface, however concave, as convex cells; a program of its own,
// which (timewarp) starts where somebody asks for that.
//
// Method: exact decomposition of a Nef polyhedron along its reflex edges (P. Hachenberger, Exact
// Minkowski sums of polyhedra and exact and efficient decomposition of polyhedra into convex
// pieces, Algorithmica 55, 2009; CGAL).  Its cost grows with the square of the number of these
// edges, so that a surface of many triangles is simplified first.
//
// Input, text: the number of triangles that are decomposed, at most; the number of surfaces; of
// each 1 where it is solid or -1 where it is a cavity of the first one, its numbers of points and
// triangles, the points and the triangles, by numbers of points from 0.
// Output: "cells", the volume within the surfaces, the number of holes that were closed, that of
// triangles that were decomposed, the number of cells, and of each its number of points and the
// points, and "end"; or "error" and what is wrong.
//
// The licence of the parts of CGAL that this program consists of is the GPL.
//
// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/copy_face_graph.h>
#include <CGAL/convex_decomposition_3.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Inexact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Inexact::Point_3>;
using Polyhedron = CGAL::Polyhedron_3<Exact>;
using Nef = CGAL::Nef_polyhedron_3<Exact>;

struct Soup {
  std::vector<Inexact::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
};

template <class T>
T read() {
  T value;
  if (!(std::cin >> value)) throw std::runtime_error("the input ends too early");
  return value;
}

Soup read_soup() {
  Soup soup;
  const auto points = read<std::size_t>(), triangles = read<std::size_t>();
  for (std::size_t i = 0; i < points; ++i) {
    const auto x = read<double>(), y = read<double>(), z = read<double>();
    soup.points.emplace_back(x, y, z);
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    std::vector<std::size_t> corners;
    for (int k = 0; k < 3; ++k) {
      corners.push_back(read<std::size_t>());
      if (corners.back() >= points) throw std::runtime_error("a corner is no point");
    }
    soup.triangles.push_back(corners);
  }
  return soup;
}

// Closed surfaces that hang together, outside outside: those within others face inwards.  The holes
// that were closed are counted.
std::vector<Surface> closed_surfaces(Soup soup, std::size_t& holes) {
  pmp::repair_polygon_soup(soup.points, soup.triangles);
  pmp::orient_polygon_soup(soup.points, soup.triangles);
  Surface all;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, all);
  std::vector<Surface::Halfedge_index> borders;
  pmp::extract_boundary_cycles(all, std::back_inserter(borders));
  holes += borders.size();
  for (const Surface::Halfedge_index border : borders) {
    std::vector<Surface::Face_index> lid;
    pmp::triangulate_hole(all, border, std::back_inserter(lid));
  }
  if (!CGAL::is_closed(all)) throw std::runtime_error("has holes that cannot be closed");
  pmp::orient_to_bound_a_volume(all);
  std::vector<Surface> surfaces;
  pmp::split_connected_components(all, surfaces);
  return surfaces;
}

// How many edges the solid is concave at.  Those of flat faces, which rounding bends, don't count.
std::size_t reflex_edges(const Surface& surface) {
  std::size_t count = 0;
  for (const Surface::Edge_index edge : surface.edges()) {
    const Surface::Halfedge_index h = surface.halfedge(edge);
    const auto& a = surface.point(surface.source(h));
    const auto& b = surface.point(surface.target(h));
    const auto& c = surface.point(surface.target(surface.next(h)));
    const auto& d = surface.point(surface.target(surface.next(surface.opposite(h))));
    const auto normal = CGAL::cross_product(b - a, c - a);
    const double height = normal * (d - a);
    count += height > 1e-9 * std::sqrt(normal.squared_length() * (d - a).squared_length());
  }
  return count;
}

// With about so many triangles; edges collapse by quadric errors where no triangle turns over.
Surface simplified(Surface surface, std::size_t triangles) {
  namespace simplification = CGAL::Surface_mesh_simplification;
  simplification::Count_stop_predicate<Surface> stop(triangles * 3 / 2);  // edges
  const simplification::GarlandHeckbert_plane_policies<Surface, Inexact> errors(surface);
  simplification::edge_collapse(surface, stop,
                                CGAL::parameters::get_cost(errors.get_cost())
                                    .get_placement(errors.get_placement())
                                    .filter(simplification::Bounded_normal_change_filter<>()));
  surface.collect_garbage();
  return surface;
}

// The same solid by a surface that does not cut itself.  One of more than `most` triangles, and of
// many concave edges, has about so many: more or fewer where that folds it.
Surface prepared(const Surface& whole, std::size_t most) {
  const std::size_t triangles = whole.number_of_faces();
  const bool large = triangles > most && reflex_edges(whole) > most / 2;
  if (large)
    for (const double more : {1.0, 0.85, 1.2, 0.7, 1.5, 2.0}) {
      const Surface fewer = simplified(whole, static_cast<std::size_t>(more * double(most)));
      if (!pmp::does_self_intersect(fewer)) return fewer;
    }
  if (pmp::does_self_intersect(whole)) throw std::runtime_error("cuts itself");
  if (large && triangles > 2 * most)
    throw std::runtime_error("cuts itself where it is simplified to " + std::to_string(most) +
                             " triangles");
  return whole;
}

Nef solid_of(const Surface& surface) {
  Polyhedron polyhedron;
  CGAL::copy_face_graph(surface, polyhedron);
  return Nef(polyhedron);
}

void add_cells(Nef solid, std::vector<Polyhedron>& cells) {
  CGAL::convex_decomposition_3(solid);
  // the first volume is the outer one
  for (auto volume = ++solid.volumes_begin(); volume != solid.volumes_end(); ++volume) {
    if (!volume->mark()) continue;
    cells.emplace_back();
    solid.convert_inner_shell_to_polyhedron(volume->shells_begin(), cells.back());
  }
}

void decompose() {
  const auto most = read<std::size_t>();
  std::vector<Nef> solids;
  Surface cavities;
  std::size_t holes = 0, triangles = 0;
  double volume = 0;
  for (auto surfaces = read<std::size_t>(); surfaces > 0; --surfaces) {
    const bool is_cavity = read<int>() < 0;
    for (Surface& whole : closed_surfaces(read_soup(), holes)) {
      const bool faces_in = !pmp::is_outward_oriented(whole);
      if (faces_in) pmp::reverse_face_orientations(whole);
      const bool solid = is_cavity == faces_in;
      const Surface surface = prepared(whole, most);
      volume += (solid ? 1 : -1) * CGAL::to_double(pmp::volume(whole));
      triangles += surface.number_of_faces();
      if (solid)
        solids.push_back(solid_of(surface));
      else
        cavities += surface;
    }
  }
  const bool hollow = cavities.number_of_faces() > 0;
  const Nef all_cavities = hollow ? solid_of(cavities) : Nef();
  std::vector<Polyhedron> cells;
  for (const Nef& solid : solids) add_cells(hollow ? solid - all_cavities : solid, cells);
  std::printf("cells %.17g %zu %zu %zu\n", volume, holes, triangles, cells.size());
  for (const Polyhedron& cell : cells) {
    std::printf("%zu\n", cell.size_of_vertices());
    for (auto p = cell.points_begin(); p != cell.points_end(); ++p)
      std::printf("%.17g %.17g %.17g\n", CGAL::to_double(p->x()), CGAL::to_double(p->y()),
                  CGAL::to_double(p->z()));
  }
  std::puts("end");
}

}  // namespace

int main(int argc, char**) {
  if (argc > 1) {
    std::puts(
        "Usage: timewarp-decompose < SURFACE > CELLS\n"
        "Splits a closed surface into convex cells; load-shape #:decompose starts it.");
    return 0;
  }
  CGAL::set_error_behaviour(CGAL::THROW_EXCEPTION);
  CGAL::set_warning_behaviour(CGAL::CONTINUE);
  try {
    decompose();
  } catch (const CGAL::Failure_exception&) {
    std::puts("error is no surface that bounds a solid");
  } catch (const std::bad_alloc&) {
    std::puts("error needs more memory than it may have");
  } catch (const std::exception& error) {
    std::printf("error %s\n", error.what());
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}
