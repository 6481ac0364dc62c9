;; The manual: every example does what it says, and every export is described, once.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(load "manual-examples.scm")
(use-modules (timewarp help))

(define source (or (getenv "TW_SRCDIR") "../.."))
(define manual (string-append source "/doc/timewarp.texi"))

(define (test-holds claim example passed? . seen)
  (test-assert (format #f "~a: ~a~a" (example-place example) claim
                       (if passed? "" (string-join (cons "" seen) "\n")))
    passed?))

;; ---- scenes ----

(define scene-options "--quiet --until=0.5")

(define (run-scene example name)
  (match (run name scene-options)
    ((status output errors)
     (test-holds "the scene runs" example (and (= status 0) (string-null? errors)) errors))))

(define (write-text name text)
  (call-with-output-file (in-folder name) (lambda (port) (display text port)) #:encoding "UTF-8"))

(define (try-part example name text)
  (write-text name text)
  (run-scene example name))

(define (replace-line text start new)
  (string-concatenate
   (map (lambda (line)
          (if (string-prefix? start line) new (string-append line "\n")))
        (string-split (string-trim-right text) #\newline))))

;; ---- commands ----

(define (draws? command)
  (string-match "--(frames|movie|at)\\b|\\(render! " command))

(define (possible? command)
  (and (or (not (draws? command)) (not (equal? (getenv "TW_DRAWS") "")))
       (or (not (string-contains command "--movie"))
           (zero? (status:exit-val (system "command -v ffmpeg >/dev/null"))))))

(define (try-command example options)
  (match-lambda
    ((command . shown)
     (when (possible? command)
       (match (shell (string-append "{ { " command
                                    (if (draws? command) (string-append " " options) "")
                                    " ; } </dev/null 2>&1 ; }"))
         ((status output _)
          (test-holds (format #f "$ ~a" command) example
                      (if (string-null? shown)
                          (and (= status 0) (string-null? output))
                          (looks-like? shown output))
                      output)))))))

;; ---- sessions ----

(define prompt "scheme@(guile-user)> ")
(define (marker i) (format #f "-- ~a --" i))

(define (session-named name examples)
  (filter (lambda (example)
            (and (eq? (example-kind example) 'repl) (string=? (example-arguments example) name)))
          examples))

;; All expressions of a session are fed to one process, with marks between what they print.
(define (try-session blocks)
  (let* ((text (string-concatenate (map example-text blocks)))
         (command (substring (first (string-split text #\newline)) 2))
         (banner (string-trim-both
                  (string-drop (substring text 0 (string-contains text prompt))
                               (+ 2 (string-length command)))))
         (parts (filter (match-lambda ((expression . _) (possible? expression)))
                        (split-transcript text prompt))))
    (call-with-output-file (in-folder "input.scm")
      (lambda (port)
        (for-each (lambda (part i)
                    (format port "~a~%(begin (format #t \"~~%~a~~%\") (force-output))~%"
                            (car part) (marker i)))
                  parts (iota (length parts))))
      #:encoding "UTF-8")
    (let ((output (run-output (shell (format #f "{ HOME=. ~a <input.scm 2>&1 ; }" command)))))
      (let loop ((parts parts) (i 0) (output output) (first? #t))
        (match parts
          (() #t)
          (((expression . shown) . rest)
           (let* ((end (or (string-contains output (string-append "\n" (marker i)))
                           (string-length output)))
                  (own (substring output 0 end))
                  (expected (if first? (string-append banner "\n" shown) shown)))
             (test-holds (format #f "> ~a" expression) (first blocks)
                         ;; scenes that are given by the command have no banner in the manual
                         (looks-like? (if (and first? (string-null? banner)) "..." expected) own)
                         own)
             (loop rest (1+ i)
                   (substring output (min (string-length output)
                                          (+ end 2 (string-length (marker i)))))
                   #f))))))))

;; ---- all ----

(define tried-sessions '())

(define (try example examples)
  (let ((text (example-text example)) (arguments (example-arguments example)))
    (match (example-kind example)
      (#f (test-holds "a mark \"@c example:\" stands before each example" example #f))
      ('file (try-part example arguments text))
      ('written (write-text arguments text))
      ('add (try-part example arguments (string-append (read-file arguments) "\n" text)))
      ('replace
       (match (string-split arguments #\space)
         ((name . words)
          (try-part example name
                    (replace-line (read-file name) (string-join words) text)))))
      ('after (try-part example "after.scm" (string-append (read-file arguments) "\n" text)))
      ('scene (try-part example "scene.scm" text))
      ('shell (for-each (try-command example arguments) (split-transcript text "$ ")))
      ('repl
       (unless (member arguments tried-sessions)
         (set! tried-sessions (cons arguments tried-sessions))
         (try-session (session-named arguments examples))))
      ('text (test-holds "says why it is not tried" example (not (string-null? arguments))))
      (kind (test-holds (format #f "~a is no kind of example" kind) example #f)))))

(test-begin "manual")

(let ((examples (read-examples manual)))
  (test-assert "there are examples" (> (length examples) 30))
  (for-each (lambda (example)
              (test-holds "nothing in it is marked up" example
                          (not (string-match "@[a-z]+\\{" (example-text example))))
              (try example examples))
            examples))

(test-assert "what is shown is compared"
  (and (looks-like? "a ... c" "a b c\n") (looks-like? "$1 = 0.4..." "$1 = 0.41")
       (not (looks-like? "a ... c" "a b d")) (not (looks-like? "a" "a b"))
       (not (looks-like? "abc...c" "abc"))))

;; ---- the reference ----

;; ((NAME TEXT) ...) of what the manual's generator writes.
(define (read-reference)
  (let ((output (run-output
                 (shell (format #f "guile --no-auto-compile -s ~a/build-aux/make-reference.scm"
                                source)))))
    (let loop ((lines (string-split output #\newline)) (entries '()))
      (match lines
        (() (reverse entries))
        ((line . rest)
         (if (string-prefix? "@deffn " line)
             (call-with-values
                 (lambda () (break (lambda (line) (string=? line "@end deffn")) rest))
               (lambda (body rest)
                 (loop rest
                       (cons (list (string->symbol (third (string-split line #\space)))
                                   (string-trim-both (string-join body "\n")))
                             entries))))
             (loop rest entries)))))))

(define reference (read-reference))
(define (exports module) (module-map (lambda (name _) name) (resolve-interface module)))
(let ((exported (append (exports '(timewarp)) (exports '(timewarp vectors))))
      (described (map first reference)))
  (test-equal "every export is in the reference" '() (lset-difference eq? exported described))
  (test-equal "and nothing else" '() (lset-difference eq? described exported))
  (test-equal "each once" '()
              (filter (lambda (name) (> (count (lambda (other) (eq? name other)) described) 1))
                      (delete-duplicates described)))
  (test-equal "each with a text" '()
              (filter-map (match-lambda ((name text) (and (< (string-length text) 10) name)))
                          reference)))

(clean-up)
(test-end "manual")
