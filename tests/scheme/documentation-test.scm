;; Every export of (timewarp) and (timewarp vectors) has a docstring; importing them is quiet; and
;; plain guile has the same binding as the program.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (ice-9 documentation) (ice-9 format) (ice-9 session) (timewarp help))

(define (exports module)
  (sort (module-map (lambda (name variable) (cons name (variable-ref variable)))
                    (resolve-interface module))
        (lambda (a b) (string<? (symbol->string (car a)) (symbol->string (car b))))))

(test-begin "documentation")

(for-each
 (lambda (module)
   (test-assert (format #f "~a exports something" module) (pair? (exports module)))
   (for-each (match-lambda
               ((name . value)
                (let ((text (object-documentation value)))
                  (test-assert (format #f "~a has a docstring" name)
                    (and (string? text) (> (string-length text) 10))))))
             (exports module)))
 '((timewarp) (timewarp vectors)))

;; a docstring is the whole reference: a line for each keyword, "#:name  ..."
(define (keywords procedure)
  (map car (or (assq-ref (or (procedure-arguments procedure) '()) 'keyword) '())))

(define with-keywords
  (filter (match-lambda ((name . value) (and (procedure? value) (pair? (keywords value)))))
          (exports '(timewarp))))
(test-assert "there are procedures with keywords" (> (length with-keywords) 10))
(for-each
 (match-lambda
   ((name . procedure)
    (test-equal (format #f "~a: each keyword has a line in the docstring" name) '()
      (remove (lambda (keyword)
                (string-match (format #f "(^|\n)~a +[^ ]"
                                      (regexp-quote (format #f "~s" keyword)))
                              (object-documentation procedure)))
              (keywords procedure)))))
 with-keywords)

;; (help)
(test-equal "(help) lists every export, and nothing else" '()
  (let ((listed (append-map cddr help-groups)) (exported (map car (exports '(timewarp)))))
    (append (lset-difference eq? listed exported) (lset-difference eq? exported listed))))
(test-assert "(help PROCEDURE) shows keywords and description"
  (string-match "^.camera #:eye #:target(.|\n)*Place the camera"
                (with-output-to-string (lambda () (help camera)))))
(test-assert "(help 'SUBJECT) lists a group"
  (string-match "^Sensors: (.|\n)*rangefinder" (with-output-to-string (lambda () (help 'sensors)))))
(test-assert "(help 'PART) lists names"
  (string-match "names with friction:\n(.|\n)*contact-friction"
                (with-output-to-string (lambda () (help 'friction)))))

(define-syntax-rule (shown expression) (with-output-to-string (lambda () expression)))
(test-assert "what is not imported is shown with its module"
  (string-match "^.lerp (.|\n)*\\(use-modules \\(timewarp vectors\\)\\) imports it"
                (shown (help 'lerp))))
(test-equal "a subject needs no quote" (shown (help 'sensors)) (shown (help sensors)))
(test-equal "nor does a part of names" (shown (help 'friction)) (shown (help friction)))
(test-equal "nor does syntax" (shown (help 'define-scene-parameter))
  (shown (help define-scene-parameter)))
(test-assert "a subject is found where a variable has its name"
  (begin (module-define! (current-module) 'queries '(1 2))
         (string-match "^Queries: " (shown (help queries)))))
(test-equal "a variable that holds a name stands for it" (shown (help "camera"))
  (let ((name "camera")) (shown (help name))))
(test-equal "and so does a global one" (shown (help 'camera))
  (begin (module-define! (current-module) 'my-favourite 'camera) (shown (help my-favourite))))
(test-equal "help is a procedure, too" (shown (begin (help "camera") (help 'sensors)))
  (shown (for-each help '("camera" sensors))))
(test-assert "a word finds descriptions, too, by the line that has it"
  (string-match "^names with friction:\n(.|\n)*\ndescriptions with friction:\n(.|\n)*  set-contact-parameters! +#:friction "
                (shown (help friction))))
(test-assert "and what is in no name"
  (string-match "^descriptions with ffmpeg:\n  simulate! +#:movie "
                (shown (help ffmpeg))))
(test-assert "keywords, as they are written"
  (string-match "^descriptions with #:max-speed:\n  add-body! +#:max-speed " (shown (help #:max-speed))))
(test-assert "several words" (string-match "descriptions with field of gravity:\n  total-energy "
                                           (shown (help "field of gravity"))))
(test-message "a name that nothing has" "nothing-such; expected a name" (help nothing-such))
(test-assert "help describes itself" (string-match "SUBJECT" (shown (help help))))

;; the names that scenes rely on
(for-each
 (lambda (name)
   (test-assert (format #f "~a is exported" name) (assq name (exports '(timewarp)))))
 '(scene define-scene-parameter scene-random-state make-world current-world reset! load-scene world-time world-bodies
   find-body sphere box convex half-space union placed rotation shape-volume shape-inertia add-body!
   keyframes set-contact-parameters! disable-collisions! enable-collisions! add-callback!
   on-collision! collision-time collision-point collision-normal collision-speed collision-impulse
   position orientation velocity angular-velocity kinetic-energy slot slot? applied-force
   applied-torque body-name random-real! observe! squeezed-time squeezed-body squeezed-between
   squeezed-depth squeezed-share run! run-for! step! simulate! statistics
   contacts contact-bodies contact-point contact-normal contact-gap contact-force contact-friction
   contact-slipping? show-statistics state-queue checkpoint restore! total-energy total-momentum camera light sky render!))

(test-equal "no private name is exported" '()
  (filter (lambda (name) (string-prefix? "%" (symbol->string name))) (map car (exports '(timewarp)))))

(test-equal "importing (timewarp) beside others gives no warning" ""
  (run-errors
   (shell "guile --no-auto-compile -c '(use-modules (timewarp) (srfi srfi-1) (ice-9 match) (oop goops) (ice-9 format)) union position slot'")))

(test-equal "plain guile runs what the program runs"
  (run-output (run "-c" "'(define b (add-body! #:shape (sphere 1))) (run! #:until 2) (display (position b))'"))
  (run-output
   (shell "guile --no-auto-compile -c '(use-modules (timewarp)) (define b (add-body! #:shape (sphere 1))) (run! #:until 2) (display (position b))'")))

(clean-up)
(test-end "documentation")
