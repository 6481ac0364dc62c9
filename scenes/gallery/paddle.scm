;;; A paddle sweeps back and forth among balls in a box without gravity: it does work on whatever it
;;; hits and never slows down, since its motion is given as a function of time.
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Paddle" #:duration 8 #:gravity #(0 0 0))

(define-scene-parameter balls-per-side 4 "balls along each edge of the starting lattice")

(define random-state (scene-random-state))
(set-contact-parameters! #t #t #:restitution 0.95 #:friction 0.1)

;; walls of a box from -2 to 2, solid outside; the floor alone is drawn
(for-each
 (lambda (name normal)
   (add-body! #:name name #:shape (half-space normal -2) #:fixed? #t
              #:visible? (string=? name "floor")))
 '("floor" "ceiling" "west" "east" "south" "north")
 '(#(0 0 1) #(0 0 -1) #(1 0 0) #(-1 0 0) #(0 1 0) #(0 -1 0)))

(add-body! #:name "paddle" #:shape (box 0.12 2.6 2.6) #:color #(0.8 0.65 0.2)
           #:motion (keyframes
                     '((0 #(-1.2 0 0)) (2 #(1.2 0 0)) (4 #(-1.2 0 0))
                       (6 #(1.2 0 0)) (8 #(-1.2 0 0)))
                     #:smooth? #t))

(define (uniform from to) (+ from (* (- to from) (random 1.0 random-state))))
(define step (/ 3.2 balls-per-side))
(for-each
 (lambda (i)
   (let* ((n balls-per-side)
          (at (lambda (k) (* step (- k (/ (1- n) 2)))))
          (vx (uniform -0.5 0.5)) (vy (uniform -0.5 0.5)) (vz (uniform -0.5 0.5)))
     (add-body! #:shape (sphere 0.15)
                #:position (vector (+ 0.3 (* 0.8 (at (quotient i (* n n)))))
                                   (at (modulo (quotient i n) n))
                                   (at (modulo i n)))
                #:velocity (vector vx vy vz))))
 (iota (expt balls-per-side 3)))

(camera #:eye #(3.2 -8.6 2.4) #:target #(0 0 -0.2) #:fov 0.62)
