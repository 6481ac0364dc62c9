;; Multibodies from Scheme: links and joints, how they stand, what drives them, kinematics.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp vectors))
(load "helpers.scm")

(test-begin "multibodies")

(define pi 3.141592653589793)

(define (rod-shape length)
  (placed (box length 0.02 0.02) #:position (vector (/ length 2) 0 0)))

;; An arm that swings up and down about y: at 0 level along x, at pi/2 hanging.
(define* (add-arm! #:key (base 'fixed) (lower-limits '(-2 2.5)))
  (add-multibody! #:name 'arm #:base base #:position #(0 0 2)
    (link 'upper #:joint (revolute #:axis #(0 1 0) #:damping 0.1 #:stiffness 2 #:rest 0.3)
          #:shape (rod-shape 0.5)
      (link 'lower #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0) #:limits lower-limits)
            #:shape (rod-shape 0.4)
        (link 'hand #:joint (weld #:at #(0.4 0 0)) #:shape (box 0.1 0.1 0.1))))))

;; ---- making them ----

(in-world ()
  (let* ((arm (add-arm!)) (hand (link-body arm 'hand)))
    (test-assert "a multibody" (multibody? arm))
    (test-assert "and no body" (not (body? arm)))
    (test-equal "its name" "arm" (multibody-name arm))
    (test-equal "links are bodies" '("arm/upper" "arm/lower" "arm/hand")
      (map body-name (multibody-links arm)))
    (test-eq "found by the body's name" hand (find-body "arm/hand"))
    (test-eq "found by its own" arm (find-multibody "arm"))
    (test-equal "all of them" (list arm) (world-multibodies))
    (test-eq "of a link" arm (body-multibody hand))
    (test-equal "joints that move, as they were named" '(upper lower) (joint-names arm))
    (test-equal "limits" '(-2.0 2.5) (joint-limits arm 'lower))
    (test-equal "no limits" '(-inf.0 +inf.0) (joint-limits arm "upper"))
    (test-equal "a weld has none" #f (joint-limits arm 'hand))
    (test-assert "links are where their joints put them" (close? #(0.9 0 2) (position hand) 1e-12))
    (test-equal "it stands for its first link" (position (link-body arm 'upper)) (position arm))
    (test-assert "and weighs what all weigh"
      (< (abs (- (body-mass arm) (apply + (map body-mass (multibody-links arm))))) 1e-12))
    (test-assert "a queue of states" (pair? (state-queue arm)))
    (test-equal "as it is written" "#<multibody arm: upper 0, lower 0 (-2.0000 to 2.5000)>"
      (object->string arm))
    (test-equal "a link as it is written" "#<link a revolute, 1 on it>"
      (object->string (link 'a #:joint (revolute) (link 'b #:joint (weld)))))
    (test-eq "no multibody" #f (body-multibody (add-body! #:shape (sphere 0.1) #:position #(9 9 9))))))

;; links may come in lists; names may be strings
(in-world ()
  (let ((tree (add-multibody! #:name "tree"
                (map (lambda (i)
                       (link (format #f "leaf-~a" i)
                             #:joint (spherical #:at (vector i 0 0)) #:shape (rod-shape 0.3)))
                     (iota 3)))))
    (test-equal "names that are strings" '("leaf-0" "leaf-1" "leaf-2") (joint-names tree))))

;; a base that is a body: its frame counts, and the first link may overlap it
(in-world ()
  (let* ((table (add-body! #:name "table" #:shape (box 1 1 0.2) #:fixed? #t #:position #(1 2 3)))
         (arm (add-multibody! #:base table #:position #(0 0 0.1)
                (link 'a #:joint (revolute) #:shape (box 0.3 0.3 0.3)))))
    (test-assert "stands on it" (close? #(1 2 3.1) (position arm) 1e-12))
    (run! #:until 0.1)
    (test-assert "goes through it" (close? #(1 2 3.1) (position arm) 1e-12))))

;; ---- every kind of joint ----

(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((shape (placed (sphere 0.1) #:position #(0.3 0 0)))
         (kinds (add-multibody! #:name 'kinds
                  (link 'r #:joint (revolute #:axis #(0 0 2)) #:shape shape)
                  (link 'p #:joint (prismatic #:at #(0 5 0)) #:shape shape)
                  (link 'u #:joint (universal #:at #(0 10 0) #:limits '((-1 1) (-2 2)))
                        #:shape shape)
                  (link 's #:joint (spherical #:at #(0 15 0)) #:shape shape)
                  (link 'c #:joint (spherical #:at #(0 20 0) #:limits 0.7 #:axis #(0 0 1))
                        #:shape shape)))
         (free (add-multibody! #:name 'free #:base 'free #:position #(0 0 5)
                               #:orientation #(0 1 0 0)
                 (link 'f #:shape (sphere 0.1)
                   (link 'w #:joint (weld #:at #(0 0 1)) #:shape (sphere 0.1))))))
    (test-equal "limits of both axes" '((-1.0 1.0) (-2.0 2.0)) (joint-limits kinds 'u))
    (test-equal "the limit of a spherical one" 0.7 (joint-limits kinds 'c))
    (test-equal "none" +inf.0 (joint-limits kinds 's))
    (test-message "beyond the limit"
        "the angle of joint c of kinds is 1.2.*; expected one within its limits, 0 to 0.7"
      (set! (joint-position kinds 'c) (vector (cos 0.6) (sin 0.6) 0 0)))
    (set! (joint-position kinds 'c) (vector (cos 0.6) 0 0 (sin 0.6)))
    (test-assert "turned about its axis it is not beyond"
      (close? (sin 0.6) (vector-ref (joint-position kinds 'c) 3) 1e-15))
    (set! (joint-position kinds 'c) #(1 0 0 0))
    (test-message "limits of a spherical joint are one angle"
        "limits of the link s.*expected an angle, rad, as the joint is spherical"
      (add-multibody! #:name 'wrong
        (link 's #:joint (spherical #:limits '(-1 1)) #:shape shape)))
    (test-equal "positions at first" '(0.0 0.0 #(0.0 0.0) #(1.0 0.0 0.0 0.0))
      (map (lambda (name) (joint-position kinds name)) '(r p u s)))
    (test-equal "of a free link" #(0.0 0.0 5.0 0.0 1.0 0.0 0.0) (joint-position free 'f))
    (test-equal "its joint" '(f) (joint-names free))
    (set! (joint-position kinds 'r) 0.5)
    (set! (joint-position kinds 'p) -0.25)
    (set! (joint-position kinds 'u) '(0.5 -0.5))
    (set! (joint-position kinds 's) #(0 0 0 2))
    (set! (joint-position free 'f) #(1 2 3 1 0 0 0))
    (test-equal "positions that were set" '(0.5 -0.25 #(0.5 -0.5) #(0.0 0.0 0.0 1.0))
      (map (lambda (name) (joint-position kinds name)) '(r p u s)))
    (test-assert "move the links" (close? #(0 5 -0.25) (position (link-body kinds 'p)) 1e-12))
    (test-assert "all of them" (close? #(1 2 4) (position (link-body free 'w)) 1e-12))
    (set! (joint-velocity kinds 'r) 1)
    (set! (joint-velocity kinds 'p) 2)
    (set! (joint-velocity kinds 'u) #(0.1 0.2))
    (set! (joint-velocity kinds 's) #(0 0 3))
    (set! (joint-velocity free 'f) #(1 0 0 0 0 0))
    (test-equal "velocities that were set" '(1.0 2.0 #(0.1 0.2) #(0.0 0.0 3.0))
      (map (lambda (name) (joint-velocity kinds name)) '(r p u s)))
    (test-equal "in one vector" #(1.0 2.0 0.1 0.2 0.0 0.0 3.0 0.0 0.0 0.0) (joint-velocities kinds))
    (test-assert "links have them" (close? #(0 0 2) (velocity (link-body kinds 'p)) 1e-12))
    (set! (joint-torque kinds 's) #(0 0 1))
    (test-equal "torques" '(0.0 #(0.0 0.0 1.0))
      (map (lambda (name) (joint-torque kinds name)) '(r s)))
    (set! (joint-torque kinds 's) #(0 0 0))
    (run! #:until 0.5)
    (test-assert "turns evenly" (close? 1.0 (joint-position kinds 'r) 1e-6))
    (test-assert "slides evenly" (close? 0.75 (joint-position kinds 'p) 1e-6))
    (test-assert "flies evenly" (close? #(1.5 2 3) (position free) 1e-6))
    (set! (joint-servo kinds 's) (servo #:target #(2 0 0 0) #:stiffness 5 #:damping 1))
    (test-equal "a servo's target" #(1.0 0.0 0.0 0.0) (servo-target (joint-servo kinds 's)))
    (set! (joint-servo kinds 'u) (servo #:target #(0.2 0.1) #:stiffness 50 #:damping 5))
    (set! (joint-servo kinds 'r) (servo #:target-velocity 2 #:damping 100 #:max-torque 1))
    (test-equal "a servo's bound" 1.0 (servo-max-torque (joint-servo kinds 'r)))
    (test-equal "none" #f (joint-servo kinds 'p))
    (run! #:until 20)
    (test-assert "a servo holds a universal joint" (close? #(0.2 0.1) (joint-position kinds 'u) 1e-4))
    (test-assert "and a spherical one"
      (< (abs (- 1 (abs (vector-ref (joint-position kinds 's) 0)))) 1e-4))
    (test-assert "and a velocity" (close? 2.0 (joint-velocity kinds 'r) 1e-4))
    (set! (joint-servo kinds 'r) #f)
    (test-equal "taken away" #f (joint-servo kinds 'r))))

;; ---- closed forms ----

;; period of a rod: 4 K(sin(a/2)) sqrt(I / (m g d)), K by the arithmetic-geometric mean
(in-world ()
  (let* ((rod (add-multibody! #:position #(0 0 2)
                (link 'rod #:joint (revolute #:axis #(0 1 0)) #:shape (rod-shape 1))))
         (amplitude 1.2)
         (mean (let loop ((a 1.0) (b (cos (/ amplitude 2))))
                 (if (< (- a b) 1e-15) a (loop (/ (+ a b) 2) (sqrt (* a b))))))
         ;; about the hinge, by the mass
         (inertia (+ 0.25 (/ (+ 1 0.0004) 12)))
         (period (/ (* 2 pi (sqrt (/ inertia (* 9.81 0.5)))) mean)))
    (set! (joint-position rod 'rod) (- (/ pi 2) amplitude))
    (let ((energy (total-energy)))
      (run! #:until period)
      (test-assert "a pendulum comes back" (close? (- (/ pi 2) amplitude) (joint-position rod 'rod) 1e-5))
      (test-assert "at rest" (close? 0.0 (joint-velocity rod 'rod) 1e-4))
      (test-assert "with its energy" (close? energy (total-energy) 1e-5)))))

;; a torque at a joint: angle = torque / inertia t^2 / 2; what was set is read again
(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((rod (add-multibody! (link 'rod #:joint (revolute) #:mass 2 #:inertia #(1 1 0.5)
                                   #:center-of-mass #(0 0 0)))))
    (set! (joint-torque rod 'rod) 0.5)
    (test-equal "a torque" 0.5 (joint-torque rod 'rod))
    (run! #:until 2)
    (test-assert "turns it" (close? 2.0 (joint-position rod 'rod) 1e-6))
    ;; to be stopped within a second, by a callback
    (add-callback! rod
                   (lambda (time view)
                     (test-equal "the view knows its multibody" rod (body-multibody view))
                     (set! (joint-torque view 'rod) (- (* 0.5 (joint-velocity view 'rod))))
                     #f)
                   #:start 3 #:period #f)
    (run! #:until 4)
    (test-assert "a callback stops it" (close? 0.0 (joint-velocity rod 'rod) 1e-6))
    (test-assert "where it should" (close? 6.0 (joint-position rod 'rod) 1e-5))))

;; ---- kinematics and dynamics ----

(define (array-row array row)
  (map (lambda (column) (array-ref array row column)) (iota (cadr (array-dimensions array)))))

(define (dot* row vector) (apply + (map * row (vector->list vector))))

(in-world ()
  (let ((arm (add-arm!)) (q #(0.3 0.9)) (u #(0.5 -0.7)))
    (set! (joint-positions arm) q)
    (set! (joint-velocities arm) u)
    (test-equal "all positions" #(0.3 0.9) (joint-positions arm))
    (call-with-values (lambda () (forward-kinematics arm q 'hand))
      (lambda (p o)
        (test-assert "forward kinematics" (close? p (position (link-body arm 'hand)) 1e-12))
        (test-assert "and orientation" (close? o (orientation (link-body arm 'hand)) 1e-12))
        (test-assert "as by hand"
          (close? (vector (+ (* 0.5 (cos 0.3)) (* 0.4 (cos 1.2))) 0
                          (- 2 (* 0.5 (sin 0.3)) (* 0.4 (sin 1.2))))
                  p 1e-12))
        (call-with-values (lambda () (inverse-kinematics arm 'hand #:position p #:start #(0 1)))
          (lambda (found residual)
            (test-assert "inverse kinematics" (close? q found 1e-6))
            (test-assert "nothing is missing" (< residual 1e-8))))))
    (call-with-values (lambda () (inverse-kinematics arm 'hand #:position #(2 0 2)))
      (lambda (found residual)
        (test-equal "out of reach" #f found)
        (test-assert "by so much" (close? 1.1 residual 1e-3))))
    (let ((j (jacobian arm 'hand)) (v (velocity (link-body arm 'hand))))
      (test-equal "the Jacobian's size" '(6 2) (array-dimensions j))
      (test-assert "the Jacobian times velocities"
        (close? v (list->vector (map (lambda (row) (dot* (array-row j row) u)) '(0 1 2))) 1e-12))
      (test-assert "of angles"
        (close? -0.2 (dot* (array-row j 4) u) 1e-12))
      (test-equal "at given positions" j (jacobian arm 'hand #(0.3 0.9))))
    ;; the torques that keep it where it is
    (set! (joint-velocities arm) #(0 0))
    (set! (joint-torques arm) (inverse-dynamics arm q #(0 0) #(0 0)))
    (run! #:until 1)
    (test-assert "inverse dynamics holds it" (close? q (joint-positions arm) 1e-6))
    ;; and those that move it
    (set! (joint-torques arm) (inverse-dynamics arm q #(0 0) #(3 -4)))
    (run! #:until 1.001)
    (test-assert "and moves it" (close? #(0.003 -0.004) (joint-velocities arm) 1e-5))))

;; ---- a controller in a callback: any schedule gives the same ----

(write-file "controlled.scm"
  "(use-modules (timewarp))"
  "(scene #:duration 2)"
  "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
  "(define (rod length) (placed (box length 0.05 0.05) #:position (vector (/ length 2) 0 0)))"
  "(define arm (add-multibody! #:name 'arm #:position #(0 0 1)"
  "  (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape (rod 0.5) #:slots '((sum . 0))"
  "    (link 'lower #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0)) #:shape (rod 0.5)))))"
  "(do ((i 0 (1+ i))) ((= i 6))"
  "  (add-body! #:shape (sphere 0.06) #:position (vector (+ 0.4 (* 0.15 i)) 0 (+ 1.2 (* 0.3 i)))))"
  "(add-callback! arm"
  "  (lambda (time view)"
  "    (let ((error (- (sin (* 3 time)) (joint-position view 'upper))))"
  "      (set! (slot view 'sum) (+ (slot view 'sum) (* 0.01 error)))"
  "      (set! (joint-torque view 'upper)"
  "            (+ (* 30 error) (* 20 (slot view 'sum)) (* -3 (joint-velocity view 'upper))))"
  "      (set! (joint-torque view 'lower) (* -1 (joint-velocity view 'lower)))))"
  "  #:period 0.01)")

(define (hash-with . options)
  (let ((result (apply run "controlled.scm" "--quiet" "--hash" options)))
    (unless (zero? (run-status result)) (display (run-errors result)))
    (string-trim-right (run-output result))))

(let ((plain (hash-with)))
  (test-assert "a hash" (> (string-length plain) 60))
  (test-equal "in pieces" plain (hash-with "--pieces=40"))
  (for-each (lambda (adversary)
              (test-equal (string-append "adversary " adversary) plain
                (hash-with (string-append "--adversary=" adversary))))
            '("1,0.1,every" "2,0.5,every" "3,0.02")))

;; ---- mistakes ----

(in-world ()
  (let* ((arm (add-arm!))
         (ball (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(9 9 9)))
         (spherical-one (add-multibody! #:name 'ball-joint #:position #(20 0 0)
                          (link 's #:joint (spherical) #:shape (rod-shape 1)))))
    (test-message "an unknown joint" "arm has no link or joint wrist; expected one of upper, lower, hand"
      (joint-position arm 'wrist))
    (test-message "a weld has no position" "link hand of arm is welded" (joint-position arm 'hand))
    (test-message "a body that is no link" "joint-position is #<body ball>; expected a multibody"
      (joint-position ball 'upper))
    (test-message "a torque that is no number" "joint-torque is x; expected a number"
      (set! (joint-torque arm 'upper) 'x))
    (test-message "NaN" "torque of the joint of upper is NaN" (set! (joint-torque arm 'upper) +nan.0))
    (test-message "a torque without measure" "accelerate joint upper"
      (set! (joint-torque arm 'upper) 1e300))
    (test-message "too many numbers" "joint-torques is #.*; expected a vector with the numbers"
      (set! (joint-torques arm) #(1 2 3)))
    (test-message "negative gains" "stiffness of the servo of upper is -1"
      (set! (joint-servo arm 'upper) (servo #:stiffness -1)))
    (test-message "no servo" "joint-servo is 3; expected a servo" (set! (joint-servo arm 'upper) 3))
    (test-message "a target that is no quaternion" "target of a servo is 1; expected a quaternion"
      (set! (joint-servo spherical-one 's) (servo #:target 1)))
    (test-message "a quaternion that is zero" "quaternion that is zero"
      (set! (joint-position spherical-one 's) #(0 0 0 0)))
    (test-message "beyond a limit"
        "the position of joint lower of arm is 3; expected one within its limits, -2 to 2.5"
      (set! (joint-position arm 'lower) 3))
    (test-message "the velocity of a link" "velocity of arm/upper cannot be set; it is a link of arm"
      (set! (velocity arm) #(1 0 0)))
    (test-message "a link taken away" "cannot be removed; it is a link of arm"
      (remove-body! (link-body arm 'upper)))
    (test-message "no position to reach" "got no #:position" (inverse-kinematics arm 'hand))
    (test-message "a name that is taken" "name arm is taken" (add-arm!))
    (test-message "twice the same link" "twin"
      (let ((twin (link 'twin #:joint (revolute) #:shape (rod-shape 1))))
        (add-multibody! twin twin)))
    (test-message "no joint" "the link a has no #:joint; expected"
      (add-multibody! (link 'a #:shape (rod-shape 1))))
    (test-message "a joint of what is free" "first link a of a free multibody has a joint, revolute"
      (add-multibody! #:base 'free (link 'a #:joint (revolute) #:shape (rod-shape 1))))
    (test-message "no links" "has no links" (add-multibody!))
    (test-message "welds alone" "cannot move: all of its links are welded"
                  (add-multibody! (link "w" #:joint (weld) #:shape (box 1 1 1))))
    (test-message "a base that moves freely" "the base of the multibody .* is ball; expected a body that is fixed"
      (add-multibody! #:base ball (link 'a #:joint (revolute) #:shape (rod-shape 1))))
    (test-message "an unknown base" "base is floating; expected 'fixed, 'free"
      (add-multibody! #:base 'floating (link 'a #:joint (revolute) #:shape (rod-shape 1))))
    (test-message "what is no link" "a part of add-multibody! is 3; expected a link"
      (add-multibody! 3))
    (test-message "an unknown keyword" "link got the unknown keyword #:size" (link 'a #:size 3))
    (test-message "a joint's unknown keyword" "weld got the unknown keyword #:axis"
      (weld #:axis #(0 0 1)))
    (test-message "a negative damping" "damping"
      (add-multibody! (link 'a #:joint (revolute #:damping -1) #:shape (rod-shape 1))))
    (test-message "where a value is wrong" "axis of the link a is 3; expected a vector"
      (add-multibody! (link 'a #:joint (revolute #:axis 3) #:shape (rod-shape 1))))
    (test-message "a density" "density of the link a is x"
      (add-multibody! (link 'a #:joint (revolute) #:shape (rod-shape 1) #:density 'x)))
    (test-equal "nothing is left of what failed" 5 (length (world-bodies)))
    ;; through a view
    (let ((message #f))
      (add-callback! arm (lambda (time view)
                           (set! message (error-of (set! (joint-position view 'upper) 1)))
                           #f))
      (run! #:until 0.01)
      (test-assert "positions stay in callbacks"
        (string-match "position of joint upper of arm was set inside a callback" message)))))

(clean-up)
;; more links than freedoms: what is welded together swings as one
(in-world ()
  (scene #:accuracy 1e-9)
  (let* ((count 40)
         (rod (lambda (length) (placed (box length 0.05 0.05)
                                       #:position (vector (/ length 2) 0 0))))
         (pendulum
          (lambda (name y links)
            (let ((length (/ 2.0 links)))
              (add-multibody! #:name name #:position (vector 0 y 0)
                (let weld-on ((i 1))
                  (apply link (format #f "~a" i) #:shape (rod length) #:density 100
                         #:joint (if (= i 1)
                                     (revolute #:axis #(0 1 0) #:stiffness 1e4)
                                     (weld #:at (vector length 0 0)))
                         (if (< i links) (list (weld-on (1+ i))) '())))))))
         (pieces (pendulum 'pieces 0 count)) (one (pendulum 'one 1 1)))
    (run! #:until 0.5)
    (test-approximate "one as forty" (joint-position one "1") (joint-position pieces "1") 1e-7)))

;; ---- rest ----

(define (count-of what) (assq-ref (statistics) what))

;; what has stopped costs nothing, and goes on where a servo is set or a ball strikes
(in-world ()
  (let* ((rod (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0)))
         (arm (add-multibody! #:name 'arm
                (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape rod #:density 500
                  (link 'fore #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0)) #:shape rod
                        #:density 500))))
         (fore (link-body arm 'fore))
         (hold! (lambda (target)
                  (for-each (lambda (joint)
                              (set! (joint-servo arm joint)
                                    (servo #:target target #:stiffness 2000 #:damping 100)))
                            '(upper fore)))))
    (hold! -0.3)
    (run! #:until 8)
    (let ((checks (count-of 'group_checks)) (before (joint-positions arm)))
      (run! #:until 100)
      (test-equal "an arm that stands still is not checked" checks (count-of 'group_checks))
      (test-equal "and stays" before (joint-positions arm))
      (test-equal "at rest" #(0.0 0.0) (joint-velocities arm)))
    (hold! -0.5)
    (run-for! 8)
    (test-approximate "a servo that is set wakes it" -0.5 (joint-position arm 'fore) 0.01)
    (add-body! #:name "ball" #:shape (sphere 0.05) #:density 2000
               #:position (v+ (position fore) (v+ (rotate (orientation fore) #(0.25 0 0)) #(0 0 1)))
               #:velocity #(0 0 -3))
    ;; it gets there after 0.27 s
    (let ((before (joint-position arm 'fore)))
      (run-for! 0.28)
      (test-assert "and what strikes it" (> (abs (- (joint-position arm 'fore) before)) 1e-4)))))

;; what swings a little swings on: a pendulum without damping
(in-world ()
  (let* ((pendulum (add-multibody! (link 'bob #:joint (revolute #:axis #(0 1 0))
                                         #:shape (placed (sphere 0.1) #:position #(0 0 -1)))))
         (I (+ (* 2/5 0.01) 1)) (w (sqrt (/ 9.81 I))))
    (set! (joint-position pendulum 'bob) 1e-4)
    (run! #:until 60)
    (test-approximate "the small swing of a pendulum" (* 1e-4 (cos (* 60 w)))
                      (joint-position pendulum 'bob) 1e-6)))

(test-end "multibodies")
