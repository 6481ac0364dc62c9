// Scheme primitive: a multibody from a URDF file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/urdf.h"

#include <algorithm>

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

// As the first links of a multibody and its base do not.
void pass_through(World& world, BodyId a, BodyId b) {
  ContactSide side_a, side_b;
  side_a.kind = side_b.kind = ContactSide::Kind::body;
  side_a.body = a;
  side_b.body = b;
  ContactSettings settings;
  settings.collide = false;
  world.set_contact(side_a, side_b, settings);
}

void touch_nothing(World& world, BodyId id) {
  ContactSide body, all;
  body.kind = ContactSide::Kind::body;
  body.body = id;
  all.kind = ContactSide::Kind::all;
  ContactSettings settings;
  settings.collide = false;
  world.set_contact(body, all, settings);
}

}  // namespace

TW_PRIMITIVE(load_urdf, "%load-urdf",
             (SCM world, SCM file, SCM name, SCM base, SCM position, SCM orientation, SCM place),
             "Add the robot of a URDF file; return its handle and the names of its links.") {
  require_outside_callbacks("load-urdf");
  const bool on_body = stands_for_body(base);
  const std::string kind = scm_is_symbol(base) ? to_symbol_name(base, "base") : "";
  if (!on_body && kind != "free" && kind != "fixed")
    throw BadValue{"base", base, "'fixed, 'free, or a fixed body"};
  UrdfRobot robot = read_urdf(to_file_name(file, "the file"), kind == "free");
  MultibodyDef& def = robot.multibody;
  if (scm_is_true(name)) def.name = to_link_name(name, "the name of a multibody");
  if (on_body) def.base = to_body(world, base, "base");
  if (scm_is_true(position)) def.position = to_vec3(position, "position");
  if (scm_is_true(orientation)) def.orientation = to_quat(orientation, "orientation");
  if (is_place(place)) def.place = to_place(place);
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
  for (std::size_t i = 0; i < made.links.size(); ++i)
    if (std::count(robot.untouchable.begin(), robot.untouchable.end(), def.links[i].name) > 0)
      touch_nothing(to, made.links[i]);
  if (robot.stand && table != no_body)
    for (std::size_t i = 0; i < made.links.size(); ++i)
      if (def.links[i].parent.empty()) pass_through(to, made.links[i], table);
  SCM names = SCM_EOL;
  for (std::size_t i = def.links.size(); i-- > 0;)
    names = scm_cons(scm_string_to_symbol(from_string(def.links[i].name)), names);
  return scm_cons(from_multibody(world, made.number), names);
}

}  // namespace tw
