;; What is seen: camera, light and sky of the current world.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp looking)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-4)
  #:export (camera light sky))

(define (check-vector name value)
  (let ((elements (cond ((vector? value) (vector->list value))
                        ((list? value) value)
                        ((f64vector? value) (f64vector->list value))
                        (else '()))))
    (unless (and (= (length elements) 3)
                 (and-map (lambda (x) (and (real? x) (not (nan? x)) (not (inf? x)))) elements))
      (bad-value name value "a vector #(x y z) of finite numbers"))))

;; Keeps the settings that are given (alist of names and values) and the vectors among them right.
(define (keep! key vectors others)
  (%require-outside-callbacks (symbol->string key))
  (for-each (match-lambda ((name . value)
                           (when value (check-vector (symbol->string name) value))))
            vectors)
  (world-set! (current-world) key
              (keep-if cdr (append vectors others)))
  (if #f #f))

(define (keep-if keep? alist)
  (let loop ((alist alist))
    (cond ((null? alist) '())
          ((keep? (car alist)) (cons (car alist) (loop (cdr alist))))
          (else (loop (cdr alist))))))

(define-keyword-procedure (camera #:key eye target up fov follow)
  "Place the camera: eye and target (points), up (a direction), fov (vertical, radians), and a body
to follow, with which eye and target move.  What is not given is chosen so that the scene is in view."
  (when fov
    (unless (and (real? fov) (< 0 fov 3.1415))
      (bad-value "fov" fov "an angle in radians between 0 and pi")))
  (when follow (%check-followed (current-world) follow))
  (keep! 'camera `((eye . ,eye) (target . ,target) (up . ,up)) `((fov . ,fov) (follow . ,follow))))

(define-keyword-procedure (light #:key direction color)
  "Set the light: the direction in which it shines, and its colour #(r g b), sRGB 0..1."
  (keep! 'light `((direction . ,direction) (color . ,color)) '()))

(define-keyword-procedure (sky #:key zenith horizon ground fog)
  "Set the colours #(r g b), sRGB 0..1, of the sky at the zenith, at the horizon and of the ground below
it, and the fog: the share of the light that is lost per metre."
  (when fog
    (unless (and (real? fog) (<= 0 fog) (< fog 1)) (bad-value "fog" fog "a share per metre, 0..1")))
  (keep! 'sky `((zenith . ,zenith) (horizon . ,horizon) (ground . ,ground)) `((fog . ,fog))))
