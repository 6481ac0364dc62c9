;; Shapes and rotations.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp shapes)
  #:use-module (timewarp primitives)
  #:use-module (timewarp arity)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (timewarp vectors)
  #:use-module (timewarp files)
  #:use-module (srfi srfi-4)
  #:use-module (ice-9 match)
  #:export (sphere box capsule cylinder cone ellipsoid convex half-space height-field triangle-mesh union
            placed
            rock load-shape load-visual rotation
            shape-volume shape-inertia shape-centroid shape-radius shape?))

(define (sphere radius)
  "Return a sphere of RADIUS metres about the origin."
  (%sphere radius))

(define (box x y z)
  "Return a box with full edges X, Y, Z in metres, centred at the origin."
  (%box x y z))

(define (cylinder radius length)
  "Return a cylinder of RADIUS and LENGTH metres about the z axis, centred at the origin."
  (%cylinder radius length))

(define (capsule radius length)
  "Return a capsule about the z axis: all points within RADIUS metres of a segment of LENGTH metres,
centred at the origin.  It is LENGTH + 2 RADIUS long over all."
  (%capsule radius length))

(define (cone radius height)
  "Return a cone about the z axis with a base of RADIUS metres, HEIGHT metres high.  The origin is
its centroid: the base is at -HEIGHT/4, the tip at 3/4 HEIGHT."
  (%cone radius height))

(define (ellipsoid a b c)
  "Return an ellipsoid with the semi-axes A, B, C metres along x, y and z, centred at the origin."
  (%ellipsoid a b c))

(define (convex points)
  "Return the convex hull of POINTS, a list or vector of #(x y z) in metres.  The origin is that of
the points."
  (%convex points))

(define (half-space normal offset)
  "Return the half-space that is solid where NORMAL.x <= OFFSET.  For fixed or kinematic bodies
only."
  (%half-space normal offset))

(define-keyword-procedure (height-field heights #:key spacing colors)
  "Return ground by its HEIGHTS in metres: an array of rank 2, or a list of its rows, with x growing
along a row and y from row to row.  The middle of the grid is at x = y = 0 of the body's frame.  For
fixed or kinematic bodies only.

Cells are cut along the diagonal from their corner of least x and y, but where the four corners lie
in one plane; rectangles of cells in one plane are one part.  The ground is solid at least down to a
cell's width below the lowest corner of each cell, and ends at the edge of the grid.

#:spacing  m, between neighbours of the grid, or #(dx dy) along x and y; 1
#:colors   by height, a list ((HEIGHT #(r g b)) ...) with heights in m that grow, between which one colour
           turns into the next; a procedure of x, y and height, m, in the body's frame, that returns
           #(r g b); or #(r g b) for each height, an array or a list of rows.  They go before #:color of
           the body; the body's"
  (let ((heights (rows-or-array heights "heights" "numbers, in metres"))
        (spacing (or spacing 1)))
    (%height-field heights spacing (and colors (colors->array colors heights spacing)))))

(define (rows-or-array object name what)
  (if (and (list? object) (and-map list? object)) (rows->array object name what) object))

(define (rows->array rows name what)
  (when (null? rows) (bad-value name rows (string-append "a list of rows of " what)))
  (let ((size (length (car rows))))
    (for-each (lambda (row j)
                (unless (= (length row) size)
                  (raise-error (format #f "row ~a of ~a has ~a ~a and row 0 has ~a; ~a"
                                       j name (length row) (car (string-split what #\,)) size
                                       "expected rows of one length"))))
              rows (iota (length rows))))
  (list->array 2 rows))

;; ---- colours of the ground ----

;; By what a color of a height field is chosen, as an array of one for each of the heights.  What is
;; wrong with heights or spacing is left to be told by what makes the shape.
(define (colors->array colors heights spacing)
  (match colors
    (((height (? vector?)) . _)
     (=> otherwise)
     (if (vector? height)                               ; two colours in a row
         (otherwise)
         (let ((steps (check-steps colors)))
           (map-heights (lambda (x y height) (color-between steps height)) heights spacing))))
    ((? procedure?)
     (check-takes "#:colors of height-field" colors 3 "x, y and the height")
     (map-heights colors heights spacing))
    (_ (rows-or-array colors "colors" "colors, #(r g b)"))))

(define (map-heights procedure heights spacing)
  (define (over? a) (and (array? a) (= (array-rank a) 2)))     ; a grid
  (define-values (dx dy)
    (match spacing
      ((? real? d) (values d d))
      ((or #((? real? dx) (? real? dy)) ((? real? dx) (? real? dy))) (values dx dy))
      (_ (values 1 1))))
  (and (over? heights)
       (match (array-shape heights)
         (((first-row last-row) (first-column last-column))
          (let ((result (make-array #f (- (1+ last-row) first-row) (- (1+ last-column) first-column))))
            (define (from-middle i first last) (- i (/ (- last first) 2)))
            (array-index-map!
             result
             (lambda (row column)
               (let ((height (array-ref heights (+ first-row row) (+ first-column column))))
                 (if (real? height)
                     (procedure (* dx (from-middle column first-column last-column))
                                (* dy (from-middle row first-row last-row))
                                height)
                     #(0 0 0)))))
            result)))))

;; ((HEIGHT . COLOR) ...)
(define (check-steps steps)
  (define expected "a list ((HEIGHT #(r g b)) ...) with heights that grow")
  (define pairs
    (map (match-lambda
           (((? real? height) (and color #((? real?) (? real?) (? real?)))) (cons height color))
           (_ (bad-value "colors" steps expected)))
         steps))
  (unless (apply < (map car pairs)) (bad-value "colors" steps expected))
  pairs)

;; Of a height below the first step or above the last one that step's.
(define (color-between steps height)
  (match steps
    (((low . color)) color)
    (((low . color) (high . next) . _)
     (cond ((<= height low) color)
           ((< height high) (lerp color next (/ (- height low) (- high low))))
           (else (color-between (cdr steps) height))))))

(define (union . shapes)
  "Return the union of SHAPES, a shape that need not be convex.  Where parts overlap, mass properties
count the overlap twice."
  (%union shapes))

(define-keyword-procedure (placed shape #:key position orientation)
  "Return SHAPE moved within the body's frame: turned, then shifted.

#:position     m, the shift; #(0 0 0)
#:orientation  a quaternion #(w x y z), as rotation returns; #(1 0 0 0)"
  (%placed shape position orientation))

(define-keyword-procedure (triangle-mesh points triangles #:key strict?)
  "Return ground by its surface, however concave it is: POINTS, a list or vector of #(x y z) in metres,
and TRIANGLES, a list or vector of #(i j k), the numbers of their corners, counter-clockwise from
outside.  For fixed or kinematic bodies only.

Triangles in one plane are joined to convex polygons.  What is beneath each polygon is solid, up to
twice its width deep or that of the mean one, and at most half as deep as the next surface beneath: a
surface that encloses nothing is a shell beneath its front.  Triangles without an area and those on
others are left out, those that face the other way than their neighbours are turned, with a warning.

#:strict?  #t: what is wrong with triangles is an error; #f"
  (let ((made (%triangle-mesh points triangles strict?)))
    (tell-mended (cdr made))
    (car made)))

(define-keyword-procedure (load-shape file #:key scale convex-hull? concave? decompose objects? up strict?)
  "Return the shape of FILE: OBJ, STL, or what else of meshes Assimp reads.  FILE is looked for
beside the file that the call stands in, then beside the scene that is being loaded, then in the current
folder.

What hangs together in it by common vertices is a convex part, several make a union; the frame is
that of the file.  A part that isn't convex is an error that names its object: split it in a
modelling program, or decompose it, or take the hull, or all of it as ground.  A part that is flat is
left out, with a warning.

#:scale         metres in a unit of the file, or #(x y z) of them, not 0; 1
#:convex-hull?  whether the hull is taken of parts that are not convex; #f
#:concave?      whether all is ground with the file's surface, as triangle-mesh makes it; #f
#:decompose     #t, or a number N of triangles, 20 to 2000: parts that are not convex are split into
                convex pieces; those of more than N triangles, 400, and half as many concave edges are
                simplified to N first.  Pieces are joined where that adds at most 4/N of the size
                over the surface, 1 %; the mass is that before they are.  The change of the volume is
                told.  More triangles take longer, by their square, and make more pieces; #f
#:objects?      #t: a list ((NAME . SHAPE) ...) of the file's objects, NAME a string, is returned, to be
                bodies each; where there is but one, of the parts in it; #f
#:up            'y: the file's y is up, and becomes z here, its z becomes -y; 'z
#:strict?       #t: a flat part is an error, holes of what is decomposed, and what is wrong with triangles
                of ground; #f"
  (unless (memq up '(#f y z)) (bad-value "up" up "'y or 'z"))
  (when (and convex-hull? concave?)
    (bad-value "concave?" concave? "#f where #:convex-hull? is given"))
  (when (and decompose (or convex-hull? concave?))
    (bad-value "decompose" decompose "#f where #:convex-hull? or #:concave? is given"))
  (unless (or (memq decompose '(#t #f)) (and (exact-integer? decompose) (<= 20 decompose 2000)))
    (bad-value "decompose" decompose "#t, or a number of triangles, 20 to 2000"))
  (when (and objects? concave?)
    (bad-value "objects?" objects? "#f where #:concave? is given: ground is one body"))
  (let* ((found (beside-caller file (caller-place)))
         (kind (cond (concave? 'concave) (convex-hull? 'hulls) (decompose 'pieces) (else 'convex)))
         (triangles (if (number? decompose) decompose 400))
         (made (%load-shape found (or scale 1) kind triangles objects? (eq? up 'y) strict?)))
    (note-file-read found)
    (tell-mended (cdr made))
    (car made)))

(define-keyword-procedure (load-visual file #:key scale up color position orientation strict?)
  "Return what is seen of the mesh FILE, for #:visual of add-body! and link: OBJ with the colours and
textures of its mtl, STL, Collada, or what else of meshes Assimp reads.  It touches nothing, and need not
be convex or closed.  FILE is looked for as by load-shape.

A texture, PNG, JPEG, TGA or BMP, is looked for where the mesh says, beside the mesh, and in
materials/textures/ beside its folder; one that is missing or cannot be read is left out, with a warning.

#:scale        metres in a unit of the file, or #(x y z) of them, not 0; 1
#:up           'y: the file's y is up, and becomes z here, its z becomes -y; 'z
#:color        #(r g b), sRGB, 0 to 1, of all of it, times a texture; those of its materials, or the body's
#:position     m, in the body's frame; #(0 0 0)
#:orientation  there, a quaternion #(w x y z); #(1 0 0 0)
#:strict?      #t: what is wrong with a texture is an error; #f"
  (unless (memq up '(#f y z)) (bad-value "up" up "'y or 'z"))
  (let* ((found (beside-caller file (caller-place)))
         (made (%load-visual found (or scale 1) (eq? up 'y) color position orientation strict?)))
    (note-file-read found)
    (tell-mended (cdr made))
    (car made)))

;; ---- rocks ----

(define (uniform from to state)
  (+ from (* (- to from) (random:uniform state))))

;; A point on the unit sphere: z and the azimuth are uniform (Archimedes).
(define (random-direction state)
  (let* ((z (uniform -1 1 state))
         (azimuth (uniform 0 (* 4 (acos 0)) state))
         (r (sqrt (- 1 (* z z)))))
    (f64vector (* r (cos azimuth)) (* r (sin azimuth)) z)))

;; COUNT directions well apart, the last one first: each is the one of a dozen that is farthest from
;; those before it (D. Mitchell, Spectrally optimal sampling, 1991, "best candidate").  Nearly all of
;; a rock's time went here while all numbers were boxed; those of f64vectors are not.
(define (spread-directions count state)
  (define chosen (make-f64vector (* 3 count)))
  ;; square of CANDIDATE's distance from the nearest of those in the first END numbers; 16 of none
  (define (clearance candidate end)
    (let ((x (f64vector-ref candidate 0)) (y (f64vector-ref candidate 1))
          (z (f64vector-ref candidate 2)))
      (let loop ((i 0) (least 16.0))
        (if (< i end)
            (let* ((dx (- x (f64vector-ref chosen i)))
                   (dy (- y (f64vector-ref chosen (+ i 1))))
                   (dz (- z (f64vector-ref chosen (+ i 2))))
                   (square (+ (* dx dx) (* dy dy) (* dz dz))))
              (loop (+ i 3) (if (< square least) square least)))
            least))))
  (let next ((end 0) (directions '()))
    (if (= end (* 3 count))
        directions
        (let search ((tries 12) (best #f) (best-clearance -1))
          (if (zero? tries)
              (begin
                (do ((i 0 (1+ i))) ((= i 3))
                  (f64vector-set! chosen (+ end i) (f64vector-ref best i)))
                (next (+ end 3) (cons best directions)))
              (let* ((candidate (random-direction state))
                     (here (clearance candidate end)))
                (if (> here best-clearance)
                    (search (1- tries) candidate here)
                    (search (1- tries) best best-clearance))))))))

(define-keyword-procedure (rock #:key size vertices random-state)
  "Return an irregular boulder: the convex hull of points near an ellipsoid, its centroid at the
origin.  It is a function of its arguments alone: draw rocks that differ from one random state.

#:size          m, the diameter of the ball that has the rock's volume, positive; 1
#:vertices      how many points at most, 4 to 200; 16
#:random-state  a Guile random state, which is advanced; (scene-random-state), the same each time"
  (let ((size (or size 1)) (count (or vertices 16)) (state (or random-state (scene-random-state))))
    (unless (and (real? size) (< 0 size +inf.0))
      (bad-value "size" size "a positive number of metres"))
    (unless (and (exact-integer? count) (<= 4 count 200))
      (bad-value "vertices" count "an integer from 4 to 200"))
    (unless (random-state? state)
      (bad-value "random-state" state "a Guile random state"))
    (let* ((b (uniform 0.72 1 state))
           (c (uniform 0.6 0.9 state))
           (points (map-in-order
                    (lambda (direction)
                      (let ((r (uniform 0.84 1 state)))
                        (vector (* r (f64vector-ref direction 0))
                                (* r b (f64vector-ref direction 1))
                                (* r c (f64vector-ref direction 2)))))
                    (spread-directions count state)))
           (raw (%convex points))
           (center (%shape-centroid raw))
           ;; pi/6 size^3 is the volume of the ball
           (scale (* size (expt (/ (* 1/3 (acos 0)) (%shape-volume raw)) 1/3))))
      (%convex (map (lambda (p) (v* scale (v- p center))) points)))))

(define (random-state? object)
  (false-if-exception (copy-random-state object)))

(define (rotation axis angle)
  "Return the quaternion #(w x y z) that rotates by ANGLE radians about AXIS."
  (%rotation axis angle))

(define (shape-volume shape)
  "Return the volume of SHAPE in cubic metres."
  (%shape-volume shape))

(define (shape-inertia shape)
  "Return the inertia of SHAPE about its centroid at density 1, as three rows."
  (%shape-inertia shape))

(define (shape-centroid shape)
  "Return the centroid of SHAPE in its own frame."
  (%shape-centroid shape))

(define (shape-radius shape)
  "Return the radius of the smallest ball about the origin of SHAPE's frame that holds it."
  (%shape-radius shape))

(define (shape? object)
  "Return #t if OBJECT is a shape."
  (eq? (class-of* object) <shape>))

(define (class-of* object)
  (and (struct? object) (struct-vtable object)))
