;; Running worlds, in slices between which Ctrl-C and progress reports have their say.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp running)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp worlds)
  #:use-module (timewarp parts)
  #:use-module (ice-9 match)
  #:use-module (ice-9 format)
  #:export (run! run-for! step! statistics show-statistics state-queue checkpoint restore! total-energy total-momentum)
  ;; for the other modules
  #:export (run-world!
            stop-at!
            runs-going-on
            current-slice-hooks))

;; s of wall time: between slices no C++ frame is on the stack
(define slice 0.02)

;; How many runs are going on, each within a hook of the one before.
(define runs-going-on (make-parameter 0))

;; Procedures that are called between slices with the world and the time to run to.
(define current-slice-hooks (make-parameter '()))

(define (run-world! world until)
  "Run WORLD until everything up to and including UNTIL is committed and observed."
  (unless (and (real? until) (not (nan? until)) (not (inf? until)))
    (bad-value "until" until "a finite time in seconds"))
  (%require-outside-callbacks "run!")
  (start-first-run! world)
  (match (world-ref world 'stop #f)
    (((? (lambda (time) (<= (%world-time world) time until)) time) . look)
     (advance-to! world time)
     (world-set! world 'stop #f)
     (look))
    (_ #t))
  (advance-to! world until)
  (if #f #f))

;; Splitting a run changes nothing.
(define (stop-at! world time look)
  "Let the run of WORLD that reaches TIME stop there to call LOOK, once."
  (world-set! world 'stop (cons time look)))

(define (advance-to! world until)
  (call-with-interrupts
   (lambda ()
     (%forget-interrupt!)
     (parameterize ((runs-going-on (1+ (runs-going-on))))
       (let loop ()
         (let ((finished? (call-with-run-stack (lambda () (%advance! world until slice)))))
           (%check-interrupt!)
           (for-each (lambda (hook) (hook world until)) (current-slice-hooks))
           (unless finished? (loop))))))))

(define-keyword-procedure (run! #:key until)
  "Run the current world; return when everything up to and including the time to run to is committed
and observed.  Ctrl-C interrupts; the world stays usable.

#:until  s, the time to run to, counted from the world's start; what is past already changes
         nothing: restore! and load-scene go back; the scene's duration"
  (let ((world (current-world)))
    (run-world! world (or until (world-duration world)))))

(define (run-for! seconds)
  "Run the current world for SECONDS more, 0 or a positive number."
  (%require-outside-callbacks "run-for!")
  (unless (and (real? seconds) (>= seconds 0))
    (bad-value "the duration" seconds "a number of seconds that is not negative"))
  (run-world! (current-world) (+ (world-time) seconds)))

(define (step!)
  "Process one event of the current world and return (KIND TIME BODY ...), which was done, when in
simulated time, and to whom: 'advance (a body goes on by a window of its path), 'check (how far two
are apart), 'impact, 'callback, or 'group-check (of what lies together, one member); #f where nothing
is left to do.  Many events pass before world-time goes on: what is done may still be taken back."
  (%require-outside-callbacks "step!")
  (let ((world (current-world)))
    (start-first-run! world)
    (call-with-interrupts
     (lambda () (call-with-run-stack (lambda () (%step! world)))))))

(define (statistics)
  "Return the statistics of the current world as an association list of symbols and values;
numbers are SI.  (assq-ref (statistics) 'collisions) is one of them; what each means tells
doc/statistics.md in the sources."
  (%statistics (current-world)))

(define (show-statistics)
  "Print the statistics of the current world, one per line."
  (for-each (match-lambda
              ((name . value)
               (format #t "~30a ~a~%" name
                       (if (and (real? value) (inexact? value)) (short-number value) value))))
            (statistics)))

(define (short-number x)
  (cond ((or (nan? x) (inf? x) (zero? x)) (number->string x))
        ((and (>= (abs x) 1e-3) (< (abs x) 1e6)) (format #f "~,6f" x))
        (else (format #f "~,5e" x))))

(define (state-queue body)
  "Return the states kept of BODY, oldest first: (time kind microstep committed? position velocity)."
  (%state-queue (current-world) body))

(define (checkpoint)
  "Return the present of the current world, for restore!: bodies, forces, contact parameters,
callbacks and observers, slots and random generators are part of it."
  (let ((world (current-world)))
    (%checkpoint world (waiting-observers world))))

(define (restore! checkpoint)
  "Bring the current world back to the time at which it made CHECKPOINT.  What was added since then
is gone, and its handle an error; what was removed is back, and its handle works again: bodies,
multibodies, forces, contact parameters, callbacks and observers.  What records the run and how it looks
stay.  Going on gives the same history, bit for bit, as if nothing had happened since.  Any checkpoint
of a world may be restored after any other, as often as one likes."
  (let* ((world (current-world))
         (waiting (%restore! world checkpoint)))
    (set-waiting-observers! world waiting)
    (if #f #f)))

(define (total-energy)
  "Return the kinetic energy of the dynamic bodies plus their energy in the field of gravity and in
the springs of their contacts, J.  What springs of bodies that were placed touching held from the start
counts for nothing."
  (%total-energy (current-world)))

(define (total-momentum)
  "Return the total momentum of the dynamic bodies, kg m/s."
  (%total-momentum (current-world)))
