;; Bad input to the program: each a clear error with file and line, within 2 s, and status 1.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "bad input")

(define (seconds) (/ (get-internal-real-time) internal-time-units-per-second 1.0))

;; Runs a scene of these lines (the second is line 2): status 1 and a message that matches, in 2 s.
(define (expect name pattern . lines)
  (apply write-file "bad.scm" "(use-modules (timewarp))" lines)
  (let* ((start (seconds))
         (result (run "bad.scm" "--until=1"))
         (taken (- (seconds) start)))
    (test-equal (string-append name ": status 1") 1 (run-status result))
    (test-assert (format #f "~a: ~s" name (run-errors result))
      (string-match (string-append "^bad.scm:" pattern) (run-errors result)))
    (test-assert (format #f "~a: ~a s" name taken) (< taken 2))))

(expect "NaN position" "2:1: position is #\\(0 0 \\+nan.0\\); expected"
        "(add-body! #:shape (sphere 1) #:position #(0 0 +nan.0))")
(expect "zero mass" "2:1: mass of body-0 is 0; expected a positive"
        "(add-body! #:shape (sphere 1) #:mass 0)")
(expect "negative density" "2:1: density of body-0 is -1; expected a positive"
        "(add-body! #:shape (sphere 1) #:density -1)")
(expect "negative radius" "3:22: the radius of a sphere is -1; expected a positive"
        "(define ball" "  (add-body! #:shape (sphere -1)))")
(expect "flat hull" "2:20: .*flat"
        "(add-body! #:shape (convex '(#(0 0 0) #(1 0 0) #(0 1 0) #(1 1 0))))")
(expect "empty hull" "2:20: .*points" "(add-body! #:shape (convex '()))")
(expect "zero quaternion" "2:1: orientation is #\\(0 0 0 0\\); expected"
        "(add-body! #:shape (sphere 1) #:orientation #(0 0 0 0))")
(expect "unknown keyword" "2:1: add-body! got the unknown keyword #:positon; expected one of .*#:position"
        "(add-body! #:shape (sphere 1) #:positon #(0 0 0))")
(expect "wrong type" "2:1: shape is 5; expected a shape" "(add-body! #:shape 5)")
(expect "missing file" "2:1: .*nowhere.scm" "(load \"nowhere.scm\")")
(expect "overlap at the start" "3:1: .*left.*right.*0.5 m"
        "(add-body! #:name \"left\" #:shape (sphere 1))"
        "(add-body! #:name \"right\" #:shape (sphere 1) #:position #(1.5 0 0))")
(expect "a callback that throws"
        "4:8: .*Wrong type.*: five(.|\n)*in the callback made at bad.scm:5:1 at 0.6[0-9]* s, bodies: ball(.|\n)*bad.scm:7:"
        "(define ball (add-body! #:name \"ball\" #:shape (sphere 1)))"
        "(define (helper x)"
        "  (+ 1 (car x)))"
        "(add-callback! ball"
        "  (lambda (time view)"
        "    (if (> time 0.55) (* 2 (helper 'five))))"
        "  #:period 0.1)")
(expect "an open parenthesis" "2:1: the form that begins here is not closed"
        "(define a (add-body! #:shape (sphere 1))" "" "(define b 3)")
(expect "a parenthesis too many" "3:13: .*unexpected" ";; nothing" "(define b 3))")
(expect "a syntax error" "2:[0-9]+: syntax error in let: bad let" "(display 1) (let ((x)) 5)")
(expect "an unbound name" "3:4: Unbound variable: add-bdy!" "(define a" "  (add-bdy! 3))")
(expect "a name written otherwise" "2:20: Unbound variable: heightField; is height-field meant\\?"
        "(define ground 3) (heightField '((0 0) (0 0)))")
(expect "a name of a module that is not used" "2:2: .*v[+]; [(]use-modules [(]timewarp vectors[)][)] imports"
        "(v+ #(0 0 1) #(0 0 2))")
(expect "the name of no body, but nearly" "2:[0-9]+: .*ball1.*is ball-1 meant\\?"
        "(add-body! #:shape (sphere 1) #:name \"ball-1\") (find-body \"ball1\")")
(expect "the name of no body" "2:[0-9]+: .*name of a body of the current world\n$" "(find-body \"zorkmid\")")
(expect "a name like no other" "2:2: Unbound variable: zorkmid\n$" "(zorkmid 3)")
(expect "what cannot be set" "3:[0-9]+: body-mass cannot be set; expected an accessor"
        "(define ball (add-body! #:shape (sphere 1)))"
        "(set! (body-mass ball) 3)")
(expect "a callback with too few arguments"
        "3:1: the procedure of add-callback! takes \\(ball\\); expected one that takes 2 arguments: the time"
        "(define ball (add-body! #:shape (sphere 1)))"
        "(add-callback! ball (lambda (ball) 3) #:period 0.1)")
(expect "a callback on collisions without views" "2:1: .*on-collision! takes .c.; expected .* 3 arguments"
        "(on-collision! #t #t (lambda (c) c))")
(expect "an observer with two arguments" "2:1: .*observe! takes .a b.; expected one that takes 1 argument:"
        "(observe! 'collision (lambda (a b) a))")
(expect "a force of the view alone" "3:1: .*add-force! takes .ball.; expected one that takes 2"
        "(define ball (add-body! #:shape (sphere 1)))"
        "(add-force! ball (lambda (ball) #(0 0 1)))")
(expect "too many arguments" "2:11: Wrong number of arguments" "(define s (sphere 1 2))")
(expect "an error in a helper" "3:6: the radius of a sphere is -2"
        "(define (make i)" "  (+ (sphere (- i 2)) 1))" "(for-each make (iota 5))")
(expect "an error of the scene's own" "2:1: no good 5" "(error \"no good\" 5)")
(expect "an observer that throws" "4:[0-9]+: .*Wrong type(.|\n)*in the observer"
        "(add-body! #:shape (sphere 1))"
        "(observe! 'frame"
        "  (lambda (frame) (1+ (car 'frame))))")

(let ((result (run "nowhere.scm")))
  (test-equal "a scene that is not there: status 1" 1 (run-status result))
  (test-assert (run-errors result)
    (string-match "cannot read the scene nowhere.scm: No such file.*expected" (run-errors result))))

(let ((result (run ".")))
  (test-equal "a folder is no scene: status 1" 1 (run-status result))
  (test-assert (run-errors result) (string-match "cannot read the scene" (run-errors result))))

;; ---- files that cannot be written ----

(write-file "fall.scm" "(use-modules (timewarp))" "(scene #:duration 1)"
            "(add-body! #:name \"ball\" #:shape (sphere 1))")

(for-each
 (lambda (option)
   (let* ((start (seconds))
          (result (run "fall.scm" option)))
     (test-equal (string-append option ": status 1") 1 (run-status result))
     (test-assert (format #f "~a: ~s" option (run-errors result))
       (string-match "cannot .*(/dev/full.*No space left|/proc/none.*No such file)" (run-errors result)))
     (test-assert (string-append option ": within 2 s") (< (- (seconds) start) 2))))
 (append '("--poses=/dev/full" "--events=/dev/full" "--stats=/dev/full" "--poses=/proc/none/p.csv")
         (if (string-null? (or (getenv "TW_DRAWS") "")) '() '("--frames=/proc/none"))))

(let ((result (shell (string-append "sh -c '" timewarp " fall.scm --hash >/dev/full'"))))
  (test-equal "standard output that is full: status 1" 1 (run-status result)))

(let ((result (shell (string-append "sh -c 'ulimit -f 1; exec " timewarp " fall.scm --quiet --poses=large.csv --fps=1000'"))))
  (test-equal "a file beyond the limit of files: status 1" 1 (run-status result))
  (test-assert "a file beyond the limit of files: which, and why"
    (string-contains (run-errors result) "cannot write large.csv: File too large")))
(let ((result (run "fall.scm" "--poses=poses.csv" "--events=/dev/full")))
  (test-equal "one of two outputs full: status 1" 1 (run-status result)))

(write-file "late.scm" "(use-modules (timewarp))" "(scene #:duration 1)"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 1)))"
            "(add-callback! ball (lambda (time view) (if (> time 0.5) (car 5))) #:period 0.25)")
(let ((result (run "late.scm" "--poses=poses.csv" "--fps=10")))
  (test-equal "after an error in the run: status 1" 1 (run-status result))
  (test-equal "what was written before is kept" 9 (length (lines-of (read-file "poses.csv")))))

(clean-up)
(test-end "bad input")
