;;; An arm whose controller keeps an integral in a slot takes a box and is struck by balls: what a
;;; controller remembers must roll back with the rest.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Integral arm" #:duration 4 #:accuracy 1e-4)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(define rod (placed (box 0.5 0.06 0.06) #:position #(0.25 0 0)))
(define arm
  (add-multibody! #:name 'arm #:position #(0 0 0.8)
    (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape rod #:density 500
      (link 'fore #:joint (revolute #:axis #(0 1 0) #:at #(0.5 0 0)) #:shape rod #:density 500
            #:slots '((integral . #(0 0)))))))
(define load-box
  (add-body! #:name "box" #:shape (box 0.1 0.1 0.1) #:density 400 #:position #(1.06 0 0.8)))
(disable-collisions! arm load-box)

(define balls
  (map (lambda (k)
         (add-body! #:name (format #f "ball-~a" k) #:shape (sphere 0.06) #:density 800
                    #:position (vector (+ 0.15 (* 0.2 k)) (* 0.01 k) (+ 1.6 (* 0.5 k)))))
       (iota 4)))

(define period 0.01)

;; proportional, integral, derivative, to an angle that changes every second
(define (control time view box)
  (unless (attached? view box) (when (< time 3) (attach! view box)))
  (when (and (attached? view box) (>= time 3)) (detach! view box))
  (let* ((goal (if (even? (inexact->exact (floor time))) -0.2 0.15))
         (q (joint-positions view)) (u (joint-velocities view))
         (error (v- (vector goal goal) q))
         (integral (v+ (slot view 'integral) (v* period error))))
    (set! (slot view 'integral) integral)
    (set! (joint-torques view)
          (v+ (v* 120 error) (v+ (v* 150 integral) (v* -14 u))))))

(add-callback! (list (link-body arm 'fore) load-box) control #:period period)
