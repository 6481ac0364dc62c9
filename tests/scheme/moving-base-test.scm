;; Multibodies on bodies whose motion is given, against closed forms.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp vectors) (srfi srfi-11))
(load "helpers.scm")

(test-begin "moving-base")

(define no-turn #(1 0 0 0))
(define (bob-link length . more)
  (link 'bob #:joint (apply revolute #:axis #(0 1 0) more) #:mass 2
        #:inertia #(1e-3 1e-3 1e-3) #:center-of-mass (vector 0 0 (- length))))
(define (carrier motion)
  (add-body! #:name "carrier" #:shape (box 0.1 0.1 0.1) #:motion motion #:max-speed 50))
(define (driven frames)
  (add-body! #:name "carrier" #:shape (box 0.1 0.1 0.1) #:motion (keyframes frames)))

;; ---- a turning base: r'' = w^2 r ----

(define (slide accuracy)
  (in-world ()
    (scene #:accuracy accuracy #:gravity #(0 0 0))
    (let* ((rate 3.0)
           (disk (carrier (lambda (t) (values #(0.5 -0.2 1) (rotation #(0 0 1) (* rate t))))))
           (bead (add-multibody! #:base disk
                   (link 'bead #:joint (prismatic #:axis #(1 0 0) #:at #(0.1 0 0)) #:mass 1
                         #:inertia #(1e-4 1e-4 1e-4)))))
      (run! #:until 1)
      (- (+ 0.1 (joint-position bead 'bead)) (* 0.1 (cosh rate))))))
(test-approximate "a bead on a turning rod" 0 (slide 1e-6) 2e-6)
(test-approximate "ten thousand times as well" 0 (slide 1e-10) 1e-9)

;; ---- an accelerated base is one in a stronger field ----

(define (swing base-motion gravity accuracy . joint)
  (in-world ()
    (scene #:accuracy accuracy #:gravity (vector 0 0 (- gravity)))
    (let* ((base (if base-motion (carrier base-motion) 'fixed))
           (arm (add-multibody! #:base base (apply bob-link 0.4 joint))))
      (set! (joint-position arm 'bob) 1.1)
      (run! #:until 1.5)
      (cons (joint-position arm 'bob) (joint-velocity arm 'bob)))))
(define (rising t) (values (vector 0 0 (* 0.5 3 t t)) no-turn))
(let ((still (swing #f 12.81 1e-9)) (risen (swing rising 9.81 1e-9)))
  (test-approximate "lifted, angle" (car still) (car risen) 1e-7)
  (test-approximate "and velocity" (cdr still) (cdr risen) 1e-6))
(let ((still (swing #f 12.81 1e-8 #:damping 300 #:stiffness 1e4))
      (risen (swing rising 9.81 1e-8 #:damping 300 #:stiffness 1e4)))
  (test-approximate "with a stiff joint, implicitly" (car still) (car risen) 1e-7))

;; ---- at constant velocity nothing is seen of it ----

(let ((still (swing #f 9.81 1e-9))
      (moved (swing (lambda (t) (values (vector (* 2 t) (* -3 t) t) no-turn)) 9.81 1e-9)))
  (test-approximate "carried along" (car still) (car moved) 1e-7))

;; ---- jumps: no impulse along the joint, so (r^2 + I/m) du = r cos(q) dv ----

(define gain (/ 0.4 (+ 0.16 (/ 1e-3 2))))
(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((base (driven '((0.5 #(0 0 0)) (1 #(0.3 0 0)))))
         (arm (add-multibody! #:base base (bob-link 0.4)))
         (tip (lambda () (vector-ref (velocity (link-body arm 'bob)) 0))))
    (set! (joint-position arm 'bob) 0.7)
    (run! #:until 0.4999)
    (test-approximate "before the jump" 0 (joint-velocity arm 'bob) 1e-12)
    (run! #:until 0.50001)
    (test-approximate "after it" (* gain (cos 0.7) 0.6) (joint-velocity arm 'bob) 1e-4)
    (test-approximate "what is heavy stays behind" (* 0.6 (- 1 (* gain 0.4 (cos 0.7) (cos 0.7))))
      (tip) 1e-4)
    ;; at constant velocity u stays, so that the angle at the second jump is known
    (let* ((u (* gain (cos 0.7) 0.6)) (left (- u (* gain (cos (+ 0.7 (* 0.5 u))) 0.6))))
      (run! #:until 3)
      (test-approximate "and it stops as suddenly" left (joint-velocity arm 'bob) 1e-6)
      (run! #:until 4)
      (test-approximate "then turns by itself" left (joint-velocity arm 'bob) 1e-6))))

;; a base that turns, and stops: what is left about the joint is the momentum about it
(in-world ()
  (scene #:accuracy 1e-9 #:gravity #(0 0 0))
  (let* ((base (driven `((0 #(0 0 0)) (0.5 #(0 0 0) ,(rotation #(0 1 0) 1))
                         (1 #(0 0 0) ,(rotation #(0 1 0) 1)))))
         (arm (add-multibody! #:base base #:position #(0.3 0 0) (bob-link 0.4)))
         (bob (link-body arm 'bob)))
    (run! #:until 0.49999999)
    (let* ((u (joint-velocity arm 'bob)) (pivot (position bob))
           (way (rotate (orientation bob) #(0 0 -0.4)))
           (moment (vector-ref (cross way (cross #(0 2 0) pivot)) 1)))
      (test-assert "it swings on the turning base" (> (abs u) 0.1))
      (run! #:until 0.50000001)
      (test-approximate "and on when that stops" (+ 2 u (/ moment (+ 0.16 (/ 1e-3 2))))
        (joint-velocity arm 'bob) 1e-6))))

;; a kink of a procedure is found
(in-world ()
  (scene #:gravity #(0 0 0) #:accuracy 1e-7)
  (let* ((base (carrier (lambda (t) (values (vector (abs (- t 0.3)) 0 0) no-turn))))
         (arm (add-multibody! #:base base (bob-link 0.4))))
    (run! #:until 0.31)
    (test-approximate "a kink" (* gain 2) (joint-velocity arm 'bob) 1e-5)))

;; ---- it lives with the others ----

(in-world ()
  (ground)
  (let* ((base (driven '((0 #(-1 0 1)) (1 #(1 0 1)) (2 #(1 0 1)))))
         (rope (add-multibody! #:name 'rope #:base base #:position #(0 0 -0.1)
                 (link 'upper #:joint (spherical) #:density 800
                       #:shape (placed (cylinder 0.03 0.36) #:position #(0 0 -0.2))
                   (link 'lower #:joint (spherical #:at #(0 0 -0.4)) #:density 800
                         #:shape (placed (cylinder 0.03 0.36) #:position #(0 0 -0.2))))))
         (target (add-body! #:name "target" #:shape (box 0.1 0.1 0.3) #:position #(0.3 0 0.15))))
    (run! #:until 2.5)
    (test-assert "what it swings strikes" (> (vector-ref (position target) 0) 0.35))
    (test-assert "the rope goes on swinging" (> (norm (velocity (link-body rope 'lower))) 1e-3))
    (test-assert "its joint stays where the base is"
      (close? #(1 0 0.9) (position (link-body rope 'upper)) 1e-12))))

;; ---- kinematics ----

(in-world ()
  (let* ((base (carrier (lambda (t) (values (vector t 0 1) (rotation #(0 0 1) t)))))
         (arm (add-multibody! #:base base #:position #(0.2 0 0)
                (link 'rod #:joint (revolute #:axis #(0 0 1)) #:mass 1 #:inertia #(1 1 1)))))
    (run! #:until 0.5)
    (let-values (((position orientation) (forward-kinematics arm #(0.1) 'rod)))
      (test-assert "where the base is now"
        (close? (vector (+ 0.5 (* 0.2 (cos 0.5))) (* 0.2 (sin 0.5)) 1) position 1e-9))
      (test-assert "as it is turned" (close? (rotation #(0 0 1) 0.6) orientation 1e-9)))))

;; ---- what cannot be ----

(in-world ()
  (let* ((base (driven '((0 #(0 0 0)) (1 #(1 0 0)))))
         (ball (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(0 0 5))))
    (add-multibody! #:name 'arm #:base base (bob-link 0.4))
    (test-message "a base that is free" "the base of the multibody .* is ball; expected a body that is fixed"
      (add-multibody! #:base ball (bob-link 0.4)))
    (test-message "a base that is removed" "carrier cannot be removed; it is the base of arm"
      (remove-body! base))))
(in-world ()
  (let* ((base (carrier (lambda (t) (if (> t 0.4) (error "off the rails" t) (values (vector t 0 1) no-turn)))))
         (arm (add-multibody! #:base base (bob-link 0.4))))
    (test-message "a motion that fails" "off the rails .*in the motion of carrier" (run! #:until 1))))

(test-end "moving-base")
