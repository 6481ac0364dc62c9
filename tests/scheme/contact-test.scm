;; Contact parameters: how they are looked up, and which pairs collide.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "contact")

(in-world ()
  (let ((a (add-body! #:name "a" #:shape (sphere 1) #:material 'rubber))
        (b (add-body! #:name "b" #:shape (sphere 1) #:position #(5 0 0) #:material 'steel)))
    (test-equal "defaults" '(0.3 0.5 #t) (contact-parameters a b))
    (set-contact-parameters! #t #t #:restitution 0.1 #:friction 0.1)
    (test-equal "for all" '(0.1 0.1 #t) (contact-parameters a b))
    (set-contact-parameters! 'rubber #t #:restitution 0.2)
    (test-equal "a material goes before all, keyword by keyword" '(0.2 0.1 #t) (contact-parameters a b))
    (set-contact-parameters! a #t #:restitution 0.9)
    (set-contact-parameters! 'rubber 'steel #:restitution 0.4)
    (test-equal "a body goes before a pair of materials" '(0.9 0.1 #t) (contact-parameters b a))
    (set-contact-parameters! #t a #:restitution 0.8)
    (test-equal "at ties the later call holds" '(0.8 0.1 #t) (contact-parameters a b))
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
    (test-message "unknown keyword" "unknown keyword #:bounce; expected one of #:restitution"
      (set-contact-parameters! a b #:bounce 1))))

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

(test-end "contact")
