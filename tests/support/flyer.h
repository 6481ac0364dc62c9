// Two bodies that fly or stand, and the piece of both: what certificates and exact impacts are
// asked of, without a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "detect/piece.h"
#include "integrate/standing.h"
#include "timeline/successor.h"

namespace tw::test {

// One of a pair, and its state: it flies from time 0 on.
struct Flyer {
  Body body;
  State state;

  Flyer(BodyId id, ShapePtr shape, const Vec3& x, const Vec3& v, const Vec3& L = Vec3::Zero()) {
    body.info.id = id;
    body.mass = 1;
    body.moments = Vec3(0.1, 0.15, 0.2);
    body.shape_P = shape;
    body.radius = shape->radius_about_origin();
    body.least_width = shape->least_width();
    body.thickness = shape->thickness();
    const ConvexPart& part = shape->parts().front();
    if (part.kind == PartKind::sphere) body.sphere_radius = part.radius;
    state.x = x;
    state.v = v;
    state.L = L;
    state.acceleration = Vec3(0, 0, -9.81);
    let_fly(body, state);
  }
  Flyer& carried() {
    state.follows = make_resting({state.x, state.q});
    return *this;
  }
};

inline Piece between(const Flyer& a, const Flyer& b) {
  Piece piece;
  piece.a = &a.state;
  piece.b = &b.state;
  piece.body_a = &a.body;
  piece.body_b = &b.body;
  piece.end = last_key;
  return piece;
}

}  // namespace tw::test
