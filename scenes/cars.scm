;;; Four cars drive courses with speed bumps through an array of spherical pendulums.  Every car is a
;;; multibody of seven bodies: chassis, two steering knuckles, four wheels.  A controller holds the
;;; speeds of the wheels and the angles of the knuckles, so that the car goes from waypoint to
;;; waypoint.  After B. Mirtich, Timewarp Rigid Body Simulation (2000), table 1.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(define-scene-parameter rows 20 "rows of pendulums, and beams they hang from")
(define-scene-parameter columns 20 "pendulums in a row")
(define-scene-parameter cars 4 "cars, 1 to 4")
(define-scene-parameter rate 50 "Hz of the controllers")
(define-scene-parameter cruise 6.5 "m/s on straights")

(scene #:title "Cars" #:duration 60 #:accuracy 1e-5)

(define pi (acos -1))
(define spacing 2.6)                       ; m, of the pendulums
(define height 3.1)                        ; m, from where they hang
(define hang 2.25)                         ; m, to the middle of a bob
(define half-x (* 0.5 spacing (1- columns)))
(define half-y (* 0.5 spacing (1- rows)))
(define margin 11)                         ; m of open ground around the array

(set-contact-parameters! #t #t #:restitution 0.3 #:friction 0.5)
(set-contact-parameters! 'rubber #t #:restitution 0 #:friction 0.9)

;; ---- what stands: ground, beams on posts, speed bumps, a fence, posts that mark the ground ----

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(define (row-y row) (- (* spacing row) half-y))
(define (column-x column) (- (* spacing column) half-x))

(define beams
  (map (lambda (row)
         (add-body! #:name (format #f "beam-~a" row) #:fixed? #t #:color #(0.42 0.4 0.38)
                    #:shape (box (+ (* 2 half-x) 2) 0.1 0.14)
                    #:position (vector 0 (row-y row) (+ height 0.08))))
       (iota rows)))

(for-each (lambda (row)
            (for-each (lambda (side)
                        (add-body! #:name (format #f "post-~a-~a" row side) #:fixed? #t
                                   #:color #(0.42 0.4 0.38) #:shape (box 0.14 0.14 (+ height 0.01))
                                   #:position (vector (* side (+ half-x 0.93)) (row-y row)
                                                      (* 0.5 (+ height 0.01)))))
                      '(-1 1)))
          (iota rows))

;; A flat hump across the way of the cars, where they turn outside of the array.
(define (add-bump! name x y along-y?)
  (add-body! #:name name #:fixed? #t #:color #(0.95 0.75 0.1)
             #:shape (let ((across (if along-y? (lambda (a b c) (vector b a c)) vector)))
                       (convex (append-map
                                (lambda (y)
                                  (list (across -0.6 y 0) (across -0.25 y 0.09)
                                        (across 0.25 y 0.09) (across 0.6 y 0)))
                                '(-2 2))))
             #:position (vector x y 0)))

(define out-x (+ half-x 6))
(define out-y (+ half-y 6))

(for-each (lambda (k)
            (let ((x (* (- k 2) 0.4 half-x)))
              (add-bump! (format #f "bump-south-~a" k) x (- out-y) #f)
              (add-bump! (format #f "bump-north-~a" k) x out-y #f)))
          (iota 5))

(for-each (lambda (name x y sx sy)
            (add-body! #:name name #:fixed? #t #:color #(0.55 0.42 0.3)
                       #:shape (box sx sy 0.5) #:position (vector x y 0.25)))
          '("fence-south" "fence-north" "fence-west" "fence-east")
          (list 0 0 (- (+ half-x margin)) (+ half-x margin))
          (list (- (+ half-y margin)) (+ half-y margin) 0 0)
          (list (* 2 (+ half-x margin)) (* 2 (+ half-x margin)) 0.2 0.2)
          (list 0.2 0.2 (* 2 (+ half-y margin)) (* 2 (+ half-y margin))))

(for-each (lambda (k)
            (let ((angle (* 2 pi (/ k 21))))
              (add-body! #:name (format #f "mark-~a" k) #:fixed? #t #:color #(0.9 0.35 0.15)
                         #:shape (cylinder 0.12 0.8)
                         #:position (vector (* (+ half-x 9.8) (max -1 (min 1 (* 1.4 (cos angle)))))
                                            (* (+ half-y 9.8) (max -1 (min 1 (* 1.4 (sin angle)))))
                                            0.4))))
          (iota 21))

;; ---- pendulums: a bob on a rod, on a spherical joint under a beam ----

(define (add-pendulum! row column)
  (let* ((share-x (/ column (max 1 (1- columns)))) (share-y (/ row (max 1 (1- rows)))))
    (add-multibody! #:name (format #f "pendulum-~a-~a" row column) #:base (list-ref beams row)
                    #:position (vector (column-x column) 0 -0.08)
      (link 'bob #:joint (spherical #:damping 0.3) #:density 120
            #:shape (union (placed (sphere 0.24) #:position (vector 0 0 (- hang)))
                           (placed (cylinder 0.02 (- hang 0.25))
                                   #:position (vector 0 0 (* -0.5 (- hang 0.25)))))
            #:color (vector (+ 0.25 (* 0.65 share-x)) (+ 0.3 (* 0.4 (- 1 share-y)))
                            (- 0.9 (* 0.6 share-x)))))))

(for-each (lambda (row) (for-each (lambda (column) (add-pendulum! row column)) (iota columns)))
          (iota rows))

;; ---- cars ----

(define wheel-radius 0.36)
(define wheel
  (placed (cylinder wheel-radius 0.26) #:orientation (rotation #(1 0 0) (/ pi 2))))

(define (wheel-link name place)
  (link name #:joint (revolute #:axis #(0 1 0) #:at place #:damping 0.2) #:shape wheel
        #:density 300 #:material 'rubber #:color #(0.12 0.12 0.13)))

(define (knuckle-link name place wheel-name)
  (link name #:joint (revolute #:axis #(0 0 1) #:at place #:limits '(-0.7 0.7))
        #:shape (box 0.12 0.1 0.16) #:density 2000
    (wheel-link wheel-name #(0 0 0))))

(define (add-car! name place heading color)
  (let ((car (add-multibody! #:name name #:base 'free #:position place
                             #:orientation (rotation #(0 0 1) heading)
               (link 'chassis #:density 450 #:color color #:slots '((next . 1))
                     #:shape (union (box 2.7 1.0 0.4)
                                    (placed (box 1.3 0.9 0.35) #:position #(-0.25 0 0.37)))
                 (knuckle-link 'knuckle-left #(0.9 0.72 -0.1) 'front-left)
                 (knuckle-link 'knuckle-right #(0.9 -0.72 -0.1) 'front-right)
                 (wheel-link 'rear-left #(-0.9 0.72 -0.1))
                 (wheel-link 'rear-right #(-0.9 -0.72 -0.1))))))
    (disable-collisions! car car)
    car))

(define (clamp x most) (max (- most) (min most x)))

;; Steers towards the next of the waypoints and keeps the wheels at the speed that the turn allows;
;; which waypoint is next is part of the state, so that a rollback takes it back.
(define (driver waypoints)
  (let ((count (vector-length waypoints)))
    (lambda (time view)
      (let* ((place (position view))
             (next (modulo (slot view 'next) count))
             (goal (vector-ref waypoints next))
             (way (rotate (q-conjugate (orientation view)) (v- goal place)))
             (bearing (atan (vector-ref way 1) (vector-ref way 0)))
             (steering (clamp (* 1.4 bearing) 0.6))
             (speed (* cruise (- 1 (* 0.75 (/ (abs steering) 0.6))))))
        (when (< (norm (vector (vector-ref way 0) (vector-ref way 1))) 2.5)
          (set! (slot view 'next) (1+ (slot view 'next))))
        (for-each (lambda (knuckle)
                    (set! (joint-servo view knuckle)
                          (servo #:target steering #:stiffness 20000 #:damping 1500
                                 #:max-torque 4000)))
                  '(knuckle-left knuckle-right))
        (for-each (lambda (wheel)
                    (set! (joint-torque view wheel)
                          (clamp (* 120 (- (/ speed wheel-radius) (joint-velocity view wheel))) 450)))
                  '(front-left front-right rear-left rear-right))))))

;; Courses: along lanes of the array, one way there, another back, over the bumps outside.
(define (lane share) (* spacing (round (* share 0.5 (1- columns)))))
(define (course x1 x2 side)
  (let ((far (* side (+ half-y 5))))
    (vector (vector x1 (- far) 0) (vector x1 0 0) (vector x1 far 0)
            (vector (* 0.5 (+ x1 x2)) (* side out-y) 0)
            (vector x2 far 0) (vector x2 0 0) (vector x2 (- far) 0)
            (vector (* 0.5 (+ x1 x2)) (* side (- out-y)) 0))))

(define courses
  (list (course (+ (lane -0.75) 1.0) (+ (lane -0.3) 1.0) 1)
        (course (- (lane 0.75) 1.0) (- (lane 0.3) 1.0) 1)
        (course (- (lane -0.55) 1.0) (- (lane -0.05) 1.0) -1)
        (course (+ (lane 0.85) 1.0) (+ (lane 0.5) 1.0) -1)))

(define colors '(#(0.85 0.12 0.1) #(0.1 0.35 0.8) #(0.95 0.7 0.05) #(0.1 0.6 0.3)))

(define all-cars
  (map (lambda (k waypoints color)
         (let* ((first (vector-ref waypoints 0))
                (south? (negative? (vector-ref first 1)))
                (heading (if south? (/ pi 2) (/ pi -2)))
                (start (vector (vector-ref first 0) ((if south? - +) (+ half-y 2.2)) 0))
                (car (add-car! (format #f "car-~a" k)
                               (v+ start (vector 0 0 (+ wheel-radius 0.1))) heading color)))
           (add-callback! car (driver waypoints) #:period (/ 1.0 rate))
           car))
       (iota cars) (take courses cars) (take colors cars)))

(camera #:eye (vector (* -1.15 half-x) (* -1.75 half-y) 14) #:target #(0 -3 0.5) #:fov 0.8)
