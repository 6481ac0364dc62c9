// Scheme primitives: how the joints of a multibody stand, and what drives them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/joints.h"

#include <algorithm>

#include "base/index.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_joints)

using multibody::JointKind;
using multibody::Link;

namespace {

// What a joint's position, or its velocity and torque, look like.
const char* shape_of(JointKind kind, bool position) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic: return "a number";
    case JointKind::universal: return "two numbers #(a b)";
    case JointKind::spherical:
      return position ? "a quaternion #(w x y z)" : "three numbers #(x y z)";
    case JointKind::free:
      return position ? "position and quaternion #(x y z qw qx qy qz)"
                      : "velocity and angular velocity #(vx vy vz wx wy wz)";
    default: return "nothing";
  }
}

SCM from_joint(std::span<const double> numbers) {
  return numbers.size() == 1 ? scm_from_double(numbers[0]) : from_reals(numbers);
}

// A part of q, u, or another row of numbers of a multibody.
struct Part {
  std::size_t begin, count;
  const char* expected;
};

Part part_of(const Multibody& multibody, int link, bool position) {
  const Link& l = multibody.tree.link(link);
  TW_REQUIRE(l.dofs > 0, "link " + l.name + " of " + multibody.name +
                             " is welded; expected a joint that moves");
  return {index(position ? l.q : l.u), index(position ? l.coordinates : l.dofs),
          shape_of(l.joint, position)};
}

SCM read_part(const std::vector<double>& row, const Part& part) {
  // rows of what drives joints are empty where nothing does
  const std::vector<double> none(part.count);
  return from_joint(row.empty() ? std::span<const double>(none)
                                : std::span(row).subspan(part.begin, part.count));
}

void write_part(std::vector<double>& row, std::size_t length, const Part& part,
                const std::vector<double>& numbers) {
  if (row.empty()) row.resize(length);
  std::copy(numbers.begin(), numbers.end(), row.begin() + static_cast<std::ptrdiff_t>(part.begin));
}

using Row = std::vector<double> MultibodyState::*;

std::size_t length_of(const Multibody& multibody, Row row) {
  return index(row == &MultibodyState::q ? multibody.tree.nq() : multibody.tree.nv());
}

SCM read_joint(SCM object, SCM name, Row row, const char* what) {
  const Jointed of = to_jointed(object, what);
  const Part part = part_of(of.multibody, to_joint(of.multibody, name), row == &MultibodyState::q);
  return read_part(read_joints(of, what).*row, part);
}

// An edit of what drives joints by which nothing drives them, as before.
bool is_nothing(const Jointed& of, const std::vector<double>& row,
                const std::vector<double>& numbers) {
  return !is_view(of.object) && row.empty() &&
         std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0; });
}

SCM write_joint(SCM object, SCM name, SCM value, Row row, const char* what) {
  const Jointed of = to_jointed(object, what);
  const Part part = part_of(of.multibody, to_joint(of.multibody, name), row == &MultibodyState::q);
  const std::vector<double> numbers = to_reals(value, part.count, what, part.expected);
  change_joints(of, what, [&](MultibodyState& joints) {
    if (is_nothing(of, joints.*row, numbers)) return;
    write_part(joints.*row, length_of(of.multibody, row), part, numbers);
  });
  return SCM_UNSPECIFIED;
}

SCM read_row(SCM object, Row row, const char* what) {
  const Jointed of = to_jointed(object, what);
  std::vector<double> numbers = read_joints(of, what).*row;
  numbers.resize(length_of(of.multibody, row));
  return from_reals(numbers);
}

SCM write_row(SCM object, SCM value, Row row, const char* what) {
  const Jointed of = to_jointed(object, what);
  const std::size_t length = length_of(of.multibody, row);
  const std::vector<double> numbers =
      to_reals(value, length, what, "a vector with the numbers of all joints, one after the other");
  change_joints(of, what, [&](MultibodyState& joints) {
    if (!is_nothing(of, joints.*row, numbers)) joints.*row = numbers;
  });
  return SCM_UNSPECIFIED;
}

// Rows for servos, all of which rest.
void make_room_for_servos(const Multibody& multibody, MultibodyState& joints) {
  if (!joints.servos.empty()) return;
  joints.servos.resize(index(multibody.tree.axis_count()));
  joints.targets.resize(index(multibody.tree.nq()));
  neutral_position(multibody.tree, joints.targets);
  joints.target_velocities.resize(index(multibody.tree.nv()));
}

const Link& servo_link(const Jointed& of, SCM name) {
  const Link& link = of.multibody.tree.link(to_joint(of.multibody, name));
  TW_REQUIRE(link.axes > 0, "link " + link.name + " of " + of.multibody.name + " is " +
                                (link.dofs > 0 ? "free" : "welded") +
                                "; expected one with a joint that a servo can drive");
  return link;
}

}  // namespace

Jointed to_jointed(SCM object, const char* what) {
  constexpr const char* expected = "a multibody, a link of one, or a view of a link";
  if (is_view(object)) {
    const Multibody* multibody = to_view(object).multibody();
    if (!multibody || !to_view(object).joints()) throw BadValue{what, object, expected};
    return {object, to_world(view_world(object)), *multibody};
  }
  if (!stands_for_body(object)) throw BadValue{what, object, expected};
  World& world = to_world(body_world(object));
  if (is_multibody(object)) return {object, world, to_own_multibody(object)};
  const auto number = world.multibody_of(body_number(object));
  if (!number) throw BadValue{what, object, expected};
  return {object, world, world.multibody(*number)};
}

std::string to_link_name(SCM name, const char* what) {
  if (scm_is_symbol(name)) return to_symbol_name(name, what);
  if (!scm_is_string(name)) throw BadValue{what, name, "a name, a symbol or a string"};
  return to_string(name, what);
}

namespace {

[[noreturn]] void refuse_name(const Multibody& multibody, const char* what, const std::string& name,
                              std::string Link::*which) {
  std::string known;
  for (const Link& l : multibody.tree.links()) known += (known.empty() ? "" : ", ") + l.*which;
  throw UserError(multibody.name + " has no " + what + " " + name + "; expected one of " + known);
}

}  // namespace

int to_link(const Multibody& multibody, SCM name) {
  const std::string text = to_link_name(name, "the name of a link");
  const int link = multibody.tree.find(text);
  if (link < 0) refuse_name(multibody, "link", text, &Link::name);
  return link;
}

int to_joint(const Multibody& multibody, SCM name) {
  const std::string text = to_link_name(name, "the name of a joint");
  const int link = multibody.tree.find_joint(text);
  if (link < 0) refuse_name(multibody, "link or joint", text, &Link::joint_name);
  return link;
}

MultibodyState read_joints(const Jointed& of, const char* what) {
  if (is_view(of.object)) return *to_view(of.object).joints();
  require_outside_callbacks(what);
  return of.world.joints(of.multibody.number);
}

void change_joints(const Jointed& of, const char* what,
                   const std::function<void(MultibodyState&)>& change) {
  if (is_view(of.object)) return to_view(of.object).change_joints(change);
  require_outside_callbacks(what);
  of.world.edit(of.multibody.links.front(), [&](StateView& view) { view.change_joints(change); });
}

// ---- one joint ----

TW_PRIMITIVE(joint_position, "%joint-position", (SCM object, SCM name), "Position of a joint.") {
  return read_joint(object, name, &MultibodyState::q, "joint-position");
}

TW_PRIMITIVE(joint_velocity, "%joint-velocity", (SCM object, SCM name), "Velocity of a joint.") {
  return read_joint(object, name, &MultibodyState::u, "joint-velocity");
}

TW_PRIMITIVE(joint_torque, "%joint-torque", (SCM object, SCM name), "Torque given to a joint.") {
  return read_joint(object, name, &MultibodyState::torques, "joint-torque");
}

TW_PRIMITIVE(set_joint_position, "%set-joint-position!", (SCM object, SCM name, SCM value),
             "Put a joint elsewhere.") {
  return write_joint(object, name, value, &MultibodyState::q, "joint-position");
}

TW_PRIMITIVE(set_joint_velocity, "%set-joint-velocity!", (SCM object, SCM name, SCM value),
             "Set the velocity of a joint.") {
  return write_joint(object, name, value, &MultibodyState::u, "joint-velocity");
}

TW_PRIMITIVE(set_joint_torque, "%set-joint-torque!", (SCM object, SCM name, SCM value),
             "Set the torque at a joint.") {
  const Jointed of = to_jointed(object, "joint-torque");
  servo_link(of, name);
  return write_joint(object, name, value, &MultibodyState::torques, "joint-torque");
}

// ---- all joints ----

TW_PRIMITIVE(joint_positions, "%joint-positions", (SCM object), "Positions of all joints.") {
  return read_row(object, &MultibodyState::q, "joint-positions");
}

TW_PRIMITIVE(joint_velocities, "%joint-velocities", (SCM object), "Velocities of all joints.") {
  return read_row(object, &MultibodyState::u, "joint-velocities");
}

TW_PRIMITIVE(joint_torques, "%joint-torques", (SCM object), "Torques given to all joints.") {
  return read_row(object, &MultibodyState::torques, "joint-torques");
}

TW_PRIMITIVE(set_joint_positions, "%set-joint-positions!", (SCM object, SCM value),
             "Put all joints elsewhere.") {
  return write_row(object, value, &MultibodyState::q, "joint-positions");
}

TW_PRIMITIVE(set_joint_velocities, "%set-joint-velocities!", (SCM object, SCM value),
             "Set the velocities of all joints.") {
  return write_row(object, value, &MultibodyState::u, "joint-velocities");
}

TW_PRIMITIVE(set_joint_torques, "%set-joint-torques!", (SCM object, SCM value),
             "Set the torques at all joints.") {
  return write_row(object, value, &MultibodyState::torques, "joint-torques");
}

// ---- servos ----

TW_PRIMITIVE(joint_servo, "%joint-servo", (SCM object, SCM name),
             "(target target-velocity stiffness damping max-torque), or #f.") {
  const Jointed of = to_jointed(object, "joint-servo");
  const Link& link = servo_link(of, name);
  const MultibodyState joints = read_joints(of, "joint-servo");
  if (joints.servos.empty()) return SCM_BOOL_F;
  const multibody::ServoGains& gains = joints.servos[index(link.first_axis)];
  if (gains == multibody::ServoGains()) return SCM_BOOL_F;
  const int number = to_joint(of.multibody, name);
  return scm_list_5(read_part(joints.targets, part_of(of.multibody, number, true)),
                    read_part(joints.target_velocities, part_of(of.multibody, number, false)),
                    scm_from_double(gains.stiffness), scm_from_double(gains.damping),
                    scm_from_double(gains.max_torque));
}

TW_PRIMITIVE(set_joint_servo, "%set-joint-servo!", (SCM object, SCM name, SCM servo),
             "Give a joint a servo, a list as %joint-servo returns, or none, #f.") {
  const Jointed of = to_jointed(object, "joint-servo");
  const Link& link = servo_link(of, name);
  const int number = to_joint(of.multibody, name);
  const Part position = part_of(of.multibody, number, true);
  const Part velocity = part_of(of.multibody, number, false);
  multibody::ServoGains gains;
  std::vector<double> target(index(of.multibody.tree.nq())), speed(velocity.count);
  neutral_position(of.multibody.tree, target);
  target = {target.begin() + static_cast<std::ptrdiff_t>(position.begin),
            target.begin() + static_cast<std::ptrdiff_t>(position.begin + position.count)};
  if (scm_is_true(servo)) {
    const std::vector<SCM> given = to_elements(servo, "the servo", "a servo");
    if (scm_is_true(given[0]))
      target = to_reals(given[0], position.count, "the target of a servo", position.expected);
    if (scm_is_true(given[1]))
      speed =
          to_reals(given[1], velocity.count, "the target-velocity of a servo", velocity.expected);
    gains.stiffness = to_optional_real(given[2], "the stiffness of a servo").value_or(0);
    gains.damping = to_optional_real(given[3], "the damping of a servo").value_or(0);
    gains.max_torque = to_optional_real(given[4], "the max-torque of a servo")
                           .value_or(of.multibody.tree.axes()[index(link.first_axis)].law.effort);
  }
  if (link.joint == JointKind::spherical) {
    const double norm = multibody::quaternion_at(target.data()).norm();
    TW_REQUIRE(norm > 1e-100 && std::isfinite(norm),
               "the target of the servo of " + link.name +
                   " is zero or not finite; expected a quaternion #(w x y z)");
    for (double& x : target) x /= norm;
  }
  change_joints(of, "joint-servo", [&](MultibodyState& joints) {
    if (!is_view(of.object) && joints.servos.empty() && gains == multibody::ServoGains()) return;
    make_room_for_servos(of.multibody, joints);
    write_part(joints.targets, 0, position, target);
    write_part(joints.target_velocities, 0, velocity, speed);
    for (int i = link.first_axis; i < link.first_axis + link.axes; ++i)
      joints.servos[index(i)] = gains;
  });
  return SCM_UNSPECIFIED;
}

}  // namespace tw
