;; Runs one SRFI-64 test file: guile -s scheme-test.scm FILE
;;
;; Prints each failure with what was expected, and at the end the counts; the exit status is
;; automake's: 0 passed, 1 failed, 77 skipped as a whole.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (srfi srfi-64) (ice-9 match))

;; one line for a test that did not go as expected, with everything known about it
(define (report runner)
  (let ((kind (test-result-kind runner)))
    (when (memq kind '(fail xpass))
      (format #t "~a: ~s~%" kind (test-runner-test-name runner))
      (for-each (match-lambda ((key . value) (format #t "  ~a: ~s~%" key value)))
                (test-result-alist runner)))))

(define (print-counts runner)
  (for-each (match-lambda ((text . count) (format #t "# of ~a: ~a~%" text count)))
            `(("expected passes" . ,(test-runner-pass-count runner))
              ("expected failures" . ,(test-runner-xfail-count runner))
              ("unexpected successes" . ,(test-runner-xpass-count runner))
              ("unexpected failures" . ,(test-runner-fail-count runner))
              ("skipped tests" . ,(test-runner-skip-count runner)))))

(define (exit-status runner)
  (cond ((positive? (+ (test-runner-fail-count runner) (test-runner-xpass-count runner))) 1)
        ((positive? (+ (test-runner-pass-count runner) (test-runner-xfail-count runner))) 0)
        ((positive? (test-runner-skip-count runner)) 77)
        (else (format #t "no test ran~%") 1)))

(define runner (test-runner-null))
(test-runner-on-test-end! runner report)
(test-runner-factory (const runner))

(match (command-line)
  ((_ file) (load (canonicalize-path file))))

(print-counts runner)
(exit (exit-status runner))
