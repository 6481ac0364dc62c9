;; Vectors #(x y z), or of any length for sums, scalar products and what follows from them, and
;; quaternions #(w x y z).  Lists and f64vectors are accepted, too.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp vectors)
  #:use-module (timewarp errors)
  #:use-module (srfi srfi-4)
  #:use-module (ice-9 match)
  #:export (v+ v- v* dot cross norm normalize lerp q* rotate q-conjugate))

;; VALUE as a plain vector of SIZE reals.
(define* (->vector value size #:optional
                   (expected (if (= size 3) "a vector #(x y z)" "a quaternion #(w x y z)")))
  (let ((v (cond ((vector? value) value)
                 ((list? value) (list->vector value))
                 ((f64vector? value) (list->vector (f64vector->list value)))
                 (else #f))))
    (unless (and v (= (vector-length v) size)
                 (let loop ((i 0))
                   (or (= i size) (and (real? (vector-ref v i)) (loop (1+ i))))))
      (bad-value "the argument" value expected))
    v))

(define-syntax-rule (with-parts ((x y z) value) body ...)
  (let* ((v (->vector value 3))
         (x (vector-ref v 0)) (y (vector-ref v 1)) (z (vector-ref v 2)))
    body ...))

(define-syntax-rule (with-quaternion ((w x y z) value) body ...)
  (let* ((q (->vector value 4))
         (w (vector-ref q 0)) (x (vector-ref q 1)) (y (vector-ref q 2)) (z (vector-ref q 3)))
    body ...))

(define (reals value)
  "Return VALUE as a plain vector of reals, of whatever length."
  (->vector value
            (cond ((vector? value) (vector-length value))
                  ((list? value) (length value))
                  ((f64vector? value) (f64vector-length value))
                  (else 3))
            "a vector of numbers"))

;; Three numbers are what scenes add up: these need no loop.
(define-syntax-rule (triple? v)
  (and (vector? v) (= (vector-length v) 3)
       (real? (vector-ref v 0)) (real? (vector-ref v 1)) (real? (vector-ref v 2))))

;; PROCEDURE, an operator's name, of the numbers of two vectors, one pair after the other.
(define-syntax-rule (map-pairs procedure a b)
  (let ((x a) (y b))
    (if (and (triple? x) (triple? y))
        (vector (procedure (vector-ref x 0) (vector-ref y 0))
                (procedure (vector-ref x 1) (vector-ref y 1))
                (procedure (vector-ref x 2) (vector-ref y 2)))
        (map-long procedure x y))))

(define (map-long procedure a b)
  (let* ((a (reals a)) (b (reals b)) (size (vector-length a)) (result (make-vector size)))
    (unless (= size (vector-length b))
      (bad-value "the argument" b (format #f "a vector of ~a numbers, as the other" size)))
    (do ((i 0 (1+ i))) ((= i size) result)
      (vector-set! result i (procedure (vector-ref a i) (vector-ref b i))))))

(define-syntax-rule (map-one procedure a)
  (let ((x a))
    (if (triple? x)
        (vector (procedure (vector-ref x 0)) (procedure (vector-ref x 1))
                (procedure (vector-ref x 2)))
        (map-long (lambda (each _) (procedure each)) x x))))

(define (scaled vector factor)
  (map-one (lambda (x) (* factor x)) vector))

(define (v+ first . rest)
  "Return the sum of vectors of one length."
  (if (null? rest)
      (reals first)
      (let loop ((sum first) (rest rest))
        (if (null? rest) sum (loop (map-pairs + sum (car rest)) (cdr rest))))))

(define (v- first . rest)
  "Return FIRST minus the other vectors, all of one length; with one argument its negative."
  (if (null? rest)
      (map-one - first)
      (let loop ((difference first) (rest rest))
        (if (null? rest) difference (loop (map-pairs - difference (car rest)) (cdr rest))))))

(define (v* a b)
  "Return the product of a number and a vector, in either order."
  (cond ((and (real? a) (not (real? b))) (scaled b a))
        ((real? b) (scaled a b))
        (else (bad-value "the argument" a "a number and a vector; see dot and cross"))))

(define (dot a b)
  "Return the scalar product of two vectors of one length."
  (if (and (triple? a) (triple? b))
      (+ (* (vector-ref a 0) (vector-ref b 0)) (* (vector-ref a 1) (vector-ref b 1))
         (* (vector-ref a 2) (vector-ref b 2)))
      (let ((products (map-long * a b)))
        (let loop ((i 0) (sum 0))
          (if (= i (vector-length products)) sum (loop (1+ i) (+ sum (vector-ref products i))))))))

(define (cross a b)
  "Return the vector product of two vectors."
  (with-parts ((ax ay az) a)
    (with-parts ((bx by bz) b)
      (vector (- (* ay bz) (* az by)) (- (* az bx) (* ax bz)) (- (* ax by) (* ay bx))))))

(define (norm a)
  "Return the length of a vector."
  (sqrt (dot a a)))

(define (normalize a)
  "Return the unit vector along A; zero is an error."
  (let ((length (norm a)))
    (when (zero? length) (bad-value "the vector" a "one that is not zero"))
    (map-one (lambda (x) (/ x length)) a)))

(define (lerp a b share)
  "Return the point SHARE of the way from A to B (vectors or numbers): A at 0, B at 1."
  (if (and (real? a) (real? b))
      (+ a (* share (- b a)))
      (v+ a (v* share (v- b a)))))

(define (q* . quaternions)
  "Return the product of quaternions: the rotation that applies the last one first."
  (define (product p q)
    (with-quaternion ((a b c d) p)
      (with-quaternion ((w x y z) q)
        (vector (- (* a w) (* b x) (* c y) (* d z))
                (+ (* a x) (* b w) (* c z) (- (* d y)))
                (+ (* a y) (- (* b z)) (* c w) (* d x))
                (+ (* a z) (* b y) (- (* c x)) (* d w))))))
  (match quaternions
    (() (vector 1 0 0 0))
    ((first . rest)
     (let loop ((p (->vector first 4)) (rest rest))
       (if (null? rest) p (loop (product p (car rest)) (cdr rest)))))))

(define (q-conjugate q)
  "Return the conjugate of a quaternion: the inverse rotation."
  (with-quaternion ((w x y z) q) (vector w (- x) (- y) (- z))))

(define (rotate q v)
  "Return the vector V rotated by the unit quaternion Q."
  ;; v + 2 w (u x v) + 2 u x (u x v), u the vector part
  (with-quaternion ((w x y z) q)
    (let* ((u (vector x y z))
           (t (cross u v)))
      (v+ v (v* (* 2 w) t) (v* 2 (cross u t))))))
