;; Vectors #(x y z) and quaternions #(w x y z).  Lists and f64vectors are accepted, too.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp vectors)
  #:use-module (timewarp errors)
  #:use-module (srfi srfi-4)
  #:use-module (ice-9 match)
  #:export (v+ v- v* dot cross norm normalize lerp q* rotate q-conjugate))

;; VALUE as a plain vector of SIZE reals.
(define (->vector value size)
  (let ((v (cond ((vector? value) value)
                 ((list? value) (list->vector value))
                 ((f64vector? value) (list->vector (f64vector->list value)))
                 (else #f))))
    (unless (and v (= (vector-length v) size)
                 (let loop ((i 0))
                   (or (= i size) (and (real? (vector-ref v i)) (loop (1+ i))))))
      (bad-value "the argument" value
                 (if (= size 3) "a vector #(x y z)" "a quaternion #(w x y z)")))
    v))

(define-syntax-rule (with-parts ((x y z) value) body ...)
  (let* ((v (->vector value 3))
         (x (vector-ref v 0)) (y (vector-ref v 1)) (z (vector-ref v 2)))
    body ...))

(define-syntax-rule (with-quaternion ((w x y z) value) body ...)
  (let* ((q (->vector value 4))
         (w (vector-ref q 0)) (x (vector-ref q 1)) (y (vector-ref q 2)) (z (vector-ref q 3)))
    body ...))

(define (add a b)
  (with-parts ((ax ay az) a)
    (with-parts ((bx by bz) b)
      (vector (+ ax bx) (+ ay by) (+ az bz)))))

(define (subtract a b)
  (with-parts ((ax ay az) a)
    (with-parts ((bx by bz) b)
      (vector (- ax bx) (- ay by) (- az bz)))))

(define (v+ first . rest)
  "Return the sum of vectors."
  (let loop ((sum (->vector first 3)) (rest rest))
    (if (null? rest) sum (loop (add sum (car rest)) (cdr rest)))))

(define (v- first . rest)
  "Return FIRST minus the other vectors; with one argument its negative."
  (if (null? rest)
      (with-parts ((x y z) first) (vector (- x) (- y) (- z)))
      (let loop ((difference (->vector first 3)) (rest rest))
        (if (null? rest) difference (loop (subtract difference (car rest)) (cdr rest))))))

(define (v* a b)
  "Return the product of a number and a vector, in either order."
  (cond ((and (real? a) (not (real? b)))
         (with-parts ((x y z) b) (vector (* a x) (* a y) (* a z))))
        ((real? b) (with-parts ((x y z) a) (vector (* x b) (* y b) (* z b))))
        (else (bad-value "the argument" a "a number and a vector; see dot and cross"))))

(define (dot a b)
  "Return the scalar product of two vectors."
  (with-parts ((ax ay az) a)
    (with-parts ((bx by bz) b)
      (+ (* ax bx) (* ay by) (* az bz)))))

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
    (with-parts ((x y z) a)
      (vector (/ x length) (/ y length) (/ z length)))))

(define (lerp a b share)
  "Return the point SHARE of the way from A to B (vectors or numbers): A at 0, B at 1."
  (if (and (real? a) (real? b))
      (+ a (* share (- b a)))
      (add a (v* share (subtract b a)))))

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
      (add (add v (v* (* 2 w) t)) (v* 2 (cross u t))))))
