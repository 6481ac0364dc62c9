;; Values beyond what can be computed are refused where they are given, and the message names the
;; limit.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

;; what once never ended ends this test
(alarm 60)

(test-begin "limits")

(define-syntax-rule (refuses name pattern expression)
  (in-world () (test-message name pattern expression)))

;; ---- shapes ----

(refuses "a huge sphere" "radius of a sphere is 1e\\+?300 m; expected a length from 1e-12 to 1e\\+?12 m"
  (sphere 1e300))
(refuses "a tiny sphere" "radius of a sphere is 1e-300 m; expected a length from 1e-12"
  (sphere 1e-300))
(refuses "a denormal edge" "y edge of a box is 5e-324 m; expected a length" (box 1 5e-324 1))
(refuses "a long cylinder" "length of a cylinder is 1e\\+?30 m; expected a length"
  (cylinder 1 1e30))
(refuses "a point far away" "a point of a hull .*; expected coordinates of at most 1e\\+?12 m"
  (convex '(#(0 0 0) #(1 0 0) #(0 1 0) #(0 0 1e300))))
(refuses "a tiny hull" "expected" (convex '(#(0 0 0) #(1e-200 0 0) #(0 1e-200 0) #(0 0 1e-200))))
(refuses "a part placed far away" "a shape is placed at .*; expected coordinates of at most"
  (placed (sphere 1) #:position #(1e300 0 0)))
(refuses "a plane far away" "offset of a half-space is 1e\\+?300 m; expected at most"
  (half-space #(0 0 1) 1e300))
(test-assert "a short normal is a normal" (shape? (half-space #(0 0 1e-300) 0)))
(test-equal "a short quaternion is a quaternion" #(0.0 1.0 0.0 0.0)
  (in-world () (orientation (add-body! #:shape (sphere 1) #:orientation #(0 1e-300 0 0)))))

;; ---- bodies ----

(define-syntax-rule (refuses-ball pattern given ...)
  (refuses (format #f "a ball with ~s" '(given ...)) pattern
    (add-body! #:name "ball" #:shape (sphere 0.1) given ...)))

(refuses-ball "density of ball is 1e\\+?300; expected a number from 1e-60 to 1e\\+?60"
  #:density 1e300)
(refuses-ball "mass of ball is 1e-300; expected a number from" #:mass 1e-300)
(refuses-ball "inertia of ball .* expected numbers from" #:inertia #(1e300 1e300 1e300))
(refuses-ball "inertia of ball .* expected numbers from" #:inertia #(1e-300 1e-300 1e-300))
(refuses-ball "center of mass of ball is .*; expected coordinates of at most"
  #:center-of-mass #(1e200 0 0))
(refuses-ball "position of ball has a coordinate of 1e\\+?300 m; expected at most"
  #:position #(0 0 1e300))
(refuses-ball "speed of ball is .*; expected at most 1e\\+?12" #:velocity #(0 0 1e30))
(refuses-ball "angular velocity of ball is .*; expected at most" #:angular-velocity #(0 0 1e300))
(refuses-ball "max-speed is 1e\\+?300 m/s; expected at most"
              #:motion (lambda (time) (values #(0 0 0) #(1 0 0 0))) #:max-speed 1e300)
(refuses "a motion to far away" "returned a position with a coordinate of 1e\\+?300 m"
  (begin
    (add-body! #:shape (sphere 1) #:max-speed 1
               #:motion (lambda (time) (values #(1e300 0 0) #(1 0 0 0))))
    (run! #:until 1)))

(define-syntax-rule (refuses-change pattern change)
  (in-world ()
    (let ((ball (add-body! #:name "ball" #:shape (sphere 0.1))))
      (test-message (format #f "~s between runs" 'change) pattern (change ball))
      (add-callback! ball (lambda (time view) (change view) #f))
      (test-message (format #f "~s in a callback" 'change) "ball(.|\n)*; expected" (run! #:until 1)))))

(refuses-change "applied-force of ball is 1e\\+?30 N on .*; expected an acceleration of at most 1e\\+?12 m/s"
  (lambda (body) (set! (applied-force body) #(0 0 1e30))))
(refuses-change "speed of ball is 1e\\+?30 m/s; expected at most"
  (lambda (body) (set! (velocity body) #(0 0 1e30))))
(refuses-change "angular velocity of ball is 1e\\+?30 rad/s; expected at most"
  (lambda (body) (set! (angular-velocity body) #(0 0 1e30))))
(refuses-change "position of ball has a coordinate of 1e\\+?30 m; expected at most"
  (lambda (body) (set! (position body) #(0 0 1e30))))

;; ---- time ----

(refuses "keyframes in no time" "keyframes 0 and 1 are 1e-300 s apart; expected a motion of at most"
  (keyframes '((0 #(0 0 0)) (1e-300 #(1 0 0)))))
(refuses "keyframes that turn in no time" "keyframes 0 and 1 are 1e-300 s apart"
  (keyframes '((0 #(0 0 0) #(1 0 0 0)) (1e-300 #(0 0 0) #(0 1 0 0)))))
(refuses "a keyframe far away" "position of keyframe 0 has a coordinate"
  (keyframes '((0 #(1e300 0 0)))))
(refuses "a keyframe long after" "time of keyframe 0 is 1e\\+?300 s; expected at most"
  (keyframes '((1e300 #(0 0 0)))))
(refuses "a run without end" "until is 1e\\+?300 s; expected at most 1e\\+?0?9 s"
  (run! #:until 1e300))

(define-syntax-rule (refuses-callback pattern given ...)
  (in-world ()
    (let ((ball (add-body! #:name "ball" #:shape (sphere 0.1))))
      (test-message (format #f "a callback with ~s" '(given ...)) pattern
        (add-callback! ball list given ...)))))

(refuses-callback "period of callback of ball is 1e-300 s; expected a time from 1e-0?6 to .* could not be counted"
  #:period 1e-300)
(refuses-callback "period of callback of ball is 5e-324 s; expected a time from" #:period 5e-324)
(refuses-callback "period of callback of ball is 1e\\+?300 s; expected a time from" #:period 1e300)
(refuses-callback "start of callback of ball is -?1e\\+?300 s; expected at most"
  #:start -1e300 #:period 1)

;; ---- settings ----

(refuses "gravity"
  "gravity is 1e\\+?300 m/s\\^2; expected at most 1e\\+?12|gravity is infinity m/s\\^2; expected at most"
  (scene #:gravity #(0 0 -1e300)))
(refuses "contact checks too often" "group-check-rate is 1e\\+?300 Hz; expected a rate from 1"
  (scene #:group-check-rate 1e300))
(refuses "contact checks too rarely" "group-check-rate is 1e-300 Hz; expected a rate from 1"
  (scene #:group-check-rate 1e-300))
(refuses "frames too often" "frames per second are 1e\\+?300; expected at most"
  (begin (scene #:fps 1e300) (observe! 'frame list) (run! #:until 1)))
(refuses "stiffness" "stiffness is 1e\\+?300; expected"
  (set-contact-parameters! #t #t #:stiffness 1e300))
(refuses "damping" "damping is 1e\\+?300; expected" (set-contact-parameters! #t #t #:damping 1e300))
(refuses "fusion speed" "fusion-speed is 1e\\+?300; expected"
  (set-contact-parameters! #t #t #:fusion-speed 1e300))

;; ---- files ----

(refuses "poses and events in one file"
  "the events file is .*; expected another file than that of the poses"
  (simulate! #:until 0 #:poses (in-folder "both.csv") #:events (in-folder "both.csv")))
(refuses "by two names" "expected another file than that of the poses"
  (simulate! #:until 0 #:poses (in-folder "both.csv") #:events (in-folder "./both.csv")))
(refuses "a table called a picture" "the poses file is .*; expected a name for a CSV file"
  (simulate! #:until 0 #:poses (in-folder "00000.png") #:frames (force folder)))
(test-equal "no file was made" '()
  (filter (lambda (name) (file-exists? (in-folder name))) '("both.csv" "00000.png")))

(unless (string-null? (or (getenv "TW_DRAWS") ""))
  (refuses "a picture in another format" "the picture's file is .*a.jpg.*; expected a name that ends in .png"
    (render! (in-folder "a.jpg") #:size '(16 16)))
  (refuses "frames in another format" "the pattern of frames is .*; expected a name that ends in .png"
    (simulate! #:until 0 #:frames (in-folder "%d.jpg"))))

(clean-up)
(test-end "limits")
