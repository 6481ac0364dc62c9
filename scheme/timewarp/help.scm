;; (help): what to type first, and the procedures by group; (help NAME): a procedure's description.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp help)
  #:use-module (timewarp describing)
  #:use-module (timewarp errors)
  #:use-module (timewarp near-names)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:use-module ((srfi srfi-1) #:select (append-map filter-map find))
  #:use-module ((system syntax) #:select (syntax-local-binding))
  #:export (help-groups)
  ;; beside (ice-9 session), which has another one
  #:replace (help))

(define help-groups
  '(("World" "settings, the bodies there are, starting afresh"
     scene define-scene-parameter scene-random-state world-time world-bodies find-body reset!
     load-scene make-world current-world)
    ("Shapes" "what bodies are made of"
     sphere box capsule cylinder cone ellipsoid convex half-space height-field triangle-mesh union placed
     rock load-shape load-visual rotation shape-volume shape-inertia shape-centroid shape-radius shape?)
    ("Bodies" "adding them, reading and (set! (velocity BODY) ...) changing them"
     add-body! remove-body! keyframes position orientation velocity angular-velocity applied-force
     applied-torque kinetic-energy slot slot? random-real! body-name body-mass body-kind view-body
     body? view?)
    ("Contact" "restitution and friction, who collides, the contacts at present"
     set-contact-parameters! contact-parameters disable-collisions! enable-collisions! contacts
     contact-bodies contact-point contact-normal contact-gap contact-force contact-friction
     contact-slipping? contact-torque contact?)
    ("Queries" "rays, distances, what is where"
     ray-cast hit? hit-body hit-point hit-normal hit-distance closest-points overlapping
     bounding-box all-poses)
    ("Sensors" "what instruments on bodies and in joints read, in callbacks too"
     accelerometer gyro net-contact-force rangefinder joint-force joint-moment spring-force
     hold-force hold-torque)
    ("Forces" "what acts on bodies, from now on"
     add-drag! remove-drag! add-spring! remove-spring! attach! detach! attached? add-force!
     remove-force!)
    ("Multibodies" "links that hang on one another by joints"
     add-multibody! load-urdf link revolute prismatic universal spherical weld link-body joint-names joint-max-torque joint-max-velocity
     joint-limits joint-position joint-velocity joint-torque joint-servo servo joint-positions
     joint-velocities joint-torques jacobian forward-kinematics inverse-kinematics inverse-dynamics
     multibody-name multibody-links body-multibody find-multibody world-multibodies servo-target
     servo-target-velocity servo-stiffness servo-damping servo-max-torque multibody? link? joint?
     servo?)
    ("Callbacks" "procedures that change what happens (may run again after a rollback)"
     add-callback! on-collision! remove-callback! collision-time collision-point collision-normal
     collision-speed collision-impulse collision-bodies collision?)
    ("Observers" "procedures that look at what is final, once and in order"
     observe! remove-observer! frame-time frame-index frame-views squeezed-time squeezed-body squeezed-between
     squeezed-depth squeezed-share)
    ("Running" "Ctrl-C interrupts; the world stays usable"
     run! run-for! step! simulate! checkpoint restore! statistics show-statistics state-queue
     total-energy total-momentum)
    ("Looking" "pictures"
     camera light sky render!)))

(define first-lines
  "A ball that falls on a floor, to type in:

  (add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)
  (define ball (add-body! #:shape (sphere 0.1) #:position #(0 0 1)))
  (run! #:until 2)
  (position ball)
  (render! \"ball.png\")

A scene of yours: (load-scene \"scene.scm\"), then (run!).  From the start again: (reset!).
")

(define last-lines
  "
(help add-body!) or ,describe add-body! shows all of a procedure; (help sensors) lists a group
of the above, (help friction) all that has this in its name, keywords or description.
Vectors are #(x y z), units SI, angles radians, z is up; what is optional is a keyword,
whose description ends with its default.
Tab completes names, keywords, bodies and files; Ctrl-C interrupts.
After an error the prompt is as before; ,option on-error 'debug enters Guile's debugger there.
(exit) or Ctrl-D leaves.  The manual, with a tutorial: info timewarp, from a shell.
")

;; "  name name ..." in lines of at most 78 columns
(define (names->lines names)
  (let loop ((names (map symbol->string names)) (line " ") (lines '()))
    (match names
      (() (string-join (reverse (cons line lines)) "\n"))
      ((name . rest)
       (if (> (+ (string-length line) 1 (string-length name)) 78)
           (loop names " " (cons line lines))
           (loop rest (string-append line " " name) lines))))))

(define (show-page)
  (display first-lines)
  (for-each (lambda (group) (newline) (show-group group)) help-groups)
  (display last-lines))

(define (show-help name value)
  (match (description value)
    (#f (bad-value "help's argument" name "a name or a procedure that has a description"))
    (text
     (match (usage value (if (symbol? name) name (name-of value)))
       (#f (format #t "~a~%" text))
       (words (format #t "(~a)~%~%~a~%" (string-join words) text))))))

;; "  name    line ..." of each description in which TEXT occurs: the first line that has it.
(define (lines-with text)
  (define (line-with description)
    (find (lambda (line) (string-contains-ci line text)) (string-split description #\newline)))
  (filter-map (match-lambda
                ((name . description)
                 (let ((line (line-with description)))
                   (and line
                        (format #f "  ~a  ~a"
                                (string-pad-right (symbol->string name)
                                                  (max 22 (string-length (symbol->string name))))
                                (string-trim-both line))))))
              (all-descriptions)))

;; (NAME . DESCRIPTION) of everything, in the order of (help).
(define (all-descriptions)
  (append-map (match-lambda
                ((module . names)
                 (let ((interface (resolve-interface module)))
                   (filter-map (lambda (name)
                                 (let ((text (description (module-ref interface name))))
                                   (and text (cons name text))))
                               names))))
              `(((timewarp) . ,(append-map cddr help-groups))
                ((timewarp vectors)
                 . ,(sort (module-map (lambda (name variable) name)
                                      (resolve-interface '(timewarp vectors)))
                          (lambda (a b) (string<? (symbol->string a) (symbol->string b))))))))

;; What has TEXT in its name, keywords or description.
(define (show-what-has what text)
  (let ((names (names-with text)) (lines (lines-with text)))
    (when (and (null? names) (null? lines))
      (bad-value "help's argument" what
                 "a name, a subject of (help), or what occurs in a name or in a description"))
    (unless (null? names) (format #t "names with ~a:~%~a~%" text (names->lines names)))
    (unless (null? lines) (format #t "descriptions with ~a:~%~a~%" text (string-join lines "\n")))))

;; NAME is a name in MODULE, a subject, or a part of names or descriptions.
(define* (help-on name #:optional (module (current-module)))
  (define text (symbol->string name))
  (define (subject? group) (string-ci=? (car group) text))
  (define variable (bound-variable module name))
  (cond ((and variable (description (variable-ref variable)))
         (show-help name (variable-ref variable)))
        ((find subject? help-groups) => show-group)
        (variable (show-help name (variable-ref variable)))
        ((home name) => (lambda (module) (show-with-home name module)))
        (else (show-what-has name text))))

;; What MODULE has and is not imported here.
(define (show-with-home name module)
  (show-help name (module-ref (resolve-interface module) name))
  (format #t "~%(use-modules ~a) imports it.~%" module))

(define (bound-variable module name)
  (let ((variable (module-variable module name)))
    (and variable (variable-bound? variable) variable)))

(define show-group
  (match-lambda
    ((group what . names) (format #t "~a: ~a~%~a~%" group what (names->lines names)))))

(define (name-of value)
  (and (procedure? value) (procedure-name value)))

(define* (help-with #:optional (what #f))
  (match what
    (#f (show-page))
    ((? string? text) (help-on (string->symbol text)))
    ((? symbol? name) (help-on name))
    ((? keyword? name)
     (show-what-has name (string-append "#:" (symbol->string (keyword->symbol name)))))
    (value (show-help (or (name-of value) value) value)))
  (if #f #f))

;; Of what was written without a quote: of a variable that holds a name, the name's.
(define (help-on-identifier name module)
  (match (bound-variable (resolve-module module) name)
    ((and (not #f) (= variable-ref (and value (or #f (? string?) (? symbol?)))))
     (help-with value))
    (_ (help-on name (resolve-module module))
       (if #f #f))))

;; Syntax, as Guile's own is, so that names that nothing has need no quote.
(define-syntax help
  (lambda (form)
    "(help) shows what to type first and the procedures by group; (help NAME) shows the description of a
procedure, (help SUBJECT) lists a group of (help), and (help WORD) the names, keywords and descriptions
in which WORD occurs.  Each may be quoted or a string, too."
    (syntax-case form ()
      ((_ name)
       (identifier? #'name)
       (call-with-values (lambda () (syntax-local-binding #'name))
         (lambda (kind where)
           (case kind
             ((global) #`(help-on-identifier 'name '#,(datum->syntax #'name (cdr where))))
             ((macro) #'(help-with 'name))
             (else #'(help-with name))))))
      ((_ . arguments) #'(help-with . arguments))
      (_ (identifier? form) #'help-with))))
