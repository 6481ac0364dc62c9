;; Shapes and rotations.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp shapes)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:export (sphere box convex half-space union placed rotation
            shape-volume shape-inertia shape-centroid shape?))

(define (sphere radius)
  "Return a sphere of RADIUS metres about the origin."
  (%sphere radius))

(define (box x y z)
  "Return a box with full edges X, Y, Z in metres, centred at the origin."
  (%box x y z))

(define (convex points)
  "Return the convex hull of POINTS, a list or vector of #(x y z) in metres.  The origin is that of
the points."
  (%convex points))

(define (half-space normal offset)
  "Return the half-space that is solid where NORMAL.x <= OFFSET.  For fixed or kinematic bodies
only."
  (%half-space normal offset))

(define (union . shapes)
  "Return the union of SHAPES, a shape that need not be convex.  Where parts overlap, mass properties
count the overlap twice."
  (%union shapes))

(define-keyword-procedure (placed shape #:key position orientation)
  "Return SHAPE moved within the body's frame: turned by orientation, then shifted by position."
  (%placed shape position orientation))

(define (rotation axis angle)
  "Return the quaternion #(w x y z) that rotates by ANGLE radians about AXIS."
  (%rotation axis angle))

(define (shape-volume shape)
  "Return the volume of SHAPE in cubic metres."
  (%shape-volume shape))

(define (shape-inertia shape)
  "Return the inertia of SHAPE about its centroid at density 1, as three rows."
  (%shape-inertia shape))

(define (shape-centroid shape)
  "Return the centroid of SHAPE in its own frame."
  (%shape-centroid shape))

(define (shape? object)
  "Return #t if OBJECT is a shape."
  (eq? (class-of* object) <shape>))

(define (class-of* object)
  (and (struct? object) (struct-vtable object)))
