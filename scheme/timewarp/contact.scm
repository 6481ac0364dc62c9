;; Contact parameters, which pairs collide, and the contacts at present.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp contact)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (srfi srfi-9)
  #:use-module (srfi srfi-9 gnu)
  #:use-module (ice-9 format)
  #:export (set-contact-parameters! contact-parameters disable-collisions! enable-collisions!
            contacts contact? contact-bodies contact-point contact-normal contact-gap contact-force
            contact-friction contact-slipping? contact-torque))

(define-keyword-procedure
  (set-contact-parameters! a b #:key restitution friction rolling-friction spinning-friction
                           stiffness damping fusion-speed friction-law impact-law)
  "Set what holds where A and B touch; each is a body, a multibody (for each of its links), a material
(a symbol), or #t for all.  Looked up keyword by keyword: a body goes before a material, a material before #t, the later call before
the earlier.

#:restitution   the share of the approach speed that is left after an impact, 0 to 1; 0.3
#:friction      Coulomb's coefficient, 0 or more; 0.5
#:rolling-friction   m, 0 or more: lasting contacts resist rolling by a torque of up to the normal
                force times this, and hold what needs no more: a ball of radius r stays on slopes
                up to this over r; 0
#:spinning-friction  m, 0 or more: likewise spinning about the normal, beside what the friction of
                several points does; 0
#:stiffness     N/m of a lasting contact, positive; such that the weight of the lighter body
                compresses it by 2.5e-4 of the smaller size (less in groups of unequal masses).  The
                points of two parts share it, as many as there are, so that without damping a soft
                contact gains energy where their number changes; at twice that depth it has doubled
#:damping       s/m of a lasting contact, 0 or more; such that it oscillates at half the critical
                damping
#:fusion-speed  m/s, 0 or more: an impact that leaves less becomes a lasting contact; 0.07 sqrt(g
                size)
#:friction-law  'anchored (a spring holds what sticks) or 'smooth; 'anchored
#:impact-law    'chatterjee-ruina (one formula), or 'stronge: the impact is followed, sliding,
                sticking and turning back included, and restitution gives the square of it of the
                work that compression took; 'chatterjee-ruina"
  (let ((settings (filter cdr `((restitution . ,restitution) (friction . ,friction)
                                (rolling-friction . ,rolling-friction)
                                (spinning-friction . ,spinning-friction)
                                (stiffness . ,stiffness) (damping . ,damping)
                                (fusion-speed . ,fusion-speed) (friction-law . ,friction-law)
                                (impact-law . ,impact-law)))))
    (set-contact! a b settings)))

(define (set-contact! a b settings)
  (%set-contact! (current-world) a b settings)
  (if #f #f))

(define (contact-parameters a b)
  "Return the restitution, the friction, whether they collide, and the lengths of rolling and spinning
friction, m, for the bodies A and B, as a list of five.  Bodies collide where both have shapes, one of
them is dynamic, disable-collisions! does not say otherwise, and no joint joins them, unless
enable-collisions! names both."
  (%contact-parameters (current-world) a b))

(define (disable-collisions! a b)
  "Let A and B pass through each other; each is a body, a multibody (for each of its links; both the
same: its links pass through each other), a material, or #t for all."
  (set-contact! a b '((collide? . #f))))

(define (enable-collisions! a b)
  "Let A and B collide again; each is a body, a multibody (for each of its links), a material, or #t
for all.  Bodies that a joint joins collide only where both are named here as bodies: a clapper in its
bell, a lid on its box.  It is an error if two that passed through each other until now overlap."
  (set-contact! a b '((collide? . #t))))

;; ---- contacts at present ----

(define-record-type <contact>
  (make-contact bodies point normal gap force friction slipping? torque)
  a-contact?
  (bodies bodies-of)
  (point point-of)
  (normal normal-of)
  (gap gap-of)
  (force force-of)
  (friction friction-of)
  (slipping? slipping-of?)
  (torque torque-of))

(set-record-type-printer! <contact>
  (lambda (contact port)
    (let ((force (force-of contact)))
      (apply format port "#<contact of ~a and ~a, ~,4f N~a>"
             (append (map %body-name (bodies-of contact))
                     (list force
                           (cond ((zero? force) "")
                                 ((slipping-of? contact) ", slips")
                                 (else ", sticks"))))))))

(define-keyword-procedure (contacts #:key body)
  "Return a list of the contacts of all contact groups at world-time, by pairs of bodies in the order in
which they were added; faces that meet have several.  Impacts of bodies that don't stay together are no
contacts; a contact whose force is 0 is about to touch, or has just lost touch.  In a callback, those
of one of the views that it is handed, which #:body must name: as they were on the motion that leads to
its event, so in on-collision! just before the impact.  While a blow runs through a heap, a body further
on has the forces that its own motion is made of.

#:body  a body or a view: its contacts alone (of views: of a dynamic body); all"
  (map (lambda (parts) (apply make-contact parts)) (%contacts (current-world) body)))

(define (contact? object)
  "Return #t if OBJECT is a contact, as `contacts' lists them."
  (a-contact? object))

(define (part contact part-of)
  (unless (a-contact? contact) (bad-value "the contact" contact "one that `contacts' lists"))
  (part-of contact))

(define (contact-bodies contact)
  "Return the list of the two bodies A and B of CONTACT; A was added first."
  (part contact bodies-of))

(define (contact-point contact)
  "Return the point at which the force of CONTACT acts, world frame, m."
  (part contact point-of))

(define (contact-normal contact)
  "Return the unit normal of CONTACT from A to B, world frame."
  (part contact normal-of))

(define (contact-gap contact)
  "Return the gap of CONTACT, m: negative where the contact spring is compressed by so much."
  (part contact gap-of))

(define (contact-force contact)
  "Return the normal force of CONTACT, N: never negative; it pushes B along the normal, and A back."
  (part contact force-of))

(define (contact-friction contact)
  "Return the friction of CONTACT on B, a vector in the world frame, N."
  (part contact friction-of))

(define (contact-slipping? contact)
  "Return #t where CONTACT touches with its friction at the limit, #f where it sticks or doesn't touch."
  (part contact slipping-of?))

(define (contact-torque contact)
  "Return the torque of CONTACT on B by which #:rolling-friction and #:spinning-friction resist, a vector in
the world frame, N m; A has its opposite.  Along the normal it is that against spinning, across it that
against rolling; the torques of normal force and friction about anything come on top."
  (part contact torque-of))
