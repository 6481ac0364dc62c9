;; --check: callbacks are watched for changing variables of the scene, which no rollback undoes.
;;
;; The data in the scene's variables is copied before a call and compared after it.  What hides behind
;; procedures and records is not seen.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp purity)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:export (watched))

;; A copy of VALUE that later changes don't reach; what is no plain data stands for itself.
(define (copy value)
  (cond ((pair? value) (cons (copy (car value)) (copy (cdr value))))
        ((vector? value) (list->vector (map copy (vector->list value))))
        ((string? value) (string-copy value))
        ((hash-table? value) (hash-map->list (lambda (k v) (cons k (copy v))) value))
        ((array? value) (array-copy* value))
        (else value)))

(define (array-copy* array)
  (let ((new (apply make-typed-array (array-type array) *unspecified* (array-dimensions array))))
    (array-copy! array new)
    new))

(define (snapshot module)
  (module-map (lambda (name variable)
                (list name variable
                      (and (variable-bound? variable) (copy (variable-ref variable)))))
              module))

(define (check-unchanged before)
  (for-each
   (lambda (entry)
     (let ((variable (cadr entry)))
       (unless (equal? (caddr entry)
                       (and (variable-bound? variable) (copy (variable-ref variable))))
         (raise-error
          (string-append
           "a callback changed the variable " (symbol->string (car entry))
           ", which a rollback would not undo; expected it to change only what it is handed (a slot "
           "holds what must be kept, an observer runs once)")))))
   before))

(define (watched procedure)
  "Return PROCEDURE, under --check one that raises an error where it changes variables of the scene."
  (if (and (override 'check) (procedure? procedure))
      (let ((module (current-module)))
        (lambda args
          (let ((before (snapshot module)))
            (call-with-values (lambda () (apply procedure args))
              (lambda results
                (check-unchanged before)
                (apply values results))))))
      procedure))
