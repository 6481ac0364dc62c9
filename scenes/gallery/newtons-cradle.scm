;;; A ball hits a row of four that touch: it stops dead and the last one flies off at its speed, bounces
;;; back from the wall and sends the first one off again, and so on.
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Newton's cradle" #:duration 10)

(define-scene-parameter balls 5 "number of balls")
(define-scene-parameter speed 2.0 "of the first ball, m/s")

(define radius 0.1)
(define half-length 1.5)
(set-contact-parameters! #t #t #:restitution 1 #:friction 0)

(add-body! #:name "table" #:shape (box 3.4 0.8 0.1) #:fixed? #t #:position #(0 0 -0.05)
           #:color #(0.30 0.32 0.36))
(for-each
 (lambda (name side)
   (add-body! #:name name #:shape (box 0.2 0.8 0.4) #:fixed? #t
              #:position (vector (* side (+ half-length 0.1)) 0 0.2) #:color #(0.45 0.30 0.20)))
 '("left" "right") '(-1 1))

;; the row touches, its middle is the table's
(for-each
 (lambda (index)
   (let ((first? (zero? index)))
     (add-body! #:name (format #f "ball-~a" index) #:shape (sphere radius) #:density 7800
                #:position (vector (if first? -1.2 (* 2 radius (- index (/ balls 2)))) 0 radius)
                #:velocity (vector (if first? speed 0) 0 0)
                #:color (if first? #(0.85 0.25 0.15) #(0.80 0.81 0.84)))))
 (iota balls))

(camera #:eye #(0.8 -3.4 1.5) #:target #(0 0 0.1))
