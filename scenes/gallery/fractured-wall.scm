;;; A wall of stones of all shapes, each an object of one OBJ file, is struck by a ball.  The file is what
;;; a modelling program's fracture leaves; here the scene writes it: the cells of a grid with crooked
;;; corners, which meet exactly.
(use-modules (timewarp) (srfi srfi-1) (ice-9 format))

(scene #:title "Fractured wall" #:duration 4 #:seed 5 #:accuracy 1e-4)

(define-scene-parameter columns 11 "stones beside each other")
(define-scene-parameter rows 7 "courses of stones")
(define-scene-parameter speed 12 "m/s, of the ball")

(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.6)

(define wall-width 4.4)                    ; m
(define wall-height 2.8)
(define depth 0.4)

;; ---- the file ----

(define random-state (scene-random-state))
(define (crooked) (* 0.22 (- (* 2 (random:uniform random-state)) 1)))
(define corners
  (list->vector
   (append-map
    (lambda (row)
      (map-in-order
       (lambda (column)
         (let ((dx (crooked)) (dz (crooked)))
           (cons (* wall-width (- (/ (+ column (if (< 0 column columns) dx 0)) columns) 1/2))
                 (* wall-height (/ (+ row (if (< 0 row rows) dz 0)) rows)))))
       (iota (1+ columns))))
    (iota (1+ rows)))))

(define (write-wall port)
  (format port "# a wall of ~a stones~%" (* rows columns))
  (do ((k 0 (1+ k))) ((= k (* rows columns)))
    (let* ((row (quotient k columns)) (column (modulo k columns))
           (a (+ column (* row (1+ columns)))) (d (+ a columns 1))
           (first (1+ (* 8 k))))
      (format port "o stone-~a~%" k)
      (for-each (lambda (y)
                  (for-each (lambda (corner)
                              (let ((place (vector-ref corners corner)))
                                (format port "v ~f ~f ~f~%" (* 1.0 (car place)) y (* 1.0 (cdr place)))))
                            (list a (1+ a) (1+ d) d)))
                (list (/ depth -2) (/ depth 2)))
      (for-each (lambda (face)
                  (format port "f~{ ~a~}~%" (map (lambda (i) (+ first i)) face)))
                '((0 1 2 3) (7 6 5 4) (0 4 5 1) (1 5 6 2) (2 6 7 3) (3 7 4 0))))))

(define file (string-append (mkdtemp "/tmp/timewarp-wall-XXXXXX") "/wall.obj"))
(call-with-output-file file write-wall)

;; ---- the wall ----

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(for-each (lambda (object)
            (let ((tint (+ 0.85 (* 0.3 (random:uniform random-state)))))
              (add-body! #:name (car object) #:shape (cdr object) #:density 2300
                         #:color (list->vector (map (lambda (c) (* c tint)) '(0.62 0.55 0.47))))))
          (load-shape file #:objects? #t))
(delete-file file)
(rmdir (dirname file))

(add-body! #:name "ball" #:shape (sphere 0.35) #:density 5000 #:color #(0.15 0.16 0.18)
           #:position #(0.3 -6 1.5) #:velocity (vector 0 speed 1.5))

(camera #:eye #(-3.8 -5.5 3.2) #:target #(0.1 1 1.0) #:fov 0.75)
(light #:direction #(0.6 0.7 -1) #:color #(1.0 0.95 0.88))
