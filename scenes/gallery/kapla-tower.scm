;;; A tower of loose wooden planks (15 : 3 : 1) keeps standing: on each floor four uprights carry two
;;; pairs of planks laid across each other.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Kapla tower" #:duration 10)

(define-scene-parameter floors 6 "number of floors")

(define long 0.117) (define wide 0.0234) (define thin 0.0078)      ; m
(define half-turn (acos -1))
(define across (rotation #(0 0 1) (* 1/2 half-turn)))
(define upright (rotation #(0 1 0) (* 1/2 half-turn)))
(define wood #(#(0.86 0.68 0.44) #(0.80 0.60 0.36) #(0.90 0.75 0.52)))

(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.5)
(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t #:color #(0.50 0.54 0.52))

(define count 0)
(define (plank! x y z orientation)
  (add-body! #:name (format #f "plank-~a" count) #:shape (box long wide thin) #:density 600
             #:position (vector x y z) #:orientation orientation
             #:color (vector-ref wood (modulo count 3)))
  (set! count (1+ count)))

(define out (* 1/2 (- long wide)))        ; from the axis to the middle of an upright
(for-each
 (lambda (floor)
   (let ((bottom (* floor (+ long thin thin))))
     (for-each (lambda (x y) (plank! (* x out) (* y out) (+ bottom (/ long 2)) upright))
               '(-1 1 -1 1) '(-1 -1 1 1))
     (for-each (lambda (side)
                 (plank! 0 (* side out) (+ bottom long (* 0.5 thin)) #(1 0 0 0))
                 (plank! (* side out) 0 (+ bottom long (* 1.5 thin)) across))
               '(-1 1))))
 (iota floors))

(camera #:eye #(0.55 -1.35 0.75) #:target (vector 0 0 (* 0.45 floors (+ long thin thin))))
