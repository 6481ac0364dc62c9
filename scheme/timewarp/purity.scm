;; --check: callbacks are watched for changing variables of the scene, which no rollback undoes.
;;
;; The data in the scene's variables is copied before a call and compared after it, with what records,
;; objects and procedures hold (counters in closures); so are the variables that the callback itself
;; has kept, the slots of what it is handed, whose pairs could be changed in place, and random states:
;; Guile's own, and what variables hold.  What comes after the first thousands of parts of a value,
;; which may be circular, is not seen.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp purity)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (ice-9 match)
  #:use-module (oop goops)
  #:use-module ((srfi srfi-1) #:select (any))
  #:use-module (system vm program)
  #:export (watched))

;; of one value that are watched
(define most-parts 10000)

;; A copy of VALUE that later changes don't reach; what is no plain data stands for itself.
(define (copy value)
  (define left most-parts)
  ;; procedures that call themselves hold themselves
  (define seen '())
  (define (seen? value)
    (or (memq value seen)
        (begin
          (set! seen (cons value seen))
          #f)))
  (let copy ((value value))
    (set! left (1- left))
    (cond ((negative? left) 'unwatched)
          ((random-state? value) (random-state->datum value))
          ((fluid? value) (copy (fluid-ref value)))
          ((parameter? value) (copy (value)))
          ((variable? value) (if (variable-bound? value) (copy (variable-ref value)) value))
          ((program? value)
           (if (seen? value) value (cons value (map-in-order copy (kept-variables value)))))
          ((module? value) value)
          ((record? value)
           (map-in-order (lambda (field) (copy ((record-accessor (record-type-descriptor value)
                                                                 field)
                                                value)))
                         (record-type-fields (record-type-descriptor value))))
          ((plain-object? value)
           (if (seen? value)
               value
               (map-in-order (lambda (slot)
                               (let ((name (slot-definition-name slot)))
                                 (and (slot-bound? value name) (copy (slot-ref value name)))))
                             (class-slots (class-of value)))))
          ((pair? value) (let ((first (copy (car value)))) (cons first (copy (cdr value)))))
          ((vector? value) (map-in-order copy (vector->list value)))
          ((string? value) (string-copy value))
          ((hash-table? value) (map-in-order copy (hash-map->list cons value)))
          ((array? value) (array-copy* value))
          (else value))))

;; What a closure has of the variables around it.  The interpreter's have its own notes, too, which
;; it adds to as it goes; what a scene defines is compiled.
(define (kept-variables procedure)
  (let ((kept (program-free-variables procedure)))
    (cond ((interpreted? procedure) '())
          ((vector? kept) (vector->list kept))
          (else kept))))

;; Looking where code comes from takes a millisecond; code never moves.
(define interpreted-by-address (make-hash-table))

(define (interpreted? procedure)
  (let* ((address (program-code procedure))
         (known (hashv-get-handle interpreted-by-address address)))
    (if known
        (cdr known)
        (let ((found (match (program-source procedure 0)
                       ((_ "ice-9/eval.scm" . _) #t)
                       (_ #f))))
          (hashv-set! interpreted-by-address address found)
          found))))

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

;; What the callback PROCEDURE has kept to itself.
(define (check-kept procedure before)
  (unless (equal? before (copy procedure))
    (raise-error
     (string-append
      "a callback changed a variable of its own that lasts from call to call, which a rollback would "
      "not undo; expected it to change only what it is handed (a slot holds what must be kept)"))))

;; an object in Scheme's own memory, and no class itself
(define (plain-object? value)
  (and (struct? value)
       (is-a? value <object>)
       (eq? (class-of (class-of value)) <class>)
       (not (any (lambda (slot) (is-a? slot <foreign-slot>)) (class-slots (class-of value))))))

;; smobs, which have no predicate
(define random-state-class (class-of *random-state*))
(define (random-state? value) (eq? (class-of value) random-state-class))

(define (random-state) (random-state->datum *random-state*))

(define (check-random before)
  (unless (equal? before (random-state))
    (raise-error
     (string-append
      "a callback drew from Guile's random state, which a rollback would not turn back; expected "
      "(random-real! view), whose state is part of the body"))))

(define (check-slots values before)
  (unless (equal? before (map copy values))
    (raise-error
     (string-append
      "a callback changed a pair in a slot in place, which a rollback would not undo; expected it "
      "to give the slot a new value by set!"))))

(define* (watched procedure #:key (slots? #t))
  "Return PROCEDURE, under --check one that raises an error where it changes variables of the scene;
SLOTS?: the views that it is handed have slots."
  (if (and (override 'check) (procedure? procedure))
      (let ((module (current-module)))
        (lambda args
          (let* ((before (snapshot module))
                 (kept (copy procedure))
                 (random (random-state))
                 (values-before (if slots? (slot-values args) '()))
                 (slots-before (map copy values-before)))
            (call-with-values (lambda () (apply procedure args))
              (lambda results
                (check-unchanged before)
                (check-kept procedure kept)
                (check-random random)
                (check-slots values-before slots-before)
                (apply values results))))))
      procedure))
