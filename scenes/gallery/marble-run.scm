;;; Marbles roll down a gutter that winds about a mast: a mesh of triangles, concave everywhere, cut
;;; from a tube.  Nobody holds them in but its walls.
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Marble run" #:duration 12 #:accuracy 1e-5)

(define-scene-parameter marbles 12 "how many marbles")
(define-scene-parameter around 20 "facets around the gutter")
(define-scene-parameter along 120 "facets along a turn")

(set-contact-parameters! #t #t #:restitution 0.4 #:friction 0.4)

(define pi (acos -1))
(define turns 3)
(define radius 1.2)                        ; m, of the helix
(define inner 0.16)                        ; of the tube
(define pitch 0.75)                        ; m that a turn goes down
(define top (+ 0.4 (* turns pitch)))

;; The gutter's points: row along the helix, column around the tube from rim to rim.  It leans
;; inwards, and straightens where it ends.
(define rows (inexact->exact (round (* turns along))))
(define (gutter-point row column)
  (let* ((angle (/ (* 2 pi row) along))
         (b (+ pi (* 0.1 pi) (* 0.95 pi (/ column around))))
         (q (+ radius (* inner (cos b)))))
    (vector (* q (cos angle)) (* q (sin angle))
            (+ (- top (* pitch (/ angle 2 pi))) (* inner (sin b))))))
(define (point-number row column) (+ column (* (1+ around) row)))
(define gutter
  (triangle-mesh
   (append-map (lambda (row) (map (lambda (column) (gutter-point row column)) (iota (1+ around))))
               (iota (1+ rows)))
   (append-map (lambda (row)
                 (append-map (lambda (column)
                               (let ((a (point-number row column))
                                     (b (point-number row (1+ column)))
                                     (c (point-number (1+ row) (1+ column)))
                                     (d (point-number (1+ row) column)))
                                 (list (vector a b c) (vector a c d))))
                             (iota around)))
               (iota rows))))
(add-body! #:name "gutter" #:shape gutter #:fixed? #t #:color #(0.78 0.62 0.42))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(add-body! #:name "mast" #:shape (cylinder 0.12 (+ top 0.3)) #:fixed? #t
           #:position (vector 0 0 (/ (+ top 0.3) 2)) #:color #(0.4 0.36 0.33))

;; one behind the other in the upper end, let go at once
(do ((k 0 (1+ k))) ((= k marbles))
  (let* ((angle (* 0.115 (+ 0.5 k))) (hue (/ k marbles)))
    (add-body! #:name (format #f "marble-~a" k) #:shape (sphere 0.06) #:density 2500
               #:position (vector (* radius (cos angle)) (* radius (sin angle))
                                  (+ (- top (* pitch (/ angle 2 pi))) (- inner) 0.07))
               #:color (vector (+ 0.5 (* 0.45 (cos (* 2 pi hue))))
                               (+ 0.5 (* 0.45 (cos (* 2 pi (- hue 1/3)))))
                               (+ 0.5 (* 0.45 (cos (* 2 pi (- hue 2/3)))))))))

(camera #:eye #(3.6 -4.2 3.4) #:target #(0 0 1.35) #:fov 0.75)
(light #:direction #(-0.5 0.6 -1) #:color #(1.0 0.95 0.88))
