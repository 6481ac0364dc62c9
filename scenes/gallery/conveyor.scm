;;; A belt carries crates and balls to its end, where they are dammed up.
(use-modules (timewarp) (timewarp vectors))

(scene #:title "Conveyor" #:duration 8)

(define-scene-parameter speed 1.0 "of the belt, m/s")
(define-scene-parameter bodies 16 "bodies on the belt")

(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.5)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) -0.6) #:fixed? #t)
;; a plate that goes on and on under the dam stands for the belt
(add-body! #:name "belt" #:shape (box 24 1.6 0.2) #:color #(0.2 0.2 0.22) #:max-speed (* 2 speed)
           #:motion (lambda (time) (values (vector (- (* speed time) 4) 0 -0.1) #(1 0 0 0))))
(add-body! #:name "dam" #:shape (box 0.2 1.6 1.2) #:position #(3 0 0.61) #:fixed? #t
           #:color #(0.45 0.3 0.18))
(for-each (lambda (y)
            (add-body! #:shape (box 14 0.1 0.5) #:position (vector -3.9 y 0.26) #:fixed? #t
                       #:color #(0.45 0.3 0.18)))
          '(-0.85 0.85))

(define (add-on-belt! k)
  (add-body! #:name (format #f "load-~a" k)
             #:shape (if (even? k) (box 0.3 0.3 0.3) (sphere 0.16))
             #:position (vector (- 2 (* 0.55 k)) (* 0.4 (sin (* 3 k))) 0.4)
             #:color (if (even? k) #(0.7 0.25 0.15) #(0.85 0.62 0.08))))
(do ((k 0 (1+ k))) ((= k bodies)) (add-on-belt! k))

(camera #:eye #(0.5 -7 4) #:target #(-0.5 0 0.2) #:fov 0.7)
