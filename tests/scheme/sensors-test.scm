;; Sensors and contacts of a body, against closed forms; in callbacks as at the prompt.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules ((timewarp vectors) #:select (v+ v- v* dot cross norm rotate q-conjugate)))

(test-begin "sensors")

(define g 9.81)
(define up (vector 0 0 g))

(define (sum vectors) (fold v+ #(0 0 0) vectors))

;; ---- at rest ----

(define floor* (ground))
(define crate (add-body! #:name "crate" #:shape (box 0.2 0.2 0.2) #:position #(0 0 0.1)
                         #:slots '((felt . #(0 0 0)) (carried . #(0 0 0)) (points . 0))))
(define weight (* g (body-mass crate)))
(add-callback! crate
  (lambda (time crate)
    (set! (slot crate 'felt) (accelerometer crate #:at #(0.1 0 0)))
    (set! (slot crate 'carried) (net-contact-force crate))
    (set! (slot crate 'points) (length (contacts #:body crate))))
  #:period 0.1)
(run! #:until 1)
(test-assert "what rests feels gravity upwards, wherever it is mounted"
  (and (close? up (accelerometer crate) 1e-9) (close? up (accelerometer crate #:at #(1 2 3)) 1e-9)))
(test-assert "in its own axes: turned about x by a quarter, up is y"
  (close? (vector 0 g 0) (accelerometer crate #:orientation (rotation #(1 0 0) (/ (acos -1) 2))) 1e-9))
(test-assert "its contacts carry it"
  (close? (vector 0 0 weight) (net-contact-force crate) (* 1e-3 weight)))
(test-assert "a callback reads the same"
  (and (close? up (slot crate 'felt) 1e-9)
       (close? (net-contact-force crate) (slot crate 'carried) 1e-9)
       (= (length (contacts #:body crate)) (slot crate 'points) 4)))
(test-assert "the floor is pressed down"
  (close? (vector 0 0 (- weight)) (net-contact-force floor*) (* 1e-3 weight)))
(test-assert "the floor stands still, and feels gravity" (close? up (accelerometer floor*) 0.0001))
(test-equal "a gyro at rest" #(0.0 0.0 0.0) (gyro crate))

;; ---- on a slope: what sticks, what slides ----

(reset!)
(define angle (/ 20 (/ 180 (acos -1))))
(define tilt (rotation #(0 1 0) angle))   ; downhill is +x
(define (on-slope x y z) (rotate tilt (vector x y z)))
(define slope (add-body! #:name "slope" #:shape (box 24 6 0.5) #:fixed? #t #:orientation tilt
                         #:position (on-slope 6 0 -0.25)))
(define (slider name y friction)
  (let ((body (add-body! #:name name #:shape (box 0.5 0.5 0.5) #:orientation tilt
                         #:position (on-slope -4 y 0.25) #:slots '((felt . #(0 0 0))))))
    (set-contact-parameters! body #t #:friction friction #:restitution 0)
    (add-callback! body (lambda (time body) (set! (slot body 'felt) (accelerometer body)))
                   #:start 0.9 #:period 0.1)
    body))
(define sticks (slider "sticks" -1 0.5))
(define slides (slider "slides" 1 0.2))
(run! #:until 1)
(define normal (on-slope 0 0 1))
(define downhill (on-slope 1 0 0))
(test-assert "what sticks feels gravity in its axes"
  (close? (vector (* -1 g (sin angle)) 0 (* g (cos angle))) (accelerometer sticks) 1e-6))
(let ((force (net-contact-force sticks)) (weight (* g (body-mass sticks))))
  (test-assert "normal part" (close? (* weight (cos angle)) (dot force normal) (* 1e-3 weight)))
  (test-assert "friction" (close? (- (* weight (sin angle))) (dot force downhill) (* 1e-3 weight))))
;; a = F/m - g: nothing but the plane's force is felt
(test-assert "what slides feels the normal force and mu of it"
  (close? (vector (* -0.2 g (cos angle)) 0 (* g (cos angle))) (slot slides 'felt) 1e-6))
(let ((contacts (contacts #:body slides)))
  (test-assert "all its contacts slip" (and (pair? contacts) (every contact-slipping? contacts)))
  (test-assert "the sum of its contacts is the net force"
    (close? (net-contact-force slides)
            (sum (map (lambda (c) (v+ (v* (contact-force c) (contact-normal c))
                                      (contact-friction c)))
                      contacts))
            1e-9)))
(test-assert "the net force and gravity make its acceleration"
  (close? (rotate (q-conjugate (orientation slides))
                  (v* (/ 1 (body-mass slides)) (net-contact-force slides)))
          (accelerometer slides) 1e-9))
(test-assert "the slope carries both, and each"
  (and (close? (net-contact-force slope)
               (v* -1 (v+ (net-contact-force sticks) (net-contact-force slides))) 1e-6)
       (close? (net-contact-force slope #:from sticks)
               (v* -1 (net-contact-force sticks #:from (list slope))) 1e-6)
       (equal? #(0.0 0.0 0.0) (net-contact-force sticks #:from slides))))

;; ---- in the air: flight, spin, drag, tumbling ----

(reset!)
(define flies (add-body! #:name "flies" #:shape (sphere 0.1) #:position #(0 0 50)
                         #:velocity #(3 0 5) #:angular-velocity #(0 0 20)))
(define drags (add-body! #:name "drags" #:shape (sphere 0.1) #:position #(5 0 50)))
(add-drag! drags #:quadratic 0.05)
(define tumbles (add-body! #:name "tumbles" #:shape (box 0.4 0.2 0.1) #:position #(9 0 50)
                           #:angular-velocity #(5 1 -3)))
(run! #:until 0.5)
(test-assert "free flight: nothing" (close? #(0 0 0) (accelerometer flies) 1e-9))
(test-assert "but where it spins, away from its centre"
  (close? #(-40 0 0) (accelerometer flies #:at #(0.1 0 0)) 1e-9))
(test-assert "the gyro reads the spin" (close? #(0 0 20) (gyro flies) 1e-9))
(test-assert "mounted upside down, too"
  (close? #(0 0 -20) (gyro flies #:orientation (rotation #(1 0 0) (acos -1))) 1e-9))
(let ((speed (vector-ref (velocity drags) 2)))
  (test-assert "drag is felt"
    (close? (vector 0 0 (/ (* 0.05 speed speed) (body-mass drags))) (accelerometer drags) 1e-9)))
;; second difference of the way of a corner
(let* ((corner #(0.2 0.1 0.05))
       (at (lambda () (v+ (position tumbles) (rotate (orientation tumbles) corner))))
       (h 1/1024) (before (at)) (now #f) (felt #f))
  (run-for! h)
  (set! now (at))
  (set! felt (rotate (orientation tumbles) (accelerometer tumbles #:at corner)))
  (run-for! h)
  (let ((difference (v* (/ 1 (* h h)) (v+ (at) (v- before (v* 2 now))))))
    (test-assert "a corner of what tumbles" (close? (v- difference (vector 0 0 (- g))) felt 1e-3))))

;; ---- hung up: pendulum, spring, hold, lift ----

(reset!)
(define pendulum
  (add-multibody! #:name "pendulum" #:position #(0 0 3)
    (link "bob" #:joint (revolute #:axis #(0 1 0))
          #:shape (placed (sphere 0.1) #:position #(0 0 -1)))))
(define bob (link-body pendulum "bob"))
(set! (joint-position pendulum "bob") 0.7)
(define hangs (add-body! #:name "hangs" #:shape (box 0.1 0.1 0.1) #:position #(2 0 1)))
(define hook (add-body! #:name "hook" #:shape #f #:fixed? #t #:position #(2 0 2)
                        #:mass 1 #:inertia #(1 1 1) #:center-of-mass #(0 0 0)))
(add-spring! hangs hook #:stiffness 40 #:damping 0.3 #:rest 0.6)
(define held (add-body! #:name "held" #:shape (box 0.1 0.1 0.1) #:position #(4 0 1)))
(define post (add-body! #:name "post" #:shape #f #:fixed? #t #:position #(4 0 1.5)
                        #:mass 1 #:inertia #(1 1 1) #:center-of-mass #(0 0 0)))
(attach! held post)
(define lift (add-body! #:name "lift" #:shape (box 1 1 0.1) #:position #(8 0 1)
                        #:motion (keyframes '((0 #(8 0 1)) (2 #(8 0 3))) #:smooth? #t)))
(run! #:until 0.6)
;; I a = - m g l sin q; the string pulls with m (g cos q + l w^2), at the bob's centre
(let* ((q (joint-position pendulum "bob")) (w (joint-velocity pendulum "bob"))
       (a (/ (* -1 g (sin q)) (+ 1 (* 2/5 0.01)))))
  (test-assert "a pendulum's bob"
    (close? (vector (- (+ a (* g (sin q)))) 0 (+ (* g (cos q)) (* w w)))
            (accelerometer bob #:at #(0 0 -1)) 1e-9))
  (test-assert "its gyro" (close? (vector 0 w 0) (gyro bob) 1e-9)))
(let* ((l (- 2 (vector-ref (position hangs) 2))) (v (vector-ref (velocity hangs) 2)))
  (test-assert "a spring's pull"
    (close? (/ (- (* 40 (- l 0.6)) (* 0.3 v)) (body-mass hangs))
            (vector-ref (accelerometer hangs) 2) 1e-9)))
(test-assert "what a hold carries feels gravity" (close? up (accelerometer held) 1e-2))
;; minimum jerk over 2 m in 2 s: z'' = (d/T^2) (60 s - 180 s^2 + 120 s^3) at s = 0.3
(test-assert "a lift that starts"
  (close? (+ g (* 2/4 (+ (* 60 0.3) (* -180 0.09) (* 120 0.027))))
          (vector-ref (accelerometer lift) 2) 1e-9))

;; ---- at impacts ----

(reset!)
(define ground* (ground))
(define ball (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(0 0 1)
                        #:angular-velocity #(0 3 0)
                        #:slots '((felt . #f) (force . #f) (contacts . #f) (turn . #f))))
(on-collision! ball ground*
  (lambda (collision ball ground*)
    (set! (slot ball 'felt) (accelerometer ball))
    (set! (slot ball 'force) (net-contact-force ball))
    (set! (slot ball 'contacts) (contacts #:body ball))
    (set! (slot ball 'turn) (gyro ball))))
(run! #:until 0.6)
(test-assert "an impulse is no force: just before, it flew"
  (and (close? #(0 0 0) (slot ball 'felt) 1e-9) (equal? #(0.0 0.0 0.0) (slot ball 'force))
       (null? (slot ball 'contacts))))
(test-assert "the gyro reads what is after it"
  (close? (gyro ball) (rotate (q-conjugate (orientation ball)) (angular-velocity ball)) 1e-12))
(test-assert "which friction has changed" (not (close? #(0 3 0) (slot ball 'turn) 1e-3)))

;; ---- what presses on a plate; frames; errors ----

(reset!)
(define plate (add-body! #:name "plate" #:shape (box 1 1 0.1) #:fixed? #t
                         #:slots '((load . #(0 0 0)))))
(define one (add-body! #:name "one" #:shape (box 0.2 0.2 0.2) #:position #(-0.3 0 0.15)))
(define two (add-body! #:name "two" #:shape (box 0.2 0.2 0.2) #:position #(0.3 0 0.15)))
(add-callback! (list plate one two)
  (lambda (time plate one two)
    (set! (slot plate 'load) (net-contact-force plate #:from (list one two two))))
  #:period 0.1)
(define framed '())
(observe! 'frame
  (lambda (frame)
    (for-each (lambda (view)
                (set! framed (list (accelerometer view) (net-contact-force view) (gyro view)
                                   (length (contacts #:body view)))))
              (frame-views frame))))
(run! #:until 1)
(test-assert "a plate weighs what stands on it"
  (close? (vector 0 0 (* -2 g (body-mass one))) (slot plate 'load) 0.2))
(test-assert "once" (close? (net-contact-force plate) (slot plate 'load) 1e-9))
(test-assert "observers of frames read sensors"
  (match framed
    ((felt force turn count)
     (and (close? up felt 1e-6) (close? (net-contact-force two) force 1e-9)
          (close? #(0 0 0) turn 1e-6) (= count 4)))))

;; What EXPRESSION raises in a callback on a plate of its own, while OTHER is no target.
(define-syntax-rule (test-refused name pattern (plate other) expression)
  (in-world ()
    (let ((plate (add-body! #:name "plate" #:shape (box 1 1 0.1) #:fixed? #t))
          (other (add-body! #:name "other" #:shape (sphere 0.1) #:position #(0 0 1))))
      (add-callback! plate (lambda (time plate) expression))
      (test-message name pattern (run! #:until 0.1)))))
(test-refused "a plate's view knows no contacts" "of plate.*dynamic body that touches"
              (plate other) (contacts #:body plate))
(test-refused "nor its force" "net-contact-force of plate.*#:from" (plate other)
              (net-contact-force plate))
(test-refused "bodies are read by views" "accelerometer was used inside a callback" (plate other)
              (accelerometer other))
(test-refused "those that touch it, too" "net-contact-force was used inside a callback"
              (plate other) (net-contact-force plate #:from other))
(test-refused "all contacts are not for callbacks" "contacts without #:body" (plate other)
              (contacts))
(test-message "no body" "the body is 7" (net-contact-force 7))
(test-message "no body to feel" "accelerometer is \"x\"" (accelerometer "x"))
(test-message "no point" "at is 3" (accelerometer one #:at 3))
(test-message "no turn" "orientation is #\\(0 0 0 0\\)" (gyro one #:orientation #(0 0 0 0)))
(test-message "unknown" "#:point" (accelerometer one #:point #(0 0 0)))

;; ---- range ----

(reset!)
(define wall (add-body! #:name "wall" #:shape (box 0.2 4 4) #:fixed? #t #:position #(3 0 0)))
(define probe (add-body! #:name "probe" #:shape (box 0.4 0.2 0.2)
                         #:orientation (rotation #(0 0 1) (/ (acos -1) 2))
                         #:slots '((range . #f))))
(test-assert "a ray from its nose, in its axes"
  (close? 2.7 (rangefinder probe #(0 -5 0) #:at #(0 -0.2 0)) 1e-12))
(test-equal "nothing there" #f (rangefinder probe #(1 0 0)))
(test-equal "not so far" #f (rangefinder probe #(0 -1 0) #:max-distance 2))
(test-equal "passed through" #f (rangefinder probe #(0 -1 0) #:ignore wall))
(test-message "no direction" "direction is #\\(" (rangefinder probe #(0 0 0)))
(add-callback! (list probe wall)
  (lambda (time probe wall)
    (set! (slot probe 'range) (rangefinder probe #(0 -1 0) #:bodies (list wall))))
  #:period 1)
(run! #:until 0.1)
(test-assert "in a callback, among its views" (close? 2.9 (slot probe 'range) 1e-12))

;; ---- what passes through joints ----

(reset!)
(define (bob-on-a-string name y)
  (add-multibody! #:name name #:position (vector 0 y 3)
    (link "bob" #:joint (revolute #:axis #(0 1 0)) #:mass 2 #:slots '((pull . #f))
          #:shape (placed (sphere 0.1) #:position #(0 0 -1)))))
(define still (bob-on-a-string "still" 0))
(define swings (bob-on-a-string "swings" 2))
(test-assert "before any run: a pendulum hangs by its weight"
  (close? (vector 0 0 (* 2 g)) (joint-force still "bob") 1e-12))
;; a third of the way down, and at the bottom: from level, m (g cos q + l w^2) towards the pivot
(set! (joint-position swings "bob") (/ (acos -1) 2))
(add-callback! (link-body swings "bob")
  (lambda (time bob) (set! (slot bob 'pull) (joint-force bob "bob")))
  #:period 1/64)
(define I/m (+ 1 (* 2/5 0.01)))                         ; about the pivot
(define (test-pull name swings mass)
  (let* ((q (joint-position swings "bob")) (w (joint-velocity swings "bob"))
         (a (/ (* -1 g (sin q)) I/m))
         ;; q turns the string from down to -x
         (inwards (vector (sin q) 0 (cos q))) (along (vector (- (cos q)) 0 (sin q))))
    (test-assert name
      (close? (v* mass (v+ (v* (+ (* g (cos q)) (* w w)) inwards) (v* (+ a (* g (sin q))) along)))
              (joint-force swings "bob") 1e-7))
    (test-assert "its bearing lets it turn"
      (close? #(0 0 0) (joint-moment swings "bob") 1e-7))))
(run! #:until 0.5)
(test-pull "a pendulum on its way" swings 2)
(test-assert "a callback reads the same"
  (close? (joint-force swings "bob") (slot (link-body swings "bob") 'pull) 1e-12))
;; the bottom: between two instants of different sides
(let loop ((h 1/16))
  (when (> h 1e-7)
    (let ((before (checkpoint)))
      (run-for! h)
      (cond ((negative? (joint-position swings "bob")) (restore! before) (loop (/ h 2)))
            (else (loop h))))))
(let ((w (joint-velocity swings "bob")))
  (test-assert "it fell through the bottom at the speed that energy gives"
    (close? (/ (* 2 g) I/m) (* w w) 1e-6))
  (test-assert "where m g + m v^2/l carries it"
    (close? (vector 0 0 (+ (* 2 g) (* 2 w w))) (joint-force swings "bob") 1e-4)))
(test-assert "the other one still hangs" (close? (vector 0 0 (* 2 g)) (joint-force still "bob") 1e-6))

;; observers of frames read the same, at the frame's time
(reset!)
(scene #:fps 20)
(define watched (bob-on-a-string "watched" 0))
(set! (joint-position watched "bob") (/ (acos -1) 2))
(define in-frames '())
(add-callback! (link-body watched "bob")
  (lambda (time bob) (set! (slot bob 'pull) time))
  #:period 1/5)
(observe! 'frame
  (lambda (frame)
    (match (frame-views frame)
      ((bob)
       (set! in-frames
             (cons (list (frame-time frame) (joint-position bob "bob") (joint-velocity bob "bob")
                         (joint-force bob "bob") (joint-moment bob "bob") (kinetic-energy bob)
                         (slot bob 'pull) (jacobian bob "bob"))
                   in-frames))))))
(run! #:until 0.5)
(test-equal "a frame every 1/20 s" 11 (length in-frames))
(for-each
 (match-lambda
   ((time q w force moment energy told jacobian)
    (let ((a (/ (* -1 g (sin q)) I/m))
          (inwards (vector (sin q) 0 (cos q))) (along (vector (- (cos q)) 0 (sin q))))
      (test-assert (format #f "frame at ~a s: what its joint carries" time)
        (close? (v* 2 (v+ (v* (+ (* g (cos q)) (* w w)) inwards) (v* (+ a (* g (sin q))) along)))
                force 1e-7))
      (test-assert "its bearing lets it turn" (close? #(0 0 0) moment 1e-7))
      (test-assert "its energy is what it fell" (close? (* 2 g (cos q)) energy 1e-5))
      (test-assert "its slot is that of the last call" (close? (/ (floor (* 5 (+ time 1e-9))) 5) told 1e-9))
      (test-assert "its Jacobian is the joint's axis"
        (close? 1 (array-ref jacobian 4 0) 1e-12)))))
 in-frames)
(test-assert "in the last frame as at the prompt"
  (close? (joint-force watched "bob") (list-ref (first in-frames) 3) 1e-12))

;; an arm held level by a servo, a crate welded on; a piston; loads come through
(reset!)
(define arm
  (add-multibody! #:name "arm" #:position #(0 0 2)
    (link "boom" #:joint (revolute #:axis #(0 1 0)) #:mass 3
          #:shape (placed (box 1 0.1 0.1) #:position #(0.5 0 0))
      (link "crate" #:joint (weld #:at #(1 0 0)) #:mass 5
            #:shape (placed (box 0.2 0.2 0.2) #:position #(0.1 0 0))))))
(set! (joint-servo arm "boom") (servo #:target 0 #:stiffness 1e5 #:damping 1e3))
(define lift*
  (add-multibody! #:name "lift" #:position #(5 0 0)
    (link "platform" #:joint (prismatic #:axis #(0 0 1)) #:mass 4 #:shape (box 1 1 0.1))))
(set! (joint-torque lift* "platform") 60)
(define passenger (add-body! #:name "passenger" #:shape (box 0.2 0.2 0.2) #:mass 1
                             #:position #(5.3 0 0.15)))
(run! #:until 2)
(test-assert "a weld carries what is welded on" 
  (and (close? (vector 0 0 (* 5 g)) (joint-force arm "crate") 1e-3)
       (close? (vector 0 (* -0.1 5 g) 0) (joint-moment arm "crate") 1e-3)))
(test-assert "the joint carries both"
  (and (close? (vector 0 0 (* 8 g)) (joint-force arm "boom") 1e-3)
       (close? (vector 0 (* -1 g (+ (* 0.5 3) (* 1.1 5))) 0) (joint-moment arm "boom") 2e-3)))
(test-assert "along its axis a piston pushes by what it is given"
  (close? 60 (vector-ref (joint-force lift* "platform") 2) 1e-9))
(test-assert "across it bears the passenger's side"
  (let ((load (vector-ref (net-contact-force passenger) 2)))
    (close? (* -0.3 load) (vector-ref (joint-moment lift* "platform") 1) 0.01)))
(define floats (add-multibody! #:name "floats" #:base 'free #:position #(0 8 5)
                 (link "hull" #:shape (sphere 0.2))))
(test-message "what floats hangs on nothing" "hull of floats is free" (joint-force floats "hull"))
(test-message "no such joint" "has no link or joint elbow" (joint-force arm "elbow"))
(test-message "no multibody" "joint-moment is 5" (joint-moment 5 "x"))

;; at rest on the ground a joint carries what the ground does not
(reset!)
(ground)
(define flail
  (add-multibody! #:name "flail" #:base 'free #:position #(0 0 0.1)
    (link "ball" #:mass 1 #:shape (sphere 0.1)
      (link "end" #:joint (revolute #:axis #(0 1 0) #:at #(0.15 0 0)) #:mass 1
            #:shape (placed (box 0.2 0.2 0.2) #:position #(0.15 0 0))))))
(set-contact-parameters! #t #t #:restitution 0)
(run! #:until 5)
(test-assert "at rest: forces on each link are in balance"
  (let ((end (link-body flail "end")))
    (close? (vector 0 0 (* g 1)) (v+ (joint-force flail "end") (net-contact-force end)) 0.05)))

;; ---- springs and holds ----

(reset!)
(define (weight* name x z)
  (add-body! #:name name #:shape (sphere 0.05) #:mass 2 #:position (vector x 0 z)
             #:slots '((pull . #f) (turn . #f))))
(define (hook* name x)
  (add-body! #:name name #:shape #f #:fixed? #t #:position (vector x 0 2)
             #:mass 1 #:inertia #(1 1 1) #:center-of-mass #(0 0 0)))
(define nail (hook* "nail" 0))
(define quiet (weight* "quiet" 0 (- 1.5 (/ (* 2 g) 200))))
(add-spring! quiet nail #:stiffness 200 #:rest 0.5)
(define bounces (weight* "bounces" 2 1.3))
(define nail-2 (hook* "nail-2" 2))
(add-spring! nail-2 bounces #:stiffness 200 #:rest 0.5)
(define upper (weight* "upper" 4 3))
(define lower (weight* "lower" 4 2.4))
(add-spring! upper lower #:stiffness 300 #:damping 2 #:rest 0.5)
(add-callback! (list bounces nail-2)
  (lambda (time bounces nail-2) (set! (slot bounces 'pull) (spring-force nail-2 bounces)))
  #:period 0.35)
(add-callback! (list upper lower)
  (lambda (time upper lower) (set! (slot upper 'pull) (spring-force lower upper)))
  #:period 0.35)
(test-assert "before any run: a spring that is 0.2 m too long"
  (close? #(0 0 40) (spring-force bounces nail-2) 1e-9))
(run! #:until 0.7)
(test-assert "a weight at rest on a spring" (close? (vector 0 0 (* 2 g)) (spring-force quiet nail) 1e-4))
(test-assert "the nail feels the opposite" (close? (vector 0 0 (* -2 g)) (spring-force nail quiet) 1e-4))
;; z = 1.5 - m g/k - A cos wt, A = 0.2 - m g/k: the spring is m g/k + A cos wt too long
(let* ((A (- 0.2 (/ (* 2 g) 200))) (stretch (+ (/ (* 2 g) 200) (* A (cos (* 10 0.7))))))
  (test-assert "a weight that swings on one"
    (close? (vector 0 0 (* 200 stretch)) (spring-force bounces nail-2) 1e-4))
  (test-assert "a callback reads the same"
    (close? (v* -1 (spring-force bounces nail-2)) (slot bounces 'pull) 1e-12)))
(let ((l (- (vector-ref (position upper) 2) (vector-ref (position lower) 2)))
      (v (- (vector-ref (velocity upper) 2) (vector-ref (velocity lower) 2))))
  (test-assert "between two that move, damping included"
    (close? (vector 0 0 (+ (* 300 (- l 0.5)) (* 2 v))) (spring-force lower upper) 1e-9))
  (test-assert "the two are opposite"
    (close? #(0 0 0) (v+ (spring-force lower upper) (spring-force upper lower)) 1e-12))
  (test-assert "in a callback, too"
    (close? (spring-force lower upper) (slot upper 'pull) 1e-9)))
(test-equal "no spring, no force" #(0.0 0.0 0.0) (spring-force quiet bounces))
(test-equal "springs are no holds" #(0.0 0.0 0.0) (hold-force quiet nail))

(reset!)
(define wall* (add-body! #:name "wall" #:shape (box 0.2 1 1) #:fixed? #t #:position #(-0.1 0 2)))
(define shelf (add-body! #:name "shelf" #:shape (box 0.4 0.1 0.1) #:mass 2 #:position #(0.3 0 2)))
(define pot (add-body! #:name "pot" #:shape (box 0.1 0.1 0.1) #:mass 1 #:position #(0.6 0 2)
                       #:slots '((pull . #f))))
(attach! shelf wall* #:at #(-0.3 0 0))
(attach! pot shelf #:at #(-0.1 0 0))
(add-callback! (list pot shelf)
  (lambda (time pot shelf) (set! (slot pot 'pull) (list (hold-force pot shelf) (hold-torque pot shelf))))
  #:period 0.5)
(run! #:until 2)
(test-assert "a hold carries both by its force"
  (close? (vector 0 0 (* 3 g)) (hold-force shelf wall*) 1e-3))
(test-assert "and by its torque about where it holds"
  (close? (vector 0 (* -1 g (+ (* 2 0.3) (* 1 0.6))) 0) (hold-torque shelf wall*) 0.02))
(test-assert "the wall feels the opposite"
  (and (close? #(0 0 0) (v+ (hold-force wall* shelf) (hold-force shelf wall*)) 1e-9)
       (close? #(0 0 0) (v+ (hold-torque wall* shelf) (hold-torque shelf wall*)) 1e-9)))
(test-assert "the pot's hold"
  (and (close? (vector 0 0 g) (hold-force pot shelf) 1e-3)
       (close? (vector 0 (* -0.1 g) 0) (hold-torque pot shelf) 0.02)
       (close? #(0 0 0) (v+ (hold-torque pot shelf) (hold-torque shelf pot)) 1e-9)))
(test-assert "a callback reads the same"
  (and (close? (hold-force pot shelf) (first (slot pot 'pull)) 1e-9)
       (close? (hold-torque pot shelf) (second (slot pot 'pull)) 1e-9)))
(detach! pot shelf)
(test-equal "what is let go is not held" #(0.0 0.0 0.0) (hold-force pot shelf))
(test-message "one body alone" "the second body is 7" (hold-force pot 7))
(test-refused "of two bodies one must be read by a view" "spring-force was used inside a callback"
              (plate other) (spring-force plate other))

(test-end "sensors")
