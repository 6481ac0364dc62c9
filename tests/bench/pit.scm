;;; A pit into which rocks are poured: layers of rocks, let go at rest, fall between four walls.
;;;
;;; The rocks are all hulls and the pit is of boxes, so that dump-bodies.scm can write them.  Sizes
;;; much as in growth-bench.cc; the floor grows with the number of rocks of a layer.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Rocks in a pit" #:accuracy 1e-4 #:duration 10)

(define-scene-parameter across 10 "rocks of a layer to either side of the pit")
(define-scene-parameter layers 6 "layers of rocks")

(set-contact-parameters! #t #t #:restitution 0.2 #:friction 0.5)

(define state (scene-random-state))
(define (uniform from to) (+ from (* (- to from) (random:uniform state))))

;;; The pit: a floor and four walls.
(define edge (* 0.66 across))
(define (add-block! size position)
  (add-body! #:fixed? #t #:shape (apply box size) #:position position))
(add-block! (list (+ edge 2) (+ edge 2) 1) #(0 0 -0.5))
(for-each (lambda (side)
            (let ((away (* side (+ (* 1/2 edge) 0.25))))
              (add-block! (list 0.5 (+ edge 1) 8) (vector away 0 4))
              (add-block! (list (+ edge 1) 0.5 8) (vector 0 away 4))))
          '(-1 1))

;;; The rocks: in a grid, a little aside each.
(define (aside) (uniform -0.03 0.03))
(define (place index)
  (define (level cell) (+ (* 0.62 (- cell (* 1/2 (1- across)))) (aside)))
  (let ((column (remainder index across))
        (row (remainder (quotient index across) across))
        (layer (quotient index (* across across))))
    (let* ((x (level column)) (y (level row)))
      (vector x y (+ 0.4 (* 0.65 layer) (aside))))))

(define (random-orientation)
  (let* ((w (random:normal state)) (x (random:normal state))
         (y (random:normal state)) (z (random:normal state)))
    (vector w x y z)))

(for-each (lambda (index)
            (let* ((shape (rock #:size (uniform 0.3 0.45) #:random-state state))
                   (position (place index)))
              (add-body! #:shape shape #:density 2600 #:position position
                         #:orientation (random-orientation))))
          (iota (* layers across across)))
