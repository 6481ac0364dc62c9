;; Many bodies that are added, and no more.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-scene-parameter bodies 20000 "number of bodies")

(scene #:gravity #(0 0 0))
(do ((i 0 (+ i 1))) ((= i bodies))
  (add-body! #:shape (if (even? i) (sphere 0.1) (box 0.1 0.2 0.1)) #:density 1000
             #:position (vector (modulo i 100) (floor-quotient i 100) 0)))
