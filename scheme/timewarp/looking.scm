;; What is seen: camera, light and sky of the current world.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp looking)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (timewarp drawing)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-4)
  #:export (camera light sky))

(define (elements-of value)
  (cond ((vector? value) (vector->list value))
        ((list? value) value)
        ((f64vector? value) (f64vector->list value))
        (else '())))

(define (check-vector name value)
  (let ((elements (elements-of value)))
    (unless (and (= (length elements) 3)
                 (and-map (lambda (x) (and (real? x) (not (nan? x)) (not (inf? x)))) elements))
      (bad-value name value "a vector #(x y z) of finite numbers"))))

;; VALUE may be absent, but points somewhere.
(define (check-direction name value)
  (when value
    (check-vector name value)
    (when (and-map zero? (elements-of value)) (bad-value name value "a vector that is not zero"))))

;; Keeps the settings that are given (alist of names and values) and the vectors among them right.
(define (keep! key vectors others)
  (%require-outside-callbacks (symbol->string key))
  (for-each (match-lambda ((name . value)
                           (when value (check-vector (symbol->string name) value))))
            vectors)
  (world-set! (current-world) key
              (keep-if cdr (append vectors others)))
  (show-new-looks! (current-world))
  (if #f #f))

(define (keep-if keep? alist)
  (let loop ((alist alist))
    (cond ((null? alist) '())
          ((keep? (car alist)) (cons (car alist) (loop (cdr alist))))
          (else (loop (cdr alist))))))

(define-keyword-procedure (camera #:key eye target up fov follow turn)
  "Place the camera of the current world, between runs also for the frames to come.  A call says all:
what it leaves out is as at the start.

#:eye     m, the point from which it looks; chosen so that the scene is in view
#:target  m, the point at which it looks; chosen likewise
#:up      the direction that is up in the picture; #(0 0 1)
#:fov     rad, the vertical angle of view, between 0 and pi; 0.7
#:follow  a body with which eye and target move, by its displacement from where it is now; none
#:turn    rad/s, the rate at which the eye goes round the target about the direction up,
          counter-clockwise as seen from above, from where it is at time 0; 0"
  (when fov
    (unless (and (real? fov) (< 0 fov 3.1415))
      (bad-value "fov" fov "an angle in radians between 0 and pi")))
  (when turn
    (unless (and (real? turn) (not (nan? turn)) (not (inf? turn)))
      (bad-value "turn" turn "a rate in radians per second")))
  (check-direction "up" up)
  (let ((follow-from (and follow (%followed-from (current-world) follow))))
    (keep! 'camera
           `((eye . ,eye) (target . ,target) (up . ,up))
           `((fov . ,fov) (follow . ,follow) (follow-from . ,follow-from) (turn . ,turn)))))

(define-keyword-procedure (light #:key direction color)
  "Set the light of the current world.  A call says all: what it leaves out is as at the start.

#:direction  in which the light shines, of any length; #(-0.75 0.35 -1)
#:color      #(r g b), sRGB, 0 to 1; #(1 0.97 0.91)"
  (check-direction "direction" direction)
  (keep! 'light `((direction . ,direction) (color . ,color)) '()))

(define-keyword-procedure (sky #:key zenith horizon ground fog grain)
  "Set the sky of the current world.  A call says all: what it leaves out is as at the start.
Colours are #(r g b), sRGB, 0 to 1.

#:zenith   colour of the sky above; #(0.33 0.53 0.8)
#:horizon  colour of the sky at the horizon, and of the fog; #(0.8 0.86 0.92)
#:ground   colour below the horizon where there is no body; #(0.48 0.51 0.55)
#:fog      1/m, the share of the light that is lost in a metre, 0 to 1; 0.04 over the distance of
           the camera from its target
#:grain    how rough ground and rocks look: height fields, and fixed bodies that are convex hulls or
           have some among their parts; 0 to 1, not at quality 'draft; 1 where there are a hundred
           such parts, else 0"
  (when fog
    (unless (and (real? fog) (<= 0 fog) (< fog 1)) (bad-value "fog" fog "a share per metre, 0..1")))
  (when grain
    (unless (and (real? grain) (<= 0 grain 1)) (bad-value "grain" grain "a number from 0 to 1")))
  (keep! 'sky
         `((zenith . ,zenith) (horizon . ,horizon) (ground . ,ground))
         `((fog . ,fog) (grain . ,grain))))
