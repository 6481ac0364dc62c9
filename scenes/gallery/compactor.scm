;;; The plate of a press comes down on a crate, a ball and a drum, to three quarters of their height,
;;; twice: half of what is missing each has sunk into the plate, half into the floor; they follow
;;; the plate up at its own speed, and none is thrown.
(use-modules (timewarp) (timewarp vectors) (ice-9 format))

(scene #:title "Compactor" #:duration 6)

(define-scene-parameter squeeze 0.75 "what is left of their height")

(define height 0.4)                        ; m, of each
(define steel #(0.35 0.37 0.4))

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.4)

(for-each
 (lambda (name shape x color)
   (add-body! #:name name #:shape shape #:density 300 #:position (vector x 0 (/ height 2))
              #:color color))
 '("crate" "ball" "drum")
 (list (box height height height) (sphere (/ height 2)) (cylinder (/ height 2) height))
 '(-0.65 0 0.65)
 '(#(0.7 0.25 0.15) #(0.85 0.62 0.08) #(0.2 0.4 0.55)))

;; columns to either side, and the plate, by the height of its lower face
(for-each
 (lambda (x name)
   (add-body! #:name name #:shape (box 0.1 0.1 1.2) #:fixed? #t #:color steel
              #:position (vector x 0 0.6)))
 '(-1.15 1.15) '("left column" "right column"))
(define up 0.9)
(define down (* height squeeze))
(define (plate-at time face) (list time (vector 0 0 (+ face 0.2))))
(add-body! #:name "plate" #:shape (box 2.1 0.7 0.4) #:color steel
           #:motion (keyframes (list (plate-at 0 up) (plate-at 1.5 down) (plate-at 2 down)
                                     (plate-at 3 up) (plate-at 4.5 down) (plate-at 5 down)
                                     (plate-at 6 up))
                               #:smooth? #t))

(observe! 'squeezed
  (lambda (squeezing)
    (format #t "~,3f s: the ~a is squeezed between ~{~a~^ and ~}~%" (squeezed-time squeezing)
            (body-name (squeezed-body squeezing))
            (map body-name (squeezed-between squeezing)))))

(camera #:eye #(1.3 -2.9 1.1) #:target #(0 0 0.4) #:fov 0.6)
