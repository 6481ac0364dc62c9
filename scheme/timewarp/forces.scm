;; Forces: drag, springs, and forces by procedures.  Applied forces and torques are in bodies.scm.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp forces)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:export (add-drag! add-spring! add-force!))

(define-keyword-procedure (add-drag! body #:key linear quadratic)
  "Slow BODY, a dynamic body, from now on, by the force -(linear + quadratic |v|) v at its centre of
mass, beside what acts on it already.

#:linear     N s/m, 0 or more; 0
#:quadratic  N s^2/m^2, 0 or more: half the density of the air times drag coefficient and
             cross-section; 0"
  (%add-drag! (current-world) body linear quadratic))

(define-keyword-procedure (add-spring! a b #:key at-a at-b stiffness damping rest)
  "Hold A and B together by a spring from now on, two bodies of which one is dynamic and the other
fixed or kinematic.  It pulls along the line between two points, by stiffness times what it is longer
than its rest length, and by damping times the speed at which it gets longer; it pushes where it is
shorter.  A spring of rest length 0 pulls, and damps, in all directions alike.

#:at-a       #(x y z), body frame of A; #(0 0 0)
#:at-b       the same of B; #(0 0 0)
#:stiffness  N/m, 0 or more.  Must be there
#:damping    N s/m, 0 or more; 0
#:rest       m, 0 or more: its length without a force; as long as it is now"
  (%add-spring! (current-world) a b at-a at-b stiffness damping rest))

(define (add-force! body procedure)
  "Let PROCEDURE act on BODY, a dynamic body, from now on.  It is called with the time and a view of
BODY, and returns the force at the centre of mass, #(x y z), N, or two values, force and torque (N m,
about the centre of mass), world frame.

It must be pure: the integrator asks it for times and motions that it only tries, in any order, some
twelve times a step.  From the view it may read position, orientation, velocity and
angular-velocity.  A callback that sets applied-force at a rate of its own is cheaper."
  (%add-force! (current-world) body procedure (caller-place)))
