;; Forces: drag, springs, and forces by procedures.  Applied forces and torques are in bodies.scm.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp forces)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp arity)
  #:use-module (timewarp purity)
  #:use-module (timewarp worlds)
  #:use-module (timewarp parts)
  #:export (add-drag! remove-drag! add-spring! remove-spring! attach! detach! attached?
            add-force! remove-force!))

(define-keyword-procedure (add-drag! body #:key linear quadratic)
  "Slow BODY, a dynamic body, from now on, by the force -(linear + quadratic |v|) v at its centre of
mass, beside what acts on it already.  Return a handle for remove-drag!.

#:linear     N s/m, 0 or more; 0
#:quadratic  N s^2/m^2, 0 or more: half the density of the air times drag coefficient and
             cross-section; 0"
  (let ((part (%add-drag! (current-world) body linear quadratic)))
    (make-handle 'drag (format #f "drag on ~a" (names-text (list body))) part)))

(define (remove-drag! drag)
  "Take DRAG, what add-drag! returned, away again, between runs; what else acts goes on."
  (remove-by-handle! "remove-drag!" 'drag "add-drag!" drag))

(define-keyword-procedure (add-spring! a b #:key at-a at-b stiffness damping rest)
  "Hold A and B together by a spring from now on, two bodies of which one at least is dynamic; links
of multibodies, too.  It pulls along the line between two points, by stiffness times what it is longer
than its rest length, and by damping times the speed at which it gets longer; it pushes where it is
shorter.  A spring of rest length 0 pulls, and damps, in all directions alike.  The two may still
collide.  Return a handle for remove-spring!.

#:at-a       #(x y z), body frame of A; #(0 0 0)
#:at-b       the same of B; #(0 0 0)
#:stiffness  N/m, 0 or more.  Must be there
#:damping    N s/m, 0 or more; 0
#:rest       m, 0 or more: its length without a force; as long as it is now"
  (let ((part (%add-spring! (current-world) a b at-a at-b stiffness damping rest)))
    (make-handle 'spring
                 (format #f "spring between ~a and ~a, ~a N/m" (names-text (list a))
                         (names-text (list b)) (short-text stiffness))
                 part)))

(define (remove-spring! spring)
  "Take SPRING, what add-spring! returned, away again, between runs.  A body that a spring tied to
another is by itself again, unless it touches it."
  (remove-by-handle! "remove-spring!" 'spring "add-spring!" spring))

(define-keyword-procedure (attach! a b #:key at stiffness damping)
  "Hold A and B from now on as they are against each other: two bodies of which one at least is
dynamic, links of multibodies, too, also of the same one, which closes a loop.  In callbacks A and B
are views of two targets.

A hold is a spring that resists all that would move the two against each other, and turns of the one
against the other; it is integrated implicitly and may be as stiff as one likes.  A blow on either
finds them as one rigid body, unless a stiffness is given.  The two may still collide (see
disable-collisions!).

#:at         #(x y z), body frame of A: where it holds; the centre of mass of B, or of A where B is
             fixed or moves by keyframes
#:stiffness  N/m, 0 or more; by default the weight of the lighter moves it by 2.5e-5 of the size of
             the lesser of the two.  Against turning it is as stiff as makes both swing alike
#:damping    N s/m, 0 or more; by default 0.7 of what is critical"
  (%attach! (current-world) a b at stiffness damping))

(define (detach! a b)
  "Let go of A and B, which attach! holds.  In callbacks both are views of targets."
  (%detach! (current-world) a b))

(define (attached? a b)
  "Return #t if attach! holds A and B together."
  (%attached? (current-world) a b))

(define (add-force! body procedure)
  "Let PROCEDURE act on BODY, a dynamic body, from now on.  It is called with the time and a view of
BODY, and returns the force at the centre of mass, #(x y z), N, or two values, force and torque (N m,
about the centre of mass), world frame.

It must be pure: the integrator asks it for times and motions that it only tries, in any order, some
twelve times a step.  From the view it may read position, orientation, velocity and
angular-velocity.  A callback that sets applied-force at a rate of its own is cheaper.
Return a handle for remove-force!."
  (check-takes "add-force!" procedure 2 "the time and a view of the body")
  (let ((part (%add-force! (current-world) body (watched procedure #:slots? #f) (caller-place))))
    (make-handle 'force (format #f "force on ~a" (names-text (list body))) part)))

(define (remove-force! force)
  "Take FORCE, what add-force! returned, away again, between runs; what else acts goes on.  After an
error of its procedure the run goes on from there without it."
  (remove-by-handle! "remove-force!" 'force "add-force!" force))
