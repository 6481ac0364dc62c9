;;; Stones and cubes pour out of a hopper and heap up below it.  In the end they lie still, on a
;;; heap with a slope of its own.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Hopper" #:accuracy 1e-4 #:duration 8)

(define-scene-parameter bodies 120 "number of bodies")
(define random-state (scene-random-state))

(set-contact-parameters! #t #t #:restitution 0.2 #:friction 0.4)
(set-contact-parameters! 'plate #t #:friction 0.1)
(add-body! #:name "floor" #:shape (half-space #(0 0 1) 0) #:fixed? #t #:color #(0.58 0.55 0.50))

;; four plates around the axis, 55 degrees steep, that leave a square hole
(define hole 0.35) (define lip-height 1.2) (define plate-length 2.0) (define steep 0.96)
(for-each
 (lambda (quarter)
   (let ((turned (q* (rotation #(0 0 1) (* quarter (acos 0))) (rotation #(0 1 0) (- steep)))))
     (add-body! #:name (format #f "plate-~a" quarter) #:fixed? #t #:material 'plate
                #:orientation turned
                #:shape (box plate-length 3.4 0.06) #:color #(0.40 0.48 0.56)
                #:visible? (not (= quarter 3))             ; look into it
                #:position (v+ (rotate turned (vector (/ plate-length 2) 0 -0.03))
                               (rotate (rotation #(0 0 1) (* quarter (acos 0)))
                                       (vector hole 0 lip-height))))))
 (iota 4))

;; a stone that keeps within its cell, however it lies
(define cell-size 0.26)
(define (stone)
  (let ((shape (rock #:size 0.18 #:random-state random-state)))
    (if (<= (shape-radius shape) (/ cell-size 2)) shape (stone))))

;; layers of sixteen in the hopper
(for-each
 (lambda (index)
   (let ((layer (quotient index 16)) (cell (modulo index 16)))
     (add-body! #:name (format #f "grain-~a" index)
                #:shape (if (zero? (modulo index 3)) (box 0.15 0.15 0.15) (stone))
                #:position (vector (* cell-size (- (modulo cell 4) 1.5))
                                   (* cell-size (- (quotient cell 4) 1.5))
                                   (+ lip-height 0.9 (* cell-size layer))))))
 (iota bodies))

(camera #:eye #(2.1 -6 2.6) #:target #(0 0 1.75) #:fov 0.9)
