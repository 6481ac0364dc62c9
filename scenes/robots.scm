;;; Twenty arms of eight links pick up boxes and throw them up a chute, from where they slide back
;;; to be picked up again.  An arm knows where a box lies, finds its joint angles by inverse
;;; kinematics, moves along polynomials by computed torques, holds a box by attach! and lets go of
;;; it in mid-swing.
;;; After B. Mirtich, Timewarp Rigid Body Simulation (2000), table 1.
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1) (ice-9 match))

(define-scene-parameter robots 20 "arms, 1 to 20")
(define-scene-parameter boxes 4 "boxes of each arm")
(define-scene-parameter rate 50 "Hz of the controllers")

(scene #:title "Robots" #:duration 120 #:accuracy 1e-3)

(define pi (acos -1))
(define side 0.14)                         ; m, of a box
(define density 180)
(define box-mass (* density side side side))
(define tick (/ 1.0 rate))

(set-contact-parameters! #t #t #:restitution 0.25 #:friction 0.5)
(set-contact-parameters! 'chute #t #:restitution 0.25 #:friction 0.22)

(add-body! #:name "ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)

;; ---- a bay: pedestal, trough, chute, back, walls; the arms stand in a ring and look outwards ----

(define slope (* pi 0.21))
(define trough-near 0.45) (define trough-far 1.0)
(define trough-top 0.25) (define rim-top 0.56)
(define chute-length 2.2)
(define wide 1.3)
(define ring 3.9)                          ; m, radius on which the arms stand

;; a frame of a bay: where its pedestal stands, and how it is turned
(define (bay-turn number) (rotation #(0 0 1) (+ (* 2 pi (/ number 20)) (* 0.5 pi))))
(define (in-bay number point)
  (rotate (bay-turn number) (v+ (vector ring 0 0) point)))

(define (add-bay! number)
  (define* (add-part! name shape point color #:optional (turn #(1 0 0 0)))
    (add-body! #:name (format #f "~a-~a" name number) #:fixed? #t #:shape shape #:color color
               #:material 'chute #:position (in-bay number point)
               #:orientation (q* (bay-turn number) turn)))
  (let* ((middle (* 0.5 (+ trough-near trough-far)))
         (end (+ trough-far (* chute-length (cos slope))))
         (top (+ trough-top (* chute-length (sin slope))))
         (wood #(0.78 0.66 0.5)) (rim #(0.55 0.4 0.27))
         (tilt (rotation #(0 1 0) (- slope)))
         (pedestal (add-part! "pedestal" (cylinder 0.17 0.76) #(0 0 0.38) #(0.2 0.21 0.24))))
    (add-part! "trough" (box (- trough-far trough-near) wide trough-top)
               (vector middle 0 (* 0.5 trough-top)) wood)
    (add-part! "lip" (box 0.04 wide rim-top)
               (vector (- trough-near 0.02) 0 (* 0.5 rim-top)) rim)
    (add-part! "chute" (box chute-length wide 0.06)
               (v+ (vector trough-far 0 trough-top)
                   (rotate tilt (vector (* 0.5 chute-length) 0 -0.03)))
               #(0.93 0.86 0.7) tilt)
    (add-part! "back" (box 0.05 wide 1.2) (vector (+ end 0.02) 0 (+ top 0.5)) #(0.9 0.62 0.2))
    (for-each (lambda (name sign)
                (add-part! (string-append name "-low")
                           (box (- trough-far trough-near) 0.04 rim-top)
                           (vector middle (* sign (+ 0.02 (* 0.5 wide))) (* 0.5 rim-top))
                           rim)
                (add-part! name
                           (convex
                            (append-map
                             (lambda (across)
                               (list (vector trough-far across 0) (vector end across 0)
                                     (vector trough-far across rim-top)
                                     (vector (+ trough-far 0.5) across (+ trough-top 0.9))
                                     (vector end across (+ top 0.9))))
                             (list (* sign 0.5 wide) (* sign (+ (* 0.5 wide) 0.04)))))
                           #(0 0 0) #(0.82 0.74 0.6)))
              '("left" "right") '(1 -1))
    pedestal))

;; ---- an arm of eight links: seven turning joints and a sprung suction pad ----

(define steel #(0.42 0.45 0.5))
(define (beam length width)
  (placed (box length width width) #:position (vector (* 0.5 length) 0 0)))

(define upper 0.66) (define fore 0.56) (define hand 0.12) (define pad-length 0.06)

(define (add-arm! number pedestal color)
  (let ((arm
          (add-multibody! #:name (format #f "arm-~a" number) #:base pedestal #:position #(0 0 0.38)
            (link 'turret #:joint (revolute #:axis #(0 0 1) #:damping 0.5)
                  #:shape (placed (cylinder 0.15 0.1) #:position #(0 0 0.05)) #:color steel
              (link 'upper #:joint (revolute #:axis #(0 1 0) #:at #(0 0 0.15) #:limits '(-2.8 1.2))
                    #:shape (beam (* 0.5 upper) 0.11) #:density 400 #:color color
                (link 'upper-roll #:joint (revolute #:axis #(1 0 0) #:at (vector (* 0.5 upper) 0 0)
                                                    #:limits '(-2 2))
                      #:shape (beam (* 0.5 upper) 0.09) #:density 400 #:color color
                  (link 'fore #:joint (revolute #:axis #(0 1 0) #:at (vector (* 0.5 upper) 0 0)
                                                #:limits '(-0.2 2.7))
                        #:shape (beam (* 0.5 fore) 0.08) #:density 400 #:color color
                    (link 'fore-roll
                          #:joint (revolute #:axis #(1 0 0) #:at (vector (* 0.5 fore) 0 0)
                                            #:limits '(-2 2))
                          #:shape (beam (* 0.5 fore) 0.07) #:density 400 #:color color
                      (link 'wrist #:joint (revolute #:axis #(0 1 0) #:at (vector (* 0.5 fore) 0 0)
                                                     #:limits '(-2.2 2.2))
                            #:shape (beam hand 0.06) #:density 400 #:color steel
                        (link 'hand #:joint (revolute #:axis #(1 0 0) #:at (vector hand 0 0))
                              #:shape (beam 0.04 0.07) #:density 400 #:color steel
                          (link 'pad #:joint (prismatic #:axis #(1 0 0) #:at #(0.04 0 0)
                                                        #:limits '(-0.03 0.03)
                                                        #:stiffness 3000 #:damping 30)
                                #:shape (placed (cylinder 0.035 pad-length)
                                                #:orientation (rotation #(0 1 0) (/ pi 2))
                                                #:position (vector (* 0.5 pad-length) 0 0))
                                #:density 400 #:color #(0.1 0.1 0.11)
                                #:slots '((phase . #f) (box . 0) (picked . 0)
                                          (thrown . 0)))))))))))))
    (disable-collisions! arm arm)
    arm))

;; ---- motion: every phase is a polynomial in the joints from here to there ----

;; of degree five, at a share s of the time T: position, velocity, acceleration; v0, v1: velocities
;; here and there
(define (quintic p0 v0 p1 v1 T s)
  (let* ((d (- p1 p0)) (u0 (* v0 T)) (u1 (* v1 T))
         (a (- (* 10 d) (* 6 u0) (* 4 u1))) (b (+ (* -15 d) (* 8 u0) (* 7 u1)))
         (c (- (* 6 d) (* 3 u0) (* 3 u1))) (s2 (* s s)))
    (values (+ p0 (* s u0) (* s2 s (+ a (* s (+ b (* s c))))))
            (/ (+ u0 (* s2 (+ (* 3 a) (* s (+ (* 4 b) (* s 5 c)))))) T)
            (/ (* s (+ (* 6 a) (* s (+ (* 12 b) (* s 20 c))))) (* T T)))))

(define ready #(0 -1.6 0 2.0 0 1.1 0 0))
(define wound #(0 -1.75 0 2.3 0 0.8 0 0))
(define release #(0 -0.6 0 1.1 0 -0.15 0 0))
(define swing #(0 0.5 0 -5.5 0 -5.5 0 0))          ; rad/s at the release: a throw from below
(define still #(0 0 0 0 0 0 0 0))
(define pitch-down (rotation #(0 1 0) (/ pi 2)))

(define stiffness (* 20 20))
(define damping (* 2 20))

;; adds the torques that a held box takes for the joints' accelerations: J^T m (a + g), a = J qdd at
;; the middle of the box
(define (carry! torques view box accelerations)
  (let* ((J (jacobian view 'pad)) (arm (v- (position box) (position view)))
         (column (lambda (i)
                   (v+ (vector (array-ref J 0 i) (array-ref J 1 i) (array-ref J 2 i))
                       (cross (vector (array-ref J 3 i) (array-ref J 4 i) (array-ref J 5 i)) arm))))
         (columns (map column (iota (vector-length torques))))
         (force (v* box-mass (fold (lambda (c a sum) (v+ sum (v* a c))) #(0 0 9.81)
                                   columns (vector->list accelerations)))))
    (for-each (lambda (c i) (vector-set! torques i (+ (vector-ref torques i) (dot c force))))
              columns (iota (vector-length torques)))))

;; joint torques that follow the phase's polynomial at the middle of the tick; `held`: a box, or #f
(define (follow! view phase time held)
  (match phase
    ((_ start length from from-speed to speed)
     (let* ((s (max 0 (min 1 (/ (- (+ time (* 0.5 tick)) start) length))))
            (q (joint-positions view)) (qd (joint-velocities view))
            (n (vector-length q)) (half (* 0.5 tick))
            (wanted (make-vector n)) (ahead (make-vector n)))
       (do ((i 0 (1+ i))) ((= i n))
         (call-with-values
             (lambda ()
               (quintic (vector-ref from i) (vector-ref from-speed i)
                        (vector-ref to i) (vector-ref speed i) length s))
           (lambda (p v a)
             (let ((q* (+ (vector-ref q i) (* half (vector-ref qd i)))))
               (vector-set! ahead i q*)
               (vector-set! wanted i (+ a (* damping (- v (vector-ref qd i)))
                                        (* stiffness (- p q*))))))))
       (vector-set! wanted (1- n) 0)
       (let ((torques (inverse-dynamics view ahead qd wanted)))
         (when held (carry! torques view held wanted))
         (vector-set! torques (1- n) 0)
         (set! (joint-torques view) torques))))))

;; ---- what an arm does: phases (name start length from from-speed to speed), and its box ----

;; a posture, but in the direction where the arm is
(define (towards view posture)
  (let ((posture (vector-copy posture)))
    (vector-set! posture 0 (vector-ref (joint-positions view) 0))
    posture))

(define (flat v) (vector (vector-ref v 0) (vector-ref v 1) 0))

(define (controller base turn)
  ;; with the pad on a point from above
  (define (angles view point)
    (let* ((way (rotate (q-conjugate turn) (v- point base)))
           (yaw (atan (vector-ref way 1) (vector-ref way 0)))
           (start (vector-copy ready)))
      (vector-set! start 0 yaw)
      (inverse-kinematics view 'pad #:position point #:point (vector pad-length 0 0)
                          #:orientation (q* turn (rotation #(0 0 1) yaw) pitch-down)
                          #:start start #:starts 3)))
  (define (above box height) (v+ (position box) (vector 0 0 (+ (* 0.5 side) height))))
  (define (calm? box)
    (let ((way (v- (position box) base)))
      (and (< (norm (velocity box)) 0.05) (< (norm (flat way)) 1.15))))
  (lambda (time view . views)
    (define (phase! name length to speed)
      (set! (slot view 'phase)
            (list name time length (joint-positions view) (joint-velocities view) to speed)))
    (define (box) (list-ref views (slot view 'box)))
    (define (wait! length) (phase! 'wait length ready still))
    (define (done? phase) (>= (+ time (* 0.5 tick)) (+ (cadr phase) (caddr phase))))
    (define (look!)
      ;; the highest of those that lie still
      (let* ((there (filter (lambda (i) (calm? (list-ref views i))) (iota boxes)))
             (best (and (pair? there)
                        (argmax (lambda (i) (vector-ref (position (list-ref views i)) 2)) there)))
             (to (and best (angles view (above (list-ref views best) 0.12)))))
        (cond (to (set! (slot view 'box) best)
                  (phase! 'reach 0.6 to still))
              (else (wait! 0.3)))))
    (let ((phase (slot view 'phase)))
      (cond
       ((not phase) (wait! (* tick (1+ (round (* rate 2.4 (random-real! view)))))))
       ((done? phase)
        (case (car phase)
          ((wait) (look!))
          ((reach)
           (let ((to (angles view (above (box) -0.005))))
             (if (and to (calm? (box))) (phase! 'lower 0.3 to still) (wait! 0.3))))
          ((lower)
           (let ((tip (v+ (position view) (rotate (orientation view) (vector pad-length 0 0)))))
             (cond ((< (norm (v- tip (above (box) 0))) 0.04)
                    (attach! view (box))
                    (set! (slot view 'picked) (1+ (slot view 'picked)))
                    (phase! 'lift 0.4 (towards view ready) still))
                   (else (wait! 0.3)))))
          ((lift) (phase! 'wind 0.4 wound still))
          ((wind) (phase! 'swing 0.3 release swing))
          ((swing)
           (detach! view (box))
           (set! (slot view 'thrown) (1+ (slot view 'thrown)))
           (phase! 'back 0.5 ready still))
          (else (look!)))))
      (let ((phase (slot view 'phase)))
        (follow! view phase time (and (memq (car phase) '(lift wind swing)) (box)))))))

(define (argmax score items)
  (fold (lambda (item best) (if (> (score item) (score best)) item best)) (car items) (cdr items)))

;; ---- all of them ----

(define (add-robot! number)
  (let* ((hue (/ number 20))
         (color (vector (+ 0.55 (* 0.4 (cos (* 2 pi hue))))
                        (+ 0.42 (* 0.25 (cos (* 2 pi (- hue 0.35)))))
                        (+ 0.4 (* 0.38 (cos (* 2 pi (- hue 0.65)))))))
         (arm (add-arm! number (add-bay! number) color))
         (crew (map (lambda (k)
                      (add-body! #:name (format #f "box-~a-~a" number k)
                                 #:shape (box side side side) #:density density
                                 #:orientation (bay-turn number)
                                 #:position
                                 (in-bay number (vector 0.74 (* 0.28 (- k (* 0.5 (1- boxes))))
                                                        (+ trough-top (* 0.5 side))))
                                 #:color (vector (+ 0.9 (* -0.2 k)) (+ 0.3 (* 0.15 k)) 0.25)))
                    (iota boxes))))
    ;; what grips a box does not push it
    (for-each (lambda (name)
                (for-each (lambda (b) (disable-collisions! (link-body arm name) b)) crew))
              '(wrist hand pad))
    (set! (joint-positions arm) ready)
    (add-callback! (cons (link-body arm 'pad) crew)
                   (controller (in-bay number #(0 0 0)) (bay-turn number))
                   #:period tick #:start (* tick (/ number robots)))
    arm))

(define arms (map add-robot! (iota robots)))

;; marks on the ground within the ring
(for-each (lambda (k)
            (let ((angle (* 2 pi (/ k 9))))
              (add-body! #:name (format #f "mark-~a" k) #:fixed? #t #:shape (cylinder 0.12 0.06)
                         #:color #(0.35 0.5 0.62)
                         #:position (vector (* 2.2 (cos angle)) (* 2.2 (sin angle)) 0.03))))
          (iota 9))

(camera #:eye #(0 -2.6 4.4) #:target #(0 4.4 0.7) #:fov 0.85)
(light #:direction #(0.35 0.75 -1))
