// From how a multibody comes into a world to its tree, its links' bodies and its joints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/make-multibody.h"

#include <algorithm>

#include "base/error.h"
#include "integrate/given/moving-base.h"
#include "multibody/couplings.h"
#include "multibody/kinematics.h"

namespace tw {

using namespace multibody;

namespace {

RigidInertia inertia_of(const LinkDef& link, const std::string& name) {
  const BodyDef& body = link.body;
  return resolve_inertia({body.density, body.mass, body.inertia, body.center_of_mass},
                         body.shape.get(), name);
}

std::vector<LinkSpec> specs_of(const MultibodyDef& def, const std::string& name) {
  std::vector<LinkSpec> specs;
  for (const LinkDef& link : def.links) {
    LinkSpec spec;
    spec.name = link.name;
    spec.parent = link.parent;
    spec.joint = link.joint;
    if (def.free && link.parent.empty()) {
      TW_REQUIRE(specs.empty(), "the free multibody " + name + " has two first links, " +
                                    specs.front().name + " and " + link.name +
                                    "; expected one that all others hang on");
      spec.joint = JointSpec();
      spec.joint.kind = JointKind::free;
    }
    const RigidInertia inertia = inertia_of(link, name + "/" + link.name);
    const Mat3 R = inertia.X_BP.q.toRotationMatrix();
    spec.mass = inertia.mass;
    spec.center_of_mass = inertia.X_BP.p;
    spec.inertia = R * inertia.moments.asDiagonal() * R.transpose();
    specs.push_back(spec);
  }
  return specs;
}

}  // namespace

std::shared_ptr<Multibody> make_multibody(const MultibodyDef& def, std::uint32_t number) {
  const std::string name = def.name.empty() ? "multibody-" + std::to_string(number) : def.name;
  TW_REQUIRE(!def.links.empty(), "the multibody " + name + " has no links; expected one or more");
  TW_REQUIRE(is_finite(def.position), "position of " + name + " is not finite");
  TW_REQUIRE(is_finite(def.orientation) && def.orientation.squaredNorm() > 0,
             "orientation of " + name + " is zero or not finite; expected a quaternion #(w x y z)");
  const Frame base(Pose{def.position, def.orientation.normalized()});
  Tree tree(specs_of(def, name));
  TW_REQUIRE(tree.nv() > 0, "the multibody " + name +
                                " cannot move: all of its links are welded to its base; expected "
                                "at least one joint that moves, or a body with a union of shapes");
  return std::make_shared<Multibody>(
      Multibody{number, name, def.place, std::move(tree), base, {}, {}, false, nullptr, {}});
}

MultibodyStatePtr joints_at_birth(const Multibody& multibody, const MultibodyDef& def, double now) {
  const Tree& tree = multibody.tree;
  auto joints = std::make_shared<MultibodyState>();
  joints->q.resize(static_cast<std::size_t>(tree.nq()));
  joints->u.resize(static_cast<std::size_t>(tree.nv()), 0.0);
  joints->base = MovingBase(multibody).twist(now);
  neutral_position(tree, joints->q);
  for (const Axis& axis : tree.axes())
    if (!axis.ball)
      joints->q[static_cast<std::size_t>(axis.q)] = std::clamp(0.0, axis.law.lower, axis.law.upper);
  follow_positions(tree, joints->q);
  if (def.free) {
    set_vector(joints->q.data(), def.position);
    set_quaternion(joints->q.data() + 3, def.orientation.normalized());
  }
  return joints;
}

std::vector<BodyDef> link_bodies(const Multibody& multibody, const MultibodyDef& def,
                                 const MultibodyState& joints) {
  Kinematics k(multibody.tree);
  multibody::BaseMotion around;
  around.base = multibody.base;
  place(multibody.tree, joints.q, joints.u, around, k);
  std::vector<BodyDef> bodies;
  for (const LinkDef& link : def.links) {
    BodyDef body = link.body;
    const Frame frame = link_frame(multibody.tree, k, static_cast<int>(bodies.size()));
    body.name = multibody.name + "/" + link.name;
    body.position = frame.p;
    body.orientation = Quat(frame.R).normalized();
    bodies.push_back(std::move(body));
  }
  return bodies;
}

namespace {

// Two nodes may stand for one joint: a universal one has one without a link of its own.
int parent_with_links(const Tree& tree, int node) {
  int at = tree.node(node).parent;
  const auto has_links = [&](int n) {
    return std::any_of(tree.links().begin(), tree.links().end(),
                       [n](const Link& other) { return other.node == n; });
  };
  while (at >= first_node && !has_links(at)) at = tree.node(at).parent;
  return at;
}

}  // namespace

bool hangs_on_base(const Tree& tree, int link) {
  const int node = tree.link(link).node;
  return node == base_node || (node >= first_node && parent_with_links(tree, node) == base_node);
}

std::vector<int> neighbours_of(const Tree& tree, int link) {
  const int node = tree.link(link).node;
  std::vector<int> found;
  for (int other = 0; other < tree.link_count(); ++other) {
    if (other == link) continue;
    const int theirs = tree.link(other).node;
    if (theirs == node || (node >= first_node && parent_with_links(tree, node) == theirs) ||
        (theirs >= first_node && parent_with_links(tree, theirs) == node))
      found.push_back(other);
  }
  return found;
}

}  // namespace tw
