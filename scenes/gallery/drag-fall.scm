;;; Four balls of one light stuff fall through air that resists with the square of the speed: the larger, the
;;; faster; each stays level with the ring that goes down its lane by the closed form, at last at terminal speed.
;;;
;;; With k = half the density of the air times drag coefficient and cross-section, the terminal speed is
;;; u = sqrt(m g/k), proportional to the square root of the radius, and after t the ball has fallen
;;; (u^2/g) log cosh(g t/u).
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Drag-limited fall" #:duration 5)

(define-scene-parameter density 1 "kg/m^3 of the balls; what the air carries is not taken off")
(define-scene-parameter air 1.2 "kg/m^3 of the air")

(define gravity 9.81)
(define drag-coefficient 0.47)   ; of a ball
(define height 42)
(define pi (acos -1))

(define (resistance radius) (* 1/2 air drag-coefficient pi radius radius))
(define (terminal-speed radius)
  (sqrt (/ (* density 4/3 pi radius radius radius gravity) (resistance radius))))
(define (fallen radius time)
  (let ((u (terminal-speed radius)))
    (* (/ (* u u) gravity) (log (cosh (/ (* gravity time) u))))))

;; twelve rods about the lane of a ball
(define (ring radius)
  (let ((wide (* 1.5 radius)) (thick (* 0.2 radius)))
    (apply union
           (map (lambda (k)
                  (let ((angle (* k (/ pi 6))))
                    (placed (box thick (* 0.5 wide) thick)
                            #:position (vector (* wide (cos angle)) (* wide (sin angle)) 0)
                            #:orientation (rotation #(0 0 1) angle))))
                (iota 12)))))

(for-each
 (lambda (radius across color)
   (let ((ball (add-body! #:name (format #f "ball ~a" radius) #:shape (sphere radius)
                          #:density density #:position (vector across 0 height) #:color color))
         (ring (add-body! #:name (format #f "ring ~a" radius) #:shape (ring radius)
                          #:color #(0.9 0.85 0.3)
                          #:motion (lambda (time)
                                     (values (vector across 0 (- height (fallen radius time)))
                                             #(1 0 0 0)))
                          #:max-speed (* 1.01 (terminal-speed radius)))))
     (add-drag! ball #:quadratic (resistance radius))))
 '(0.25 0.5 1 2)
 '(-6 -3.5 0 6)
 '(#(0.75 0.25 0.20) #(0.85 0.55 0.15) #(0.25 0.45 0.75) #(0.35 0.6 0.3)))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(camera #:eye #(4 -50 24) #:target #(1 0 21) #:fov 0.9)
