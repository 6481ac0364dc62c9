// Scheme primitives: shapes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/interruption.h"
#include "geometry/shape.h"

#include "import/solid-file.h"
#include "import/surface-file.h"
#include "script/file-names.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_shapes)

TW_PRIMITIVE(sphere, "%sphere", (SCM radius), "Return a sphere.") {
  return from_shape(make_sphere(to_real(radius, "radius")));
}

TW_PRIMITIVE(box, "%box", (SCM x, SCM y, SCM z), "Return a box with full edges x, y, z.") {
  return from_shape(make_box({to_real(x, "edge x"), to_real(y, "edge y"), to_real(z, "edge z")}));
}

TW_PRIMITIVE(cylinder, "%cylinder", (SCM radius, SCM length), "Return a cylinder about z.") {
  return from_shape(make_cylinder(to_real(radius, "radius"), to_real(length, "length")));
}

TW_PRIMITIVE(capsule, "%capsule", (SCM radius, SCM length), "Return a capsule about z.") {
  return from_shape(make_capsule(to_real(radius, "radius"), to_real(length, "length")));
}

TW_PRIMITIVE(cone, "%cone", (SCM radius, SCM height), "Return a cone about z.") {
  return from_shape(make_cone(to_real(radius, "radius"), to_real(height, "height")));
}

TW_PRIMITIVE(ellipsoid, "%ellipsoid", (SCM a, SCM b, SCM c),
             "Return an ellipsoid with semi-axes a, b, c.") {
  return from_shape(make_ellipsoid(
      {to_real(a, "semi-axis a"), to_real(b, "semi-axis b"), to_real(c, "semi-axis c")}));
}

TW_PRIMITIVE(convex, "%convex", (SCM points), "Return the convex hull of points.") {
  return from_shape(make_hull(to_points(points, "points")));
}

namespace {

// An array of rank 2, by rows.  Elements are taken one by one: those of a typed array are made
// anew, and nothing but the stack would keep them.
class Grid {
 public:
  Grid(SCM array, const char* name, const char* expected) {
    if (!scm_is_true(scm_array_p(array, SCM_UNDEFINED)) || scm_c_array_rank(array) != 2)
      throw BadValue{name, array, expected};
    scm_array_get_handle(array, &handle_);
    dims_ = scm_array_handle_dims(&handle_);
  }
  ~Grid() { scm_array_handle_release(&handle_); }
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;

  std::size_t rows() const { return length(dims_[0]); }
  std::size_t columns() const { return length(dims_[1]); }
  // Row by row.
  template <class Visit>
  void each(Visit&& visit) {
    for (std::size_t i = 0; i < rows(); ++i)
      for (std::size_t j = 0; j < columns(); ++j)
        visit(scm_array_handle_ref(&handle_, static_cast<ssize_t>(i) * dims_[0].inc +
                                                 static_cast<ssize_t>(j) * dims_[1].inc));
  }

 private:
  static std::size_t length(const scm_t_array_dim& dim) {
    return static_cast<std::size_t>(dim.ubnd - dim.lbnd + 1);
  }
  scm_t_array_handle handle_;
  const scm_t_array_dim* dims_;
};

}  // namespace

// The colours of the points of a height field, row by row.
static std::vector<Vec3> to_colors(SCM array, std::size_t rows, std::size_t columns) {
  constexpr const char* expected = "an array of rank 2 of colors, with rows as the heights have";
  Grid grid(array, "colors", expected);
  if (grid.rows() != rows || grid.columns() != columns) throw BadValue{"colors", array, expected};
  std::vector<Vec3> colors;
  grid.each([&](SCM color) { colors.push_back(to_vec3(color, "a color of the ground")); });
  return colors;
}

// Row by row; `columns` in a row.
static std::vector<double> to_rows(SCM array, std::size_t& columns) {
  constexpr const char* expected = "an array of rank 2 of numbers, in metres";
  Grid grid(array, "heights", expected);
  columns = grid.columns();
  std::vector<double> numbers;
  grid.each([&](SCM value) {
    if (!scm_is_real(value)) throw BadValue{"heights", value, expected};
    numbers.push_back(scm_to_double(value));
  });
  return numbers;
}

TW_PRIMITIVE(height_field, "%height-field", (SCM heights, SCM spacing, SCM colors),
             "Return the ground with these heights; colors: an array, or #f.") {
  constexpr const char* expected = "a number of metres, or #(dx dy) of them";
  std::vector<SCM> apart{spacing, spacing};
  if (!scm_is_real(spacing)) apart = to_elements(spacing, "spacing", expected);
  if (apart.size() != 2) throw BadValue{"spacing", spacing, expected};
  const double x = to_real(apart[0], "spacing along x"), y = to_real(apart[1], "spacing along y");
  std::size_t columns = 0;
  std::vector<double> numbers = to_rows(heights, columns);
  TW_REQUIRE(!numbers.empty(), "the heights are an empty array; expected at least 2 rows of 2");
  std::vector<Vec3> painted;
  if (scm_is_true(colors)) painted = to_colors(colors, numbers.size() / columns, columns);
  return from_shape(make_height_field(std::move(numbers), columns, x, y, std::move(painted)));
}

namespace {

Vec3 to_scale(SCM scale) {
  const Vec3 factors = scm_is_real(scale) ? Vec3(Vec3::Constant(to_finite(scale, "scale")))
                                          : to_vec3(scale, "scale");
  if (!(factors.cwiseAbs().minCoeff() > 0)) throw BadValue{"scale", scale, "no factor of 0"};
  return factors;
}

}  // namespace

TW_PRIMITIVE(
    load_shape, "%load-shape",
    (SCM file, SCM scale, SCM kind, SCM decompose, SCM by_objects, SCM y_up, SCM strict),
    "Return (SHAPE . NOTES) of a mesh file, or (((NAME . SHAPE) ...) . NOTES); kind: convex, "
    "hulls, pieces or concave; decompose: of pieces, the number of triangles.") {
  const InterruptionCheck check(look_for_signals);
  SolidOptions options;
  const std::string wanted = to_symbol_name(kind, "the kind");
  options.hulls = wanted == "hulls";
  if (wanted == "pieces") options.decompose = scm_to_size_t(decompose);
  options.y_up = scm_is_true(y_up);
  options.scale = to_scale(scale);
  Mending mending(scm_is_true(strict));
  const std::string name = to_file_name(file, "the file");
  if (scm_is_true(by_objects)) {
    SCM all = SCM_EOL;
    for (const NamedShape& one : read_objects(name, options, mending))
      all = scm_acons(from_string(one.name), from_shape(one.shape), all);
    return scm_cons(scm_reverse_x(all, SCM_EOL), from_strings(mending.take_notes()));
  }
  const auto ground = [&] {
    GroundReader reader(mending);
    reader.add(name, options);
    return reader.shape();
  };
  const ShapePtr shape = wanted == "concave" ? ground() : read_solid(name, options, mending);
  return scm_cons(from_shape(shape), from_strings(mending.take_notes()));
}

TW_PRIMITIVE(triangle_mesh, "%triangle-mesh", (SCM points, SCM triangles, SCM strict),
             "Return (SHAPE . NOTES) of the ground with these triangles.") {
  const std::vector<Vec3> places = to_points(points, "points");
  std::vector<MeshTriangle> all;
  for (const SCM one : to_elements(triangles, "triangles", "a list or vector of #(i j k)")) {
    constexpr const char* expected = "#(i j k), numbers of points";
    const std::vector<SCM> corners = to_elements(one, "a triangle", expected);
    if (corners.size() != 3) throw BadValue{"a triangle", one, expected};
    MeshTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      if (places.empty() || !scm_is_unsigned_integer(corners[k], 0, places.size() - 1))
        throw BadValue{"a triangle", one, expected};
      triangle[k] = scm_to_uint32(corners[k]);
    }
    all.push_back(triangle);
  }
  const InterruptionCheck check(look_for_signals);
  MeshFaults faults;
  const ShapePtr shape = make_mesh(places, all, &faults);
  Mending mending(scm_is_true(strict));
  mend_triangles("a mesh has ", faults, mending);
  return scm_cons(from_shape(shape), from_strings(mending.take_notes()));
}

TW_PRIMITIVE(load_visual, "%load-visual",
             (SCM file, SCM scale, SCM y_up, SCM color, SCM position, SCM orientation, SCM strict),
             "Return (VISUAL . NOTES) of what is seen of a mesh file.") {
  const InterruptionCheck check(look_for_signals);
  const Vec3 factors = to_scale(scale);
  VisualPart part;
  if (scm_is_true(color)) part.color = to_vec3(color, "color");
  if (scm_is_true(position)) part.pose.p = to_vec3(position, "position");
  if (scm_is_true(orientation)) {
    part.pose.q = to_quat(orientation, "orientation");
    if (!(part.pose.q.norm() > 0))
      throw BadValue{"orientation", orientation, "a quaternion #(w x y z) that is not zero"};
    part.pose.q.normalize();
  }
  Mending mending(scm_is_true(strict));
  part.mesh = read_surface(to_file_name(file, "the file"), factors, scm_is_true(y_up), mending);
  return scm_cons(from_visual(std::make_shared<const Visual>(Visual{part})),
                  from_strings(mending.take_notes()));
}

TW_PRIMITIVE(half_space, "%half-space", (SCM normal, SCM offset),
             "Return the half-space where normal.x <= offset.") {
  return from_shape(make_half_space(to_vec3(normal, "normal"), to_finite(offset, "offset")));
}

TW_PRIMITIVE(shape_union, "%union", (SCM list), "Return the union of a list of shapes.") {
  std::vector<ShapePtr> shapes;
  for (const SCM part : to_elements(list, "the parts of the union", "a list of shapes"))
    shapes.push_back(to_shape(part, "a part of the union"));
  TW_REQUIRE(!shapes.empty(), "the union has no parts; expected at least one shape");
  return from_shape(make_union(shapes));
}

TW_PRIMITIVE(placed, "%placed", (SCM shape, SCM position, SCM orientation),
             "Return the shape moved within the body's frame.") {
  Pose pose;
  if (scm_is_true(position)) pose.p = to_vec3(position, "position");
  if (scm_is_true(orientation)) pose.q = to_quat(orientation, "orientation");
  return from_shape(place_shape(to_shape(shape, "the shape to place"), pose));
}

static void require_bounds(const ShapePtr& shape) {
  TW_REQUIRE(shape->bounded(), "the shape is a " + shape->kind_name() +
                                   ", which has no bounds; expected a bounded shape");
}

// The mass properties of a shape that has some.
static const MassProperties& mass_of(const ShapePtr& shape) {
  require_bounds(shape);
  TW_REQUIRE(!shape->is_ground(), "the shape is a " + shape->kind_name() +
                                      ", which is ground without mass; expected another shape");
  return shape->mass_properties();
}

TW_PRIMITIVE(shape_volume, "%shape-volume", (SCM shape), "Return the volume in cubic metres.") {
  return scm_from_double(mass_of(to_shape(shape, "the shape")).volume);
}

TW_PRIMITIVE(shape_inertia, "%shape-inertia", (SCM shape),
             "Return the inertia about the centroid at density 1, as three rows.") {
  return from_matrix(mass_of(to_shape(shape, "the shape")).inertia);
}

TW_PRIMITIVE(shape_centroid, "%shape-centroid", (SCM shape), "Return the centroid.") {
  return from_vec3(mass_of(to_shape(shape, "the shape")).centroid);
}

TW_PRIMITIVE(shape_radius, "%shape-radius", (SCM shape),
             "Return the radius of the ball about the frame's origin that holds the shape.") {
  const ShapePtr value = to_shape(shape, "the shape");
  require_bounds(value);
  return scm_from_double(value->radius_about_origin());
}

TW_PRIMITIVE(shape_kind, "%shape-kind", (SCM shape), "Return one word that names the shape.") {
  return from_string(to_shape(shape, "the shape")->kind_name());
}

TW_PRIMITIVE(rotation, "%rotation", (SCM axis, SCM angle),
             "Return the quaternion that rotates by angle about axis.") {
  const Vec3 a = to_vec3(axis, "axis");
  const double half = 0.5 * to_finite(angle, "angle");
  const double norm = scaled_norm(a);
  if (!(norm > 0)) throw BadValue{"axis", axis, "a vector #(x y z) that is not zero"};
  const Vec3 v = std::sin(half) / norm * a;
  return from_quat(Quat(std::cos(half), v.x(), v.y(), v.z()));
}

}  // namespace tw
