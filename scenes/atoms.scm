;;; Atoms: 200 spheres and 100 water-like molecules bounce in a divided box (the paper, section 5).
;;;
;;; Scaled units; everything is elastic and smooth, there is no gravity.  The divider, two kinematic
;;; panels, first rests, then compresses the right compartment (its gas heats up: look at
;;; kinematic_work), rests again, and lifts, so that the gases mix.  Colour tells where a body was born.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1) (ice-9 receive))

(scene #:title "Atoms" #:duration 120 #:gravity #(0 0 0))

(define-scene-parameter spheres 200 "number of single atoms")
(define-scene-parameter molecules 100 "number of water-like molecules")
(define-scene-parameter temperature 12.0 "mean square speed of a sphere, (m/s)^2")
(define-scene-parameter compress-at 30 "time at which the divider begins to move, s; #f: never")
(define-scene-parameter room 1 "the box's edges over their usual lengths; beyond some 400 atoms more than 1")

(define half-x (* 8 room)) (define half-y (* 4 room)) (define half-z (* 4 room))
(define radius 0.25)
(define random-state (scene-random-state))

(set-contact-parameters! #t #t #:restitution 1 #:friction 0)

;;; The box: six half-spaces, solid outside.  Only the floor is drawn.
(for-each
 (lambda (name normal distance)
   (add-body! #:name name #:shape (half-space normal (- distance)) #:fixed? #t
              #:visible? (string=? name "floor") #:color #(0.62 0.64 0.66)))
 '("west" "east" "south" "north" "floor" "ceiling")
 '(#(1 0 0) #(-1 0 0) #(0 1 0) #(0 -1 0) #(0 0 1) #(0 0 -1))
 (list half-x half-x half-y half-y half-z half-z))

;;; The divider: two panels side by side, somewhat larger than the box, so that it seals.
(define panel-thickness 0.3)
(define (panel-motion y)
  (define (at t x z) (list t (vector x y z)))
  (if compress-at
      (keyframes (list (at compress-at 0 0)
                       (at (+ compress-at 15) 3 0)          ; compress
                       (at (+ compress-at 30) 3 0)          ; rest
                       (at (+ compress-at 40) 3 (* 2.2 half-z))) ; lift
                 #:smooth? #t)
      (keyframes (list (at 0 0 0)))))
(for-each
 (lambda (name y)
   (add-body! #:name name #:motion (panel-motion y) #:color #(0.9 0.9 0.95)
              #:shape (box panel-thickness half-y (* 2.1 half-z))))
 '("divider-near" "divider-far")
 (list (/ half-y -2) (/ half-y 2)))

;;; A molecule: one large atom, two small ones at 104.5 degrees.
(define molecule
  (let* ((bond 0.3) (angle (* 104.5 (/ (acos -1) 180)))
         (x (* bond (sin (/ angle 2)))) (z (* bond (cos (/ angle 2)))))
    (union (sphere radius)
           (placed (sphere 0.15) #:position (vector x 0 z))
           (placed (sphere 0.15) #:position (vector (- x) 0 z)))))

;;; Places on a lattice in either compartment, in random order; half of each kind on each side.
(define count (+ spheres molecules))
(define (places side number)
  (let* ((spacing 1.05) (wall (+ 0.55 (/ panel-thickness 2)))
         (cells (lambda (length) (inexact->exact (floor (/ (- length 1.0) spacing)))))
         (nx (cells (- half-x (/ panel-thickness 2)))) (ny (cells (* 2 half-y)))
         (nz (cells (* 2 half-z)))
         (all (append-map
               (lambda (i)
                 (append-map
                  (lambda (j)
                    (map (lambda (k)
                           (vector (* side (+ wall (* spacing (+ i 0.25))))
                                   (* spacing (- j (/ (1- ny) 2)))
                                   (* spacing (- k (/ (1- nz) 2)))))
                         (iota nz)))
                  (iota ny)))
               (iota nx)))
         (shuffled (map cdr (sort (map (lambda (p) (cons (random 1.0 random-state) p)) all)
                                  (lambda (a b) (< (car a) (car b)))))))
    (when (< (length shuffled) number)
      (error "too many atoms for the box:" number))
    (take shuffled number)))

(define (gaussian-vector scale)
  (let* ((x (random:normal random-state)) (y (random:normal random-state))
         (z (random:normal random-state)))
    (vector (* scale x) (* scale y) (* scale z))))

;; equal energy for each degree of freedom: a molecule is heavier by its two small atoms
(define speed (sqrt (/ temperature 3)))
(define (add-atom! index position left?)
  (let ((sphere? (< index spheres)))
    (add-body! #:name (string-append (if sphere? "atom-" "molecule-") (number->string index))
               #:shape (if sphere? (sphere radius) molecule)
               #:position position
               #:velocity (gaussian-vector speed)
               #:angular-velocity (if sphere? #(0 0 0) (gaussian-vector (* 2 speed)))
               #:color (cond ((and left? sphere?) #(0.90 0.33 0.13))
                             (left? #(0.97 0.72 0.22))
                             (sphere? #(0.10 0.40 0.78))
                             (else #(0.35 0.75 0.85))))))

(let* ((left-count (quotient count 2))
       (spots (append (places -1 left-count) (places 1 (- count left-count))))
       ;; alternate kinds so that both compartments get their share
       (order (map cdr (sort (map (lambda (i) (cons (random 1.0 random-state) i)) (iota count))
                             (lambda (a b) (< (car a) (car b)))))))
  (for-each (lambda (index spot) (add-atom! index spot (< (vector-ref spot 0) 0)))
            order spots))

(camera #:eye (v* room #(7 -19 8.5)) #:target #(0.2 0 -0.9) #:fov 0.66)
