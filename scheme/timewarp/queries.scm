;; Looking into the world: rays, distances, what is where.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp queries)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (srfi srfi-1)
  #:use-module (srfi srfi-9)
  #:use-module (srfi srfi-9 gnu)
  #:use-module (ice-9 format)
  #:export (ray-cast hit? hit-body hit-point hit-normal hit-distance closest-points overlapping
            bounding-box all-poses)
  ;; for the other modules
  #:export (candidates))

(define-record-type <hit>
  (make-hit body point normal distance)
  a-hit?
  (body body-of)
  (point point-of)
  (normal normal-of)
  (distance distance-of))

(set-record-type-printer! <hit>
  (lambda (hit port)
    (format port "#<hit ~a at ~,4f m>" (%body-name (body-of hit)) (distance-of hit))))

;; BODIES, or all of the current world, without those of IGNORE: a body, a view, or a list of them;
;; for WHO, a procedure's name.
(define (candidates who bodies ignore)
  (let ((all (or bodies (begin (%require-outside-callbacks
                                (string-append who " without #:bodies"))
                               (world-bodies))))
        (left-out (map %view-body (if (list? ignore) ignore (list ignore)))))
    (unless (list? all) (bad-value "bodies" all "a list of bodies or views"))
    (if (null? left-out)
        all
        (remove (lambda (body) (memq (%view-body body) left-out)) all))))

(define-keyword-procedure (ray-cast from direction #:key max-distance ignore bodies)
  "Return the first hit of a ray from FROM (m) in DIRECTION, a vector that is not zero, or #f.  Read it by
hit-body, hit-point, hit-normal (unit, outward) and hit-distance.  A ray that begins inside a body hits
it at once, with a normal against the ray.  At world-time; in a callback, among the views that it is
handed, which #:bodies must list.

#:max-distance  m, how far the ray goes; without end
#:ignore        a body or view that the ray passes through, or a list of them; none
#:bodies        a list of those that it may hit; all bodies of the current world"
  (let ((found (%ray-cast from direction max-distance
                          (candidates "ray-cast" bodies (or ignore '())))))
    (and found (apply make-hit found))))

(define (hit? object)
  "Return #t if OBJECT is a hit, as `ray-cast' returns them."
  (a-hit? object))

(define (part hit part-of)
  (unless (a-hit? hit) (bad-value "the hit" hit "one that `ray-cast' returned"))
  (part-of hit))

(define (hit-body hit)
  "Return the body or view that HIT is on."
  (part hit body-of))

(define (hit-point hit)
  "Return the point of HIT, m."
  (part hit point-of))

(define (hit-normal hit)
  "Return the outward unit normal of the body where HIT is."
  (part hit normal-of))

(define (hit-distance hit)
  "Return how far HIT is from where the ray began, m."
  (part hit distance-of))

(define (closest-points a b)
  "Return three values: the points of the bodies or views A and B that are nearest to each other, m, and the
signed distance.  It is negative where they overlap: minus the least way along which one has to be
moved to be free, and the points are those that part along it."
  (apply values (%closest-points a b)))

(define-keyword-procedure (overlapping shape #:key position orientation ignore bodies)
  "Return the list of the bodies that SHAPE would overlap or touch if it were placed there, at world-time; in
a callback, of the views that it is handed, which #:bodies must list.

#:position     m, where its frame is; #(0 0 0)
#:orientation  a quaternion #(w x y z); #(1 0 0 0)
#:ignore       a body or view that doesn't count, or a list of them; none
#:bodies       a list of those that count; all bodies of the current world"
  (%overlapping shape position orientation (candidates "overlapping" bodies (or ignore '()))))

(define (bounding-box body)
  "Return two values: the least and the greatest corner of the box along the world's axes that just holds
BODY, a body or view, m."
  (apply values (%bounding-box body)))

(define (all-poses)
  "Return the poses of all bodies of the current world that aren't fixed, in the order in which they were
added, as one f64vector of seven numbers each: x y z (m) and the quaternion w x y z.  Not in callbacks,
which see what they are handed."
  (%all-poses (current-world)))
