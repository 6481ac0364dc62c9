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

(test-end "sensors")
