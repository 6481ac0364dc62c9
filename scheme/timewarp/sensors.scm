;; Sensors: what instruments read that are fixed to a body, what presses on it, and what passes
;; through joints, springs and holds.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sensors)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module ((timewarp queries) #:select (candidates))
  #:use-module (ice-9 match)
  #:export (accelerometer gyro net-contact-force rangefinder joint-force joint-moment spring-force
            hold-force hold-torque))

(define-keyword-procedure (accelerometer body #:key at orientation)
  "Return what an accelerometer on BODY reads, a body or a view, in its own axes, m/s^2: the acceleration of
its point less gravity's.  So it reads 9.81 upwards at rest and nothing in free flight.  It is the
acceleration of the motion that leads to the event (of a body: to world-time): an impact is no force
but an impulse, of which it shows nothing, and in on-collision! it reads what it did just before.  Of a
body that #:motion moves: that of its motion, from there on.

#:at           m, where it sits in the body's frame; #(0 0 0)
#:orientation  a quaternion #(w x y z), how its axes are turned in the body's frame; #(1 0 0 0)"
  (%accelerometer body at orientation))

(define-keyword-procedure (gyro body #:key orientation)
  "Return what a gyroscope on BODY reads, a body or a view, in its own axes, rad/s: the angular velocity.  In
on-collision! it reads what is after the impulse, as angular-velocity does.

#:orientation  a quaternion #(w x y z), how its axes are turned in the body's frame; #(1 0 0 0)"
  (%gyro body orientation))

(define-keyword-procedure (net-contact-force body #:key from)
  "Return the sum of the forces, friction included, of the lasting contacts of BODY, a body or a view, N, world
frame; #(0 0 0) where it has none.  An impact is no force but an impulse, which
collision-impulse tells: in on-collision! it is what was just before.  In a callback, what presses on a
body that is fixed or moved by #:motion is read from those that touch it: #:from must list their views.

#:from  a body or view, or a list of them: the forces of those alone; of all"
  (%net-contact-force body (and from (if (list? from) from (list from)))))

(define-keyword-procedure (rangefinder body direction #:key at max-distance ignore bodies)
  "Return the distance (m) to the first hit of a ray that is fixed to BODY, a body or a view, or #f; BODY itself
is passed through.  DIRECTION is a vector of the body's frame that is not zero.  In a callback, among the
views that it is handed, which #:bodies must list.  What is hit, and where, ray-cast tells.  Of a link, its
neighbours are not passed through: #:ignore names them.

#:at            m, where the ray begins in the body's frame; #(0 0 0)
#:max-distance  m, how far it goes; without end
#:ignore        a body or view that the ray passes through, or a list of them; none
#:bodies        a list of those that it may hit; all bodies of the current world"
  (match (%mounted-ray body at direction)
    ((from way)
     (let* ((others (if (list? ignore) ignore (if ignore (list ignore) '())))
            (found (%ray-cast from way max-distance
                              (candidates "rangefinder" bodies (cons body others)))))
       (and found (match found ((_ _ _ distance) distance)))))))

(define (joint-force multibody name)
  "Return the force that passes through the joint NAME of MULTIBODY, a multibody, a link of one, or a view
of a link, on the link that it carries, N, world frame: what a force sensor in the joint reads.  A
pendulum at rest is carried by its weight, upwards.  It holds what drives the joint, too: along the axis of
a prismatic one it is what torque, servo, spring, damping and friction give together.  Welds are
joints; a free first link has none.  It is the force on the motion that leads to the event (of a
multibody and a link: to world-time), as accelerometer has it: impulses are no forces."
  (%joint-force multibody name))

(define (joint-moment multibody name)
  "Return the torque that passes through the joint NAME of MULTIBODY, a multibody, a link of one, or a view
of a link, on the link that it carries, about the origin of the link's frame, N m, world frame: what a
torque sensor in the joint reads.  Along the axis of a revolute joint it is what torque (see
joint-torque), servo, spring, damping and friction give together; across it, what the bearing takes.
Otherwise as joint-force."
  (%joint-moment multibody name))

(define (spring-force a b)
  "Return the force on A of the springs, damping included, that add-spring! has put between A and B, N, world
frame; #(0 0 0) where there are none.  Both are bodies or views; in a callback one that is dynamic, A
if both are, must be a view.  It is the force on the motion that leads to the event (of a body: to
world-time)."
  (%spring-force a b))

(define (hold-force a b)
  "Return the force on A by which attach! holds A and B together, damping included, N, world frame; #(0 0 0)
where they are not held.  Both are bodies or views, as of spring-force."
  (%hold-force a b))

(define (hold-torque a b)
  "Return the torque on A by which attach! keeps A and B from turning against each other, about the point
where it holds, N m, world frame; #(0 0 0) where they are not held.  Both are bodies or views, as
of spring-force."
  (%hold-torque a b))
