;;; Seven four-bar linkages in a row, whose cranks turn one behind the other: what the rockers do runs
;;; along the row as a wave.  A tree of joints has no loops: each linkage is closed by attach!.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Four-bar linkages" #:duration 12 #:accuracy 1e-4)

(define-scene-parameter linkages 7 "in the row")
(define-scene-parameter pace 3.0 "rad/s of the cranks")

(define pi (acos -1))
(define base 1.0) (define crank 0.3) (define coupler 0.9) (define rocker 0.65)  ; m, lengths of the bars

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(define (bar length width)
  (union (placed (box length width width) #:position (vector (* 0.5 length) 0 0))
         (placed (cylinder (* 0.9 width) (* 1.6 width)) #:orientation (rotation #(1 0 0) (/ pi 2)))))

;; where coupler and rocker meet as the crank stands at an angle (about y: from x towards -z)
(define (meeting angle)
  (let* ((pin (vector (* crank (cos angle)) 0 (- (* crank (sin angle)))))
         (way (v- (vector base 0 0) pin)) (d (norm way))
         (along (/ (+ (* d d) (* coupler coupler) (- (* rocker rocker))) (* 2 d)))
         (up (sqrt (- (* coupler coupler) (* along along))))
         (u (v* (/ 1 d) way)))
    (v+ pin (v+ (v* along u) (v* up (vector (- (vector-ref u 2)) 0 (vector-ref u 0)))))))

(define (angle-of v) (- (atan (vector-ref v 2) (vector-ref v 0))))

(define (add-linkage! k)
  (let* ((y (* 0.32 (- k (* 0.5 (1- linkages))))) (share (/ k (max 1 (1- linkages))))
         (angle (* 2 pi (/ k linkages)))
         (plate (add-body! #:name (format #f "plate-~a" k) #:fixed? #t #:color #(0.3 0.31 0.34)
                           #:shape (union (box 1.2 0.06 0.06)
                                          (placed (box 0.08 0.06 0.7) #:position #(-0.5 0 -0.35))
                                          (placed (box 0.08 0.06 0.7) #:position #(0.5 0 -0.35)))
                           #:position (vector 0 y 0.7)))
         (linkage
          (add-multibody! #:name (format #f "linkage-~a" k) #:base plate
                          #:position (vector (* -0.5 base) 0.08 0)
            (link 'crank #:joint (revolute #:axis #(0 1 0)) #:shape (bar crank 0.06) #:density 800
                  #:color #(0.85 0.65 0.25)
              (link 'coupler #:joint (revolute #:axis #(0 1 0) #:at (vector crank 0.05 0))
                    #:shape (bar coupler 0.04) #:density 800 #:color #(0.6 0.63 0.68)
                (link 'pin #:joint (revolute #:axis #(0 1 0) #:at (vector coupler 0.04 0))
                      #:shape (placed (cylinder 0.03 0.1) #:orientation (rotation #(1 0 0) (/ pi 2)))
                      #:density 800)))
            (link 'rocker #:joint (revolute #:axis #(0 1 0) #:at (vector base 0.05 0))
                  #:shape (union (bar rocker 0.05)
                                 (placed (box 0.35 0.2 0.03)
                                         #:position (vector (+ rocker 0.17) 0 0)))
                  #:density 400 #:color (vector (- 0.9 (* 0.6 share)) (+ 0.3 (* 0.3 share)) (+ 0.2 (* 0.6 share))))))
         (meet (meeting angle))
         (pin (vector (* crank (cos angle)) 0 (- (* crank (sin angle)))))
         (coupler-angle (angle-of (v- meet pin)))
         (rocker-angle (angle-of (v- meet (vector base 0 0)))))
    (disable-collisions! linkage linkage)
    (disable-collisions! linkage plate)
    (set! (joint-positions linkage)
          (vector angle (- coupler-angle angle) (- rocker-angle coupler-angle) rocker-angle))
    (attach! (link-body linkage 'pin) (link-body linkage 'rocker))
    (set! (joint-servo linkage 'crank) (servo #:target-velocity pace #:damping 200))
    linkage))

(for-each add-linkage! (iota linkages))

(camera #:eye #(2.3 -3.0 2.3) #:target #(0.2 0 0.95) #:fov 0.6)
