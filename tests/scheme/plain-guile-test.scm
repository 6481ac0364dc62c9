;; What plain guile shows of our errors: the user's place and message, no frames of ours or Guile's.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "plain guile")

(define (guile . args)
  (shell (string-join (cons* "guile" "--no-auto-compile" args) " ")))

(write-file "wrong.scm"
            "(use-modules (timewarp))"
            "(define (make n)"
            "  (list (sphere (- n 6))))"
            ""
            "(define shapes"
            "  (make 5))"
            "(display \"not reached\")")

(define message "the radius of a sphere is -1; expected a positive number of metres\n")

(let ((result (guile "-c" "'(use-modules (timewarp)) (list (sphere -1))'")))
  (test-equal "-c: status 1" 1 (run-status result))
  (test-equal "-c: the message alone" message (run-errors result)))

(let ((result (guile "wrong.scm")))
  (test-equal "a script that is interpreted: status 1" 1 (run-status result))
  (test-equal "and the place of its form" "wrong.scm:5:1: "
    (match (string-match "wrong.scm:[0-9:]+ " (run-errors result))
      (found (match:substring found))))
  (test-assert "and the message alone" (string-suffix? (string-append "5:1: " message) (run-errors result)))
  (test-equal "one line" 1 (length (lines-of (run-errors result)))))

;; set!, so that the compiler doesn't put the procedure in the place of its call
(write-file "compiled.scm"
            "(use-modules (timewarp))"
            "(define (make n)"
            "  (list (sphere (- n 6))))"
            "(set! make make)"
            "(define shapes"
            "  (make 5))")
(let ((result (guile "-c" (string-append "'((@ (system base compile) compile-file) \"compiled.scm\""
                                         " #:output-file \"compiled.go\")"
                                         " (load-compiled \"compiled.go\")'"))))
  (test-assert (format #f "a script that is compiled: the call and the user's frames: ~s" (run-errors result))
    (string-match (string-append "^compiled.scm:3:9: the radius[^\n]*\n"
                                 "  compiled.scm:3:9 \\(make\\)\n"
                                 "  compiled.scm:6:3\n$")
                  (run-errors result))))

(let ((result (run "-l" "wrong.scm" "-c" "1")))
  (test-assert "-l of the program: the place of the form"
    (string-match "wrong.scm:5:1: the radius" (run-errors result))))

(let ((result (shell "{ echo '(use-modules (timewarp))'; echo '(list (sphere -1))'; } | guile -q")))
  (test-assert (format #f "guile's REPL: the message alone: ~s" (run-output result))
    (string-match (string-append "(^|\n|> )" message) (string-append (run-output result) (run-errors result))))
  (test-assert "and no frames"
    (not (string-match "In procedure|timewarp/errors" (run-output result)))))

(let ((result (guile "-c" "'(use-modules (timewarp)) (false-if-exception (sphere -1)) (car 5)'")))
  (test-assert "errors of others are shown as ever, with Guile's backtrace"
    (string-match "(^|\n)Backtrace:(.|\n)*In procedure car:" (run-errors result))))

(clean-up)
(test-end "plain guile")
