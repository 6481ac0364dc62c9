;;; Writes the bodies of a scene at its start as plain text, for other engines (other-engines.h reads it):
;;;
;;;   timewarp --until=0 dump-bodies.scm -D scene-file=FILE.scm -D output=FILE [-D NAME=VALUE ...]
;;;
;;; `gravity gx gy gz', `contact restitution friction' (of the first two bodies), then one line a body:
;;;   body FIXED mass Ixx Iyy Izz Ixy Ixz Iyz  px py pz  qw qx qy qz  vx vy vz  wx wy wz  N  x1 y1 z1 ...
;;; SI; inertia about the centre of mass in body axes; corners of the hull in the body frame, whose
;;; origin is the centre of mass where the body moves.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (timewarp primitives) (timewarp vectors) (srfi srfi-1) (ice-9 match))

(define-scene-parameter scene-file "avalanche.scm" "the scene to load")
(define-scene-parameter output "scene.bodies" "the file to write")

;; ---- corners of shapes and shapes of bodies, noted as the scene makes them ----

(define corners-of (make-weak-key-hash-table))
(define shape-of (make-hash-table))

;; Lets the primitive NAME also pass its result and its arguments to NOTE.
(define (listen! name note)
  (let* ((module (resolve-module '(timewarp primitives)))
         (primitive (module-ref module name)))
    (module-set! module name
                 (lambda args
                   (let ((result (apply primitive args)))
                     (apply note result args)
                     result)))))

(listen! '%convex
         (lambda (shape points)
           (hashq-set! corners-of shape (if (vector? points) (vector->list points) points))))
(listen! '%box
         (lambda (shape . edges)
           (define (both edge) (list (* -1/2 edge) (* 1/2 edge)))
           (match (map both edges)
             ((xs ys zs)
              (hashq-set! corners-of shape
                          (append-map (lambda (x)
                                        (append-map (lambda (y) (map (lambda (z) (vector x y z)) zs))
                                                    ys))
                                      xs))))))
(listen! '%add-body!
         (lambda (body world properties place)
           (hashq-set! shape-of body (assq-ref properties 'shape))))

(define gravity #(0 0 -9.81))
(listen! '%set-world!
         (lambda (result world name value)
           (when (eq? name 'gravity) (set! gravity value))))

;; ---- writing ----

(define (show . values)
  (for-each (lambda (value)
              (if (vector? value)
                  (apply show (vector->list value))
                  (format #t " ~a" (if (integer? value) (inexact->exact value) (exact->inexact value)))))
            values))

(define (upper-triangle rows scale)
  (define (at i j) (* scale (vector-ref (vector-ref rows i) j)))
  (list (at 0 0) (at 1 1) (at 2 2) (at 0 1) (at 0 2) (at 1 2)))

(define (show-body body)
  (let* ((shape (hashq-ref shape-of body))
         (corners (or (hashq-ref corners-of shape)
                      (error "only boxes and hulls can be written, not" body shape)))
         (fixed? (eq? (body-kind body) 'fixed))
         (mass (if fixed? 0 (body-mass body))))
    (unless (or fixed? (< (norm (shape-centroid shape)) 1e-12))
      (error "the centre of mass is not at the origin of" body))
    (display "body")
    (show (if fixed? 1 0) mass)
    (apply show (upper-triangle (shape-inertia shape) (/ mass (shape-volume shape))))
    (show (position body) (orientation body))
    (if fixed? (show 0 0 0 0 0 0) (show (velocity body) (angular-velocity body)))
    (show (length corners))
    (apply show corners)
    (newline)))

(load "load-apart.scm")
(load-apart scene-file)
(with-output-to-file output
  (lambda ()
    (display "gravity") (show gravity) (newline)
    (match (contact-parameters (first (world-bodies)) (last (world-bodies)))
      ((restitution friction . _) (display "contact") (show restitution friction) (newline)))
    (for-each show-body (world-bodies))))
