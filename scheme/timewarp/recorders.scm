;; Recorders: what a run writes to files, opened before it, attached when it begins, closed however
;; it ends.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp recorders)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp worlds)
  #:use-module (timewarp running)
  #:use-module (timewarp drawing)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-9)
  #:export (call-with-recorders))

;; A recorder: FOLLOW lets a world feed it from that world's next run on, PACE is called between
;; slices and FLUSH once a second, CLOSE with whether the run was interrupted.  PACE and CLOSE get what
;; is to be done again and again while they wait, too.
(define-record-type <recorder>
  (make-recorder follow pace flush close)
  recorder?
  (follow recorder-follow)
  (pace recorder-pace)
  (flush recorder-flush)
  (close recorder-close))

;; A recorder that ATTACH feeds from one world only, the first to run of those it is told to follow.
;; CLOSE is given that world, or #f, and what it gets.
(define (record-one-world what attach pace flush close)
  (let ((attached #f))
    (make-recorder
     (lambda (world)
       (when attached
         (raise-error (string-append what " record a world that has run already; expected a new "
                                     "world (reset!, load-scene) before the first run")))
       (at-first-run! world
         (lambda ()
           (unless attached
             (attach world)
             (set! attached world)))))
     pace
     flush
     ;; what is closed before a world ran must not be fed by it later
     (lambda (interrupted? idle)
       (let ((world (and (not (eq? attached 'closed)) attached)))
         (set! attached 'closed)
         (close world interrupted? idle))))))

(define (csv-recorder what open file)
  (let ((recorder (open file)))
    (record-one-world what
                      (lambda (world) (%attach-recorder! world recorder (world-fps world)))
                      (const #f)
                      (lambda () (%flush-recorder! recorder))
                      (lambda (world interrupted? idle)
                        (%close-recorder! (or world (current-world)) recorder)))))

(define (frames-recorder frames movie size quality contacts? bare?)
  (let ((drawer (open-frames frames movie size quality bare?)))
    (record-one-world (if frames "frames" "a movie")
                      (lambda (world) (attach-frames! world drawer (world-fps world) contacts?))
                      ;; one is being written, one drawn, one is waiting: more would only fill memory
                      (lambda (idle) (await-frames drawer 3 idle))
                      (const #f)
                      (lambda (world interrupted? idle)
                        (when world (close-frames! world drawer interrupted? idle))))))

;; One picture, of the moment TIME.
(define (shot-recorder file time size quality contacts? bare?)
  (let ((drawn? #f))
    (check-shot file size quality)
    (record-one-world "a picture"
                      (lambda (world)
                        (keep-first-view! world)
                        (stop-at! world time
                          (lambda ()
                            (draw-world! world file size quality contacts? bare?)
                            (set! drawn? #t))))
                      (const #f)
                      (const #f)
                      (lambda (world interrupted? idle)
                        (unless (or drawn? interrupted?)
                          (raise-error (format #f "no run! reached ~a s, of which ~a was to be drawn"
                                               time file)))))))

;; A slice hook: the run waits for the slowest recorder, what is recorded reaches the files once a
;; second, and a full disk shows as soon.  While it waits the OTHERS have their say.
(define (make-pacer recorders others)
  (let ((last (current-time)))
    (lambda (world until)
      (define (idle) (for-each (lambda (hook) (hook world until)) others))
      (for-each (lambda (recorder) ((recorder-pace recorder) idle)) recorders)
      (unless (= (current-time) last)
        (set! last (current-time))
        (for-each (lambda (recorder) ((recorder-flush recorder))) recorders)))))

(define (stops-at-once? key)
  (or (eq? key 'timewarp-interrupted) (ending?)))

;; Every recorder is closed, also where closing another fails; the first failure is raised.
(define (close-all recorders interrupted?)
  (define (idle)
    (let ((world (current-world)))
      (for-each (lambda (hook) (hook world (%world-time world))) (current-slice-hooks))))
  (let loop ((recorders recorders) (interrupted? interrupted?) (failure #f))
    (match recorders
      (() (when failure (apply throw failure)))
      ((recorder . rest)
       (match (catch #t
                (lambda () ((recorder-close recorder) interrupted? idle) #f)
                list)
         (#f (loop rest interrupted? failure))
         (raised (loop rest
                       (or interrupted? (stops-at-once? (car raised)))
                       (or failure raised))))))))

;; Two recorders would write over one another, and so would pictures over tables.
(define (check-files poses events movie)
  (define (check-table what file)
    (when (and (string? file) (string-suffix-ci? ".png" file))
      (bad-value what file "a name for a CSV file, not for a picture")))
  (check-table "the poses file" poses)
  (check-table "the events file" events)
  (for-each (lambda (table)
              (when (and movie table (same-file? movie table))
                (bad-value "the movie" movie "another file than those of poses and events")))
            (list poses events))
  (when (and poses events (same-file? poses events))
    (bad-value "the events file" events "another file than that of the poses")))

;; Whether two names lead to one file on a disk, there or not yet.
(define (same-file? a b)
  (define (identity file)
    (match (stat file #f)
      (#f (match (stat (dirname file) #f)
            (#f file)
            (folder (list (stat:dev folder) (stat:ino folder) (basename file)))))
      (there (and (eq? (stat:type there) 'regular) (list (stat:dev there) (stat:ino there))))))
  (let ((one (identity a)))
    (and one (equal? one (identity b)))))

(define* (call-with-recorders thunk #:key frames movie at size quality contacts?
                              bare? poses events)
  "Call THUNK while the current world, or one that takes its place before anything has run, is
recorded: frames to pictures and to a movie, poses and events to CSV files.  With AT, FRAMES is a
file, for one picture of that time.  Every file is closed however THUNK is
left, by SIGTERM and SIGHUP too."
  (check-files poses events movie)
  (call-with-ending-signals
   (lambda ()
     (record thunk
             (append (if poses (list (csv-recorder "poses" %open-poses poses)) '())
                     (if events (list (csv-recorder "events" %open-events events)) '())
                     (if at (list (shot-recorder frames at size quality contacts? bare?)) '())
                     (if (or movie (and frames (not at)))
                         (list (frames-recorder (and (not at) frames) movie size quality contacts? bare?))
                         '()))))))

(define (record thunk recorders)
  (let ((follows (map recorder-follow recorders)))
    (for-each (lambda (follow) (follow (current-world))) follows)
    (call-with-values
        (lambda ()
          (catch #t
            (lambda ()
              (parameterize ((current-slice-hooks
                              (cons (make-pacer recorders (current-slice-hooks))
                                    (current-slice-hooks)))
                             (current-world-followers
                              (append follows (current-world-followers))))
                (thunk)))
            (lambda (key . args)
              ;; what made the run stop is what is told, not what came of it
              (catch #t
                (lambda () (close-all recorders (stops-at-once? key)))
                (const #f))
              (apply throw key args))))
      (lambda results
        (close-all recorders #f)
        (apply values results)))))
