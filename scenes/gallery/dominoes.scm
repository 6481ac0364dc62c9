;;; A hundred dominoes stand along an S.  The first is pushed; each one topples the next until all lie,
;;; leaning on each other.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(scene #:title "Dominoes" #:duration 12)

(define-scene-parameter dominoes 100 "number of dominoes")
(define-scene-parameter gap 0.17 "from one to the next, m")

(define thickness 0.07) (define width 0.24) (define height 0.48)
(set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.3)
(add-body! #:name "table" #:shape (half-space #(0 0 1) 0) #:fixed? #t #:color #(0.46 0.34 0.25))

;; two half circles of this radius, one to the left, one to the right
(define pi (acos -1))
(define radius (/ (* dominoes gap) (* 2 pi)))
(define (place way)           ; x, y and the turn after WAY metres: the way on is local -x
  (let* ((first? (< way (* pi radius)))
         (turn (/ (if first? way (- (* 2 pi radius) way)) radius))
         (side (if first? 1 -1)))
    (values (* -1 side radius (sin turn)) (* side radius (1+ (cos turn))) turn)))

(for-each
 (lambda (index)
   (call-with-values (lambda () (place (* index gap)))
     (lambda (x y heading)
       (let* ((spin (if (zero? index) 2 0))      ; the first one turns about its lower edge
              (turned (rotation #(0 0 1) heading))
              (share (/ index (max 1 (1- dominoes)))))
         (add-body! #:name (format #f "domino-~a" index) #:shape (box thickness width height)
                    #:density 600 #:position (vector x y (* 1/2 height)) #:orientation turned
                    #:velocity (rotate turned (vector (* -1/2 spin height) 0 0))
                    #:angular-velocity (rotate turned (vector 0 (- spin) 0))
                    #:color (lerp #(0.85 0.30 0.16) #(0.95 0.85 0.55) share))))))
 (iota dominoes))

(camera #:eye #(6.5 -9.5 6.5) #:target #(0 0.2 0) #:fov 0.75)
