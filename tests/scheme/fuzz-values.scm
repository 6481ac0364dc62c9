;; Random calls of everything that (timewarp) and (timewarp vectors) export, as expressions.
;;
;; What is drawn never depends on what earlier calls did, so that an episode without some of its
;; calls has the others unchanged: bodies and the like are named by number, which counts modulo
;; those there are.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp)
             (timewarp vectors)
             (timewarp primitives)
             (srfi srfi-1)
             (srfi srfi-4)
             (srfi srfi-9)
             (ice-9 match)
             ((oop goops) #:select (class-of class-name))
             (system vm program))

;; ---- values that expressions name ----

(define-record-type <thing> (make-thing part) thing? (part thing-part))

(define handle? (@@ (timewarp parts) handle?))
(define handle-kind (@@ (timewarp parts) handle-kind))

(define (circular . elements)
  (set-cdr! (last-pair elements) elements)
  elements)

;; 2^COUNT parts, if it is walked as a tree
(define (shared count)
  (let loop ((value '(1)) (n count)) (if (zero? n) value (loop (cons value value) (1- n)))))

;; What calls returned, and what callbacks were handed, by kind, latest first; members of lists, too.
(define kept (make-hash-table))
(define (kind-of value)
  (match value
    ((? shape?) 'shape)
    ((? view?) 'view)
    ((? hit?) 'hit)
    ((? contact?) 'contact)
    ((? collision?) 'collision)
    ((? servo?) 'servo)
    ((? handle?) (handle-kind value))
    (((? real?) (? integer?) (views ...)) 'frame)
    (((? real?) (? body?) (_ _) (? real?) (? real?)) 'squeezing)
    ((? struct?) (class-name (class-of value)))
    (_ #f)))
(define (keep! value)
  (let loop ((value value) (depth 3))
    (let ((kind (kind-of value)))
      (when kind
        (hashq-set! kept kind
                    (let ((others (hashq-ref kept kind '())))
                      (cons value (if (< (length others) 20) others (list-head others 19)))))))
    (when (and (positive? depth) (list? value))
      (for-each (lambda (member) (loop member (1- depth)))
                (if (> (length value) 20) (list-head value 20) value))))
  value)
;; What observers are handed comes as the world commits, which is not the same in each run: callbacks
;; see nothing of it, or they would not be the same when they run again.
(define observed '())
(define (keep-later! value) (set! observed (cons value observed)))
(define (keep-observed!)
  (for-each keep! (reverse observed))
  (set! observed '()))
(define (pick list number)
  (if (null? list) 'none (list-ref list (modulo number (length list)))))
(define (a-kept kind number) (pick (hashq-ref kept kind '()) number))
;; Of any kind.
(define (a-kept-thing number)
  (a-kept (pick (sort (hash-map->list (lambda (kind _) kind) kept)
                      (lambda (a b) (string<? (symbol->string a) (symbol->string b))))
                (quotient number 20))
          (modulo number 20)))
(define (a-body number) (pick (world-bodies) number))
(define (a-multibody number) (pick (world-multibodies) number))
;; What is held together: the END of the first such pair.
(define (a-held end)
  (let ((bodies (world-bodies)))
    (or (any (lambda (a)
               (and=> (find (lambda (b) (and (not (eq? a b)) (attached? a b))) bodies)
                      (lambda (b) (end (list a b)))))
             bodies)
        'none)))

(define other-world (make-world))
(define other-body
  (parameterize ((current-world other-world))
    (add-body! #:name "ball" #:shape (sphere 0.1))
    (add-body! #:name "alien" #:shape (sphere 0.1) #:position #(3 0 0))))

;; How often each procedure returned.
(define returns (make-hash-table))
(define (returned! name) (hash-set! returns name (1+ (hash-ref returns name 0))))
;; NAME is that of a procedure, or (setter NAME); the first of several values counts.
(define-syntax-rule (made (name argument ...))
  (let ((value (name argument ...)))
    (returned! 'name)
    value))

;; A procedure that does CALLS when it is called, and returns RESULT.  What it is handed and what they
;; return are kept while it runs: a callback is the same when it runs again.
(define-syntax-rule (doing (call ...) result)
  (let ((bodies (list (lambda () call) ...)))
    (lambda arguments
      (let ((before (hash-map->list cons kept)))
        (dynamic-wind
          (const #t)
          (lambda ()
            (for-each keep! arguments)
            (for-each (lambda (body) (keep! (body))) bodies)
            result)
          (lambda ()
            (hash-clear! kept)
            (for-each (match-lambda ((kind . values) (hashq-set! kept kind values))) before)))))))

;; Errors of EXPRESSION are as good as values; Ctrl-C is not.
(define-syntax-rule (attempt expression)
  (catch #t
    (lambda () expression)
    (lambda (key . args)
      (when (eq? key 'timewarp-interrupted) (apply throw key args))
      key)))

;; ---- files that calls read ----

(define (write-files!)
  (for-each (match-lambda
              ((name . text)
               (when (file-exists? name) (delete-file name))
               (call-with-output-file name (lambda (port) (display text port)))))
            file-texts))

(define file-texts
  '(("tetra.obj" . "mtllib tetra.mtl
v 0 0 0\nv 0.4 0 0\nv 0 0.4 0\nv 0 0 0.4
vt 0 0\nvt 1 0\nvt 0 1
usemtl skin
f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nusemtl bare\nf 2/1 3/2 4/3\nf 3/1 1/2 4/3\n")
    ("tetra.mtl" . "newmtl skin\nmap_Kd tetra.pgm\nnewmtl bare\nKd 0 0 1\nmap_Kd none.png\n")
    ("tetra.pgm" . "P5\n2 2\n255\nabcd")
    ("tetra.stl" . "solid tetra
facet normal 0 0 -1 outer loop vertex 0 0 0 vertex 0 0.4 0 vertex 0.4 0 0 endloop endfacet
facet normal 0 -1 0 outer loop vertex 0 0 0 vertex 0.4 0 0 vertex 0 0 0.4 endloop endfacet
facet normal 1 1 1 outer loop vertex 0.4 0 0 vertex 0 0.4 0 vertex 0 0 0.4 endloop endfacet
facet normal -1 0 0 outer loop vertex 0 0.4 0 vertex 0 0 0 vertex 0 0 0.4 endloop endfacet
endsolid tetra\n")
    ("arm.urdf" . "<robot name=\"urdf-arm\">
<link name=\"arm-1\"><inertial><mass value=\"1\"/>
<inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>
<collision><geometry><box size=\"0.2 0.2 0.2\"/></geometry></collision></link>
<link name=\"arm-2\"><inertial><mass value=\"1\"/>
<inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>
<collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>
<joint name=\"elbow\" type=\"continuous\"><parent link=\"arm-1\"/><child link=\"arm-2\"/>
<origin xyz=\"0.4 0 0\"/><axis xyz=\"0 1 0\"/></joint></robot>\n")
    ("scene.scm" . "(use-modules (timewarp))
(scene #:duration 0.05)
(add-body! #:name \"ball\" #:shape (sphere 0.1) #:slots '((n . 0)))
(add-body! #:shape (half-space #(0 0 1) -0.15) #:fixed? #t)\n")))

;; ---- drawing ----

(define state (seed->random-state 0))
(define (draw n) (random n state))
(define (chance share) (< (random 1.0 state) share))
(define (one-of list) (list-ref list (draw (length list))))
(define-syntax-rule (one-of-these expression ...)
  ((one-of (list (lambda () expression) ...))))
(define (uniform from to) (+ from (* (- to from) (random 1.0 state))))
(define (short x) (/ (round (* 100 x)) 100))

(define numbers
  '(0 1 -1 2 0.5 -0.5 1e-3 10 0.0 -0.0 1/3 1e10 1e-10 1e300 -1e300 1e-300 5e-324 1e30
    1e-30 1e15 1e18
    +nan.0 +inf.0 -inf.0 +i 4294967296 9223372036854775808 -5 (expt 10 400) (/ (expt 10 400) 3)))
(define times
  '(0 0.01 0.05 0.1 0.1 0.2 0.3 0.5 0.7 -1 +nan.0 +inf.0 -inf.0 1e300 -1e300 "0" #t (expt 10 400)))
(define names '("ball" "body-0" "x" "" "alien" "a b" "ä"))
(define files
  '("a.png" "b.png" "a.csv" "b.csv" "scene.scm" "none/a.png" "" "." "frames" "f/%03d.png" "%d%d"
                "a.jpg" "tetra.obj" "tetra.stl" "arm.urdf"))
(define symbols
  '('rubber 'steel 'collision 'frame 'fusion 'fission 'timewarp 'best 'draft 'normal 'anchored
                  'smooth 'n 'list 'chatterjee-ruina 'stronge 'conservative))

(define (a-vector)
  (if (chance 0.85)
      (vector (short (uniform -2 2)) (short (uniform -2 2)) (short (uniform -1 3)))
      (one-of '(#(0 0 0) #(1e300 0 0) #(1e-300 0 0) #(0 0 1e30) #(5e-324 0 0) #(1e12 1 1) #(0 0 1e15)
                '(1 0 1) (f64vector 0 1 1) #(0 0 +nan.0) #(+inf.0 0 0) #(1 2) #(1 2 x) '(1 2 . 3)
                (circular 1 2 3) #(1/3 1/7 1/9) #(1e150 1e150 1e150)))))

(define (a-quaternion)
  (one-of '(#(1 0 0 0) #(0 1 0 0) #(1 1 0 0) #(0.5 0.5 0.5 0.5) #(0 0 0 0) #(1e-300 0 0 0)
            #(1e300 1e300 0 0) #(1 0 0) (rotation #(0 0 1) 0.3) (rotation #(1 2 3) 2))))

(define (a-length) (if (chance 0.8) (short (uniform 0.05 1)) (one-of numbers)))

(define (some-points) `(list ,@(map (lambda _ (a-plain-vector)) (iota 5))))
(define (some-triangles)
  `(list ,@(map (lambda _ (list->vector (map (lambda _ (draw (if (chance 0.98) 5 9))) (iota 3))))
                (iota (draw 6)))))

(define (a-shape)
  (one-of-these `(sphere ,(a-length))
                `(box ,(a-length) ,(a-length) ,(a-length))
                `(cylinder ,(a-length) ,(a-length))
                `(,(one-of '(capsule cone)) ,(a-length) ,(a-length))
                `(ellipsoid ,(a-length) ,(a-length) ,(a-length))
                `(half-space #(0 0 1) ,(short (uniform -1 0)))
                `(union (sphere ,(a-length)) (placed (box 0.2 0.2 0.2) #:position ,(a-vector)))
                `(convex (list ,@(map (lambda _ (a-vector)) (iota (+ 4 (draw 6))))))
                `(rock #:size ,(a-length))
                `(load-shape ,(one-of '("tetra.obj" "tetra.stl")))
                `(triangle-mesh ,(some-points) ,(some-triangles))
                `(a-kept 'shape ,(draw 20))))

;; Mostly what a callback was handed just now.
(define (a-view) `(a-kept 'view ,(if (chance 0.7) (draw 3) (draw 20))))

(define (some-keyframes)
  (one-of-these `(keyframes '((0 #(0 0 0)) (0.02 ,(a-plain-vector))) #:smooth? ,(chance 0.5))
                `(keyframes '((0 #(1 0 0)) (0.01 #(1 0 1) #(0 1 0 0))))
                `(keyframes '((0 #(0 0 0)) (1e-300 #(1 0 0))))
                `(lambda (time) (values (vector (* 0.5 time) 0 2) #(1 0 0 0)))
                `(lambda (time) ,(a-wild-value))))

(define (a-plain-vector)
  (vector (short (uniform -2 2)) (short (uniform -2 2)) (short (uniform -1 3))))

(define (a-link depth)
  `(link ',(one-of '(n arm-1 arm-2)) #:joint ,(a-joint) #:shape ,(a-shape)
         ,@(if (chance 0.3) (list (a-link depth)) '())
         ,@(if (chance 0.1) (list (a-wild-value)) '())))

(define (a-joint)
  (one-of-these `(revolute #:axis ,(a-vector)) '(revolute #:axis #(0 1 0) #:limits '(-1 2))
                '(prismatic #:stiffness 100 #:damping 1) '(spherical #:at #(0 0 0.5))
                '(spherical #:limits 0.4) '(universal)
                '(spherical #:limits 1 #:axis #(0 0 1) #:restitution 0.5)
                '(weld #:at #(0.5 0 0))))

(define (a-procedure depth)
  (if (zero? depth)
      (one-of '(list car (lambda arguments #f) (lambda (time) 1) (lambda () 1)))
      `(doing ,(map (lambda _ (let ((call `(made ,(a-call-inside (1- depth)))))
                                (if (chance 0.8) `(attempt ,call) call)))
                    (iota (draw 4)))
              ,(one-of '(#f #f #f 1 +nan.0 'x 0.02)))))

(define (a-wild-value)
  (one-of-these (one-of numbers) (one-of numbers) (one-of names) (one-of files) (one-of symbols)
                #t #f ''() '*unspecified* #\a #:shape (a-vector) (a-quaternion) (a-shape)
                `(a-body ,(draw 10)) 'other-body 'other-world '(current-world)
                (a-view) `(a-kept-thing ,(draw 400)) `(a-kept-thing ,(draw 400))
                '(circular 1 2) '(list (circular 1 2)) '(shared 50)
                ''(1 . 2) ''(a b) ''((a . 1)) '(make-hash-table) '(make-thing 1) '(u8vector 1 2 3)
                '(make-array 0 2 2) '(make-array 0) '(current-output-port) '(make-string 300 #\x)
                #() '(delay 1)
                `(list ,@(map (lambda _ (one-of numbers)) (iota (draw 4))))
                '(make-vector 1000 0) 'car '(random-state-from-platform)))

;; Of calls that callbacks make.
(define (outside-callbacks? depth) (= depth 2))
;; One of the first COUNT that are loose, or of ten all; in callbacks mostly a view.
(define (a-body-or-view count depth)
  (if (chance (if (outside-callbacks? depth) 0.9 0.4))
      `(a-body ,(+ (if (< count 10) 3 0) (draw count)))
      (a-view)))

;; What a parameter of that name is usually given.
(define (plausible name depth)
  (case name
    ((shape s) (a-shape))
    ((radius length x y z size height offset spacing) (a-length))
    ((scale) (one-of '(1 0.5 -1 1e-3 1e300 #(1 2 3))))
    ((heights) (one-of '('((0 0 0) (0 0.1 0)) '((0 0) (1 0) (0 2)) '((0)) '((0 1) (2))
                         (make-array 0.1 3 4))))
    ((title) (one-of names))
    ((policy) (one-of '('timewarp 'conservative '(retroactive 0.01))))
    ((on-overlap) (one-of '('refuse 'push)))
    ((linear quadratic rolling-friction spinning-friction share angle max-distance)
     (one-of '(0 0.1 0.5 2 1e300 -1)))
    ((impact-law) (one-of '('poisson 'stronge 'chatterjee-ruina)))
    ((object) `(a-kept-thing ,(draw 400)))
    ((bare? convex-hull?) (one-of '(#t #f)))
    ((random-state) '(seed->random-state 3))
    ((points) `(list ,@(map (lambda _ (a-vector)) (iota (+ 4 (draw 8))))))
    ((position velocity angular-velocity eye normal axis center-of-mass up direction v
               gravity)
     (a-vector))
    ((colors) (one-of '('((0 #(0 0 0)) (1 #(1 1 1))) '((1 #(0 0 0)) (0 #(1 1 1)))
                        (lambda (x y height) #(0.5 0.5 0)) '((#(0 0 0) #(1 0 0)) (#(0 1 0) #(0 0 1))))))
    ((color zenith horizon ground) (one-of '(#(1 0 0) #(0.2 0.5 1) #(0 0 0))))
    ((orientation q) (a-quaternion))
    ((body contact-body) (a-body-or-view 10 depth))
    ((loose-body one-of-two) (a-body-or-view 4 depth))
    ((view) (a-view))
    ((follow) `(a-body ,(draw 10)))
    ((multibody) (if (chance (if (outside-callbacks? depth) 0.95 0.6))
                     `(a-multibody ,(draw 3))
                     (a-view)))
    ((joint) (a-joint))
    ((at point at-a at-b) (a-vector))
    ((from) (one-of-these (a-vector) `(a-body ,(draw 10)) (a-view)))
    ((bodies ignore) (one-of-these `(a-body ,(draw 10)) `(list (a-body ,(draw 10)))
                                   `(list ,(a-view) ,(a-view))))
    ((base) (one-of `('fixed 'free (a-body ,(draw 6)))))
    ((limits) (one-of '('(-1 1) '(0 0.5) '((-1 1) (0 2)) '(1 -1) #(-3 3) 0.7 4)))
    ((target) (one-of-these (a-vector) (short (uniform -2 2)) (a-quaternion) #(0.1 0.2)))
    ((target-velocity) (one-of-these (short (uniform -2 2)) (a-vector) #(0.1 0.2)))
    ((max-torque) (one-of '(1 100 1e300 +inf.0 -1)))
    ((positions) (one-of-these `(joint-positions (a-multibody ,(draw 3))) #(0.3 -0.2) #(1)))
    ((velocities accelerations)
     (if (chance 0.75)
         `(joint-velocities (a-multibody ,(draw 3)))
         (one-of '(#(0.3 -0.2) #(0 0 0 1 0 0 0)))))
    ((coordinate) (one-of-these (short (uniform -1 1)) (short (uniform -1 1)) (short (uniform -1 1))
                                (a-vector) (a-quaternion) #(0.1 0.2)))
    ((tolerance) (one-of '(1e-6 1e-3 0 -1)))
    ((starts) (one-of '(1 6 0)))
    ((rest) (one-of-these (short (uniform -1 1)) (a-quaternion)))
    ((stop-stiffness) (one-of '(1e3 1e5 0 -1)))
    ((targets) (if (chance 0.5) 
                   `(a-body ,(draw 10))
                   `(list (a-body ,(draw 10)) (a-body ,(draw 10)))))
    ((a b) (one-of-these `(a-body ,(draw 10)) `(a-body ,(draw 10)) (a-view) #t
                         ''rubber))
    ((contact collision frame squeezing) `(a-kept ',name ,(draw 20)))
    ((hit) (one-of-these `(a-kept 'hit ,(draw 20)) `(ray-cast ,(a-plain-vector) #(0 0 -1))))
    ((servo) (one-of-these `(a-kept 'servo ,(draw 20)) '(servo #:stiffness 10 #:damping 1)))
    ((checkpoint) (one-of-these `(a-kept '<checkpoint> ,(draw 20)) '(checkpoint)))
    ((callback observer spring drag force) `(a-kept ',name ,(draw 20)))
    ((procedure) (a-procedure depth))
    ((kind) (one-of '('collision 'fusion 'fission 'frame 'frame 'squeezed)))
    ((density mass) (if (chance 0.7) (short (uniform 1 2000)) (one-of numbers)))
    ((inertia) (one-of '(#(1 1 1) #(1 2 3) #(1 1 3) #(1e-300 1e-300 1e-300) #(1e300 1e300 1e300))))
    ((fixed? smooth? visible? contacts? strict? self-collisions?) (one-of '(#t #f)))
    ((y-or-z) (one-of '('y 'z #f)))
    ((decompose) (one-of '(#f #t 50 3)))
    ((package-path) (one-of '("." '("." "nowhere") '())))
    ((visual) (one-of-these '(load-visual "tetra.obj") '(box 0.1 0.2 0.3) '(half-space #(0 0 1) 0)
                            '(list (sphere 0.1) (load-visual "tetra.stl" #:scale 0.1)) ''()))
    ((motion) (some-keyframes))
    ((list) (one-of '('((0 #(0 0 0)) (1 #(0 0 1))) '((0 #(0 0 0) #(0 1 0 0))) '()
                      '((0 #(1e300 0 0)) (1 #(0 0 0))))))
    ((max-speed) (one-of '(1 0.5 10 1e-3 #f)))
    ((material) (one-of '('rubber 'steel)))
    ((name) (one-of-these ''n ''arm-1 ''arm-2 (one-of names)))
    ((slots) ''((n . 0) (list 1 2)))
    ((value) (one-of-these (a-vector) (one-of numbers) ''(1 2)))
    ((restitution friction) (if (chance 0.8) (short (uniform 0 1)) (one-of numbers)))
    ((stiffness) (one-of '(1e5 1e3 1e3 1e300 1e-300 1e8)))
    ((damping) (one-of '(0 1 1e300 1e-300 100)))
    ((fusion-speed) (one-of '(0 0.1 1 1e300)))
    ((friction-law) (one-of '('anchored 'smooth)))
    ((until seconds duration start) (one-of times))
    ((period) (one-of '(0.01 0.003 1 1e-300 5e-324 #f 1e300)))
    ((fps) (one-of '(30 100 1e-300 1e300 1/3 240)))
    ((group-check-rate) (one-of '(480 100 1e300 1e-300)))
    ((accuracy) (one-of '(1e-6 1e-4 1e-12 0.1)))
    ((seed) (one-of '(0 1 7 18446744073709551615)))
    ((fov) (one-of '(0.5 1 3 1e-300)))
    ((grain) (one-of '(0 0.3 1 7)))
    ((turn) (one-of '(0 0.5 -3 1e300)))
    ((fog) (one-of '(0 0.1 0.9)))
    ((file frames) (one-of files))
    ((some-points) (some-points))
    ((triangles) (some-triangles))
    ((mesh-file) (one-of '("tetra.obj" "tetra.stl" "arm.urdf")))
    ((robot-file) (one-of '("arm.urdf" "arm.urdf" "tetra.obj")))
    ((scene-file) (one-of '("scene.scm" "scene.scm" "tetra.obj" "none.scm")))
    ((slot-name) (one-of '('n 'n 'n 'x)))
    ((body-name) (one-of '("ball" "body-0" "x")))
    ((multibody-name) (one-of '("arm" 'arm "urdf-arm" "x")))
    ((joint-name) (one-of '('arm-1 'arm-1 "arm-1" 'arm-2 'arm-2 "arm-2" 'n)))
    ((picture-file) (one-of '("a.png" "b.png" "f/a.png" "none.jpg" "")))
    ((picture-size) (one-of '('(16 16) "16x8" '(0 1) "16")))
    ((held-a) (if (chance 0.7) '(a-held car) (a-body-or-view 4 depth)))
    ((held-b) (if (chance 0.7) '(a-held cadr) (a-body-or-view 4 depth)))
    ((poses events) (one-of files))
    ((movie) (one-of '("a.mp4" "b.gif" "c.avi" "" "none/d.webm")))
    ((quality) ''draft)
    ((vertices) (one-of '(8 16 4 200)))
    (else (a-wild-value))))

;; Where a parameter's name alone doesn't say what it is given.
(define (parameter-of procedure name)
  (match (list procedure name)
    (((or 'v+ 'v- 'dot 'cross 'norm 'normalize 'lerp) (or 'a 'b 'first 'rest)) 'v)
    (('v* 'a) 'share)
    (('v* 'b) 'v)
    (('q* 'quaternions) 'q)
    (('union 'shapes) 'shape)
    (('ellipsoid _) 'radius)
    (('universal 'second-axis) 'axis)
    ((('setter (or 'position 'velocity 'angular-velocity 'applied-force 'applied-torque)) 'value) 'v)
    ((('setter 'orientation) 'value) 'q)
    ((('setter 'joint-servo) 'value) 'servo)
    ((('setter 'joint-positions) 'value) 'positions)
    ((('setter (or 'joint-velocities 'joint-torques)) 'value) 'velocities)
    ((('setter (or 'joint-position 'joint-velocity 'joint-torque)) 'value) 'coordinate)
    (((or 'add-spring! 'attach! 'attached? 'spring-force 'hold-force 'hold-torque
          'closest-points 'contact-parameters)
      (or 'a 'b))
     'one-of-two)
    (('find-body 'name) 'body-name)
    (((or 'load-shape 'load-visual) 'file) 'mesh-file)
    (('triangle-mesh 'points) 'some-points)
    (((or 'load-shape 'load-visual) 'up) 'y-or-z)
    (('load-urdf 'file) 'robot-file)
    (('load-scene 'file) 'scene-file)
    (('render! 'file) 'picture-file)
    (('simulate! 'size) 'picture-size)
    (((or 'slot 'slot? '(setter slot)) 'name) 'slot-name)
    (((or 'slot 'slot? ('setter _)) 'body) 'loose-body)
    (('ray-cast 'from) 'v)
    (('detach! 'a) 'held-a)
    (('detach! 'b) 'held-b)
    (('find-multibody 'name) 'multibody-name)
    (((or 'link-body 'joint-limits 'joint-position 'joint-velocity 'joint-torque 'joint-servo
          'joint-max-torque 'joint-max-velocity 'joint-force 'joint-moment 'jacobian 'forward-kinematics 'inverse-kinematics
          ('setter _))
      'name)
     'joint-name)
    (_ name)))

;; What could take minutes though nothing is wrong has only a few values.
(define (argument name depth wildness)
  (cond ((memq name '(until seconds duration)) (one-of times))
        ((memq name '(period fps group-check-rate quality)) (plausible name depth))
        ((chance wildness) (a-wild-value))
        (else (plausible name depth))))

;; ---- procedures ----

(define (arguments-of procedure)
  (let* ((getter (if (procedure-with-setter? procedure) (procedure* procedure) procedure))
         (arguments (match (and (program? getter) (program-arguments-alists getter))
                      ((first . _) first)
                      (_ '()))))
    (list (or (assq-ref arguments 'required) '())
          (or (assq-ref arguments 'optional) '())
          (assq-ref arguments 'rest)
          (map car (or (assq-ref arguments 'keyword) '())))))

(define (procedure* accessor) (procedure accessor))

;; (NAME required optional rest? keywords) of every procedure that is exported.
(define procedures
  (let ((found '()))
    (for-each
     (lambda (module)
       (module-for-each
        (lambda (name variable)
          (let ((value (variable-ref variable)))
            (when (procedure? value)
              (set! found (cons (list name (arguments-of value)) found))
              (when (procedure-with-setter? value)
                (set! found (cons (list `(setter ,name)
                                        (match (arguments-of value)
                                          ((required . _) `((,@required value) () #f ()))))
                                  found))))))
        (resolve-interface module)))
     '((timewarp) (timewarp vectors)))
    (sort found (lambda (a b) (string<? (object->string (car a)) (object->string (car b)))))))

(define (some-keywords name keywords depth wildness)
  (append-map (lambda (keyword)
                (if (chance (if (memq keyword '(#:shape #:size #:quality #:stiffness #:position)) 0.85 0.25))
                    (list keyword (argument (parameter-of name (keyword->symbol keyword))
                                            depth wildness))
                    '()))
              keywords))

;; Runs are short: without `until' they would take the scene's duration, which may be long.
(define (keywords-for name keywords depth wildness)
  (case name
    ((run! simulate!)
     (append (list #:until (one-of times))
             (some-keywords name (delq #:until keywords) depth wildness)))
    ((render!)
     (append '(#:size '(16 16) #:quality 'draft)
             (some-keywords name (delq #:quality (delq #:size keywords)) depth wildness)))
    (else (some-keywords name keywords depth wildness))))

(define (call-of entry depth)
  (match entry
    ((name (required optional rest? keywords))
     (let* ((wildness (one-of '(0 0 0 0.1 0.5)))
            (arguments (append (map (lambda (parameter)
                                      (argument (parameter-of name parameter) depth wildness))
                                    required)
                               (if (and rest? (null? keywords))
                                   (map (lambda _ (argument (parameter-of name rest?) depth wildness))
                                        (iota (draw 4)))
                                   '())
                               (if (null? keywords)
                                   '()
                                   (keywords-for name keywords depth wildness))
                               (if (and rest? (memq name '(link add-multibody!)))
                                   (map (lambda _ (a-link depth)) (iota (1+ (draw 2))))
                                   '()))))
       (cons name
             (cond ((chance 0.97) arguments)
                   ((and (pair? arguments) (chance 0.5)) (cdr arguments))
                   (else (append arguments (list (a-wild-value))))))))))

;; What makes scenes interesting comes more often; the others take turns.
(define favourites '(add-body! add-callback! on-collision! observe! run-for! run! step!))

;; What an episode begins with: bodies well apart over a ground, so that runs happen, some that are
;; in touch, and one that is going to be squeezed.
(define (a-beginning number)
  (case number
    ((0) `(add-body! #:shape (half-space #(0 0 1) -1) #:fixed? #t #:material 'steel
                     #:slots '((n . 0))))
    ((1) `(add-multibody! #:name 'arm #:position #(0 -3 0.5) #:base ,(a-base)
            (link 'arm-1 #:joint ,(a-joint) #:shape (box 0.3 0.2 0.1)
              #:slots '((n . 0))
              (link 'arm-2 #:joint ,(a-joint) #:shape (placed (sphere 0.1) #:position #(0.4 0 0))
                #:slots '((n . 0))))))
    ;; strikes the ground within 0.01 s of any run
    ((2) '(add-body! #:name "ball" #:shape (sphere 0.2) #:position #(4.4 0 -0.75)
                     #:velocity #(0 0 -5) #:slots '((n . 0))))
    ((3) '(add-body! #:shape (box 0.4 0.4 0.4) #:position #(8.8 0 -0.8) #:slots '((n . 0))))
    ((4) '(add-body! #:shape (sphere 0.2) #:position #(8.8 4 -0.8) #:slots '((n . 0))))
    ((5) `(add-body! #:shape (box 0.4 0.4 0.2)
                     #:slots '((n . 0))
                     #:motion (keyframes '((0 #(8.8 4 -0.5)) (,(uniform 0.01 0.04) #(8.8 4 -0.53))))))
    ((6) '(map (lambda (kind) (observe! kind keep-later!)) '(collision frame squeezed)))
    ((7) (one-of '((attach! (a-body 3) (a-body 4))
                   (list (add-spring! (a-body 3) (a-body 5) #:stiffness 100)
                         (add-drag! (a-body 3) #:linear 1)
                         (add-force! (a-body 4) (lambda (time view) #(0.1 0 0)))))))
    ((8) `(add-callback! (list (a-body ,(+ 3 (draw 2))) (a-body 1)) ,(a-procedure 2) #:period 0.01))
    ((9) `(run! #:until ,(one-of '(0.01 0.05 0.05))))
    ((10) '(contacts))
    (else
     (match (call-of (assq 'add-body! procedures) 2)
       ((name . arguments)
        (cons name (with-position (vector (* 2.2 (modulo number 3)) (* 2.2 (quotient number 3)) 0)
                     arguments)))))))

;; stands, or goes to and fro with jumps
(define (a-base)
  (if (chance 0.5)
      ''fixed
      `(add-body! #:shape (box 0.1 0.1 0.1)
                  #:motion (keyframes '((0 #(0 0 0)) (,(uniform 0.01 0.3) #(0.2 0 0.1))
                                        (0.4 #(0 0 0) ,(one-of '(#(1 0 0 0) #(0.8 0 0.6 0))))
                                        (,(uniform 0.5 2) #(0 0.3 0)))
                                      #:smooth? ,(chance 0.3)))))

(define (with-position position arguments)
  (match arguments
    (() (list #:position position))
    ((#:position _ . rest) (cons* #:position position rest))
    ((argument . rest) (cons argument (with-position position rest)))))

(define (a-favourite depth) (call-of (assq (one-of favourites) procedures) depth))
;; Callbacks mostly look at what they are handed.
(define (a-call-inside depth)
  (if (chance 0.2)
      (a-favourite depth)
      (call-of (one-of (if (chance 0.5) that-take-views procedures)) depth)))
(define that-take-views
  (append-map (lambda (entry)
                (match entry
                  ((_ (required . _))
                   ;; what takes nothing else comes more often
                   (make-list (cond ((memq 'view required) 5)
                                    ((any (lambda (name) (memq name '(body multibody a))) required) 1)
                                    (else 0))
                              entry))))
              procedures))
;; The call at a place in the order of all episodes.
(define (a-call-in-turn place depth)
  (if (chance 0.25)
      (a-favourite depth)
      (call-of (list-ref procedures (modulo place (length procedures))) depth)))
