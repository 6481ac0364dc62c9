// Evaluating and bounding arcs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/arc.h"

#include <algorithm>

namespace tw {
namespace {

bool at_rest(const StateData& arc) { return arc.group && arc.group->at_rest; }

PoseTwist group_point(const StateData& arc, double time) {
  if (at_rest(arc)) return {arc.x, arc.q, Vec3::Zero(), Vec3::Zero()};
  const GroupSample s = arc.group->arc->evaluate(static_cast<int>(arc.member), time);
  return {s.x, s.q, s.v, s.w};
}

// The body at one pose, grown by what it moves from there.
Aabb group_bounds(const Body& body, const StateData& arc, double from, double to) {
  if (at_rest(arc)) return body.shape_P->bounds(Frame(arc.q.toRotationMatrix(), arc.x));
  const GroupBounds b = arc.group->arc->bounds(static_cast<int>(arc.member), from, to);
  const double turn = b.turn * (to - from);
  if (body.sphere_radius >= 0 || turn > 0.5) {
    Aabb ball = b.path;
    ball.grow(body.radius);
    return ball;
  }
  Frame frame = frame_at(body, arc, from);
  frame.p.setZero();
  Aabb box = body.shape_P->bounds(frame);
  box.grow(turn * body.radius);
  box.lo += b.path.lo;
  box.hi += b.path.hi;
  return box;
}

}  // namespace

double natural_end(const StateData& arc) { return arc.group ? arc.group->end(arc.member) : never; }

const FreeRotation& rotation_of(const Body& body, const StateData& arc) {
  if (!arc.rotation_ready) {
    arc.rotation = FreeRotation(body.moments, arc.q, arc.L);
    arc.rotation_ready = true;
  }
  return arc.rotation;
}

PoseTwist evaluate(const Body& body, const StateData& arc, double time) {
  PoseTwist point;
  if (!body.dynamic()) {
    const Pose pose = body.motion->pose(time);
    point.x = pose.p;
    point.q = pose.q;
    body.motion->velocity(time, point.v, point.w);
    return point;
  }
  if (arc.group) return group_point(arc, time);
  const double s = time - arc.arc_time;
  point.x = arc.x + s * (arc.v + (0.5 * s) * arc.acceleration);
  point.v = arc.v + s * arc.acceleration;
  rotation_of(body, arc).evaluate(s, point.q, point.w);
  return point;
}

Frame frame_at(const Body& body, const StateData& arc, double time) {
  if (!body.dynamic()) return Frame(body.motion->pose(time));
  if (at_rest(arc)) return {arc.q.toRotationMatrix(), arc.x};
  if (arc.group) {
    Vec3 x;
    Quat attitude;
    arc.group->arc->pose(static_cast<int>(arc.member), time, x, attitude);
    return {attitude.toRotationMatrix(), x};
  }
  const Quat q = rotation_of(body, arc).attitude(time - arc.arc_time);
  return {q.toRotationMatrix(), center_at(body, arc, time)};
}

Vec3 center_at(const Body& body, const StateData& arc, double time) {
  if (!body.dynamic()) return body.motion->pose(time).p;
  if (arc.group) return frame_at(body, arc, time).p;
  const double s = time - arc.arc_time;
  return arc.x + s * (arc.v + (0.5 * s) * arc.acceleration);
}

double angular_speed_bound(const Body& body, const StateData& arc, double from, double to) {
  if (!body.dynamic()) return body.motion->angular_speed_bound(from, to);
  if (at_rest(arc)) return 0;
  if (arc.group) return arc.group->arc->bounds(static_cast<int>(arc.member), from, to).turn;
  return rotation_of(body, arc).max_angular_speed();
}

Aabb swept_bounds(const Body& body, const StateData& arc, double from, double to) {
  if (arc.group) return group_bounds(body, arc, from, to);

  // the path of the centre: ends, and where a coordinate turns
  Aabb path;
  if (body.dynamic()) {
    path.add(center_at(body, arc, from));
    path.add(center_at(body, arc, to));
    for (int i = 0; i < 3; ++i) {
      const double a = arc.acceleration[i];
      if (a == 0) continue;
      const double apex = arc.arc_time - arc.v[i] / a;
      if (apex > from && apex < to) path.add(center_at(body, arc, apex));
    }
  } else {
    path = body.motion->path_bounds(from, to);
  }

  // the shape about it: exact where it does not turn, else the ball
  if (body.sphere_radius < 0 && angular_speed_bound(body, arc, from, to) == 0) {
    Frame still = frame_at(body, arc, from);
    still.p.setZero();
    const Aabb shape = body.shape_P->bounds(still);
    path.lo += shape.lo;
    path.hi += shape.hi;
    return path;
  }
  path.grow(body.radius);
  return path;
}

}  // namespace tw
