;;; Avalanche: 300 rocks tumble down a mountainside of 524 fixed pieces (the paper, section 5).
;;;
;;; A heap of rocks is let go in a bowl below the saddle, pours through a gully with a ledge in it, and
;;; comes to rest on the flat below.  The mountain is a height field over a grid that follows the
;;; gully: each triangle is a slab of its own, and neighbours share their corners.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1) (srfi srfi-43) (ice-9 match))

(scene #:title "Avalanche" #:accuracy 1e-3 #:duration 45)

(define-scene-parameter rocks 300 "number of rocks")
(define-scene-parameter friction 0.5 "coefficient of friction of all contacts")
(define-scene-parameter restitution 0.2 "coefficient of restitution of all impacts")
(define-scene-parameter spacing 0 "m, at most 1, of a height field in place of the slabs; 0: slabs")

(set-contact-parameters! #t #t #:restitution restitution #:friction friction)

;; the mountain is always the same, the rocks follow the seed
(define mountain-state (seed->random-state 2000))
(define rock-state (scene-random-state))
(define (uniform from to state) (+ from (* (- to from) (random:uniform state))))

;;; The gully: for each row of the grid its y, the height of the floor, the middle, half its width.
(define rows
  #((-75 17 -6 9) (-38 9.5 -5 9) (-21 5.4 -3 8.5) (-13 3.2 -2 8.5) (-8 0.9 -1.5 8)
    (-4.5 0 -1 7.5) (-1.5 0.5 -0.5 6.5) (1 1.8 0.2 5.2) (3.5 3.5 1 4.2) (6 5.5 1.8 3.6)
    (8.5 7.8 2.3 3.2) (11 10 2.2 3) (13.5 11.3 1.4 3.2) (16 13.2 0.4 2.9) (18.5 15.6 -0.3 2.7)
    (21 18 -0.5 3.4) (24 20.8 -0.2 4.6) (28 24.8 0.2 5) (35 29.5 0.5 5.5) (52 31.5 0 9)))

;; lines of the grid to either side: distance from the floor's edge, height above the floor, roughness
(define sides
  '((2.2 1.6 0.5) (6 3.4 1.0) (14 6.5 1.8) (62 15 5.0)))

;; to a whole multiple of 2^-12 m: sums and differences of such numbers are exact, and so are the
;; corners that slabs share
(define (snapped p) (vector-map (lambda (i x) (/ (round (* 4096 x)) 4096)) p))

;; one row: 13 corners from west to east
(define (row-corners row)
  (match-let (((y floor middle half) row))
    (define (corner across height rough)
      (let* ((shift (min rough 1.2))
             (dx (* 0.5 shift (uniform -1 1 mountain-state)))
             (dy (* (min shift 0.7) (uniform -1 1 mountain-state)))
             (dz (* 0.8 rough (uniform -1 1 mountain-state))))
        (snapped (vector (+ middle across dx) (+ y dy) (+ floor height dz)))))
    (define (bank sign)
      (map-in-order (match-lambda ((out up rough) (corner (* sign (+ half out)) up rough))) sides))
    (let* ((west (bank -1))
           (floor (map-in-order (lambda (share)
                                  (corner (* share half) (* 0.7 share share) 0.25))
                                '(-1 -0.5 0 0.5 1)))
           (east (bank 1)))
      (list->vector (append (reverse west) floor east)))))

(define grid (list->vector (map-in-order row-corners (vector->list rows))))
(define (corner j i) (vector-ref (vector-ref grid j) i))

;; all triangles, counter-clockwise from above; each cell is cut along its higher or lower diagonal
(define triangles
  (append-map
   (lambda (j)
     (append-map
      (lambda (i)
        (let ((a (corner j i)) (b (corner j (1+ i)))
              (c (corner (1+ j) (1+ i))) (d (corner (1+ j) i)))
          (if (zero? (random 2 mountain-state))
              (list (list a b c) (list a c d))
              (list (list a b d) (list b c d)))))
      (iota (1- (vector-length (vector-ref grid 0))))))
   (iota (1- (vector-length rows)))))

(define (middle-of points) (v* (/ (length points)) (apply v+ points)))
(define (normal-of triangle)
  (match triangle ((a b c) (normalize (cross (v- b a) (v- c a))))))
(define (x-of v) (vector-ref v 0))
(define (y-of v) (vector-ref v 1))
(define (z-of v) (vector-ref v 2))

;;; What grows and lies where: snow high up, grass on the flat, bare rock where it is steep, scree in
;;; the gully.
(define (ramp from to x) (max 0 (min 1 (/ (- x from) (- to from)))))

;; how far into the gully's floor a point is: 1 in its middle, 0 at its edge and beyond
(define (in-gully p)
  (let ((nearest (vector-fold (lambda (j best row)
                                (if (< (abs (- (first row) (y-of p))) (abs (- (first best) (y-of p))))
                                    row best))
                              (vector-ref rows 0) rows)))
    (match-let (((_ _ middle half) nearest))
      (- 1 (ramp 0.75 1.1 (/ (abs (- (x-of p) middle)) half))))))

(define (ground-color triangle)
  (let* ((p (middle-of triangle))
         (level (z-of (normal-of triangle)))
         (grass (lerp #(0.37 0.47 0.17) #(0.55 0.56 0.26) (uniform 0 1 mountain-state)))
         (stone (lerp #(0.46 0.40 0.35) #(0.60 0.55 0.48) (uniform 0 1 mountain-state)))
         (scree (lerp #(0.66 0.59 0.47) #(0.76 0.68 0.55) (uniform 0 1 mountain-state)))
         (snow #(0.80 0.84 0.90))
         (bank (lerp stone grass (* (ramp 0.62 0.84 level) (- 1 (ramp 9 17 (z-of p))))))
         (ground (lerp bank scree (* (in-gully p) (- 1 (ramp -16 -30 (y-of p)))))))
    (lerp ground snow (* (ramp 18 22 (+ (z-of p) (uniform -1 1 mountain-state)))
                         (ramp 0.45 0.65 level)))))

(define ground-colors (map-in-order ground-color triangles))

(define slab-depth 3)
(define (add-slab! index triangle color)
  (define down (vector 0 0 (* -1/2 slab-depth)))
  (define origin (snapped (v+ (middle-of triangle) down)))
  (add-body! #:name (format #f "slab-~a" index) #:fixed? #t #:position origin #:color color
             #:shape (convex (append-map (lambda (p)
                                           (let ((top (v- p origin)))
                                             (list top (v+ top down down))))
                                         triangle))))
(when (zero? spacing)
  (for-each add-slab! (iota (length triangles)) triangles ground-colors))

;; height above (x, y) of the triangle's plane, lifted by RADIUS along its normal
(define (plane-height triangle x y radius)
  (let ((n (normal-of triangle)) (p (first triangle)))
    (+ (z-of p)
       (/ (- radius (* (x-of n) (- x (x-of p))) (* (y-of n) (- y (y-of p)))) (z-of n)))))

;; number of the triangle around (x, y), which lies to the left of all its sides
(define (triangle-around x y)
  (define (left-of? p q)
    (>= (* (- (x-of q) (x-of p)) (- y (y-of p))) (* (- (y-of q) (y-of p)) (- x (x-of p)))))
  (list-index (match-lambda
                ((a b c) (and (left-of? a b) (left-of? b c) (left-of? c a))))
              triangles))

;; height and colour of the ground
(define (ground-height x y)
  (plane-height (list-ref triangles (triangle-around x y)) x y 0))
(define (color-at x y) (list-ref ground-colors (triangle-around x y)))

;;; The same ground as one body: its heights over a rectangle, x from -32 to 32 m, y from -66 to 46 m.
(unless (zero? spacing)
  (let* ((rows (1+ (inexact->exact (floor (/ 112 spacing)))))
         (columns (1+ (inexact->exact (floor (/ 64 spacing)))))
         (over-grid (lambda (at)
                      (let ((grid (make-array #f rows columns)))
                        (array-index-map! grid (lambda (row column)
                                                 (at (- (* spacing column) 32)
                                                     (- (* spacing row) 66))))
                        grid))))
    (add-body! #:name "mountain" #:fixed? #t #:color #(0.56 0.53 0.42)
               #:shape (height-field (over-grid ground-height) #:spacing spacing
                                     #:colors (over-grid color-at))
               #:position (vector (- (* 1/2 spacing (1- columns)) 32)
                                  (- (* 1/2 spacing (1- rows)) 66) 0))))

;;; Boulders that stick in the ground make up the 524 pieces.
(define boulders (- 524 (length triangles)))
(for-each
 (lambda (index)
   (let* ((in-the-way? (< index 16))
          (row (vector-ref rows (+ 3 (random 12 mountain-state))))
          (size (if in-the-way?
                    (uniform 0.5 1.1 mountain-state)
                    (+ 0.5 (* 1.9 (expt (uniform 0 1 mountain-state) 2))))))
     (match-let (((y _ middle half) row))
       (let* ((side (if (zero? (random 2 mountain-state)) -1 1))
              (x (+ middle (if in-the-way?
                               (* half (uniform -0.9 0.9 mountain-state))
                               (* side (+ half (uniform 0.2 8 mountain-state))))))
              (y (+ y (uniform -1.5 1.5 mountain-state))))
         (add-body! #:name (format #f "boulder-~a" index) #:fixed? #t
                    #:shape (rock #:size size #:vertices 18 #:random-state mountain-state)
                    #:position (vector x y (- (ground-height x y) (* 0.1 size)))
                    #:color (lerp #(0.50 0.49 0.48) #(0.66 0.62 0.56)
                                  (uniform 0 1 mountain-state)))))))
 (iota boulders))

;;; The rocks: each is laid where the heap is lowest among a few places in the bowl.  Balls around
;;; them don't overlap, so neither do they.
(define bowl '(0 25 4.2 5))                ; an ellipse: middle x y, half axes
(define (random-place)
  (match-let (((x y a b) bowl))
    (let* ((r (sqrt (uniform 0 1 rock-state)))
           (angle (uniform 0 (* 4 (acos 0)) rock-state)))
      (list (+ x (* a r (cos angle))) (+ y (* b r (sin angle)))))))

;; the triangles within 2 m of the bowl: (least x, greatest x, least y, greatest y . triangle)
(define bowl-triangles
  (match-let (((x y a b) bowl))
    (filter-map
     (lambda (triangle)
       (let* ((xs (map x-of triangle)) (west (apply min xs)) (east (apply max xs))
              (ys (map y-of triangle)) (south (apply min ys)) (north (apply max ys)))
         (and (<= (- west a 2) x (+ east a 2)) (<= (- south b 2) y (+ north b 2))
              (cons* west east south north triangle))))
     triangles)))
;; a height of its centre at which a ball above (x, y) in the bowl clears all triangles near it
(define (height-over x y radius)
  (fold (lambda (bounded height)
          (match bounded
            ((west east south north . triangle)
             (if (and (<= (- west radius) x (+ east radius))
                      (<= (- south radius) y (+ north radius)))
                 (max height (plane-height triangle x y radius))
                 height))))
        -1000 bowl-triangles))

;; least height at which a ball at (x, y) clears the balls ((center . radius) ...) laid so far
(define (height-on-balls x y radius balls)
  (fold (lambda (ball height)
          (match-let (((center . other) ball))
            (let* ((apart (+ radius other 0.01)) (dx (- x (x-of center))) (dy (- y (y-of center)))
                   (up (- (* apart apart) (* dx dx) (* dy dy))))
              (if (positive? up) (max height (+ (z-of center) (sqrt up))) height))))
        -1000 balls))

(define (lowest-place radius balls)
  (let ((heights (map-in-order
                  (lambda (try)
                    (match-let (((x y) (random-place)))
                      (let* ((bare (height-over x y (+ radius 0.02)))
                             (height (max bare (height-on-balls x y radius balls))))
                        (cons (- height bare) (vector x y height)))))
                  (iota 10))))
    (cdr (reduce (lambda (a b) (if (< (car a) (car b)) a b)) #f heights))))

(define (rock-color)
  (let ((tint (uniform 0 1 rock-state)) (light (uniform 0.75 1.15 rock-state)))
    (vector-map (lambda (i c) (min 1 (* light c)))
                (cond ((< tint 0.42) #(0.53 0.54 0.56))       ; slate
                      ((< tint 0.72) #(0.66 0.63 0.58))       ; limestone
                      ((< tint 0.90) #(0.76 0.55 0.34))       ; ochre
                      (else #(0.42 0.36 0.34))))))            ; basalt

(define (random-orientation)
  (let* ((w (random:normal rock-state)) (x (random:normal rock-state))
         (y (random:normal rock-state)) (z (random:normal rock-state)))
    (vector w x y z)))

(let loop ((index 0) (balls '()))
  (when (< index rocks)
    (let* ((size (+ 0.28 (* 0.52 (expt (uniform 0 1 rock-state) 2))))
           (shape (rock #:size size #:random-state rock-state))
           (radius (shape-radius shape))
           (place (lowest-place radius balls)))
      (add-body! #:name (format #f "rock-~a" index) #:shape shape #:density 2600
                 #:position place #:orientation (random-orientation) #:color (rock-color))
      (loop (1+ index) (cons (cons place radius) balls)))))

(camera #:eye #(7.5 -29 12.5) #:target #(0.3 6 8.5) #:fov 0.9)
;; a low sun at the side shows how steep it is
(light #:direction #(-1 0.3 -0.65) #:color #(1.0 0.95 0.86))
(sky #:zenith #(0.22 0.42 0.72) #:horizon #(0.74 0.83 0.92) #:ground #(0.46 0.45 0.42) #:fog 0.002)
