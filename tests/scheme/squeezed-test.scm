;; What has nowhere to go is told: by observers, in the statistics, and by a warning.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "squeezed")

;; A ram presses a crate of 0.2 m to half its width, twice in 4 s.
(define press
  '("(define wall (add-body! #:name \"wall\" #:shape (box 0.2 2 2) #:fixed? #t #:position #(-0.1 0 0)))"
    "(define crate (add-body! #:name \"crate\" #:shape (box 0.2 0.2 0.2) #:position #(0.11 0 0.1)))"
    "(define ram (add-body! #:name \"ram\" #:shape (box 0.2 2 2) #:motion"
    "  (keyframes '((0 #(0.5 0 0)) (1 #(0.2 0 0)) (2 #(0.5 0 0)) (3 #(0.2 0 0)) (4 #(0.5 0 0)))"
    "             #:smooth? #t)))"
    "(add-body! #:name \"ground\" #:shape (half-space #(0 0 1) 0) #:fixed? #t)"))
(apply write-file "press.scm" "(use-modules (timewarp))" press)

(in-world ()
  (load (in-folder "press.scm"))
  (let ((crate (find-body "crate")) (seen '()))
    (observe! 'squeezed (lambda (squeezing) (set! seen (cons squeezing seen))))
    (run! #:until 1.5)
    (test-equal "an observer hears of a squeezing once while it lasts" 1 (length seen))
    (run! #:until 4)
    (test-equal "and again when it begins anew" 2 (length seen))
    (let ((first-time (second seen)))
      (test-assert "its time" (< 0.3 (squeezed-time first-time) 1))
      (test-eq "who is squeezed" crate (squeezed-body first-time))
      (test-equal "between whom" (list (find-body "wall") (find-body "ram"))
        (squeezed-between first-time))
      (test-assert "how deep" (<= 0.02 (squeezed-share first-time) 0.05))
      (test-assert "in metres, and as a share"
        (close? (squeezed-depth first-time) (* 0.2 (squeezed-share first-time)) 1e-15)))
    (test-equal "statistics: how many" 2 (assq-ref (statistics) 'squeezed))
    (test-assert "how deep" (close? 0.05 (assq-ref (statistics) 'squeezed_depth) 1e-4))
    (test-assert "share of the width" (close? 0.25 (assq-ref (statistics) 'squeezed_share) 1e-3))
    (test-assert "max_penetration leaves it out"
      (< (assq-ref (statistics) 'max_penetration) 0.01))
    (test-message "only squeezings have a depth" "the squeezing is 5; expected" (squeezed-depth 5))))

(let* ((result (run "press.scm" "--until=4"))
       (warnings (filter (lambda (line) (string-contains line "warning"))
                         (lines-of (run-errors result)))))
  (test-equal "squeezing is no error" 0 (run-status result))
  (test-equal "one warning a run" 1 (length warnings))
  (test-assert "it says when, who, between whom, and how deep"
    (string-match "^timewarp: warning: at 0[.][0-9]+ s crate is squeezed between wall and ram, [0-9.e-]+ m deep, [0-9.]+ % of"
                  (car warnings))))

(write-file "ball.scm" "(use-modules (timewarp))"
            "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
            "(add-body! #:shape (sphere 0.1) #:position #(0 0 1))")
(test-equal "who has room is not warned of" "" (run-errors (run "ball.scm" "--until=2")))

(define (hash-of . args)
  (last (lines-of (run-output (apply run "press.scm" "--until=4" "--hash" "--quiet" args)))))
(let ((hash (hash-of)))
  (for-each (lambda (args)
              (test-equal (format #f "the hash doesn't depend on ~a" args) hash (apply hash-of args)))
            '(("--check") ("--pieces=7") ("--gvt-interval=1") ("--adversary=1,0.05,every")
              ("--adversary=2,0.05") ("--undo-redo"))))

(clean-up)
(test-end "squeezed")
