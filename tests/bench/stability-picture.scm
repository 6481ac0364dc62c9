;;; The picture of doc/stability.md: an arch of 15 stones, a cube a million times as heavy as the nine
;;; that it stands on, and a heap of round bodies that has come to rest on hills.
;;;
;;;   timewarp --at=6 --size=900x400 --frames=stability.png stability-picture.scm
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Stability" #:duration 6)

(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.6 #:rolling-friction 0.01
                         #:spinning-friction 0.01)
(define pi (acos -1))
(define state (scene-random-state))
(define (uniform from to) (+ from (* (- to from) (random:uniform state))))

(add-body! #:name "floor" #:shape (half-space #(0 0 1) 0) #:fixed? #t #:color #(0.72 0.70 0.66))

;;; The arch: wedges of 12 degrees, a micrometre apart.
(define stones 15)
(define (arch-stone i)
  (define (corner angle r y) (vector (* r (cos angle)) y (* r (sin angle))))
  (let* ((from (* pi (/ i stones))) (to (* pi (/ (1+ i) stones)))
         (corners (append-map
                   (lambda (angle)
                     (append-map (lambda (r) (map (lambda (y) (corner angle r y)) '(-0.2 0.2)))
                                 '(1 1.3)))
                   (list from to)))
         (center (v* 1/8 (reduce v+ #(0 0 0) corners))))
    (add-body! #:shape (convex (map (lambda (x) (v* (- 1 4e-6) (v- x center))) corners))
               #:position (v+ #(-2.2 0 0) center) #:density 2400
               #:color (if (even? i) #(0.80 0.74 0.62) #(0.70 0.62 0.50)))))
(for-each arch-stone (iota stones))

;;; The column.
(for-each (lambda (i)
            (add-body! #:shape (box 0.2 0.2 0.2) #:position (vector -0.1 0 (+ 0.1 (* 0.2 i)))
                       #:density (if (= i 9) 1e9 1000)
                       #:color (if (= i 9) #(0.25 0.27 0.30) #(0.93 0.78 0.35))))
          (iota 10))

;;; The heap, in a hollow with hills.
(define cells 30)
(define spacing 0.1)
(define (height i j)
  (let ((x (* spacing (- i 15))) (y (* spacing (- j 15))))
    (+ 0.1 (* 0.25 (+ (* x x) (* y y))) (* 0.05 (sin (* 6 x)) (cos (* 5 y))))))
(add-body! #:fixed? #t #:position #(2.2 0 -0.08) #:color #(0.55 0.62 0.45)
           #:shape (height-field (map (lambda (j) (map (lambda (i) (height i j)) (iota (1+ cells))))
                                      (iota (1+ cells)))
                                 #:spacing spacing))
(define (round-shape k)
  (case (remainder k 4)
    ((0) (capsule 0.09 0.2))
    ((1) (cone 0.14 0.3))
    ((2) (ellipsoid 0.18 0.14 0.1))
    (else (cylinder 0.11 0.22))))
(for-each (lambda (k)
            (add-body! #:shape (round-shape k)
                       #:position (vector (+ 2.2 (* 0.4 (- (remainder k 3) 1)) (uniform -0.03 0.03))
                                          (+ (* 0.4 (- (remainder (quotient k 3) 3) 1))
                                             (uniform -0.03 0.03))
                                          (+ 0.9 (* 0.4 (quotient k 9))))
                       #:orientation (vector (random:normal state) (random:normal state)
                                             (random:normal state) (random:normal state))
                       #:color (list-ref '(#(0.85 0.35 0.25) #(0.95 0.65 0.25) #(0.35 0.55 0.80)
                                           #(0.45 0.70 0.60))
                                         (remainder k 4))))
          (iota 27))

(camera #:eye #(0.3 -6.2 2.6) #:target #(0.1 0 0.75) #:fov 0.62)
