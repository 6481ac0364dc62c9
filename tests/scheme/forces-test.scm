;; Forces: applied torques, drag, springs and forces by procedures, from Scheme.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "forces")

;; a torque turns a ball evenly faster; a callback changes it
(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((ball (add-body! #:shape (sphere 0.5) #:mass 10))
         (moment (* 0.4 10 0.25)))
    (test-equal "no torque at first" #(0.0 0.0 0.0) (applied-torque ball))
    (set! (applied-torque ball) #(0 0 2))
    (run! #:until 1)
    (test-assert "alpha = T / I" (close? (vector 0 0 (/ 2 moment)) (angular-velocity ball) 1e-6))
    (add-callback! ball (lambda (t view) (set! (applied-torque view) #(0 0 -2)) #f)
                   #:start 2)
    (run! #:until 4)
    (test-assert "a callback turns it back" (close? #(0 0 0) (angular-velocity ball) 1e-6))
    (test-equal "and is read again" #(0.0 0.0 -2.0) (applied-torque ball))))

;; drag: v0 exp(-t c/m)
(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((ball (add-body! #:shape (sphere 0.5) #:mass 2 #:velocity #(3 0 0))))
    (add-drag! ball #:linear 1)
    (run! #:until 2)
    (test-assert "linear drag" (close? (vector (* 3 (exp -1)) 0 0) (velocity ball) 1e-6))
    (test-message "negative drag" "linear drag of body-0 is -1; expected a number of N s/m from 0"
      (add-drag! ball #:linear -1))
    (test-message "drag that is no number" "quadratic is x" (add-drag! ball #:quadratic 'x))))

;; a spring: x = cos(t sqrt(k/m)), its energy is counted
(in-world ()
  (scene #:gravity #(0 0 0))
  (let* ((ball (add-body! #:name "ball" #:shape (sphere 0.1) #:mass 2 #:position #(1 0 0)))
         (post (add-body! #:name "post" #:shape (sphere 0.1) #:fixed? #t #:position #(-5 0 0)))
         (other (add-body! #:name "other" #:shape (sphere 0.1) #:position #(9 0 0))))
    (disable-collisions! #t #t)
    (add-spring! ball post #:stiffness 8 #:rest 5)
    (test-assert "the spring's energy is part of all" (< (abs (- (total-energy) 4)) 1e-12))
    (run! #:until 1)
    (test-assert "it oscillates" (close? (vector (cos 2) 0 0) (position ball) 1e-6))
    (test-assert "energy stays" (< (abs (- (total-energy) 4)) 1e-5))
    (test-message "negative stiffness"
        "stiffness of the spring between ball and post is -1; expected a number of N/m from 0"
      (add-spring! ball post #:stiffness -1))
    (test-message "no stiffness" "stiffness is #f" (add-spring! ball post))
    (test-message "both ends on one body" "both ends on one body"
      (add-spring! ball ball #:stiffness 1))
    (test-message "no body" "the second body" (add-spring! ball 'post #:stiffness 1))))

;; a procedure: force, or force and torque
(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((ball (add-body! #:shape (sphere 0.5) #:mass 1 #:position #(1 0 0)))
        (top (add-body! #:shape (sphere 0.5) #:mass 1 #:position #(9 0 0))))
    (add-force! ball (lambda (t view) (vector (- (vector-ref (position view) 0)) 0 0)))
    (add-force! top (lambda (t view) (values #(0 0 0) (vector 0 0 t))))
    (run! #:until 1)
    (test-assert "a force of place" (close? (vector (cos 1) 0 0) (position ball) 1e-6))
    (test-assert "a torque of time" (close? #(0 0 5) (angular-velocity top) 1e-5))))

(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:mass 1)))
    (test-message "no procedure" "expected a procedure" (add-force! ball 5))
    (add-force! ball (lambda (t view) (if (< t 1) #(1 0 0) (vector-ref #(1) 7))))
    (test-message "an error in it is told with body and time" "in the force on ball at"
      (run! #:until 3))
    (test-assert "the run stops where it began" (<= 0 (world-time) 1))))

(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:mass 1)))
    (add-force! ball (lambda (t view) 'strong))
    (test-message "what is no force" "returned a wrong force" (run! #:until 3))))

(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:mass 1)))
    (add-force! ball (lambda (t view) (set! (velocity view) #(1 0 0)) #(0 0 0)))
    (test-message "it looks only" "changed in a force's procedure" (run! #:until 3))))

;; What a run has made final stays so when the next one fails at once: bodies whose states before
;; that are gone are changed all the same, and the one that failed goes on with another force.
(in-world ()
  (let ((fails (add-body! #:shape (sphere 0.2)))
        (ticked (add-body! #:shape (sphere 0.2) #:position #(4 0 0)))
        (wrong? #t))
    (add-callback! ticked (const #f) #:period 0.01)
    (run! #:until 0.01)
    (add-force! fails (lambda (time view) (if wrong? 1 #(0 0 0))))
    (test-message "a wrong force" "returned a wrong force" (run! #:until 0.1))
    (set! (velocity ticked) #(1 0 0))
    (test-equal "another body is changed" #(1.0 0.0 0.0) (velocity ticked))
    (set! wrong? #f)
    (set! (velocity fails) #(1 0 0))
    (run! #:until 0.11)
    (test-assert "the one that failed goes on"
      (close? 0.1 (vector-ref (position fails) 0) 1e-12))))

(test-end "forces")
