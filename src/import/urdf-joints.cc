// Joints of URDF files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf-joints.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include "base/error.h"

namespace tw::urdf {

using multibody::AxisSpec;
using multibody::JointKind;
using multibody::JointSpec;

namespace {

class Joints : LineMending {
 public:
  Joints(const std::string& file, const Robot& model, Mending& mending)
      : LineMending(file, mending), model_(model) {}

  std::vector<JointSpec> specs() {
    for (const Joint& joint : model_.joints) specs_.push_back(spec_of(joint));
    set_followers();
    return std::move(specs_);
  }

 private:
  JointSpec spec_of(const Joint& joint);
  void set_limits(const Joint& joint, JointSpec& spec);
  static void lock(JointSpec& spec, double position);
  void set_followers();

  const Joint& joint(std::size_t i) const { return model_.joints[i]; }

  const Robot& model_;
  std::vector<JointSpec> specs_;             // of each joint
  std::map<std::size_t, double> locked_at_;  // joints whose limits are equal
};

void Joints::set_limits(const Joint& joint, JointSpec& spec) {
  AxisSpec& axis = spec.axes[0];
  if (joint.limit) {
    // nobody means that a joint can do nothing
    if (joint.limit->effort.value_or(0) > 0) axis.effort = *joint.limit->effort;
    if (joint.limit->velocity.value_or(0) > 0) axis.speed = *joint.limit->velocity;
  }
  if (joint.type != JointType::revolute && joint.type != JointType::prismatic) return;
  const std::string of = "the joint " + joint.name;
  // one that follows another has the limits of that, at least
  const bool limited = joint.limit && (joint.limit->lower || joint.limit->upper);
  if (joint.mimic && !limited) return;
  if (!joint.limit) {
    mend(joint.line, of + " has no <limit>", "it moves without end",
         "<limit lower=\"...\" upper=\"...\"/>");
    return;
  }
  const double lower = joint.limit->lower.value_or(0), upper = joint.limit->upper.value_or(0);
  if (lower < upper) {
    axis.lower = lower, axis.upper = upper;
    return;
  }
  const std::string are =
      "the limits of " + of + " are " +
      (joint.limit->lower || joint.limit->upper ? show(lower) + " and " + show(upper)
                                                : "not given, and so 0 and 0");
  constexpr const char* expected = "a lower one and a greater upper one";
  if (lower > upper) {
    mend(joint.limit->line, are, "it has none", expected);
    return;
  }
  mend(joint.limit->line, are, "it is locked", expected);
  lock(spec, lower);
  locked_at_[static_cast<std::size_t>(&joint - model_.joints.data())] = lower;
}

void Joints::lock(JointSpec& spec, double position) {
  const Vec3 unit = spec.axis.normalized();
  const Pose there = spec.kind == JointKind::revolute
                         ? Pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(position, unit))}
                         : Pose{position * unit, Quat::Identity()};
  spec.placement = spec.placement * there;
  spec.kind = JointKind::weld;
}

JointSpec Joints::spec_of(const Joint& joint) {
  JointSpec spec;
  switch (joint.type) {
    case JointType::fixed: spec.kind = JointKind::weld; break;
    case JointType::revolute:
    case JointType::continuous:
    case JointType::planar: spec.kind = JointKind::revolute; break;
    case JointType::prismatic: spec.kind = JointKind::prismatic; break;
    case JointType::spherical: spec.kind = JointKind::spherical; break;
    case JointType::floating: spec.kind = JointKind::free; break;
  }
  spec.name = joint.name;
  spec.placement = joint.origin;
  spec.axis = joint.axis;
  if (spec.kind == JointKind::weld) return spec;
  if (spec.kind != JointKind::free && spec.kind != JointKind::spherical && !(spec.axis.norm() > 0))
    fail(joint.line, "the axis of the joint " + joint.name + " is 0 0 0; expected a direction");
  for (const auto& [value, name, member] :
       {std::tuple(joint.damping, "damping", &AxisSpec::damping),
        std::tuple(joint.friction, "friction", &AxisSpec::friction)}) {
    if (value < 0)
      mend(joint.line, std::string(name) + " of the joint " + joint.name + " is " + show(value),
           "it has none", "0 or more");
    spec.axes[0].*member = std::max(0.0, value);
  }
  set_limits(joint, spec);
  return spec;
}

// Which joints follow which: those at the ends of chains, whose limits are those of all that
// follow; what follows a joint that is locked is locked, too.
void Joints::set_followers() {
  std::map<std::string, std::size_t> names;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) names[joint(i).name] = i;
  const auto one_freedom = [&](std::size_t i) {
    return specs_[i].kind == JointKind::revolute || specs_[i].kind == JointKind::prismatic;
  };
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    if (!joint(i).mimic || specs_[i].kind == JointKind::weld) continue;
    multibody::FollowSpec follows{joint(i).name, 1, 0};
    std::size_t leader = i, steps = 0;
    std::string wrong;
    while (joint(leader).mimic && specs_[leader].kind != JointKind::weld) {
      const Mimic& mimic = *joint(leader).mimic;
      const auto found = names.find(mimic.joint);
      if (found == names.end())
        wrong = mimic.joint + ", which is no joint of the robot";
      else if (++steps > model_.joints.size())
        wrong = mimic.joint + ", and so itself";
      if (!wrong.empty()) break;
      follows.offset += follows.ratio * mimic.offset;
      follows.ratio *= mimic.multiplier;
      leader = found->second;
    }
    if (!wrong.empty()) {
      mend(joint(i).mimic->line, "the joint " + joint(i).name + " follows " + wrong,
           "it moves by itself", "the name of a joint that moves by itself");
      continue;
    }
    follows.joint = joint(leader).name;
    JointSpec& own = specs_[i];
    JointSpec& leads = specs_[leader];
    if (leads.kind == JointKind::weld) {
      const double position = follows.offset + follows.ratio * locked_at_[leader];
      mend(joint(i).mimic->line,
           "the joint " + joint(i).name + " follows " + follows.joint + ", which does not move",
           "it is locked at " + show(position), "the name of a joint that moves by itself");
      lock(own, position);
      continue;
    }
    if (!one_freedom(i) || !one_freedom(leader) || joint(i).type == JointType::planar ||
        joint(leader).type == JointType::planar)
      fail(joint(i).mimic->line, "the joint " + joint(i).name + " follows " + follows.joint +
                                     "; expected two joints that turn or slide");
    AxisSpec& axis = own.axes[0];
    AxisSpec& most = leads.axes[0];
    if (follows.ratio != 0) {
      const double a = (axis.lower - follows.offset) / follows.ratio;
      const double b = (axis.upper - follows.offset) / follows.ratio;
      const double lower = std::max(most.lower, std::min(a, b));
      const double upper = std::min(most.upper, std::max(a, b));
      if (lower < upper)
        most.lower = lower, most.upper = upper;
      else
        mend(joint(i).mimic->line,
             "the limits of the joint " + joint(i).name + " leave nothing to " + follows.joint +
                 ", which it follows",
             "it has none", "limits that both can keep");
    }
    axis.lower = -std::numeric_limits<double>::infinity();
    axis.upper = std::numeric_limits<double>::infinity();
    own.follows = follows;
  }
}

}  // namespace

std::vector<JointSpec> joint_specs(const std::string& file, const Robot& model, Mending& mending) {
  return Joints(file, model, mending).specs();
}

}  // namespace tw::urdf
