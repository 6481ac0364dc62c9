;;; Boxes with instruments hop: each feels by accelerometer, gyro and contact force when it stands, looks
;;; down, and thrusts; balls, two of them on a spring, one held at another, and an arm are among them.  What sensors read must roll back with the rest.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Hopping boxes" #:duration 3 #:accuracy 1e-4)

(set-contact-parameters! #t #t #:rolling-friction 0.004 #:spinning-friction 0.002)
(define ground (add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t))
(define boxes
  (map (lambda (k)
         (add-body! #:name (format #f "box-~a" k) #:shape (box 0.3 0.3 0.2) #:density 300
                    #:position (vector (* 0.32 (modulo k 3)) (* 0.05 k) (+ 0.15 (* 0.25 k)))
                    #:angular-velocity (vector 0 (* 0.3 k) 0.2)
                    #:slots '((felt . #(0 0 0)) (pressed . 0) (points . 0) (above . 0) (since . 0))))
       (iota 5)))
(define arm
  (add-multibody! #:name "arm" #:position #(-0.8 0.2 0.6)
    (link "rod" #:joint (revolute #:axis #(0 1 0)) #:density 500
          #:shape (placed (box 0.8 0.1 0.1) #:position #(0.4 0 0))
          #:slots '((felt . #(0 0 0)) (pressed . 0)))))
(define balls
  (map (lambda (k)
         (add-body! #:name (format #f "ball-~a" k) #:shape (sphere 0.08) #:density 500
                    #:position (vector (- (* 0.25 k) 0.6) (* 0.02 k) (+ 1.6 (* 0.3 k)))
                    #:slots '((pulled . #(0 0 0)))))
       (iota 4)))
(add-spring! (first balls) (second balls) #:stiffness 60 #:damping 0.2)
(attach! (third balls) (fourth balls) #:stiffness 2000)

;; Stands for a while: thrusts until it looks down from 0.4 m.
(define (control time view ground)
  (let* ((felt (accelerometer view #:at #(0.15 0.1 0)))
         (force (net-contact-force view))
         (height (rangefinder view #(0 0 -1) #:bodies (list ground)))
         (stands? (< 0.5 (/ (vector-ref force 2) (* 9.81 (body-mass view))) 3))
         (since (if stands? (+ (slot view 'since) 0.02) 0)))
    (set! (slot view 'felt) (v+ felt (gyro view)))
    (set! (slot view 'pressed) (norm force))
    (set! (slot view 'points)
          (fold (lambda (contact sum) (+ sum (contact-force contact) (contact-gap contact)))
                (norm (fold v+ #(0 0 0) (map contact-torque (contacts #:body view))))
                (contacts #:body view)))
    (set! (slot view 'above) (or height -1))
    (set! (slot view 'since) since)
    (set! (applied-force view)
          (if (and (> since 0.15) (or (not height) (< height 0.4)))
              (vector 0 0 (* 25 (body-mass view)))
              #(0 0 0)))))
(for-each (lambda (body) (add-callback! (list body ground) control #:period 0.02)) boxes)

(add-callback! (link-body arm "rod")
  (lambda (time rod)
    (set! (slot rod 'felt) (accelerometer rod #:at #(0.8 0 0)))
    (set! (slot rod 'pressed) (norm (v+ (net-contact-force rod) (joint-force rod "rod"))))
    (set! (joint-torque rod "rod")
          (- (* -40 (+ 0.3 (joint-position rod "rod"))) (* 0.2 (vector-ref (slot rod 'felt) 0))
             (* 1e-3 (vector-ref (joint-moment rod "rod") 0)))))
  #:period 0.01)

;; pulls itself along by a hundredth of what the spring or the hold pulls
(define (follow sense)
  (lambda (time ball other)
    (set! (slot ball 'pulled) (sense ball other))
    (set! (applied-force ball) (v* 0.01 (slot ball 'pulled)))))
(add-callback! (list (first balls) (second balls)) (follow spring-force) #:period 0.015)
(add-callback! (list (third balls) (fourth balls))
  (follow (lambda (a b) (v+ (hold-force a b) (hold-torque b a))))
  #:period 0.015)

;; what a box felt before it was struck
(on-collision! #t #t
  (lambda (collision a b)
    (when (slot? a 'pressed)
      (set! (slot a 'pressed) (+ (norm (accelerometer a)) (norm (net-contact-force a)))))))
