;; Bodies: adding them, their motion by keyframes, and reading and changing their states.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp bodies)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (ice-9 match)
  #:export (add-body! remove-body! keyframes
            body? view? body-name body-mass body-kind view-body
            position orientation velocity angular-velocity kinetic-energy
            slot slot? applied-force applied-torque random-real!))

;; ---- adding ----

(define body-keywords
  '(#:name #:shape #:density #:mass #:inertia #:center-of-mass #:position #:orientation #:velocity
    #:angular-velocity #:fixed? #:motion #:max-speed #:material #:color #:slots #:visible? #:visual))

(define* (add-body! #:key name shape density mass inertia center-of-mass position orientation
                    velocity angular-velocity fixed? motion max-speed material color slots visible?
                    visual #:allow-other-keys #:rest given)
  "Add a body to the current world and return it.  Without a mass or an inertia, its mass properties
come from the shape and the density.

#:shape       what sphere, box, ... return; #f for a body that touches nothing and is given
              #:mass, #:inertia and #:center-of-mass.  The only keyword that must be there
#:name        a string that no other body has; body-N
#:density     kg/m^3, positive; 1000
#:mass        kg, positive: the shape's inertia is scaled to it; volume times density
#:inertia     kg m^2 about the centre of mass, body axes: principal moments #(Ixx Iyy Izz) or a
              matrix as three rows; the shape's
#:center-of-mass  m, a point #(x y z) of the body's frame; the shape's centroid
#:position    m, of the origin of the body's frame; #(0 0 0)
#:orientation a quaternion #(w x y z), made a unit one; #(1 0 0 0)
#:velocity    m/s, of the centre of mass; #(0 0 0)
#:angular-velocity  rad/s, world frame; #(0 0 0)
#:fixed?      #t: it never moves; #f
#:motion      makes the body kinematic: what keyframes returns, or a procedure of the time (s)
              that returns a position and an orientation (two values) and depends on nothing
              else; #f.  It is called a sixteenth of a second or more ahead, some 300 times a
              second, oftener where it is not smooth
#:max-speed   m/s, with a procedure as #:motion, and needed there: no point of the surface is
              faster, which is verified; so a jump is an error
#:material    a symbol that set-contact-parameters! can name; none
#:color       #(r g b), sRGB, 0 to 1; chosen for each body
#:slots       an alist of names (symbols) and values, which callbacks can change; ()
#:visible?    #f: it is not drawn; #t
#:visual      what is drawn of it, and touches nothing: what load-visual returns, a shape, or a list of
              such; #:shape"
  (check-keywords 'add-body! given body-keywords)
  (let ((shape? (memq #:shape given)))
    (unless shape?
      (raise-error (string-append "add-body! got no #:shape; expected a shape, or #:shape #f for a "
                                  "body that touches nothing")))
    (%add-body! (current-world)
                (body-properties given (body-motion motion name max-speed shape))
                (caller-place))))

(define (remove-body! body)
  "Take BODY out of the current world, between runs: it touches nothing from now on, what lay on it
falls, and callbacks that have it among their targets end.  Its name may be given again; using BODY
after this is an error.  Links of multibodies cannot be removed."
  (%remove-body! (current-world) body))

;; The motion of the body as the C++ side wants it, or #f.
(define (body-motion motion name max-speed shape)
  (if (procedure? motion)
      (%procedure-motion motion name max-speed shape)
      (begin
        (when max-speed
          (raise-error "add-body! got #:max-speed; expected it only where #:motion is a procedure"))
        motion)))

;; Keywords to an alist of properties; a keyword given #f counts as absent, except visible?.
(define (body-properties given motion)
  (match given
    (() '())
    ((keyword value . rest)
     (let ((properties (body-properties rest motion)))
       (cond ((eq? keyword #:max-speed) properties)
             ((eq? keyword #:motion) (if motion (acons 'motion motion properties) properties))
             ((or value (eq? keyword #:visible?))
              (acons (keyword->symbol keyword) value properties))
             (else properties))))))

(define-keyword-procedure (keyframes list #:key smooth?)
  "Return a motion for add-body! through the keyframes LIST: ((TIME POSITION [ORIENTATION]) ...),
times in s, increasing, positions in m, orientations quaternions #(w x y z).  The body rests
before the first and after the last.

#:smooth?  #f: straight lines at constant velocity and angular velocity; #t: the same path at
           minimum jerk, at rest at every keyframe; #f"
  (%keyframes list smooth?))

;; ---- asking ----

(define (of-class? object class)
  (and (struct? object) (eq? (struct-vtable object) class)))

(define (body? object)
  "Return #t if OBJECT is a body."
  (of-class? object <body>))

(define (view? object)
  "Return #t if OBJECT is a view, as callbacks are handed."
  (of-class? object <view>))

(define (body-name body)
  "Return the name of BODY, a body or a view."
  (%body-name body))

(define (body-mass body)
  "Return the mass of BODY, a body or a view, in kg."
  (%body-mass body))

(define (body-kind body)
  "Return what kind of body BODY is: dynamic, fixed or kinematic."
  (%body-kind body))

(define (view-body view)
  "Return the body that VIEW looks at."
  (%view-body view))

;; ---- states: accessors with set! ----

(define-syntax-rule (define-accessor accessor doc getter setter)
  (define accessor
    (let ((getter* (lambda (body) doc (getter body))))
      (set-procedure-property! getter* 'name 'accessor)
      (make-procedure-with-setter getter* (lambda (body value) (setter body value))))))

(define-accessor position
  "Return the position of the body frame's origin of BODY, a body or a view, in metres.
(set! (position BODY) #(x y z)) moves a body between runs; one that is fixed stays where it is, an error."
  %position %set-position!)

(define-accessor orientation
  "Return the orientation of the body frame of BODY, a body or a view, as #(w x y z).
(set! (orientation BODY) #(w x y z)) turns a body between runs, but not a fixed one."
  %orientation %set-orientation!)

(define-accessor velocity
  "Return the velocity of the centre of mass of BODY, a body or a view, in m/s; with set!."
  %velocity %set-velocity!)

(define-accessor angular-velocity
  "Return the angular velocity of BODY, a body or a view, in rad/s, world frame; with set!."
  %angular-velocity %set-angular-velocity!)

(define-accessor applied-force
  "Return the force applied at the centre of mass of BODY, a body or a view, in N, world frame; with
set!.  It stays constant until it is changed."
  %applied-force %set-applied-force!)

(define-accessor applied-torque
  "Return the torque applied to BODY, a body or a view, about its centre of mass, in N m, world frame;
with set!.  It stays constant until it is changed."
  %applied-torque %set-applied-torque!)

(define (kinetic-energy body)
  "Return the kinetic energy of BODY, a body or a view, in J."
  (%kinetic-energy body))

(define slot
  (let ((slot (lambda (body name)
                "Return the value of the slot NAME (a symbol) of BODY, a body or a view; with set!.
Values are numbers, booleans, symbols, keywords, characters, strings, bodies, and lists and vectors
of such: set! copies them, and what is read is not to be changed in place (--check looks).  A slot
that the body lacks is an error."
                (%slot body name))))
    (make-procedure-with-setter
     slot
     (lambda (body name value) (%set-slot! body name value)))))

(define (slot? body name)
  "Return #t if BODY, a body or a view, has a slot called NAME."
  (%slot? body name))

(define (random-real! body)
  "Draw a number from [0, 1) from the generator that lives in the state of BODY, a view or a body."
  (%random-real! body))
