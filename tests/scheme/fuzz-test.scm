;; Random calls of every exported procedure, in each setting: see fuzz-calls.scm.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "fuzz")

(define fuzzer
  (in-vicinity (canonicalize-path (dirname (current-filename))) "fuzz-calls.scm"))

(for-each
 (lambda (setting)
   (let ((result (shell (format #f "guile --no-auto-compile ~a --seed=1 --calls=500 --setting=~a"
                                fuzzer setting))))
     (test-equal (format #f "500 calls, setting ~a: ~a~a" setting (run-output result)
                         (run-errors result))
       0 (run-status result))
     (test-assert (format #f "worlds run, setting ~a" setting)
       (string-match "[1-9][0-9]* collisions" (run-output result)))))
 '(plain check undo adversary))

(clean-up)
(test-end "fuzz")
