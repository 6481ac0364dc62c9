;; Errors at the border of a program: a message on standard error and an exit status.
;;
;; 0; 1 for an error; 2 for wrong usage; 130 after Ctrl-C.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp exit-status)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module (ice-9 match)
  #:export (exit-status flush-output complain))

;; A disk may be full.
(define (flush-output)
  "Write out what standard output still holds; a failure is an error."
  (catch 'system-error
    (lambda () (force-output (current-output-port)))
    (lambda args
      (raise-error (format #f "cannot write standard output: ~a"
                           (strerror (system-error-errno args)))))))

(define (complain format-string . args)
  "Print a line on standard error."
  ;; standard output may be what failed
  (false-if-exception (force-output (current-output-port)))
  (let ((port (current-error-port)))
    (apply format port format-string args)
    (newline port)
    (force-output port)))

;; An error that is no timewarp-error, for instance in -c: as describe-error sees it.
(define (complain-about program key args description)
  (match (if (eq? key 'timewarp-error) (describe-error key args) description)
    (#(message place backtrace)
     (complain "~a~a~a"
               (if place (string-append (place->string place) ": ") (string-append program ": "))
               message
               (if (string-null? backtrace) "" (string-append "\n" backtrace))))
    (_ (complain "~a: ~a" program (error-text key args)))))

(define* (exit-status thunk #:optional (program "timewarp"))
  "Call THUNK; return the exit status that PROGRAM owes, after telling what went wrong."
  (let ((description #f))
    (catch #t
      (lambda () (thunk) 0)
      (lambda (key . args)
        (match (cons key args)
          (('timewarp-usage message) (complain "~a: ~a" program message) 2)
          (('timewarp-interrupted) (complain "interrupted") 130)
          (('quit . status)
           (match status ((or () (#t)) 0) ((#f) 1) (((? integer? n) . _) n) (_ 1)))
          (_ (unless (reader-gone? key args) (complain-about program key args description)) 1)))
      (lambda (key . args)
        (unless (memq key '(quit timewarp-usage timewarp-interrupted timewarp-error))
          (set! description (describe-error key args)))))))
