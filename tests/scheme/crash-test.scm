;; Scenes that once killed or hung the program: each ends with a message, or as if nothing had been wrong.
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
  (test-equal name '(0 "done") (list-head (apply run-scene (append lines '("(display \"done\")"))) 2)))

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

;; ---- long scenes ----

(let ((count 2500))
  (apply passes "a scene of 2500 forms"
         (map (lambda (i) (format #f "(define x~a ~a)" i i)) (iota count)))
  (fails-with "an error in one of its last forms has its place" "^crash.scm:2504:.*no good"
              (string-join (map (lambda (i) (format #f "(define x~a ~a)" i i)) (iota count)) "\n")
              "" "(error \"no good\")"))

(clean-up)
(test-end "crash")
