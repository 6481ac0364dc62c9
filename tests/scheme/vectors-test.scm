;; (timewarp vectors)
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors) (srfi srfi-4))

(test-begin "vectors")

(test-equal "sums take any number of vectors" #(9 12 15) (v+ #(1 2 3) #(3 4 5) #(5 6 7)))
(test-equal "differences subtract all the others" #(-2 -2 -2) (v- #(1 2 3) #(3 4 5)))
(test-equal "one argument is negated" #(-1 -2 -3) (v- #(1 2 3)))
(test-equal "a number multiplies from the left" #(2 4 6) (v* 2 #(1 2 3)))
(test-equal "a number multiplies from the right" #(2 4 6) (v* #(1 2 3) 2))
(test-equal "dot" 32 (dot #(1 2 3) #(4 5 6)))
(test-equal "x cross y is z" #(0 0 1) (cross #(1 0 0) #(0 1 0)))
(test-equal "norm" 13 (norm #(3 4 12)))
(test-equal "normalize" #(0 3/5 4/5) (normalize #(0 3 4)))
(test-equal "lerp of numbers" 3/2 (lerp 1 2 1/2))
(test-equal "lerp of vectors ends at B" #(4 5 6) (lerp #(1 2 3) #(4 5 6) 1))
(test-equal "lists and f64vectors are vectors, too" #(2.0 4.0 6.0) (v+ '(1 2 3) (f64vector 1 2 3)))

(let ((quarter (rotation #(0 0 1) (acos 0))))
  (test-assert "a quarter turn about z takes x to y"
    (close? #(0 1 0) (rotate quarter #(1 0 0)) 1e-15))
  (test-assert "the last quaternion is applied first"
    (close? (rotate quarter (rotate (rotation #(1 0 0) 1) #(1 2 3)))
            (rotate (q* quarter (rotation #(1 0 0) 1)) #(1 2 3)) 1e-15))
  (test-assert "the conjugate undoes a rotation"
    (close? #(1 2 3) (rotate (q-conjugate quarter) (rotate quarter #(1 2 3))) 1e-15)))

(test-equal "vectors of any length" '(#(5 7 9 11) 40 5)
  (list (v- (v* 2 (v+ #(1 2 3 4) #(2 2 2 2))) #(1 1 1 1)) (dot #(1 2 3 4) #(2 3 4 5)) (norm #(3 4))))
(test-message "vectors of two lengths"
  "argument is #\\(1 2 3\\); expected a vector of 2 numbers, as the other" (v+ #(1 2) #(1 2 3)))
(test-message "no vector product of two numbers" "argument is #\\(1 2\\); expected a vector"
  (cross #(1 2) #(1 2 3)))
(test-message "no numbers" "argument is #\\(a\\); expected a vector of numbers" (v+ #(a)))
(test-message "zero has no direction" "expected one that is not zero" (normalize #(0 0 0)))
(test-message "two vectors are no product" "expected a number and a vector" (v* #(1 2 3) #(1 2 3)))

(test-end "vectors")
