;; Shapes that are not convex, of moving bodies, as convex pieces.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(define pi (* 4 (atan 1)))
(define (vertex x y z) (format #f "v ~,15f ~,15f ~,15f" x y z))
;; corners counter-clockwise from outside
(define (face . corners) (format #f "f ~{~a~^ ~}" corners))

;; What is turned about z: the corners of its section, (RADIUS . HEIGHT), from the axis outwards
;; below and back to it above, in SIDES sides.
(define (turned sides section)
  (define rows (length section))
  (define (number row side) (+ 1 (modulo side sides) (* row sides)))
  (append
   (append-map
    (lambda (corner)
      (map (lambda (side)
             (let ((angle (/ (* 2 pi side) sides)))
               (vertex (* (car corner) (cos angle)) (* (car corner) (sin angle)) (cdr corner))))
           (iota sides)))
    section)
   (append-map
    (lambda (row)
      (map (lambda (side)
             (face (number row side) (number row (+ side 1)) (number (+ row 1) (+ side 1))
                   (number (+ row 1) side)))
           (iota sides)))
    (iota (- rows 1)))
   (list (apply face (map (lambda (side) (number 0 (- sides side))) (iota sides)))
         (apply face (map (lambda (side) (number (- rows 1) side)) (iota sides))))))

;; the area of a polygon of SIDES corners on a circle, over that of the circle's square
(define (share sides) (* 1/2 sides (sin (/ (* 2 pi) sides))))

;; Outer radius 5 cm, wall and bottom 1 cm, 10 cm high.
(define cup (apply write-file "cup.obj" (turned 12 '((0.05 . 0) (0.05 . 0.1) (0.04 . 0.1) (0.04 . 0.01)))))
(define cup-volume (* (share 12) (- (* 0.05 0.05 0.1) (* 0.04 0.04 0.09))))

(define (box-lines first lo hi inwards?)
  (define (corner i)
    (apply vertex (map (lambda (axis) (if (logbit? axis i) hi lo)) '(0 1 2))))
  (append (map corner (iota 8))
          (map (lambda (corners)
                 (apply face (map (lambda (c) (+ first c))
                                  (if inwards? (reverse corners) corners))))
               '((0 2 3 1) (4 5 7 6) (0 1 5 4) (2 6 7 3) (0 4 6 2) (1 3 7 5)))))
(define hollow
  (apply write-file "hollow.obj" (append (box-lines 1 -0.5 0.5 #f) (box-lines 9 -0.4 0.4 #t))))

;; What THUNK warns of, and what it returns.
(define (told thunk)
  (define result #f)
  (define text
    (call-with-output-string
      (lambda (port) (parameterize ((current-warning-port port)) (set! result (thunk))))))
  (cons text result))

(define decomposer (search-path (parse-path (getenv "PATH")) "timewarp-decompose"))
(define-syntax-rule (when-there form ...)
  (begin
    (unless decomposer (test-skip 1))
    form ...))

(test-begin "decompose")

(unless decomposer
  (test-message "without the program its package is named" "built with CGAL.*libcgal-dev"
    (load-shape cup #:decompose #t)))

(when-there
 (test-assert "a cup has the volume of its surface, and is told"
   (match (told (lambda () (load-shape cup #:decompose #t)))
     ((text . shape)
      (and (close? cup-volume (shape-volume shape) (* 1e-7 cup-volume))
           (string-match "cup.obj: it is [0-9]+ convex pieces, of the same volume" text))))))

(when-there
 (test-assert "a cavity is none of the solid"
   (let ((shape (cdr (told (lambda () (load-shape hollow #:decompose #t))))))
     (and (close? (- 1 0.512) (shape-volume shape) 1e-7)
          (close? (/ (- 1 (expt 0.8 5)) 6)
                  (vector-ref (vector-ref (shape-inertia shape) 0) 0) 1e-7)))))

(when-there
 (test-assert "so it is whichever way the file faces, and however it is scaled"
   (let ((inside-out (apply write-file "inside-out.obj"
                            (append (box-lines 1 -0.5 0.5 #t) (box-lines 9 -0.4 0.4 #f)))))
     (every (lambda (made) (close? (- 1 0.512) (shape-volume (cdr made)) 1e-7))
            (list (told (lambda () (load-shape inside-out #:decompose #t)))
                  (told (lambda () (load-shape hollow #:decompose #t #:scale #(-1 1 1)))))))))

(when-there
 (test-assert "what stands free in a cup is no cavity of it"
   (let ((both (apply write-file "both.obj"
                      (append (lines-of (read-file "cup.obj")) (box-lines 49 -0.002 0.002 #t)))))
     (close? (+ cup-volume (expt 0.004 3))
             (shape-volume (cdr (told (lambda () (load-shape both #:decompose #t))))) 1e-9))))

(when-there
 (test-assert "many triangles are simplified, and the change of the volume told"
   (let* ((ring (apply write-file "ring.obj"
                       (turned 200 (map (lambda (i)
                                          (let ((angle (* 2 pi (/ i 20))))
                                            (cons (- 1 (* 0.3 (cos angle))) (* -0.3 (sin angle)))))
                                        (iota 20)))))
          (made (told (lambda () (load-shape ring #:decompose 200)))))
     (string-match "it is [0-9]+ convex pieces, made of [0-9]+ of [0-9]+ triangles, with a volume"
                   (car made)))))

(when-there
 (test-assert "small pieces are joined, and not across what is hollow"
   (in-world ()
     (let* ((thin (apply write-file "thin.obj"
                         (turned 24 '((0.05 . 0) (0.05 . 0.1) (0.0495 . 0.1) (0.0495 . 0.0005)))))
            (shape (cdr (told (lambda () (load-shape thin #:decompose #t)))))
            (cup (add-body! #:shape shape #:fixed? #t)))
       ;; from above into it, and from its middle to the wall: within 1 % of its size
       (and (close? 0.2995 (hit-distance (ray-cast #(0 0 0.3) #(0 0 -1))) 0.0018)
            (close? 0.0495 (hit-distance (ray-cast #(0 0 0.05) #(1 0 0))) 0.0022))))))

(when-there
 (test-assert "a ball that falls into a cup comes to rest in it"
   (in-world ()
     (let* ((shape (cdr (told (lambda () (load-shape cup #:decompose #t)))))
            (floor (ground))
            (cup (add-body! #:shape shape #:density 1000 #:position #(0 0 0)))
            (ball (add-body! #:shape (sphere 0.015) #:density 1000 #:position #(0 0 0.2))))
       (run! #:until 1)
       (and (< (abs (- 0.025 (vector-ref (position ball) 2))) 1e-4)
            (< (abs (vector-ref (position cup) 2)) 1e-4))))))

(when-there
 (test-assert "a hole is closed and told, or refused"
   (let ((open (apply write-file "open.obj" (drop-right (lines-of (read-file "cup.obj")) 1))))
     (and (string-match "it has 1 hole; it is closed"
                        (car (told (lambda () (load-shape open #:decompose #t)))))
          (string-match "expected a closed surface"
                        (error-of (load-shape open #:decompose #t #:strict? #t)))))))

(test-message "it goes with no other way" "decompose is #t; expected #f where"
  (load-shape cup #:decompose #t #:convex-hull? #t))
(test-message "a number of triangles" "decompose is 3; expected #t, or a number of triangles"
  (load-shape cup #:decompose 3))

(test-end)
