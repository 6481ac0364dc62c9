// Where all links of a multibody are and how they move.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/kinematics.h"

#include <cmath>

namespace tw::multibody {
namespace {

// Motion per unit of an angular velocity about an axis through r.
Motion turning(const Vec3& axis, const Vec3& r) { return {axis, r.cross(axis)}; }

// A hinge: the frame of the joint turned about its z.
void place_hinge(const Mat3& R, double angle, NodeMotion& node) {
  const double s = std::sin(angle), c = std::cos(angle);
  node.R.col(0) = c * R.col(0) + s * R.col(1);
  node.R.col(1) = c * R.col(1) - s * R.col(0);
  node.R.col(2) = R.col(2);
}

void set_scalar_motion(const NodeMotion& parent, const Motion& axis, double rate,
                       NodeMotion& node) {
  const Motion joint = axis * rate;
  node.V = parent.V + joint;
  node.A = parent.A + cross(parent.V, joint);
}

void place_ball(const NodeMotion& parent, const Mat3& R, const double* q, const double* u,
                NodeMotion& node, Motion* axes) {
  node.R = R * quaternion_at(q).toRotationMatrix();
  for (int c = 0; c < 3; ++c) axes[c] = turning(node.R.col(c), node.r);
  const Motion joint = turning(node.R * vector_at(u), node.r);
  node.V = parent.V + joint;
  // axes are fixed in the node: V x joint, and joint x joint = 0
  node.A = parent.A + cross(parent.V, joint);
}

void place_floating(const NodeMotion& world, const Vec3& origin, const double* q, const double* u,
                    NodeMotion& node, Motion* axes) {
  node.R = quaternion_at(q + 3).toRotationMatrix();
  node.r = vector_at(q) - origin;
  for (int c = 0; c < 3; ++c) {
    axes[c] = {Vec3::Zero(), Vec3::Unit(c)};
    axes[3 + c] = turning(Vec3::Unit(c), node.r);
  }
  const Vec3 v = vector_at(u), w = vector_at(u + 3);
  node.V = {w, v + node.r.cross(w)};
  // v' of the fixed point: the field moves on with v
  node.A = world.A;
  node.A.v -= w.cross(v);
}

Vec3 default_origin(const Tree& tree, In q, const BaseMotion& around) {
  const bool free =
      tree.node_count() > first_node && tree.node(first_node).kind == NodeKind::floating;
  return free ? vector_at(q.data()) : around.base.p;
}

void place_base(const BaseMotion& around, Kinematics& k) {
  NodeMotion& world = k.node(world_node);
  world.R = Mat3::Identity();
  world.r = -k.origin;
  world.V = Motion();
  world.A = {Vec3::Zero(), -around.gravity};
  NodeMotion& base = k.node(base_node);
  base.R = around.base.R;
  base.r = around.base.p - k.origin;
  base.V = {around.w, around.v + base.r.cross(around.w)};
  base.A = {around.alpha,
            around.a + base.r.cross(around.alpha) - around.w.cross(around.v) - around.gravity};
  for (int i : {world_node, base_node}) {
    k.node(i).center = k.node(i).r;
    k.node(i).moments = Sym3();
    k.node(i).W = Force();
  }
}

}  // namespace

Kinematics::Kinematics(const Tree& tree)
    : nodes(static_cast<std::size_t>(tree.node_count())),
      axes(static_cast<std::size_t>(tree.nv())) {}

void place(const Tree& tree, In q, In u, const BaseMotion& around, const Vec3& origin,
           Kinematics& k) {
  k.origin = origin;
  place_base(around, k);
  for (int i = first_node; i < tree.node_count(); ++i) {
    const Node& fixed = tree.node(i);
    const NodeMotion& parent = k.node(fixed.parent);
    NodeMotion& node = k.node(i);
    const double* const qi = q.data() + fixed.q;
    const double* const ui = u.data() + fixed.u;
    Motion* const axes = k.axes.data() + fixed.u;
    if (fixed.kind == NodeKind::floating) {
      place_floating(parent, origin, qi, ui, node, axes);
    } else {
      const Mat3 R = parent.R * fixed.X_PF.R;
      node.r = parent.r + parent.R * fixed.X_PF.p;
      if (fixed.kind == NodeKind::hinge) {
        place_hinge(R, *qi, node);
        *axes = turning(node.R.col(2), node.r);
        set_scalar_motion(parent, *axes, *ui, node);
      } else if (fixed.kind == NodeKind::slider) {
        node.R = R;
        node.r += *qi * R.col(2);
        *axes = {Vec3::Zero(), R.col(2)};
        set_scalar_motion(parent, *axes, *ui, node);
      } else {
        place_ball(parent, R, qi, ui, node, axes);
      }
    }
    node.center = node.r + node.R * fixed.center;
    node.moments = turned(node.R, fixed.moments);
    node.W = Force();
  }
}

void place(const Tree& tree, In q, In u, const BaseMotion& around, Kinematics& k) {
  place(tree, q, u, around, default_origin(tree, q, around), k);
}

Frame link_frame(const Tree& tree, const Kinematics& k, int link) {
  const Link& fixed = tree.link(link);
  const NodeMotion& node = k.node(fixed.node);
  return {node.R * fixed.X_NL.R, k.origin + node.r + node.R * fixed.X_NL.p};
}

LinkTwist link_twist(const Tree& tree, const Kinematics& k, int link) {
  const Link& fixed = tree.link(link);
  const NodeMotion& node = k.node(fixed.node);
  const Vec3 r = node.r + node.R * fixed.X_NL.p;
  return {node.V.v + node.V.w.cross(r), node.V.w};
}

Vec3 link_center_of_mass(const Tree& tree, const Kinematics& k, int link) {
  return link_frame(tree, k, link) * tree.link(link).center_of_mass;
}

void add_force(const Tree& tree, Kinematics& k, int link, const Vec3& point, const Vec3& force) {
  k.node(tree.link(link).node).W += Force{(point - k.origin).cross(force), force};
}

void add_torque(const Tree& tree, Kinematics& k, int link, const Vec3& torque) {
  k.node(tree.link(link).node).W.n += torque;
}

}  // namespace tw::multibody
