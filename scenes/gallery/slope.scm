;;; On one slope a box sticks, a box slides, a ball rolls and a ball without friction slides; tan 20
;;; degrees is 0.36.  The box that sticks does not creep, and the ball that rolls (5/7 of the
;;; acceleration) falls behind the one that slides.
(use-modules (timewarp) (timewarp vectors) (ice-9 match))

(scene #:title "Slope" #:duration 3.5)

(define-scene-parameter degrees 20 "inclination of the slope")

(define tilt (rotation #(0 1 0) (* degrees (/ (acos -1) 180))))   ; downhill is +x
(define (on-slope along across above)
  (rotate tilt (vector along across above)))

(add-body! #:name "slope" #:shape (box 24 6 0.5) #:fixed? #t #:orientation tilt
           #:position (on-slope 6 0 -0.25) #:color #(0.55 0.57 0.60))

(set-contact-parameters! #t #t #:restitution 0)
(define bodies
  (list (list "sticks"  (box 0.5 0.5 0.5)  0.5 #(0.25 0.45 0.75))
        (list "slides"  (box 0.5 0.5 0.5)  0.2 #(0.85 0.55 0.15))
        (list "rolls"   (sphere 0.25)      0.5 #(0.75 0.25 0.20))
        (list "glides"  (sphere 0.25)      0   #(0.85 0.85 0.80))))

(let loop ((left bodies) (across -1.8))
  (match left
    (() #t)
    (((name shape friction color) . rest)
     (let ((body (add-body! #:name name #:shape shape #:orientation tilt #:color color
                            #:position (on-slope -4 across 0.25))))
       (set-contact-parameters! body #t #:friction friction)
       (loop rest (+ across 1.2))))))

(camera #:eye #(3 -13 6) #:target #(2 0 -1.2) #:fov 0.75)
