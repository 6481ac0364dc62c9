;; Completion at the prompt, and the file that keeps its history.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp completion) (timewarp history))

(test-begin "completion")

;; what the last word of BEFORE, TEXT, may become
(define (candidates before text)
  (call-with-values (lambda () (completions before text))
    (lambda (list files?) (sort list string<?))))

(define ball (add-body! #:name "steel ball" #:shape (sphere 1)))
(define arm (add-multibody! #:name "arm" (link "upper" #:joint (revolute #:axis #(0 1 0)) #:shape (sphere 0.1))))

(test-equal "a name" '("world-bodies" "world-duration" "world-fps" "world-multibodies" "world-ref"
                       "world-seed" "world-set!" "world-time")
  (candidates "(list (world-" "world-"))
(test-equal "a name of the user's" '("steel-drum")
  (begin (module-define! (current-module) 'steel-drum 1) (candidates "steel-d" "steel-d")))
(test-equal "keywords of the procedure that is called" '("#:angular-velocity")
  (candidates "(add-body! #:shape (sphere 1) #:ang" "#:ang"))
(test-equal "but those that it has" '("#:position")
  (candidates "(add-body! #:policy 3 #:po" "#:po"))
(test-equal "none that it has already" '()
  (candidates "(add-body! #:position #(0 0 1) #:posi" "#:posi"))
(test-equal "not those of the call around it" '() (candidates "(add-body! #:shape (sphere #:pos" "#:pos"))
(test-equal "keywords where nothing is typed" '("#:bare?" "#:contacts?" "#:quality" "#:size")
  (candidates "(render! \"a.png\" " ""))
(test-assert "what there is where nothing is typed at all"
  (member "add-body!" (candidates "" "")))
(test-equal "subjects of (help)" '("queries") (candidates "(help quer" "quer"))
(test-equal "commands of the REPL" '(",describe") (candidates ",desc" ",desc"))
(test-equal "bodies in a string" '("steel ball") (candidates "(find-body \"st" "st"))
(test-equal "links and multibodies, too" '("arm" "arm/upper") (candidates "(find-body \"ar" "ar"))
(test-equal "joints" (quote ("upper")) (candidates "(joint-position arm \"up" "up"))
(test-equal "nothing in a comment" '() (candidates "; (world-" "world-"))
(test-equal "characters and strings that are closed hide nothing" '("world-time")
  (candidates "(list #\\( #\\\" \"(\\\"\" ; \"\n (world-t" "world-t"))

(write-file "drop.scm" "")
(mkdir (in-folder "drops"))
(write-file ".hidden" "")
(let ((before (getcwd)))
  (chdir (force folder))
  (test-equal "files" '("drop.scm" "drops/") (candidates "(load-scene \"dr" "dr"))
  (test-equal "files after a keyword that takes one" '("drop.scm" "drops/")
    (candidates "(simulate! #:poses \"dr" "dr"))
  (test-equal "files where no body fits" '("drop.scm" "drops/") (candidates "(f \"dr" "dr"))
  (test-equal "hidden ones where asked for" '(".hidden") (candidates "(load-scene \".h" ".h"))
  (test-equal "of a folder" (list (in-folder "drops/"))
    (candidates (string-append "(load-scene \"" (in-folder "drops")) (in-folder "drops")))
  (chdir before))

;; ---- history ----

(define file (in-folder "state/timewarp/history"))
(define entries '("(+ 1 2)" "(define x\n  \"a\\n\")" "ünïcode"))
(for-each (lambda (entry) (append-history-entry! file entry)) entries)
(test-equal "history comes back as it was typed" entries (read-history-entries file))
(test-equal "only its user may read it" #o600 (logand #o777 (stat:mode (stat file))))
(call-with-port (open-file file "a") (lambda (port) (display "(broken\n\"half" port)))
(test-equal "what is broken in it is left out" entries (read-history-entries file))
(test-equal "no file, no history" '() (read-history-entries (in-folder "none")))
(append-history-entry! "/proc/none/history" "(a)")
(test-assert "where none can be written, none is" #t)
(let ((long (in-folder "long")))
  (for-each (lambda (k) (append-history-entry! long (number->string k))) (iota 3100))
  (test-equal "the latest of a long one" '(2000 "3099")
    (let ((kept (read-history-entries long))) (list (length kept) (last kept))))
  (test-equal "which is cut" 2000 (length (lines-of (read-file "long")))))

(clean-up)
(test-end "completion")
