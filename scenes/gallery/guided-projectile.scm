;;; Two darts are shot at drones that weave: the red one steers by its instruments and brings its drone down;
;;; the grey one flies to where its drone was.
;;;
;;; The line of sight to what is hit without steering keeps its direction.  So the dart accelerates across it,
;;; 4 v w for a line that turns at w while the two close at v (proportional navigation).  What its accelerometer
;;; misses of that, gravity and drag included, is added to its thrust, a hundred times a second.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Guided projectile" #:duration 3)

(define-scene-parameter speed 22 "m/s, at which the darts are shot")
(define-scene-parameter weave 4 "m, how far the drones weave")

(define gravity 9.81)
(define period 0.01)
(define pi (acos -1))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

;; ---- drones: held on a path, upright, until they are struck ----

(define (path middle time)
  (let ((w (* 2/3 pi)))
    (v+ middle (vector 0 (* weave (sin (* w time))) (* 0.3 weave (sin (* 1.7 w time)))))))
(define (difference f time h) (v* (/ 1 (* 2 h)) (v- (f (+ time h)) (f (- time h)))))

(define (fly middle)
  (define (place time) (path middle time))
  (define (place-rate time) (difference place time 1e-3))
  (lambda (time drone)
    (if (slot drone 'flies?)
        (let* ((m (body-mass drone))
               (pull (v+ (v* 25 (v- (place time) (position drone)))
                         (v* 10 (v- (place-rate time) (velocity drone)))))
               (lean (cross (rotate (orientation drone) #(0 0 1)) #(0 0 1))))
          (set! (applied-force drone)
                (v* m (v+ (vector 0 0 gravity) (v+ pull (difference place-rate time 1e-3)))))
          (set! (applied-torque drone)
                (v* (* 0.5 m) (v- (v* 60 lean) (v* 12 (angular-velocity drone))))))
        (begin (set! (applied-force drone) #(0 0 0))
               (set! (applied-torque drone) #(0 0 0))))))

(define hull
  (apply union (box 1 1 0.5)
         (append-map (lambda (x)
                       (map (lambda (y)
                              (placed (cylinder 0.7 0.12) #:position (vector x y 0.3)))
                            '(-0.9 0.9)))
                     '(-0.9 0.9))))

(define (drone! name middle)
  (let ((drone (add-body! #:name name #:shape hull #:density 60 #:color #(0.25 0.45 0.75)
                          #:position (path middle 0)
                          #:velocity (difference (lambda (time) (path middle time)) 0 1e-3)
                          #:slots '((flies? . #t)))))
    (add-callback! drone (fly middle) #:period period)
    drone))

;; ---- darts: their axis is z ----

(define dart-shape
  (union (cylinder 0.15 1.6) (placed (cone 0.15 0.4) #:position #(0 0 0.9))
         (placed (box 0.7 0.04 0.35) #:position #(0 0 -0.62))
         (placed (box 0.04 0.7 0.35) #:position #(0 0 -0.62))))

(define most (* 12 gravity))   ; m/s^2, of the thrusters
(define (limited v) (let ((length (norm v))) (if (> length most) (v* (/ most length) v) v)))

(define (across v) (vector (vector-ref v 0) (vector-ref v 1) 0))

(define (guide time dart drone)
  (let* ((m (body-mass dart)) (q (orientation dart)))
    (if (slot dart 'guided?)
        (let* ((r (v- (position drone) (position dart)))
               (v (v- (velocity drone) (velocity dart)))
               (turning (v* (/ 1 (dot r r)) (cross r v)))
               (wanted (cross (v* 4 turning) (v* -1 v)))
               ;; what is to be felt, and what is, both in the world's axes
               (missing (v- (v+ wanted (vector 0 0 gravity)) (rotate q (accelerometer dart))))
               ;; the nose into the wind
               (off (cross #(0 0 1) (rotate (q-conjugate q) (normalize (velocity dart))))))
          (set! (applied-force dart)
                (v* m (limited (v+ (v* (/ 1 m) (applied-force dart)) missing))))
          ;; it is left to roll as it likes, so little it resists that
          (set! (applied-torque dart)
                (rotate q (across (v* (* 0.3 m) (v- (v* 200 off) (v* 25 (gyro dart))))))))
        (begin (set! (applied-force dart) #(0 0 0))
               (set! (applied-torque dart) #(0 0 0))))))

;; From a point to where the drone is now, as a stone would be thrown there.
(define (dart! name from drone color guided?)
  (let* ((there (v- (position drone) from))
         (drop (* 1/2 gravity (/ (dot there there) (* speed speed))))
         (way (normalize (v+ there (vector 0 0 drop))))
         (axis (cross #(0 0 1) way))
         (dart (add-body! #:name name #:shape dart-shape #:density 150 #:color color #:position from
                          #:orientation (rotation axis (acos (dot #(0 0 1) way)))
                          #:velocity (v* speed way) #:slots `((guided? . ,guided?)))))
    (add-drag! dart #:quadratic 0.02)
    (when guided? (add-callback! (list dart drone) guide #:period period))
    (on-collision! dart drone
      (lambda (collision dart drone)
        (set! (slot dart 'guided?) #f)
        (set! (slot drone 'flies?) #f)))
    dart))

(define target (drone! "target" #(30 5 10)))
(define other (drone! "other" #(30 -6 10)))
(dart! "guided" #(0 5 2) target #(0.75 0.25 0.20) #t)
(dart! "unguided" #(0 -6 2) other #(0.55 0.57 0.60) #f)

(camera #:eye #(9 -25 11) #:target #(20 0 7.5) #:fov 0.85)
