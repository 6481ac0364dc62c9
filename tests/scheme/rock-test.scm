;; Rocks, and the radius of shapes.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(define pi (acos -1))
(define (state) (seed->random-state 42))
(define (drawn count . keywords)
  (let ((state (state)))
    (map-in-order (lambda (i) (apply rock #:random-state state keywords)) (iota count))))

(test-begin "rock")

(for-each
 (lambda (size)
   (let ((stone (rock #:size size #:random-state (state))))
     (test-assert "a rock has the volume of a ball of its size"
       (close? 1 (/ (shape-volume stone) (* 1/6 pi size size size)) 1e-14))
     (test-assert "its centroid is the origin"
       (close? #(0 0 0) (shape-centroid stone) (* 1e-15 size)))))
 '(1e-3 0.4 7 100))

(test-equal "size is 1 and there are 16 vertices unless said otherwise"
  (shape-inertia (rock #:size 1 #:vertices 16 #:random-state (state)))
  (shape-inertia (rock #:random-state (state))))
(test-assert "no two rocks drawn from one state are alike"
  (let ((inertias (map shape-inertia (drawn 50))))
    (= 50 (length (delete-duplicates inertias)))))
(test-assert "rocks are boulders, not needles: their radius is below 0.85 of their size"
  (every (lambda (stone) (< 0.5 (shape-radius stone) 0.85)) (drawn 200)))
(test-assert "four vertices are enough" (< 0 (shape-radius (rock #:vertices 4)) 2))

(in-world ()
  (scene #:seed 3)
  (test-equal "by default the scene's random state is taken afresh"
    (list (shape-inertia (rock)) (shape-inertia (rock)))
    (list (shape-inertia (rock #:random-state (seed->random-state 3)))
          (shape-inertia (rock #:random-state (scene-random-state)))))
  (let ((first (shape-inertia (rock))))
    (scene #:seed 4)
    (test-assert "another seed gives another rock" (not (equal? first (shape-inertia (rock)))))))

(test-message "no size" "size is 0; expected a positive number" (rock #:size 0))
(test-message "negative size" "size is -1" (rock #:size -1))
(test-message "infinite size" "size is \\+inf.0" (rock #:size +inf.0))
(test-message "NaN" "size is \\+nan.0" (rock #:size +nan.0))
(test-message "too few vertices" "vertices is 3; expected an integer from 4" (rock #:vertices 3))
(test-message "half a vertex" "vertices is 9/2" (rock #:vertices 9/2))
(test-message "a seed is no random state" "random-state is 5; expected a Guile random state"
  (rock #:random-state 5))
(test-message "unknown keyword" "rock got the unknown keyword #:seed" (rock #:seed 5))

(test-equal "a ball's radius" 2.0 (shape-radius (sphere 2)))
(test-assert "a box's radius reaches its corners" (close? 3.5 (shape-radius (box 2 3 6)) 1e-15))
(test-assert "the radius is about the frame's origin, not the centroid"
  (close? 5 (shape-radius (placed (sphere 1) #:position #(0 4 0))) 1e-15))
(test-message "a half-space has none" "no bounds" (shape-radius (half-space #(0 0 1) 0)))

(test-end "rock")
