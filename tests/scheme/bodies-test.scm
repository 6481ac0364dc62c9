;; Bodies: what they are made of, how they are read and changed between runs.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "bodies")

(in-world ()
  (let* ((a (add-body! #:name "a" #:shape (box 1 1 1) #:density 500 #:position '(0 0 5)
                       #:velocity #(1 2 3) #:slots '((hits . 0) (path . #(1 (2 "x"))))))
         (b (add-body! #:shape (sphere 1) #:position #(9 0 50) #:mass 3))
         (g (ground)))
    (test-equal "names are kept" "a" (body-name a))
    (test-equal "a body without a name is body-N" "body-1" (body-name b))
    (test-assert "the body of a name is the same object" (eq? b (find-body "body-1")))
    (test-equal "bodies in order" (list a b g) (world-bodies))
    (test-equal "mass from shape and density" 500.0 (body-mass a))
    (test-equal "mass as given" 3.0 (body-mass b))
    (test-equal "kinds" '(dynamic fixed) (list (body-kind a) (body-kind g)))
    (test-equal "a body is written with its name, its kind and where it is" "#<body a dynamic at #(0 0 5)>"
      (format #f "~s" a))
    (test-equal "state at the start" '(#(0.0 0.0 5.0) #(1.0 0.0 0.0 0.0) #(1.0 2.0 3.0))
                (list (position a) (orientation a) (velocity a)))
    (test-equal "kinetic energy" 3500.0 (kinetic-energy a))
    (test-message "unknown name" "\"nobody\"; expected the name of a body" (find-body "nobody"))
    (test-message "a name used twice" "name a is taken" (add-body! #:name "a" #:shape #f #:mass 1
                                                                  #:inertia #(1 1 1) #:center-of-mass #(0 0 0)))

    ;; slots
    (test-equal "slots" '(0 #(1 (2 "x"))) (list (slot a 'hits) (slot a 'path)))
    (test-equal "slot?" '(#t #f #f) (list (slot? a 'hits) (slot? a 'nix) (slot? b 'hits)))
    (test-message "a slot that is not there" "body a has no slot nix; expected one of: hits, path"
      (slot a 'nix))
    (test-message "a body without slots" "expected slots given by #:slots" (slot b 'hits))
    (let ((value (list 1 (vector 2 3) (string #\x))))
      (set! (slot a 'path) value)
      (vector-set! (cadr value) 0 'changed)
      (string-set! (caddr value) 0 #\y)
      (test-equal "a slot keeps a copy" '(1 #(2 3) "x") (slot a 'path)))

    ;; changes between runs are discontinuities of kind edit at the world's time
    (run! #:until 0.5)
    (test-equal "world-time" 0.5 (world-time))
    (set! (velocity a) #(0 0 0))
    (set! (position a) #(0 0 20))
    (set! (angular-velocity a) #(0 0 1))
    (set! (orientation a) #(0 0 0 2))
    (test-equal "set!" '(#(0.0 0.0 20.0) #(0.0 0.0 0.0 1.0) #(0.0 0.0 0.0) #(0.0 0.0 1.0))
                (list (position a) (orientation a) (velocity a) (angular-velocity a)))
    (run-for! 1)
    (test-assert "the motion goes on from there"
      (close? #(0 0 15.095) (position a) 1e-12))
    (set! (applied-force a) (vector 0 0 (* 500 9.81)))
    (run-for! 1)
    (test-assert "a constant force against gravity keeps the velocity"
      (close? #(0 0 -9.81) (velocity a) 1e-12))
    (set! (applied-torque a) #(0 0 1))
    (test-equal "torque is set" #(0.0 0.0 1.0) (applied-torque a))
    (test-message "torque not finite" "applied-torque" (set! (applied-torque a) #(0 0 +nan.0)))
    (set! (applied-torque a) #(0 0 0))
    (test-message "a fixed body has no velocity to set" "ground" (set! (velocity g) #(1 0 0)))
    (test-message "a velocity that is no vector" "velocity is 5; expected a vector"
      (set! (velocity a) 5))
    (test-assert "the state queue holds the edit" (assq 'edit (map cdr (state-queue a))))
    (let ((kept (checkpoint)) (before (position a)) (now (world-time)))
      (run-for! 1)
      (let ((after (position a)))
        (restore! kept)
        (test-equal "a restored world stands where it stood" (list now before)
                    (list (world-time) (position a)))
        (run-for! 1)
        (test-equal "and goes on to the same bits" after (position a)))
      (let ((later (add-body! #:name "later" #:shape (sphere 0.1) #:position #(0 0 99))))
        (restore! kept)
        (test-equal "a body that came since is gone" #f (memq later (world-bodies)))
        (test-message "and its handle says so" "#<body later.*expected one that is there"
          (position later))))))

(in-world ()
  (let ((free (add-body! #:shape #f #:mass 2 #:inertia #(1 2 3) #:center-of-mass #(0 0 0)
                         #:velocity #(0 0 1))))
    (run! #:until 1)
    (test-assert "a body without a shape flies" (close? #(0 0 -3.905) (position free) 1e-12))
    (test-assert "momentum" (close? #(0 0 -17.62) (total-momentum) 1e-12))))

(in-world ()
  (test-message "no shape" "no #:shape" (add-body! #:mass 1))
  (test-message "#:shape #f needs mass" "mass" (add-body! #:shape #f))
  (test-message "zero mass" "mass of body-0 is 0" (add-body! #:shape (sphere 1) #:mass 0))
  (test-message "negative density" "density of body-0 is -1" (add-body! #:shape (sphere 1) #:density -1))
  (test-message "NaN position" "position is #\\(0 0 \\+nan.0\\)"
    (add-body! #:shape (sphere 1) #:position #(0 0 +nan.0)))
  (test-message "zero quaternion" "orientation is .* not zero"
    (add-body! #:shape (sphere 1) #:orientation #(0 0 0 0)))
  (test-message "unknown keyword" "unknown keyword #:positon; expected one of .*#:position"
    (add-body! #:shape (sphere 1) #:positon #(0 0 0)))
  (test-message "a value where a keyword belongs" "add-body! got 5; expected a keyword"
    (add-body! 5 (sphere 1)))
  (test-message "a shape of the wrong type" "shape is ball; expected a shape" (add-body! #:shape 'ball))
  (test-message "a half-space that moves" "unbounded shape" (add-body! #:shape (half-space #(0 0 1) 0)))
  (test-message "slots that are no alist" "slots is \\(hits\\); expected an association list"
    (add-body! #:shape (sphere 1) #:slots '(hits)))
  (test-message "a slot given twice" "each name once"
    (add-body! #:shape (sphere 1) #:slots '((a . 1) (a . 2))))
  (test-equal "a failed body leaves nothing behind" '() (world-bodies))
  (test-assert "a keyword given #f counts as absent"
    (body? (add-body! #:shape (sphere 1) #:mass #f #:name #f #:velocity #f))))

;; ---- keyframes ----

(in-world ()
  (let ((door (add-body! #:name "door" #:shape (box 1 1 1)
                         #:motion (keyframes '((0 #(0 0 0)) (1 #(0 0 2)) (2 #(0 0 2) #(0 0 0 1))))))
        (lift (add-body! #:name "lift" #:shape (box 1 1 1)
                         #:motion (keyframes '((1 #(5 0 0)) (3 #(5 0 4))) #:smooth? #t))))
    (test-equal "kinematic" 'kinematic (body-kind door))
    (run! #:until 0.5)
    (test-equal "halfway on a line" '(#(0.0 0.0 1.0) #(0.0 0.0 2.0)) (list (position door) (velocity door)))
    (test-equal "at rest before the first keyframe" #(0.0 0.0 0.0) (velocity lift))
    (run! #:until 2)
    (test-assert "smooth motion is halfway at half the time" (close? #(5 0 2) (position lift) 1e-14))
    (run! #:until 4)
    (test-assert "at rest after the last" (close? #(0 0 0 1) (orientation door) 1e-14))
    (test-message "a kinematic body can't be pushed" "kinematic" (set! (velocity door) #(1 0 0))))
  (test-message "times must increase" "expected a time after" (keyframes '((1 #(0 0 0)) (1 #(0 0 1)))))
  (test-message "no keyframes" "keyframes is \\(\\)" (keyframes '()))
  (test-message "a keyframe without a position" "keyframe is \\(1\\)" (keyframes '((1))))
  (test-message "max-speed without a procedure" "max-speed"
    (add-body! #:shape (sphere 1) #:max-speed 1)))

;; ---- motion by a procedure ----

(in-world ()
  (let* ((swing (lambda (time) (values (vector (sin time) 0 0) (rotation #(0 0 1) time))))
         (paddle (add-body! #:shape (box 1 1 1) #:motion swing #:max-speed 1.8)))
    (run! #:until 2)
    (test-assert "it is where the procedure says" (close? (vector (sin 2) 0 0) (position paddle) 1e-15))
    (test-assert "velocities are differences" (close? (vector (cos 2) 0 0) (velocity paddle) 1e-9))
    (test-assert "so are angular velocities" (close? #(0 0 1) (angular-velocity paddle) 1e-9)))
  (test-message "a procedure needs a bound" "max-speed is #f" 
    (add-body! #:shape (sphere 1) #:motion (lambda (time) #f))))

(in-world ()
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(0 0 1)))
        (paddle (add-body! #:name "paddle" #:shape (box 1 1 0.1) #:max-speed 1
                           #:motion (lambda (time) (values (vector (* 3 time) 0 0) #(1 0 0 0))))))
    (test-message "the bound is verified" "paddle is faster than its #:max-speed: it moves a point by [0-9.e-]+ m between 0 s and [0-9.e-]+ s, at [23][0-9.]* m/s; expected at most 1 m/s" (run! #:until 1))
    (test-assert "the world stays usable" (real? (world-time)))))

(in-world ()
  (test-message "one value is not enough" "expected two values"
    (begin
      (add-body! #:shape (sphere 1) #:motion (lambda (time) #(0 0 0)) #:max-speed 1)
      (run! #:until 1))))

;; a tray that sways under balls: what meets it, and how often, asks the procedure no more
(define (calls-of-swaying-tray balls)
  (let ((calls 0) (latest 0))
    (in-world ()
      (add-body! #:name "tray" #:shape (box 3 3 0.1) #:max-speed 2
                 #:motion (lambda (time)
                            (set! calls (1+ calls))
                            (set! latest (max latest time))
                            (values (vector (* 0.1 (sin (* 3 time))) 0 0)
                                    (rotation #(0 1 0) (* 0.1 (sin time))))))
      (for-each (lambda (i)
                  (add-body! #:shape (sphere 0.05)
                             #:position (vector (* 0.2 (- (quotient i 5) 2))
                                                (* 0.2 (- (remainder i 5) 2)) 0.2)))
                (iota balls))
      (run! #:until 1)
      (test-assert "it is asked little beyond the end of the run" (< latest 1.2)))
    calls))

(let ((few (calls-of-swaying-tray 1)) (many (calls-of-swaying-tray 25)))
  (test-assert (format #f "17 calls in a sixteenth of a second: ~a in 1 s" few)
    (< (* 16 17) few (* 19 17)))
  (test-equal "and no more of them for more balls" few many))

(define (run-with-motion motion max-speed until)
  (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(0 0 1))
  (add-body! #:name "plate" #:shape (box 1 1 0.1) #:motion motion #:max-speed max-speed)
  (run! #:until until))

(define (straight x) (values (vector x 0 0) #(1 0 0 0)))

(in-world ()
  (test-message "a jump is told with its time"
    "the motion of plate is faster than its #:max-speed: it moves a point by .* between 0.299999[0-9]* s and 0.3"
    (run-with-motion (lambda (time) (straight (if (< time 0.3) 0 0.01))) 5 1))
  (test-assert "nothing after it is committed" (< (world-time) 0.3)))
(in-world ()
  (test-message "a motion that is not a number" "motion of plate returned a wrong position at 0.3[0-9]* s"
    (run-with-motion (lambda (time) (straight (if (<= time 0.3) time (/ 0. 0.)))) 5 1)))
(in-world ()
  (test-message "an error of the procedure's own" "no row for 0.3[0-9]*\n  in the motion of plate at 0.3[0-9]* s"
    (run-with-motion
     (lambda (time) (if (<= time 0.3) (straight time) (error "no row for" time))) 5 1)))
(in-world ()
  (run-with-motion (lambda (time) (straight (if (< time 0.3) (* 3 time) (- 1.2 time)))) 3 1)
  (test-assert "a kink is no error" (close? #(0.2 0 0) (position (find-body "plate")) 1e-12)))

;; smooth, and too fast from a time on: it is told so, from there on
(for-each
 (lambda (motion fast)
   (in-world ()
     (test-message "a motion that becomes too fast"
       "plate is faster than its #:max-speed: .*, at 2[.]0[0-9]* m/s; expected at most 2 m/s, or a larger"
       (run-with-motion motion 2 9))
     (test-assert "nothing after it is committed" (<= 1 (world-time) (+ fast 0.001)))))
 (list (lambda (time) (straight (* 0.25 time time)))
       (lambda (time) (values #(0 0 0) (rotation #(0 0 1) (* 0.5 time time))))
       (lambda (time) (straight (* 0.01 (exp time)))))
 (list 4 (/ 2 (sqrt 0.5)) (log 200)))
(in-world ()
  (run-with-motion (lambda (time) (straight (* 2 time))) 2 3)
  (test-assert "as fast as it may be" (close? #(6 0 0) (position (find-body "plate")) 1e-9)))

;; ---- what cannot be moved ----

(in-world ()
  (let ((plate (add-body! #:name "plate" #:shape (box 1 1 0.1)
                          #:motion (keyframes '((0 #(0 0 0)) (1 #(1 0 0))))))
        (floor (add-body! #:name "floor" #:shape (box 9 9 1) #:position #(0 0 -5) #:fixed? #t)))
    (define given "of plate cannot be changed, which is kinematic: its #:motion says where .*; expected .*#:motion .*add-body! after remove-body!")
    (test-message "where a motion says where it is" (string-append "position or orientation " given)
      (set! (position plate) #(0 0 1)))
    (test-message "and how it is turned" (string-append "position or orientation " given)
      (set! (orientation plate) #(0 1 0 0)))
    (test-message "nor how fast" (string-append "velocity " given) (set! (velocity plate) #(0 0 1)))
    (test-message "what is fixed" "of floor cannot be changed, which is fixed; expected .*remove-body!, and add-body!"
      (set! (position floor) #(0 0 1)))
    (run! #:until 0.5)
    (test-assert "the motion goes on" (close? #(0.5 0 0) (position plate) 1e-12))))

;; ---- removing ----

;; what its springs held from the start counts for nothing, and goes with them
(in-world ()
  (let* ((floor (add-body! #:shape (box 4 4 1) #:position #(0 0 -0.5) #:fixed? #t))
         (crate (add-body! #:shape (box 1 1 1) #:position #(0 0 0.5)))
         (start (total-energy)))
    (run! #:until 1)
    (test-assert "at rest it stays" (close? start (total-energy) 1e-9))
    (remove-body! floor)
    (test-assert "without the floor there is no spring" (close? start (total-energy) 1e-9))
    (run! #:until 1.5)
    (test-assert "it falls" (close? start (total-energy) 1e-8))
    (remove-body! crate)
    (test-equal "an emptied world has no energy" 0.0 (total-energy))
    (run! #:until 2)
    (add-body! #:shape (sphere 1) #:density 1 #:position #(0 0 -2))
    (test-assert "nor does it remember any"
      (close? (* -9.81 2 4/3 3.141592653589793) (total-energy) 1e-9))))
(in-world ()
  (ground)
  (let ((crate (add-body! #:shape (box 1 1 1) #:position #(0 0 0.5))))
    (run! #:until 1)
    (set! (velocity crate) #(0 0 1))
    (run! #:until 1.1)
    (remove-body! crate)
    (test-equal "whose springs have let go since" 0.0 (total-energy))))

;; What was attached just before leaves a state behind whose group it was in.
(for-each
 (lambda (until)
   (in-world ('(check . #t))
     (let ((a (add-body! #:shape (sphere 0.2) #:position #(0 0 1)))
           (b (add-body! #:shape (sphere 0.2) #:position #(4 0 1))))
       (run! #:until until)
       (attach! a b)
       (remove-body! a)
       (run-for! 0.1)
       (test-assert (format #f "what is held may be removed at ~a s" until)
         (close? (+ 1 (* -1/2 9.81 (+ until 0.1) (+ until 0.1))) (vector-ref (position b) 2) 1e-9)))))
 '(0 0.1))

(in-world ()
  (ground)
  (let ((low (add-body! #:name "low" #:shape (box 1 1 1) #:position #(0 0 0.5)))
        (high (add-body! #:name "high" #:shape (box 1 1 1) #:position #(0 0 1.5))))
    (run! #:until 0.5)
    (remove-body! low)
    (test-equal "a removed body is listed no more" '("ground" "high") (map body-name (world-bodies)))
    (test-equal "and says so" "#<body low (removed)>" (format #f "~s" low))
    (for-each (lambda (use)
                (test-message "what uses it is refused" "low \\(removed\\)>; expected a body that was not removed"
                  (use low)))
              (list position velocity state-queue remove-body! kinetic-energy
                    (lambda (b) (set! (velocity b) #(1 0 0)))
                    (lambda (b) (add-callback! b (const #f)))
                    (lambda (b) (set-contact-parameters! b #t #:friction 0))
                    (lambda (b) (contact-parameters high b))
                    (lambda (b) (camera #:follow b))))
    (test-assert "its name may be given again"
      (body? (add-body! #:name "low" #:shape (sphere 0.1) #:position #(5 0 1))))
    (run! #:until 3)
    (test-assert "what lay on it falls" (close? (vector-ref (position high) 2) 0.5 1e-3))
    (add-callback! high (lambda (time view) (remove-body! high) #f) #:start 3.5)
    (test-message "not in callbacks" "remove-body! was used inside a callback" (run! #:until 4))))
;; What is placed elsewhere must not overlap anything; what stays where it is may be pressed in.
(in-world ()
  (let* ((floor (ground))
         (soft (add-body! #:name "soft" #:shape (box 1 1 1) #:density 1000 #:position #(0 0 0.6))))
    (set-contact-parameters! soft #t #:stiffness 2e4)
    (run! #:until 3)
    (test-assert "it is pressed in" (< (vector-ref (position soft) 2) 0.4))
    (test-message "an overlap elsewhere is an error" "ground and soft overlap"
      (set! (position soft) (vector 0.1 0 (vector-ref (position soft) 2))))))
(in-world ()
  (let* ((floor (ground))
         (soft (add-body! #:name "soft" #:shape (box 1 1 1) #:density 1000 #:position #(0 0 0.6))))
    (set-contact-parameters! soft #t #:stiffness 2e4)
    (run! #:until 3)
    (let ((before (position soft)))
      (set! (position soft) before)
      (run-for! 0.1)
      (test-assert "a position that is set to what it is" (close? before (position soft) 1e-3)))))
;; A cushion stops what a hard contact would stop by impulses: it comes straight down and settles
;; where k d (1 + (d/2d0)^2) = m g, d0 = m g/k.
(in-world ()
  (ground)
  (let* ((soft (add-body! #:name "soft" #:shape (box 1 1 1) #:density 1000 #:position #(0 0 0.6)))
         (depth (lambda () (- 0.5 (vector-ref (position soft) 2))))
         (stiffness 3e4) (weight 9810))
    (set-contact-parameters! soft #t #:stiffness stiffness)
    (run! #:until 0.5)
    (test-assert "straight" (close? #(0 0 0) (angular-velocity soft) 1e-12))
    (run! #:until 6)
    (let ((d (depth)))
      (test-assert "its load"
        (close? weight (* stiffness d (+ 1 (expt (/ (* d stiffness) (* 2 weight)) 2))) 20)))))

(test-end "bodies")
