;;; Rocks are thrown over a ridge: on the far slope they bounce from hill to hill, collect in the hollows
;;; and come to rest.  The ground is one body, a height field of 14,400 cells.
(use-modules (timewarp))

(scene #:title "Rocks on hills" #:duration 14 #:seed 3 #:accuracy 1e-4)

(define-scene-parameter rocks 80 "how many rocks")
(define-scene-parameter restitution 0.7 "coefficient of restitution of all impacts")

(set-contact-parameters! #t #t #:restitution restitution #:friction 0.5 #:rolling-friction 0.01)

(define random-state (scene-random-state))
(define (uniform from to) (+ from (* (- to from) (random:uniform random-state))))

;;; Hills: waves of ever shorter length and in random directions, on a slope that ends in a hollow.
(define spacing 0.2)
(define cells 120)
(define half (* 1/2 cells spacing))
(define ground-state (seed->random-state 7))
(define waves
  (map-in-order
   (lambda (k)
     (let ((angle (* 6.283 (random:uniform ground-state)))
           (number (* 0.42 (expt 1.32 k))))
       (list (* number (cos angle)) (* number (sin angle)) (* 6.283 (random:uniform ground-state))
             (/ 0.30 number (expt 1.12 k)))))
   (iota 14)))
(define (ground-height x y)
  (let ((far (/ (sqrt (+ (* x x) (* y y))) half)))
    (apply + (* 3.2 (expt far 3))
           (map (lambda (wave)
                  (apply (lambda (kx ky phase height)
                           (* 0.55 height (sin (+ (* kx x) (* ky y) phase))))
                         wave))
                waves))))
(define heights (make-typed-array 'f64 0 (1+ cells) (1+ cells)))
(array-index-map! heights
                  (lambda (row column)
                    (ground-height (- (* column spacing) half) (- (* row spacing) half))))
(add-body! #:name "hills" #:shape (height-field heights #:spacing spacing) #:fixed? #t
           #:color #(0.46 0.48 0.27))

;;; One rock after the other, from the same place: so many metres behind each other.
(do ((k 0 (1+ k))) ((= k rocks))
  (let* ((size (uniform 0.25 0.6))
         (row (quotient k 8)) (column (modulo k 8)))
    (add-body! #:name (format #f "rock-~a" k)
               #:shape (rock #:size size #:vertices 14 #:random-state random-state)
               #:position (vector (- -9 (* 0.5 row)) (* 0.75 (- column 3.5)) (+ 6 (* 0.75 row)))
               #:velocity (vector (uniform 5 7) (uniform -1 1) (uniform 1 3))
               #:angular-velocity (vector (uniform -6 6) (uniform -6 6) (uniform -6 6))
               #:color (let ((tint (uniform 0.8 1.15)))
                         (list->vector (map (lambda (c) (* c tint))
                                            (list-ref '((0.53 0.54 0.56) (0.66 0.60 0.52)
                                                        (0.74 0.52 0.32) (0.45 0.38 0.35))
                                                      (modulo k 4))))))))

(camera #:eye #(8.5 -10 6.5) #:target #(0 -0.5 1) #:fov 0.75)
;; a sun at the side shows the hills
(light #:direction #(-0.6 0.5 -1) #:color #(1.0 0.95 0.86))
(sky #:zenith #(0.22 0.42 0.72) #:horizon #(0.74 0.83 0.92) #:ground #(0.46 0.45 0.42) #:fog 0.002)
