;; Signals: Ctrl-C, and those that end the program.
;;
;; Ctrl-C (SIGINT) throws `timewarp-interrupted' where that is safe.  While something is recorded
;; SIGTERM and SIGHUP throw `quit', which leaves the REPL, too: everything is closed, then the program
;; ends by the signal itself, as the shell expects.  So it does with SIGPIPE after its output has lost
;; its reader.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp interrupts)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:export (call-with-interrupts
            interrupt-count
            call-with-ending-signals
            call-with-write-errors
            ending?
            reader-gone?
            exit-program))

;; The signal by which the program will end, or #f.
(define ending-signal #f)

(define (ending?)
  "Is the program to end by a signal, once everything is closed?"
  (->bool ending-signal))

;; Calls THUNK with the HANDLERS, lists (SIGNAL HANDLER [FLAGS]).
(define (call-with-handlers handlers thunk)
  (let ((outer #f))
    (dynamic-wind
      (lambda ()
        (set! outer (map (lambda (handler) (cons (car handler) (apply sigaction handler)))
                         handlers)))
      thunk
      (lambda ()
        (unless (ending?)
          (for-each (lambda (old) (sigaction (car old) (cadr old) (cddr old))) outer))))))

;; How often Ctrl-C came: who evaluates for others sees that they were interrupted.
(define interrupts 0)
(define (interrupt-count) interrupts)

(define (interrupt! signal)
  (set! interrupts (1+ interrupts))
  (%interrupt! signal))

(define (call-with-interrupts thunk)
  "Call THUNK; Ctrl-C throws timewarp-interrupted where that is safe."
  (call-with-handlers (list (list SIGINT interrupt!)) thunk))

;; SA_RESETHAND, which Guile doesn't name: a second signal of the kind kills
(define only-once (- (expt 2 31)))

;; A second SIGHUP means nothing: when a terminal closes, the shell and the system send one each.
(define (end-by! signal)
  (set! ending-signal signal)
  (sigaction SIGHUP SIG_IGN)
  (%interrupt! signal))

(define (ignored? signal) (eqv? (car (sigaction signal)) SIG_IGN))

(define (call-with-ending-signals thunk)
  "Call THUNK; SIGTERM and SIGHUP leave it by throwing `quit' where that is safe.  Those that were
ignored stay so: nohup ignores SIGHUP."
  (call-with-handlers (filter (lambda (handler) (not (ignored? (car handler))))
                              (list (list SIGTERM end-by! only-once) (list SIGHUP end-by!)))
                      thunk))

(define (call-with-write-errors thunk)
  "Call THUNK; SIGPIPE, and SIGXFSZ of a file beyond its limit, become errors of what writes."
  ;; no SIG_IGN, which programs that we start would inherit
  (call-with-handlers (list (list SIGPIPE (const #t)) (list SIGXFSZ (const #t))) thunk))

(define (reader-gone? key args)
  "Is this exception the failure to write where nobody reads any more, as after `| head -1'?  The
program then ends by SIGPIPE."
  (let ((gone? (and (string-contains (error-text key args) (strerror EPIPE)) (%reader-gone?))))
    (when gone? (set! ending-signal SIGPIPE))
    gone?))

(define (exit-program status)
  "End the program, by its signal or with STATUS."
  (when ending-signal
    (false-if-exception (force-output (current-output-port)))
    (sigaction ending-signal SIG_DFL)
    (kill (getpid) ending-signal))
  (primitive-exit status))
