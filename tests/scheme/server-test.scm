;; --listen: a REPL on a socket, that answers while the simulation runs.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
;; clients write to connections that have ended
(sigaction SIGPIPE (const #t))

(test-begin "server")

;; it bounces for ever
(write-file "bounce.scm"
            "(use-modules (timewarp))"
            "(scene #:duration 1e8)"
            "(add-body! #:name \"floor\" #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
            "(set-contact-parameters! #t #t #:restitution 1)"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 0.1) #:position #(0 0 1)))")

(define socket-file (in-folder "here"))

;; Starts the program in the folder; returns its process number when it listens.
(define (start . args)
  (when (file-exists? (in-folder "server.err")) (delete-file (in-folder "server.err")))
  (let ((pid (primitive-fork)))
    (when (zero? pid)
      (chdir (force folder))
      (dup2 (fileno (open-file "server.out" "w")) 1)
      (dup2 (fileno (open-file "server.err" "w")) 2)
      (apply execlp timewarp timewarp args))
    (let wait ((left 200))
      (unless (or (zero? left) (string-contains (read-file* "server.err") "listening"))
        (usleep 50000)
        (wait (1- left))))
    pid))
(define (read-file* name) (if (file-exists? (in-folder name)) (read-file name) ""))

(define (wait pid) (cdr (waitpid pid)))

(define (connect-unix)
  (let ((port (socket PF_UNIX SOCK_STREAM 0)))
    (connect port AF_UNIX socket-file)
    port))

;; What comes up to the prompt, or #f where the connection ends or nothing comes for 10 s.
(define (answer port)
  (let loop ((chars '()))
    (match (select (list port) '() '() 10)
      ((() . _) #f)
      (_ (let ((char (read-char port)))
           (cond ((eof-object? char) #f)
                 ((and (char=? char #\space) (pair? chars) (char=? (car chars) #\>))
                  (list->string (reverse chars)))
                 (else (loop (cons char chars)))))))))

(define (ask port text)
  (display text port)
  (newline port)
  (force-output port)
  (answer port))

(define (number-in text)
  (string->number (match:substring (string-match "= ([0-9.e+-]+)" text) 1)))

(define-syntax-rule (test-answer name pattern port text)
  (let ((got (ask port text)))
    (test-assert (format #f "~a: ~s" name got) (and got (string-match pattern got) #t))))

;; ---- a run in batch ----

(define pid (start (string-append "--listen=" socket-file) "--until=1e8" "bounce.scm"))
(define one (connect-unix))
(define two (connect-unix))
(test-equal "only the user may connect" #o600 (logand #o777 (stat:mode (stat socket-file))))
(test-assert "a prompt comes while it runs" (string-match "timewarp.*@\\(guile-user\\)>" (answer one)))
(answer two)
(define before (number-in (ask one "(world-time)")))
(test-assert "time goes on" (< before (number-in (ask one "(world-time)"))))
(test-answer "several clients, at one time" "= \"ball\"" two "(body-name ball)")
(display "(list 1\n" one)
(force-output one)
(test-answer "an expression that is not complete holds nobody up" "= 3" two "(+ 1 2)")
(test-answer "and goes on" "= \\(1 2\\)" one "2)")
(test-answer "an error" "Wrong type" one "(car 5)")
(test-answer "a command" "current world" two ",describe world-time")
(test-answer "what it prints goes to the client" "^here\n.*= 1" one "(begin (display \"here\") (newline) 1)")
(test-answer "a body added between slices" "= \\(\"floor\" \"ball\" \"late\"\\)" two
             "(begin (add-body! #:name \"late\" #:shape (sphere 0.1) #:position #(1 0 1)) (map body-name (world-bodies)))")
(test-assert "time goes on after all that" (< before (number-in (ask one "(world-time)"))))
(test-equal "(exit) ends the client only" #f (ask two "(exit)"))
;; nor does who computes for ever hold others up, nor for a while
(define endless (connect-unix))
(answer endless)
(display "(define turns 0)\n(let loop () (set! turns (1+ turns)) (loop))\n" endless)
(force-output endless)
(define busy (connect-unix))
(answer busy)
(display "(let loop ((k 0)) (if (< k 30000000) (loop (1+ k)) (list 'counted k)))\n" busy)
(force-output busy)
(usleep 300000)
(test-answer "another gets answers while one computes for ever" "= 9" one "(+ 4 5)")
(test-assert "and the run goes on"
  (let ((time (number-in (ask one "(world-time)"))))
    (usleep 200000)
    (< time (number-in (ask one "(world-time)")))))
(test-assert "what takes long is done in the end" (string-match "= \\(counted 30000000\\)" (answer busy)))
(define turns (number-in (ask one "turns")))
(usleep 200000)
(test-assert "the endless one goes on" (< turns (number-in (ask one "turns"))))
(test-answer "a client's own run serves the others, too" "= [0-9.]+" busy "(begin (run-for! 100) (world-time))")
(close-port endless)
(usleep 200000)
(define (settled) (let ((turns (number-in (ask one "turns")))) (usleep 200000) (= turns (number-in (ask one "turns")))))
(test-assert "it ends with its connection" (settled))
(close-port busy)
;; who doesn't read what he asked for doesn't hold the run up
(define three (connect-unix))
(display "(make-list 200000 \"a long string of which there will be very many\")\n" three)
(force-output three)
(usleep 300000)
(test-answer "another still gets answers" "= 4" one "(+ 2 2)")
(close-port three)
(test-answer "also when that one has gone" "= 5" one "(+ 2 3)")
(let ((second (run (string-append "--listen=" socket-file) "--until=0.1" "bounce.scm")))
  (test-equal "one program a socket" 1 (run-status second))
  (test-assert (string-append "and it says so: " (run-errors second))
    (string-contains (run-errors second) "a program is listening there")))
;; 40 replies in sequence
(define latencies
  (sort (map (lambda (k)
               (let ((start (get-internal-real-time)))
                 (ask one "(world-time)")
                 (/ (- (get-internal-real-time) start) internal-time-units-per-second 1.0)))
             (iota 40))
        <))
(test-assert (format #f "half of the replies within 0.2 s: ~a" (list-ref latencies 20))
  (< (list-ref latencies 20) 0.2))
(kill pid SIGINT)
(test-equal "connections end with the program" #f (answer one))
(test-equal "Ctrl-C stops the run" 130 (status:exit-val (wait pid)))
(test-assert "the socket is gone" (not (file-exists? socket-file)))

;; ---- what a client evaluates when Ctrl-C comes ----

(define pid (start (string-append "--listen=" socket-file) "bounce.scm"))
(define one (connect-unix))
(answer one)
(display "(let loop () (loop))\n" one)
(force-output one)
(usleep 300000)
(kill pid SIGINT)
(test-equal "Ctrl-C stops the run, too, while a client evaluates" 130 (status:exit-val (wait pid)))

;; ---- a program that died leaves a socket ----

(define pid (start (string-append "--listen=" socket-file) "bounce.scm"))
(kill pid SIGKILL)
(wait pid)
(test-assert "a socket is left" (file-exists? socket-file))
(test-equal "it is no obstacle" 0
  (run-status (run (string-append "--listen=" socket-file) "--until=0.1" "bounce.scm")))
(test-assert "and gone in the end" (not (file-exists? socket-file)))

;; SIGTERM clears up, too
(define pid (start (string-append "--listen=" socket-file) "bounce.scm"))
(kill pid SIGTERM)
(test-equal "SIGTERM ends it" SIGTERM (status:term-sig (wait pid)))
(test-assert "and the socket is gone" (not (file-exists? socket-file)))

;; the history is the same, whether clients look or not
(write-file "short.scm" "(load \"bounce.scm\")" "(scene #:duration 20000)")
(define hash (last (lines-of (run-output (run "--hash" "--quiet" "short.scm")))))
(define pid (start (string-append "--listen=" socket-file) "--hash" "short.scm"))
(define one (false-if-exception (connect-unix)))
(when one
  (answer one)
  (let loop () (when (false-if-exception (ask one "(position ball)")) (loop))))
(wait pid)
(test-equal "looking changes no history" hash (last (lines-of (read-file "server.out"))))

;; ---- at the prompt that waits; a port of this machine ----

(define (free-port)
  (let ((port (socket PF_INET SOCK_STREAM 0)))
    (bind port AF_INET INADDR_LOOPBACK 0)
    (let ((number (sockaddr:port (getsockname port))))
      (close-port port)
      number)))
(define number (free-port))
(define prompt (pipe))
(define (connect-tcp)
  (let ((port (socket PF_INET SOCK_STREAM 0)))
    (connect port AF_INET INADDR_LOOPBACK number)
    port))
(define pid
  (begin
    (dup2 (fileno (car prompt)) 0)
    (fcntl (cdr prompt) F_SETFD FD_CLOEXEC)
    (start (format #f "--listen=localhost:~a" number) "-i" "-q" "--until=0" "bounce.scm")))
(define one (connect-tcp))
(answer one)
(test-answer "a REPL that waits for its user answers clients" "= \"ball\"" one "(body-name ball)")
(define web (connect-tcp))
(answer web)
(test-equal "a browser's request is not evaluated" #f
  (false-if-exception (ask web "GET / HTTP/1.1\r\n\r\n(primitive-exit 9)")))
(test-answer "and does no harm" "= 2" one "(+ 1 1)")
(display "(exit 7)\n" (cdr prompt))
(close-port (cdr prompt))
(test-equal "the user's (exit) ends it" 7 (status:exit-val (wait pid)))

;; ---- in Guile's place, as Geiser starts it and talks to it ----

(test-equal "its version" (version) (run-output (run "-c" "'(display (version))'")))
(mkdir (in-folder "editor"))
(write-file "editor/talk.scm"
            "(define-module (talk) #:use-module (system repl command))"
            "(define datum syntax->datum)"
            "(define-meta-command ((talk-eval talk) repl (module form) . rest)"
            "  \"talk-eval MODULE FORM\nEvaluate FORM in MODULE.\""
            "  (write (list 'result (eval (datum form) (resolve-module (datum module)))))"
            "  (newline))")
(write-file "init.scm" "(define from-init 5)")
(write-file "talk.txt" ",use (talk)" "'done" ",talk-eval (guile-user) (world-time)"
            ",talk-eval (guile-user) from-init" "(exit)")
(test-assert "options of Guile, and commands of an editor's own"
  (string-match "= done\n.*\\(result 0.0\\)\n.*\\(result 5\\)"
                (run-output (run "-q -L editor -l init.scm <talk.txt"))))
(define pid (start (string-append "--listen=" socket-file) "-L" "editor" "bounce.scm"))
(define one (connect-unix))
(answer one)
(test-answer "the same through a socket" "done" one ",use (talk)\n'done")
(test-answer "evaluates" "result \"ball\"" one ",talk-eval (guile-user) (body-name ball)")
(ask one "(use-modules (system repl error-handling))")
(test-answer "an error within a debugger's prompt is told" "Wrong type argument" one
             "(call-with-error-handling (lambda () (car 1)))")
(test-assert "which leaves the client at its first one"
  (string-match "back at the first one" (answer one)))
(test-answer "where it goes on" "= 42" one "(+ 40 2)")
(kill pid SIGINT)
(wait pid)

;; ---- wrong addresses ----

(define (refused pattern where)
  (let ((result (run (string-append "--listen=" where) "--until=0.1" "bounce.scm")))
    (test-assert (format #f "~a: ~a" where (run-errors result))
      (and (> (run-status result) 0) (string-match pattern (run-errors result))))))
(refused "expected localhost" "example.org:80")
(refused "expected a port from 1 to 65535" "localhost:0")
(refused "expected a port from 1 to 65535" "99999")
(refused "which is no socket" (in-folder "bounce.scm"))
(refused "longer than the 107 bytes" (string-append "/tmp/" (make-string 200 #\a)))
(refused "cannot listen on /nowhere/at/all: No such file" "/nowhere/at/all")

(clean-up)
(test-end "server")
