;; Signals that end the program, and outputs that fail: what was recorded is kept, and the exit status
;; is what a shell expects.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "signals")

(write-file "endless.scm" "(use-modules (timewarp))" "(scene #:duration 1e9)"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 1)))"
            "(observe! 'frame (lambda args (display \"frame\n\" (current-error-port))))"
            "(add-callback! ball (lambda (time view) #t) #:period 0.01)")
(write-file "stuck.scm" "(use-modules (timewarp))"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 1)))"
            "(add-callback! ball (lambda (time view) (let loop () (loop))) #:start 0.5)")
(write-file "loading.scm" "(let loop () (loop))")
;; catches what ends the run, and goes on
(write-file "deaf.scm" "(use-modules (timewarp))" "(scene #:duration 1e9)"
            "(define ball (add-body! #:shape (sphere 1)))"
            "(add-callback! ball (lambda (time view) #t) #:period 0.01)"
            "(catch #t run! (const #f))" "(run!)" "(display \"survived\")")

;; Sends SIGNAL after a second; one that doesn't end by it is killed after five (status 137).
(define (ended-by signal . args)
  (shell (format #f "timeout --foreground --preserve-status -k 5 -s ~a 1 ~a ~a" signal timewarp
                 (string-join args " "))))

;; Sends SIGNAL to a REPL that is given EXPRESSIONS and then waits for more.
(define (at-open-prompt signal expressions)
  (shell (format #f "(rm -f input; mkfifo input; exec 3<>input; echo '~a' >&3; \
timeout --foreground --preserve-status -k 5 -s ~a 2 ~a -q <&3)" expressions signal timewarp)))

;; What takes the time of a run that was stopped is told.
(let ((result (ended-by "INT" "endless.scm" "--quiet" "--stats=s.json")))
  (test-equal "SIGINT: status" 130 (run-status result))
  (test-assert "SIGINT: statistics" (string-contains (read-file "s.json") "\"callbacks")))

(for-each
 (lambda (signal status)
   (define (claim text) (format #f "SIG~a: ~a" signal text))
   (let ((result (ended-by signal "endless.scm" "--quiet" "--poses=p.csv" "--events=e.csv")))
     (test-equal (claim "status") status (run-status result))
     (test-equal (claim "nothing is said") '("frame")
       (delete-duplicates (lines-of (run-errors result))))
     ;; the scene counts its frames on standard error, after their rows
     (test-assert (claim "rows up to the last moment, whole lines")
       (let ((rows (cdr (lines-of (read-file "p.csv")))))
         (and (> (length rows) 10)
              (>= (length rows) (length (lines-of (run-errors result))))
              (string-suffix? "\n" (read-file "p.csv"))
              (every (lambda (row) (= 15 (length (string-split row #\,)))) rows))))
     (test-assert (claim "files without rows have their header")
       (string-prefix? "time,kind," (read-file "e.csv"))))
   (for-each (lambda (name . args)
               (test-equal (claim name) status (run-status (apply ended-by signal args))))
             '("an endless callback" "an endless scene" "a scene that catches everything")
             '("stuck.scm" "loading.scm" "deaf.scm"))
   (test-equal (claim "-i doesn't lead to the prompt") (list status "")
     (list-head (ended-by signal "-q" "-i" "endless.scm" "--quiet") 2))
   (test-equal (claim "leaves the REPL, quietly") (list status "")
     (match (at-open-prompt signal "") ((status _ errors) (list status errors))))
   (test-equal (claim "leaves a REPL whose expression caught it") (list status #f)
     (match (at-open-prompt
             signal "(catch #t (lambda () (let loop () (loop))) (const #f)) (display \"went on\")")
       ((status output _) (list status (string-contains output "went on"))))))
 '("TERM" "HUP") '(143 129))

;; two signals at once, as from a terminal that closes
(test-equal "a second SIGHUP changes nothing" '(129 "whole\n")
  (list-head
   (shell (format #f "(~a endless.scm --quiet --poses=p.csv & sleep 1; kill -HUP $!; kill -HUP $!; \
wait $!; status=$?; tail -c 1 p.csv | grep -qx '' && echo whole; exit $status)" timewarp))
   2))

(test-equal "nohup holds: a SIGHUP that was ignored stays so" "finished\n"
  (begin
    (write-file "short.scm" "(use-modules (timewarp))" "(scene #:duration 1)"
                "(define ball (add-body! #:shape (sphere 1)))"
                "(add-callback! ball (lambda (time view) (usleep 10000)) #:period 0.01)")
    (run-output
     (shell (format #f "timeout -s HUP -k 20 0.5 sh -c 'trap \"\" HUP; ~a short.scm --quiet && \
echo finished'" timewarp)))))

;; ---- standard output ----

(write-file "chatty.scm" "(use-modules (timewarp))" "(scene #:duration 1e9)"
            "(define ball (add-body! #:shape (sphere 1)))"
            "(observe! 'frame (lambda args (display \"a frame\\n\")))"
            "(add-callback! ball (lambda (time view) #t) #:period 0.01)")

;; the status of the first command of a pipe, then what the reader printed
(define (piped args reader)
  (shell (format #f "({ { timeout 20 ~a ~a; echo $? >&3; } | ~a; } 3>&1)" timewarp args reader)))

(test-equal "| head -1 ends a run by SIGPIPE, quietly" '(("a frame" "141") "")
  (match (piped "chatty.scm --quiet --poses=p.csv" "head -1")
    ((0 output errors) (list (lines-of output) errors))))
(test-assert "what was recorded is kept"
  (and (> (length (lines-of (read-file "p.csv"))) 1000) (string-suffix? "\n" (read-file "p.csv"))))
(test-equal "a second SIGTERM ends what waits for a reader" "143\n"
  (run-output
   (shell (format #f "({ { ~a chatty.scm --quiet & sleep 2; kill $!; sleep 0.5; kill $!; wait $!; \
echo $? >&3; } | sleep 5; } 3>&1)" timewarp))))
(test-equal "--help that nobody reads is quiet, too" '("141\n" "")
  (cdr (piped "--help" "(exec <&-; sleep 1)")))
(test-equal "so is -c" '(("111" "141") "")
  (match (piped "-q -c '(let loop () (display 1) (loop))'" "{ head -c 3; echo; }")
    ((0 output errors) (list (lines-of output) errors))))

(test-equal "standard output on a full disk: status 1, and why"
  '(1 "timewarp: cannot write standard output: No space left on device\n")
  (let ((result (shell (string-append "(" timewarp " --help >/dev/full)"))))
    (list (run-status result) (run-errors result))))
(for-each
 (lambda (closed)
   (test-equal (format #f "--version works with ~a" closed) 0
     (run-status (shell (format #f "(~a --version ~a)" timewarp closed)))))
 '(">&-" "<&-" "2>&-" "<&- >&- 2>&-"))
(test-equal "a file doesn't take the place of a closed standard output"
  "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"
  (begin
    (write-file "empty.scm" "(use-modules (timewarp))" "(system \"echo noise; echo noise >&2\")")
    (shell (string-append "(" timewarp " empty.scm --until=0 --poses=p.csv >&- 2>&- <&-)"))
    (read-file "p.csv")))

(clean-up)
(test-end "signals")
