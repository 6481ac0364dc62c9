// Scheme primitive: a multibody from a URDF file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf.h"
#include "base/interruption.h"

#include "collision/distance/separation.h"
#include "script/body-def.h"
#include "script/file-names.h"
#include "script/joints.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_urdf)

namespace {

Pose pose_of(const BodyState& state) { return {state.position, state.orientation}; }

// What is fixed to the base becomes a body that the robot stands on.
void stand_on(World& world, const BodyDef& stand, MultibodyDef& def, const std::string& name) {
  TW_REQUIRE(def.base == no_body || world.body(def.base).kind == BodyKind::fixed,
             "the link " + stand.name + " of " + def.name +
                 " has no mass, and would be fixed to a body that moves, " +
                 world.body(def.base).name +
                 "; expected #:base to be fixed, or <inertial> with a mass above 0");
  Pose place{def.position, def.orientation.normalized()};
  if (def.base != no_body) place = pose_of(world.state(def.base)) * place;
  BodyDef body = stand;
  body.name = name;
  body.position = place.p;
  body.orientation = place.q;
  body.place = def.place;
  def.base = world.add_body(body);
  def.position = Vec3::Zero();
  def.orientation = Quat::Identity();
}

using Sides = std::vector<std::pair<ContactSide, ContactSide>>;

ContactSide side_of(BodyId body) {
  ContactSide side;
  side.kind = ContactSide::Kind::body;
  side.body = body;
  return side;
}

ContactSettings passing() {
  ContactSettings settings;
  settings.collide = false;
  return settings;
}

// A default name that is taken gets a number: one file may be loaded often.
std::string free_name(const World& world, const std::string& name, bool stand) {
  const auto taken = [&](const std::string& candidate) {
    return world.find_multibody(candidate) || (stand && world.find_body(candidate));
  };
  std::string candidate = name;
  for (int number = 2; taken(candidate); ++number) candidate = name + "-" + std::to_string(number);
  return candidate;
}

// The pairs of a robot's parts that overlap where the joints begin, and are no neighbours, for
// those never touch; noted, the deepest by name.
Sides overlapping(const World& world, const std::vector<BodyId>& parts,
                  std::vector<std::string>& notes) {
  Sides pairs;
  double deepest = 0;
  std::string which;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      const BodyId a = parts[i], b = parts[j];
      const BodyInfo &first = world.body(a), &second = world.body(b);
      if (!first.shape || !second.shape || !world.contact_parameters(a, b).collide) continue;
      const Separation s = separation(*first.shape, Frame(pose_of(world.state(a))), *second.shape,
                                      Frame(pose_of(world.state(b))));
      if (s.distance >= 0) continue;
      pairs.emplace_back(side_of(a), side_of(b));
      if (s.distance >= deepest) continue;
      deepest = s.distance;
      which = first.name + " and " + second.name;
    }
  if (pairs.empty()) return pairs;
  const std::string depth = show(-deepest) + " m";
  notes.push_back(pairs.size() == 1
                      ? which + " overlap by " + depth +
                            " where their joints begin; they do not touch each other"
                      : std::to_string(pairs.size()) +
                            " pairs of links overlap where their joints " + "begin, " + which +
                            " most, by " + depth + "; they do not touch each other");
  return pairs;
}

Sides all_pairs(const std::vector<BodyId>& parts) {
  Sides pairs;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j)
      pairs.emplace_back(side_of(parts[i]), side_of(parts[j]));
  return pairs;
}

}  // namespace

TW_PRIMITIVE(
    load_urdf, "%load-urdf",
    (SCM world, SCM file, SCM name, SCM base, SCM position, SCM orientation, SCM place, SCM strict,
     SCM packages, SCM self_collisions),
    "Add the robot of a URDF file, #:base of #f as usual; return the multibody or, of what "
    "does not move, the body, the names of its joints, and notes of what was mended.") {
  require_outside_callbacks("load-urdf");
  const bool usual = scm_is_false(base);
  MultibodyDef def = to_root_def(world, name, usual ? scm_from_utf8_symbol("fixed") : base,
                                 position, orientation, place);
  UrdfOptions options;
  options.base = usual ? UrdfBase::automatic : def.free ? UrdfBase::free : UrdfBase::fixed;
  for (const SCM folder : to_elements(packages, "package-path", "a list of folders"))
    options.packages.push_back(to_file_name(folder, "a folder of package-path"));
  const std::string path = to_file_name(file, "the file");
  Mending mending(scm_is_true(strict));
  UrdfRobot robot = [&] {
    const InterruptionCheck check(look_for_signals);
    return read_urdf(path, options, mending);
  }();
  std::vector<std::string> notes = mending.take_notes();
  World& to = to_world(world);
  def.free = robot.free;
  if (scm_is_false(name)) def.name = free_name(to, robot.name, robot.links.empty());
  if (robot.links.empty()) {
    // scenery is one body, called as the robot
    stand_on(to, *robot.stand, def, def.name);
    return scm_list_3(from_body(world, def.base), SCM_EOL, from_strings(notes));
  }
  def.links = std::move(robot.links);
  for (LinkDef& link : def.links) link.body.place = def.place;
  const BodyId table = def.base;
  if (robot.stand) stand_on(to, *robot.stand, def, def.name + "/" + robot.stand->name);
  std::uint32_t number = 0;
  try {
    number = to.add_multibody(def);
  } catch (const UserError& error) {
    if (robot.stand) to.remove_body(def.base);
    throw UserError(path + ": " + error.what());
  }
  const Multibody& made = to.multibody(number);
  Sides pass;
  // as the first links of a multibody and its base do
  for (std::size_t i = 0; i < made.links.size(); ++i)
    if (robot.stand && table != no_body && def.links[i].parent.empty())
      pass.emplace_back(side_of(made.links[i]), side_of(table));
  if (!pass.empty()) to.set_contact(pass, passing());
  std::vector<BodyId> parts = made.links;
  if (robot.stand) parts.push_back(def.base);
  const Sides apart =
      scm_is_true(self_collisions) ? overlapping(to, parts, notes) : all_pairs(parts);
  if (!apart.empty()) to.set_contact(apart, passing());
  SCM names = SCM_EOL;
  for (std::size_t i = made.links.size(); i-- > 0;)
    names = scm_cons(
        scm_string_to_symbol(from_string(made.tree.link(static_cast<int>(i)).joint_name)), names);
  return scm_list_3(from_multibody(world, made.number), names, from_strings(notes));
}

}  // namespace tw
