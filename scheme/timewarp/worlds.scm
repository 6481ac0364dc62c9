;; Worlds, what a scene says about itself, and the command line's say in it.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp worlds)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp guarded-call)
  #:use-module (timewarp near-names)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:use-module (oop goops)
  #:export (make-world
            current-world
            reset!
            scene
            scene-random-state
            world-time
            world-bodies
            find-body)
  ;; for the other modules
  #:export (world-ref
            world-set!
            override
            set-overrides!
            world-fps
            world-duration
            world-seed
            at-first-run!
            start-first-run!
            start-afresh!
            current-world-followers))

;; ---- overrides: what the command line says, whatever scenes say ----

(define overrides '())

(define (override name)
  "Return what the command line set NAME to, or #f."
  (assq-ref overrides name))

(define (set-overrides! alist)
  "Let every world made from now on obey ALIST, whatever scenes say."
  (set! overrides alist))

;; Settings of the kernel that the command line can override.
(define kernel-settings
  '(accuracy seed threads hash check undo-redo gvt-interval window group-check-rate integrator
    policy write-states compare-states))

(define (make-world)
  "Return a new, empty world."
  (let ((world (%make-world)))
    (for-each (lambda (name)
                (when (override name) (%set-world! world name (override name))))
              kernel-settings)
    (match (override 'adversary)
      (#f #t)
      ((seed head-start every?) (%set-adversary! world seed head-start every?)))
    world))

(define (check-world world)
  (%require-outside-callbacks "setting current-world")
  (unless (world? world) (bad-value "current-world" world "a world, as (make-world) returns"))
  world)

(define (world? object)
  (and (struct? object) (eq? (struct-vtable object) <world>)))

(define current-world (make-parameter (make-world) check-world))
(set-object-property! current-world 'documentation
                      "The world that scenes fill and procedures act on: a parameter object.")

;; Procedures that are called with each world that takes the current one's place: what was to be
;; done with that (recording it) is to be done with this.
(define current-world-followers (make-parameter '()))

(define (start-afresh! who)
  "Let a new world take the current one's place for WHO, and return the current one."
  (when (%inside-callback?)
    (raise-error
     (string-append who " was used inside a callback or observer; expected it outside")))
  (let ((old (current-world))
        (new (make-world)))
    (for-each (lambda (follow) (follow new)) (current-world-followers))
    (current-world new)
    old))

(define (reset!)
  "Let a new, empty world take the current one's place: no bodies, time 0, and the settings of
`scene', camera, light and sky as they are at the start.  What the command line set, -D included,
stays; so do the names defined so far, but bodies of the old world are no bodies of the new one."
  (start-afresh! "reset!")
  (if #f #f))

(define* (world-ref world name #:optional default)
  (hashq-ref (%world-table world) name default))

(define (world-set! world name value)
  (hashq-set! (%world-table world) name value))

;; ---- what a scene says about itself ----

(define (check-number name value valid? expected)
  (unless (and (real? value) (valid? value)) (bad-value name value expected)))

;; Frames are numbered, and a film has one rate: who takes them goes on as it began.
(define (check-frame-rates world fps)
  (match (delete (exact->inexact fps) (if (override 'fps) '() (%frame-rates world)))
    (() #t)
    ((rate . _)
     (bad-value "fps" fps
                (format #f "~a, at which frames are taken since the first run, or another value before it"
                        (number-text rate))))))

(define (finite-positive? x) (and (positive? x) (not (inf? x))))

(define (policy->string policy)
  (match policy
    ((? symbol?) (symbol->string policy))
    (('retroactive (? real? step)) (format #f "retroactive:~a" step))
    (_ (bad-value "policy" policy "'timewarp, 'conservative or '(retroactive 0.01)"))))

(define-keyword-procedure
  (scene #:key title duration gravity accuracy fps seed policy group-check-rate on-overlap)
  "Set defaults of the current world; what a call leaves out stays.  Options of the command line go
first.

#:title     a string, shown in the frames; none
#:duration  s that `run!' and the command line simulate, 0 or more; 10
#:gravity   m/s^2, the acceleration #(x y z); #(0 0 -9.81)
#:accuracy  relative, 1e-12 to 0.1, before the first run; 1e-6 (--accuracy).  Heaps
            take about half the time at 1e-4; looser makes nothing faster
#:fps       frames per second of pictures, poses and frame observers, positive, before the run in
            which these begin; 30 (--fps)
#:seed      of random numbers, an integer, 0 or more, before bodies are added; 0 (--seed)
#:policy    'timewarp, 'conservative or '(retroactive STEP), STEP in seconds: how the main loop
            goes forward, before the first run; the answer is the same, the work is not
            (doc/policies.md); 'timewarp (--policy)
#:group-check-rate  Hz, the finest rate at which lasting contacts are checked, positive, before
            the first run; otherwise it follows from the sizes of the bodies in contact:
            480 for 0.14 to 0.55 m (--group-check-rate)
#:on-overlap  what becomes of bodies that are put deeper into each other than by 0.5 % of the
            thinner one's thickness: 'refuse, an error, or 'push: they begin without a load and
            are pushed apart, each two no faster than 0.15 sqrt(g size); 'refuse"
  (%require-outside-callbacks "scene")
  (let ((world (current-world)))
    ;; all is looked at before anything is set
    (when title
      (unless (string? title) (bad-value "title" title "a string")))
    (when duration
      (check-number "duration" duration (lambda (d) (and (>= d 0) (not (inf? d))))
                    "a number of seconds, not negative"))
    (when fps
      (check-number "fps" fps finite-positive? "a positive number of frames per second")
      (check-frame-rates world fps))
    (when on-overlap
      (unless (memq on-overlap '(refuse push))
        (bad-value "on-overlap" on-overlap "'refuse or 'push")))
    (%set-all! world
               (filter cdr
                       `((gravity . ,gravity)
                         (push-overlaps . ,on-overlap)
                         (accuracy . ,(and (not (override 'accuracy)) accuracy))
                         (seed . ,(and (not (override 'seed)) seed))
                         (policy . ,(and policy (not (override 'policy)) (policy->string policy)))
                         (group-check-rate
                          . ,(and (not (override 'group-check-rate)) group-check-rate)))))
    (for-each (match-lambda ((name . value) (when value (world-set! world name value))))
              `((title . ,title) (duration . ,duration) (fps . ,fps)))))

(define (world-duration world)
  "Return the duration of the scene in WORLD, s."
  (world-ref world 'duration 10))

(define (world-fps world)
  "Return the frames per second of WORLD: the command line's, the scene's, or 30."
  (or (override 'fps) (world-ref world 'fps 30)))

(define (world-seed world)
  (%world-seed world))

(define (scene-random-state)
  "Return a fresh Guile random state, seeded by --seed, else by the scene's #:seed."
  (seed->random-state (world-seed (current-world))))

;; ---- looking ----

(define (world-time)
  "Return the simulated time up to which the current world is committed, s."
  (%world-time (current-world)))

(define (world-bodies)
  "Return the list of all bodies of the current world, in the order in which they were added."
  (%world-bodies (current-world)))

(define (find-body name)
  "Return the body called NAME in the current world; it is an error if there is none."
  (or (%find-body (current-world) name)
      (bad-value "the name" name
                 (string-append "the name of a body of the current world"
                                (meant name (map %body-name (world-bodies)))))))

;; ---- before the first run ----

(define (at-first-run! world thunk)
  "Call THUNK when WORLD runs next."
  (world-set! world 'first-run (append (world-ref world 'first-run '()) (list thunk))))

(define (start-first-run! world)
  "Call what at-first-run! has gathered, oldest first.  What one that fails has kept from being
called waits for the next run."
  (match (world-ref world 'first-run '())
    (() #t)
    ((thunk . rest)
     (world-set! world 'first-run rest)
     (thunk)
     (start-first-run! world))))

;; ---- how things are written ----

;;
;; At the prompt objects tell how they are; messages name them only, and so do callbacks, in which
;; nobody may read a body.

(define (number-text x)
  (let ((rounded (round x)))
    (if (= x rounded)
        (number->string (inexact->exact rounded))
        (format #f "~,4f" x))))

(define (vector-text vector)
  (format #f "#(~a)" (string-join (map number-text (vector->list vector)) " ")))

(define (telling?) (not (or (writing-briefly?) (%inside-callback?))))

(define-method (write (world <world>) port)
  (format port "#<world ~a bodies~a>" (length (%world-bodies world))
          (if (telling?) (format #f " at ~a s" (number-text (%world-time world))) "")))

(define-method (write (body <body>) port)
  (format port "#<body ~a~a>" (%body-name body)
          (cond ((%removed? body) " (removed)")
                ((telling?) (format #f " ~a at ~a" (%body-kind body)
                                    (vector-text (%position body))))
                (else ""))))

(define-method (write (view <view>) port)
  (match (false-if-exception (%body-name (%view-body view)))
    (#f (display "#<view of the past>" port))
    (name (format port "#<view ~a>" name))))

(define-method (write (checkpoint <checkpoint>) port)
  (display "#<checkpoint>" port))

(define-method (write (motion <motion>) port)
  (display "#<keyframes>" port))

(define-method (write (shape <shape>) port)
  (format port "#<shape ~a>" (%shape-kind shape)))

(define-method (write (collision <collision>) port)
  (format port "#<collision ~a s ~a>" (%collision-time collision)
          (map %body-name (%collision-bodies collision))))
