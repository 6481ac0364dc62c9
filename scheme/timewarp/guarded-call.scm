;; How the C++ side calls procedures of the user's, within its catch (src/script/border.cc).
;;
;; An exception is looked at twice: here while the stack still stands, for the places that its message
;; names, then where it is caught, where the message is made.  Guile's `catch' with a handler before
;; unwinding does the first, too, but makes a fluid and four closures a call for it.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp guarded-call)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors))

(define (note-places exn)
  (%call-raised! '())                   ; from here on nothing interrupts
  (unless (eq? (exception-kind exn) 'timewarp-interrupted)
    (%call-raised! (error-places)))
  (raise-exception exn))

;; In place of an escape, by a continuation or to a prompt, whose stack still stands.
(define (stop-escape)
  (%call-raised! (error-places))
  (throw 'timewarp-escape))

(define-syntax-rule (watched expression)
  (with-exception-handler note-places (lambda () expression)))

(%set-call-hooks!
 (case-lambda
   ((procedure) (watched (procedure)))
   ((procedure a) (watched (procedure a)))
   ((procedure a b) (watched (procedure a b)))
   ((procedure a b c) (watched (procedure a b c)))
   ((procedure . arguments) (watched (apply procedure arguments))))
 stop-escape
 describe-error)
