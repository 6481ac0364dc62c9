;;; A cue ball breaks a rack of fifteen.  The balls almost touch, so the shock runs through the rack
;;; within microseconds; each impact is located on its own, to rounding.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Billiard break" #:duration 2.5 #:gravity #(0 0 0))

(define-scene-parameter speed 6.0 "speed of the cue ball, m/s")

(define r 0.028575)                        ; m, a pool ball
(define density 1740)
(define random-state (scene-random-state))

;; the bed is only to be seen: the balls roll on nothing, gravity is off
(define bed (add-body! #:name "bed" #:shape (box 2.6 1.4 0.04) #:fixed? #t
                       #:position (vector 0.3 0 (- -0.02 r)) #:color #(0.07 0.36 0.22)))
(disable-collisions! bed #t)

(define (cushion! name size position)
  (add-body! #:name name #:shape size #:position position #:fixed? #t
             #:material 'cushion #:color #(0.32 0.17 0.08)))
(cushion! "left"  (box 0.06 1.4 0.09) #(-1.0 0 0))
(cushion! "right" (box 0.06 1.4 0.09) #(1.6 0 0))
(cushion! "near"  (box 2.66 0.06 0.09) #(0.3 -0.7 0))
(cushion! "far"   (box 2.66 0.06 0.09) #(0.3 0.7 0))

(set-contact-parameters! #t #t #:restitution 0.96 #:friction 0)
(set-contact-parameters! 'cushion #t #:restitution 0.75)

(define colors
  #(#(0.9 0.75 0.1) #(0.1 0.25 0.7) #(0.75 0.1 0.1) #(0.35 0.1 0.45) #(0.9 0.4 0.05)
    #(0.05 0.4 0.2) #(0.45 0.05 0.08) #(0.06 0.06 0.06)))

;; rows of 1 to 5, a hair apart
(define gap (* 2 r 1.0001))
(for-each
 (lambda (row)
   (for-each
    (lambda (k)
      (add-body! #:shape (sphere r) #:density density
                 #:position (vector (* row gap 0.8660254) (* gap (- k (/ row 2)))
                                    0)
                 #:color (vector-ref colors (modulo (+ k (* 2 row)) 8))))
    (iota (1+ row))))
 (iota 5))

(add-body! #:name "cue" #:shape (sphere r) #:density density #:position #(-0.7 0.003 0)
           #:velocity (vector speed 0 0) #:color #(0.95 0.94 0.88))

(camera #:eye #(-0.9 -1.5 1.15) #:target #(0.3 0 0) #:fov 0.75)
