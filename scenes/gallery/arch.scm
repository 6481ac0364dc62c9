;;; A semicircular arch of dry stones stands by its own weight; a block that is thrown at its side
;;; does not bring it down.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Arch" #:duration 6)

(define-scene-parameter stones 25 "stones of the arch")
(define-scene-parameter thrown? #t "throw the block")

(define inner 2.0)                         ; m, radius
(define thickness 0.6)
(define half-width 0.5)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(set-contact-parameters! #t #t #:restitution 0 #:friction 0.7)

(define (at radius angle y) (vector (* radius (cos angle)) y (* radius (sin angle))))

;; the k-th stone from the right, with corners about the middle of its sector
(define (add-stone! k)
  (let* ((step (/ (acos -1) stones))
         (from (* k step)) (to (* (1+ k) step))
         (middle (at (+ inner (/ thickness 2)) (/ (+ from to) 2) 0))
         (corners (append-map (lambda (y)
                                (append-map (lambda (angle)
                                              (list (at inner angle y)
                                                    (at (+ inner thickness) angle y)))
                                            (list from to)))
                              (list (- half-width) half-width)))
         (grey (+ 0.5 (* 0.12 (modulo (* 7 k) 3)))))
    (add-body! #:name (format #f "stone-~a" k) #:position middle #:density 2400
               #:shape (convex (map (lambda (corner) (v- corner middle)) corners))
               #:color (vector grey (* 0.93 grey) (* 0.8 grey)))))

(for-each add-stone! (iota stones))

(when thrown?
  (add-body! #:name "block" #:shape (box 0.5 0.5 0.5) #:position #(-12 0 1.2) #:density 2400
             #:velocity #(6 0 7) #:angular-velocity #(0 2 0) #:color #(0.75 0.2 0.12)))

(camera #:eye #(-2.5 -8.5 2.2) #:target #(-0.4 0 1.2) #:fov 0.7)
