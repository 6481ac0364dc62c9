;; What slots hold: only what no callback can change behind a rollback.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (srfi srfi-4) (srfi srfi-9))

;; what once never ended ends this test
(alarm 60)

(test-begin "slots")

(define circular (list 1 2))
(set-cdr! (cdr circular) circular)
;; 2^60 parts, if it is walked as a tree
(define shared
  (let loop ((value '(1)) (n 60)) (if (zero? n) value (loop (cons value value) (1- n)))))
(define (nested wrap)
  (let loop ((value '()) (n 1000000)) (if (zero? n) value (loop (wrap value) (1- n)))))
(define-record-type <thing> (make-thing part) thing? (part thing-part))

(define (refused name value)
  (in-world ()
    (test-message (format #f "~a at the start" name) "the value for slot n is (.|\n)*; expected"
      (add-body! #:shape (sphere 1) #:slots (list (cons 'n value))))
    (let ((ball (add-body! #:shape (sphere 1) #:slots '((n . 0)))))
      (test-message (format #f "~a later" name) "the value for slot n is (.|\n)*; expected"
        (set! (slot ball 'n) value))
      (test-message (format #f "~a within" name) "the value for slot n is (.|\n)*; expected"
        (set! (slot ball 'n) (list 1 (vector 2 value))))
      (test-equal (format #f "~a leaves the slot as it was" name) 0 (slot ball 'n)))))

(refused "a bytevector" (u8vector 1 2 3))
(refused "an f64vector" (f64vector 1 2 3))
(refused "an array" (make-array 0 2 2))
(refused "a hash table" (make-hash-table))
(refused "a record" (make-thing 1))
(refused "a procedure" car)
(refused "a port" (current-output-port))
(refused "a shape" (sphere 1))
(refused "a world" (current-world))
(refused "a promise" (delay 1))
(refused "a circular list" circular)
(refused "a list that shares its parts over and over" shared)
(refused "a deep list" (nested list))
(refused "a deep vector" (nested vector))
(refused "a very long vector" (make-vector 1000001 0))

(in-world ()
  (let* ((ball (add-body! #:shape (sphere 1) #:slots '((n . 0))))
         (values (list 1 1/2 2.5 +i (expt 10 100) #t #f 'a #:a #\a "text" '() *unspecified* ball
                       '(1 . 2) '(1 (2 "x") #(3 (4))) #() (make-string 3 #\x) (iota 1000))))
    (test-equal "what may stand in a slot" values
      (map (lambda (value) (set! (slot ball 'n) value) (slot ball 'n)) values))
    (test-message "a view in a slot" "the value for slot n is #<view [^>]*>; expected"
      (begin
        (add-callback! ball (lambda (time view) (set! (slot view 'n) view) #f))
        (run! #:until 1)))))

;; ---- what is read from a slot is not changed in place ----

(in-world ()
  (let ((ball (add-body! #:shape (sphere 1) #:slots (list (cons 'v (vector 1 (string #\a)))))))
    (test-eq "a vector is read-only" 'wrong-type-arg (error-of (vector-set! (slot ball 'v) 0 2)))
    (test-eq "a string is read-only" 'misc-error
      (error-of (string-set! (vector-ref (slot ball 'v) 1) 0 #\b)))
    (test-equal "both are as they were" #(1 "a") (slot ball 'v))
    (test-assert "a copy is not" (vector-set! (vector-copy (slot ball 'v)) 0 2))))

(define (change-pair! time view) (set-car! (slot view 'list) time) #f)
(define (set-pair! time view) (set! (slot view 'list) (list time)) #f)

(define (run-changing change overrides)
  (set-overrides! overrides)
  (let ((message (parameterize ((current-world (make-world)))
                   (let ((ball (add-body! #:shape (sphere 1) #:slots '((list 1 2)))))
                     (add-callback! ball change)
                     (error-of (run! #:until 1))))))
    (set-overrides! '())
    message))

(test-assert "--check finds a pair changed in place"
  (string-match "changed a pair in a slot in place" (run-changing change-pair! '((check . #t)))))
(test-equal "and lets a slot be set" #f (run-changing set-pair! '((check . #t))))

;; ---- --check in a scene with endless data ----

(define scene-data circular)
(test-equal "--check copes with circular data" #f (run-changing set-pair! '((check . #t))))

(test-end "slots")
