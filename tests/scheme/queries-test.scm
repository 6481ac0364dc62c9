;; Looking into the world.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (srfi srfi-4))

(test-begin "queries")

(define ground (add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t))
(define ball (add-body! #:name "ball" #:shape (sphere 0.5) #:position #(0 0 3)))
(define crate (add-body! #:name "crate" #:shape (box 1 1 1) #:position #(3 0 0.5)))
(define ghost (add-body! #:name "ghost" #:shape #f #:mass 1 #:inertia #(1 1 1)
                         #:center-of-mass #(0 0 0)))

(define down (ray-cast #(0 0 10) #(0 0 -2)))
(test-assert "a ray meets the first body" (eq? ball (hit-body down)))
(test-assert "where it enters"
  (and (close? #(0 0 3.5) (hit-point down) 1e-14) (close? 6.5 (hit-distance down) 1e-14)
       (close? #(0 0 1) (hit-normal down) 1e-14)))
(test-equal "a hit tells of itself" "#<hit ball at 6.5000 m>" (format #f "~s" down))
(test-assert "hit?" (and (hit? down) (not (hit? ball))))
(test-assert "what is ignored is passed"
  (eq? ground (hit-body (ray-cast #(0 0 10) #(0 0 -1) #:ignore ball))))
(test-assert "all of a list"
  (not (ray-cast #(0 0 10) #(0 0 -1) #:ignore (list ball ground))))
(test-assert "no farther than it may go" (not (ray-cast #(0 0 10) #(0 0 -1) #:max-distance 6)))
(test-assert "among some" (eq? crate (hit-body (ray-cast #(0 0 0.5) #(1 0 0) #:bodies (list crate)))))
(test-assert "into the sky" (not (ray-cast #(0 0 10) #(0 0 1))))
(test-message "no direction" "direction is #\\(0 0 0\\)" (ray-cast #(0 0 1) #(0 0 0)))
(test-message "no hit" "the hit is #f" (hit-point (ray-cast #(0 0 10) #(0 0 1))))

(call-with-values (lambda () (closest-points ball crate))
  (lambda (on-ball on-crate distance)
    ;; from (0 0 3) to the edge at x = 2.5, z = 1
    (let ((away (sqrt (+ (* 2.5 2.5) 4))))
      (test-assert "signed distance" (close? (- away 0.5) distance 1e-14))
      (test-assert "the nearest points" (close? #(2.5 0 1) on-crate 1e-14))
      (test-assert "of both"
        (close? (vector (* 0.5 (/ 2.5 away)) 0 (- 3 (/ 1 away))) on-ball 1e-14)))))
(test-message "what has no shape has none" "a body that has a shape" (closest-points ball ghost))

(test-equal "what overlaps a shape" (list ground crate)
  (overlapping (sphere 0.2) #:position #(2.4 0 0.1)))
(test-equal "but what is ignored" (list crate)
  (overlapping (sphere 0.2) #:position #(2.4 0 0.1) #:ignore ground))
(test-equal "nothing" '() (overlapping (box 1 1 1) #:position #(0 0 7)))

(call-with-values (lambda () (bounding-box crate))
  (lambda (lo hi)
    (test-assert "a box's box" (and (close? #(2.5 -0.5 0) lo 1e-14) (close? #(3.5 0.5 1) hi 1e-14)))))

(test-assert "all poses"
  (close? #(0 0 3 1 0 0 0 3 0 0.5 1 0 0 0 0 0 0 1 0 0 0)
          (list->vector (f64vector->list (all-poses))) 1e-15))

(run! #:until 0.1)
(test-assert "contacts of one body"
  (and (pair? (contacts #:body crate)) (null? (contacts #:body ball))
       (every (lambda (contact) (equal? (list ground crate) (contact-bodies contact)))
              (contacts #:body crate))))

;; in a callback: among the views that it is handed
(reset!)
(define floor* (add-body! #:name "floor" #:shape (half-space #(0 0 1) 0) #:fixed? #t))
(define probe (add-body! #:name "probe" #:shape (sphere 0.1) #:position #(0 0 2)
                         #:slots '((height . 0))))
(add-callback! (list probe floor*)
  (lambda (time probe floor*)
    (set! (slot probe 'height)
          (hit-distance (ray-cast (position probe) #(0 0 -1) #:ignore probe
                                  #:bodies (list probe floor*)))))
  #:period 0.1)
(run! #:until 0.25)
(test-assert "a range sensor reads the height at its tick"
  (close? (- 2 (* 1/2 9.81 0.04)) (slot probe 'height) 1e-12))
(add-callback! (list probe) (lambda (time probe) (ray-cast #(0 0 1) #(0 0 1))) #:start 0.35)
(test-message "all bodies are not for callbacks" "ray-cast without #:bodies was used inside a callback"
  (run! #:until 0.4))

(test-end "queries")
