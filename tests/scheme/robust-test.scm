;; Scenes nobody tuned for that once went wrong, each by the name it was reported under, with its
;; verdict: depth, energy, counters of work, or one hash under every schedule.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors))

(test-begin "robust")

(define (stat key) (assq-ref (statistics) key))

;; The floor and four walls of half width HALF, fixed.
(define (pit! half)
  (ground)
  (for-each (lambda (n) (add-body! #:shape (half-space n (- half)) #:fixed? #t))
            '(#(1 0 0) #(-1 0 0) #(0 1 0) #(0 -1 0))))

;; Six walls of THICKNESS around a cube of half width HALF.
(define (room! half thickness)
  (let ((middle (+ half (/ thickness 2))) (long (* 2.2 (+ half thickness))))
    (for-each (lambda (sign)
                (for-each (lambda (size at) (add-body! #:shape (apply box size) #:fixed? #t
                                                       #:position at))
                          (list (list thickness long long) (list long thickness long)
                                (list long long thickness))
                          (let ((at (* sign middle)))
                            (list (vector at 0 0) (vector 0 at 0) (vector 0 0 at)))))
              '(1 -1))))

;; The world's end time is reached, and what was asked for meanwhile holds.
(define (run-in-steps! until steps look)
  (do ((k 1 (1+ k))) ((> k steps))
    (run! #:until (/ (* k until) steps))
    (look)))

;; SCENE's text gives the same hash whatever the schedule.
(define (test-one-hash name until . scene)
  (let ((file (string-append name ".scm")))
    (apply write-file file "(use-modules (timewarp) (timewarp vectors))" scene)
    (let* ((hash (lambda (option)
                   (let ((result (run file (format #f "--until=~a" until) "--hash" "--quiet"
                                      option)))
                     (and (zero? (run-status result)) (last (lines-of (run-output result)))))))
           (plain (hash "")))
      (test-assert (string-append name " runs") plain)
      (for-each (lambda (option) (test-equal (string-append name " " option) plain (hash option)))
                '("--pieces=7" "--undo-redo" "--adversary=3" "--adversary=5,0.05")))))

;; Parallel drums that touch along a line, at rest, without gravity: no certificate holds.
(in-world ()
  (scene #:gravity #(0 0 0))
  (for-each (lambda (x) (add-body! #:shape (cylinder 0.25 0.5) #:position (vector x 0 0.25)))
            '(0 0.5))
  (run! #:until 1)
  (test-assert "cylinders-side-by-side: time goes on" (< (stat 'distance_queries) 100)))

;; A drum of 328 kg under grams: at the second fusion 0.49 J appeared.
(in-world ()
  (set-contact-parameters! #t #t #:restitution 0.8 #:friction 1)
  (ground)
  (add-body! #:shape (cylinder 0.07076572550731859 0.14153145101463718) #:density 147572.7933618642
             #:position #(-0.00896301597242177 0 0.07076572550731859))
  (add-body! #:shape (sphere 0.030914316830073535) #:density 3.543790887390489
             #:position #(0 0 0.19520602031650816))
  (for-each (lambda (edge density x z)
              (add-body! #:shape (box edge edge (/ edge 20)) #:density density
                         #:position (vector x 0 z)))
            '(0.041529488009165456 0.08013915054110846 0.06198898775035049)
            '(36.31642069363942 3.9704628563900677 121.07185759609582)
            '(0.0010732930363267555 0.005420656666341963 -0.002901785322186734)
            '(0.22715857434681083 0.2529605427823651 0.2565137462396516))
  (let ((lowest (total-energy)) (rise 0))
    (run-in-steps! 0.4 80
      (lambda ()
        (set! rise (max rise (- (total-energy) lowest)))
        (set! lowest (min lowest (total-energy)))))
    (test-assert (format #f "energy-at-fusion: rises by ~a J" rise) (< rise 1e-4))))

;; Plates of 27 um at 800 m/s whose tips turn at 2.4 km/s: one dipped 0.2 mm into a fixed half-space
;; between two points of the grid of times.
(in-world ()
  (scene #:gravity #(0 0 0))
  (set-contact-parameters! #t #t #:restitution 1 #:friction 1.3)
  (add-body! #:shape (half-space #(1 0 0) 0) #:fixed? #t)
  (let* ((state (seed->random-state 12)) (edges '(0.00217 0.00229 2.7e-5))
         (draw (lambda (most) (* 2 most (- (random 1.0 state) 0.5))))
         (plates
          (map (lambda (k)
                 (add-body! #:shape (apply box edges) #:position (vector 0.0026 (* k 0.0158) 0)
                            #:orientation (vector (draw 1) (draw 1) (draw 1) (draw 1))
                            #:velocity (vector -800 (draw 200) (draw 200))
                            #:angular-velocity (vector (draw 1.4e6) (draw 1.4e6) (draw 1.4e6))))
               (iota 20)))
         (reach (lambda (plate)           ; how far it is beyond x = 0
                  (- (apply + (map (lambda (edge axis)
                                     (abs (* 0.5 edge
                                             (vector-ref (rotate (orientation plate) axis) 0))))
                                   edges '(#(1 0 0) #(0 1 0) #(0 0 1))))
                     (vector-ref (position plate) 0))))
         (deepest 0))
    (run-in-steps! 7.887e-6 200
      (lambda () (set! deepest (apply max deepest (map reach plates)))))
    (test-assert "fast-spin: plates hit" (> (stat 'collisions) 5))
    (test-assert (format #f "fast-spin: ~a m deep" deepest) (< deepest 1e-7))))

;; Balls through a funnel onto pegs, between two planes: many short arcs.
(in-world ()
  (set-contact-parameters! #t #t #:restitution 0.35 #:friction 0.2)
  (ground)
  (add-body! #:shape (half-space #(0 -1 0) -0.03) #:fixed? #t)
  (add-body! #:shape (half-space #(0 1 0) -0.03) #:fixed? #t)
  (do ((row 0 (1+ row))) ((= row 5))
    (do ((k 0 (1+ k))) ((> k row))
      (add-body! #:shape (cylinder 0.012 0.06) #:orientation (rotation #(1 0 0) (/ (acos -1) 2))
                 #:position (vector (* 0.1 (- k (/ row 2))) 0 (- 1.5 (* row 0.09))) #:fixed? #t)))
  (for-each (lambda (sign)
              (add-body! #:shape (box 0.6 0.06 0.01) #:fixed? #t
                         #:position (vector (* sign 0.3) 0 1.85)
                         #:orientation (rotation #(0 1 0) (* sign -0.8))))
            '(1 -1))
  (let ((state (seed->random-state 7)))
    (do ((k 0 (1+ k))) ((= k 36))
      (add-body! #:shape (sphere 0.018)
                 #:position (vector (+ (* 0.002 (random 1.0 state)) (* 0.05 (- (modulo k 6) 2.5))) 0
                                    (+ 1.95 (* 0.05 (quotient k 6)))))))
  (run! #:until 1)
  (test-assert (format #f "galton: ~a steps" (stat 'implicit_steps))
    (< 1000 (stat 'implicit_steps) 10000))
  (test-assert "galton: nothing is deep" (< (stat 'max_penetration) 0.001)))

;; A drum of 1 mm slides along walls of 0.4 mm at 100 m/s: with checks at a rate for large bodies it
;; sank by 18 % of its width.
(in-world ()
  (scene #:gravity #(0 0 0))
  (set-contact-parameters! #t #t #:restitution 0 #:friction 1)
  (room! 0.0147 0.000422)
  (add-body! #:shape (cylinder 0.00099 0.00116)
             #:position #(0.009291913553192609 0.012601222335622865 -0.012194110816589058)
             #:orientation #(-0.9353966781200261 0.1512448305898288
                             0.1431789969286296 -0.28575834304598285)
             #:velocity #(-7.744798526190687 44.71302375317405 -80.10678633642421))
  (run! #:until 0.000685)
  (test-assert "group-check-rate: it meets the walls" (> (stat 'groups) 0))
  (test-assert (format #f "group-check-rate: ~a m deep" (stat 'max_penetration))
    (< (stat 'max_penetration) 1e-5)))

(test-one-hash "hash-adversary-r0092" 0.7
  "(scene #:accuracy 1e-4)"
  "(set-contact-parameters! #t #t #:restitution 0.36 #:friction 1.68)"
  "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
  "(for-each (lambda (n) (add-body! #:shape (half-space n -0.0358) #:fixed? #t))"
  "          '(#(1 0 0) #(-1 0 0) #(0 1 0) #(0 -1 0)))"
  "(define state (seed->random-state 92))"
  "(define (draw most) (* 2 most (- (random 1.0 state) 0.5)))"
  "(define dumbbell (union (placed (box 0.016 0.005 0.006) #:position #(0 0 0))"
  "                        (placed (sphere 0.006) #:position #(0.009 0 0))"
  "                        (placed (box 0.004 0.014 0.006) #:position #(-0.008 0.004 0))))"
  "(do ((k 0 (1+ k))) ((= k 12))"
  "  (add-body! #:shape dumbbell #:position (vector (draw 0.015) (draw 0.015) (+ 0.03 (* k 0.035)))"
  "             #:orientation (vector (draw 1) (draw 1) (draw 1) (draw 1))))")

(test-one-hash "hash-r0181-piston" 6
  "(scene #:gravity #(-7.6 -38.6 -4.6))"
  "(set-contact-parameters! #t #t #:restitution 0.2 #:friction 0)"
  "(for-each (lambda (n) (add-body! #:shape (half-space n -6.85) #:fixed? #t))"
  "          '(#(1 0 0) #(-1 0 0) #(0 1 0) #(0 -1 0) #(0 0 1) #(0 0 -1)))"
  "(add-body! #:shape (box 1.8 1.3 1.2) #:density 7368 #:position #(0.5 -0.3 -2.2)"
  "           #:orientation #(0.52 -0.59 0.04 0.62))"
  "(add-body! #:shape (sphere 1.55) #:position #(1.2 -5.1 5.2))"
  "(add-body! #:shape (box 3.8 4 4.2) #:density 913 #:position #(1.2 3.3 2.4)"
  "           #:orientation #(0.84 -0.08 -0.13 0.53))"
  "(add-body! #:shape (union (box 1.65 0.41 0.62)"
  "                          (placed (box 0.41 1.24 0.62) #:position #(0.62 0.82 0)))"
  "           #:density 142 #:position #(-0.1 4.8 -5) #:orientation #(0.04 -0.3 -0.35 -0.88))"
  "(add-body! #:shape (box 1.37 13.5 13.5)"
  "           #:motion (keyframes '((0 #(-5.48 0 0)) (3.84 #(-0.69 0 0)) (15 #(-5.48 0 0)))))")

;; Stones and balls shaken in a box of 6 mm by next to no gravity: links without contacts in the end
;; test.
(in-world ()
  (scene #:gravity #(0.2066 -0.0612 0.0999))
  (set-contact-parameters! #t #t #:restitution 0.41 #:friction 0.1)
  (room! 0.0039 0.00195)
  (let* ((state (seed->random-state 251))
         (draw (lambda (most) (* 2 most (- (random 1.0 state) 0.5)))))
    (do ((k 0 (1+ k))) ((= k 18))
      (add-body! #:shape (case (modulo k 3)
                           ((0) (sphere 0.001))
                           ((1) (rock #:size 0.0021 #:vertices 20 #:random-state state))
                           (else (box 0.0014 0.0011 0.0012)))
                 #:position (vector (* 0.0026 (- (modulo k 3) 1))
                                    (* 0.0026 (- (modulo (quotient k 3) 3) 1))
                                    (* 0.0026 (- (quotient k 9) 0.5)))
                 #:velocity (vector (draw 0.02) (draw 0.02) (draw 0.02))))
    (run! #:until 1.89)
    (test-equal "segfault-early-end: it ends" 1.89 (world-time))
    (test-assert "segfault-early-end: nothing is deep" (< (stat 'max_penetration) 1e-5))))

;; Balls in a drum of twelve plates that a procedure turns: asked at each pose it was 1.3 million
;; calls and half a million queries for 0.3 s.
(in-world ()
  (set-contact-parameters! #t #t #:restitution 0.2 #:friction 0.5)
  (let* ((calls 0) (sixth (/ (acos -1) 6))
         (plate (lambda (k)
                  (placed (box 0.04 0.28938512782561254 0.3)
                          #:position (v* 0.52 (vector (cos (* k sixth)) (sin (* k sixth)) 0))
                          #:orientation (rotation #(0 0 1) (* k sixth)))))
         (lie (rotation #(1 0 0) (* 3 sixth))))
    (add-body! #:shape (apply union (map plate (iota 12))) #:max-speed 1
               #:motion (lambda (time)
                          (set! calls (1+ calls))
                          (values #(0 0 0) (q* (rotation #(0 1 0) time) lie))))
    (for-each (lambda (y) (add-body! #:shape (half-space (vector 0 y 0) -0.15) #:fixed? #t))
              '(1 -1))
    (do ((k 0 (1+ k))) ((= k 30))
      (add-body! #:shape (sphere 0.025)
                 #:position (vector (* 0.055 (- (modulo k 6) 2.5))
                                    (* 0.06 (- (modulo (quotient k 6) 5) 2)) -0.38)))
    (run! #:until 0.3)
    (test-assert (format #f "slow-procedure-motion: ~a calls" calls) (< calls 1000))
    (test-assert (format #f "slow-procedure-motion: ~a queries" (stat 'distance_queries))
      (< (stat 'distance_queries) 60000))))

;; Rods and plates of 1:1000 in a pit of 31 mm.
(in-world ()
  (set-contact-parameters! #t #t #:restitution 1 #:friction 0.84)
  (pit! 0.015425704740461938)
  (let* ((state (seed->random-state 112))
         (draw (lambda (most) (* 2 most (- (random 1.0 state) 0.5)))))
    (for-each (lambda (k shape)
                (add-body! #:shape shape
                           #:position (vector (draw 0.003) (draw 0.003) (+ 0.009 (* 0.0155 k)))
                           #:orientation (vector (draw 1) (draw 1) (draw 1) (draw 1))))
              (iota 6)
              (list (box 0.0123 6.2e-5 6.2e-5) (cylinder 2.7e-5 0.0067) (box 0.0096 0.0069 1.2e-5)
                    (box 0.0069 2.7e-5 2.7e-5) (cylinder 0.0057 8e-5) (box 0.0128 0.0045 3e-5))))
  (run! #:until 0.8)
  (test-assert (format #f "slow-thin: ~a queries" (stat 'distance_queries))
    (< 1000 (stat 'distance_queries) 150000))
  (test-assert (format #f "slow-thin: ~a steps" (stat 'implicit_steps))
    (< (stat 'implicit_steps) 60000)))

;; Erleben's spike: a pyramid whose tip stands above the bottom of a V, the seam of two pieces.
(in-world ()
  (scene #:gravity #(0 -9.8 0))
  (set-contact-parameters! #t #t #:restitution 0 #:friction 0.5)
  (let* ((prism (lambda (outline)
                  (convex (append-map (lambda (corner)
                                        (match corner
                                          ((x y) (list (vector x y -2) (vector x y 2)))))
                                      outline))))
         (half (lambda (s)
                 (list (prism `((,s -1/2) (,(/ s 2) -1/2) (,s 1/2) (,(/ s 2) 1/2)))
                       (prism `((,(/ s 2) -1/2) (0 -1/2) (0 0) (,(/ s 2) 1/2)))))))
    (add-body! #:shape (apply union (append (half -1) (half 1))) #:fixed? #t #:position #(0 -1 0))
    (let ((spike (add-body! #:position #(0 2.0001 0) #:orientation (rotation #(0 0 1) (acos -1))
                            #:velocity #(1 0 0)
                            #:shape (convex '(#(.5 0 -.5) #(.5 0 .5) #(-.5 0 .5) #(-.5 0 -.5)
                                              #(0 3 0))))))
      (run! #:until 0.9)                  ; later it leans over the rim and falls
      (let ((tip (v+ (position spike) (rotate (orientation spike) #(0 3 0)))))
        (test-assert (format #f "spike-in-crack: the tip is at ~a m" tip)
          (> (vector-ref tip 1) -1.001)))
      (test-assert "spike-in-crack: nothing is deep" (< (stat 'max_penetration) 0.001)))))

;; A wall presses a crate to half its width and goes: it was 14 % deep half a second later.
(in-world ()
  (set-contact-parameters! #t #t #:restitution 0.3 #:friction 0.5)
  (ground)
  (add-body! #:shape (box 0.2 2 2) #:fixed? #t #:position #(-0.1 0 0))
  (let ((crate (add-body! #:shape (box 0.2 0.2 0.2) #:position #(0.2 0 0.1))))
    (add-body! #:shape (box 0.2 2 2)
               #:motion (keyframes '((0 #(0.6 0 0)) (1 #(0.2 0 0)) (2 #(0.2 0 0)) (2.5 #(0.6 0 0)))
                                   #:smooth? #t))
    (run! #:until 1.9)
    (test-assert "squeeze-box: the overlap is shared"
      (close? 0.05 (vector-ref (position crate) 0) 1e-4))
    (run! #:until 3)
    (test-assert "squeeze-box: it is out" (> (vector-ref (position crate) 0) 0.099))))

(clean-up)
(test-end "robust")
