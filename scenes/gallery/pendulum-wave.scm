;;; A row of pendulums whose lengths are chosen so that the k-th swings k times more in a minute than
;;; the first: they begin together, drift into waves, and are together again when the minute is over.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Pendulum wave" #:duration 60)

(define-scene-parameter pendulums 15 "pendulums in the row")
(define-scene-parameter swings 24 "swings of the first in the minute")
(define-scene-parameter amplitude 0.35 "rad at the start")

(define cycle 60.0)                        ; s, until they are together again
(define radius 0.045)                      ; m, of a bob
(define rod-mass 0.004)
(define bob-mass 1.5)
(define height 1.5)
(define spacing 0.105)
(define pi (acos -1))

;; The period of a rigid pendulum that swings by `amplitude': 4 K(sin(a/2)) sqrt(I / (m g d)), with
;; the elliptic integral from the arithmetic-geometric mean.
(define (period moment inertia)
  (let mean ((a 1.0) (b (cos (/ amplitude 2))))
    (if (< (- a b) 1e-15)
        (/ (* 2 pi (sqrt (/ inertia (* 9.81 moment)))) a)
        (mean (/ (+ a b) 2) (sqrt (* a b))))))

;; Of a bob that hangs at `length'.
(define (period-at length)
  (period (+ (* bob-mass length) (* rod-mass length 1/2))
          (+ (* bob-mass (+ (* length length) (* 2/5 radius radius)))
             (* rod-mass length length 1/3))))

;; The length at which the period is `wanted', by bisection.
(define (length-for wanted)
  (let halve ((low 0.05) (high 5.0))
    (let ((middle (/ (+ low high) 2)))
      (cond ((< (- high low) 1e-14) middle)
            ((< (period-at middle) wanted) (halve middle high))
            (else (halve low middle))))))

;; The rod weighs as much as a thread and touches nothing; the bob hangs on it.
(define (add-pendulum! k)
  (let* ((length (length-for (/ cycle (+ swings k))))
         (share (/ k (max 1 (1- pendulums))))
         (pendulum
          (add-multibody! #:name (format #f "pendulum-~a" k)
                          #:position (vector 0 (* spacing (- k (/ (1- pendulums) 2))) height)
            (link 'rod #:joint (revolute #:axis #(0 1 0)) #:mass rod-mass
                  #:shape (placed (cylinder 0.003 length) #:position (vector 0 0 (/ length -2)))
                  #:color #(0.75 0.75 0.78)
              (link 'bob #:joint (weld #:at (vector 0 0 (- length))) #:mass bob-mass
                    #:shape (sphere radius)
                    #:color (vector (- 0.95 (* 0.75 share)) (+ 0.25 (* 0.35 share))
                                    (+ 0.15 (* 0.75 share))))))))
    (set! (joint-position pendulum 'rod) amplitude)))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(add-body! #:name "beam" #:shape (box 0.06 (* spacing (1+ pendulums)) 0.06) #:fixed? #t
           #:position (vector 0 0 (+ height 0.03)) #:color #(0.35 0.24 0.16))
(for-each (lambda (side)
            (add-body! #:name (format #f "post-~a" side) #:shape (box 0.06 0.06 (+ height 0.06))
                       #:fixed? #t #:color #(0.35 0.24 0.16)
                       #:position (vector 0 (* side (+ 0.03 (/ (* spacing (1+ pendulums)) 2)))
                                          (/ (+ height 0.06) 2))))
          '(-1 1))
(disable-collisions! #t #t)

(for-each add-pendulum! (iota pendulums))

(camera #:eye #(3.4 -1.7 1.6) #:target #(0 0 0.8) #:fov 0.62)
