;; Callbacks, which may change what they are handed and may run again after a rollback; observers,
;; which only look and run exactly once; and what a collision was.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp callbacks)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp arity)
  #:use-module (timewarp worlds)
  #:use-module (timewarp bodies)
  #:use-module ((timewarp multibodies) #:select (multibody?))
  #:use-module (timewarp parts)
  #:use-module (timewarp purity)
  #:use-module (ice-9 match)
  #:use-module ((srfi srfi-1) #:select (first second third fourth fifth))
  #:export (add-callback! on-collision! remove-callback! observe! remove-observer!
            collision? collision-time collision-point collision-normal collision-speed
            collision-impulse collision-bodies
            frame-time frame-index frame-views
            squeezed-time squeezed-body squeezed-between squeezed-depth squeezed-share))

(define-keyword-procedure (add-callback! targets procedure #:key start period)
  "Call PROCEDURE with the time and a view of each of TARGETS, a body or a list of bodies, at start
+ k period; of a multibody a view of its first link.  It may run again after a rollback: it must change only what it is handed, by set!.
Return a handle for remove-callback!.

#:start   s, not before the world's time; at once
#:period  s, positive; #f: PROCEDURE returns its next time, or #f for never again; #f"
  (let ((targets (if (or (body? targets) (multibody? targets)) (list targets) targets)))
    (when (list? targets)
      (check-takes "add-callback!" procedure (1+ (length targets))
                   "the time and a view of each target"))
    (let ((added (%add-callback! (current-world) targets (watched procedure) start period
                                 (caller-place))))
      (make-handle 'callback
                   (format #f "callback ~a of ~a~a" (car added) (names-text targets)
                           (if period (format #f " every ~a s" (short-text period)) ""))
                   (cdr added)))))

(define (on-collision! a b procedure)
  "Call PROCEDURE with the collision and two views, in the order A, B, after each impact between A and
B; each is a body, a multibody (for each of its links), a material, or #t for all.  It may run again
after a rollback.  Return a handle for remove-callback!."
  (check-takes "on-collision!" procedure 3 "the collision and two views")
  (let ((part (%on-collision! (current-world) a b (watched procedure) (caller-place))))
    (make-handle 'callback
                 (format #f "callback on collisions of ~a and ~a" (names-text (list a))
                         (names-text (list b)))
                 part)))

(define (remove-callback! callback)
  "Call the procedure of CALLBACK, what add-callback! or on-collision! returned, no more, between runs.
After an error of a callback the run goes on from there without it, or with another one in its place."
  (remove-by-handle! "remove-callback!" 'callback "add-callback! or on-collision!" callback))

(define (observe! kind procedure)
  "Call PROCEDURE once, in time order, with everything of KIND that is final: 'collision, 'fusion,
'fission (with the collision), 'frame (with the frame) or 'squeezed (with the squeezing: a body
that has nowhere to go, once each time that it begins).  A body is squeezed when two contacts push
it against each other, by their normal forces or by friction, one of them deeper than 2 % of its
least width, and what does not give way stands behind both; until no two push it so at 1 %.  So it
is, too, when a force of more than some million times its weight presses it deeper than 1 % into one
other, which is then both of those between which it is.
Return a handle for remove-observer!."
  (%require-outside-callbacks "observe!")
  (let ((world (current-world))
        (place (caller-place)))
    (unless (procedure? procedure) (bad-value "the observer" procedure "a procedure"))
    (check-takes "observe!" procedure 1 "what it is to see")
    (define (observer-of kinds part)
      (make-handle 'observer (string-append "observer of " kinds) part))
    (match kind
      ((or 'collision 'fusion 'fission 'squeezed)
       (observer-of (if (eq? kind 'squeezed) "squeezings" (format #f "~as" kind))
                    (%observe-collisions! world kind procedure place)))
      ('frame
       (let ((part (%frame-observer world procedure place)))
         (add-frame-observer! world part)
         (observer-of "frames" part)))
      (_ (bad-value "what to observe" kind "'collision, 'fusion, 'fission, 'frame or 'squeezed")))))

(define (remove-observer! observer)
  "Let OBSERVER, what observe! returned, look no more, between runs."
  (remove-by-handle! "remove-observer!" 'observer "observe!" observer))

;; ---- collisions ----

(define (collision? object)
  "Return #t if OBJECT is a collision."
  (and (struct? object) (eq? (struct-vtable object) <collision>)))

(define (collision-time collision)
  "Return the time of COLLISION, s."
  (%collision-time collision))

(define (collision-point collision)
  "Return the point of COLLISION, world frame, m."
  (%collision-point collision))

(define (collision-normal collision)
  "Return the unit normal of COLLISION from A to B, world frame."
  (%collision-normal collision))

(define (collision-speed collision)
  "Return the approach speed of COLLISION before the impulse, m/s."
  (%collision-speed collision))

(define (collision-impulse collision)
  "Return the sum of the normal impulses of COLLISION, N s."
  (%collision-impulse collision))

(define (collision-bodies collision)
  "Return the list of the two bodies of COLLISION, in the order A, B."
  (%collision-bodies collision))

;; ---- frames ----

(define (frame-part frame part)
  (match frame
    (((? real?) (? integer?) (views ...)) (part frame))
    (_ (bad-value "the frame" frame "what an observer of frames is handed"))))

(define (frame-time frame)
  "Return the time of FRAME, s."
  (frame-part frame car))

(define (frame-index frame)
  "Return the number of FRAME, counted from 0."
  (frame-part frame cadr))

(define (frame-views frame)
  "Return a list of views of all moving bodies in FRAME, which only look: at all that views in callbacks show,
at the frame's time."
  (frame-part frame caddr))

;; ---- squeezings ----

(define (squeezed-part squeezing part)
  (match squeezing
    (((? real?) (? body?) ((? body?) (? body?)) (? real?) (? real?)) (part squeezing))
    (_ (bad-value "the squeezing" squeezing "what an observer of 'squeezed is handed"))))

(define (squeezed-time squeezing)
  "Return the time from which the body of SQUEEZING is squeezed, s."
  (squeezed-part squeezing first))

(define (squeezed-body squeezing)
  "Return the body that has nowhere to go in SQUEEZING."
  (squeezed-part squeezing second))

(define (squeezed-between squeezing)
  "Return the list of the two bodies that push the body of SQUEEZING against each other; one body
may do both."
  (squeezed-part squeezing third))

(define (squeezed-depth squeezing)
  "Return the deeper one of the two overlaps of SQUEEZING at its time, m."
  (squeezed-part squeezing fourth))

(define (squeezed-share squeezing)
  "Return the deeper overlap of SQUEEZING at its time as a share of the thinner one's
thickness: of the body, or of who pushes it; of a union that of its thinnest part."
  (squeezed-part squeezing fifth))
