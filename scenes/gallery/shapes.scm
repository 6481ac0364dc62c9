;;; Without gravity, in a room that loses nothing: every kind of shape tumbles about, passes its motion on
;;; and keeps the sum of it.
(use-modules (timewarp))

(scene #:title "Shapes in zero gravity" #:duration 12 #:gravity #(0 0 0) #:seed 4)

(define-scene-parameter count 60 "how many bodies")
(define-scene-parameter speed 1.5 "m/s, at most, along each axis at the start")

(define room 2)   ; half its width
(for-each (lambda (normal)
            (add-body! #:shape (half-space normal (- room)) #:fixed? #t #:visible? #f))
          '(#(1 0 0) #(-1 0 0) #(0 1 0) #(0 -1 0) #(0 0 1) #(0 0 -1)))
(add-body! #:name "floor" #:shape (box (* 2 room) (* 2 room) 0.02) #:fixed? #t
           #:position (vector 0 0 (- (+ room 0.01))) #:color #(0.5 0.52 0.55))
(set-contact-parameters! #t #t #:restitution 1 #:friction 0)

(define random-state (scene-random-state))
(define (uniform from to) (+ from (* (- to from) (random:uniform random-state))))
(define (random-vector most)
  (vector (uniform (- most) most) (uniform (- most) most) (uniform (- most) most)))

(define shapes
  (vector (lambda () (sphere 0.16))
          (lambda () (box 0.3 0.24 0.18))
          (lambda () (cylinder 0.13 0.3))
          (lambda () (capsule 0.1 0.25))
          (lambda () (cone 0.18 0.34))
          (lambda () (ellipsoid 0.22 0.15 0.1))
          (lambda () (rock #:size 0.3 #:random-state random-state))
          (lambda () (union (box 0.4 0.08 0.08) (box 0.08 0.4 0.08) (box 0.08 0.08 0.4)))))

;; one in each cell of a grid of 5 x 5 x 5, so that none overlap at the start
(do ((k 0 (1+ k))) ((= k (min count 125)))
  (let ((cell (lambda (i) (* 0.78 (- (modulo i 5) 2)))) (j (modulo (* 47 k) 125)))
    (add-body! #:shape ((vector-ref shapes (modulo k 8)))
               #:position (vector (cell j) (cell (quotient j 5)) (cell (quotient j 25)))
               #:orientation (rotation (random-vector 1) (uniform 0 6))
               #:velocity (random-vector speed) #:angular-velocity (random-vector 5))))

(camera #:eye #(4.5 -6 3.5) #:target #(0 0 -0.2) #:fov 0.7)
