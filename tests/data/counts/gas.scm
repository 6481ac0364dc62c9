;; Balls in a box that lose nothing: what a collision costs.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-scene-parameter balls 200 "number of balls")

(define side (ceiling (expt balls 1/3)))
(scene #:gravity #(0 0 0))
(set-contact-parameters! #t #t #:restitution 1 #:friction 0)
(for-each
 (lambda (axis)
   (define (along x) (list->vector (map (lambda (i) (if (= i axis) x 0)) '(0 1 2))))
   (add-body! #:shape (half-space (along 1) 0) #:fixed? #t)
   (add-body! #:shape (half-space (along -1) (- side)) #:fixed? #t))
 '(0 1 2))
(define (place i k) (+ 0.5 (modulo (floor-quotient i (expt side k)) side)))
(define (speed) (- (random 6.0) 3))
(do ((i 0 (+ i 1))) ((= i balls))
  (add-body! #:shape (sphere 0.25) #:density 1000
             #:position (vector (place i 0) (place i 1) (place i 2))
             #:velocity (vector (speed) (speed) (speed))))
