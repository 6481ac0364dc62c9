;; Recorders: what a run writes to files, opened before it, attached when it begins, closed however it
;; ends.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp recorders)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (timewarp running)
  #:use-module (timewarp drawing)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-9)
  #:export (call-with-recorders))

;; A recorder: FOLLOW lets a world feed it from that world's next run on, FLUSH and CLOSE are thunks.
(define-record-type <recorder>
  (make-recorder follow flush close)
  recorder?
  (follow recorder-follow)
  (flush recorder-flush)
  (close recorder-close))

;; A recorder that ATTACH feeds from one world only, the first to run of those it is told to follow.
;; CLOSE is given that world, or #f.
(define (record-one-world what attach flush close)
  (let ((attached #f))
    (make-recorder
     (lambda (world)
       (when attached
         (raise-error (string-append what " record a world that has run already; expected a new world "
                                     "(reset!, load-scene) before the first run")))
       (at-first-run! world
         (lambda ()
           (unless attached
             (attach world)
             (set! attached world)))))
     flush
     (lambda () (close attached)))))

(define (csv-recorder what open file)
  (let ((recorder (open file)))
    (record-one-world what
                      (lambda (world) (%attach-recorder! world recorder (world-fps world)))
                      (lambda () (%flush-recorder! recorder))
                      (lambda (world) (%close-recorder! (or world (current-world)) recorder)))))

(define (frames-recorder frames size quality contacts?)
  (let ((drawer (open-frames frames size quality)))
    (record-one-world "frames"
                      (lambda (world) (attach-frames! world drawer (world-fps world) contacts?))
                      (const #f)
                      (lambda (world) (when world (close-frames! world drawer))))))

;; A slice hook: what is recorded reaches the files once a second, and a full disk shows as soon.
(define (make-flusher recorders)
  (let ((last (current-time)))
    (lambda (world until)
      (unless (= (current-time) last)
        (set! last (current-time))
        (for-each (lambda (recorder) ((recorder-flush recorder))) recorders)))))

;; Every recorder is closed, also where closing another fails; the first failure is raised.
(define (close-all recorders)
  (let loop ((recorders recorders) (failure #f))
    (match recorders
      (() (when failure (apply throw failure)))
      ((recorder . rest)
       (loop rest
             (catch 'timewarp-error
               (lambda () ((recorder-close recorder)) failure)
               (lambda args (or failure args))))))))

(define* (call-with-recorders thunk #:key frames size quality contacts? poses events)
  "Call THUNK while the current world, or one that takes its place before anything has run, is
recorded: frames to pictures, poses and events to CSV files."
  (let* ((recorders
          (append (if poses (list (csv-recorder "poses" %open-poses poses)) '())
                  (if events (list (csv-recorder "events" %open-events events)) '())
                  (if frames (list (frames-recorder frames size quality contacts?)) '())))
         (follows (map recorder-follow recorders)))
    (for-each (lambda (follow) (follow (current-world))) follows)
    (call-with-values
        (lambda ()
          (catch #t
            (lambda ()
              (parameterize ((current-slice-hooks
                              (cons (make-flusher recorders) (current-slice-hooks)))
                             (current-world-followers
                              (append follows (current-world-followers))))
                (thunk)))
            (lambda (key . args)
              ;; what made the run stop is what is told, not what came of it
              (catch 'timewarp-error (lambda () (close-all recorders)) (const #f))
              (apply throw key args))))
      (lambda results
        (close-all recorders)
        (apply values results)))))
