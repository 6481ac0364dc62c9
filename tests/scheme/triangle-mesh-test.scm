;; Meshes as ground: rolling, sliding, being carried, nothing through, and what is told.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors))

(define pi (* 4 (atan 1)))

;; Surfaces as (POINTS . TRIANGLES): ROWS of COLUMNS points by (PLACE row column), their cells as two
;; triangles each; AROUND?: the last of a row is beside the first, TURNED?: they look the other way.
(define* (grid rows columns place #:key around? all-around? turned? (kept? (const #t)))
  (define (point row column)
    (+ (* columns (modulo row rows)) (modulo column columns)))
  (cons (append-map (lambda (row) (map (lambda (column) (place row column)) (iota columns)))
                    (iota rows))
        (append-map
         (lambda (row)
           (append-map
            (lambda (column)
              (let ((a (point row column)) (b (point row (1+ column)))
                    (c (point (1+ row) (1+ column))) (d (point (1+ row) column)))
                (filter kept?
                        (if turned?
                            (list (vector a c b) (vector a d c))
                            (list (vector a b c) (vector a c d))))))
            (iota (if around? columns (1- columns)))))
         (iota (if all-around? rows (1- rows))))))

(define* (plane n #:key (slope 0) (kept? (const #t)))
  (grid (1+ n) (1+ n)
        (lambda (row column)
          (let ((x (- (/ (* 10. column) n) 5)) (y (- (/ (* 10. row) n) 5)))
            (vector x y (* slope x))))
        #:kept? kept?))

(define* (ring around along #:key inside?)
  (grid along around
        (lambda (row column)
          (let* ((a (/ (* 2 pi row) along)) (b (/ (* 2 pi column) around))
                 (q (+ 2 (* 0.8 (cos b)))))
            (vector (* q (cos a)) (* q (sin a)) (* 0.8 (sin b)))))
        #:around? #t #:all-around? #t #:turned? (not inside?)))

(define (mesh surface) (triangle-mesh (car surface) (cdr surface)))

;; m, of a point over the ring's surface
(define (over-ring p)
  (match p
    (#(x y z) (- (sqrt (+ (expt (- (sqrt (+ (* x x) (* y y))) 2) 2) (* z z))) 0.8))))

(test-begin "triangle-mesh")

(test-equal "prints as what it is" "#<shape mesh>" (format #f "~s" (mesh (plane 2))))

;; without one triangle the plane is several polygons
(define (holed n slope)
  (mesh (plane n #:slope slope #:kept? (lambda (triangle) (not (= 40 (vector-ref triangle 0)))))))

(test-equal "a ball rolls over inner edges as over a plane" '()
  (filter-map
   (lambda (n)
     (in-world ()
       (scene #:gravity #(0 0 -9.81))
       (add-body! #:shape (holed n 0) #:fixed? #t)
       (let ((ball (add-body! #:shape (sphere 0.3) #:position #(4 0.3 0.3) #:velocity #(-1 0.13 0)
                              #:angular-velocity (vector (/ -0.13 0.3) (/ -1 0.3) 0))))
         (run! #:until 3)
         (if (close? (position ball) #(1 0.69 0.3) 1e-6) #f (list n (position ball))))))
   '(9 20 33)))

(test-equal "and down a ramp by 5/7 g sin" '()
  (filter-map
   (lambda (n)
     (in-world ()
       (scene #:gravity #(0 0 -9.81))
       (add-body! #:shape (holed n (tan 0.2)) #:fixed? #t)
       (let ((ball (add-body! #:shape (sphere 0.1)
                              #:position (vector 4 0.3 (+ (* 4 (tan 0.2)) (/ 0.1 (cos 0.2)))))))
         (run! #:until 2)
         (let* ((way (* 1/2 4 5/7 9.81 (sin 0.2))) (x (- 4 (* way (cos 0.2))))
                (there (vector x 0.3 (+ (* x (tan 0.2)) (/ 0.1 (cos 0.2))))))
           (if (close? (position ball) there 1e-6) #f (list n (position ball) there))))))
   '(9 20 33)))

;; seen from inside: a marble swings to and fro, and never higher than it was let go
(in-world ()
  (scene #:gravity #(0 0 -9.81))
  (let* ((tube (grid 41 24
                     (lambda (row column)
                       (let* ((a (+ pi (/ (* pi row) 40))) (b (/ (* 2 pi column) 24))
                              (q (+ 2 (* 0.3 (cos b)))))
                         (vector (* q (cos a)) (* 0.3 (sin b)) (* q (sin a)))))
                     #:around? #t #:turned? #t))
         (marble (begin
                   (add-body! #:shape (mesh tube) #:fixed? #t)
                   (add-body! #:shape (sphere 0.1) #:position #(-2.05 0.01 -0.1))))
         (start (total-energy))
         (energies (map (lambda (k)
                          (run! #:until (* 0.1 k))
                          (match (position marble)
                            (#(x y z)
                             (test-assert (format #f "in the tube at ~a" (world-time))
                               (and (< z 0.1)
                                    (< (sqrt (+ (expt (- (sqrt (+ (* x x) (* z z))) 2) 2) (* y y)))
                                       0.201)))))
                          (total-energy))
                        (iota 60))))
    (test-assert "it swings" (< (vector-ref (position marble) 2) 0))
    (test-assert "and gains nothing" (every (lambda (e) (< e (+ start 1e-6))) energies))))

;; nothing through at any speed, from outside and in a room
(define (fired inside? speed)
  (in-world ()
    (scene #:gravity #(0 0 0) #:on-overlap 'push)
    (add-body! #:shape (mesh (ring 11 17 #:inside? inside?)) #:fixed? #t)
    (let* ((random (seed->random-state 5))
           (u (lambda (size) (* size (- (* 2 (random:uniform random)) 1))))
           (bodies
            (map (lambda (k)
                   (let* ((a (* 2 pi (/ k 12)))
                          (from (if inside? 2 6))
                          (place (vector (* from (cos a)) (* from (sin a)) (if inside? 0 (u 0.3))))
                          (way (if inside?
                                   (vector (u 1) (u 1) (u 1))
                                   (vector (+ (u 0.2) (- (cos a))) (+ (u 0.2) (- (sin a))) (u 0.05)))))
                     (add-body! #:shape (list-ref (list (sphere 0.05) (box 0.1 0.06 0.08)
                                                        (cylinder 0.03 0.1))
                                                  (modulo k 3))
                                #:position place #:velocity (v* speed way)
                                #:angular-velocity (vector (u 30) (u 30) (u 30)))))
                 (iota 12))))
      (run! #:until (/ 30. speed))
      ;; the surface is up to 0.09 m within the ring's
      (list (> (assq-ref (statistics) 'collisions) 10)
            (every (lambda (body)
                     (if inside?
                         (< (over-ring (position body)) 0.02)
                         (> (over-ring (position body)) -0.12)))
                   bodies)))))
(for-each (lambda (speed)
            (test-equal (format #f "from outside at ~a m/s" speed) '(#t #t) (fired #f speed))
            (test-equal (format #f "in a room at ~a m/s" speed) '(#t #t) (fired #t speed)))
          '(3 300 10000))

;; a tray with a rim carries what lies in it
(define tray
  (let ((side (lambda (x) (list-ref '(-0.5 -0.45 -0.4 0.4 0.45 0.5) x))))
    (grid 6 6 (lambda (row column)
                (vector (side column) (side row)
                        (if (and (<= 1 row 4) (<= 1 column 4))
                            (if (and (<= 2 row 3) (<= 2 column 3)) 0 0.1)
                            0.1))))))
(in-world ()
  (scene #:gravity #(0 0 -9.81))
  (add-body! #:shape (mesh tray)
             #:motion (keyframes '((0 #(0 0 0)) (2 #(1 0 0.5)) (4 #(0 1 0.2) #(0.9239 0 0 0.3827)))
                                 #:smooth? #t))
  (let ((load (add-body! #:shape (box 0.2 0.2 0.1) #:position #(0 0 0.05))))
    (run! #:until 4)
    (test-assert (format #f "it is carried along: ~a" (position load))
      (close? (position load) #(0 1 0.25) 2e-3))))

(test-assert "the same from a list of rows and from vectors"
  (in-world ()
    (add-body! #:shape (triangle-mesh #(#(0 0 0) #(1 0 0) #(0 1 0)) #(#(0 1 2))) #:fixed? #t)
    (hit? (ray-cast #(0.2 0.2 1) #(0 0 -1)))))

;; ---- files ----

(define bracket
  (write-file "bracket.obj" "o bracket"
              "v 0 0 0" "v 2 0 0" "v 2 1 0" "v 1 1 0" "v 1 2 0" "v 0 2 0"
              "v 0 0 1" "v 2 0 1" "v 2 1 1" "v 1 1 1" "v 1 2 1" "v 0 2 1"
              "f 6 5 4 3 2 1" "f 7 8 9 10 11 12"
              "f 1 2 8 7" "f 2 3 9 8" "f 3 4 10 9" "f 4 5 11 10" "f 5 6 12 11" "f 6 1 7 12"))
(define (falls-to shape x y)
  (in-world ()
    (scene #:gravity #(0 0 -9.81))
    (add-body! #:shape shape #:fixed? #t)
    (let ((ball (add-body! #:shape (sphere 0.1) #:position (vector x y 1.2))))
      (run! #:until 2)
      (vector-ref (position ball) 2))))
(test-assert "a file that isn't convex, as it is"
  (let ((ground (load-shape bracket #:concave? #t)))
    (and (close? (falls-to ground 0.5 0.5) 1.1 1e-3) (< (falls-to ground 1.5 1.5) -10))))
(test-assert "the hull has the corner filled" (> (falls-to (load-shape bracket #:convex-hull? #t) 1.4 1.4) 1))
(test-assert "a scale that mirrors it does not turn it inside out"
  (close? (falls-to (load-shape bracket #:concave? #t #:scale #(-1 1 1)) -0.5 0.5) 1.1 1e-3))
(test-message "what isn't convex says so" "#:concave\\? #t for ground" (load-shape bracket))
(test-message "one of both" "#f where #:convex-hull" (load-shape bracket #:concave? #t #:convex-hull? #t))

;; ---- what is told ----

(define (warned-of thunk)
  (call-with-output-string
    (lambda (port) (parameterize ((current-warning-port port)) (thunk)))))
(define corners '(#(0 0 0) #(1 0 0) #(0 1 0) #(1 1 0) #(2 0 0) #(0 0 1)))
(define (told name pattern triangles)
  (let ((said (warned-of (lambda () (triangle-mesh corners triangles)))))
    (test-assert (format #f "~a: ~a" name said) (string-match pattern said)))
  (test-message (string-append name ", strictly") "a mesh has .*; expected"
    (triangle-mesh corners triangles #:strict? #t)))
(told "a triangle without an area" "has 1 triangle without an area; left out" '(#(0 1 2) #(0 1 4)))
(told "two at one place" "has 1 triangle on others; left out" '(#(0 1 2) #(1 2 0)))
(told "back to back" "has 1 triangle on others, 1 of them back to back" '(#(0 1 2) #(1 0 2)))
(told "one that faces the other way" "1 triangle facing the other way.*turned"
      '(#(0 1 2) #(1 2 3)))
(told "three at one side" "1 side of more than two" '(#(0 1 2) #(1 0 3) #(0 1 5)))
(test-equal "nothing is told of what is right" ""
  (warned-of (lambda () (triangle-mesh corners '(#(0 1 2) #(1 3 2))))))

(test-message "no triangles" "no triangle with an area" (triangle-mesh corners '()))
(test-message "no such point" "triangle.*numbers of points" (triangle-mesh corners '(#(0 1 6))))
(test-message "two corners" "triangle.*numbers of points" (triangle-mesh corners '(#(0 1))))
(test-message "no numbers" "triangle" (triangle-mesh corners '(#(0 a 1))))
(test-message "it does not move" "is a mesh" (add-body! #:shape (mesh (plane 2))))
(test-message "it has no volume" "without mass" (shape-volume (mesh (plane 2))))
(test-message "no part of a union" "body of its own" (union (sphere 1) (mesh (plane 2))))
(test-message "not placed within a shape" "#:position" (placed (mesh (plane 2))))

(clean-up)
(test-end "triangle-mesh")
