;;; A pendulum of two links on a trolley that stops at once, and a rod on a turning and trembling
;;; post: both strike what stands about.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Moving bases" #:duration 4 #:accuracy 1e-4)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

(define trolley
  (add-body! #:name "trolley" #:shape (box 0.3 0.2 0.1)
             #:motion (keyframes '((0 #(-1 0 1.6)) (0.9 #(0.3 0 1.6)) (1.3 #(0.3 0 1.6))
                                   (2 #(-0.6 0.2 1.6)) (3 #(0.4 0 1.6))))))
(define rod (placed (cylinder 0.04 0.5) #:position #(0 0 -0.3)))
(add-multibody! #:name 'rope #:base trolley #:position #(0 0 -0.05)
  (link 'upper #:joint (spherical) #:shape rod #:density 900
    (link 'lower #:joint (spherical #:at #(0 0 -0.6)) #:density 900
          #:shape (union rod (placed (sphere 0.12) #:position #(0 0 -0.7))))))

(define post
  (add-body! #:name "post" #:shape (cylinder 0.1 0.4) #:max-speed 5
             #:motion (lambda (t)
                        (values (vector 1.6 0 (+ 0.4 (* 0.02 (abs (sin (* 9 t))))))
                                (rotation #(0 0 1) (* 2 t))))))
(define club
  (add-multibody! #:name 'club #:base post #:position #(0 0 0.1)
    (link 'club #:joint (revolute #:axis #(0 1 0) #:at #(0.15 0 0) #:limits '(-1 0.9) #:friction 0.1)
          #:shape (placed (box 0.6 0.06 0.06) #:position #(0.3 0 0)) #:density 700)))

(for-each (lambda (k)
            (add-body! #:name (format #f "box-~a" k) #:shape (box 0.14 0.14 0.14) #:density 300
                       #:position (vector (+ 0.75 (* 0.02 k)) 0 (+ 0.07 (* 0.14 k)))))
          (iota 4))
