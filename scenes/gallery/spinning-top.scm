;;; A fast top leans, yet does not fall: its axis goes round (precession), nodding a little, while its
;;; tip stays in place on the table.  Beside it lies the one that does not spin.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Spinning top" #:duration 6)

(define-scene-parameter spin 150.0 "angular velocity of the top, rad/s")
(define-scene-parameter lean 0.35 "angle between its axis and the vertical, rad")

(set-contact-parameters! #t #t #:restitution 0 #:friction 0.6)
(add-body! #:name "table" #:shape (half-space #(0 0 1) 0) #:fixed? #t #:color #(0.34 0.25 0.18))

;; a tip, two rims and a stem
(define (ring radius height)
  (map (lambda (k)
         (let ((angle (* k (/ (acos -1) 10))))
           (vector (* radius (cos angle)) (* radius (sin angle)) height)))
       (iota 20)))
(define top
  (union (convex (append (list #(0 0 0)) (ring 0.05 0.055) (ring 0.044 0.07)))
         (convex (append (ring 0.006 0.07) (ring 0.006 0.11)))))

;; the tip stays at rest: the centre of mass moves as the spin tells it to
(define (add-top! name x spin color)
  (let* ((tilted (rotation #(0 1 0) lean))
         (axis (rotate tilted #(0 0 1))))
    (add-body! #:name name #:shape top #:density 700 #:position (vector x 0 0)
               #:orientation tilted #:angular-velocity (v* spin axis) #:color color)))
(add-top! "spins" -0.1 spin #(0.80 0.22 0.14))
(add-top! "falls" 0.12 0.0 #(0.20 0.42 0.70))

(camera #:eye #(0.08 -0.55 0.26) #:target #(0.01 0 0.045))
