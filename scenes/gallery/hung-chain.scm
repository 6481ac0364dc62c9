;;; A chain that hangs between two posts, struck by a ball.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Hung chain" #:duration 6 #:accuracy 1e-5)

(define-scene-parameter links 14 "links of each chain")
(define-scene-parameter chains 5 "chains side by side")
(define-scene-parameter speed 9 "m/s of the ball")

(define length 0.16)                       ; m, from joint to joint
(define height 2.6)

(define (iron k) (if (even? k) #(0.5 0.51 0.54) #(0.36 0.37 0.4)))

;; Links k and after, each on the one before.
(define (chain-from k)
  (if (= k links)
      '()
      (list
       (link (string->symbol (format #f "link-~a" k))
             #:joint (spherical #:at (if (zero? k) #(0 0 0) (vector 0 0 (- length)))
                                #:damping 1e-4)
             #:shape (placed (cylinder 0.03 (* 0.86 length)) #:position (vector 0 0 (/ length -2)))
             #:density 2000 #:color (iron k)
         (chain-from (1+ k))))))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(add-body! #:name "beam" #:shape (box 0.12 (+ 0.8 (* 0.3 chains)) 0.12) #:fixed? #t
           #:position (vector 0 0 (+ height 0.07)) #:color #(0.36 0.24 0.13))
(for-each (lambda (side)
            (add-body! #:name (format #f "post-~a" side) #:shape (box 0.12 0.12 (+ height 0.13))
                       #:fixed? #t #:color #(0.36 0.24 0.13)
                       #:position (vector 0 (* side (+ 0.46 (* 0.15 chains))) (/ (+ height 0.13) 2))))
          '(-1 1))

(for-each (lambda (k)
            (add-multibody! #:name (format #f "chain-~a" k)
                            #:position (vector 0 (* 0.3 (- k (/ (1- chains) 2))) height)
              (chain-from 0)))
          (iota chains))

(add-body! #:name "ball" #:shape (sphere 0.2) #:density 400 #:position #(-4 0.08 1.0)
           #:velocity (vector speed 0 2.6) #:color #(0.85 0.2 0.12))

(camera #:eye #(-3.2 -4.2 2.1) #:target #(0 0 1.25) #:fov 0.75)
