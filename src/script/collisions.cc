// Scheme primitives: what a collision was.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_collisions)

TW_PRIMITIVE(collision_time, "%collision-time", (SCM c), "Time, s.") {
  return scm_from_double(to_collision(c).collision.time);
}

TW_PRIMITIVE(collision_point, "%collision-point", (SCM c), "Point, world, m.") {
  return from_vec3(to_collision(c).collision.point);
}

TW_PRIMITIVE(collision_normal, "%collision-normal", (SCM c), "Unit normal from A to B, world.") {
  const CollisionCopy& copy = to_collision(c);
  return from_vec3(copy.reversed ? Vec3(-copy.collision.normal) : copy.collision.normal);
}

TW_PRIMITIVE(collision_speed, "%collision-speed", (SCM c), "Approach speed, m/s.") {
  return scm_from_double(to_collision(c).collision.speed);
}

TW_PRIMITIVE(collision_impulse, "%collision-impulse", (SCM c), "Normal impulse, N s.") {
  return scm_from_double(to_collision(c).collision.impulse);
}

TW_PRIMITIVE(collision_bodies, "%collision-bodies", (SCM c), "List of the handles of A and B.") {
  const CollisionCopy& copy = to_collision(c);
  const SCM world = collision_world(c);
  const SCM one = from_past_body(world, copy.collision.body1, copy.serial1);
  const SCM two = from_past_body(world, copy.collision.body2, copy.serial2);
  return copy.reversed ? scm_list_2(two, one) : scm_list_2(one, two);
}

}  // namespace tw
