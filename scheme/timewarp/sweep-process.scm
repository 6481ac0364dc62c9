;; Other programs: finding, quoting, starting and stopping them.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-process)
  #:use-module (timewarp errors)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:export (sweep-program
            timewarp-program
            require-program
            shell-quote
            command->text
            start-process
            wait-for-process
            call-with-stopping-signals
            stopping?))

;; ---- where they are ----

;; Both names lead to one executable.
(define (beside-executable name)
  (string-append (dirname (readlink "/proc/self/exe")) "/" name))

(define (timewarp-program)
  "Return the absolute name of the program timewarp."
  (or (getenv "TIMEWARP") (beside-executable "timewarp")))

(define (sweep-program)
  "Return the absolute name of the program timewarp-sweep."
  (string-append (dirname (timewarp-program)) "/timewarp-sweep"))

(define (require-program program package purpose)
  "Raise an error that names the Debian PACKAGE unless PROGRAM is in a folder of PATH."
  (unless (search-path (parse-path (or (getenv "PATH") "")) program)
    (raise-error (format #f "~a needs ~a, which is not in PATH; on Debian: apt-get install ~a"
                         purpose program package))))

;; ---- shell ----

(define plain-characters
  (char-set-union (ucs-range->char-set 48 58) (ucs-range->char-set 65 91)
                  (ucs-range->char-set 97 123) (string->char-set "-_./=,:+@%^")))

(define (shell-quote text)
  "Return TEXT as one word of a shell's command."
  (if (and (not (string-null? text)) (string-every plain-characters text))
      text
      (string-append "'" (string-join (string-split text #\') "'\\''") "'")))

(define (command->text arguments)
  "Return ARGUMENTS as a line for a shell."
  (string-join (map shell-quote arguments) " "))

;; ---- processes ----

(define* (start-process arguments #:key output errors own-group?)
  "Start the program that ARGUMENTS name; return its process number.  OUTPUT and ERRORS are ports on
files or pipes; standard input is empty.  With OWN-GROUP? Ctrl-C at a terminal doesn't reach it."
  (flush-all-ports)
  (let ((pid (primitive-fork)))
    (when (zero? pid)
      (catch #t
        (lambda ()
          (when own-group? (setpgid 0 0))
          (dup2 (fileno (open-input-file "/dev/null")) 0)
          (when output (dup2 (fileno output) 1))
          (when errors (dup2 (fileno errors) 2))
          (apply execlp (first arguments) arguments))
        (lambda (key . args)
          (format (current-error-port) "~a: ~a~%" (first arguments) (error-text key args))
          (primitive-_exit 127))))
    pid))

;; As shells have it: of a program that a signal ended, 128 and the signal's number.
(define (wait-for-process pid)
  "Wait until the process PID has ended; return its exit status."
  (match (waitpid pid)
    ((_ . status) (or (status:exit-val status) (+ 128 (status:term-sig status))))))

;; ---- signals ----

(define (ignored? signal) (eqv? (car (sigaction signal)) SIG_IGN))

;; has one of the signals come?
(define stop-asked? #f)
(define (stopping?) stop-asked?)

(define (call-with-stopping-signals stop! thunk)
  "Call THUNK; the first SIGINT, SIGTERM or SIGHUP calls STOP!, and makes (stopping?) true.
A SIGHUP that was ignored stays so, as nohup wants it."
  (let ((outer '()))
    (define (handler signal)
      (let ((first? (not stop-asked?)))
        (set! stop-asked? #t)
        (when first? (stop!))))
    (dynamic-wind
      (lambda ()
        (set! outer (map (lambda (signal) (cons signal (sigaction signal handler)))
                         (cons* SIGINT SIGTERM (if (ignored? SIGHUP) '() (list SIGHUP))))))
      thunk
      (lambda ()
        (for-each (match-lambda ((signal old . flags) (sigaction signal old flags))) outer)))))
