;;; A table turns faster and faster: what stands on it slides off, the outermost first.
(use-modules (timewarp) (timewarp vectors))

(scene #:title "Turntable" #:duration 5)

(define-scene-parameter bodies 24 "bodies on the table")

(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.5)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) -0.8) #:fixed? #t)
(add-body! #:name "table" #:shape (cylinder 3 0.4) #:color #(0.45 0.3 0.18) #:max-speed 16
           #:motion (lambda (time)
                      (values #(0 0 -0.2) (rotation #(0 0 1) (* 1/2 time time)))))

;; on a spiral
(define (add-on-table! k)
  (let ((radius (+ 0.4 (* 2.3 (/ k bodies)))) (angle (* 2.4 k)))
    (add-body! #:name (format #f "load-~a" k)
               #:shape (if (even? k) (box 0.3 0.3 0.3) (cylinder 0.15 0.3))
               #:position (vector (* radius (cos angle)) (* radius (sin angle)) 0.15)
               #:orientation (rotation #(0 0 1) angle)
               #:color (if (even? k) #(0.2 0.4 0.55) #(0.85 0.62 0.08)))))
(do ((k 0 (1+ k))) ((= k bodies)) (add-on-table! k))

(camera #:eye #(0 -9 5) #:target #(0 0 -0.2) #:fov 0.7)
