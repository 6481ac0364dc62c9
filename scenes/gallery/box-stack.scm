;;; Ten boxes stand on each other and stay: nothing leans, sinks or trembles, and after a moment at rest
;;; the stack costs nothing.
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Box stack" #:duration 5)

(define-scene-parameter boxes 10 "number of boxes")
(define-scene-parameter size 0.2 "edge of a box, m")

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t #:color #(0.60 0.62 0.65))

(for-each
 (lambda (index)
   (add-body! #:name (format #f "box-~a" index) #:shape (box size size size)
              #:position (vector 0 0 (* size (+ index 0.5)))
              #:color (if (even? index) #(0.80 0.45 0.20) #(0.88 0.78 0.60))))
 (iota boxes))

(camera #:eye (vector 1.6 -3.2 1.5) #:target (vector 0 0 (* 0.5 size boxes)))
