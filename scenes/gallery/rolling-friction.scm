;;; Balls and drums roll out: each stops at the post that the closed form v^2/2a puts beside its lane, a =
;;; rho g/r/(1 + I/(m r^2)).  Their rolling friction rho is 6, 12 and 24 mm.
(use-modules (timewarp) (ice-9 match))

(scene #:title "Rolling friction" #:duration 9)

(define-scene-parameter speed 2 "m/s at the start")

(define radius 0.15)
(define gravity 9.81)
(define start -4)

(add-body! #:name "floor" #:shape (box 12 5 0.2) #:position #(1.5 0 -0.1) #:fixed? #t
           #:color #(0.55 0.57 0.60))
(set-contact-parameters! #t #t #:restitution 0 #:friction 0.6)

;; a drum lies across its lane; BETA = I/(m r^2)
(define lying (rotation #(1 0 0) (/ (acos -1) 2)))

(define (roll! name shape orientation beta friction across color)
  (let ((body (add-body! #:name name #:shape shape #:position (vector start across radius)
                         #:orientation orientation #:velocity (vector speed 0 0)
                         #:angular-velocity (vector 0 (/ speed radius) 0) #:color color))
        (way (/ (* speed speed radius (+ 1 beta)) (* 2 friction gravity))))
    (set-contact-parameters! body #t #:rolling-friction friction)
    (add-body! #:name (string-append name "'s post") #:shape (cylinder 0.02 0.3) #:fixed? #t
               #:position (vector (+ start way) (- across 0.3) 0.15) #:color #(0.9 0.85 0.3))))

(for-each
 (match-lambda
   ((name friction across color)
    (roll! (string-append "ball " name) (sphere radius) #(1 0 0 0) 2/5 friction across color)
    (roll! (string-append "drum " name) (cylinder radius 0.3) lying 1/2 friction
           (+ across 0.75) color)))
 '(("6 mm" 0.006 -2 #(0.25 0.45 0.75))
   ("12 mm" 0.012 -0.4 #(0.85 0.55 0.15))
   ("24 mm" 0.024 1.2 #(0.75 0.25 0.20))))

(camera #:eye #(-3 -7 4.5) #:target #(0 0 -0.3) #:fov 0.75)
