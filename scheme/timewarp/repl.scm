;; The REPL: Guile's own, with (timewarp) at hand, readline where it is installed, and a short banner.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp repl)
  #:use-module (timewarp primitives)
  #:use-module (timewarp interrupts)
  #:use-module (system repl repl)
  #:use-module (system repl common)
  #:export (start-timewarp-repl))

(define (activate-readline-if-there)
  (when (and (isatty? (current-input-port))
             (false-if-exception (resolve-interface '(ice-9 readline))))
    (let ((activate (module-ref (resolve-interface '(ice-9 readline)) 'activate-readline)))
      (activate))))

(define (load-user-init)
  (let ((file (string-append (or (getenv "HOME") "/") "/.guile")))
    (when (file-exists? file)
      (save-module-excursion
       (lambda ()
         (set-current-module (resolve-module '(guile-user)))
         (primitive-load file))))))

(define (banner)
  (format #f "timewarp ~a on Guile ~a.  ,help for help, ,describe NAME for a procedure's, (exit) to leave."
          (%version) (version)))

;; The REPL takes the `quit' of a signal that comes while it compiles for an error of the expression,
;; and asks for the next.
(define (leave-if-ending)
  (when (ending?) (throw 'quit)))

(define* (start-timewarp-repl #:key (init? #t))
  "Run a REPL in (guile-user) until the user leaves it."
  (when init? (load-user-init))
  (activate-readline-if-there)
  (set-current-module (resolve-module '(guile-user)))
  (module-set! (resolve-module '(system repl common)) '*version* (banner))
  (add-hook! before-read-hook leave-if-ending)
  ;; Ctrl-C while an expression of the user is evaluated raises an error at the prompt
  (call-with-interrupts start-repl))
