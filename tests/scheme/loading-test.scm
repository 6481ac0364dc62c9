;; Loading scenes: fresh worlds, errors that leave the world as it was, scenes of many forms, and places.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "loading")

;; ---- reset! ----

(in-world ('(seed . 7))
  (let ((old (add-body! #:name "old" #:shape (sphere 1))))
    (scene #:title "old" #:duration 5 #:gravity #(0 0 0))
    (camera #:eye #(1 2 3))
    (add-callback! old (lambda (time view) #f) #:start 0.1)
    (run! #:until 1)
    (reset!)
    (test-equal "after reset! there are no bodies" '() (world-bodies))
    (test-equal "and the time is 0" 0.0 (world-time))
    (test-equal "what scene and camera set is as at the start" '(#f 10 ())
      (list (world-ref (current-world) 'title) (world-duration (current-world))
            (world-ref (current-world) 'camera '())))
    (test-equal "what the command line sets stays" 7 (world-seed (current-world)))
    (let ((ball (add-body! #:shape (sphere 1))))
      (run! #:until 1)
      (test-assert "gravity is the earth's again" (close? (position ball) #(0 0 -4.905) 1e-9)))))

(in-world ()
  (let ((ball (add-body! #:shape (sphere 1))))
    (add-callback! ball (lambda (time view) (reset!)) #:start 0.5)
    (test-message "reset! in a callback" "reset! was used inside a callback" (run! #:until 1))))

;; ---- load-scene ----

(write-file "one.scm" "(use-modules (timewarp))" "(scene #:title \"one\")"
            "(add-body! #:name \"one\" #:shape (sphere 1))")
(write-file "wrong.scm" "(use-modules (timewarp))" "(scene #:title \"wrong\")"
            "(add-body! #:name \"one\" #:shape (sphere 1))" "(camera #:fov 1)"
            "(observe! 'frame (lambda (frame) #t))" "(run! #:until 1)" "(car 'pear)")

(define (load-in-guile-user name)
  (save-module-excursion
   (lambda ()
     (set-current-module (resolve-module '(guile-user)))
     (load-scene (in-folder name)))))

(in-world ()
  (load-in-guile-user "one.scm")
  (load-in-guile-user "one.scm")
  (test-equal "load-scene starts afresh" '("one") (map body-name (world-bodies)))
  (camera #:eye #(1 2 3))
  (let ((frames 0))
    (observe! 'frame (lambda (frame) (set! frames (1+ frames))))
    (let ((world (current-world)) (body (find-body "one")))
      (test-message "an error in a scene has its place" "Wrong type" (load-in-guile-user "wrong.scm"))
      (test-eq "after it the world is what it was" world (current-world))
      (test-equal "with its bodies, settings, camera and time" (list (list body) "one" #(1 2 3) 0.0)
        (list (world-bodies) (world-ref world 'title)
              (assq-ref (world-ref world 'camera) 'eye) (world-time)))
      (run! #:until 1)
      (test-equal "and what was to begin with its first run does" 31 frames))))

(write-file "outer.scm" "(use-modules (timewarp))" "(add-body! #:name \"left behind\" #:shape (sphere 1))"
            "(load-scene \"one.scm\")" "(add-body! #:name \"two\" #:shape (sphere 1) #:position #(3 0 0))"
            "(observe! 'frame (lambda (frame) (if (zero? (frame-index frame)) (write (map body-name (world-bodies))))))")
(write-file "afresh.scm" "(use-modules (timewarp))" "(reset!)"
            "(add-body! #:name \"new\" #:shape (sphere 1))")
(write-file "late.scm" "(use-modules (timewarp))" "(add-body! #:name \"new\" #:shape (sphere 1))"
            "(run! #:until 0.1)" "(reset!)" "(add-body! #:name \"newer\" #:shape (sphere 1))")

(let ((result (run "outer.scm" "--until=0.5" "--fps=4" "--poses=p.csv")))
  (test-equal "load-scene in a scene: the new world is what runs and is recorded"
    '(0 "one" "two" "one" "two" "one" "two")
    (cons (run-status result)
          (map (lambda (row) (second (string-split row #\,))) (cdr (lines-of (read-file "p.csv")))))))
(run "afresh.scm" "--until=0.5" "--fps=2" "--poses=p.csv")
(test-equal "a scene may begin with reset!" '("0" "0.5")
  (map (lambda (row) (first (string-split row #\,))) (cdr (lines-of (read-file "p.csv")))))
(test-assert "a recorder doesn't go over to a second world that runs"
  (string-match "^late.scm:4:1: poses record a world that has run already; expected a new world"
                (run-errors (run "late.scm" "--poses=p.csv"))))
(test-equal "without a recorder a scene may" 0 (run-status (run "late.scm" "--quiet")))
(test-equal "-c and -l fill the world before the scene does" "2"
  (begin
    (write-file "count.scm" "(use-modules (timewarp))" "(add-body! #:shape (sphere 1))"
                "(display (length (world-bodies)))")
    (run-output (run "-c" "'(add-body! #:shape (sphere 1) #:position #(9 0 0))'" "count.scm" "--until=0"))))

;; ---- scenes of many forms ----

(define (write-many name count proc)
  (call-with-output-file (in-folder name)
    (lambda (port)
      (display "(use-modules (timewarp))\n" port)
      (for-each (lambda (i) (proc i port)) (iota count)))))

(write-many "many.scm" 5000
            (lambda (i port)
              (format port "(define x~a ~a)~%" i i)
              (when (= i 4999) (display "(display x4999)\n(sphere -1)\n" port))))
(let ((result (run "many.scm" "--quiet" "--until=0")))
  (test-equal "5000 definitions are run" "4999" (run-output result))
  (test-assert "and an error after them has its place"
    (string-match "^many.scm:5003:1: the radius of a sphere is -1" (run-errors result))))

;; each of these is compiled; what the code refers to outlives collections
(write-many "many-procedures.scm" 2500
            (lambda (i port)
              (format port "(define (f~a x) (list 'symbol-~a \"string ~a\" ~a.5 x))~%" i i i i)
              (when (= i 2499)
                (display "(gc)\n(display (map (lambda (f) (f 1)) (list f0 f1200 f2499)))\n" port))))
(test-equal "2500 procedures are compiled and stay whole"
  "((symbol-0 string 0 0.5 1) (symbol-1200 string 1200 1200.5 1) (symbol-2499 string 2499 2499.5 1))"
  (run-output (run "many-procedures.scm" "--quiet" "--until=0")))

;; ---- what forms may be ----

(write-file "forms.scm" "(use-modules (timewarp))"
            "(define-syntax twice (syntax-rules () ((_ x) (begin x x))))"
            "(twice (display \"a\"))"
            "(define b (let* ((x 1) (y (+ x 1))) (if (odd? y) 'odd (list x y))))"
            "(begin (define c 3) (set! c (+ c 1)))"
            "(use-modules (srfi srfi-1) (srfi srfi-9))"
            "(define-values (d e) (values 5 6))"
            "(define add (let ((n 10)) (lambda (x) (+ n x))))"
            "(define-record-type <thing> (make-thing size) thing? (size thing-size))"
            "(display (list b c (first '(1 2)) d e (add 1) (thing-size (make-thing 7)) (or #f 8)))"
            "(do ((i 0 (1+ i))) ((= i 3)) (display i))"
            "(define when (lambda (x) (display x)))"
            "(when 9)")
(test-equal "forms are run in order, macros and modules included" "aa((1 2) 4 1 5 6 11 7 8)0129"
  (run-output (run "forms.scm" "--quiet" "--until=0")))

(define (place-of . lines)
  (apply write-file "bad.scm" "(use-modules (timewarp))" lines)
  (match (string-match "^bad.scm:([0-9]+:[0-9]+): " (run-errors (run "bad.scm" "--until=0")))
    (#f #f)
    (found (match:substring found 1))))

(test-equal "the place of a call in a call" "3:20"
  (place-of "(add-body! #:name \"a\"" "           #:shape (car (sphere 1)))"))
(test-equal "of the call around" "2:1"
  (place-of "(add-body! #:shape (box 1 1 1)" "           #:mass (- (* 2 3)))"))
(test-equal "of a branch" "3:23" (place-of "(define a 1)" "(define s (if (= a 1) (sphere -1) 2))"))
(test-equal "of an unbound name" "2:22" (place-of "(define s (sphere (* radius 2)))"))
(test-equal "of set! of an unbound name" "2:1" (place-of "(set! radius 2)"))

;; a frame in one of the program's own files is not taken for the user's place; forms.scm stands for
;; the user's forms, primitives.scm has no procedures that could be on the stack
(use-modules (ice-9 ftw))
(let ((folder (string-append (dirname (current-filename)) "/../../scheme/timewarp")))
  (for-each
   (lambda (name)
     (test-assert (string-append "one of the program's own files: " name)
       (member name (map basename (@@ (timewarp errors) own-files)))))
   (lset-difference string=? (scandir folder (lambda (name) (string-suffix? ".scm" name)))
                    '("forms.scm" "primitives.scm"))))

(clean-up)
(test-end "loading")
