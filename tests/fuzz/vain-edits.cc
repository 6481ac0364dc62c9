// Edits that leave nothing behind: each is refused, changes nothing, or is undone.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/vain-edits.h"

#include <limits>
#include <stdexcept>

#include "base/error.h"
#include "support/stability.h"

namespace tw::fuzz {
namespace {

template <class Edit>
void expect_refused(const char* what, Edit edit) {
  try {
    edit();
  } catch (const UserError&) {
    return;
  }
  throw std::runtime_error(std::string("nobody refused ") + what);
}

// The same once more, where it is.
BodyDef copy_of(const World& world, BodyId id, const char* name) {
  const BodyState state = world.state(id);
  BodyDef def;
  def.name = name;
  def.shape = world.body(id).shape;
  def.density = 1000;
  def.position = state.position;
  def.orientation = state.orientation;
  return def;
}

void edit_body(World& world, BodyId id) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const BodyState state = world.state(id);
  expect_refused("a body in the hands of itself", [&] { world.attach(id, id); });
  expect_refused("a velocity that is no number", [&] {
    world.edit(id, [&](StateView& view) { view.set_velocity({0, nan, 0}); });
  });
  expect_refused("a place that is no number", [&] {
    world.edit(id, [&](StateView& view) { view.set_pose({nan, 0, 0}, state.orientation); });
  });
  world.edit(id, [&](StateView& view) { view.set_velocity(state.velocity); });
  world.edit(id, [](StateView&) {});
}

}  // namespace

void edit_in_vain(World& world) {
  // whole ones about their origins hold these
  BodyId loose = no_body, other = no_body;
  for (BodyId id = 0; id < world.body_count(); ++id) {
    const BodyInfo& body = world.body(id);
    if (!test::is_dynamic(world, id) || world.multibody_of(id) || !body.shape ||
        body.shape->part_count() > 1 ||
        body.shape->mass_properties().centroid.norm() > 0.1 * body.shape->least_width())
      continue;
    other = loose;
    loose = id;
  }
  if (loose == no_body) return;
  edit_body(world, loose);
  if (other != no_body)
    expect_refused("a body within another one", [&] {
      const BodyState there = world.state(other);
      world.edit(loose, [&](StateView& view) { view.set_pose(there.position, there.orientation); });
    });

  const auto before = world.checkpoint();
  BodyDef aloft = copy_of(world, loose, "aloft");
  aloft.position += Vec3(0, 0, 1e3 * aloft.shape->least_width());
  world.add_body(aloft);
  world.edit(loose, [](StateView& view) { view.set_velocity(-2 * view.state().velocity); });
  world.restore(*before);
}

}  // namespace tw::fuzz
