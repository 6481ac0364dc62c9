;;; A catapult: a spring at the arm's joint is cocked by a servo, which lets go after a second; the arm
;;; flies up to its stop and throws a stone at a wall.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Catapult" #:duration 5 #:accuracy 1e-5)

(define-scene-parameter stiffness 6000 "N m/rad of the spring")
(define-scene-parameter rows 6 "rows of the wall")

(define wood #(0.5 0.34 0.18))
(define dark-wood #(0.36 0.24 0.13))
(define cocked -0.35)                      ; rad: the arm lies back, above the level
(define arm-length 2.2)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.6)

;; ---- the frame, one fixed body ----

(define (post y)
  (placed (box 0.16 0.12 1.5) #:position (vector 0 y 0.75)))

(add-body! #:name "frame" #:fixed? #t #:color dark-wood
           #:shape (union (post 0.45) (post -0.45)
                          (placed (box 2.4 0.12 0.14) #:position #(0 0.45 0.09))
                          (placed (box 2.4 0.12 0.14) #:position #(0 -0.45 0.09))
                          (placed (box 0.12 0.78 0.12) #:position #(0.22 0 1.62))
                          (placed (box 0.12 0.12 0.32) #:position #(0.22 0.45 1.52))
                          (placed (box 0.12 0.12 0.32) #:position #(0.22 -0.45 1.52))))

;; ---- the arm: level and backwards at 0, upright at pi/2, where its stop is ----

(define cup
  (union (box 0.4 0.4 0.05)
         (placed (box 0.05 0.4 0.2) #:position #(0.175 0 0.1))
         (placed (box 0.05 0.4 0.2) #:position #(-0.175 0 0.1))
         (placed (box 0.3 0.05 0.2) #:position #(0 0.175 0.1))
         (placed (box 0.3 0.05 0.2) #:position #(0 -0.175 0.1))))

(define catapult
  (add-multibody! #:name 'catapult #:position #(0 0 0.9)
    (link 'arm #:joint (revolute #:axis #(0 1 0) #:limits '(-0.45 1.45) #:restitution 0.1
                                 #:stiffness stiffness #:rest 1.6)
          #:shape (placed (box arm-length 0.12 0.12) #:position (vector (- 0.1 (/ arm-length 2)) 0 0))
          #:density 600 #:color wood
      (link 'cup #:joint (weld #:at (vector (- 0.1 arm-length) 0 0.085)) #:shape cup #:density 600
            #:color dark-wood))))
(disable-collisions! catapult (find-body "frame"))

(set! (joint-position catapult 'arm) cocked)
(set! (joint-servo catapult 'arm) (servo #:target cocked #:stiffness 1e7 #:damping 1e5))
(add-callback! catapult (lambda (time view) (set! (joint-servo view 'arm) #f) #f) #:start 1)

;; in the cup
(call-with-values (lambda () (forward-kinematics catapult (joint-positions catapult) 'cup))
  (lambda (place turned)
    (add-body! #:name "stone" #:shape (sphere 0.15) #:density 2600 #:color #(0.42 0.42 0.44)
               #:position (v+ place (rotate turned #(0 0 0.176))))))

;; ---- the wall ----

(define brick (box 0.5 1.0 0.5))
(for-each
 (lambda (row)
   (for-each
    (lambda (column)
      (add-body! #:name (format #f "brick-~a-~a" row column) #:shape brick #:density 120
                 #:position (vector 14 (+ (* 1.001 (- column 1.5)) (* 0.5 (modulo row 2)))
                                    (+ 0.25 (* 0.5 row)))
                 #:color (vector (+ 0.62 (* 0.06 (modulo (+ row (* 2 column)) 3))) 0.34 0.24)))
    (iota 4)))
 (iota rows))

(camera #:eye #(2.5 -13 4.5) #:target #(5.8 0 1.8) #:fov 0.85)
