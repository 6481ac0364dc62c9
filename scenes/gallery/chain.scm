;;; A chain of links, each of four bars, falls from the horizontal, hangs and cracks like a whip.
(use-modules (timewarp) (timewarp vectors))

(scene #:title "Chain" #:duration 5)

(define-scene-parameter links 12 "links of the chain")

(define bar 0.02)                          ; m
(define length 0.2)
(define width 0.12)

(set-contact-parameters! #t #t #:restitution 0 #:friction 0.3)

(define link
  (let ((along (box length bar bar))
        (across (box bar bar (- width bar bar)))
        (end (/ (- length bar) 2)) (side (/ (- width bar) 2)))
    (union (placed along #:position (vector 0 0 side))
           (placed along #:position (vector 0 0 (- side)))
           (placed across #:position (vector end 0 0))
           (placed across #:position (vector (- end) 0 0)))))

;; every other one on its side; a millimetre of play
(define (add-link! k)
  (add-body! #:name (format #f "link-~a" k) #:shape link #:fixed? (zero? k)
             #:position (vector (* k (- length bar bar 0.001)) 0 2.2)
             #:orientation (rotation #(1 0 0) (if (odd? k) (/ (acos -1) 2) 0))
             #:color (if (odd? k) #(0.75 0.6 0.25) #(0.6 0.62 0.65))))

(do ((k 0 (1+ k))) ((= k links)) (add-link! k))
(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(camera #:eye #(0.2 -4.2 1.5) #:target #(0 0 1.25) #:fov 0.65)
