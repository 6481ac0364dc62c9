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
  #:export (make-progress))

(define (wall-seconds)
  (exact->inexact (/ (get-internal-real-time) internal-time-units-per-second)))

(define (duration-text seconds)
  (if (< seconds 100)
      (format #f "~,1f s" seconds)
      (format #f "~d min ~2,'0d s" (quotient (truncate->exact seconds) 60)
              (remainder (truncate->exact seconds) 60))))

(define (truncate->exact x) (inexact->exact (truncate x)))

(define (report world until course)
  (let ((time (%world-time world))
        (left (time-left course until))
        (frames (frames-written world)))
    (format #f "~,2f of ~,2f s simulated~a~a, ~a rollbacks" time until
            (if left (string-append ", " (duration-text left) " left") "")
            (if frames (format #f ", ~a frames written" frames) "")
            (assq-ref (%statistics world) 'rollbacks))))

(define* (make-progress #:key (port (current-error-port)))
  "Return two procedures: one to be called between slices with the world and the time to run to, and
one to be called when the run is over."
  (let* ((terminal? (isatty? port))
         (interval (if terminal? 0.2 3.0))
         (world #f) (until #f) (course '()) (last-sample 0) (last-shown 0) (shown? #f))
    (define (show! now)
      (set! last-shown now)
      (set! shown? #t)
      (if terminal?
          (format port "\r~a\x1b[K" (report world until course))
          (format port "~a~%" (report world until course)))
      (force-output port))
    ;; a scene may run itself in many small runs: they are reported as often as one long one
    (define (start! next-world next-until now)
      (unless world (set! last-shown now))
      (set! world next-world)
      (set! until next-until)
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
