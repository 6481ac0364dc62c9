;; The REPL server (--listen): a prompt for clients on a socket, that answers while a world runs.
;;
;; Nothing runs beside the run: clients are served at its safe points, between two slices, and while
;; the terminal's prompt waits.  So what they read is the committed world, and what they change is as
;; if it were typed between two runs.  A client's REPL is a delimited continuation that is left where
;; its socket has nothing to read and entered again where it has; what it prints is kept until the
;; socket takes it, so that no client can hold the run up by not reading.  Nor can it by computing: after
;; a while of that it is left, too, and goes on at the next safe point, after the others.  An error of a
;; client is told to that client alone.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp server)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module ((timewarp running) #:select (runs-going-on))
  #:use-module ((timewarp exit-status) #:select (complain))
  #:use-module (timewarp repl)
  #:use-module (timewarp history)
  #:use-module ((timewarp option-table) #:select (usage-error))
  #:use-module (system repl common)
  #:use-module (system repl repl)
  #:use-module (ice-9 binary-ports)
  #:use-module (ice-9 match)
  #:use-module ((ice-9 control) #:select (suspendable-continuation?))
  #:use-module (ice-9 suspendable-ports)
  #:use-module (rnrs bytevectors)
  #:use-module (srfi srfi-1)
  #:use-module (srfi srfi-9)
  #:export (parse-address
            call-with-server
            poll-server!))

;; ---- addresses ----

;; An address is (unix FILE) or (loopback PORT).

(define (default-file)
  (match (getenv "XDG_RUNTIME_DIR")
    ((? string? (? absolute-file-name? folder)) (string-append folder "/timewarp.socket"))
    (_ (string-append (state-folder) "/socket"))))

(define (loopback-port text whole)
  (let ((port (string->number text)))
    (unless (and (exact-integer? port) (<= 1 port 65535))
      (usage-error "--listen is ~s; expected a port from 1 to 65535" whole))
    (list 'loopback port)))

(define (parse-address text)
  "Return the address that TEXT, the value of --listen, stands for; #t: the default."
  (cond
   ((not (string? text)) (list 'unix (default-file)))
   ((string-null? text) (usage-error "--listen= is empty; expected a file or a port"))
   ((string-index text #\/) (list 'unix text))
   ((string-every char-numeric? text) (loopback-port text text))
   ((string-rindex text #\:)
    => (lambda (colon)
         (let ((host (substring text 0 colon)))
           ;; whoever reaches the prompt can do all that the user can
           (unless (member host '("localhost" "127.0.0.1"))
             (usage-error "--listen is ~s; expected localhost: other machines must not get in" text))
           (loopback-port (substring text (1+ colon)) text))))
   (else (list 'unix text))))

(define (address->text address)
  (match address
    (('unix file) file)
    (('loopback port) (format #f "localhost:~a" port))))

;; ---- the listening socket ----

(define (refuse address what)
  (raise-error (format #f "cannot listen on ~a: ~a" (address->text address) what)))

(define-syntax-rule (refusing address body ...)
  (catch 'system-error
    (lambda () body ...)
    (lambda args (refuse address (strerror (system-error-errno args))))))

(define (answers? file)
  (let* ((socket (socket PF_UNIX SOCK_STREAM 0))
         (connected? (false-if-exception (connect socket AF_UNIX file))))
    (close-port socket)
    (->bool connected?)))

;; A socket that is left of a program that died is in the way.
(define (clear-file address file)
  (match (stat file #f)
    (#f #t)
    (there
     (unless (eq? (stat:type there) 'socket)
       (refuse address "there is a file of that name, which is no socket; expected another name"))
     (when (answers? file)
       (refuse address "a program is listening there; expected another name, --listen=FILE"))
     (delete-file file))))

(define (open-listener address)
  (match address
    (('unix file)
     ;; sun_path
     (when (> (string-utf8-length file) 107)
       (refuse address "the name is longer than the 107 bytes of a socket's; expected a shorter one"))
     (refusing address
       (when (string=? file (default-file)) (make-folders (dirname file)))
       (clear-file address file)
       (let ((socket (socket PF_UNIX SOCK_STREAM 0)) (outer #f))
         (dynamic-wind
           ;; never anybody else's, not even for a moment
           (lambda () (set! outer (umask #o177)))
           (lambda () (bind socket AF_UNIX file))
           (lambda () (umask outer)))
         (start-listening socket))))
    (('loopback port)
     (refusing address
       (let ((socket (socket PF_INET SOCK_STREAM 0)))
         (setsockopt socket SOL_SOCKET SO_REUSEADDR 1)
         (bind socket AF_INET INADDR_LOOPBACK port)
         (start-listening socket))))))

(define (start-listening socket)
  (listen socket 8)
  (unblock! socket)
  socket)

(define (unblock! socket)
  ;; programs that we start don't inherit it
  (fcntl socket F_SETFD (logior FD_CLOEXEC (fcntl socket F_GETFD)))
  (fcntl socket F_SETFL (logior O_NONBLOCK (fcntl socket F_GETFL))))

;; ---- clients ----

;; OUTBOX: bytevectors that the socket has not taken yet, the newest first.  RESUME goes on with its
;; REPL; #f while that runs.  COMPUTING: what interrupt-count was when it was left while it computed, #f
;; where it waits for input.  NEW?: nothing was read of it yet.
(define-record-type <client>
  (make-client socket output outbox resume computing new?)
  client?
  (socket client-socket)
  (output client-output set-client-output!)
  (outbox client-outbox set-client-outbox!)
  (resume client-resume set-client-resume!)
  (computing client-computing set-client-computing!)
  (new? client-new? set-client-new!))

(define listener #f)
(define clients '())

(define client-tag (make-prompt-tag "client"))
(define restart-tag (make-prompt-tag "restart"))

;; bytes that are kept for a client that doesn't read; then it is left
(define most-kept (expt 2 26))

(define (make-output client)
  (let ((port (make-custom-binary-output-port
               "client"
               (lambda (bytes start count)
                 (let ((copy (make-bytevector count)))
                   (bytevector-copy! bytes start copy 0 count)
                   (set-client-outbox! client (cons copy (client-outbox client))))
                 count)
               #f #f #f)))
    (set-port-encoding! port "UTF-8")
    (set-port-conversion-strategy! port 'substitute)
    port))

;; Sends what SOCKET takes of BYTES; returns what is left, or #f.
(define (send-some socket bytes)
  (let ((sent (catch 'system-error
                (lambda () (send socket bytes))
                (lambda args
                  (let ((errno (system-error-errno args)))
                    (if (or (= errno EAGAIN) (= errno EINTR)) 0 (apply throw args))))))
        (size (bytevector-length bytes)))
    (and (< sent size)
         (let ((rest (make-bytevector (- size sent))))
           (bytevector-copy! bytes sent rest 0 (- size sent))
           rest))))

;; Ctrl-C must not come between what is sent and the note of it.
(define (send-outbox! client)
  (call-with-blocked-asyncs (lambda () (send-kept! client))))

(define (send-kept! client)
  (force-output (client-output client))
  (let loop ((left (reverse (client-outbox client))))
    (match left
      (() (set-client-outbox! client '()))
      ((bytes . others)
       (match (send-some (client-socket client) bytes)
         (#f (loop others))
         (rest
          (set-client-outbox! client (reverse (cons rest others)))
          (when (> (fold + 0 (map bytevector-length (client-outbox client))) most-kept)
            (throw 'system-error "send" "~A" (list "the client doesn't read") (list EPIPE)))))))))

(define (drop-client! client)
  (set! clients (delq client clients))
  (false-if-exception (send-outbox! client))
  (false-if-exception (close-port (client-socket client))))

;; microseconds of CPU time for which a client computes at a time: as long as a slice of the run
(define turn 20000)

;; What SIGVTALRM does at the end of a turn: #f where no client computes.
(define end-of-turn #f)

(define (start-turn!) (setitimer ITIMER_VIRTUAL 0 0 0 turn))
(define (stop-turn!) (setitimer ITIMER_VIRTUAL 0 0 0 0))

;; Calls THUNK, the client's REPL, until it waits for input or its turn is over.  Within a run of its
;; own, which serves the others, or where a C frame is on the stack it goes on, and is asked again.
(define (run-client! client thunk)
  (define outer end-of-turn)
  (define runs (runs-going-on))
  (define (leave!)
    (cond ((and (= runs (runs-going-on)) (suspendable-continuation? client-tag))
           (set-client-computing! client (interrupt-count))
           (let ((before (abort-to-prompt client-tag)))
             (unless (= before (interrupt-count)) (throw 'timewarp-interrupted))))
          (else (start-turn!))))
  (set-client-resume! client #f)
  (dynamic-wind
    (lambda ()
      (set! end-of-turn leave!)
      (start-turn!))
    (lambda ()
      (call-with-prompt client-tag
        thunk
        (lambda (resume) (set-client-resume! client resume))))
    (lambda ()
      (stop-turn!)
      (set! end-of-turn outer)
      (when outer (start-turn!)))))

;; A prompt within an error handler, as Guile's debugger has it, cannot wait for its input while
;; others go on: then the client is back at its first one.
(define (start-client-repl)
  (call-with-prompt restart-tag
    start-repl
    (lambda (inner)
      (format #t "~%the debugger's prompt cannot wait here: back at the first one~%")
      (start-client-repl))))

(define (serve client)
  (let ((socket (client-socket client))
        (output (client-output client))
        (wait (current-read-waiter)))
    (parameterize ((current-input-port socket)
                   (current-output-port output)
                   (current-error-port output)
                   (current-warning-port output)
                   (current-read-waiter
                    (lambda (port)
                      (cond ((not (eq? port socket)) (wait port))
                            ((suspendable-continuation? client-tag) (abort-to-prompt client-tag))
                            (else (abort-to-prompt restart-tag))))))
      (with-fluids ((*repl-stack* '()))
        (save-module-excursion
         (lambda ()
           (set-current-module (resolve-module '(guile-user)))
           ;; (exit) and the end of its input end a client, not the program
           (catch 'quit start-client-repl (const #f))))))
    (drop-client! client)))

(define (accept-client!)
  ;; one that has gone again must not be waited for
  (match (false-if-exception
          (parameterize ((current-read-waiter (lambda (port) (throw 'nobody))))
            (accept listener)))
    ((socket . _)
     (unblock! socket)
     (set-port-encoding! socket "UTF-8")
     (set-port-conversion-strategy! socket 'substitute)
     (let ((client (make-client socket #f '() #f #f #t)))
       (set-client-output! client (make-output client))
       (set! clients (append clients (list client)))
       (serving client (lambda () (run-client! client (lambda () (serve client)))))))
    (_ #f)))

;; A web page can make a browser send requests to a port of this machine, with lines of Scheme in
;; them: who begins as HTTP does is no client.
(define http (make-regexp "^[A-Z]+ [^\r\n]* HTTP/[0-9]"))

(define (check-first-words! client)
  (when (client-new? client)
    (set-client-new! client #f)
    (let* ((bytes (make-bytevector 4096))
           (count (recv! (client-socket client) bytes MSG_PEEK))
           (text (latin-1->string bytes count)))
      (when (regexp-exec http text)
        (complain "timewarp: warning: a web browser's request came to --listen; it was not answered")
        (throw 'system-error "recv" "~A" (list "a request of HTTP") (list EPROTO))))))

(define (latin-1->string bytes count)
  (string-map (lambda (char) (if (char=? char #\nul) #\? char))
              (list->string (map (lambda (i) (integer->char (bytevector-u8-ref bytes i)))
                                 (iota count)))))

;; Calls THUNK for CLIENT, which is left where that fails: its connection has gone, as a rule.
(define (serving client thunk)
  (catch #t thunk
    (lambda (key . args)
      (drop-client! client)
      (case key
        ((system-error) #f)
        ((quit timewarp-interrupted) (apply throw key args))
        (else (complain "timewarp: warning: a client of --listen was left: ~a"
                        (error-text key args)))))))

;; Who computes reads nothing, not even that its client has gone.
(define (check-presence! client)
  (when (zero? (recv! (client-socket client) (make-bytevector 1) MSG_PEEK))
    (throw 'system-error "recv" "~A" (list "the client has gone") (list EPIPE))))

(define (go-on! client ready?)
  (match (client-computing client)
    (#f
     (when ready?
       (check-first-words! client)
       (run-client! client (client-resume client))))
    (interrupts
     (when ready? (check-presence! client))
     (set-client-computing! client #f)
     (let ((resume (client-resume client)))
       (run-client! client (lambda () (resume interrupts)))))))

(define (poll-client! client ready)
  (serving client
    (lambda ()
      (when (client-resume client)
        (go-on! client (memq (client-socket client) ready)))
      (when (memq client clients) (send-outbox! client)))))

(define (poll-server!)
  "Serve the clients that have sent something, if there is a server.  Called at safe points."
  (when listener
    (match (select (cons listener (filter-map (lambda (client)
                                                (and (client-resume client)
                                                     (client-socket client)))
                                              clients))
                   '() '() 0)
      ((ready . _)
       (let ((before (interrupt-count)))
         (when (memq listener ready) (accept-client!))
         (for-each (lambda (client) (poll-client! client ready)) clients)
         ;; what a client evaluated has been stopped; Ctrl-C at the terminal means the run there
         (unless (= (interrupt-count) before) (throw 'timewarp-interrupted)))))))

;; ---- from beginning to end ----

(define (close-server! address)
  (for-each drop-client! clients)
  (close-port listener)
  (set! listener #f)
  (match address
    (('unix file) (false-if-exception (delete-file file)))
    (_ #t)))

(define (call-with-turns thunk)
  (let ((outer #f))
    (dynamic-wind
      (lambda ()
        (set! outer (sigaction SIGVTALRM (lambda (signal) (when end-of-turn (end-of-turn))))))
      thunk
      (lambda () (sigaction SIGVTALRM (car outer) (cdr outer))))))

(define (call-with-server address announce thunk)
  "Call THUNK while clients are served on ADDRESS; ANNOUNCE is called with its text.  Connections and
the socket are closed however THUNK is left."
  (install-suspendable-ports!)
  (prepare-repl!)
  (call-with-ending-signals
   (lambda ()
     (dynamic-wind
       (lambda () (set! listener (open-listener address)))
       (lambda ()
         (announce (address->text address))
         (call-with-turns thunk))
       (lambda () (close-server! address))))))
