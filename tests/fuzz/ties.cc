// What ties bodies together while a scene is drawn.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/ties.h"

#include <algorithm>
#include <cmath>

namespace tw::fuzz {
namespace {

using multibody::AxisSpec;
using multibody::JointKind;
using multibody::JointSpec;

const Quat z_to_x = rotation_by({0, pi / 2, 0}), z_to_y = rotation_by({pi / 2, 0, 0});

// From the origin along x.
Solid beam(Draft& draft, double length, double width) {
  const Vec3 middle(0.5 * length, 0, 0);
  switch (draft.random.below(4)) {
    case 0: return placed(capsule(0.5 * width, 0.9 * length - width), middle, z_to_x);
    case 1: return placed(cylinder(0.5 * width, 0.9 * length), middle, z_to_x);
    case 2: return placed(ball(0.45 * length), middle);
    default: return placed(box({0.9 * length, width, width}), middle);
  }
}

// `torque`: N m, of the weight of what is moved.
AxisSpec law(Draft& draft, double torque) {
  AxisSpec axis;
  if (draft.chance(0.3)) axis.damping = torque * draft.time * draft.log_uniform(1e-3, 1);
  if (draft.chance(0.2)) axis.friction = torque * draft.log_uniform(1e-3, 0.3);
  if (draft.chance(0.2)) axis.stiffness = torque * draft.log_uniform(0.1, 10);
  return axis;
}

void limit(Draft& draft, AxisSpec& axis, double lower, double upper) {
  axis.lower = lower * draft.random.real(0.1, 1);
  axis.upper = upper * draft.random.real(0.1, 1);
  axis.restitution = draft.random.real();
}

// By draws of its own, so that what follows stays as it was before there were such limits.  Mostly
// of the swing of the link: a limit of all turning sets thin links spinning about themselves, fast.
void limit_turning(Random random, JointSpec& spec) {
  if (random.real() > 0.3) return;
  spec.axes[0].upper = random.real(0.3, 2.5);
  spec.axes[0].restitution = random.real();
  if (random.real() < 0.85) spec.swinging = Vec3::UnitX();
}

JointSpec joint(Draft& draft, double length, double torque, bool moves) {
  JointSpec spec;
  switch (draft.random.below(moves ? 7 : 8)) {
    case 0:
      spec.kind = JointKind::universal;
      spec.axes = {law(draft, torque), law(draft, torque)};
      return spec;
    case 1:
    case 2:
      spec.kind = JointKind::spherical;
      spec.axes[0] = law(draft, torque);
      limit_turning(draft.random, spec);
      return spec;
    case 3:
      spec.kind = JointKind::prismatic;
      spec.axis = Vec3::UnitX();
      spec.axes[0] = law(draft, torque / length);
      limit(draft, spec.axes[0], 0, 0.5 * length);
      return spec;
    case 7: spec.kind = JointKind::weld; return spec;
    default: break;
  }
  spec.axis = draft.chance(0.5) ? Vec3(Vec3::UnitY()) : draft.direction();
  spec.axes[0] = law(draft, torque);
  if (draft.chance(0.4)) limit(draft, spec.axes[0], -1.5, 1.5);
  return spec;
}

std::size_t freedoms(const Hanging& hanging) {
  if (hanging.free) return 6;
  switch (hanging.joint.kind) {
    case JointKind::weld: return 0;
    case JointKind::universal: return 2;
    case JointKind::spherical: return 3;
    default: return 1;
  }
}

// Adds links one by one, where they are while all joints are at 0.
class Tying {
 public:
  Tying(Draft& draft, const std::string& name, const Pose& pose)
      : draft_(draft),
        name_(name + "-" + std::to_string(draft.scene.bodies.size())),
        pose_(pose),
        first_(draft.scene.bodies.size()) {}

  // On the base, or free.
  std::string add_first(std::vector<Solid> solids, std::optional<JointSpec> spec) {
    Hanging hanging;
    hanging.free = !spec;
    if (spec) hanging.joint = *spec;
    return add(std::move(solids), hanging, pose_);
  }
  std::string add(std::vector<Solid> solids, const std::string& parent, const JointSpec& spec) {
    Hanging hanging;
    hanging.parent = parent;
    hanging.joint = spec;
    const auto& bodies = draft_.scene.bodies;
    const DescribedBody& below = *std::find_if(
        bodies.begin(), bodies.end(), [&](const DescribedBody& b) { return b.name == parent; });
    const bool welded = spec.kind == JointKind::weld;
    hanging.part = welded ? below.hanging->part : "";
    hanging.on = welded ? below.hanging->on : below.hanging->part;
    const Pose& pose = below.pose;
    return add(std::move(solids), hanging,
               {pose.p + pose.q * spec.placement.p, pose.q * spec.placement.q});
  }

 private:
  std::string add(std::vector<Solid> solids, Hanging hanging, const Pose& pose) {
    hanging.multibody = name_;
    const bool prismatic = !hanging.free && hanging.joint.kind == JointKind::prismatic;
    for (std::size_t i = 0; i < freedoms(hanging); ++i) {
      const bool along = prismatic || (hanging.free && i < 3);
      const double most = 0.3 * (along ? draft_.speed : 1 / draft_.time);
      hanging.velocity.push_back(draft_.random.real(-most, most));
    }
    DescribedBody body;
    body.name = name_ + "/link-" + std::to_string(draft_.scene.bodies.size() - first_);
    body.solids = std::move(solids);
    body.pose = pose;
    if (hanging.part.empty()) hanging.part = body.name;
    body.hanging = hanging;
    draft_.scene.bodies.push_back(body);
    return body.name;
  }

  Draft& draft_;
  std::string name_;
  Pose pose_;
  std::size_t first_;
};

}  // namespace

double weight_torque(const Draft& draft, double length, double width) {
  const double g = draft.speed * draft.speed / draft.size;
  return 1000 * length * width * width * g * length;
}

namespace {

void add_chain(Draft& draft, const Vec3& middle, double length) {
  const int count = draft.whole(2, 7);
  const double each = length / count, width = each * draft.random.real(0.1, 0.4);
  const double torque = weight_torque(draft, each, width);
  const Quat yaw = rotation_by({0, 0, draft.random.real(0, 2 * pi)});
  Tying chain(draft, "chain", {middle - yaw * Vec3(0.5 * length, 0, 0), yaw});
  const bool hung = draft.chance(0.5);
  std::string last = chain.add_first(
      {beam(draft, each, width)},
      hung ? std::optional(joint(draft, each, count * torque, true)) : std::nullopt);
  for (int i = 1; i < count; ++i) {
    JointSpec spec = joint(draft, each, torque * (count - i), false);
    spec.placement.p = Vec3(each, 0, 0);
    last = chain.add({beam(draft, each, width)}, last, spec);
  }
}

void add_star(Draft& draft, const Vec3& middle, double reach) {
  const int arms = draft.whole(2, 6), segments = draft.whole(1, 2);
  const double hub = 0.3 * reach, each = (reach - hub) / segments, width = 0.25 * hub;
  const double torque = weight_torque(draft, each, width);
  Tying star(draft, "star", {middle, Quat::Identity()});
  const Solid body = draft.chance(0.5) ? ball(hub) : box({1.3 * hub, 1.3 * hub, 0.5 * hub});
  const std::string center = star.add_first({body}, std::nullopt);
  for (int arm = 0; arm < arms; ++arm) {
    const Quat turned = rotation_by({0, 0, 2 * pi * arm / arms});
    std::string last = center;
    for (int i = 0; i < segments; ++i) {
      JointSpec spec = joint(draft, each, torque * (segments - i), false);
      if (i == 0)
        spec.placement = {turned * Vec3(hub, 0, 0), turned};
      else
        spec.placement.p = Vec3(each, 0, 0);
      last = star.add({beam(draft, each, width)}, last, spec);
    }
  }
}

}  // namespace

std::string add_cart(Draft& draft, const Vec3& middle, double length) {
  const double radius = length * draft.random.real(0.1, 0.25);
  const double torque = weight_torque(draft, radius, radius);
  Tying cart(draft, "cart", {middle, rotation_by({0, 0, draft.random.real(0, 2 * pi)})});
  const std::string chassis =
      cart.add_first({box({length, 0.5 * length, 0.2 * length})}, std::nullopt);
  for (const double x : {-0.35, 0.35})
    for (const double y : {-0.35, 0.35}) {
      JointSpec spec;
      spec.axis = Vec3::UnitY();
      spec.axes[0] = law(draft, torque);
      spec.axes[0].stiffness = 0;
      spec.placement.p = length * Vec3(x, y, -0.1);
      cart.add({placed(cylinder(radius, 0.1 * length), Vec3::Zero(), z_to_y)}, chassis, spec);
    }
  return chassis;
}

void add_tool(Draft& draft, const Vec3& start, double size, double speed) {
  Tying tool(draft, "tool", {start, Quat::Identity()});
  const double mass = 1000 * size * size * size * draft.log_uniform(0.1, 10);
  const auto slide = [](const Vec3& axis) {
    JointSpec spec;
    spec.kind = JointKind::prismatic;
    spec.axis = axis;
    return spec;
  };
  const auto make_bare = [&] {
    DescribedBody& link = draft.scene.bodies.back();
    link.bare_mass = mass;
    link.bare_moment = mass * size * size;
    return &*link.hanging;
  };
  const std::string along = tool.add_first({}, slide(Vec3::UnitX()));
  make_bare()->velocity = {speed};
  const std::string up = tool.add({}, along, slide(Vec3::UnitZ()));
  make_bare()->velocity = {0};
  JointSpec spec;
  spec.kind = draft.chance(0.4)   ? JointKind::revolute
              : draft.chance(0.5) ? JointKind::weld
                                  : JointKind::spherical;
  spec.axis = Vec3::UnitY();
  const double r = 0.5 * size, wide = size * draft.random.real(0.1, 1);
  const Solid shapes[] = {placed(cylinder(r, wide), Vec3::Zero(), z_to_y), ball(r),
                          box({size, wide, size}), cone(r, size),
                          placed(capsule(0.5 * wide, size - wide), Vec3::Zero(), z_to_y)};
  tool.add({shapes[draft.random.below(5)]}, up, spec);
  if (spec.kind == JointKind::revolute)
    draft.scene.bodies.back().hanging->velocity = {draft.chance(0.5) ? speed / r : 0};
}

void add_tree(Draft& draft, const Vec3& middle, double reach) {
  switch (draft.random.below(4)) {
    case 0: add_star(draft, middle, 0.5 * reach); return;
    case 1: add_cart(draft, middle, reach); return;
    default: add_chain(draft, middle, reach);
  }
}

std::vector<std::string> loose(const DescribedScene& scene) {
  std::vector<std::string> names;
  for (const DescribedBody& body : scene.bodies)
    if (body.dynamic() && !body.hanging) names.push_back(body.name);
  return names;
}

double typical_mass(const Draft& draft) { return 1000 * std::pow(0.4 * draft.size, 3); }

void add_spring(Draft& draft, const std::string& a, const std::string& b) {
  const double g = draft.speed * draft.speed / draft.size, mass = typical_mass(draft);
  DescribedBond bond;
  bond.a = a;
  bond.b = b;
  bond.spring.at_a = draft.vector(0.3 * draft.size);
  bond.spring.at_b = draft.vector(0.3 * draft.size);
  bond.spring.stiffness = mass * g / draft.size * draft.log_uniform(1, 1000);
  if (draft.chance(0.5))
    bond.spring.damping = 2 * std::sqrt(bond.spring.stiffness * mass) * draft.log_uniform(1e-3, 1);
  if (draft.chance(0.3))
    bond.spring.rest = draft.chance(0.5) ? 0 : draft.size * draft.random.real();
  draft.scene.bonds.push_back(bond);
}

void add_hold(Draft& draft, const std::string& a, const std::string& b) {
  DescribedBond bond;
  bond.a = a;
  bond.b = b;
  bond.holds = true;
  draft.scene.bonds.push_back(bond);
}

DescribedCallback callback(Draft& draft, Deed deed, std::vector<std::string> targets) {
  DescribedCallback made;
  made.deed = deed;
  made.targets = std::move(targets);
  made.period = draft.time * draft.log_uniform(0.05, 1);
  made.start = made.period * draft.random.real();
  return made;
}

}  // namespace tw::fuzz
