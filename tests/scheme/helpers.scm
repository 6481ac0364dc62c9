;; What the Scheme tests share: errors as values, fresh worlds, and running the program.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp)
             (timewarp worlds)
             (timewarp primitives)
             (srfi srfi-1)
             (srfi srfi-64)
             (ice-9 match)
             (ice-9 popen)
             (ice-9 regex)
             (ice-9 textual-ports))

;; The message of the timewarp-error that EXPRESSION raises; #f if it returns, the key if it raises
;; something else.  (SRFI-64's test-error would accept any error.)
(define-syntax-rule (error-of expression ...)
  (catch #t
    (lambda () expression ... #f)
    (lambda (key . args)
      (match (cons key args)
        (('timewarp-error _ _ (message) _) message)
        (_ key)))))

;; Passes if EXPRESSION raises a timewarp-error whose message matches PATTERN.
(define-syntax-rule (test-message name pattern expression ...)
  (let ((message (error-of expression ...)))
    (test-assert (format #f "~a: ~s" name message)
      (and (string? message) (string-match pattern message) #t))))

;; Evaluates the body with a fresh current world; OVERRIDES as from the command line.
(define-syntax-rule (in-world (override ...) body ...)
  (dynamic-wind
    (lambda () (set-overrides! (list override ...)))
    (lambda () (parameterize ((current-world (make-world))) body ...))
    (lambda () (set-overrides! '()))))

(define (ground)
  (add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t))

(define (close? a b tolerance)
  (if (vector? a)
      (every (lambda (x y) (close? x y tolerance)) (vector->list a) (vector->list b))
      (< (abs (- a b)) tolerance)))

;; ---- the program ----

(define timewarp (or (getenv "TIMEWARP") "timewarp"))

;; made when it is first asked for
(define folder
  (delay (mkdtemp (string-append (or (getenv "TMPDIR") "/tmp") "/timewarp-test-XXXXXX"))))

(define (in-folder name) (string-append (force folder) "/" name))

(define (write-file name . lines)
  (call-with-output-file (in-folder name)
    (lambda (port) (for-each (lambda (line) (display line port) (newline port)) lines)))
  (in-folder name))

(define (read-file name)
  (call-with-input-file (in-folder name) get-string-all #:encoding "UTF-8"))

(define (lines-of text)
  (remove string-null? (string-split text #\newline)))

;; Runs a shell command line in the folder: exit status, standard output, standard error.
(define (shell command)
  (let* ((status (system (format #f "cd ~a && ~a >out.txt 2>err.txt" (force folder) command)))
         (code (or (status:exit-val status) (+ 128 (status:term-sig status)))))
    (list code (read-file "out.txt") (read-file "err.txt"))))

(define (run . args)
  (shell (string-join (cons timewarp args) " ")))

(define run-status first)
(define run-output second)
(define run-errors third)

;; At the end of every test file that ran the program.
(define (clean-up)
  (system* "rm" "-rf" (force folder)))
