;; --check: callbacks are watched for changing variables of the scene, which no rollback undoes.
;;
;; The data in the scene's variables is copied before a call and compared after it; so are the slots
;; of what the callback is handed, whose pairs could be changed in place.  What hides behind
;; procedures and records is not seen, nor what comes after the first thousands of parts of a value,
;; which may be circular.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp purity)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:export (watched))

;; of one value that are watched
(define most-parts 10000)

;; A copy of VALUE that later changes don't reach; what is no plain data stands for itself.
(define (copy value)
  (define left most-parts)
  (let copy ((value value))
    (set! left (1- left))
    (cond ((negative? left) 'unwatched)
          ((pair? value) (let ((first (copy (car value)))) (cons first (copy (cdr value)))))
          ((vector? value) (map-in-order copy (vector->list value)))
          ((string? value) (string-copy value))
          ((hash-table? value) (map-in-order copy (hash-map->list cons value)))
          ((array? value) (array-copy* value))
          (else value))))

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

;; The values in the slots of the views among ARGS.
(define (slot-values args)
  (map (lambda (arg)
         (if (and (struct? arg) (eq? (struct-vtable arg) <view>)) (%slot-values arg) '()))
       args))

(define (check-slots values before)
  (unless (equal? before (map copy values))
    (raise-error
     (string-append
      "a callback changed a pair in a slot in place, which a rollback would not undo; expected it "
      "to give the slot a new value by set!"))))

(define (watched procedure)
  "Return PROCEDURE, under --check one that raises an error where it changes variables of the scene."
  (if (and (override 'check) (procedure? procedure))
      (let ((module (current-module)))
        (lambda args
          (let* ((before (snapshot module))
                 (values-before (slot-values args))
                 (slots-before (map copy values-before)))
            (call-with-values (lambda () (apply procedure args))
              (lambda results
                (check-unchanged before)
                (check-slots values-before slots-before)
                (apply values results))))))
      procedure))
