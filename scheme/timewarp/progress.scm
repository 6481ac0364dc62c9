;; Progress reports: a line that rewrites itself on a terminal, a plain line every few seconds
;; elsewhere, both on standard error.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp progress)
  #:use-module (timewarp primitives)
  #:use-module (timewarp worlds)
  #:use-module (timewarp recorders)
  #:use-module (timewarp drawing)
  #:use-module (timewarp time-left)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-1)
  #:export (make-progress)
  ;; for timewarp-sweep
  #:export (duration-text))

(define (wall-seconds)
  (exact->inexact (/ (get-internal-real-time) internal-time-units-per-second)))

(define (duration-text seconds)
  (if (< seconds 100)
      (format #f "~,1f s" seconds)
      (format #f "~d min ~2,'0d s" (quotient (truncate->exact seconds) 60)
              (remainder (truncate->exact seconds) 60))))

(define (truncate->exact x) (inexact->exact (truncate x)))

;; What takes the time is told where simulated time goes slower than this share of real time, or
;; than 1/50 of it for each 100 bodies.
(define slow-rate 1/5)
(define slow-rate-of-bodies 2)

(define (slow? world simulated seconds)
  (let ((moving (assq-ref (%statistics world) 'bodies_moving)))
    (< simulated (* seconds (min slow-rate (/ slow-rate-of-bodies (max 1 moving)))))))

;; s that the simulation itself took, without drawing, writing and observers
(define (seconds-of-simulation world) (assq-ref (%statistics world) 'cpu_seconds))

;; The work of the groups and of the pair that took most so far: #(BODIES AMOUNT TEXT) each.  BODIES
;; and since when tell one from another, so that two such lists give what was done in between.
(define (dearest world)
  (let* ((table (%statistics world)) (looks (assq-ref table 'dearest_pair_checks)))
    (append
     (map (match-lambda
            ((names bodies contacts steps since)
             (vector (cons names since) steps
                     (format #f "the group ~a (~a bodies, ~a contacts) since ~,3f s" names bodies
                             contacts since))))
          (%dearest-groups world))
     (if (zero? looks)
         '()
         (let ((names (assq-ref table 'dearest_pair)))
           (list (vector (list names) looks (format #f "the pair ~a" names))))))))

;; What of NOW did most since BEFORE, and how much; #f where nothing did.
(define (dearest-between before now)
  (let ((done (lambda (entry)
                (let ((old (find (lambda (b) (equal? (vector-ref b 0) (vector-ref entry 0)))
                                 before)))
                  (- (vector-ref entry 1) (if old (vector-ref old 1) 0))))))
    (match (sort now (lambda (x y) (> (done x) (done y))))
      (() #f)
      ((most . _)
       (and (> (done most) 0)
            (format #f "slow: ~a took ~a ~a" (vector-ref most 2) (done most)
                    (if (null? (cdr (vector-ref most 0))) "looks" "steps")))))))

;; To ten-thousandths of the run, with two digits at least.
(define (time-text time until)
  (let ((digits (if (> until 0) (- 4 (inexact->exact (floor (log10 until)))) 2)))
    (format #f "~,vf" (min 12 (max 2 digits)) time)))

;; A film is not whole yet when its last frame has been handed over.
(define (frames-text world until)
  (call-with-values (lambda () (frames-written world until))
    (lambda (written all)
      (cond ((not written) "")
            ((< written all) (format #f ", ~a of ~a frames written" written all))
            (else (format #f ", all ~a frames written, closing the files" all))))))

(define (report world until course)
  (let ((time (%world-time world))
        (left (time-left course until)))
    (format #f "~a of ~a s simulated~a~a, ~a rollbacks" (time-text time until)
            (time-text until until)
            (if left (string-append ", " (duration-text left) " left") "")
            (frames-text world until)
            (assq-ref (%statistics world) 'rollbacks))))

(define* (make-progress #:key (port (current-error-port)))
  "Return two procedures: one to be called between slices with the world and the time to run to, and
one to be called when the run is over."
  (let* ((terminal? (isatty? port))
         (interval (if terminal? 0.2 3.0))
         (before '()) (simulated 0) (spent 0)
         (world #f) (until #f) (course '()) (last-sample 0) (last-shown 0) (shown? #f))
    ;; what was dear since the last report, where time goes slowly
    (define (cause! now)
      (let* ((seconds (seconds-of-simulation world))
             (advanced (- (%world-time world) simulated))
             (entries (dearest world))
             (text (cond ((slow? world advanced (- seconds spent)) (dearest-between before entries))
                         ((and (slow? world advanced (- now last-shown)) (frames-awaited? world))
                          "slow: drawing")
                         (else #f))))
        (set! before entries)
        (set! simulated (%world-time world))
        (set! spent seconds)
        (if text (string-append "; " text) "")))
    (define (show! now)
      (let ((text (string-append (report world until course) (cause! now))))
        (set! last-shown now)
        (set! shown? #t)
        (if terminal?
            (format port "\r~a\x1b[K" text)
            (format port "~a~%" text))
        (force-output port)))
    ;; a scene may run itself in many small runs: they are reported as often as one long one
    (define (start! next-world next-until now)
      (unless world (set! last-shown now))
      (unless (eq? world next-world)
        (set! before '())
        (set! spent (seconds-of-simulation next-world)))
      (set! world next-world)
      (set! until next-until)
      (set! simulated (min simulated (%world-time world)))
      (set! course '())
      (set! last-sample now))
    (define (sample! now)
      (set! last-sample now)
      (set! course (add-sample course (%world-time world) now until)))
    (values
     (lambda (next-world next-until)
       (let ((now (wall-seconds)))
         (unless (and (eq? world next-world) (equal? until next-until))
           (start! next-world next-until now))
         (when (or (null? course) (>= (- now last-sample) 0.1)) (sample! now))
         (when (>= (- now last-shown) interval) (show! now))))
     (lambda ()
       (when (and terminal? shown?)
         (format port "\r\x1b[K")
         (force-output port))))))
