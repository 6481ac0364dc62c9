// Scheme primitives: making multibodies and asking about them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/index.h"
#include "integrate/given/moving-base.h"
#include "multibody/couplings.h"
#include "multibody/inverse-dynamics.h"
#include "multibody/inverse-kinematics.h"
#include "multibody/jacobian.h"
#include "script/body-def.h"
#include "script/joints.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_multibodies)

using namespace multibody;

namespace {

// ---- joints and links of a definition ----

struct KindName {
  const char* name;
  JointKind kind;
};

constexpr KindName kinds[] = {
    {"weld", JointKind::weld},           {"revolute", JointKind::revolute},
    {"prismatic", JointKind::prismatic}, {"universal", JointKind::universal},
    {"spherical", JointKind::spherical}, {"free", JointKind::free},
};

const char* name_of(JointKind kind) {
  for (const KindName& known : kinds)
    if (known.kind == kind) return known.name;
  return "";
}

// Of both axes of a universal joint: one number for both, or #(a b).
void read_axes(JointSpec& joint, SCM value, const char* name, double AxisSpec::*member) {
  if (joint.kind == JointKind::universal && !scm_is_real(value)) {
    const std::vector<double> both = to_reals(value, 2, name, "a number, or two #(a b)");
    for (std::size_t i = 0; i < 2; ++i) joint.axes[i].*member = both[i];
    return;
  }
  for (AxisSpec& axis : joint.axes) axis.*member = to_real(value, name);
}

void read_axis(JointSpec& joint, SCM value, const char* name) {
  const Vec3 axis = to_vec3(value, name);
  if (joint.kind == JointKind::spherical)
    joint.swinging = axis;
  else
    joint.axis = axis;
}

constexpr const char* limits_expected = "a list (LOWER UPPER); of a universal joint, one or two";

void read_limits(JointSpec& joint, SCM value, const char* name) {
  if (joint.kind == JointKind::spherical) {
    if (!scm_is_real(value))
      throw BadValue{name, value, "an angle, rad, as the joint is spherical"};
    joint.axes[0].upper = to_real(value, name);
    return;
  }
  const auto set = [&](AxisSpec& axis, SCM limits) {
    const std::vector<double> both = to_reals(limits, 2, name, limits_expected);
    axis.lower = both[0], axis.upper = both[1];
  };
  const std::vector<SCM> parts = to_elements(value, name, limits_expected);
  const bool each =
      joint.kind == JointKind::universal && parts.size() == 2 && !scm_is_real(parts[0]);
  for (std::size_t i = 0; i < 2; ++i) set(joint.axes[i], each ? parts[i] : value);
}

void read_rest(JointSpec& joint, SCM value, const char* name) {
  if (joint.kind == JointKind::spherical)
    joint.rest_attitude = to_quat(value, name);
  else
    read_axes(joint, value, name, &AxisSpec::rest);
}

void read_stop_stiffness(JointSpec& joint, SCM value, const char* name) {
  for (AxisSpec& axis : joint.axes) axis.stop_stiffness = to_real(value, name);
}

struct JointProperty {
  const char* name;
  void (*read)(JointSpec&, SCM value, const char* name);
};

constexpr JointProperty joint_properties[] = {
    {"axis", read_axis},
    {"second-axis", [](JointSpec& j, SCM v, const char* n) { j.second = to_vec3(v, n); }},
    {"at", [](JointSpec& j, SCM v, const char* n) { j.placement.p = to_vec3(v, n); }},
    {"orientation", [](JointSpec& j, SCM v, const char* n) { j.placement.q = to_quat(v, n); }},
    {"limits", read_limits},
    {"damping", [](JointSpec& j, SCM v, const char* n) { read_axes(j, v, n, &AxisSpec::damping); }},
    {"friction",
     [](JointSpec& j, SCM v, const char* n) { read_axes(j, v, n, &AxisSpec::friction); }},
    {"stiffness",
     [](JointSpec& j, SCM v, const char* n) { read_axes(j, v, n, &AxisSpec::stiffness); }},
    {"rest", read_rest},
    {"restitution",
     [](JointSpec& j, SCM v, const char* n) { read_axes(j, v, n, &AxisSpec::restitution); }},
    {"stop-stiffness", read_stop_stiffness},
};

// (KIND (PROPERTY . VALUE) ...)
JointSpec to_joint(SCM value) {
  JointSpec joint;
  const std::string kind = to_symbol_name(SCM_CAR(value), "the kind of a joint");
  for (const KindName& known : kinds)
    if (kind == known.name) joint.kind = known.kind;
  for (SCM rest = SCM_CDR(value); scm_is_pair(rest); rest = SCM_CDR(rest)) {
    const std::string name = to_symbol_name(SCM_CAAR(rest), "the property of a joint");
    for (const JointProperty& property : joint_properties)
      if (name == property.name) property.read(joint, SCM_CDAR(rest), property.name);
  }
  return joint;
}

// (NAME PARENT-OR-#f JOINT-OR-#f PROPERTIES)
LinkDef to_link_def(SCM value) {
  const std::vector<SCM> parts = to_elements(value, "a link", "four parts");
  LinkDef link;
  link.name = to_link_name(parts[0], "the name of a link");
  if (scm_is_true(parts[1])) link.parent = to_link_name(parts[1], "the name of a link");
  try {
    if (scm_is_true(parts[2])) link.joint = to_joint(parts[2]);
    link.body = to_body_def(parts[3], "link");
  } catch (const BadValue& bad) {
    throw BadValue{bad.name + " of the link " + link.name, bad.value, bad.expected};
  }
  return link;
}

// ---- kinematics ----

multibody::BaseMotion around(const Jointed& of) {
  multibody::BaseMotion result;
  result.gravity = of.world.gravity();
  const double now = is_view(of.object) ? to_view(of.object).joints_time() : of.world.time();
  MovingBase(of.multibody).set(now, result);
  return result;
}

constexpr const char* q_expected = "a vector with the positions of all joints, one after the other";
constexpr const char* u_expected = "a vector with one number for each freedom of the joints";

// Finite; quaternions are made unit ones.
std::vector<double> to_row(const Jointed& of, SCM value, bool positions, const char* name) {
  const Tree& tree = of.multibody.tree;
  const char* expected = positions ? q_expected : u_expected;
  std::vector<double> row =
      to_reals(value, index(positions ? tree.nq() : tree.nv()), name, expected);
  for (const double x : row)
    if (!std::isfinite(x)) throw BadValue{name, value, "finite numbers"};
  if (!positions) return row;
  for (const Link& link : tree.links()) {
    if (link.joint != JointKind::spherical && link.joint != JointKind::free) continue;
    const int q = link.joint == JointKind::free ? link.q + 3 : link.q;
    if (!(quaternion_at(&row[index(q)]).norm() > 1e-100))
      throw BadValue{name, value, "quaternions that are not zero"};
  }
  normalize(tree, row);
  return row;
}

// (LOWER UPPER); of a spherical joint the angle.
SCM from_limits(const Axis& axis) {
  if (axis.ball) return scm_from_double(axis.law.upper);
  return scm_list_2(scm_from_double(axis.law.lower), scm_from_double(axis.law.upper));
}

// rows x columns, from columns one after the other
SCM from_columns(const std::vector<double>& columns, std::size_t rows) {
  const std::size_t count = columns.size() / rows;
  const SCM array = scm_make_typed_array(scm_from_utf8_symbol("f64"), scm_from_double(0),
                                         scm_list_2(scm_from_size_t(rows), scm_from_size_t(count)));
  scm_t_array_handle handle;
  scm_array_get_handle(array, &handle);
  double* elements = scm_array_handle_f64_writable_elements(&handle);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < count; ++c) elements[r * count + c] = columns[r + rows * c];
  scm_array_handle_release(&handle);
  return array;
}

}  // namespace

MultibodyDef to_root_def(SCM world, SCM name, SCM base, SCM position, SCM orientation, SCM place) {
  MultibodyDef def;
  if (scm_is_true(name)) def.name = to_link_name(name, "the name of a multibody");
  if (stands_for_body(base)) {
    def.base = to_body(world, base, "base");
  } else {
    const std::string kind = scm_is_symbol(base) ? to_symbol_name(base, "base") : "";
    if (kind != "free" && kind != "fixed")
      throw BadValue{"base", base, "'fixed, 'free, or a body that is fixed or kinematic"};
    def.free = kind == "free";
  }
  if (scm_is_true(position)) def.position = to_vec3(position, "position");
  if (scm_is_true(orientation)) def.orientation = to_quat(orientation, "orientation");
  if (is_place(place)) def.place = to_place(place);
  return def;
}

TW_PRIMITIVE(add_multibody, "%add-multibody!",
             (SCM world, SCM name, SCM base, SCM position, SCM orientation, SCM links, SCM place),
             "Add a multibody; return its handle.") {
  require_outside_callbacks("add-multibody!");
  MultibodyDef def = to_root_def(world, name, base, position, orientation, place);
  for (SCM rest = links; scm_is_pair(rest); rest = SCM_CDR(rest)) {
    def.links.push_back(to_link_def(SCM_CAR(rest)));
    def.links.back().body.place = def.place;
  }
  const std::uint32_t number = to_world(world).add_multibody(def);
  keep_with_world(world, links);
  return from_multibody(world, number);
}

TW_PRIMITIVE(world_multibodies, "%world-multibodies", (SCM world), "All multibodies in order.") {
  SCM list = SCM_EOL;
  for (std::size_t i = to_world(world).multibody_count(); i-- > 0;)
    list = scm_cons(from_multibody(world, static_cast<std::uint32_t>(i)), list);
  return list;
}

TW_PRIMITIVE(find_multibody, "%find-multibody", (SCM world, SCM name), "By its name, or #f.") {
  const auto number = to_world(world).find_multibody(to_link_name(name, "the name"));
  return number ? from_multibody(world, *number) : SCM_BOOL_F;
}

TW_PRIMITIVE(the_multibody, "%multibody", (SCM object),
             "Of a multibody, a link or a view of one.") {
  if (is_multibody(object)) return object;
  const Jointed of = to_jointed(object, "the multibody");
  return from_multibody(is_view(object) ? view_world(object) : body_world(object),
                        of.multibody.number);
}

TW_PRIMITIVE(is_link_object, "%link?", (SCM object), "Is the body a link, or the view of one?") {
  if (is_view(object)) return scm_from_bool(to_view(object).multibody());
  if (!is_body(object)) return SCM_BOOL_F;
  return scm_from_bool(to_world(body_world(object)).multibody_of(body_number(object)).has_value());
}

TW_PRIMITIVE(multibody_links, "%multibody-links", (SCM multibody), "Its links, bodies, in order.") {
  const Multibody& m = to_own_multibody(multibody);
  SCM list = SCM_EOL;
  for (std::size_t i = m.links.size(); i-- > 0;)
    list = scm_cons(from_body(body_world(multibody), m.links[i]), list);
  return list;
}

TW_PRIMITIVE(link_body, "%link-body", (SCM multibody, SCM name), "The body of a link.") {
  const Multibody& m = to_own_multibody(multibody);
  return from_body(body_world(multibody), m.links[index(to_link(m, name))]);
}

TW_PRIMITIVE(multibody_joints, "%multibody-joints", (SCM object),
             "((NAME KIND LIMITS TORQUE VELOCITY) ...) of all links; limits: (LOWER UPPER), two "
             "such, ANGLE or "
             "#f; the most of both, or #f.") {
  const Multibody& m = to_jointed(object, "the multibody").multibody;
  SCM list = SCM_EOL;
  for (int i = m.tree.link_count(); i-- > 0;) {
    const Link& link = m.tree.link(i);
    SCM limits = SCM_BOOL_F, torque = SCM_BOOL_F, speed = SCM_BOOL_F;
    if (link.axes > 0) {
      const AxisSpec& law = m.tree.axes()[index(link.first_axis)].law;
      torque = scm_from_double(law.effort), speed = scm_from_double(law.speed);
    }
    if (link.axes == 1) limits = from_limits(m.tree.axes()[index(link.first_axis)]);
    if (link.axes == 2)
      limits = scm_list_2(from_limits(m.tree.axes()[index(link.first_axis)]),
                          from_limits(m.tree.axes()[index(link.first_axis + 1)]));
    list = scm_cons(scm_list_5(from_string(link.joint_name),
                               scm_from_utf8_symbol(name_of(link.joint)), limits, torque, speed),
                    list);
  }
  return list;
}

TW_PRIMITIVE(joint_index, "%joint-index", (SCM object, SCM name),
             "Number of the link that a joint moves, from 0.") {
  return scm_from_int(to_joint(to_jointed(object, "the multibody").multibody, name));
}

// ---- kinematics and dynamics ----

TW_PRIMITIVE(jacobian, "%jacobian", (SCM object, SCM name, SCM positions),
             "6 x n, at given positions of all joints, or, #f, the present ones.") {
  const Jointed of = to_jointed(object, "jacobian");
  const Tree& tree = of.multibody.tree;
  const int link = to_link(of.multibody, name);
  const std::vector<double> q = scm_is_true(positions) ? to_row(of, positions, true, "positions")
                                                       : read_joints(of, "jacobian").q;
  const std::vector<double> u(index(tree.nv()));
  Kinematics k(tree);
  place(tree, q, u, around(of), k);
  std::vector<double> J(6 * u.size());
  link_jacobian(tree, k, link, J);
  return from_columns(J, 6);
}

TW_PRIMITIVE(forward_kinematics, "%forward-kinematics", (SCM object, SCM positions, SCM name),
             "(POSITION . ORIENTATION) of a link.") {
  const Jointed of = to_jointed(object, "forward-kinematics");
  const Tree& tree = of.multibody.tree;
  const int link = to_link(of.multibody, name);
  const std::vector<double> q = to_row(of, positions, true, "positions");
  const std::vector<double> u(index(tree.nv()));
  Kinematics k(tree);
  place(tree, q, u, around(of), k);
  const Frame frame = link_frame(tree, k, link);
  return scm_cons(from_vec3(frame.p), from_quat(Quat(frame.R).normalized()));
}

TW_PRIMITIVE(positions_to_reach, "%inverse-kinematics",
             (SCM object, SCM name, SCM position, SCM orientation, SCM point, SCM start,
              SCM tolerance, SCM starts),
             "(POSITIONS-OR-#f . RESIDUAL).") {
  const Jointed of = to_jointed(object, "inverse-kinematics");
  Target target;
  target.link = to_link(of.multibody, name);
  target.position = to_vec3(position, "position");
  if (scm_is_true(orientation)) target.attitude = to_quat(orientation, "orientation");
  if (scm_is_true(point)) target.point = to_vec3(point, "point");
  SearchOptions options;
  options.tolerance = to_optional_real(tolerance, "tolerance");
  if (scm_is_true(starts)) {
    const long count = to_integer(starts, "starts");
    if (count < 1 || count > 1000000) throw BadValue{"starts", starts, "a number from 1 to 1e6"};
    options.starts = static_cast<int>(count);
  }
  const std::vector<double> from = scm_is_true(start) ? to_row(of, start, true, "start")
                                                      : read_joints(of, "inverse-kinematics").q;
  const Reached reached =
      multibody::inverse_kinematics(of.multibody.tree, around(of), target, from, options);
  return scm_cons(reached.q ? from_reals(*reached.q) : SCM_BOOL_F,
                  scm_from_double(reached.residual));
}

TW_PRIMITIVE(torques_needed, "%inverse-dynamics",
             (SCM object, SCM positions, SCM velocities, SCM rates),
             "The torques that a motion needs, beyond those of damping, friction and springs.") {
  const Jointed of = to_jointed(object, "inverse-dynamics");
  const Tree& tree = of.multibody.tree;
  std::vector<double> q = to_row(of, positions, true, "positions"),
                      u = to_row(of, velocities, false, "velocities"),
                      rate = to_row(of, rates, false, "accelerations");
  follow_positions(tree, q);
  follow(tree, u);
  follow(tree, rate);
  Kinematics k(tree);
  place(tree, q, u, around(of), k);
  InverseDynamics work(tree);
  std::vector<double> needed(u.size()), passive(u.size());
  multibody::inverse_dynamics(tree, k, rate, work, needed);
  joint_torques(tree, q, u, {}, passive);
  for (std::size_t i = 0; i < needed.size(); ++i) needed[i] -= passive[i];
  fold(tree, needed);
  return from_reals(needed);
}

}  // namespace tw
