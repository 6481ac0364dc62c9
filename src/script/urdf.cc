// Scheme primitive: a multibody from a URDF file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf.h"

#include <algorithm>

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
void stand_on(World& world, const BodyDef& stand, MultibodyDef& def) {
  TW_REQUIRE(def.base == no_body || world.body(def.base).kind == BodyKind::fixed,
             "the link " + stand.name + " of " + def.name +
                 " has no mass, and would be fixed to a body that moves, " +
                 world.body(def.base).name +
                 "; expected #:base to be fixed, or <inertial> with a mass above 0");
  Pose place{def.position, def.orientation.normalized()};
  if (def.base != no_body) place = pose_of(world.state(def.base)) * place;
  BodyDef body = stand;
  body.name = def.name + "/" + stand.name;
  body.position = place.p;
  body.orientation = place.q;
  body.place = def.place;
  def.base = world.add_body(body);
  def.position = Vec3::Zero();
  def.orientation = Quat::Identity();
}

// Lets a body pass through another one, or through all.
void let_pass(World& world, BodyId body, std::optional<BodyId> other) {
  ContactSide a, b;
  a.kind = ContactSide::Kind::body;
  a.body = body;
  b.kind = other ? ContactSide::Kind::body : ContactSide::Kind::all;
  b.body = other.value_or(no_body);
  ContactSettings settings;
  settings.collide = false;
  world.set_contact(a, b, settings);
}

}  // namespace

TW_PRIMITIVE(load_urdf, "%load-urdf",
             (SCM world, SCM file, SCM name, SCM base, SCM position, SCM orientation, SCM place),
             "Add the robot of a URDF file; return its handle and the names of its links.") {
  require_outside_callbacks("load-urdf");
  MultibodyDef def = to_root_def(world, name, base, position, orientation, place);
  UrdfRobot robot = read_urdf(to_file_name(file, "the file"), def.free);
  if (scm_is_false(name)) def.name = robot.name;
  def.links = std::move(robot.links);
  for (LinkDef& link : def.links) link.body.place = def.place;
  World& to = to_world(world);
  const BodyId table = def.base;
  if (robot.stand) stand_on(to, *robot.stand, def);
  std::uint32_t number = 0;
  try {
    number = to.add_multibody(def);
  } catch (...) {
    if (robot.stand) to.remove_body(def.base);
    throw;
  }
  const Multibody& made = to.multibody(number);
  for (std::size_t i = 0; i < made.links.size(); ++i) {
    if (std::count(robot.untouchable.begin(), robot.untouchable.end(), def.links[i].name) > 0)
      let_pass(to, made.links[i], std::nullopt);
    // as the first links of a multibody and its base do
    if (robot.stand && table != no_body && def.links[i].parent.empty())
      let_pass(to, made.links[i], table);
  }
  SCM names = SCM_EOL;
  for (std::size_t i = def.links.size(); i-- > 0;)
    names = scm_cons(scm_string_to_symbol(from_string(def.links[i].name)), names);
  return scm_cons(from_multibody(world, made.number), names);
}

}  // namespace tw
