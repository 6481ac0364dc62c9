;;; Double pendulums that begin a thousandth of a degree apart: for some seconds they are one, then
;;; each goes its own way.
(use-modules (timewarp) (srfi srfi-1))

(scene #:title "Double pendulums" #:duration 20 #:accuracy 1e-8)

(define-scene-parameter pendulums 12 "how many")
(define-scene-parameter apart 0.001 "degrees between their starts")

(define upper 0.7)                         ; m
(define lower 0.6)
(define spacing 0.12)
(define degree (/ (acos -1) 180))

(define (rod length)
  (placed (box 0.05 0.025 (+ length 0.05)) #:position (vector 0 0 (/ length -2))))

(define (add-pendulum! k)
  (let* ((share (/ k (max 1 (1- pendulums))))
         (color (vector (+ 0.2 (* 0.75 share)) (- 0.55 (* 0.3 share)) (- 0.9 (* 0.8 share))))
         (pendulum
          (add-multibody! #:name (format #f "pendulum-~a" k)
                          #:position (vector 0 (* spacing k) 1.6)
            (link 'upper #:joint (revolute #:axis #(0 1 0)) #:shape (rod upper) #:color color
              (link 'lower #:joint (revolute #:axis #(0 1 0) #:at (vector 0 0.03 (- upper)))
                    #:shape (rod lower) #:color color)))))
    (set! (joint-position pendulum 'upper) (* degree (+ 130 (* apart k))))
    (set! (joint-position pendulum 'lower) (* degree -40))))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(add-body! #:name "axle" #:shape (placed (cylinder 0.02 (* spacing (1+ pendulums)))
                                         #:orientation (rotation #(1 0 0) (/ (acos -1) 2)))
           #:fixed? #t #:position (vector 0 (* spacing (/ (1- pendulums) 2)) 1.6)
           #:color #(0.3 0.3 0.32))
(disable-collisions! #t #t)

(for-each add-pendulum! (iota pendulums))

(camera #:eye #(2.4 -2.6 2.0) #:target #(0 0.6 1.3) #:fov 0.72)
