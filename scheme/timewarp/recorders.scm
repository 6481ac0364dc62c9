;; Recorders: what a run writes to files, opened before it, attached when it begins, closed however it
;; ends.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp recorders)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp worlds)
  #:use-module (timewarp running)
  #:use-module (timewarp drawing)
  #:use-module (ice-9 match)
  #:export (call-with-recorders))

;; Opens a CSV recorder and lets WORLD feed it from its next run on.  Returns a pair of thunks that flush
;; and close it.
(define (start-csv! world open file)
  (let ((recorder (open file)))
    (at-first-run! world (lambda () (%attach-recorder! world recorder (world-fps world))))
    (cons (lambda () (%flush-recorder! recorder))
          (lambda () (%close-recorder! world recorder)))))

(define (start-frames! world frames size quality contacts?)
  (let ((drawer (open-frames frames size quality)))
    (at-first-run! world (lambda () (attach-frames! world drawer (world-fps world) contacts?)))
    (cons (lambda () #f)
          (lambda () (close-frames! world drawer)))))

;; A slice hook: what is recorded reaches the files once a second, and a full disk shows as soon.
(define (make-flusher recorders)
  (let ((last (current-time)))
    (lambda (world until)
      (unless (= (current-time) last)
        (set! last (current-time))
        (for-each (match-lambda ((flush . _) (flush))) recorders)))))

;; Every recorder is closed, also where closing another fails; the first failure is raised.
(define (close-all recorders)
  (let loop ((recorders recorders) (failure #f))
    (match recorders
      (() (when failure (apply throw failure)))
      (((_ . close) . rest)
       (loop rest
             (catch 'timewarp-error
               (lambda () (close) failure)
               (lambda args (or failure args))))))))

(define* (call-with-recorders world thunk #:key frames size quality contacts? poses events)
  "Call THUNK while WORLD is recorded: frames to pictures, poses and events to CSV files.  Every
file is closed however THUNK is left, by SIGTERM and SIGHUP too."
  (call-with-ending-signals
   (lambda ()
     (record world thunk frames size quality contacts? poses events))))

(define (record world thunk frames size quality contacts? poses events)
  (let ((recorders
         (append (if poses (list (start-csv! world %open-poses poses)) '())
                 (if events (list (start-csv! world %open-events events)) '())
                 (if frames (list (start-frames! world frames size quality contacts?)) '()))))
    (call-with-values
        (lambda ()
          (catch #t
            (lambda ()
              (parameterize ((current-slice-hooks
                              (cons (make-flusher recorders) (current-slice-hooks))))
                (thunk)))
            (lambda (key . args)
              ;; what made the run stop is what is told, not what came of it
              (catch 'timewarp-error (lambda () (close-all recorders)) (const #f))
              (apply throw key args))))
      (lambda results
        (close-all recorders)
        (apply values results)))))
