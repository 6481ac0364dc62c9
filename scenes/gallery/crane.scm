;;; A crane swings a wrecking ball into a wall: only its trolley is driven, and stops and turns at
;;; once.  The rope is a multibody whose base moves.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Crane" #:duration 9 #:accuracy 1e-5)

(define-scene-parameter links 10 "links of the rope")
(define-scene-parameter courses 8 "courses of the wall")

(define yellow #(0.95 0.72 0.1))
(define dark #(0.16 0.17 0.19))
(define height 4.2)                        ; m, of the rail
(define reach 0.26)                        ; m, from joint to joint of the rope
(define radius 0.32)                       ; m, of the ball

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

;; ---- the portal: two posts, a rail, and the trolley that runs on it ----

(for-each (lambda (side)
            (add-body! #:name (format #f "post-~a" side) #:fixed? #t #:color yellow
                       #:shape (box 0.22 0.5 (+ height 0.3))
                       #:position (vector (* side 4.1) 0 (/ (+ height 0.3) 2))))
          '(-1 1))
(add-body! #:name "rail" #:fixed? #t #:color yellow
           #:shape (box 8 0.3 0.3) #:position (vector 0 0 (+ height 0.15)))
(define trolley
  (add-body! #:name "trolley" #:shape (box 0.6 0.42 0.16) #:color dark
             #:motion (keyframes (map (lambda (time x) (list time (vector x 0 (- height 0.08))))
                                      '(0    0.4  2.0 2.9 4.5  5.3  6.9)
                                      '(-2.6 -2.6 0.1 0.1 -2.6 -2.6 0.4)))))

;; ---- rope and ball ----

(define (rope-from k)
  (link (string->symbol (format #f "link-~a" k))
        #:joint (spherical #:at (if (zero? k) #(0 0 -0.08) (vector 0 0 (- reach))) #:damping 0.02)
        #:shape (placed (cylinder 0.025 (* 0.9 reach)) #:position (vector 0 0 (/ reach -2)))
        #:density 3000 #:color dark
    (if (= (1+ k) links)
        (link 'ball #:joint (spherical #:at (vector 0 0 (- reach)) #:damping 0.02)
              #:shape (placed (sphere radius) #:position (vector 0 0 (- radius)))
              #:density 5000 #:color #(0.3 0.31 0.33))
        (rope-from (1+ k)))))
(define rope (add-multibody! #:name 'rope #:base trolley (rope-from 0)))

;; ---- the wall ----

(define across 0.3) (define long 0.62) (define thick 0.2)      ; m, of a brick
(for-each
 (lambda (course)
   (for-each
    (lambda (k)
      (let ((shade (* 0.05 (modulo (+ (* 7 k) (* 3 course)) 5)))
            (along (- k (if (odd? course) 1.5 2))))
        (add-body! #:name (format #f "brick-~a-~a" course k)
                   #:shape (box across long thick) #:density 400
                   #:position (vector 1.15 (* long along) (* thick (+ course 0.5)))
                   #:color (vector (+ 0.58 shade) (+ 0.24 shade) (+ 0.16 (* 0.5 shade))))))
    (iota (if (odd? course) 4 5))))
 (iota courses))

(camera #:eye #(-4.2 -6.2 3.1) #:target #(0.1 0 1.7) #:fov 0.75)
