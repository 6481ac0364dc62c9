;; Edits: what is refused, or changes nothing, leaves no trace; restore! undoes what was added and
;; removed; what was added can be taken away.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors) (srfi srfi-4))

(test-begin "edits")

(define (hash) (%history-hash (current-world)))

;; Boxes that tumble onto each other, one that is held, a swinging arm, a ball on a spring, a callback
;; that draws random numbers, and a kinematic table.
(define (playground!)
  (ground)
  (for-each (lambda (k)
              (add-body! #:name (format #f "b~a" k) #:shape (box 0.3 0.3 0.3) #:material 'wood
                         #:slots '((n . 0))
                         #:position (vector (* 0.05 (modulo k 3)) (* 0.07 (modulo k 2))
                                            (+ 0.5 (* 0.55 k)))))
            (iota 5))
  (add-body! #:name "post" #:shape (box 0.2 0.2 2) #:position #(2 0 1) #:fixed? #t)
  (add-body! #:name "held" #:shape (box 0.2 0.2 0.2) #:position #(2.2 0 1.5))
  (attach! (find-body "post") (find-body "held"))
  (add-body! #:name "bob" #:shape (sphere 0.1) #:position #(2 1 1))
  (add-spring! (find-body "post") (find-body "bob") #:stiffness 200 #:rest 0.5)
  (add-body! #:name "table" #:shape (box 0.4 0.4 0.1)
             #:motion (keyframes '((0 #(4 0 0.5)) (3 #(4 0.5 0.5)))))
  (add-multibody! #:name 'arm #:position #(-3 0 1.5)
    (link 'upper #:joint (revolute #:axis #(0 1 0) #:limits '(-2 2))
          #:shape (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0))
      (link 'fore #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0))
            #:shape (placed (box 0.4 0.06 0.06) #:position #(0.25 0 0)))))
  (add-body! #:name "shelf" #:shape (box 0.3 0.3 0.3) #:position #(-3 0 2.3) #:fixed? #t)
  (add-callback! (find-body "b4")
                 (lambda (time view)
                   (set! (slot view 'n) (random-real! view))
                   (set! (applied-force view) (vector (slot view 'n) 0 0)))
                 #:period 0.11))
(define b find-body)
(define (arm) (find-multibody 'arm))

;; What comes of the playground when CHANGE is called at 0.7 s: hash and poses at 1.6 s.
(define (continued change)
  (in-world ('(hash . #t))
    (playground!)
    (run! #:until 0.7)
    (change)
    (run! #:until 1.6)
    (list (hash) (all-poses))))
(define undisturbed (continued (const #t)))

;; EXPRESSION is an error, and all goes on as EXPECTED, as if it had not been tried after BEFORE.
(define-syntax-rule (test-refused-after before expected name pattern expression)
  (let ((same? #f) (message #f))
    (let ((after (continued (lambda ()
                              before
                              (let ((poses (all-poses)))
                                (set! message (error-of expression))
                                (set! same? (equal? poses (all-poses))))))))
      (test-assert (format #f "~a is refused: ~s" name message)
        (and (string? message) (string-match pattern message) #t))
      (test-assert (string-append name " leaves all where it was") same?)
      (test-equal (string-append name " leaves no trace") expected after))))
(define-syntax-rule (test-refused name pattern expression)
  (test-refused-after #t undisturbed name pattern expression))

(define-syntax-rule (test-nothing name expression)
  (test-equal (string-append name " changes nothing") undisturbed
    (continued (lambda () expression))))

;; ---- refused ----

(test-refused "a position in another" "b0 and b1 overlap|b1 and b0 overlap"
  (set! (position (b "b0")) (v+ (position (b "b1")) #(0.05 0 0))))
(test-refused "a position in the ground" "overlap" (set! (position (b "b4")) #(6 0 -0.05)))
(test-refused "a position too far away" "expected at most" (set! (position (b "b4")) #(1e30 0 0)))
(test-refused "the position of a link" "link of arm"
  (set! (position (link-body (arm) 'fore)) #(0 0 3)))
(test-refused "the position of what is fixed" "fixed" (set! (position (b "post")) #(0 0 3)))
(test-refused "an orientation that turns it into another" "overlap"
  (set! (orientation (b "held")) (rotation #(0 0 1) 0.785)))
(test-refused "an orientation of zero" "quaternion" (set! (orientation (b "b4")) #(0 0 0 0)))
(test-refused "a joint beyond its limits" "within its limits"
  (set! (joint-position (arm) 'upper) 2.5))
(test-refused "joints that put a link into another body" "overlap"
  (set! (joint-positions (arm)) #(-1.57 0)))
(test-refused "joint positions that are too few" "joint-positions" (set! (joint-positions (arm)) #(0)))
(test-refused "a joint velocity that is not finite" "finite"
  (set! (joint-velocity (arm) 'fore) +inf.0))
(test-refused "a torque beyond all" "accelerate" (set! (joint-torque (arm) 'fore) 1e300))
(test-refused "a velocity of what is fixed" "fixed" (set! (velocity (b "post")) #(1 0 0)))
(test-refused "a velocity beyond all" "expected at most" (set! (velocity (b "b4")) #(1e30 0 0)))
(test-refused "a force that is not finite" "finite" (set! (applied-force (b "b4")) #(0 0 +nan.0)))
(test-refused "a slot that is not there" "no slot" (set! (slot (b "b4") 'm) 1))
(test-refused "attach! to itself" "both ends" (attach! (b "b0") (b "b0")))
(test-refused "attach! twice" "held together already" (attach! (b "post") (b "held")))
(test-refused "attach! with a stiffness below 0" "stiffness"
  (attach! (b "b0") (b "b1") #:stiffness -1))
(test-refused "detach! of what is not held" "not held" (detach! (b "b0") (b "b1")))
(test-refused "a spring of no stiffness" "stiffness" (add-spring! (b "b0") (b "b1")))
(test-refused "a drag below 0" "drag" (add-drag! (b "b0") #:linear -1))
(test-refused "a force on what is fixed" "cannot move it" (add-force! (b "post") (const #(0 0 0))))
(test-refused "a mass that is no number" "mass" (add-body! #:shape (sphere 1) #:mass +nan.0))
(test-refused "a name that is taken" "taken" (add-body! #:name "b0" #:shape (sphere 1)))
(test-refused "a link without mass" "mass|inertia"
  (add-multibody! #:name 'other
    (link 'a #:joint (revolute) #:shape (sphere 0.1))
    (link 'c #:joint (revolute) #:shape #f)))
(test-refused "the base of a multibody that moves" "base" (add-multibody! #:base (b "b0")
    (link 'a #:joint (revolute) #:shape (sphere 0.1))))
(test-refused "a link removed" "link of arm" (remove-body! (link-body (arm) 'fore)))
(test-refused "a friction below 0" "friction" (set-contact-parameters! #t #t #:friction -1 #:restitution 0))
(test-refused "contact with what is no body" "second side" (set-contact-parameters! 'wood "x" #:friction 1))
(test-refused "gravity beyond all" "gravity" (scene #:gravity #(0 0 -1e300)))
(test-refused "gravity with an accuracy that comes too late" "accuracy was set after"
  (scene #:gravity #(1 0 -9.81) #:accuracy 1e-3))
(test-refused "gravity with a policy that there is not" "policy"
  (scene #:gravity #(1 0 -9.81) #:policy 'lazy))
(test-refused "gravity with frames below 0" "fps" (scene #:gravity #(1 0 -9.81) #:fps -1))
(test-refused "a callback of the past" "expected a time after" (add-callback! (b "b0") list #:start 0.1))
(test-refused "a callback twice on one" "twice" (add-callback! (list (b "b0") (b "b0")) list #:period 1))
(test-refused "what nobody can observe" "what to observe" (observe! 'noise list))

;; all or none: of two links one overlaps
(define (move-into-fore!)
  (disable-collisions! (arm) (b "b4"))
  (set! (position (b "b4")) (position (link-body (arm) 'fore))))
(test-refused-after (move-into-fore!) (continued move-into-fore!)
  "collisions with links of which one overlaps" "overlap"
  (enable-collisions! (arm) (b "b4")))
(in-world ()
  (playground!)
  (run! #:until 0.1)
  (move-into-fore!)
  (error-of (enable-collisions! (arm) (b "b4")))
  (test-equal "none of them collides" '(#f #f)
    (map (lambda (link) (third (contact-parameters (link-body (arm) link) (b "b4")))) '(upper fore))))

;; the scene is as it was, too
(in-world ()
  (scene #:title "one" #:duration 3)
  (test-message "a duration below 0" "duration" (scene #:title "two" #:duration -1))
  (test-message "an accuracy of 2" "accuracy" (scene #:title "two" #:duration 4 #:accuracy 2))
  (test-equal "neither title nor duration is set" '("one" 3)
    (map (lambda (name) (world-ref (current-world) name)) '(title duration))))

;; a new body that overlaps is refused when the next run begins; without it all goes on
(test-equal "a body that overlaps, removed again, leaves no trace" undisturbed
  (continued
   (lambda ()
     (let ((late (add-body! #:name "late" #:shape (sphere 0.2) #:position (position (b "b1")))))
       (test-message "it is refused" "overlap" (run-for! 0.1))
       (test-equal "the time stands" 0.7 (world-time))
       (remove-body! late)))))

;; what the issue shows: it stays where it was, and so does the next run
(in-world ()
  (ground)
  (let ((a (add-body! #:name "a" #:shape (box 0.2 0.2 0.2) #:position #(0 0 0.1)))
        (b (add-body! #:name "b" #:shape (box 0.2 0.2 0.2) #:position #(0.3 0 0.1))))
    (run! #:until 0.5)
    (let ((before (position a)))
      (test-message "in another" "overlap" (set! (position a) #(0.25 0 0.1)))
      (test-equal before (position a))
      (run! #:until 1)
      (test-assert "it rests there" (close? before (position a) 1e-9))
      (test-message "in the ground" "overlap" (set! (position a) #(0 0 -0.05)))
      (run! #:until 3)
      (test-assert "and there" (close? before (position a) 1e-9)))))

;; ---- of nothing ----

(test-nothing "a contact parameter of materials that nobody has"
  (set-contact-parameters! 'nobody 'has-it #:friction 0.1))
(test-nothing "a contact parameter that holds" (set-contact-parameters! #t #t #:friction 0.5))
(test-nothing "one of two that never touch" (set-contact-parameters! (b "shelf") (b "post") #:friction 0.1))
(test-nothing "one for all that a rule for each overrules"
  (begin (set-contact-parameters! 'wood #t #:restitution 0.3 #:friction 0.5)
         (set-contact-parameters! #t #t #:restitution 0.3)))
(test-nothing "gravity that holds" (scene #:gravity #(0 0 -9.81)))
(test-nothing "collisions that are enabled" (enable-collisions! #t #t))
(test-nothing "collisions of a multibody with itself" (enable-collisions! (arm) (arm)))
(test-nothing "collisions disabled and enabled again of what is far apart"
  (begin (disable-collisions! (b "bob") (b "b4")) (enable-collisions! (b "bob") (b "b4"))))
(for-each
 (lambda (name)
   (test-nothing (string-append "the force of " name)
     (set! (applied-force (b name)) (applied-force (b name))))
   (test-nothing (string-append "the torque of " name)
     (set! (applied-torque (b name)) (applied-torque (b name))))
   (test-nothing (string-append "the velocity of " name)
     (set! (velocity (b name)) (velocity (b name))))
   (test-nothing (string-append "the spin of " name)
     (set! (angular-velocity (b name)) (angular-velocity (b name))))
   (test-nothing (string-append "the position of " name)
     (set! (position (b name)) (position (b name))))
   (test-nothing (string-append "the orientation of " name)
     (set! (orientation (b name)) (orientation (b name)))))
 '("b0" "b3" "held" "bob"))
(test-nothing "a slot" (set! (slot (b "b0") 'n) 0))
(test-nothing "the joints' positions" (set! (joint-positions (arm)) (joint-positions (arm))))
(test-nothing "the joints' velocities" (set! (joint-velocities (arm)) (joint-velocities (arm))))
(test-nothing "a joint's torque" (set! (joint-torque (arm) 'fore) 0))
(test-nothing "an observer that only looks" (observe! 'collision (const #t)))
(test-nothing "and one of frames" (observe! 'frame (const #t)))
(test-nothing "a callback that only looks, of what flies" (add-callback! (b "bob") (const #f) #:start 1))
(test-nothing "an observer that comes and goes" (remove-observer! (observe! 'fusion (const #t))))
(test-nothing "a callback that comes and goes"
  (remove-callback! (add-callback! (b "b0") (lambda (time view) (set! (velocity view) #(0 0 9)))
                                   #:period 0.2)))
(test-nothing "a callback on collisions that comes and goes"
  (remove-callback! (on-collision! #t #t (lambda (collision a b) (error "no")))))
(test-nothing "a checkpoint" (checkpoint))
(test-nothing "a checkpoint that is restored at once" (restore! (checkpoint)))

;; what a slot is set to does not move anybody
(test-equal "a slot that changes moves nobody" (second undisturbed)
  (second (continued (lambda () (set! (slot (b "b0") 'n) 7)))))

;; the issue's own case
(in-world ()
  (ground)
  (for-each (lambda (k)
              (add-body! #:shape (box 0.3 0.3 0.3)
                         #:position (vector (* 0.05 (modulo k 3)) (* 0.07 (modulo k 2))
                                            (+ 0.5 (* 0.55 k)))))
            (iota 6))
  (run! #:until 1.3)
  (let* ((here (checkpoint))
         (go (lambda () (run! #:until 4) (all-poses)))
         (first (go)))
    (for-each
     (lambda (name change)
       (restore! here)
       (change)
       (test-equal (string-append name ": the same bits") first (go)))
     '("restored" "parameters of nobody" "restored again" "gravity" "a force")
     (list (const #t)
           (lambda () (set-contact-parameters! 'nobody 'has-it #:friction 0.1))
           (const #t)
           (lambda () (scene #:gravity #(0 0 -9.81)))
           (lambda () (let ((body (car (reverse (world-bodies)))))
                        (set! (applied-force body) (applied-force body))))))))

;; ---- back to a checkpoint ----

(define (throw-ball! . keywords)
  (apply add-body! #:name "thrown" #:shape (sphere 0.15) #:density 3000
         #:position #(-1.5 0 0.6) #:velocity #(8 0 1) keywords))

(define-syntax-rule (test-undone name expression)
  (begin
    (test-equal (string-append name ", looked at and undone, leaves no trace") undisturbed
      (continued (lambda ()
                   (let ((here (checkpoint)))
                     expression
                     (error-of (run-for! 0.4))
                     (restore! here)))))
    (test-equal (string-append name ", undone unseen, leaves no trace") undisturbed
      (continued (lambda ()
                   (let ((here (checkpoint)))
                     expression
                     (restore! here)))))))

(test-undone "a thrown ball" (throw-ball!))
(test-undone "a wall" (add-body! #:shape (box 0.1 3 3) #:position #(0.5 0 0) #:fixed? #t))
(test-undone "a ceiling" (add-body! #:shape (half-space #(0 0 -1) -4) #:fixed? #t))
(test-undone "a lift" (add-body! #:shape (box 1 1 0.1) #:position #(0 0 0)
                                 #:motion (keyframes '((0.5 #(0 3 0.1)) (1.5 #(0 0 2))))))
(test-undone "a box removed" (remove-body! (b "b1")))
(test-undone "the ground removed" (remove-body! (b "ground")))
(test-undone "the post removed" (remove-body! (b "post")))
(test-undone "the table removed" (remove-body! (b "table")))
(test-undone "another arm"
  (add-multibody! #:name 'second #:position #(-3 1 1.5) #:base (b "post")
    (link 'upper #:joint (revolute #:axis #(0 1 0))
          #:shape (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0)))))
(test-undone "a spring" (add-spring! (b "b0") (b "b3") #:stiffness 500))
(test-undone "a hold" (attach! (b "b2") (b "b3")))
(test-undone "a hold that let go" (detach! (b "post") (b "held")))
(test-undone "drag" (add-drag! (b "b2") #:linear 5))
(test-undone "wind" (add-force! (b "b2") (lambda (time view) (vector (sin (* 9 time)) 0 0))))
(test-undone "friction" (set-contact-parameters! #t #t #:friction 0 #:restitution 0.9))
(test-undone "a filter" (disable-collisions! (b "b0") (b "ground")))
(test-undone "gravity" (scene #:gravity #(0 3 -5)))
(test-undone "a callback" (add-callback! (b "b0") (lambda (time view) (set! (velocity view) #(0 0 2)))
                                         #:period 0.05))
(test-undone "a callback that fails" (add-callback! (b "b0") (lambda (time view) (car time))))
(test-undone "a callback on collisions"
  (on-collision! #t #t (lambda (collision a b) (set! (velocity (if (eq? (body-kind a) 'dynamic) a b)) #(0 0 3)))))
(test-undone "an observer that fails" (observe! 'frame (lambda (frame) (error "no"))))
(test-undone "joints put elsewhere" (set! (joint-positions (arm)) #(0.5 0.5)))
(test-undone "a number drawn" (random-real! (b "b4")))
(test-undone "all of it"
  (begin (remove-body! (b "b0"))
         (let ((ball (throw-ball! #:slots '((n . 1)))))
           (add-spring! ball (b "b3") #:stiffness 100)
           (add-callback! (list ball (b "b3")) (lambda (time x y) (random-real! x) #f))
           (set-contact-parameters! ball #t #:restitution 1)
           (disable-collisions! ball (b "b2")))))

;; what is thrown after an undone throw flies as if it were the first
(test-equal "a second throw is like the first"
  (continued (lambda () (throw-ball!)))
  (continued (lambda ()
               (let ((here (checkpoint)))
                 (add-body! #:name "brick" #:shape (box 0.3 0.2 0.1) #:position #(1 0 3))
                 (add-callback! (b "brick") (const #f) #:period 0.1)
                 (run-for! 0.3)
                 (restore! here)
                 (throw-ball!)))))

;; handles
(in-world ('(hash . #t))
  (playground!)
  (run! #:until 0.7)
  (let* ((first (checkpoint))
         (box (b "b1"))
         (ball (throw-ball!))
         (spring (add-spring! ball (b "b3") #:stiffness 100))
         (called 0)
         (callback (add-callback! ball (lambda (time view) (set! called (1+ called))) #:period 0.1)))
    (remove-body! box)
    (run-for! 0.2)
    (let ((second (checkpoint)) (there (position ball)))
      (run-for! 0.1)
      (restore! first)
      (test-equal "what came since is not found" #f (memq ball (world-bodies)))
      (test-message "its handle says so" "#<body thrown( \\(removed\\))?>; expected one that is there"
        (position ball))
      (test-message "also where it is changed" "thrown" (set! (velocity ball) #(0 0 0)))
      (test-message "a spring of it" "the spring is #<spring between thrown and b3, 100 N/m"
        (remove-spring! spring))
      (test-message "a callback of it" "the callback is #<callback 1 of thrown every 0.1 s"
        (remove-callback! callback))
      (test-equal "what was removed is back, the same" box (b "b1"))
      (test-assert "and can be read" (vector? (position box)))
      (test-equal "handles tell" "#<body thrown (removed)> #<callback 1 of thrown every 0.1 s (removed)>"
        (format #f "~a ~a" ball callback))
      (let ((other (throw-ball! #:density 100)))
        (test-assert "a new one is another" (not (eq? other ball)))
        (test-message "even if it has its number" "expected one that is there" (position ball))
        (run-for! 0.1))
      (restore! second)
      (test-equal "back to the later one: the handle works" there (position ball))
      (test-equal "and the name is its" ball (b "thrown"))
      (test-message "what was removed then is removed" "not removed" (position box))
      (set! called 0)
      (run-for! 0.3)
      (test-assert "its callback is called" (<= 2 called 3))
      (remove-spring! spring)
      (remove-callback! callback)
      (run-for! 0.2)
      (test-assert "and no more" (<= called 3))
      (restore! first)
      (restore! second)
      (let ((after (begin (run! #:until 1.6) (hash))))
        (restore! first)
        (run! #:until 1)
        (restore! second)
        (run! #:until 1.6)
        (test-equal "to and fro gives the same bits" after (hash))))))

;; observers come and go with it, recorders of the command line stay
(in-world ()
  (playground!)
  (let* ((frames 0) (hits 0)
         (before (checkpoint))
         (observer (observe! 'frame (lambda (frame) (set! frames (1+ frames))))))
    (run! #:until 0.5)
    (test-equal "frames are seen" 16 frames)
    (let ((with-frames (checkpoint))
          (hit (observe! 'collision (lambda (collision) (set! hits (1+ hits))))))
      (run! #:until 1)
      (test-assert "hits are seen" (> hits 0))
      (restore! with-frames)
      (set! hits 0)
      (set! frames 0)
      (run! #:until 1)
      (test-equal "the later observer is gone" '(0 15) (list hits frames))
      (test-message "and says so" "observer of collisions" (remove-observer! hit))
      (restore! before)
      (set! frames 0)
      (run! #:until 0.5)
      (test-equal "and so is the other" 0 frames)
      (restore! with-frames)
      (run! #:until 1)
      (test-equal "which is back" 15 frames)
      (remove-observer! observer)
      (run! #:until 2)
      (test-equal "and removed" 15 frames)
      (restore! with-frames)
      (run! #:until 1)
      (test-equal "and back" 30 frames))))

;; under the validators, and out of order
(define (under . overrides)
  (dynamic-wind
    (lambda () (set-overrides! (cons '(hash . #t) overrides)))
    (lambda ()
      (parameterize ((current-world (make-world)))
        (playground!)
        (run! #:until 0.4)
        (let ((here (checkpoint)) (ball (throw-ball!)))
          (error-of (set! (position (b "b0")) (position (b "b1"))))
          (run-for! 0.1)
          (let ((later (checkpoint)))
            (remove-body! (b "b2"))
            (run-for! 0.1)
            (restore! here)
            (run-for! 0.1)
            (restore! later)
            (remove-body! ball)
            (error-of (set! (orientation (b "held")) (rotation #(0 0 1) 0.785)))
            (run! #:until 0.8)
            (hash)))))
    (lambda () (set-overrides! '()))))
(let ((plain (under)))
  (test-equal "under --check" plain (under '(check . #t)))
  (test-equal "under --undo-redo" plain (under '(undo-redo . #t)))
  (test-equal "under an adversary" plain (under '(adversary 3 0.05 #t)))
  (test-equal "under another policy of GVT" plain (under '(gvt-interval . 1))))

;; ---- what can be taken away ----

(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((a (add-body! #:name "a" #:shape (sphere 0.1) #:mass 1 #:position #(0 0 0)))
         (c (add-body! #:name "c" #:shape (sphere 0.1) #:mass 1 #:position #(1 0 0) #:velocity #(1 0 0)))
         (wall (add-body! #:name "wall" #:shape #f #:mass 1 #:inertia #(1 1 1) #:center-of-mass #(0 0 0)
                          #:position #(0 5 0) #:fixed? #t))
         (spring (add-spring! a c #:stiffness 10))
         (anchor (add-spring! wall c #:stiffness 20.5 #:rest 0))
         (drag (add-drag! c #:linear 0.5))
         (twin (add-drag! c #:linear 0.5))
         (force (add-force! c (lambda (time view) #(0 0 1)))))
    (test-equal "handles tell what they are"
      '("#<spring between a and c, 10 N/m>" "#<spring between wall and c, 20.5 N/m>"
        "#<drag on c>" "#<force on c>")
      (map object->string (list spring anchor drag force)))
    (run! #:until 0.3)
    (remove-spring! anchor)
    (remove-drag! drag)
    (test-equal "they tell that they are gone" "#<drag on c (removed)>" (object->string drag))
    (test-equal "the other one is not" "#<drag on c>" (object->string twin))
    (test-message "twice" "the drag is #<drag on c.*it was removed" (remove-drag! drag))
    (remove-drag! twin)
    (remove-force! force)
    (run-for! 0.1)
    (let ((momentum (total-momentum)) (energy (total-energy)))
      (run-for! 1)
      (test-assert "the spring alone keeps momentum" (close? momentum (total-momentum) 1e-10))
      (test-approximate "and energy" energy (total-energy) 1e-5))
    (remove-spring! spring)
    (let ((before (list (velocity a) (velocity c) (position c))))
      (run-for! 1)
      (test-equal "then both fly straight on" (list-head before 2) (list (velocity a) (velocity c)))
      (test-assert "at that speed"
        (close? (v+ (third before) (second before)) (position c) 1e-12)))
    (test-message "another kind of handle" "the drag is #<spring .*expected what add-drag! returned"
      (remove-drag! spring))
    (test-message "no handle" "the force is 5; expected what add-force! returned" (remove-force! 5))
    (let ((late (add-drag! c #:linear 1)))
      (remove-body! c)
      (test-message "of a body that is gone" "the drag is" (remove-drag! late)))))

;; a force's procedure that fails is removed, and the run goes on from there
(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((c (add-body! #:name "c" #:shape (sphere 0.1) #:mass 1))
         (force (add-force! c (lambda (time view) (if (> time 0.5) (car 'typo) #(1 0 0))))))
    (test-message "an error of a force" "Wrong type(.|
)*the force on c" (run! #:until 1))
    (let ((when (world-time)) (speed (velocity c)))
      (remove-force! force)
      (run! #:until 2)
      (test-equal "it flies straight on" speed (velocity c))
      (test-assert "from the time of the error" (<= 0.4 when 0.51))
      (test-assert "which it reached" (close? speed (vector when 0 0) 1e-6)))))

;; a callback's typo does not cost the world
(in-world ()
  (let* ((ball (add-body! #:name "ball" #:shape (sphere 0.1) #:slots '((n . 0))))
         (callback (add-callback! ball
                     (lambda (time view)
                       (set! (slot view 'n) (1+ (slot view 'n)))
                       (when (> time 0.45) (car time)))
                     #:period 0.1)))
    (test-message "a typo" "Wrong type" (run! #:until 1))
    (test-approximate "the world stands at its time" 0.5 (world-time) 1e-15)
    (test-message "again" "Wrong type" (run! #:until 1))
    (test-equal "a callback tells what it is" "#<callback 0 of ball every 0.1 s>" (object->string callback))
    (remove-callback! callback)
    (let ((again (add-callback! ball (lambda (time view) (set! (slot view 'n) (1+ (slot view 'n))))
                                #:period 0.1)))
      (run! #:until 1)
      (test-equal "anew, from the time of the error on" 11 (slot ball 'n))
      (test-message "the first is gone" "it was removed" (remove-callback! callback))
      (test-equal "and says so" "#<callback 0 of ball every 0.1 s (removed)>" (object->string callback))
      (remove-callback! again)
      (run! #:until 2)
      (test-equal "no more calls" 11 (slot ball 'n)))))

;; one on collisions
(in-world ()
  (ground)
  (let* ((ball (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(0 0 1) #:slots '((n . 0))))
         (count (on-collision! ball #t (lambda (collision a b) (set! (slot a 'n) (1+ (slot a 'n))))))
         (typo (on-collision! ball 'steel (lambda (collision a b) (car 5))))
         (wrong (on-collision! #t #t (lambda (collision a b) (car 5)))))
    (set-contact-parameters! #t #t #:restitution 0.8)
    (test-equal "they tell what they are"
      '("#<callback on collisions of ball and all>" "#<callback on collisions of ball and steel>")
      (map object->string (list count typo)))
    (test-message "a typo in a callback on collisions" "Wrong type" (run! #:until 1))
    (test-equal 0 (slot ball 'n))
    (remove-callback! wrong)
    (run! #:until 2)
    (let ((hits (slot ball 'n)))
      (test-assert "the other one is called" (>= hits 2))
      (remove-callback! count)
      (run! #:until 4)
      (test-equal "and no more" hits (slot ball 'n)))))

;; from within: a clear error, and nothing has happened
(in-world ()
  (ground)
  (let* ((ball (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(0 0 1)))
         (callback #f) (observer #f) (calls 0))
    (set! callback (add-callback! ball (lambda (time view) (remove-callback! callback) #f) #:start 0.1))
    (test-message "a callback that removes itself" "remove-callback! was used inside a callback"
      (run! #:until 1))
    (remove-callback! callback)
    (set! observer (observe! 'collision (lambda (collision) (set! calls (1+ calls))
                                                            (remove-observer! observer))))
    (test-message "an observer that removes itself" "remove-observer! was used inside a callback or obs"
      (run! #:until 1))
    (test-equal "it has been called" 1 calls)
    (remove-observer! observer)
    (run! #:until 2)
    (test-equal "and is no more" 1 calls)
    (test-equal "it tells what it is" "#<observer of collisions (removed)>" (object->string observer))))

;; an observer of frames that never saw one
(in-world ()
  (add-body! #:shape (sphere 0.1))
  (let* ((seen 0)
         (one (observe! 'frame (lambda (frame) (set! seen (1+ seen)))))
         (two (observe! 'frame (lambda (frame) (set! seen (+ seen 100))))))
    (test-equal "it waits" "#<observer of frames>" (object->string two))
    (remove-observer! two)
    (test-message "twice" "it was removed" (remove-observer! two))
    (run! #:until 0.1)
    (test-equal "the other one looks" 4 seen)
    (test-message "of another world" "belongs to another world"
      (parameterize ((current-world (make-world))) (remove-observer! one)))))

;; ---- who collides ----

;; a clapper in its bell, which stands still: it comes back with e times its speed
(define (bell! restitution . change)
  (set-contact-parameters! #t #t #:restitution restitution #:friction 0)
  (let ((bell (add-multibody! #:name 'bell
                (link 'shell #:joint (weld)
                      #:shape (union (placed (box 0.02 0.4 0.6) #:position #(-0.3 0 -0.3))
                                     (placed (box 0.02 0.4 0.6) #:position #(0.3 0 -0.3)))
                  (link 'clapper #:joint (revolute #:axis #(0 1 0))
                        #:shape (placed (sphere 0.05) #:position #(0 0 -0.5)))))))
    bell))
(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((bell (bell! 0.5))
         (shell (link-body bell 'shell)) (clapper (link-body bell 'clapper)))
    (test-equal "joined links don't collide" #f (third (contact-parameters shell clapper)))
    (set! (joint-velocity bell 'clapper) 1)
    (run! #:until 1)
    (test-approximate "it swings through" 1 (joint-position bell 'clapper) 1e-9)
    (set! (joint-position bell 'clapper) 0)
    (enable-collisions! bell bell)
    (test-equal "nor if the whole is named" #f (third (contact-parameters shell clapper)))
    (enable-collisions! shell clapper)
    (test-equal "they do if both are named" #t (third (contact-parameters shell clapper)))
    (run-for! 1)
    (test-approximate "it comes back at half its speed" -0.5 (joint-velocity bell 'clapper) 1e-9)
    ;; the ball's centre goes round at 0.5 m and meets the wall at x = 0.29 - 0.05
    (let ((angle (asin (/ 0.24 0.5))))
      (test-approximate "from where it struck" (- angle (* 0.5 (- 1 angle)))
                        (abs (joint-position bell 'clapper)) 1e-6))
    (disable-collisions! bell bell)
    (test-equal "and not if they are told not to" #f (third (contact-parameters shell clapper)))))

;; it comes to rest in its bell that is tilted, on the wall
(in-world ()
  (let* ((bell (bell! 0)) (shell (link-body bell 'shell)) (clapper (link-body bell 'clapper)))
    (enable-collisions! shell clapper)
    (scene #:gravity #(9.81 0 0))
    (run! #:until 3)
    (test-approximate "at rest on the wall" (asin (/ 0.24 0.5)) (abs (joint-position bell 'clapper)) 1e-3)
    (test-assert "still" (< (abs (joint-velocity bell 'clapper)) 1e-6))
    (test-equal "in contact" '(("bell/shell" "bell/clapper"))
      (delete-duplicates (map (lambda (contact) (map body-name (contact-bodies contact))) (contacts))))))

;; those that overlap about their joint are refused by its name
(in-world ()
  (let* ((rod (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0)))
         (arm (add-multibody! #:name 'arm
                (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape rod
                  (link 'fore #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0)) #:shape rod)))))
    (run! #:until 0.1)
    (test-message "links that overlap at their joint"
      "arm/upper and arm/fore \\(which the joint fore of arm joins\\) overlap"
      (enable-collisions! (link-body arm 'upper) (link-body arm 'fore)))
    (test-equal "they don't collide" #f
      (third (contact-parameters (link-body arm 'upper) (link-body arm 'fore))))
    (run! #:until 0.3)
    (test-assert "the arm swings on" (> (abs (joint-velocity arm 'upper)) 0.5))))
(in-world ()
  (let* ((rod (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0)))
         (post (add-body! #:name "post" #:shape (box 0.1 0.1 0.1) #:fixed? #t))
         (arm (add-multibody! #:name 'arm #:base post
                (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape rod))))
    (test-equal "nor do a base and what hangs on it" #f
      (third (contact-parameters post (link-body arm 'upper))))
    (enable-collisions! post (link-body arm 'upper))
    (test-message "before the first run, too" "\\(which the joint upper of arm joins\\) overlap"
      (run! #:until 0.1))
    (disable-collisions! post (link-body arm 'upper))
    (run! #:until 0.1)))

;; a base that its link strikes
(in-world ()
  (scene #:gravity #(0 0 0))
  (set-contact-parameters! #t #t #:restitution 1 #:friction 0)
  (let* ((frame (add-body! #:name "frame" #:shape (placed (box 0.1 1 1) #:position #(0.55 0 0)) #:fixed? #t))
         (cart (add-multibody! #:name 'cart #:base frame
                 (link 'slide #:joint (prismatic #:axis #(1 0 0)) #:shape (box 0.2 0.2 0.2)))))
    (enable-collisions! frame (link-body cart 'slide))
    (set! (joint-velocity cart 'slide) 1)
    (run! #:until 0.6)
    ;; 0.4 m there, 0.2 m back
    (test-approximate "a base that its link strikes" 0.2 (joint-position cart 'slide) 1e-9)))

(in-world ()
  (let ((a (add-body! #:shape (sphere 0.1) #:material 'wood))
        (c (add-body! #:shape (sphere 0.1) #:position #(1 0 0)))
        (g (ground))
        (h (add-body! #:shape (sphere 0.1) #:position #(3 0 0) #:fixed? #t))
        (point (add-body! #:shape #f #:mass 1 #:inertia #(1 1 1) #:center-of-mass #(0 0 0))))
    (define (collide? x y) (third (contact-parameters x y)))
    (test-equal "two that move, one that does not, two that do not, one without a shape, one alone"
      '(#t #t #f #f #f) (map collide? (list a a g a a) (list c g h point a)))
    (disable-collisions! 'wood g)
    (test-equal "by a material" '(#f #t) (list (collide? a g) (collide? c g)))))

(test-end "edits")
