;; Shapes from mesh files.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
;; A box from LO to HI as quads that look outward, its corners numbered from FIRST on.
(define (box-lines name first lo hi)
  (define (corner i)
    (format #f "v ~{~a~^ ~}"
            (map (lambda (axis) (list-ref (if (logbit? axis i) hi lo) axis)) '(0 1 2))))
  (define (face . corners)
    (format #f "f ~{~a~^ ~}" (map (lambda (c) (+ first c)) corners)))
  (append (if name (list (string-append "o " name)) '())
          (map corner (iota 8))
          (list (face 0 2 3 1) (face 4 5 7 6) (face 0 1 5 4) (face 2 6 7 3) (face 0 4 6 2)
                (face 1 3 7 5))))

(define cube (apply write-file "cube.obj" (box-lines #f 1 '(0 0 0) '(0.1 0.2 0.3))))
(define two
  (apply write-file "two.obj"
         (append (box-lines "left" 1 '(0 0 0) '(1 1 1)) (box-lines "right" 9 '(2 0 0) '(3 1 2)))))
;; an L as one object: two boxes that share the corners of a face would be two convex objects
(define ell
  (write-file "ell.obj" "o bracket"
              "v 0 0 0" "v 2 0 0" "v 2 1 0" "v 1 1 0" "v 1 2 0" "v 0 2 0"
              "v 0 0 1" "v 2 0 1" "v 2 1 1" "v 1 1 1" "v 1 2 1" "v 0 2 1"
              "f 6 5 4 3 2 1" "f 7 8 9 10 11 12"
              "f 1 2 8 7" "f 2 3 9 8" "f 3 4 10 9" "f 4 5 11 10" "f 5 6 12 11" "f 6 1 7 12"))
(define tetrahedron
  (write-file "tetrahedron.stl" "solid tip"
              "facet normal 0 0 -1" "outer loop" "vertex 0 0 0" "vertex 0 1 0" "vertex 1 0 0"
              "endloop" "endfacet"
              "facet normal 0 -1 0" "outer loop" "vertex 0 0 0" "vertex 1 0 0" "vertex 0 0 1"
              "endloop" "endfacet"
              "facet normal -1 0 0" "outer loop" "vertex 0 0 0" "vertex 0 0 1" "vertex 0 1 0"
              "endloop" "endfacet"
              "facet normal 1 1 1" "outer loop" "vertex 1 0 0" "vertex 0 1 0" "vertex 0 0 1"
              "endloop" "endfacet" "endsolid tip"))

(test-begin "load-shape")

(test-assert "a cube keeps all digits of its coordinates"
  (close? 0.006 (shape-volume (load-shape cube)) 1e-17))
(test-equal "one object is a hull" "#<shape hull>" (format #f "~s" (load-shape cube)))
(test-assert "a scale for all axes, and one for each"
  (and (close? 6e-6 (shape-volume (load-shape cube #:scale 0.1)) 1e-18)
       (close? 6.0 (shape-volume (load-shape cube #:scale #(10 10 10))) 1e-13)))
(test-assert "objects make a union" (close? 3.0 (shape-volume (load-shape two)) 1e-13))
(test-equal "of hulls" "#<shape union>" (format #f "~s" (load-shape two)))
(test-assert "STL" (close? 1/6 (shape-volume (load-shape tetrahedron)) 1e-7))
(test-message "what isn't convex is named"
  "ell.obj: the object bracket isn't convex.*#:convex-hull\\? #t" (load-shape ell))
(test-assert "its hull is to be had"
  (close? 3.5 (shape-volume (load-shape ell #:convex-hull? #t)) 1e-13))
;; objects as bodies of their own
(define named (load-shape two #:objects? #t))
(test-equal "the objects of a file have its names" '("left" "right") (map car named))
(test-assert "each is a shape, where it is in the file"
  (and (close? 1.0 (shape-volume (cdar named)) 1e-13) (close? 2.0 (shape-volume (cdadr named)) 1e-13)
       (close? #(2.5 0.5 1) (shape-centroid (cdadr named)) 1e-12)))
(test-equal "parts without names are objects, too" '("object-1" "object-2")
  (map car (load-shape (apply write-file "bare.obj" (append (box-lines #f 1 '(0 0 0) '(1 1 1))
                                                            (box-lines #f 9 '(2 0 0) '(3 1 2))))
                       #:objects? #t)))
(test-equal "a name that comes again has a number" '("a" "a-2")
  (map car (load-shape (apply write-file "twice.obj" (append (box-lines "a" 1 '(0 0 0) '(1 1 1))
                                                             (box-lines "a" 9 '(2 0 0) '(3 1 2))))
                       #:objects? #t)))
(test-equal "which no other object has" '("a" "a-3" "a-2")
  (map car (load-shape (apply write-file "thrice.obj" (append (box-lines "a" 1 '(0 0 0) '(1 1 1))
                                                              (box-lines "a" 9 '(2 0 0) '(3 1 2))
                                                              (box-lines "a-2" 17 '(5 0 0) '(6 1 2))))
                       #:objects? #t)))
(test-message "an object that isn't convex is named" "the object bracket isn't convex"
  (load-shape ell #:objects? #t))
(test-message "ground is one body" "ground is one body" (load-shape ell #:objects? #t #:concave? #t))

(test-message "a missing file" "nowhere.obj is missing" (load-shape "nowhere.obj"))

;; beside the file that the call stands in, whatever there is in the current folder
(mkdir (in-folder "inner"))
(mkdir (in-folder "outer"))
(apply write-file "inner/thing.obj" (box-lines #f 1 '(0 0 0) '(1 1 2)))
(apply write-file "outer/thing.obj" (box-lines #f 1 '(0 0 0) '(1 1 3)))
(apply write-file "thing.obj" (box-lines #f 1 '(0 0 0) '(1 1 4)))
(define load-it '("(use-modules (timewarp))" "(display (shape-volume (load-shape \"thing.obj\")))"))
(apply write-file "inner/part.scm" load-it)
(apply write-file "outer/main.scm" load-it)
(write-file "outer/nested.scm" "(use-modules (timewarp))" "(load \"../inner/part.scm\")")
(test-equal "a mesh beside the scene" "3.0" (run-output (run "outer/main.scm" "--quiet" "--until=0.1")))
(test-equal "a mesh beside a file that the scene loads" "2.0"
  (run-output (run "outer/nested.scm" "--quiet" "--until=0.1")))

(test-message "no mesh" "no faces" (load-shape (write-file "empty.obj" "# nothing")))
;; a cube and a stray triangle
(let* ((file (apply write-file "stray.obj"
                    (append (box-lines "cube" 1 '(0 0 0) '(1 1 1)) '("o stray" "v 5 0 0" "v 6 0 0" "v 6 1 0" "f 9 10 11"))))
       (volume #f)
       (warned (call-with-output-string
                 (lambda (port)
                   (parameterize ((current-warning-port port)) (set! volume (shape-volume (load-shape file))))))))
  (test-assert (format #f "a flat part is left out: ~a" warned)
    (and (close? 1.0 volume 1e-14)
         (string-match "stray.obj: the object stray has no hull: .*; it is left out" warned)))
  (test-message "or refused" "stray.obj: the object stray has no hull" (load-shape file #:strict? #t)))
(test-assert "y up"
  (close? #(0.05 -0.15 0.1) (shape-centroid (load-shape cube #:up 'y)) 1e-15))
(test-message "what is up" "up is z\\?; expected 'y or 'z" (load-shape cube #:up 'z?))
;; points so close that Qhull's merged facets bend
(test-assert "a mesh with nearly the same points many times"
  (let ((state (seed->random-state 5)))
    (every (lambda (trial)
             (let* ((n 60)
                    (points (append-map
                             (lambda (i)
                               (let* ((a (* 6.2831853 (/ i n))) (c (cos a)) (s (sin a)))
                                 (append-map
                                  (lambda (z)
                                    (map (lambda (k)
                                           (map (lambda (x) (+ x (* 1e-12 (random:normal state))))
                                                (list (+ (* 0.8 c) (* 0.6 z)) s (+ (* -0.6 c) (* 0.8 z)))))
                                         (iota 3)))
                                  '(-0.5 0.5))))
                             (iota n))))
               (close? 3.135 (shape-volume (convex (map list->vector points))) 0.01)))
           (iota 20))))
(test-message "a flat mesh" "has no hull: .*flat"
  (load-shape (write-file "flat.obj" "v 0 0 0" "v 1 0 0" "v 1 1 0" "v 0 1 0" "f 1 2 3 4")))
(test-message "corners that are not there" "flaw.obj has a face with the corner 7, and 2 vertices"
  (load-shape (write-file "flaw.obj" "v 0 0 0" "v 1 0 0" "f 1 2 7")))
(test-message "a coordinate that is no number" "nan.obj:2: coordinate of a vertex is nan; expected three finite"
  (load-shape (write-file "nan.obj" "v 0 0 0\nv 1 nan 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")))
(test-message "a coordinate that is missing" "short.obj:1: coordinate of a vertex is missing"
  (load-shape (write-file "short.obj" "v 0 0\n")))
(test-message "no scale" "scale" (load-shape cube #:scale 0))
(test-message "no name" "file" (load-shape 5))
(test-assert "a body made of it falls, lands and rests"
  (begin
    (reset!)
    (add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)
    (let ((body (add-body! #:shape (load-shape two #:scale 0.1) #:position #(0 0 0.05))))
      (run! #:until 2)
      (< (abs (vector-ref (position body) 2)) 1e-3))))

(test-end "load-shape")
