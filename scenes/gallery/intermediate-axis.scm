;;; A wing nut spins about its intermediate axis and flips over, again and again; beside it one spins
;;; about its largest axis and does not.  No step is taken: the attitude is a closed form of time.
(use-modules (timewarp))

(scene #:title "Intermediate axis" #:duration 12 #:gravity #(0 0 0))

(define-scene-parameter tilt 1e-3 "how far the spin is off the axis, rad")

;; a handle along z and a crossbar along x; moments: x < y < z are all different
(define handle
  (union (box 0.9 0.12 0.12)
         (placed (box 0.12 0.12 0.4) #:position #(0 0 0.26))))

(add-body! #:name "flips" #:shape handle #:position #(-0.8 0 0.1)
           #:orientation (rotation #(1 0 0) tilt)
           #:angular-velocity #(0 0 5) #:color #(0.85 0.45 0.1))
(add-body! #:name "stays" #:shape handle #:position #(0.8 0 0.1)
           #:orientation (rotation #(1 0 0) tilt)
           #:angular-velocity #(0 5 0) #:color #(0.15 0.4 0.75))

(camera #:eye #(0.4 -3.4 1.3) #:target #(0 0 0.05))
(sky #:zenith #(0.10 0.16 0.30) #:horizon #(0.55 0.62 0.72))
