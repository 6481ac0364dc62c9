;; Runs of a sweep on this machine, or those that it can log in to, by GNU Parallel.
;;
;; GNU Parallel starts the tasks, as many at a time as it is told to, on whatever machines it
;; knows, and stops them.  What is finished we know from the results themselves rather than from
;; its --joblog: that counts jobs by their order in one list, and the list changes when a sweep is
;; extended.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-local)
  #:use-module (timewarp progress)
  #:use-module (timewarp sweep-process)
  #:use-module (ice-9 match)
  #:use-module (ice-9 rdelim)
  #:export (check-local
            run-locally))

(define (check-local)
  "Raise an error unless GNU Parallel is there."
  (require-program "parallel" "parallel" "running a sweep on this machine"))

;; s between the signal that asks a run to close its files and the one that kills it
(define patience 10)

(define (parallel-command task-command batch jobs options)
  (append (list "parallel" "--will-cite" "--line-buffer" "--arg-file" batch
                "--termseq" (format #f "TERM,~a,KILL,25" (* 1000 patience)))
          (if jobs (list "--jobs" jobs) '())
          options
          ;; one word: GNU Parallel hands it to a shell; {} are numbers and commas
          (list (string-append (command->text task-command) "={}"))))

;; ---- progress ----

(define (wall-seconds)
  (exact->inexact (/ (get-internal-real-time) internal-time-units-per-second)))

(define (progress-text done failed total elapsed)
  (format #f "~a of ~a runs~a~a" done total
          (if (zero? failed) "" (format #f ", ~a failed" failed))
          (if (or (zero? done) (= done total))
              ""
              (format #f ", ~a left" (duration-text (* elapsed (/ (- total done) done)))))))

;; A procedure to be called with what is done and what failed: on a terminal a line that rewrites
;; itself, elsewhere a plain one every few seconds.
(define (make-report total quiet?)
  (let* ((port (current-error-port)) (terminal? (isatty? port)) (start (wall-seconds)) (last start))
    (lambda (done failed)
      (let ((now (wall-seconds)))
        (when (and (not quiet?) (> (- now last) (if terminal? 0.1 3)))
          (set! last now)
          (let ((text (progress-text done failed total (- now start))))
            (if terminal?
                (format port "\r~a\x1b[K" text)
                (format port "~a~%" text)))
          (force-output port))))))

(define (end-report quiet?)
  (when (and (not quiet?) (isatty? (current-error-port)))
    (format (current-error-port) "\r\x1b[K")))

;; "run NUMBER STATUS", a line from each task; what else comes is a message for the user.
(define (read-report line)
  (match (string-tokenize line)
    (("run" (= string->number (? identity)) (= string->number (? identity status))) status)
    (_ #f)))

(define (follow port report)
  (let loop ((done 0) (failed 0))
    (report done failed)
    (match (read-line port)
      ((? eof-object?) #t)
      (line (match (read-report line)
              (#f (format (current-error-port) "~a~%" line) (loop done failed))
              (0 (loop (1+ done) failed))
              (_ (loop (1+ done) (1+ failed))))))))

;; ---- the run ----

(define* (run-locally task-command batch total #:key jobs (options '()) quiet?)
  "Run the tasks of the file BATCH, a line each, by TASK-COMMAND=LINE; TOTAL runs are in them.
Return whether all were seen to, rather than stopped by a signal."
  (match (pipe)
    ((in . out)
     (let ((parallel #f))
       (define (stop!)
         (when parallel (kill parallel SIGTERM)))
       (call-with-stopping-signals stop!
         (lambda ()
           ;; a process group of its own: Ctrl-C reaches it through us only, and once
           (set! parallel (start-process (parallel-command task-command batch jobs options)
                                         #:output out #:own-group? #t))
           (close-port out)
           (follow in (make-report total quiet?))
           (end-report quiet?)
           (close-port in)
           (wait-for-process parallel)
           (not (stopping?))))))))
