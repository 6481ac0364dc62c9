;;; An arm of four joints under PD control, written in Scheme: its hand follows a path that inverse
;;; kinematics turns into angles, and sweeps a tower of boxes from the table.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Arm under PD control" #:duration 8 #:accuracy 1e-5)

(define-scene-parameter rate 200 "Hz of the controller")
(define-scene-parameter boxes 8 "boxes of the tower")

(define pi (acos -1))
(define steel #(0.55 0.58 0.62))
(define orange #(0.95 0.45 0.08))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(add-body! #:name "table" #:shape (box 0.7 1.6 0.5) #:fixed? #t #:position #(0.95 0 0.25)
           #:color #(0.55 0.38 0.22))
(define pedestal
  (add-body! #:name "pedestal" #:shape (cylinder 0.18 0.5) #:fixed? #t #:position #(0 0 0.25)
             #:color #(0.25 0.26 0.28)))

(define (beam length width)
  (placed (box (+ length width) width width) #:position (vector (/ length 2) 0 0)))

(define arm
  (add-multibody! #:name 'arm #:base pedestal #:position #(0 0 0.25)
    (link 'turret #:joint (revolute #:axis #(0 0 1))
          #:shape (placed (cylinder 0.14 0.16) #:position #(0 0 0.1)) #:color steel
      (link 'upper #:joint (revolute #:axis #(0 1 0) #:at #(0 0 0.25) #:limits '(-2.6 0.6))
            #:shape (beam 0.6 0.1) #:density 500 #:color orange
        (link 'fore #:joint (revolute #:axis #(0 1 0) #:at #(0.6 0 0) #:limits '(0 2.7))
              #:shape (beam 0.55 0.08) #:density 500 #:color orange
          (link 'hand #:joint (revolute #:axis #(0 1 0) #:at #(0.55 0 0) #:limits '(-2 2))
                #:shape (union (beam 0.12 0.06)
                               (placed (sphere 0.07) #:position #(0.18 0 0)))
                #:color steel))))))
(disable-collisions! arm arm)

;; the tower
(for-each (lambda (i)
            (add-body! #:name (format #f "box-~a" i) #:shape (box 0.12 0.12 0.1)
                       #:density 300 #:position (vector 0.85 0.25 (+ 0.55 (* 0.1 i)))
                       #:orientation (rotation #(0 0 1) (* 0.35 i))
                       #:color (vector (+ 0.2 (* 0.09 i)) (- 0.75 (* 0.05 i)) 0.35)))
          (iota boxes))

;; ---- the path: circles in the air, then a sweep along the table ----

(define (smooth s) (* s s s (+ 10 (* s (- (* 6 s) 15)))))

(define (hand-at time)
  (if (< time 5)
      (let ((angle (* 2 pi (smooth (/ time 5)))))
        (vector (+ 0.75 (* 0.15 (cos (* 2 angle)))) (- (* -0.3 (cos angle)) 0.25)
                (+ 1.0 (* 0.25 (sin (* 3 angle))))))
      (let ((s (smooth (min 1 (/ (- time 5) 2)))))
        (vector (+ 0.9 (* -0.05 s)) (+ -0.55 (* 1.2 s)) (- 1.0 (* 0.3 (min 1 (* 3 s))))))))

(define (angles-at view time)
  (or (inverse-kinematics view 'hand #:position (hand-at time) #:point #(0.18 0 0))
      (joint-positions view)))

(add-callback! arm
  (let ((step (/ 1.0 rate)))
    (lambda (time view)
      (let* ((q (joint-positions view)) (qd (joint-velocities view))
             (wanted (angles-at view time))
             (rates (v* (/ 1 step) (v- (angles-at view (+ time step)) wanted))))
        ;; computed torques: the arm's own dynamics, and a stiff spring and damper on the error
        (set! (joint-torques view)
              (inverse-dynamics view q qd
                                (v+ (v* 400 (v- wanted q)) (v* 40 (v- rates qd))))))))
  #:period (/ 1.0 rate))

;; where it begins
(let ((start (inverse-kinematics arm 'hand #:position (hand-at 0) #:point #(0.18 0 0)
                                 #:start #(0 -1 1.5 0.5))))
  (set! (joint-positions arm) start))

(camera #:eye #(2.6 -2.0 1.7) #:target #(0.6 0 0.75) #:fov 0.75)
