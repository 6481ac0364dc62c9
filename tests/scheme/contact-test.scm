;; Contact parameters: how they are looked up, and which pairs collide.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules ((timewarp vectors) #:select (rotate)))

(test-begin "contact")

(in-world ()
  (let ((a (add-body! #:name "a" #:shape (sphere 1) #:material 'rubber))
        (b (add-body! #:name "b" #:shape (sphere 1) #:position #(5 0 0) #:material 'steel)))
    (test-equal "defaults" '(0.3 0.5 #t 0.0 0.0) (contact-parameters a b))
    (set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.1)
    (test-equal "for all" '(0.1 0.1 #t 0.0 0.0) (contact-parameters a b))
    (set-contact-parameters! 'rubber #t #:restitution 0.2)
    (test-equal "a material goes before all, keyword by keyword" '(0.2 0.1 #t 0.0 0.0) (contact-parameters a b))
    (set-contact-parameters! a #t #:restitution 0.9)
    (set-contact-parameters! 'rubber 'steel #:restitution 0.4)
    (test-equal "a body goes before a pair of materials" '(0.9 0.1 #t 0.0 0.0) (contact-parameters b a))
    (set-contact-parameters! #t a #:restitution 0.8)
    (test-equal "at ties the later call holds" '(0.8 0.1 #t 0.0 0.0) (contact-parameters a b))
    (disable-collisions! 'rubber 'steel)
    (test-equal "collisions disabled" #f (third (contact-parameters a b)))
    (enable-collisions! a b)
    (test-equal "and enabled for a pair" #t (third (contact-parameters a b)))
    (test-message "a side of the wrong type" "first side is \"a\"; expected a body, a material"
      (set-contact-parameters! "a" #t #:friction 1))
    (test-message "restitution above 1" "restitution is 2" (set-contact-parameters! a b #:restitution 2))
    (test-message "negative friction" "friction is -1" (set-contact-parameters! a b #:friction -1))
    (test-message "an unknown law" "expected anchored or smooth"
      (set-contact-parameters! a b #:friction-law 'sticky))
    (test-message "an unknown impact law" "impact-law is newton; expected chatterjee-ruina or stronge"
      (set-contact-parameters! a b #:impact-law 'newton))
    (test-message "unknown keyword" "unknown keyword #:bounce; expected one of #:restitution"
      (set-contact-parameters! a b #:bounce 1))))

;; A thin rod of length 1 and mass 1 comes down on its end, tilted by 60 degrees, without gravity.  By Stronge's
;; law the end slides away at once with friction mu = 0.1 along x, so that along z
;;   p = (1 + e) v/(k_zz - mu k_xz),  k_zz = 1/m + x^2/I,  k_xz = x z/I.
(define (rod-speed law friction slide)
  (in-world ()
    (scene #:gravity #(0 0 0))
    (let* ((angle (acos 0.5))
           (rod (add-body! #:shape (box 1 1e-5 1e-5) #:mass 1 #:inertia #(1e-6 1/12 1/12)
                           #:orientation (rotation #(0 1 0) angle)
                           #:position #(0 0 1) #:velocity (vector slide 0 -1))))
      (add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)
      (set-contact-parameters! #t #t #:restitution 0.5 #:friction friction)
      (when law (set-contact-parameters! rod #t #:impact-law law))
      (run! #:until 0.7)
      (vector-ref (velocity rod) 2))))

(test-group "impact laws"
  (let* ((x (* 1/2 1/2)) (z (* 1/2 (sqrt 3/4)))
         (kzz (+ 1 (* 12 x x))) (kxz (* 12 x z))
         (stronge (+ -1 (/ 1.5 (- kzz (* 0.1 kxz))))))
    (test-approximate "Stronge's law: an end that slides away" stronge (rod-speed 'stronge 0.1 0) 3e-5))
  (let ((default (rod-speed #f 0.5 0.5)))
    (test-assert "where sliding stops the laws differ"
      (> (abs (- default (rod-speed 'stronge 0.5 0.5))) 0.01))
    (test-equal "the default has a name" default (rod-speed 'chatterjee-ruina 0.5 0.5))))

(define (fall disabled?)
  (in-world ()
    (let ((ball (add-body! #:shape (sphere 0.5) #:position #(0 0 2)))
          (floor (ground)))
      (set-contact-parameters! #t #t #:restitution 1)
      (when disabled? (disable-collisions! ball #t))
      (run! #:until 1)
      (vector-ref (position ball) 2))))

(test-assert "a ball bounces off the ground" (> (fall #f) 0.5))
(test-assert "unless collisions are disabled" (close? (fall #t) -2.905 1e-12))

;; Two that passed through each other collide again: not while one is within the other.
(in-world ()
  (let ((one (add-body! #:name "one" #:shape (sphere 0.5) #:position #(0 0 10) #:velocity #(1 0 0)))
        (two (add-body! #:name "two" #:shape (sphere 0.5) #:position #(0.5 0 10) #:velocity #(1 0 0))))
    (disable-collisions! one two)
    (run! #:until 0.1)
    (test-message "who overlap cannot begin to collide"
      "one and two overlap by 0.5 m at 0.1 s, so they cannot collide from now on; expected .* move one"
      (enable-collisions! one two))
    (test-equal "and still pass" #f (third (contact-parameters one two)))
    (enable-collisions! one 'rubber)
    (set! (position two) #(5 0 10))
    (enable-collisions! one two)
    (test-equal "once they are apart they may" #t (third (contact-parameters one two)))))

;; What rests lies as deep as its weight presses it.
(in-world ()
  (let ((floor (ground)) (box (add-body! #:shape (box 0.2 0.2 0.2) #:position #(0 0 0.11))))
    (set-contact-parameters! box floor #:stiffness 1e4)
    (run! #:until 1)
    (test-assert "a soft spring gives way" (< (vector-ref (position box) 2) 0.096))
    (disable-collisions! box floor)
    (enable-collisions! box floor)
    (run! #:until 2)
    (test-assert "off and on again at rest changes nothing"
      (close? (vector-ref (position box) 2) 0.094 2e-3))))

;; ---- contacts at present ----

(in-world ()
  (let* ((floor (ground))
         (box (add-body! #:name "box" #:shape (box 0.2 0.2 0.2) #:mass 5 #:position #(0 0 0.1))))
    (test-equal "before the run there are no contacts" '() (contacts))
    (run! #:until 1)
    (let ((all (contacts)))
      (test-equal "a box on the ground has four" 4 (length all))
      (test-assert "they are contacts" (every contact? all))
      (test-assert "a contact names its bodies, its force and whether it sticks"
        (string-match "^#<contact of [^ ]+ and [^ ]+, [0-9.]+ N(, s(tick|lip)s)?>$"
                      (object->string (car all))))
      (test-assert "nothing else is" (not (any contact? (list 1 "a" '() floor #f))))
      (test-assert "between ground and box" (every (lambda (c) (equal? (contact-bodies c) (list floor box))) all))
      (test-assert "normals point up, from the ground to the box"
        (every (lambda (c) (close? (contact-normal c) #(0 0 1) 1e-9)) all))
      (test-assert "at its lower corners"
        (every (lambda (c)
                 (match (contact-point c)
                   (#(x y z) (and (close? (abs x) 0.1 1e-4) (close? (abs y) 0.1 1e-4) (close? z 0 1e-4)))))
               all))
      (test-assert "their forces carry the weight, N"
        (close? (apply + (map contact-force all)) (* 5 9.81) 0.01))
      (test-assert "they touch, and what was placed touching does not sink"
        (every (lambda (c) (close? (contact-gap c) 0 1e-9)) all))
      (test-assert "no friction on the level" (every (lambda (c) (close? (contact-friction c) #(0 0 0) 1e-3)) all))
      (test-assert "nothing slips" (not (any contact-slipping? all))))
    (test-message "a contact of the wrong type" "the contact is 5; expected one that" (contact-force 5))
    (set! (velocity box) #(0 0 3))
    (run-for! 0.1)
    (test-equal "in the air it has none" '() (contacts))))

(in-world ()
  (ground)
  (set-contact-parameters! #t #t #:friction 0.3)
  (add-body! #:shape (box 0.4 0.4 0.1) #:position #(0 0 0.05) #:velocity #(2 0 0))
  (run! #:until 0.3)
  (let ((loaded (filter (lambda (c) (positive? (contact-force c))) (contacts))))
    (test-assert "a sliding box slips" (and (pair? loaded) (every contact-slipping? loaded)))
    (test-assert "its friction is mu N against the motion"
      (every (lambda (c)
               (close? (vector-ref (contact-friction c) 0) (* -0.3 (contact-force c)) 1e-3))
             loaded))))

;; ---- the torques of rolling and spinning friction ----

(define (ball-on tilt y velocity spin)
  (add-body! #:shape (sphere 0.1) #:position (rotate tilt (vector 0 y 0.1))
             #:velocity velocity #:angular-velocity spin))
(define (torque-on ball)
  (match (contacts #:body ball) ((contact) (contact-torque contact))))

(in-world ()
  (let* ((slope 0.05) (tilt (rotation #(0 1 0) slope)))            ; downhill is +x
    (add-body! #:shape (half-space (rotate tilt #(0 0 1)) 0) #:fixed? #t)
    (set-contact-parameters! #t #t #:rolling-friction 0.02 #:restitution 0)
    (let* ((ball (ball-on tilt 0 #(0 0 0) #(0 0 0)))
           (needed (* 9.81 (body-mass ball) 0.1 (sin slope))))
      (run! #:until 1)
      ;; friction m g sin(a) uphill would set it rolling by r times that
      (test-assert "what rolling friction holds on a slope takes the torque that this needs"
        (close? (torque-on ball) (vector 0 (- needed) 0) (* 1e-3 needed)))
      (run-for! 20)
      (test-assert "at rest, too"
        (close? (torque-on ball) (vector 0 (- needed) 0) (* 1e-3 needed))))))

(in-world ()
  (let ((floor (ground)))
    (set-contact-parameters! #t #t #:rolling-friction 0.004 #:spinning-friction 0.003 #:restitution 0)
    (let* ((rolls (ball-on #(1 0 0 0) 0 #(1 0 0) #(0 10 0)))
           (spins (ball-on #(1 0 0 0) 3 #(0 0 0) #(0 0 30)))
           (weight (* 9.81 (body-mass rolls))))
      (run! #:until 0.2)
      (test-assert "rolling takes the length times the force, against the roll"
        (close? (torque-on rolls) (vector 0 (* -0.004 weight) 0) (* 1e-4 weight)))
      (test-assert "spinning likewise, along the normal"
        (close? (torque-on spins) (vector 0 0 (* -0.003 weight)) (* 1e-4 weight)))
      (test-assert "the first body's is the opposite of the second's: B is what was added later"
        (every (lambda (c) (eq? floor (car (contact-bodies c)))) (contacts)))
      (test-message "of what is no contact" "the contact is 5" (contact-torque 5)))))

(in-world ()
  (ground)
  (let ((box (add-body! #:shape (box 0.2 0.2 0.2) #:position #(0 0 0.1) #:velocity #(1 0 0)
                        #:angular-velocity #(0 0 1))))
    (run! #:until 0.1)
    (test-assert "none where nothing resists rolling or spinning"
      (every (lambda (c) (equal? (contact-torque c) #(0.0 0.0 0.0))) (contacts #:body box)))))

(in-world ()
  (let ((ball (add-body! #:shape (sphere 1))))
    (add-callback! ball (lambda (time ball) (contacts)) #:period 1)
    (test-message "inside a callback" "contacts without #:body was used inside a callback" (run! #:until 1))))

(test-end "contact")
