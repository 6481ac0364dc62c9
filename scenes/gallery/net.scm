;;; A net of rings, held at its four corners, catches a ball.
(use-modules (timewarp) (timewarp vectors))

(scene #:title "Net" #:duration 3)

(define-scene-parameter rings 4 "large rings along a side")

(define bar 0.02)                          ; m
(define pitch 0.25)                        ; of the large rings

(set-contact-parameters! #t #t #:restitution 0 #:friction 0.3)

;; a square of four bars, SIDE wide, in the plane of x and y
(define (ring side)
  (let ((along (box side bar bar))
        (across (box bar (- side bar bar) bar))
        (out (/ (- side bar) 2)))
    (union (placed along #:position (vector 0 out 0))
           (placed along #:position (vector 0 (- out) 0))
           (placed across #:position (vector out 0 0))
           (placed across #:position (vector (- out) 0 0)))))
(define large (ring 0.2))
(define small (ring 0.14))

(define (place i j) (vector (* i pitch) (* j pitch) 1.2))
(define (at-rim? i) (or (zero? i) (= i (1- rings))))
(define quarter (/ (acos -1) 2))

(define (add-small! i j axis)
  (add-body! #:shape small #:position (place i j) #:orientation (rotation axis quarter)
             #:color #(0.75 0.6 0.25)))

(do ((i 0 (1+ i))) ((= i rings))
  (do ((j 0 (1+ j))) ((= j rings))
    (add-body! #:name (format #f "ring-~a-~a" i j) #:shape large #:position (place i j)
               #:fixed? (and (at-rim? i) (at-rim? j)) #:color #(0.6 0.62 0.65))
    (when (< i (1- rings)) (add-small! (+ i 1/2) j #(1 0 0)))
    (when (< j (1- rings)) (add-small! i (+ j 1/2) #(0 1 0)))))

(define middle (/ (* pitch (1- rings)) 2))
(add-body! #:name "ball" #:shape (sphere 0.22) #:position (vector middle middle 2)
           #:density 300 #:color #(0.75 0.2 0.12))
(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(camera #:eye (vector (+ middle 0.8) -2.4 1.9) #:target (vector middle middle 1.1) #:fov 0.7)
