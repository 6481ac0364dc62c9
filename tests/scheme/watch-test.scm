;; --watch: a scene that is saved runs again.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "watch")

(define (scene-that-says text . more)
  (apply write-file "scene.scm" "(use-modules (timewarp))"
         (format #f "(display ~s) (newline) (force-output)" text) more))

(define (output) (read-file "watch.out"))
(define (errors) (read-file "watch.err"))

(define (start)
  (let ((pid (primitive-fork)))
    (when (zero? pid)
      (chdir (force folder))
      ;; Ctrl-C at a terminal reaches the whole group
      (setpgid 0 0)
      (dup2 (fileno (open-file "watch.out" "w")) 1)
      (dup2 (fileno (open-file "watch.err" "w")) 2)
      (execlp timewarp timewarp "--watch" "scene.scm" "--until=0.1"))
    pid))

;; Waits for up to 20 s until THERE? is true.
(define-syntax-rule (test-soon name there?)
  (test-assert name
    (let wait ((left 400))
      (cond (there? #t)
            ((zero? left) (display (output)) (display (errors)) #f)
            (else (usleep 50000) (wait (1- left)))))))

(define (count-of word text) (length (list-matches word text)))

(scene-that-says "first")
(write-file "watch.out")
(write-file "watch.err")
(define pid (start))
(test-soon "it runs" (string-contains (errors) "has run"))
(test-equal "once" 1 (count-of "first" (output)))

(scene-that-says "second")
(test-soon "a save runs it again" (string-contains (output) "second"))

;; as many editors save: a new file that takes the old one's name
(test-soon "and waits again" (= 2 (count-of "has run" (errors))))
(rename-file (write-file "scene.scm~" "(use-modules (timewarp))" "(display \"third\") (newline)")
             (in-folder "scene.scm"))
(test-soon "a file that replaces it, too" (string-contains (output) "third"))

(scene-that-says "fourth" "(add-body! #:shape 5)")
(test-soon "an error is told" (string-contains (errors) "scene.scm:3:1: shape is 5"))
(test-soon "and waits for the next save" (string-contains (errors) "has failed"))
(delete-file (in-folder "scene.scm"))
(usleep 500000)
(test-equal "a scene that is missing for a moment is waited for" 1 (count-of "has failed" (errors)))

(write-file "part.scm" "(display \"part one\") (newline)")
(write-file "included.scm" "(display \"included one\") (newline)")
(scene-that-says "fifth" "(load \"part.scm\")" "(include \"included.scm\")")
(test-soon "what the scene loads runs" (string-contains (output) "included one"))
(test-soon "to the end" (= 4 (count-of "has run" (errors))))
(write-file "part.scm" "(display \"part two\") (newline)")
(test-soon "a file that it loads is watched, too" (string-contains (output) "part two"))
(test-soon "to the end" (= 5 (count-of "has run" (errors))))
(write-file "included.scm" "(display \"included two\") (newline)")
(test-soon "and one that it includes" (string-contains (output) "included two"))

;; a run that goes on for ever gives way to the next
(test-soon "to the end" (= 6 (count-of "has run" (errors))))
(scene-that-says "endless" "(let loop () (loop))")
(test-soon "an endless run" (string-contains (output) "endless"))
(scene-that-says "ended")
(test-soon "gives way" (string-contains (output) "ended"))
(test-soon "to one that ends" (= 7 (count-of "has run" (errors))))

(scene-that-says "endless again" "(let loop () (loop))")
(test-soon "another endless run" (string-contains (output) "endless again"))
(kill (- pid) SIGINT)
(test-equal "Ctrl-C ends all" 130 (status:exit-val (cdr (waitpid pid))))

(define (refused pattern . args)
  (let ((result (apply run "--watch" args)))
    (test-equal (format #f "~a: status" args) 2 (run-status result))
    (test-assert (run-errors result) (string-match pattern (run-errors result)))))
(refused "there is no scene")
(refused "no prompt" "-i" "scene.scm")
(test-assert "a scene that is not there"
  (string-match "cannot watch none.scm: No such file" (run-errors (run "--watch" "none.scm"))))

(clean-up)
(test-end "watch")
