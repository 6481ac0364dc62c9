;; Contact parameters, and which pairs collide.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp contact)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:export (set-contact-parameters! contact-parameters disable-collisions! enable-collisions!))

(define-keyword-procedure
  (set-contact-parameters! a b #:key restitution friction stiffness damping fusion-speed
                           friction-law impact-law)
  "Set what holds where A and B touch; each is a body, a material (a symbol), or #t for all.  Looked up
keyword by keyword: a body goes before a material, a material before #t, the later call before the
earlier.  Defaults: restitution 0.3, friction 0.5."
  (%set-contact! (current-world) a b
                 (let loop ((names '(restitution friction stiffness damping fusion-speed
                                                 friction-law impact-law))
                            (values (list restitution friction stiffness damping fusion-speed
                                          friction-law impact-law)))
                   (cond ((null? names) '())
                         ((car values) (acons (car names) (car values)
                                              (loop (cdr names) (cdr values))))
                         (else (loop (cdr names) (cdr values)))))))

(define (contact-parameters a b)
  "Return the restitution, the friction and whether they collide for the bodies A and B, as a list."
  (%contact-parameters (current-world) a b))

(define (disable-collisions! a b)
  "Let A and B pass through each other; each is a body, a material, or #t for all."
  (%set-contact! (current-world) a b '((collide? . #f))))

(define (enable-collisions! a b)
  "Let A and B collide again; each is a body, a material, or #t for all."
  (%set-contact! (current-world) a b '((collide? . #t))))
