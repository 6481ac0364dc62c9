;;; A card house of four floors; a ball is thrown into its side.
(use-modules (timewarp) (timewarp vectors))

(scene #:title "Card house" #:duration 5)

(define-scene-parameter floors 4 "floors of the house")
(define-scene-parameter thrown? #t "throw the ball")

(define long 1.0)                          ; m, of a card
(define wide 0.7)
(define thick 0.02)
(define lean (* 20 (/ (acos -1) 180)))     ; of a card, off the vertical

(define height (+ (* long (cos lean)) (* thick (sin lean))))
(define foot (/ (+ (* long (sin lean)) (* thick (cos lean))) 2)) ; from a pair's middle to a card's
(define spacing (* 4 foot))                ; of the pairs of a floor: they touch

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.6)

(define (card! shape x z turn color)
  (add-body! #:shape shape #:position (vector x 0 z) #:orientation (rotation #(0 1 0) turn)
             #:density 700 #:color color))

(define (add-floor! k)
  (let* ((pairs (- floors k))
         (first (* -1/2 spacing (1- pairs)))
         (bottom (* k (+ height thick))))
    (do ((i 0 (1+ i))) ((= i pairs))
      (for-each (lambda (side)
                  (card! (box thick wide long) (+ first (* i spacing) (* side foot))
                         (+ bottom (/ height 2)) (* -1 side lean) #(0.85 0.84 0.8)))
                '(-1 1)))
    (do ((i 0 (1+ i))) ((>= i (1- pairs)))
      (card! (box (* 0.99 spacing) wide thick) (+ first (* (+ i 1/2) spacing))
             (+ bottom height (/ thick 2)) 0 #(0.7 0.15 0.12)))))

(do ((k 0 (1+ k))) ((= k floors)) (add-floor! k))

(when thrown?
  (add-body! #:name "ball" #:shape (sphere 0.25) #:position #(-9 0 1) #:velocity #(8 0 4.5)
             #:density 2000 #:color #(0.15 0.3 0.5)))

(camera #:eye #(2 -9 3) #:target #(0 0 1.7) #:fov 0.7)
