;; Random calls of every exported procedure, in each setting: see fuzz-calls.scm.  Each of them
;; returns at least once, or its arguments are never what it takes, and it is not tested.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "fuzz")

(define fuzzer
  (in-vicinity (canonicalize-path (dirname (current-filename))) "fuzz-calls.scm"))

;; What may never return, and why.
(define exceptions
  ;; draws, and is an error where drawing was left out
  (if (%drawing?) '() '(render!)))

;; The procedures of which no call returned.
(define (never-returned output)
  (match (string-match "never returned: (.*)\n" output)
    (#f 'unknown)
    (found (call-with-input-string (match:substring found 1) read))))

(define (calls setting seed)
  (let ((result (shell (format #f "guile --no-auto-compile ~a --seed=~a --calls=4000 --setting=~a"
                               fuzzer seed setting))))
    (test-equal (format #f "4000 calls, setting ~a: ~a~a" setting (run-output result)
                        (if (zero? (run-status result)) "" (run-errors result)))
      0 (run-status result))
    (test-assert (format #f "worlds run, setting ~a" setting)
      (string-match "[1-9][0-9]* collisions" (run-output result)))
    (never-returned (run-output result))))

(test-equal "every procedure returns at least once"
  '()
  (apply lset-intersection equal?
         (map (lambda (setting seed) (lset-difference equal? (calls setting seed) exceptions))
              '(plain check undo adversary) '(1 2 3 4))))

(clean-up)
(test-end "fuzz")
