// A multibody's nodes, dofs and axes from the user's links.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/tree.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "multibody/coordinates.h"
#include "multibody/kinematics.h"
#include "multibody/regularity.h"
#include "multibody/tree-checks.h"

namespace tw::multibody {
namespace {

// The least turn that takes z to an axis; exactly none where it is z.
Frame z_to(const Vec3& axis) {
  const Vec3 unit = (axis / scaled_norm(axis)).normalized();
  Frame X;
  if (unit != Vec3::UnitZ())
    X.R = Quat::FromTwoVectors(Vec3::UnitZ(), unit).normalized().toRotationMatrix();
  return X;
}

Frame inverse_turn(const Frame& X) { return {X.R.transpose(), Vec3::Zero()}; }

// Moments about a point d away from the centre of mass.
Mat3 shifted(const Mat3& moments, double mass, const Vec3& d) {
  return moments + mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

int index_of(const std::vector<LinkSpec>& links, const std::string& name) {
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == name) return static_cast<int>(i);
  return -1;
}

// Why a parent that is not among the earlier links is wrong.
void require_earlier_parent(const std::vector<LinkSpec>& links, std::size_t at) {
  const std::string& parent = links[at].parent;
  if (parent.empty()) return;
  const int found = index_of(links, parent);
  TW_REQUIRE(found >= 0, "parent of " + links[at].name + " is " + parent +
                             "; expected the name of one of the multibody's links");
  if (static_cast<std::size_t>(found) < at) return;
  int up = found;
  for (std::size_t steps = 0; up >= 0 && steps <= links.size(); ++steps) {
    TW_REQUIRE(up != static_cast<int>(at), "parent of " + links[at].name + " is " + parent +
                                               ", which hangs on it; expected a tree, no cycle");
    up = index_of(links, links[static_cast<std::size_t>(up)].parent);
  }
  throw UserError("parent of " + links[at].name + " is " + parent +
                  ", which comes later; expected parents before their children");
}

}  // namespace

Tree::Tree(const std::vector<LinkSpec>& links) {
  nodes_.resize(first_node);
  nodes_[base_node].kind = NodeKind::base;
  last_dof_.assign(first_node, -1);
  for (std::size_t i = 0; i < links.size(); ++i) {
    require_link(links[i]);
    TW_REQUIRE(find(links[i].name) < 0, "two links are named " + links[i].name +
                                            "; expected a name to each link of a multibody");
    require_earlier_parent(links, i);
    add_link(links[i]);
  }
  for (const LinkSpec& link : links)
    if (link.joint.follows) add_coupling(link);
  require_regular();
  set_gravity(answer::standard_gravity);
}

int Tree::find(const std::string& name) const {
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].name == name) return static_cast<int>(i);
  return -1;
}

int Tree::find_joint(const std::string& name) const {
  // one that has a name of its own goes before a link that is called so
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].joint_name == name && links_[i].name != name) return static_cast<int>(i);
  return find(name);
}

void Tree::add_coupling(const LinkSpec& spec) {
  const FollowSpec& given = *spec.joint.follows;
  const Link& own = link(find(spec.name));
  const std::string of = "the joint " + own.joint_name + ", which follows " + given.joint;
  const int found = find_joint(given.joint);
  TW_REQUIRE(found >= 0, of + ", follows no joint; expected one of the multibody's");
  const Link& leads = link(found);
  for (const Link* l : {&own, &leads})
    TW_REQUIRE(l->dofs == 1, of + ", has to do with one, " + l->joint_name + ", that has " +
                                 std::to_string(l->dofs) +
                                 " freedoms; expected two joints with one each");
  TW_REQUIRE(std::isfinite(given.ratio) && std::isfinite(given.offset),
             of + ", does so by " + show(given.ratio) + " and " + show(given.offset) +
                 "; expected finite numbers");
  const auto follower = [](const Link& l) {
    return [&l](const Coupling& c) { return c.follower == l.u; };
  };
  TW_REQUIRE(&own != &leads &&
                 std::none_of(couplings_.begin(), couplings_.end(), follower(leads)) &&
                 std::none_of(couplings_.begin(), couplings_.end(),
                              [&](const Coupling& c) { return c.leader == own.u; }),
             of + ", is in a chain of such; expected a leader that follows none");
  couplings_.push_back({leads.u, own.u, leads.q, own.q, given.ratio, given.offset});
}

int Tree::add_node(NodeKind kind, int parent, const Frame& X_PF) {
  Node node;
  node.kind = kind;
  node.parent = parent;
  node.link = link_count();
  node.X_PF = X_PF;
  node.q = nq_;
  node.u = nv_;
  node.dofs = kind == NodeKind::floating ? 6 : kind == NodeKind::ball ? 3 : 1;
  nq_ += kind == NodeKind::floating ? 7 : kind == NodeKind::ball ? 4 : 1;
  nv_ += node.dofs;
  nodes_.push_back(node);
  int last = last_dof(parent);
  for (int k = node.u; k < nv_; ++k) {
    dof_parent_.push_back(last);
    dof_node_.push_back(node_count() - 1);
    last = k;
  }
  last_dof_.push_back(last);
  return node_count() - 1;
}

void Tree::add_axis(const AxisSpec& law) {
  Axis axis;
  axis.link = link_count();
  axis.q = nq_;
  axis.u = nv_;
  axis.law = law;
  axis.passive = law.damping > 0 || law.friction > 0 || law.stiffness > 0;
  axes_.push_back(axis);
}

void Tree::add_mass(Node& node, const LinkSpec& spec, const Frame& X_NL) {
  if (spec.mass == 0) return;
  const Vec3 center = X_NL * spec.center_of_mass;
  const Mat3 symmetric = 0.5 * (spec.inertia + spec.inertia.transpose());
  const Mat3 moments = X_NL.R * symmetric * X_NL.R.transpose();
  const double total = node.mass + spec.mass;
  const Vec3 common = (node.mass * node.center + spec.mass * center) / total;
  node.moments = Sym3::of(shifted(node.moments.matrix(), node.mass, common - node.center) +
                          shifted(moments, spec.mass, common - center));
  node.center = common;
  node.mass = total;
}

void Tree::add_link(const LinkSpec& spec) {
  const JointSpec& joint = spec.joint;
  Link link;
  link.name = spec.name;
  link.joint_name = joint.name.empty() ? spec.name : joint.name;
  link.parent = spec.parent.empty() ? -1 : find(spec.parent);
  link.joint = joint.kind;
  link.placement = Frame(Pose{joint.placement.p, joint.placement.q.normalized()});
  link.mass = spec.mass;
  link.center_of_mass = spec.center_of_mass;
  link.inertia = spec.inertia;
  link.q = nq_;
  link.u = nv_;
  link.first_axis = axis_count();
  const int parent = link.parent < 0 ? base_node : this->link(link.parent).node;
  const Frame X_PJ = (link.parent < 0 ? Frame() : this->link(link.parent).X_NL) * link.placement;
  switch (joint.kind) {
    case JointKind::weld:
      link.node = parent;
      link.X_NL = X_PJ;
      break;
    case JointKind::revolute:
    case JointKind::prismatic: {
      const Frame turn = z_to(joint.axis);
      add_axis(joint.axes[0]);
      link.node = add_node(joint.kind == JointKind::revolute ? NodeKind::hinge : NodeKind::slider,
                           parent, X_PJ * turn);
      link.X_NL = inverse_turn(turn);
      break;
    }
    case JointKind::universal: {
      const Frame first = z_to(joint.axis), second = z_to(joint.second);
      add_axis(joint.axes[0]);
      const int between = add_node(NodeKind::hinge, parent, X_PJ * first);
      add_axis(joint.axes[1]);
      link.node = add_node(NodeKind::hinge, between, inverse_turn(first) * second);
      link.X_NL = inverse_turn(second);
      break;
    }
    case JointKind::spherical:
      add_axis(joint.axes[0]);
      axes_.back().ball = true;
      axes_.back().rest_attitude = joint.rest_attitude.normalized();
      if (joint.swinging) axes_.back().swinging = joint.swinging->normalized();
      link.node = add_node(NodeKind::ball, parent, X_PJ);
      break;
    case JointKind::free:
      TW_REQUIRE(link.parent < 0, "the joint of " + spec.name + " below " + spec.parent +
                                      " is free; expected that of a link on the base alone");
      link.node = add_node(NodeKind::floating, world_node, Frame());
      break;
  }
  link.coordinates = nq_ - link.q;
  link.dofs = nv_ - link.u;
  link.axes = axis_count() - link.first_axis;
  if (link.node != base_node) {
    add_mass(nodes_[static_cast<std::size_t>(link.node)], spec, link.X_NL);
    mass_ += spec.mass;
  }
  links_.push_back(link);
}

void Tree::require_regular() const {
  const int dof = undetermined_dof(*this);
  if (dof < 0) return;
  const std::string& name = link(node(dof_node(dof)).link).name;
  throw UserError("mass and inertia of " + name + " and of what hangs on it leave the motion of " +
                  "its joint undetermined; expected mass that moves with each joint by itself");
}

// The reach of a joint is the radius of gyration about it of the links beyond it.  A stop yields by
// answer::stop_depth under their weight, held out so far.
void Tree::set_gravity(double magnitude) {
  Kinematics k(*this);
  std::vector<double> q(static_cast<std::size_t>(nq_)), u(static_cast<std::size_t>(nv_));
  neutral_position(*this, q);
  place(*this, q, u, BaseMotion(), k);
  for (Axis& axis : axes_) {
    const int at = dof_node(axis.u);
    const Beyond all = beyond(*this, k, at);
    const double weight = all.mass * magnitude;
    const double reach = all.second > 0 ? std::sqrt(all.second / all.mass) : 1;
    const bool slides = node(at).kind == NodeKind::slider;
    const double standard =
        slides ? weight / (answer::stop_depth * reach) : weight * reach / answer::stop_depth;
    axis.unit = slides ? reach : 1;
    axis.slow = axis.unit * std::sqrt(magnitude / reach);
    axis.stop_stiffness = axis.law.stop_stiffness.value_or(standard);
  }
}

}  // namespace tw::multibody
