;;; A toy that walks: four cranks, each with two legs in antiphase that slide through swivels.  Every
;;; leg closes a loop with its crank and its swivel; attach! holds it in the collar it slides in.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Walking toy" #:duration 12 #:accuracy 1e-4)

(define-scene-parameter pace 4.5 "rad/s of the cranks")

(define pi (acos -1))
(define crank 0.06)                        ; m, its radius
(define drop 0.16)                         ; m, from a crank's axis to the swivels under it
(define long 0.4)                          ; m, of a leg, from the crank's pin to the foot
(define axle 0.26)                         ; m, of the cranks before and behind the middle
(define track 0.24)                        ; m, and beside it
(define high (+ crank long 0.031))         ; m, of the axles above the ground as it starts

(set-contact-parameters! #t #t #:restitution 0 #:friction 0.9)
(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(for-each (lambda (i)
            (add-body! #:name (format #f "plank-~a" i) #:fixed? #t #:color #(0.6 0.45 0.3)
                       #:shape (box 0.3 1.2 0.02)
                       #:position (vector (+ 1.1 (* 0.55 i)) 0 0.01)))
          (iota 4))

(define brass #(0.85 0.65 0.25))
(define steel #(0.5 0.53 0.58))
(define teal #(0.1 0.5 0.52))

;; The legs of a corner: `side` of the axle, `end` of the toy, phase of the crank: where the pin of a
;; leg is, and how the leg leans so that it passes through its swivel.
(define (pin-of angle) (vector (* crank (cos angle)) 0 (* crank (sin angle))))
(define (lean-of angle)
  (let ((pin (pin-of angle)))
    ;; about y, of a leg that points down at 0
    (atan (vector-ref pin 0) (+ drop (vector-ref pin 2)))))

(define (name what . where) (string->symbol (format #f "~a~{-~a~}" what where)))

(define corners '((front left 1 1) (front right 1 -1) (rear left -1 1) (rear right -1 -1)))
(define phases '((a 0) (b 1)))             ; in half turns

(define (crank-link corner)
  (let* ((end (first corner)) (side (second corner))
         (x (* axle (third corner))) (y (* track (fourth corner))))
    (apply link (name 'crank end side) #:joint (revolute #:axis #(0 1 0) #:at (vector x y 0))
           #:shape (union (placed (box (* 2.4 crank) 0.015 0.03))
                          (placed (cylinder 0.02 0.05) #:orientation (rotation #(1 0 0) (/ pi 2))))
           #:density 2000 #:color brass
           (map (lambda (phase)
                  ;; the pins lie at +-crank along x as the crank stands at 0
                  (let ((sign (if (zero? (second phase)) 1 -1)))
                    (link (name 'leg end side (first phase))
                          #:joint (revolute #:axis #(0 1 0)
                                            #:at (vector (* sign crank) (* 0.035 sign (fourth corner)) 0))
                          #:shape (union (placed (box 0.022 0.016 (- long 0.02))
                                                 #:position (vector 0 0 (* -0.5 long)))
                                         (placed (sphere 0.03) #:position (vector 0 0 (- long))))
                          #:density 700 #:color steel)))
                phases))))

(define (swivel-links corner)
  (let* ((end (first corner)) (side (second corner))
         (x (* axle (third corner))) (y (* track (fourth corner))))
    (map (lambda (phase)
           (let ((sign (if (zero? (second phase)) 1 -1)))
             (link (name 'swivel end side (first phase))
                   #:joint (revolute #:axis #(0 1 0)
                                     #:at (vector x (+ y (* 0.035 sign (fourth corner))) (- drop)))
                   #:shape (box 0.03 0.03 0.03) #:density 2000 #:color brass
               (link (name 'collar end side (first phase)) #:joint (prismatic #:axis #(0 0 1))
                     #:shape (box 0.04 0.022 0.02) #:density 2000 #:color brass))))
         phases)))

(define toy
  (apply add-multibody! #:name 'toy #:base 'free #:position (vector 0 0 high)
         (list (apply link 'frame #:density 300 #:color teal
                      #:shape (union (placed (box 0.66 0.34 0.08) #:position #(0 0 0.07))
                                     (placed (box 0.6 0.4 0.03) #:position (vector 0 0 (- drop)))
                                     (placed (box 0.04 0.04 (+ drop 0.1)) #:position #(0 0 -0.05))
                                     (placed (sphere 0.07) #:position #(0.38 0 0.12)))
                      (append (map crank-link corners) (append-map swivel-links corners))))))
(disable-collisions! toy toy)

;; set up: all cranks in step, each leg in its swivel
(define turn 0.5)
(for-each
 (lambda (corner)
   (let* ((end (first corner)) (side (second corner)))
     ;; a turn about y takes x towards -z
     (set! (joint-position toy (name 'crank end side)) turn)
     (for-each
      (lambda (phase)
        (let* ((angle (- (+ turn (* pi (second phase))))) (lean (lean-of angle))
               (pin (pin-of angle)))
          (set! (joint-position toy (name 'leg end side (first phase))) (- lean turn))
          (set! (joint-position toy (name 'swivel end side (first phase))) lean)
          (set! (joint-position toy (name 'collar end side (first phase))) 0)
          (attach! (link-body toy (name 'leg end side (first phase)))
                   (link-body toy (name 'collar end side (first phase))))))
      phases)))
 corners)

;; the cranks are turned together, from rest
(add-callback! toy
  (lambda (time view)
    (let* ((speed (* (- pace) (min 1 time)))
           (angle (- turn (* pace (if (< time 1) (* 0.5 time time) (- time 0.5))))))
      (for-each (lambda (corner)
                  (set! (joint-servo view (name 'crank (first corner) (second corner)))
                        (servo #:target angle #:target-velocity speed #:stiffness 100 #:damping 5
                               #:max-torque 40)))
                corners)))
  #:period 0.02)

(camera #:eye #(1.2 -2.2 0.9) #:target #(0.9 0 0.3) #:fov 0.8)
