;; Lists that end badly, or never: an error wherever a list is taken.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors))

;; what once never ended ends this test
(alarm 60)

(test-begin "lists")

(define (circular . elements)
  (set-cdr! (last-pair elements) elements)
  elements)

;; 2^50 parts, if it is walked as a tree.
(define shared
  (let loop ((value '(1)) (n 50)) (if (zero? n) value (loop (cons value value) (1- n)))))

;; A list that never ends, one that ends in the number 7 and one that is endless to print are
;; refused, with a short message.
(define-syntax-rule (refuses-lists name (_ element ...) expression)
  (in-world ()
    (let* ((ball (add-body! #:name "ball" #:shape (sphere 1)))
           (try (lambda (kind list)
                  (let ((message (error-of (expression ball list))))
                    (test-assert (format #f "~a, ~a: ~s" name kind message)
                      (and (string? message)
                           (string-match "; expected" message)
                           (< (string-length message) 400)))))))
      (try "circular" (circular element ...))
      (try "circular at once" (circular (first (list element ...))))
      (try "improper" (cons* element ... 7))
      (try "shared" shared))))

(define points '(#(0 0 0) #(1 0 0) #(0 1 0) #(0 0 1)))

(refuses-lists "targets" (list (sphere 1)) (lambda (ball l) (add-callback! l list)))
(refuses-lists "a position" (list 1 2 3)
  (lambda (ball l) (add-body! #:shape (sphere 1) #:position l)))
(refuses-lists "inertia" (list #(1 0 0) #(0 1 0) #(0 0 1))
  (lambda (ball l) (add-body! #:shape #f #:mass 1 #:inertia l)))
(refuses-lists "slots" (list '(a . 1) '(b . 2))
  (lambda (ball l) (add-body! #:shape (sphere 1) #:slots l)))
(refuses-lists "points" (list #(0 0 0) #(1 0 0) #(0 1 0) #(0 0 1)) (lambda (ball l) (convex l)))
(refuses-lists "a point" (list 1 2 3) (lambda (ball l) (convex (cons l points))))
(refuses-lists "parts" (list (sphere 1)) (lambda (ball l) (union l)))
(refuses-lists "keyframes" (list '(0 #(0 0 0)) '(1 #(0 0 1))) (lambda (ball l) (keyframes l)))
(refuses-lists "a keyframe" (list 0 #(0 0 0)) (lambda (ball l) (keyframes (list l))))
(refuses-lists "an eye" (list 1 2 3) (lambda (ball l) (camera #:eye l)))
(refuses-lists "a size" (list 32 32) (lambda (ball l) (render! "x.png" #:size l)))
(refuses-lists "a policy" (list 'retroactive 1) (lambda (ball l) (scene #:policy l)))
(refuses-lists "a vector" (list 1 2 3) (lambda (ball l) (v+ l #(0 0 0))))
(refuses-lists "a quaternion" (list 1 0 0 0) (lambda (ball l) (q* l l)))
(refuses-lists "what to observe" (list 'frame) (lambda (ball l) (observe! l list)))
(refuses-lists "whom a force moves" (list 1) (lambda (ball l) (add-force! l list)))
(refuses-lists "a spring" (list 1) (lambda (ball l) (add-spring! ball l #:stiffness l)))
(refuses-lists "who collides" (list 1) (lambda (ball l) (on-collision! l l list)))
(refuses-lists "a period" (list 1) (lambda (ball l) (add-callback! ball list #:period l)))
(refuses-lists "a frame" (list 0.0 0) (lambda (ball l) (frame-views l)))

(test-message "a list is no name" "name is" (find-body (circular 1)))
(test-message "long data are cut in messages" "radius is \\(0 1 2.*\\.\\.\\.; expected"
  (sphere (iota 1000000)))
(test-message "long numbers, too" "name is an integer of [0-9]+ bits; expected a string"
  (add-body! #:name (expt 7 1000000) #:shape (sphere 1)))

(test-end "lists")
