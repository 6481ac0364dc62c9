;; Shapes and rotations.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (srfi srfi-4))

(define pi (acos -1))

(test-begin "shapes")

(test-assert "a sphere's volume" (close? (shape-volume (sphere 0.5)) (* 4/3 pi 0.125) 1e-15))
(test-equal "a box has full edges" 24.0 (shape-volume (box 2 3 4)))
(test-assert "a cylinder's volume" (close? (shape-volume (cylinder 0.5 2)) (* 1/2 pi) 1e-15))
(test-assert "a cylinder stands along z"
  (let ((inertia (shape-inertia (cylinder 0.5 2))))
    (< (vector-ref (vector-ref inertia 2) 2) (vector-ref (vector-ref inertia 0) 0))))
(test-message "negative length" "length.* is -1" (cylinder 1 -1))
(test-assert "a capsule is a cylinder and a ball"
  (close? (+ (* 2 pi) (* 4/3 pi)) (shape-volume (capsule 1 2)) 1e-14))
(test-assert "a cone's volume" (close? (* 4 pi) (shape-volume (cone 2 3)) 1e-14))
(test-assert "a cone's origin is its centroid" (close? #(0 0 0) (shape-centroid (cone 2 3)) 1e-15))
(test-assert "an ellipsoid's volume" (close? (* 8 pi) (shape-volume (ellipsoid 1 2 3)) 1e-14))
(test-assert "how far shapes reach"
  (close? #(2.0 2.25 3.0)
          (vector (shape-radius (capsule 1 2)) (shape-radius (cone 1 3)) (shape-radius (ellipsoid 1 2 3)))
          1e-15))
(test-equal "new shapes name themselves" "(#<shape capsule> #<shape cone> #<shape ellipsoid>)"
  (format #f "~s" (list (capsule 1 1) (cone 1 1) (ellipsoid 1 1 1))))
(test-message "a capsule without length" "length of a capsule is 0" (capsule 1 0))
(test-message "a flat cone" "height of a cone is -1" (cone 1 -1))
(test-message "a flat ellipsoid" "z semi-axis of an ellipsoid is 0" (ellipsoid 1 1 0))
(test-assert "a box's inertia at density 1"
  (close? #(#(50.0 0.0 0.0) #(0.0 40.0 0.0) #(0.0 0.0 26.0)) (shape-inertia (box 2 3 4)) 1e-13))
(test-assert "a hull's volume"
  (close? 1/6 (shape-volume (convex '(#(0 0 0) #(1 0 0) #(0 1 0) #(0 0 1)))) 1e-15))
(test-assert "a hull keeps the frame of its points"
  (close? #(1/4 1/4 1/4) (shape-centroid (convex '(#(0 0 0) #(1 0 0) #(0 1 0) #(0 0 1)))) 1e-15))
(test-assert "points may stand in a vector and be lists or f64vectors"
  (close? 1/6 (shape-volume (convex (vector '(0 0 0) #(1 0 0) (f64vector 0 1 0) #(0 0 1)))) 1e-15))
(test-equal "a union adds up" 2.0
  (shape-volume (union (box 1 1 1) (placed (box 1 1 1) #:position #(3 0 0)))))
(test-assert "placed turns before it shifts"
  (close? #(1 2 0)
          (shape-centroid (placed (placed (box 1 1 1) #:position #(2 0 0))
                                  #:position #(1 0 0)
                                  #:orientation (rotation #(0 0 1) (/ pi 2))))
          1e-15))
(test-assert "a rotation is a unit quaternion about its axis"
  (close? #(0.5 0 0 0.8660254037844386) (rotation '(0 0 7) (* 2/3 pi)) 1e-15))
(test-assert "shape?" (and (shape? (sphere 1)) (not (shape? 5))))
(test-equal "a shape is written by its kind" "#<shape sphere>" (format #f "~s" (sphere 1)))

(test-message "negative radius" "radius.* is -1" (sphere -1))
(test-message "zero edge" "0" (box 1 0 1))
(test-message "NaN radius" "NaN" (sphere +nan.0))
(test-message "a radius that is no number" "radius is \"big\"; expected a real number" (sphere "big"))
(test-message "flat hull" "flat" (convex '(#(0 0 0) #(1 0 0) #(0 1 0) #(1 1 0))))
(test-message "empty hull" "points" (convex '()))
(test-message "no points" "points is 5; expected a list of points" (convex 5))
(test-message "zero normal" "normal" (half-space #(0 0 0) 0))
(test-message "empty union" "no parts" (union))
(test-message "zero axis" "axis is #\\(0 0 0\\); expected .* not zero" (rotation #(0 0 0) 1))
(test-message "zero quaternion" "not zero" (placed (sphere 1) #:orientation #(0 0 0 0)))
(test-message "unknown keyword" "placed got the unknown keyword #:at; expected one of #:position"
  (placed (sphere 1) #:at #(0 0 0)))
(test-message "a half-space has no volume" "no bounds" (shape-volume (half-space #(0 0 1) 0)))

(test-end "shapes")
