;; Callbacks, views, collisions and observers.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (ice-9 control))

(test-begin "callbacks")

;; A room of six half-spaces, 4 m wide, with 24 elastic spheres, each with a counter.
(define (gas!)
  (for-each (lambda (axis)
              (for-each (lambda (sign)
                          (let ((normal (make-vector 3 0)))
                            (vector-set! normal axis (- sign))
                            (add-body! #:shape (half-space normal -2) #:fixed? #t)))
                        '(-1 1)))
            '(0 1 2))
  (set-contact-parameters! #t #t #:restitution 1 #:friction 0)
  (map (lambda (i)
         (add-body! #:name (format #f "s~a" i) #:shape (sphere 0.3) #:slots '((hits . 0) (sum . 0))
                    #:position (vector (- (modulo i 3) 1) (- (modulo (quotient i 3) 3) 1)
                                       (- (quotient i 9) 1))
                    #:velocity (vector (- (modulo (* 7 i) 5) 2.3) (- (modulo (* 5 i) 7) 3.1)
                                       (- (modulo (* 3 i) 11) 5.2))))
       (iota 24)))

;; Hits counted in slots, collisions seen by an observer (latest first), rollbacks, and the hash.
(define (run-gas)
  (let ((seen '())
        (spheres (gas!)))
    (scene #:gravity #(0 0 0))
    (on-collision! #t #t
      (lambda (collision a b)
        (for-each (lambda (view)
                    (when (slot? view 'hits)
                      (set! (slot view 'hits) (1+ (slot view 'hits)))))
                  (list a b))))
    (observe! 'collision (lambda (collision) (set! seen (cons collision seen))))
    (run! #:until 1)
    (list (map (lambda (sphere) (slot sphere 'hits)) spheres)
          seen
          (assq-ref (statistics) 'rollbacks)
          (%history-hash (current-world)))))

(define (hits-of name collisions)
  (count (lambda (collision) (member name (map body-name (collision-bodies collision)))) collisions))

(define plain (in-world ('(hash . #t)) (run-gas)))

(test-assert "the gas collides" (> (length (second plain)) 50))

(for-each
 (lambda (seed head-start)
   (match (in-world ('(hash . #t) (cons 'adversary (list seed head-start #t))) (run-gas))
     ((hits seen rollbacks hash)
      (test-assert (format #f "the adversary ~a makes rollbacks: ~a" seed rollbacks) (> rollbacks 0))
      (test-equal (format #f "a counter in a slot counts committed collisions, seed ~a" seed)
        (map (lambda (i) (hits-of (format #f "s~a" i) seen)) (iota 24))
        hits)
      (test-equal "and is that of the ordinary schedule" (first plain) hits)
      (test-equal "an observer sees each collision once"
        (map collision-time (second plain)) (map collision-time seen))
      (test-assert "in time order" (apply >= (map collision-time seen)))
      (test-equal "the history is the same" (fourth plain) hash))))
 '(1 2 3 4) '(0.3 0.5 0.7 1.0))

;; ---- ticks ----

(define (times-of . keywords)
  (in-world ()
    (let ((ball (add-body! #:shape (sphere 1) #:slots '((times)))))
      (apply add-callback! ball
             (lambda (time view)
               (set! (slot view 'times) (cons time (slot view 'times)))
               (and (< time 0.5) (+ time 0.25)))
             keywords)
      (run! #:until 1)
      (reverse (slot ball 'times)))))

(test-equal "ticks are start + k period, one product and one sum"
  (map (lambda (k) (+ 0.1 (* k 0.3))) '(0 1 2 3))
  (times-of #:start 0.1 #:period 0.3))
(test-equal "without a period it returns its next time, or #f" '(0.0 0.25 0.5) (times-of))

(test-equal "ticks before the first run are not made up for" '(0.0 0.25 0.5 0.75 1.0)
  (times-of #:start -0.5 #:period 0.25))
(in-world ()
  (let ((ball (add-body! #:name "ball" #:shape (sphere 1))))
    (test-message "a start before the first run"
      "start of callback of ball is -1; expected a time after"
      (begin (add-callback! ball list #:start -1)
             (run! #:until 1)))))

(in-world ()
  (let* ((ball (add-body! #:shape (sphere 1)))
         (calls '()))
    (run! #:until 1)
    (add-callback! ball (lambda (time view) (set! calls (cons time calls)) #f))
    (run! #:until 2)
    (test-assert "the start is the present unless given"
      (and (= (length calls) 1) (close? 1 (car calls) 1e-15)))))

;; ---- views ----

(in-world ()
  (let ((a (add-body! #:name "a" #:shape (sphere 0.5) #:position #(0 0 2) #:slots '((n . 0))))
        (b (add-body! #:name "b" #:shape (sphere 0.5) #:position #(5 0 2)))
        (kept #f) (told '()))
    (scene #:gravity #(0 0 0))
    (add-callback! (list b a)
      (lambda (time b* a*)
        (set! kept b*)
        (set! told (list time (body-name b*) (position b*) (eq? (view-body b*) b) (view? b*) (view? b)))
        (set! (velocity b*) #(0 1 0))
        (set! (angular-velocity a*) #(0 0 2))
        (set! (applied-force a*) #(0 0 1))
        (set! (slot a* 'n) (random-real! a*))
        (set! (slot a* 'n) (list (slot a* 'n) (velocity b*) (applied-force a*) (kinetic-energy a*)))
        #f))
    (run! #:until 1)
    (test-equal "views come in the order of the targets" '(0.0 "b" #(5.0 0.0 2.0) #t #t #f) told)
    (test-equal "a view shows what was set" '(#(0.0 1.0 0.0) #(0.0 0.0 1.0)) (list-head (cdr (slot a 'n)) 2))
    (test-assert "random-real! is in [0, 1)" (and (>= (car (slot a 'n)) 0) (< (car (slot a 'n)) 1)))
    (test-equal "what was set moves the body" '(#(5.0 1.0 2.0) #(0.0 0.0 2.0))
                (list (position b) (angular-velocity a)))
    (test-message "a view is dead after the call" "this view is dead" (position kept))
    (test-message "also for set!" "this view is dead" (set! (velocity kept) #(0 0 0)))))

(define-syntax-rule (callback-error pattern (view other) expression)
  (in-world ()
    (let ((ball (add-body! #:name "ball" #:shape (sphere 1)))
          (floor (add-body! #:name "floor" #:shape (sphere 1) #:position #(9 0 0) #:fixed? #t)))
      (add-callback! (list ball floor) (lambda (time view other) expression #f) #:start 0.25)
      (test-message (format #f "~s in a callback" 'expression)
        (string-append pattern "(.|\n)*in the callback.* at 0.25 s, bodies: ball, floor")
        (call-with-prompt 'tests (lambda () (run! #:until 1)) (const #f)))
      (test-assert "the world is left at a committed time" (<= 0 (world-time) 0.25)))))

(callback-error "position was used inside a callback" (view other) (position (find-body "ball")))
(callback-error "world-time was used inside" (view other) (world-time))
(callback-error "statistics was used inside" (view other) (statistics))
(callback-error "add-body! was used inside" (view other) (add-body! #:shape (sphere 1)))
(callback-error "run! was used inside" (view other) (run! #:until 2))
(callback-error "add-callback! was used inside" (view other) (add-callback! (find-body "ball") list))
(callback-error "set-contact-parameters! was used inside" (view other) (set-contact-parameters! #t #t #:friction 1))
(callback-error "position of body ball was set through a view" (view other) (set! (position view) #(0 0 0)))
(callback-error "body ball has no slot n" (view other) (slot view 'n))
(callback-error "velocity is #\\(0 0 \\+inf.0\\)" (view other) (set! (velocity view) #(0 0 +inf.0)))
(callback-error "fixed" (view other) (set! (velocity other) #(0 0 0)))
(callback-error "Wrong type" (view other) (car 5))
(callback-error "expected it to return" (view other) (abort-to-prompt 'tests))
(callback-error "exit was called" (view other) (exit 3))
(callback-error "my own 5" (view other) (error "my own" 5))
(callback-error "42 was raised" (view other) (raise-exception 42))

(in-world ()
  (let ((ball (add-body! #:shape (sphere 1))))
    (test-message "targets must be bodies" "a target is 5; expected a body" (add-callback! (list 5) list))
    (test-message "no targets" "no targets" (add-callback! '() list))
    (test-message "a callback must be a procedure" "callback is 5; expected a procedure"
      (add-callback! ball 5))
    (test-message "a side of the wrong type" "second side is \"x\"" (on-collision! ball "x" list))
    (test-message "unknown keyword" "unknown keyword #:every; expected one of #:start #:period"
      (add-callback! ball list #:every 1))
    (test-message "a period of zero" "period" (add-callback! ball list #:period 0))
    (add-callback! ball (lambda (time view) 'soon))
    (test-message "a next time that is no number" "expected its next time" (run! #:until 1))))

;; ---- exits leave nothing behind ----

(define (living) (map cdr (alist-delete 'worlds (%live-objects))))

(define (leave-by thunk)
  (in-world ()
    (let ((ball (add-body! #:shape #f #:mass 1 #:inertia #(1 1 1) #:center-of-mass #(0 0 0)
                           #:slots '((n . 0)))))
      (add-callback! ball (lambda (time view) (set! (slot view 'n) 1) (thunk) #f) #:start 0.1)
      (call-with-prompt 'tests
        (lambda () (string? (error-of (run! #:until 1))))
        (const #f)))))

(define exits
  (list (lambda () (error "no"))
        (lambda () (car 5))
        (lambda () (raise-exception 42))
        (lambda () (throw 'own-key 1 2))
        (lambda () (add-body! #:shape (sphere 1)))
        (lambda () (abort-to-prompt 'tests))
        (lambda () (exit 3))))

(let ((escaped #f) (before #f))
  (gc)
  (set! before (living))
  (for-each (lambda (leave)
              (do ((i 0 (1+ i))) ((= i 100))
                (unless (leave-by leave) (set! escaped leave))))
            exits)
  (do ((i 0 (1+ i))) ((= i 100))
    (unless (call/ec (lambda (return) (leave-by (lambda () (return #f)))))
      (set! escaped 'call/ec)))
  (test-assert "every exit from a callback becomes an error" (not escaped))
  ;; worlds are collected when Guile likes, and words on the stack that look like pointers keep a few;
  ;; what they own goes with them.  An exit that leaks leaves a hundred worlds.
  (let ((few? (lambda () (< (apply + (living)) (+ 100 (apply + before))))))
    (do ((i 0 (1+ i))) ((or (= i 20) (few?))) (gc) (usleep 10000))
    (test-assert (format #f "800 failing callbacks leave no objects: ~a ~a" before (living)) (few?))))

(in-world ()
  (let ((ball (add-body! #:shape (sphere 1) #:slots '((n . 0)))) (failures 0))
    (add-callback! ball (lambda (time view) (set! (slot view 'n) (1+ (slot view 'n))) (car 5)) #:start 1)
    (error-of (run! #:until 2))
    (let ((before (begin (gc) (%live-objects))))
      (do ((i 0 (1+ i))) ((= i 3000))
        (when (error-of (run! #:until 2)) (set! failures (1+ failures))))
      (gc)
      (test-equal "a failing callback fails every time" 3000 failures)
      ;; worlds of earlier tests may be collected meanwhile: then there is less
      (test-assert (format #f "3000 failing callbacks in one world leave nothing: ~a ~a" before
                           (%live-objects))
        (every (lambda (earlier now) (<= (cdr now) (cdr earlier))) before (%live-objects))))))

;; ---- collisions ----

(define (one-collision register)
  (in-world ()
    (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:density (/ 6 (acos -1))
                           #:position #(0 0 5.5) #:material 'rubber))
          (floor (ground)))
      (set-contact-parameters! #t #t #:restitution 0.5 #:friction 0)
      (register ball floor)
      (run! #:until 1.1))))

(let ((told '()))
  (define (tell label)
    (lambda (collision a b)
      (set! told (cons (list label (body-name a) (body-name b) (collision-normal collision)) told))))
  (one-collision
   (lambda (ball floor)
     (on-collision! floor ball (tell 1))
     (on-collision! 'rubber #t (tell 2))
     (on-collision! #t #t (tell 3))
     (on-collision! 'steel #t (tell 4))))
  (test-equal "all that match run, in order of registration, with views in A, B order"
    '((1 "ground" "ball" #(0.0 0.0 1.0)) (2 "ball" "ground" #(0.0 0.0 -1.0))
      (3 "ball" "ground" #(0.0 0.0 -1.0)))
    (map (match-lambda ((label a b n) (list label a b (list->vector (map (lambda (x) (+ x 0.0)) (vector->list n)))))) (reverse told))))

(let ((seen #f) (speed-after #f))
  (one-collision
   (lambda (ball floor)
     (on-collision! ball floor
       (lambda (collision a b) (set! speed-after (vector-ref (velocity a) 2))))
     (observe! 'collision (lambda (collision) (set! seen collision)))))
  (let ((speed (sqrt (* 2 9.81 5))))
    (test-assert "the time of a collision" (close? (collision-time seen) (sqrt (/ 10 9.81)) 1e-14))
    (test-assert "its point" (close? (collision-point seen) #(0 0 0) 1e-14))
    (test-assert "its approach speed" (close? (collision-speed seen) speed 1e-13))
    (test-assert "its impulse" (close? (collision-impulse seen) (* 1.5 speed) 1e-12))
    (test-assert "a callback sees the state after the impulse" (close? speed-after (* 0.5 speed) 1e-13))
    (test-equal "its bodies" '("ball" "ground") (map body-name (collision-bodies seen)))
    (test-assert "collision?" (and (collision? seen) (not (collision? 5))))))

;; ---- observers ----

(in-world ()
  (run! #:until 0.1)
  (scene #:fps 4)
  (let ((times '()))
    (observe! 'frame (lambda (frame) (set! times (cons (frame-time frame) times))))
    (run! #:until 1)
    (test-equal "between runs a rate may be set that nobody takes frames at yet"
      '(0.25 0.5 0.75 1.0) (reverse times))))

(in-world ()
  (let ((ball (add-body! #:name "ball" #:shape (sphere 1))) (frames '()))
    (scene #:fps 10 #:gravity #(0 0 -10))
    (observe! 'fusion list)
    (observe! 'fission list)
    (observe! 'frame
      (lambda (frame)
        (set! frames (cons (list (frame-index frame) (frame-time frame)
                                 (map body-name (frame-views frame))
                                 (map position (frame-views frame)))
                           frames))))
    (run! #:until 0.05)
    (run! #:until 0.2)
    (test-equal "frames come at k/fps, once, also from a run in pieces"
      '((0 0.0) (1 0.1) (2 0.2)) (map (lambda (f) (list-head f 2)) (reverse frames)))
    (test-equal "a frame has views of the moving bodies" '("ball") (third (first frames)))
    (test-assert "which show the motion" (close? #(0 0 -0.2) (car (fourth (first frames))) 1e-14))
    (test-message "their rate stays while they are taken" "fps is 20; expected 10, at which frames"
      (scene #:fps 20))
    (scene #:fps 10.0)
    (test-message "what to observe" "expected 'collision" (observe! 'rain list))
    (test-message "an observer must be a procedure" "expected a procedure" (observe! 'frame 5))))

(in-world ()
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:position #(0 0 2))) (calls 0))
    (ground)
    (set-contact-parameters! #t #t #:restitution 1)
    (observe! 'collision (lambda (collision)
                           (set! calls (1+ calls))
                           (when (= calls 1) (error "no more"))))
    (test-message "an observer's error stops the run" "no more(.|\n)*observer" (run! #:until 4))
    (run! #:until 4)
    (test-assert "and the world goes on" (and (> calls 2) (= (world-time) 4)))))

(in-world ()
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:position #(0 0 2))))
    (ground)
    (observe! 'collision (lambda (collision) (add-body! #:shape (sphere 1))))
    (test-message "an observer only looks" "inside a callback or observer" (run! #:until 1))))

;; A ball that comes to lie on the ground is kicked off it: one fusion before, one fission after.
(in-world ()
  (let ((ball (add-body! #:name "ball" #:shape (sphere 0.5) #:position #(0 0 0.5001)))
        (fusions '()) (fissions '()))
    (ground)
    (set-contact-parameters! #t #t #:restitution 0)
    (scene #:group-check-rate 240)
    (observe! 'fusion (lambda (event) (set! fusions (cons event fusions))))
    (observe! 'fission (lambda (event) (set! fissions (cons event fissions))))
    (add-callback! ball (lambda (time view) (set! (velocity view) #(0 0 3)) #f) #:start 0.25)
    (run! #:until 0.5)
    (define (bodies-of event) (sort (map body-name (collision-bodies event)) string<?))
    (test-equal "a fusion is observed" '(("ball" "ground")) (map bodies-of fusions))
    (test-equal "a fission is observed" '(("ball" "ground")) (map bodies-of fissions))
    (test-assert "before and after the kick"
      (< (collision-time (car fusions)) 0.25 (collision-time (car fissions)) 0.3))
    (test-equal "neither has an impulse" '(0.0 0.0)
      (map collision-impulse (append fusions fissions)))))

;; ---- no callbacks, no calls ----

(in-world ()
  (gas!)
  (scene #:gravity #(0 0 0))
  (run! #:until 1)
  (test-equal "a scene without callbacks never calls Guile" 0 (assq-ref (statistics) 'guile_calls)))

;; a body whose motion is given stops, and what lies in contact elsewhere does not wait for it
(in-world ()
  (ground)
  (let ((mover (add-body! #:name "mover" #:shape (box 0.1 0.1 0.1)
                          #:motion (keyframes '((0 #(0 0 3)) (1 #(0.2 0 3)))))))
    (for-each (lambda (z) (add-body! #:shape (box 0.2 0.2 0.2) #:position (vector 0 0 z))) '(0.1 0.31))
    (run-for! 0.1)
    (add-callback! mover (lambda (time view) (error "no further")))
    (test-message "an error of a kinematic body's callback" "no further" (run-for! 0.7))
    (test-approximate "ends the run there" 0.1 (world-time) 1e-12)))

(test-end "callbacks")
