;; How many arguments a procedure takes that is to be called later: a wrong number is told where the
;; procedure is handed over, not when it is first called, which may be long after.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp arity)
  #:use-module (timewarp errors)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:use-module (system vm program)
  #:export (check-takes))

(define (ways procedure)
  (or (and (program? procedure) (false-if-exception (program-arguments-alists procedure))) '()))

(define (way-takes? way count)
  (define (how-many key) (length (or (assq-ref way key) '())))
  (let ((required (how-many 'required)))
    (and (>= count required)
         (or (assq-ref way 'rest) (<= count (+ required (how-many 'optional)))))))

;; "(time ball)", as it is written
(define (written way)
  (append (or (assq-ref way 'required) '())
          (match (assq-ref way 'optional)
            ((names ..1) (cons #:optional names))
            (_ '()))
          (or (assq-ref way 'rest) '())))

(define (check-takes who procedure count handed)
  "Raise an error unless the PROCEDURE that WHO is given can be called with COUNT arguments: with
what HANDED says.  What is no procedure, or does not tell what it takes, is left alone."
  (let ((all (ways procedure)))
    (unless (or (null? all) (any (lambda (way) (way-takes? way count)) all))
      (raise-error (format #f "the procedure of ~a takes ~a; expected one that takes ~a: ~a" who
                           (string-join (map (lambda (way) (format #f "~a" (written way))) all)
                                        " or ")
                           (if (= count 1) "1 argument" (format #f "~a arguments" count))
                           handed)))))
