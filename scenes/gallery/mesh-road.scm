;;; A car on a road that is one mesh of 100,000 triangles: banked, bumpy, with a kerb on either side.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "A road of triangles" #:duration 12 #:accuracy 1e-4)

(define-scene-parameter lengthwise 2500 "cells along the road")
(define-scene-parameter across 20 "cells across")
(define-scene-parameter speed 5 "m/s that the car's wheels are driven at")

(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.6)
(set-contact-parameters! 'rubber #t #:restitution 0 #:friction 0.9)

;; ---- the road, from its middle line ----

(define road-length 70)                    ; m
(define half-width 3)
(define (middle s) (* 4 (sin (* 0.09 s)))) ; y of the middle line at x = s
(define (height s)
  (+ (* 0.9 (sin (* 0.13 s))) (* 0.03 (sin (* 2.9 s))) (* 0.02 (sin (+ 1 (* 7.3 s))))))
(define (bank s) (* 0.12 (sin (* 0.09 s)))) ; inwards, in curves
(define (profile u)                        ; m over the road at u metres beside its middle
  (let ((beside (- (abs u) (- half-width 0.5))))
    (+ (if (> beside 0) (* 0.18 (- 1 (expt (- 1 (min 1 (/ beside 0.15))) 2))) 0)
       (* 0.008 (sin (* 11 u))))))
(define (road-point row column)
  (let* ((s (* road-length (/ row lengthwise)))
         (u (* half-width (- (/ (* 2.0 column) across) 1))))
    (vector s (+ (middle s) u) (+ (height s) (* -1 u (bank s)) (profile u)))))
(define (point-number row column) (+ column (* (1+ across) row)))
(define road
  (triangle-mesh
   (append-map (lambda (row) (map (lambda (column) (road-point row column)) (iota (1+ across))))
               (iota (1+ lengthwise)))
   (append-map (lambda (row)
                 (append-map (lambda (column)
                               (let ((a (point-number row column))
                                     (b (point-number (1+ row) column))
                                     (c (point-number (1+ row) (1+ column)))
                                     (d (point-number row (1+ column))))
                                 (list (vector a b c) (vector a c d))))
                             (iota across)))
               (iota lengthwise))))
(add-body! #:name "road" #:shape road #:fixed? #t #:color #(0.45 0.46 0.48))

(add-body! #:name "meadow" #:shape (half-space #(0 0 1) -1.6) #:fixed? #t #:color #(0.36 0.42 0.22))

;; ---- the car: a body, two knuckles that steer, four wheels ----

(define radius 0.36)                       ; m, of the wheels
(define (wheel name place)
  (link name #:joint (revolute #:axis #(0 1 0) #:at place #:damping 0.2)
        #:shape (placed (cylinder radius 0.26) #:orientation (rotation #(1 0 0) (acos 0)))
        #:density 300 #:material 'rubber #:color #(0.12 0.12 0.13)))
(define (knuckle name place wheel-name)
  (link name #:joint (revolute #:axis #(0 0 1) #:at place #:limits '(-0.6 0.6))
        #:shape (box 0.12 0.1 0.16) #:density 2000
    (wheel wheel-name #(0 0 0))))

(define start 2)
(define car
  (add-multibody! #:name "car" #:base 'free
                  #:position (vector start (middle start) (+ (height start) radius 0.3))
                  #:orientation (rotation #(0 0 1) (atan (* 4 0.09)))
    (link 'chassis #:density 450 #:color #(0.8 0.12 0.1)
          #:shape (union (box 2.7 1.0 0.4) (placed (box 1.3 0.9 0.35) #:position #(-0.25 0 0.37)))
      (knuckle 'knuckle-left #(0.9 0.72 -0.1) 'front-left)
      (knuckle 'knuckle-right #(0.9 -0.72 -0.1) 'front-right)
      (wheel 'rear-left #(-0.9 0.72 -0.1))
      (wheel 'rear-right #(-0.9 -0.72 -0.1)))))
(disable-collisions! car car)

(define (clamp x most) (max (- most) (min most x)))

;; Steers for the middle of the road some metres ahead.
(define (drive time view)
  (let* ((place (position view))
         (ahead (+ (vector-ref place 0) 4))
         (way (rotate (q-conjugate (orientation view))
                      (v- (vector ahead (middle ahead) (vector-ref place 2)) place)))
         (steering (clamp (* 1.2 (atan (vector-ref way 1) (vector-ref way 0))) 0.5)))
    (for-each (lambda (knuckle)
                (set! (joint-servo view knuckle)
                      (servo #:target steering #:stiffness 20000 #:damping 1500 #:max-torque 4000)))
              '(knuckle-left knuckle-right))
    (for-each (lambda (wheel)
                (set! (joint-torque view wheel)
                      (clamp (* 120 (- (/ speed radius) (joint-velocity view wheel))) 400)))
              '(front-left front-right rear-left rear-right))))
(add-callback! car drive #:period 1/50)

(camera #:eye #(6.5 -2.5 5.5) #:target #(21 3 -0.6) #:fov 0.8)
(light #:direction #(-0.4 0.5 -0.8) #:color #(1.0 0.95 0.86))
(sky #:zenith #(0.22 0.42 0.72) #:horizon #(0.74 0.83 0.92) #:ground #(0.46 0.45 0.42) #:fog 0.002)
