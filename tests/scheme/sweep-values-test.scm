;; The values that options of a sweep list, their combinations, and words for a shell.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp sweep-values) (timewarp sweep-plan) (timewarp sweep-process))

(test-begin "sweep values")

(define (values-of text) (sweep-values "-D x" text))

(for-each
 (match-lambda ((text . expected) (test-equal text expected (values-of text))))
 '(("3" "3")
   ("" "")
   ("3,1,2" "3" "1" "2")
   ("1,2,1" "1" "2")
   ("1..4" "1" "2" "3" "4")
   ("3..1" "3" "2" "1")
   ("-1..1" "-1" "0" "1")
   ("0..1..0.25" "0" "0.25" "0.5" "0.75" "1")
   ("1..0..-0.5" "1" "0.5" "0")
   ("0..10..4" "0" "4" "8")
   ("1e-6..1e-4..x10" "1.0e-6" "1.0e-5" "1.0e-4")
   ("8..1..x0.5" "8" "4" "2" "1")
   ("1..3,10" "1" "2" "3" "10")
   ("draft,best" "draft" "best")
   ("\"a, b\",c" "a, b" "c")
   ("\"1..3\"" "1..3")
   ("\"\"" "")
   ("\"say \\\"x, y\\\" \\\\\"" "say \"x, y\" \\")
   ;; what is in quotes within a value stays as it is
   ("(\"a,b\" 1),()" "(\"a,b\" 1)" "()")
   ("../file,a..b" "../file" "a..b")
   ("it's,$HOME" "it's" "$HOME")))

(test-equal "steps are counted exactly" '("0.7" "0.8" "0.9" "1")
  (list-tail (values-of "0..1..0.1") 7))

(define (refusal text)
  (catch 'timewarp-usage (lambda () (values-of text) "") (lambda (key message) message)))
(for-each
 (match-lambda
   ((text pattern)
    (test-assert (format #f "~a: ~a" text (refusal text)) (string-match pattern (refusal text)))))
 '(("1,,2" "-D x: a value is missing between commas")
   ("1," "a value is missing")
   ("0..1..0" "a step that is not 0")
   ("0.5..2" "the range is \"0.5..2\"; expected a step, as in")
   ("1..2..-1" "a step that leads from the first to the last")
   ("1..z" "FROM..TO, FROM..TO..STEP or")
   ("1..2..z" "a step")
   ("1..1e9" "at most 1000000 values")
   ("1..10..x1" "a factor that leads")
   ("0..10..x2" "positive numbers")
   ("\"a" "a double quote is not closed in \"\\\\\"a\"; expected")))

;; ---- combinations ----

(define (texts combination) (map setting-text combination))
(define (axis name . texts) (map (lambda (text) (make-setting 'define name text)) texts))

(test-equal "every combination, the last axis first" '(("1" "a") ("1" "b") ("2" "a") ("2" "b"))
  (map texts (all-combinations (list (axis "x" "1" "2") (axis "y" "a" "b")))))
(test-equal "of nothing there is one" '(()) (all-combinations '()))

(define empty-plan (make-plan "/" "x.scm" '() '() '()))
(define-values (plan asked) (extend-plan empty-plan (all-combinations (list (axis "x" "1" "2")))))
(define-values (wider asked-then)
  (extend-plan plan (all-combinations (list (axis "x" "0" "2" "3")))))
(test-equal "runs are numbered" '(1 2) (map run-number (plan-runs plan)))
(test-equal "what is asked for later comes after it" '((1 "1") (2 "2") (3 "0") (4 "3"))
  (map (lambda (run) (cons (run-number run) (texts (run-settings run)))) (plan-runs wider)))
(test-equal "what is planned keeps its number" '(3 2 4) (map run-number asked-then))
(define (parts n)
  (map (lambda (k) (make-setting 'option "part" (format #f "~a/~a" k n))) (iota n 1)))
(define-values (frames asked-frames)
  (extend-plan empty-plan (all-combinations (list (axis "x" "1" "2") (parts 2)))))
(test-equal "parts of one run have one home" '(1 1 3 3) (map run-home asked-frames))

;; ---- shell ----

(define (through-shell text)
  (let* ((port (open-pipe* OPEN_READ "sh" "-c" (string-append "printf %s " (shell-quote text))))
         (result (get-string-all port)))
    (close-pipe port)
    result))
(for-each (lambda (text)
            (test-equal (format #f "a shell takes ~s as one word" text) text (through-shell text)))
          '("plain" "" "a b" "it's" "\"x\"" "$(id) `id` \\" "-D" "*?[a]" "~" "#x;&|<>" "ü"))

(test-end "sweep values")
