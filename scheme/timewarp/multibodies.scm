;; Multibodies: links and joints, how the joints stand and what drives them, kinematics and dynamics.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp multibodies)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp near-names)
  #:use-module ((timewarp files) #:select (beside-caller note-file-read scene-file tell-mended))
  #:use-module (timewarp worlds)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:use-module (oop goops)
  #:use-module (srfi srfi-1)
  #:use-module (srfi srfi-9)
  #:use-module (srfi srfi-9 gnu)
  #:export (add-multibody! load-urdf multibody? multibody-name multibody-links body-multibody link-body
            find-multibody world-multibodies
            link? joint? revolute prismatic universal spherical weld
            joint-names joint-limits joint-max-torque joint-max-velocity
            joint-position joint-velocity joint-torque joint-servo
            joint-positions joint-velocities joint-torques
            servo servo? servo-target servo-target-velocity servo-stiffness servo-damping
            servo-max-torque
            jacobian forward-kinematics inverse-kinematics inverse-dynamics)
  ;; for the other modules
  ;; beside the system call
  #:replace (link))

;; ---- joints ----

;; PROPERTIES: an alist for the C++ side.
(define-record-type <joint>
  (make-joint kind properties)
  a-joint?
  (kind joint-kind)
  (properties joint-properties))

(set-record-type-printer! <joint>
  (lambda (joint port) (format port "#<joint ~a>" (joint-kind joint))))

(define (joint? object)
  "Return #t if OBJECT is a joint, as `revolute', `prismatic', `universal', `spherical' and `weld'
return."
  (a-joint? object))

(define-syntax-rule (define-joint (name keyword ...) doc)
  (define-keyword-procedure (name #:key keyword ...)
    doc
    (make-joint 'name (filter cdr (list (cons 'keyword keyword) ...)))))

(define-joint (revolute axis at orientation limits damping friction stiffness rest restitution
                        stop-stiffness)
  "Return a joint that turns about an axis: its position is an angle, rad.

#:axis         #(x y z) in the joint's frame, of any length; #(0 0 1)
#:at           m, where the joint is in the frame of the parent link, or of the base; #(0 0 0)
#:orientation  of the joint's frame there, a quaternion #(w x y z); #(1 0 0 0)
#:limits       (LOWER UPPER), rad; none.  The joint begins at 0, or at the limit nearest to it
#:damping      N m s/rad, 0 or more; 0
#:friction     N m, 0 or more: the torque against the motion; what it holds creeps by um/s; 0
#:stiffness    N m/rad, of a spring, 0 or more; 0
#:rest         rad, where the spring is relaxed; 0
#:restitution  the share of the speed that is left after a stop is struck, 0 to 1; 0
#:stop-stiffness  N m/rad, of the stops at the limits; from the weight of what hangs on the joint")

(define-joint (prismatic axis at orientation limits damping friction stiffness rest restitution
                         stop-stiffness)
  "Return a joint that slides along an axis: its position is a distance, m.

#:axis         #(x y z) in the joint's frame, of any length; #(0 0 1)
#:at           m, where the joint is in the frame of the parent link, or of the base; #(0 0 0)
#:orientation  of the joint's frame there, a quaternion #(w x y z); #(1 0 0 0)
#:limits       (LOWER UPPER), m; none.  The joint begins at 0, or at the limit nearest to it
#:damping      N s/m, 0 or more; 0
#:friction     N, 0 or more: the force against the motion; what it holds creeps by um/s; 0
#:stiffness    N/m, of a spring, 0 or more; 0
#:rest         m, where the spring is relaxed; 0
#:restitution  the share of the speed that is left after a stop is struck, 0 to 1; 0
#:stop-stiffness  N/m, of the stops at the limits; from the weight of what hangs on the joint")

(define-joint (universal axis second-axis at orientation limits damping friction stiffness rest
                         restitution stop-stiffness)
  "Return a joint that turns about two axes that cross: first about one that is fixed in the parent
link, then about one that is fixed in the link.  Its position is two angles #(a b), rad.

#:axis         the first, #(x y z) in the joint's frame; #(0 0 1)
#:second-axis  the second, square to the first; #(0 1 0)
#:at           m, where the joint is in the frame of the parent link, or of the base; #(0 0 0)
#:orientation  of the joint's frame there, a quaternion #(w x y z); #(1 0 0 0)
#:limits       (LOWER UPPER) of both angles, or a list of two such, rad; none
#:damping      N m s/rad, 0 or more, of both or #(a b); 0
#:friction     N m, 0 or more, of both or #(a b); 0
#:stiffness    N m/rad, of a spring, 0 or more, of both or #(a b); 0
#:rest         rad, where the spring is relaxed, of both or #(a b); 0
#:restitution  the share of the speed that is left after a stop is struck, of both or #(a b); 0
#:stop-stiffness  N m/rad, of the stops; from the weight of what hangs on the joint")

(define-joint (spherical axis at orientation limits damping friction stiffness rest restitution
                         stop-stiffness)
  "Return a joint that turns about a point: its position is a quaternion #(w x y z), its velocity the
angular velocity #(x y z), rad/s, in the link's frame.

#:axis         #(x y z) in the joint's frame: #:limits is of how far it may swing from where it is at
               #(1 0 0 0), in a cone, and turning about it is free; #f: of all turning (which a thin
               link that may turn about itself strikes again and again: many short steps)
#:at           m, where the joint is in the frame of the parent link, or of the base; #(0 0 0)
#:orientation  of the joint's frame there, a quaternion #(w x y z); #(1 0 0 0)
#:limits       an angle, 0.001 to 3 rad; none
#:damping      N m s/rad, 0 or more; 0
#:friction     N m, 0 or more: the torque against the motion; what it holds creeps by um/s; 0
#:stiffness    N m, of a spring whose torque is stiffness times the sine of the angle; 0
#:rest         a quaternion, where the spring is relaxed; #(1 0 0 0)
#:restitution  the share of the speed that is left after the stop is struck, 0 to 1; 0
#:stop-stiffness  N m/rad, of the stop at the limit; from the weight of what hangs on the joint")

(define-joint (weld at orientation)
  "Return a joint that does not move: the link is part of its parent, or of the base.

#:at           m, where the link's frame is in that of the parent link, or of the base; #(0 0 0)
#:orientation  of the link's frame there, a quaternion #(w x y z); #(1 0 0 0)")

;; ---- links ----

(define-record-type <link>
  (make-link name joint properties children)
  a-link?
  (name link-name)
  (joint link-joint)
  (properties link-properties)
  (children link-children))

(set-record-type-printer! <link>
  (lambda (link port)
    (let ((joint (link-joint link)) (children (length (link-children link))))
      (format port "#<link ~a~a~a>" (link-name link)
              (if joint (format #f " ~a" (joint-kind joint)) "")
              (if (zero? children) "" (format #f ", ~a on it" children))))))

(define (link? object)
  "Return #t if OBJECT is a link, as `link' returns."
  (a-link? object))

(define link-keywords
  '(#:joint #:shape #:density #:mass #:inertia #:center-of-mass #:color #:material #:slots
    #:visible? #:visual))

;; The keywords with their values at the beginning of ARGUMENTS, and the links after them, of which
;; some may be in lists.
(define (split-arguments who arguments)
  (let loop ((rest arguments) (keywords '()))
    (match rest
      (((? keyword? keyword) value . rest) (loop rest (cons* value keyword keywords)))
      (((? keyword? keyword)) (loop '() (cons keyword keywords)))
      (_ (values (reverse keywords) (links-among who rest))))))

(define (links-among who objects)
  (append-map (lambda (object)
                (cond ((a-link? object) (list object))
                      ((and (list? object) (every a-link? object)) object)
                      (else (bad-value (format #f "a part of ~a" who) object
                                       "a link, as (link NAME ...) returns"))))
              objects))

(define (name? object) (or (symbol? object) (string? object)))

(define* (link name #:key joint shape density mass inertia center-of-mass color material slots
               visible? visual #:allow-other-keys #:rest given)
  "Return a link for add-multibody!, and whatever hangs on it: after the keywords come further links,
or lists of them.  Its frame is that of its joint: where the joint is at 0, the link's frame is the
joint's, in the parent's.  Shapes are put into it by `placed'.  It becomes a body called
MULTIBODY/NAME.  NAME, a symbol or a string, is also the name of its joint.

#:joint   what revolute, prismatic, universal, spherical or weld return.  Must be there, but for the
          first link of a free multibody, which has none
#:shape   as of add-body!; a link without one touches nothing and is given #:mass, #:inertia and
          #:center-of-mass
#:density   kg/m^3, positive; 1000
#:mass      kg, positive: the shape's inertia is scaled to it; volume times density
#:inertia   kg m^2 about the centre of mass, axes of the link: principal moments #(Ixx Iyy Izz) or a
            matrix as three rows; the shape's
#:center-of-mass  m, a point #(x y z) of the link's frame; the shape's centroid
#:color     #(r g b), sRGB, 0 to 1; chosen for each link
#:material  a symbol that set-contact-parameters! can name; none
#:slots     an alist of names (symbols) and values, which callbacks can change; ()
#:visible?  #f: it is not drawn; #t
#:visual    what is drawn of it, and touches nothing, as of add-body!; #:shape"
  (call-with-values (lambda () (split-arguments 'link given))
    (lambda (keywords children)
      (check-keywords 'link keywords link-keywords)
      (unless (name? name) (bad-value "the name of a link" name "a symbol or a string"))
      (when (and joint (not (a-joint? joint)))
        (bad-value (format #f "the joint of the link ~a" name) joint
                   "a joint, as (revolute) returns"))
      (make-link name joint (link-alist keywords) children))))

(define (link-alist keywords)
  (match keywords
    (() '())
    ((#:joint _ . rest) (link-alist rest))
    ((keyword value . rest)
     (if (or value (eq? keyword #:visible?))
         (acons (keyword->symbol keyword) value (link-alist rest))
         (link-alist rest)))))

;; ((NAME PARENT JOINT PROPERTIES) ...), parents first.
(define (flatten-links links parent free?)
  (append-map
   (lambda (link)
     (let ((joint (link-joint link)) (name (link-name link)))
       (when (and joint free? (not parent))
         (raise-error
          (format #f "the first link ~a of a free multibody has a joint, ~a; expected none"
                  name (joint-kind joint))))
       (unless (or joint (and free? (not parent)))
         (raise-error
          (format #f "the link ~a has no #:joint; expected what revolute, prismatic, universal, ~
spherical or weld return" name)))
       (cons (list name parent
                   (and joint (cons (joint-kind joint) (joint-properties joint)))
                   (link-properties link))
             (flatten-links (link-children link) name free?))))
   links))

;; ---- multibodies ----

(define multibody-keywords '(#:name #:base #:position #:orientation))

(define* (add-multibody! #:key name base position orientation #:allow-other-keys #:rest given)
  "Add a multibody to the current world and return it: after the keywords come its links.  Each link
is a body called NAME/LINK.  Links that a joint joins don't touch each other, nor does the first link
touch the base's body.  A multibody stands for its first link where a body is expected.

#:name      a symbol or a string that no other multibody has; multibody-N
#:base      what the first links hang on: 'fixed, the world; a body that is fixed or kinematic, and
            carries them along; 'free, nothing: then there is one first link, which has no joint,
            and is what moves about; 'fixed
#:position  m, of the base, or of a free first link's frame; in the frame of the base's body, if
            there is one; #(0 0 0)
#:orientation  of the same, a quaternion #(w x y z); #(1 0 0 0)"
  (call-with-values (lambda () (split-arguments 'add-multibody! given))
    (lambda (keywords links)
      (check-keywords 'add-multibody! keywords multibody-keywords)
      (let* ((free? (eq? base 'free))
             (flat (flatten-links links #f free?))
             (world (current-world))
             (multibody (%add-multibody! world name (or base 'fixed) position orientation flat
                                         (caller-place))))
        (set! (given-names multibody) (map car flat))
        multibody))))

(define-keyword-procedure
  (load-urdf file #:key name base position orientation strict? package-path (self-collisions? #t))
  "Add the robot that the URDF file FILE describes to the current world, and return it, a multibody,
or, where nothing of it can move, a fixed body.  FILE is looked for beside the file that the call
stands in, then beside the scene that is being loaded, then in the current folder.

Links are called as in the file, by symbols, and so are joints; a joint may be named by the link that
it moves as well.  A link without a mass that is fixed to another becomes a part of that, one that is
fixed to a base that stands a fixed body.  What <collision> says touches, a mesh as its convex hull; what
<visual> says is drawn, meshes with the colours of their materials.  Damping, friction and limits
of joints are taken; <limit>'s effort is the #:max-torque of servos that are given none.  A joint with
<mimic> follows the one that it names, exactly: torques and servos of both drive them together.

What is wrong in the file but clear is mended, and told by a warning with file and line each: <inertia>
that no body has, or that is missing; what moves and has no mass; limits in the wrong order; a <visual>
that cannot be read.  What cannot be read else, or not be expressed, is an error.

#:name      of the multibody; that of the robot, with a number where it is taken
#:base      what the first link stands on: 'fixed, the world; a body that is fixed or, where nothing
            is fixed to the base, kinematic; 'free, nothing; 'free for a robot without joints that
            move, 'fixed for others
#:position  m, of the first link's frame, in that of the base's body if there is one; #(0 0 0)
#:orientation  of the same, a quaternion #(w x y z); #(1 0 0 0)
#:strict?   #t: what is wrong is an error, and nothing is mended; #f
#:package-path  a folder, or a list of folders, in which package://NAME/... lies, in a folder NAME, or
            which are that folder themselves; then the folders above FILE are tried, then the
            environment's ROS_PACKAGE_PATH
#:self-collisions?  whether links may touch each other, but for those that a joint joins and those
            that overlap where the joints begin; #t"
  (let* ((place (caller-place))
         (found (beside-caller file place))
         (made (%load-urdf (current-world) found name base position orientation place strict?
                           (map scene-file (folders package-path)) self-collisions?)))
    (note-file-read found)
    (match made
      ((robot names notes)
       (tell-mended notes)
       (when (multibody? robot) (set! (given-names robot) names))
       robot))))

(define (folders path)
  (cond ((not path) '())
        ((string? path) (list path))
        ((and (list? path) (every string? path)) path)
        (else (bad-value "package-path" path "a folder, or a list of folders"))))

;; Of each multibody, the names of its joints, by link, as they were given.
(define given-names (make-object-property))

(define (multibody? object)
  "Return #t if OBJECT is a multibody."
  (and (struct? object) (eq? (struct-vtable object) <multibody>)))

(define (multibody-name multibody)
  "Return the name of MULTIBODY."
  (%body-name (%multibody multibody)))

(define (multibody-links multibody)
  "Return the list of the links of MULTIBODY, bodies, parents first."
  (%multibody-links (%multibody multibody)))

(define (body-multibody body)
  "Return the multibody of which BODY, a body or a view, is a link, or #f."
  (and (%link? body) (%multibody body)))

(define (link-body multibody name)
  "Return the body that is the link NAME of MULTIBODY."
  (%link-body (%multibody multibody) name))

(define (find-multibody name)
  "Return the multibody called NAME in the current world; it is an error if there is none."
  (or (%find-multibody (current-world) name)
      (bad-value "the name" name
                 (string-append "the name of a multibody of the current world"
                                (meant name (map multibody-name (world-multibodies)))))))

(define (world-multibodies)
  "Return the list of all multibodies of the current world, in the order in which they were added."
  (%world-multibodies (current-world)))

;; ---- joints of a multibody ----

;; ((NAME KIND LIMITS) ...) of the joints that move, the names as they were given.
(define (moving-joints multibody)
  (let* ((multibody (%multibody multibody))
         (joints (%multibody-joints multibody))
         (given (given-names multibody)))
    (filter-map (lambda (name joint)
                  (and (not (eq? (cadr joint) 'weld)) (cons name (cdr joint))))
                given joints)))

(define (joint-names multibody)
  "Return the list of the names of the joints of MULTIBODY that move, as they were given, in the order
of their positions in (joint-positions MULTIBODY).  A free multibody's first is its first link."
  (map car (moving-joints multibody)))

(define (joint-limits multibody name)
  "Return the limits of the joint NAME of MULTIBODY as a list (LOWER UPPER), rad or m, infinite where
there are none; of a universal joint a list of two such; of a spherical one the greatest angle, rad;
#f of other joints."
  (caddr (list-ref (%multibody-joints multibody) (%joint-index multibody name))))

(define (drive-of multibody name which)
  (let ((found (which (list-ref (%multibody-joints multibody) (%joint-index multibody name)))))
    (and (number? found) found)))

(define (joint-max-torque multibody name)
  "Return the most that drives the joint NAME of MULTIBODY, N m or N, as the effort of a URDF file's
<limit> says, infinite where nothing does; #f of joints that nothing can drive.  Servos that are given
no #:max-torque have it."
  (drive-of multibody name cadddr))

(define (joint-max-velocity multibody name)
  "Return how fast the joint NAME of MULTIBODY is meant to go, rad/s or m/s, as the velocity of a URDF
file's <limit> says, infinite where nothing does; #f of joints that nothing can drive.  Nothing
enforces it."
  (drive-of multibody name fifth))

(define-syntax-rule (define-joint-accessor (accessor argument ...) doc getter setter)
  (define accessor
    (let ((getter* (lambda (argument ...) doc (getter argument ...))))
      (set-procedure-property! getter* 'name 'accessor)
      (make-procedure-with-setter getter*
                                  (lambda (argument ... value) (setter argument ... value))))))

(define-joint-accessor (joint-position multibody name)
  "Return the position of the joint NAME of MULTIBODY, a multibody, a link of one, or a view of a link:
an angle, rad, or a distance, m; of a universal joint two angles #(a b); of a spherical one a quaternion
#(w x y z), of the link in the joint's frame; of a free first link #(x y z qw qx qy qz), of its frame in
the world.  (set! (joint-position MULTIBODY NAME) VALUE) moves it between runs."
  %joint-position %set-joint-position!)

(define-joint-accessor (joint-velocity multibody name)
  "Return the velocity of the joint NAME of MULTIBODY, a multibody, a link of one, or a view of a link:
rad/s or m/s; of a universal joint #(a b); of a spherical one the angular velocity #(x y z) in the
link's frame; of a free first link #(vx vy vz wx wy wz), of its frame's origin, world frame; with
set!."
  %joint-velocity %set-joint-velocity!)

(define-joint-accessor (joint-torque multibody name)
  "Return the torque, N m, or force, N, that was given to the joint NAME of MULTIBODY, a multibody, a
link of one, or a view of a link; with set!.  It stays constant until it is changed, and acts beside the
joint's damping, friction, spring and servo.  Of a universal joint #(a b); of a spherical one #(x y z) in
the link's frame."
  %joint-torque %set-joint-torque!)

(define-joint-accessor (joint-positions multibody)
  "Return the positions of all joints of MULTIBODY, a multibody, a link of one, or a view of a link, as
one vector: those that joint-position returns, one after the other; with set! between runs."
  %joint-positions %set-joint-positions!)

(define-joint-accessor (joint-velocities multibody)
  "Return the velocities of all joints of MULTIBODY, a multibody, a link of one, or a view of a link, as
one vector: those that joint-velocity returns, one after the other; with set!."
  %joint-velocities %set-joint-velocities!)

(define-joint-accessor (joint-torques multibody)
  "Return the torques that were given to all joints of MULTIBODY, a multibody, a link of one, or a view
of a link, as one vector, in the order of joint-velocities; with set!."
  %joint-torques %set-joint-torques!)

;; ---- servos ----

(define-record-type <servo>
  (make-servo target target-velocity stiffness damping max-torque)
  a-servo?
  (target target-of)
  (target-velocity target-velocity-of)
  (stiffness stiffness-of)
  (damping damping-of)
  (max-torque max-torque-of))

(set-record-type-printer! <servo>
  (lambda (servo port)
    (format port "#<servo target ~a, stiffness ~a, damping ~a>"
            (target-of servo) (stiffness-of servo) (damping-of servo))))

(define-keyword-procedure (servo #:key target target-velocity stiffness damping max-torque)
  "Return a servo for (set! (joint-servo MULTIBODY NAME) SERVO): the torque
stiffness (target - position) + damping (target-velocity - velocity), cut to max-torque.  It acts within
the integration, so that stiff ones are no trouble.

#:target           as joint-position returns it; 0, or #(1 0 0 0)
#:target-velocity  as joint-velocity returns it; 0
#:stiffness        N m/rad or N/m, 0 or more; 0: only the velocity is held
#:damping          N m s/rad or N s/m, 0 or more; 0
#:max-torque       N m or N, 0 or more; no bound"
  (make-servo target target-velocity stiffness damping max-torque))

(define (servo? object)
  "Return #t if OBJECT is a servo."
  (a-servo? object))

(define (part servo part-of)
  (unless (a-servo? servo) (bad-value "the servo" servo "one that `servo' returns"))
  (part-of servo))

(define (servo-target servo)
  "Return the target of SERVO, rad or m."
  (part servo target-of))

(define (servo-target-velocity servo)
  "Return the target velocity of SERVO, rad/s or m/s."
  (part servo target-velocity-of))

(define (servo-stiffness servo)
  "Return the stiffness of SERVO, N m/rad or N/m."
  (part servo stiffness-of))

(define (servo-damping servo)
  "Return the damping of SERVO, N m s/rad or N s/m."
  (part servo damping-of))

(define (servo-max-torque servo)
  "Return the greatest torque of SERVO, N m or N."
  (part servo max-torque-of))

(define (get-servo multibody name)
  (and=> (%joint-servo multibody name) (lambda (parts) (apply make-servo parts))))

(define (set-servo! multibody name servo)
  (unless (or (not servo) (a-servo? servo))
    (bad-value "joint-servo" servo "a servo, as (servo #:target 0.3 #:stiffness 100) returns, or #f"))
  (%set-joint-servo! multibody name
                     (and servo
                          (list (target-of servo) (target-velocity-of servo) (stiffness-of servo)
                                (damping-of servo) (max-torque-of servo)))))

(define-joint-accessor (joint-servo multibody name)
  "Return the servo at the joint NAME of MULTIBODY, a multibody, a link of one, or a view of a link, or
#f; with set!, where #f takes it away."
  get-servo set-servo!)

;; ---- kinematics and dynamics ----

(define* (jacobian multibody name #:optional positions)
  "Return the Jacobian of the frame of the link NAME of MULTIBODY, a multibody, a link of one, or a view
of a link, as a 6 x n array: what rows 0 to 2 times (joint-velocities MULTIBODY) give is the velocity of
its origin, m/s, rows 3 to 5 the angular velocity, rad/s, both in the world frame.  At POSITIONS of all
joints, or where they are."
  (%jacobian multibody name positions))

(define (forward-kinematics multibody positions name)
  "Return the position (m) and the orientation of the frame of the link NAME of MULTIBODY in the world,
two values, were the joints at POSITIONS, as joint-positions returns them."
  (let ((pose (%forward-kinematics multibody positions name)))
    (values (car pose) (cdr pose))))

(define-keyword-procedure
  (inverse-kinematics multibody name #:key position orientation point start tolerance starts)
  "Return two values: positions of all joints of MULTIBODY, within their limits, at which the link NAME
is where it is wanted, or #f where none were found; and what is missing, m (a turn by 1 rad counts as a
sixth of the reach).

#:position     m, world frame, of the origin of the link's frame.  Must be there
#:orientation  a quaternion #(w x y z), of the link's frame in the world; any
#:point        m, in the link's frame: what is to be at #:position in place of the origin
#:start        positions to begin at, as joint-positions returns them; where the joints are
#:tolerance    m, positive; 1e-9 of the reach
#:starts       how often to try: after #:start from positions drawn within the limits, always the
               same; 6"
  (unless position
    (raise-error "inverse-kinematics got no #:position; expected a point #(x y z), world frame"))
  (let ((found (%inverse-kinematics multibody name position orientation point start tolerance
                                    starts)))
    (values (car found) (cdr found))))

(define (inverse-dynamics multibody positions velocities accelerations)
  "Return the torques, as joint-torques has them, that give the joints of MULTIBODY at POSITIONS and
VELOCITIES the ACCELERATIONS (rad/s^2, m/s^2) against gravity, damping, friction and springs of the
joints.  Servos, stops, contacts and forces on links are left out.  Joints that follow others do so,
whatever is given for them, and their torques are counted at those they follow."
  (%inverse-dynamics multibody positions velocities accelerations))

;; ---- how they are written ----

(define most-written 12)

(define (number->text x)
  (cond ((or (inf? x) (nan? x)) (number->string x))
        ((zero? x) "0")
        ((and (>= (abs x) 1e-3) (< (abs x) 1e6)) (format #f "~,4f" x))
        (else (format #f "~,3e" x))))

(define (value->text value)
  (if (vector? value)
      (format #f "#(~a)" (string-join (map number->text (vector->list value))))
      (number->text value)))

(define (limits->text limits)
  (match limits
    (#f "")
    ((? real? angle) (if (inf? angle) "" (format #f " (to ~a)" (number->text angle))))
    (((? real? lower) upper)
     (if (and (inf? lower) (inf? upper))
         ""
         (format #f " (~a to ~a)" (number->text lower) (number->text upper))))
    ((first second) (string-append (limits->text first) (limits->text second)))))

(define (joint->text multibody joint)
  (match joint
    ((name kind limits . _)
     (if (%inside-callback?)
         (format #f "~a" name)
         (format #f "~a ~a~a" name (value->text (joint-position multibody name))
                 (limits->text limits))))))

(define-method (write (multibody <multibody>) port)
  (if (%removed? multibody)
      (format port "#<multibody ~a (removed)>" (multibody-name multibody))
      (write-multibody multibody port)))

(define (write-multibody multibody port)
  (let* ((joints (moving-joints multibody))
         (shown (if (> (length joints) most-written) (list-head joints most-written) joints)))
    (format port "#<multibody ~a~a~a~a>" (multibody-name multibody) (if (null? joints) "" ": ")
            (string-join (map (lambda (joint) (joint->text multibody joint)) shown) ", ")
            (if (eq? shown joints)
                ""
                (format #f ", and ~a more" (- (length joints) most-written))))))
