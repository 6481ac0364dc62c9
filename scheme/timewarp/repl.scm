;; The REPL: Guile's own, with (timewarp) at hand, lines edited by readline where it is installed, and
;; a short banner.
;;
;; There is one level of it: an error is shown with the user's frames, and the prompt is there
;; again.  So (exit) and Ctrl-D leave it at any time; `,option on-error 'debug' brings Guile's nested
;; prompts, with their debugger, back.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp repl)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp forms)
  #:use-module (timewarp help)
  #:use-module (timewarp line-editing)
  #:use-module (system repl repl)
  #:use-module (system repl common)
  #:use-module ((system repl command) #:select (define-meta-command))
  #:use-module ((system base compile) #:select (compile))
  #:use-module (ice-9 match)
  #:export (start-timewarp-repl prepare-repl!))

(define (load-user-init)
  (let ((file (string-append (or (getenv "HOME") "/") "/.guile")))
    (when (file-exists? file)
      (save-module-excursion
       (lambda ()
         (set-current-module (resolve-module '(guile-user)))
         (primitive-load file))))))

;; Guile adds "Enter `,help' for help."
(define (banner)
  (format #f "timewarp ~a on Guile ~a.  (help) says what to type, (exit) leaves."
          (%version) (version)))

;; Guile compiles each expression that is typed into a unit of its own.
(define hold-now-and-then
  (let ((expressions 0))
    (lambda _
      (set! expressions (1+ expressions))
      (when (zero? (remainder expressions 256))
        (hold-all-units!)))))

;; The REPL takes the `quit' of a signal that comes while it compiles for an error of the expression,
;; and asks for the next.
(define (leave-if-ending)
  (when (ending?) (throw 'quit)))

;; Guile's ,bt has no frames where an error is shown and the prompt is as before, and of a callback not
;; the user's: these come first.
(define (show-users-frames-in-backtrace!)
  (define commands (resolve-module '(system repl command)))
  (define guiles (car (hashq-ref (module-ref commands '*command-infos*) 'backtrace)))
  (define-meta-command (backtrace repl . arguments)
    "backtrace [COUNT] [#:width W] [#:full? F]
Print a backtrace.

Print the frames of your own files in the last error, innermost first, and in a debugger all stack
frames, or innermost COUNT frames. If COUNT is negative, the last COUNT frames will be shown."
    (let ((frames (last-error-frames)))
      (unless (string-null? frames)
        (format #t "In your files, innermost first:~%~a~%" frames))
      (when (or (repl-debug repl) (string-null? frames))
        (apply guiles repl arguments)))))

(define prepare-repl!
  (let ((prepared? #f))
    (lambda ()
      "Set up what the terminal's REPL and those of a server's clients share."
      (unless prepared?
        (set! prepared? #t)
        (module-use! (resolve-module '(guile-user)) (resolve-interface '(timewarp help)))
        (module-set! (resolve-module '(system repl common)) '*version* (banner))
        (repl-default-option-set! 'on-error 'report)
        (show-users-frames-in-backtrace!)
        ;; the compiler's parts are loaded when they are first needed, and what Ctrl-C keeps from
        ;; being loaded is missing from then on
        (compile '(if #f #f) #:env (resolve-module '(guile-user)))
        (add-hook! before-read-hook leave-if-ending)
        (add-hook! before-eval-hook hold-now-and-then)
        (add-hook! after-error-hook (lambda () (print-user-frames (current-error-port))))))))

;; Without readline: IDLE is called until there is something to read.
(define (wait-while-idle idle)
  (let ((reader (module-ref the-root-module 'repl-reader)) (terminal (current-input-port)))
    (module-set! the-root-module 'repl-reader
                 (lambda* (prompt #:optional (read (fluid-ref current-reader)))
                   (reader prompt
                           (lambda* (#:optional (port (current-input-port)))
                             (when (eq? port terminal)
                               (let loop ()
                                 (when (null? (car (select (list port) '() '() 0 20000)))
                                   (idle)
                                   (loop))))
                             (read port)))))))

(define* (start-timewarp-repl #:key (init? #t) poll)
  "Run a REPL in (guile-user) until the user leaves it; (exit STATUS) throws quit as everywhere.  POLL
is called again and again while it waits for input, where it is not #f."
  (prepare-repl!)
  (when init? (load-user-init))
  (unless (activate-line-editing poll)
    (when poll (wait-while-idle poll)))
  (set-current-module (resolve-module '(guile-user)))
  ;; Ctrl-C while an expression of the user is evaluated raises an error at the prompt
  (match (call-with-interrupts start-repl)
    (() #t)
    (status (apply throw 'quit status))))
