;;; One ball bounces on a slab and loses a fifth of its speed each time.  A slot of its state counts
;;; the bounces: the count rolls back with the ball, so it always equals the bounces that happened.
(use-modules (timewarp) (ice-9 format))

(scene #:title "Bouncing ball" #:duration 3)

(define-scene-parameter restitution 0.8 "share of the approach speed that a bounce gives back")

(define ground
  (add-body! #:name "ground" #:shape (box 4 4 0.2) #:position #(0 0 -0.1) #:fixed? #t))

(define ball
  (add-body! #:name "ball" #:shape (sphere 0.1) #:position #(-0.6 0 1)
             #:velocity #(0.4 0 0) #:color #(0.85 0.25 0.15) #:slots '((bounces . 0))))

(set-contact-parameters! ball ground #:restitution restitution #:friction 0)

(on-collision! ball ground                 ; may run again after a rollback
  (lambda (collision ball ground)
    (set! (slot ball 'bounces) (1+ (slot ball 'bounces)))))

(observe! 'collision                       ; runs once, in time order, when final
  (lambda (collision)
    (format #t "bounce at ~,6f s, ~,3f m/s~%"
            (collision-time collision) (collision-speed collision))))

(camera #:eye #(0.3 -3.2 1.1) #:target #(0 0 0.4))
