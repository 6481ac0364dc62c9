;;; A gripper on a gantry picks cubes from the floor and builds a tower of them: what holds a cube is
;;; friction alone, between fingers that servos press together.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1) (ice-9 match))

(scene #:title "Gripper" #:duration 26 #:accuracy 1e-4)

(define-scene-parameter cubes 4 "cubes of the tower")

(define side 0.12)                         ; m, of a cube
(define turn 6.0)                          ; s for each cube
(define tower-x 0.55)
(define high -0.25)                        ; m, of the palm against the gantry, when it carries
(define rail 1.05)                         ; m, height of the gantry
(define reach 0.2)                         ; m, from the palm to the middle of a held cube

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(add-body! #:name "rail" #:shape (box 2.2 0.1 0.08) #:fixed? #t #:color #(0.3 0.31 0.34)
           #:position (vector 0 0 (+ rail 0.1)))
(for-each (lambda (x)
            (add-body! #:name (format #f "post~a" x) #:shape (box 0.1 0.1 (+ rail 0.14)) #:fixed? #t
                       #:color #(0.3 0.31 0.34) #:position (vector x 0.0 (/ (+ rail 0.14) 2))))
          '(-1.15 1.15))
(set-contact-parameters! #t #t #:restitution 0 #:friction 0.6)

(define finger (placed (box 0.03 0.1 0.2) #:position #(0 0 -0.13)))
(define gantry
  (add-multibody! #:name 'gantry #:position (vector 0 0 rail)
    (link 'carriage #:joint (prismatic #:axis #(1 0 0) #:limits '(-1 1)) #:shape (box 0.2 0.16 0.08)
          #:color #(0.9 0.6 0.1)
      (link 'palm #:joint (prismatic #:axis #(0 0 1) #:limits '(-0.9 0))
            #:shape (union (placed (box 0.34 0.12 0.05) #:position #(0 0 -0.05))
                           (placed (box 0.05 0.05 0.9) #:position #(0 0 0.42)))
            #:density 800 #:color #(0.85 0.3 0.1)
        (link 'left #:joint (prismatic #:axis #(1 0 0) #:at #(-0.13 0 0) #:limits '(-0.03 0.1))
              #:shape finger #:color #(0.2 0.22 0.25))
        (link 'right #:joint (prismatic #:axis #(-1 0 0) #:at #(0.13 0 0) #:limits '(-0.03 0.1))
              #:shape finger #:color #(0.2 0.22 0.25))))))
(disable-collisions! gantry gantry)
(disable-collisions! gantry (find-body "rail"))

(define (cube-x k) (- (* 0.26 k) 0.8))
(for-each (lambda (k)
            (add-body! #:name (format #f "cube-~a" k) #:shape (box side side side) #:density 400
                       #:position (vector (cube-x k) 0 (/ side 2))
                       #:color (vector (+ 0.25 (* 0.2 k)) 0.45 (- 0.85 (* 0.2 k)))))
          (iota cubes))

;; ---- where carriage and palm shall be: (time x z closed?) for cube k, from its turn's start ----

(define (palm-at height) (- (+ height reach) rail))

(define (plan k)
  (let ((pick (palm-at (/ side 2))) (lay (palm-at (+ (* side k) (/ side 2) 0.001))))
    `((0.0 ,(if (zero? k) (cube-x 0) tower-x) ,high #f)
      (1.2 ,(cube-x k) ,high #f) (2.0 ,(cube-x k) ,pick #f) (2.4 ,(cube-x k) ,pick #t)
      (3.2 ,(cube-x k) ,high #t) (4.4 ,tower-x ,high #t) (5.2 ,tower-x ,lay #t)
      (5.5 ,tower-x ,lay #f) (,turn ,tower-x ,high #f))))

(define plans (map plan (iota cubes)))

(define (smooth s) (* s s (- 3 (* 2 s))))

;; x, z and whether the fingers are closed
(define (wanted time)
  (let* ((k (min (1- cubes) (inexact->exact (floor (/ time turn)))))
         (local (min turn (- time (* k turn)))))
    (let find ((entries (list-ref plans k)))
      (match entries
        (((from x z closed?) (to x* z* closed?*) . _)
         (if (<= local to)
             (let ((s (smooth (max 0 (/ (- local from) (- to from))))))
               (list (+ x (* s (- x* x))) (+ z (* s (- z* z))) closed?*))
             (find (cdr entries))))))))

(define (drive time view)
  (match-let (((x z closed?) (wanted time)) ((x* z* _) (wanted (+ time 0.01))))
    (let ((follow! (lambda (joint here there)
                     (set! (joint-servo view joint)
                           (servo #:target here #:target-velocity (* 100 (- there here))
                                  #:stiffness 2e4 #:damping 1e3)))))
      (follow! 'carriage x x*)
      (follow! 'palm z z*)
      (for-each (lambda (finger)
                  (set! (joint-servo view finger)
                        (servo #:target (if closed? 0.08 -0.02) #:stiffness 1000 #:damping 60
                               #:max-torque 40)))
                '(left right)))))

(set! (joint-position gantry 'carriage) (cube-x 0))
(set! (joint-position gantry 'palm) high)
(add-callback! gantry drive #:period 0.01)

(camera #:eye #(0.9 -2.6 1.3) #:target #(-0.05 0 0.55) #:fov 0.7)
