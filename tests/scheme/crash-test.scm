;; Scenes that once killed or hung the program: each ends with a message, or as if nothing had been
;; wrong.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "crash")

(define (run-scene . lines)
  (apply write-file "crash.scm" "(use-modules (timewarp))"
         "(define ball (add-body! #:name \"ball\" #:shape (sphere 0.1) #:position #(0 0 1)))" lines)
  (run "crash.scm" "--until=1" "--quiet"))

(define (fails-with name pattern . lines)
  (let ((result (apply run-scene lines)))
    (test-equal (string-append name ": status 1") 1 (run-status result))
    (test-assert (format #f "~a: ~s" name (run-errors result))
      (string-match pattern (run-errors result)))))

(define (passes name . lines)
  (test-equal name '(0 "done") 
    (list-head (apply run-scene (append lines '("(display \"done\")"))) 2)))

;; ---- callbacks that name their next time ----

(define-syntax-rule (next-time answer shown)
  (fails-with (string-append "a callback that answers " answer)
              (string-append "^crash.scm:3:1: callback of ball at 0.5 s returned the next time " shown
                             "; expected a later time")
              (string-append "(add-callback! ball (lambda (time view) " answer ") #:start 0.5)")))

(next-time "+nan.0" "NaN")
(next-time "(- time 1)" "-0.5")
(next-time "time" "0.5")
(next-time "-inf.0" "-infinity")
(passes "a callback that answers infinity is never called again"
        "(add-callback! ball (lambda (time view) +inf.0))" "(run-for! 0.5)")

;; ---- recorders of a first run that failed ----

(define (failed-then-run record)
  (list (string-append "(false-if-exception (simulate! #:until \"5\" " record "))")
        "(run-for! 0.5)"))

(apply passes "events of a run that did not begin" (failed-then-run "#:events \"e.csv\""))
(apply passes "poses of a run that did not begin" (failed-then-run "#:poses \"p.csv\""))
(unless (string-null? (or (getenv "TW_DRAWS") ""))
  (apply passes "frames of a run that did not begin"
         (failed-then-run "#:frames \"frames\" #:size '(32 32)"))
  (test-assert "draw nothing later" (not (file-exists? (in-folder "frames/00000.png")))))

;; What was registered beside the recorder stays.
(test-equal "an observer stays when a recorder is withdrawn" '(0 "0123")
  (list-head (run-scene "(scene #:fps 10)"
                        "(observe! 'frame (lambda (frame) (display (frame-index frame))))"
                        "(false-if-exception (simulate! #:until \"5\" #:events \"e.csv\"))"
                        "(run! #:until 0.35)" "(exit 0)")
             2))

;; ---- recursions without end ----

;; of CPU, in programs that have ended: other programs may be busy, and slow it down to a third
(define (seconds)
  (let ((spent (times)))
    (/ (+ (tms:cutime spent) (tms:cstime spent)) internal-time-units-per-second 1.0)))

(define (overflows name pattern . lines)
  (let ((start (seconds)))
    (apply fails-with name
           (string-append pattern "a procedure calls itself without end.*; expected") lines)
    (test-assert (format #f "~a: ~a s" name (- (seconds) start)) (< (- (seconds) start) 6))))

(overflows "a callback that calls itself" "^crash.scm:3:.*"
           "(define (f x) (+ 1 (f x)))"
           "(add-callback! ball (lambda (time view) (f 1)) #:period 0.1)")
(overflows "a callback whose frames alternate" "^crash.scm:[345]:.*"
           "(define (f x) (cons x"
           "                    (g x)))"
           "(define (g x) (map f (list x x)))"
           "(add-callback! ball (lambda (time view) (f 1)) #:period 0.1)")
(overflows "a callback that overflows the stack of C" "crash.scm:4:.*"
           "(define (f x) (sort '(2 1) (lambda (a b) (f x))))"
           "(add-callback! ball (lambda (time view) (f 1)) #:period 0.1)")
(overflows "an observer that calls itself" "^crash.scm:3:.*"
           "(define (f x) (+ 1 (f x)))" "(observe! 'frame f)")
(overflows "a motion that calls itself" "^crash.scm:3:.*"
           "(define (f x) (+ 1 (f x)))"
           "(add-body! #:shape (sphere 1) #:position #(5 0 0) #:max-speed 1 #:motion f)")
(overflows "a scene that calls itself" "^crash.scm:3:.*"
           "(define (f x) (+ 1 (f x)))" "(f 1)")
(passes "a list of a million elements is mapped in a scene" "(map 1+ (iota 1000000))")
(passes "a list of 100000 elements is mapped in a callback"
        "(add-callback! ball (lambda (time view) (map 1+ (iota 100000))) #:period 0.1)"
        "(run! #:until 0.5)")

;; ---- long scenes ----

(let ((count 2500))
  (apply passes "a scene of 2500 forms"
         (map (lambda (i) (format #f "(define x~a ~a)" i i)) (iota count)))
  (fails-with "an error in one of its last forms has its place" "^crash.scm:2504:.*no good"
              (string-join (map (lambda (i) (format #f "(define x~a ~a)" i i)) (iota count)) "\n")
              "" "(error \"no good\")"))

;; ---- validators ----

(write-file "outside.scm" "(use-modules (timewarp))"
            "(add-body! #:shape (half-space #(0 0 1) -1) #:fixed? #t)"
            "(add-body! #:shape (rock #:size 0.48) #:inertia #(1 1 1)"
            "           #:center-of-mass #(1.7 -0.93 0.02)"
            "           #:orientation (rotation #(0 0 1) 0.3) #:angular-velocity #(1.39 -0.49 0.85)"
            "           #:position #(2.2 2.2 0))"
            "(add-body! #:shape (box 0.2 0.7 0.5) #:center-of-mass #(1 0 1) #:position #(0 0 2))")
(test-equal "--check takes a centre of mass outside its shape" '(0 "" "")
  (run "outside.scm" "--until=0.8" "--quiet" "--check"))

(clean-up)
(test-end "crash")
