;; Springs and holds between bodies that move.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (srfi srfi-1) (srfi srfi-64) (timewarp) (timewarp vectors))
(load "helpers.scm")

(test-begin "bonds")

;; how B stands in A's frame
(define (against a b)
  (rotate (q-conjugate (orientation a)) (v- (position b) (position a))))

;; two on a spring swing against each other at sqrt(k/reduced mass); twice m2 moves half as far
(in-world ()
  (scene #:gravity #(0 0 0) #:accuracy 1e-8)
  (let* ((a (add-body! #:shape (sphere 0.1) #:mass 1 #:position #(0 0 0)))
         (b (add-body! #:shape (sphere 0.1) #:mass 3 #:position #(1 0 0) #:velocity #(0.4 0 0)))
         (frequency (sqrt 40)))
    (add-spring! a b #:stiffness 30)
    (let ((energy (total-energy)))
      (run! #:until 10)
      (let ((apart (vector-ref (v- (position b) (position a)) 0)))
        (test-approximate "it swings as it should"
          (+ 1 (* (/ 0.4 frequency) (sin (* 10 frequency)))) apart 1e-7)
        (test-approximate "its energy is kept" energy (total-energy) 1e-9)
        (test-assert "and its momentum" (close? #(1.2 0 0) (total-momentum) 1e-12))))))

;; a damped spring off the middle turns both, too
(in-world ()
  (scene #:gravity #(0 0 0) #:accuracy 1e-8)
  (let ((a (add-body! #:shape (box 0.6 0.1 0.1) #:mass 2 #:position #(0 0 0)
                      #:angular-velocity #(0 0 2)))
        (b (add-body! #:shape (box 0.6 0.1 0.1) #:mass 1 #:position #(0 1 0) #:velocity #(1 0 0.3))))
    (add-spring! a b #:at-a #(0.3 0 0) #:at-b #(-0.3 0 0) #:stiffness 50 #:damping 1 #:rest 0.4)
    (run! #:until 0.001)
    (let ((energy (total-energy)))
      (run! #:until 3)
      (test-assert "damping takes energy" (< (total-energy) (- energy 0.1)))
      (test-assert "not momentum" (close? #(1 0 0.3) (total-momentum) 1e-10)))))

;; ---- holds ----

;; two that are held together spin as one body, at the default accuracy, too
(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((spin #(4 0 0))
         (add (lambda (mass at)
                (add-body! #:shape (box 0.2 0.2 0.2) #:mass mass #:position at
                           #:velocity (cross spin at) #:angular-velocity spin)))
         (a (add 2 #(0 0 0)))
         (b (add 3 #(0 0 0.5)))
         (energy (+ (kinetic-energy a) (kinetic-energy b))))
    (attach! a b)
    (run! #:until 10)
    (test-approximate "what spins about a hold goes on"
      1 (/ (+ (kinetic-energy a) (kinetic-energy b)) energy) 5e-4)))

;; what is held falls, lands and comes to rest as one body; let go of, it is two again
(in-world ()
  (ground)
  (let ((a (add-body! #:name "a" #:shape (box 0.2 0.2 0.2) #:density 500 #:position #(0 0 1)))
        (b (add-body! #:name "b" #:shape (box 0.4 0.1 0.1) #:density 500 #:position #(0.3 0 1))))
    (test-eq "not yet" #f (attached? a b))
    (attach! a b)
    (test-eq "held" #t (attached? a b))
    (test-eq "from either side" #t (attached? b a))
    (for-each (lambda (time)
                (run! #:until time)
                (test-assert (format #f "as it was held, at ~a s" time)
                  (close? #(0.3 0 0) (against a b) 2e-5)))
              '(0.3 0.6 1 2 3))
    (test-assert "they rest" (< (+ (norm (velocity a)) (norm (velocity b))) 1e-6))
    (test-message "twice" "b and a are held together already; expected detach! before"
      (attach! b a))
    (detach! b a)
    (test-eq "no more" #f (attached? a b))
    (test-message "nor twice" "a and b are not held together" (detach! a b))
    (run-for! 1)
    (test-assert "b lies on the floor now"
      (< (abs (- (vector-ref (position b) 2) 0.05)) 1e-3))))

;; a hold to what stands: a cantilever that sags by as much as its stiffness says
(in-world ()
  (let ((wall (add-body! #:name "wall" #:shape (box 0.2 1 1) #:fixed? #t #:position #(-0.1 0 0)))
        (b (add-body! #:name "b" #:shape (box 0.2 0.2 0.2) #:mass 2 #:position #(0.11 0 0))))
    (attach! wall b #:stiffness 2000 #:damping 100)
    (run! #:until 5)
    (test-approximate "its weight over the stiffness" (/ (* -2 9.81) 2000)
                      (vector-ref (position b) 2) 1e-5)
    (let ((checks (assq-ref (statistics) 'group_checks)))
      (run! #:until 30)
      (test-equal "where it stands it costs nothing" checks (assq-ref (statistics) 'group_checks)))
    (detach! wall b)
    (run-for! 0.2)
    (test-assert "then it falls" (< (vector-ref (position b) 2) -0.15))))

;; in callbacks, on views; what a hold does is taken back with the callback
(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((a (add-body! #:name "a" #:shape (box 0.2 0.2 0.2) #:mass 1 #:position #(0 0 0)
                      #:velocity #(1 0 0)))
        (b (add-body! #:name "b" #:shape (box 0.2 0.2 0.2) #:mass 3 #:position #(0.5 0.5 0))))
    (add-callback! (list a b)
                   (lambda (time a b)
                     (cond ((attached? a b) (detach! a b) #f)
                           (else (attach! a b) 1.5)))
                   #:start 0.5 #:period #f)
    (run! #:until 0.5)
    (run! #:until 1.4)
    (test-eq "held by the callback" #t (attached? a b))
    (test-assert "two that are held move as one" (close? #(0.25 0 0)
      (v* 0.25 (v+ (velocity a) (v* 3 (velocity b)))) 1e-12))
    (test-assert "and spin about each other"
      (> (norm (angular-velocity a)) 0.1))
    (test-assert "with one spin" (close? (angular-velocity a) (angular-velocity b) 1e-4))
    (run! #:until 2)
    (test-eq "let go" #f (attached? a b))
    (test-equal "one fission" 1 (assq-ref (statistics) 'fissions))))

;; what meets sticks: attach! where two collide, in free flight
(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((a (add-body! #:name "a" #:shape (sphere 0.1) #:mass 1 #:position #(0 0 0)
                      #:velocity #(1 0 0)))
        (b (add-body! #:name "b" #:shape (sphere 0.1) #:mass 1 #:position #(0.5 0.1 0))))
    (on-collision! a b (lambda (collision a b) (unless (attached? a b) (attach! a b))))
    (run! #:until 2)
    (test-eq "held by the collision" #t (attached? a b))
    (test-approximate "they stay as near as they met" 0.2 (norm (v- (position b) (position a))) 1e-4)
    (test-assert "and go on together" (close? (angular-velocity a) (angular-velocity b) 1e-4))
    (test-assert "with their momentum" (close? #(1 0 0) (v+ (velocity a) (velocity b)) 1e-12))))

(in-world ()
  (let ((a (add-body! #:name "a" #:shape (sphere 0.1) #:density 500 #:position #(0 0 1)))
        (b (add-body! #:name "b" #:shape (sphere 0.1) #:density 500 #:position #(0.3 0 1)))
        (wall (add-body! #:name "wall" #:shape (box 0.1 1 1) #:fixed? #t #:position #(-1 0 0)))
        (post (add-body! #:name "post" #:shape (box 0.1 1 1) #:fixed? #t #:position #(-2 0 0))))
    (test-message "with itself" "the hold between a and a has both ends on one body" (attach! a a))
    (attach! a b)
    (test-eq "nothing is attached to itself" #f (attached? a a))
    (test-message "nor detached from it" "a and a are not held together" (detach! a a))
    (test-eq "what was held is" #t (attached? a b))
    (detach! a b)
    (test-message "nobody moves" "the hold between wall and post moves neither" (attach! wall post))
    (test-message "a stiffness below 0" "stiffness of the hold between a and b is -1"
      (attach! a b #:stiffness -1))
    (test-message "a point that is none" "at is 5; expected a vector" (attach! a b #:at 5))
    (test-message "no spring without stiffness" "stiffness" (add-spring! a b))
    (add-callback! a (lambda (time view) (attach! view b) #f) #:start 0.1)
    (test-message "a body where views are wanted"
      "expected a view, as the other one is: make it a target of the callback" (run! #:until 1))))

;; ---- how stiff, and how slow ----

;; a weight at the end of a long lever sinks by no more than a share of its size
(in-world ()
  (let ((wall (add-body! #:name "wall" #:shape (box 0.2 0.2 0.2) #:fixed? #t #:position #(0 0 0)))
        (b (add-body! #:name "b" #:shape (box 0.2 0.2 0.2) #:mass 1 #:position #(10 0 0))))
    (attach! wall b #:at #(0.1 0 0))
    (run! #:until 3)
    (test-approximate "ten metres off" 0 (vector-ref (position b) 2) 1e-5)))

;; a weak tether draws two heavy balls together, however slowly they start
(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((a (add-body! #:shape (sphere 0.1) #:mass 1000 #:position #(0 0 0)))
        (b (add-body! #:shape (sphere 0.1) #:mass 1000 #:position #(3 0 0))))
    (add-spring! a b #:stiffness 1e-4 #:rest 2)
    (run! #:until (* 0.5 (acos -1) (sqrt (/ 500 1e-4))))
    (test-approximate "after a quarter of its period" 2.5 (vector-ref (position b) 0) 1e-4)))

;; ---- links ----

;; an arm holds what it is attached to, and swings on when it is let go of
(in-world ()
  (let* ((rod (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0)))
         (arm (add-multibody! #:name 'arm
                (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape rod #:density 500
                  (link 'fore #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0)) #:shape rod
                        #:density 500))))
         (fore (link-body arm 'fore))
         (b (add-body! #:name "b" #:shape (box 0.1 0.1 0.1) #:density 300 #:position #(1.06 0 0))))
    (for-each (lambda (joint)
                (set! (joint-servo arm joint) (servo #:target -0.3 #:stiffness 2000 #:damping 50)))
              '(upper fore))
    (disable-collisions! arm b)
    (attach! fore b)
    (run! #:until 2)
    (test-assert "it carries the box" (close? #(0.56 0 0) (against fore b) 2e-5))
    ;; at rest the servos hold the weights of arm and box
    (let* ((torque (lambda (joint) (* 2000 (- -0.3 (joint-position arm joint)))))
           (x (lambda (body) (vector-ref (position body) 0)))
           (middle (lambda (name)
                     (let ((link (link-body arm name)))
                       (+ (x link) (vector-ref (rotate (orientation link) #(0.25 0 0)) 0)))))
           (g 9.81) (rod-mass (* 500 0.5 0.06 0.06)) (mass 0.3))
      (test-approximate "at the elbow"
        (- (+ (* rod-mass g (- (middle 'fore) (x fore))) (* mass g (- (x b) (x fore)))))
        (torque 'fore) 1e-3)
      (test-approximate "at the shoulder"
        (- (+ (* rod-mass g (+ (middle 'fore) (middle 'upper))) (* mass g (x b))))
        (torque 'upper) 1e-3))
    (detach! fore b)
    (let ((height (vector-ref (position b) 2)))
      (run-for! 0.5)
      (test-approximate "a free fall" (- height (* 0.5 9.81 0.25)) (vector-ref (position b) 2) 1e-7))))

;; a loop of one multibody's links: a four-bar linkage keeps its bars together, and a crank at one
;; speed turns it as geometry says
(in-world ()
  (let* ((bar (lambda (length) (placed (box length 0.04 0.04)
                                       #:position (vector (/ length 2) 0 0))))
         (crank 0.3) (coupler 0.9) (rocker 0.6)
         (four-bar
          (add-multibody! #:name 'four-bar
            (link 'crank #:joint (revolute #:axis #(0 1 0)) #:shape (bar crank) #:density 500
              (link 'coupler #:joint (revolute #:axis #(0 1 0) #:at (vector crank 0 0))
                    #:shape (bar coupler) #:density 500
                (link 'pin #:joint (revolute #:axis #(0 1 0) #:at (vector coupler 0 0))
                      #:shape (box 0.05 0.05 0.05) #:density 500)))
            (link 'rocker #:joint (revolute #:axis #(0 1 0) #:at #(1 0 0)) #:shape (bar rocker)
                  #:density 500)))
         ;; where the circles about the crank's end and the rocker's joint meet, the crank along x
         (x (+ 0.3 (/ (+ (- (* coupler coupler) (* rocker rocker)) 0.49) 1.4)))
         (z (sqrt (- (* coupler coupler) (expt (- x 0.3) 2))))
         (coupler-angle (- (atan z (- x 0.3)))) (rocker-angle (- (atan z (- x 1)))))
    (disable-collisions! four-bar four-bar)
    (set! (joint-position four-bar 'coupler) coupler-angle)
    (set! (joint-position four-bar 'rocker) rocker-angle)
    (set! (joint-position four-bar 'pin) (- rocker-angle coupler-angle))
    (attach! (link-body four-bar 'pin) (link-body four-bar 'rocker))
    (set! (joint-servo four-bar 'crank) (servo #:target-velocity 6 #:damping 500))
    (let ((end (lambda ()
                 (let ((bar (link-body four-bar 'rocker)))
                   (v+ (position bar) (rotate (orientation bar) (vector rocker 0 0)))))))
      (for-each
       (lambda (time)
         (run! #:until time)
         (test-assert (format #f "closed at ~a s" time)
           (close? (end) (position (link-body four-bar 'pin)) 1e-4))
         ;; the coupler is as long as it is
         (test-approximate "geometry" coupler
           (norm (v- (end) (position (link-body four-bar 'coupler)))) 1e-4))
       '(0.1 0.5 1 2 5)))))

(test-end "bonds")
