;;; A fan starts up while balls rain on it: its blades, moved by a procedure of time, fling them out of
;;; the drum that they fall into.
(use-modules (timewarp))

(scene #:title "Fan" #:duration 10 #:seed 5 #:accuracy 1e-4)

(define-scene-parameter balls 90 "how many balls")
(define-scene-parameter speed 7 "rad/s, what the fan comes up to")

(set-contact-parameters! #t #t #:restitution 0.5 #:friction 0.3)

(define pi 3.141592653589793)
(define random-state (scene-random-state))
(define (uniform from to) (+ from (* (- to from) (random:uniform random-state))))

(add-body! #:name "floor" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

;;; The drum: staves in a ring.
(define staves 24)
(define radius 1.45)
(define (around k n) (* 2 pi (/ k n)))
(do ((k 0 (1+ k))) ((= k staves))
  (let ((angle (around k staves)))
    (add-body! #:shape (box 0.06 (* 2.04 radius (tan (/ pi staves))) 0.5) #:fixed? #t
               #:position (vector (* radius (cos angle)) (* radius (sin angle)) 0.25)
               #:orientation (rotation #(0 0 1) angle) #:color #(0.42 0.40 0.38))))

;;; The fan: six blades on a hub, pitched so that they lift.
(define blades 6)
(define fan
  (apply union
         (cylinder 0.22 0.3)
         (map (lambda (k)
                (let ((angle (around k blades)))
                  (placed (placed (box 0.9 0.3 0.03) #:orientation (rotation #(1 0 0) -0.5))
                          #:position (vector (* 0.68 (cos angle)) (* 0.68 (sin angle)) 0)
                          #:orientation (rotation #(0 0 1) angle))))
              (iota blades))))
;; still for two seconds, then faster by two more: the angle is the integral of the speed
(define (turned time)
  (let ((since (- time 2)))
    (cond ((< since 0) 0)
          ((< since 2) (* 1/4 speed since since))
          (else (* speed (- since 1))))))
(add-body! #:name "fan" #:shape fan #:color #(0.80 0.30 0.16)
           #:motion (lambda (time)
                      (values #(0 0 0.16) (rotation #(0 0 1) (turned time))))
           #:max-speed (* 1.35 speed))

;;; The rain.
(do ((k 0 (1+ k))) ((= k balls))
  (let ((r (* 1.15 (sqrt (uniform 0 1)))) (angle (uniform 0 (* 2 pi))))
    (add-body! #:shape (sphere (uniform 0.06 0.1))
               #:position (vector (* r (cos angle)) (* r (sin angle)) (+ 1.2 (* 0.22 k)))
               #:density 500
               #:color (list-ref '(#(0.93 0.78 0.30) #(0.30 0.55 0.75) #(0.85 0.85 0.82))
                                 (modulo k 3)))))

(camera #:eye #(2.9 -3.4 2.9) #:target #(0 0 0.4) #:fov 0.75)
