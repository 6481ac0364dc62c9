;; Progress reports: a line that rewrites itself on a terminal, a plain line every few seconds
;; elsewhere, both on standard error.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp progress)
  #:use-module (timewarp primitives)
  #:use-module (timewarp worlds)
  #:use-module (timewarp recorders)
  #:use-module (timewarp drawing)
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

(define (report world until begun start-time)
  (let* ((time (%world-time world))
         (elapsed (- (wall-seconds) begun))
         (share (if (> until start-time) (/ (- time start-time) (- until start-time)) 1))
         (left (and (> share 0.001) (* elapsed (/ (- 1 share) share))))
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
         (begun #f) (start-time 0) (last 0) (shown? #f) (last-flush 0))
    (define (show! world until now)
      (set! last now)
      (set! shown? #t)
      (if terminal?
          (format port "\r~a\x1b[K" (report world until begun start-time))
          (format port "~a~%" (report world until begun start-time)))
      (force-output port))
    (values
     (lambda (world until)
       (let ((now (wall-seconds)))
         (unless begun
           (set! begun now)
           (set! start-time (%world-time world))
           (set! last now))
         (when (>= (- now last) interval) (show! world until now))))
     (lambda ()
       (when (and terminal? shown?)
         (format port "\r\x1b[K")
         (force-output port))))))
