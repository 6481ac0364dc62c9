;; Runs of a sweep by Slurm: a job array, each task a line of runs, and a job after it that gathers.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-slurm)
  #:use-module (timewarp errors)
  #:use-module (timewarp sweep-files)
  #:use-module (timewarp sweep-process)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 ftw)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:use-module (ice-9 popen)
  #:use-module (ice-9 textual-ports)
  #:export (check-slurm
            check-no-job
            most-tasks
            print-array-script
            print-merge-script
            submit
            wait-for-job))

;; Slurm's own bound for an array, MaxArraySize, is 1001 unless somebody has changed it.
(define most-tasks 1000)

(define (check-slurm)
  "Raise an error unless Slurm's commands are there."
  (require-program "sbatch" "slurm-client" "--slurm"))

;; ---- scripts ----

;; sbatch takes these lines apart as a shell does, and reads % in names of files.
(define (log-name folder suffix)
  (shell-quote (string-append (string-join (string-split (in-sweep folder "batches") #\%) "%%")
                              suffix)))

(define (print-head port name directives)
  (format port "#!/bin/sh~%#SBATCH --job-name=~a~%#SBATCH --ntasks=1~%" (shell-quote name))
  (for-each (lambda (directive) (format port "#SBATCH ~a~%" directive)) directives))

(define (print-array-script port folder name tasks jobs options batch task-command)
  "Print the script of a job array of so many TASKS, at most JOBS at a time (#f: as many as Slurm
lets), that runs TASK-COMMAND=LINE with the lines of the file BATCH; OPTIONS are further ones of
sbatch."
  (print-head port name
              (cons* (format #f "--array=0-~a~a" (1- tasks) (if jobs (string-append "%" jobs) ""))
                     (string-append "--output=" (log-name folder "/%A_%a.log"))
                     options))
  (format port "~%# line N of the list, from 0, holds the runs of task N~%")
  (format port "runs=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" ~a)~%" (shell-quote batch))
  (format port "exec ~a=\"$runs\"~%" (command->text task-command)))

(define (print-merge-script port folder name options merge-command)
  "Print the script of the job that does MERGE-COMMAND when an array is over."
  (print-head port (string-append name "-merge")
              (cons (string-append "--output=" (log-name folder "/%j-merge.log")) options))
  (format port "~%exec ~a~%" (command->text merge-command)))

;; ---- jobs ----

;; What a command prints, and its exit status.
(define (text-of command)
  (let* ((port (apply open-pipe* OPEN_READ command))
         (text (get-string-all port)))
    (values (string-trim-both text) (status:exit-val (close-pipe port)))))

(define (job-files folder)
  (map (lambda (name) (in-sweep folder "batches" name))
       (or (scandir (in-sweep folder "batches") (lambda (name) (string-suffix? ".job" name))) '())))

;; Of a job that Slurm has forgotten squeue says nothing, or that it is invalid.
(define (in-queue? job)
  (not (string-null? (text-of (list "sh" "-c" "squeue --noheader --jobs=\"$1\" 2>/dev/null" "squeue"
                                    job)))))

(define (check-no-job folder)
  "Raise an error if a job that was submitted for FOLDER is still in Slurm's queue."
  (when (search-path (parse-path (or (getenv "PATH") "")) "squeue")
    (for-each
     (lambda (job)
       (when (in-queue? job)
         (raise-error (format #f "job ~a, which works in ~a, is still queued or running; ~
                                  expected its end, or: scancel ~a" job folder job))))
     (append-map file-lines (job-files folder)))))

(define (submit script . options)
  "Submit SCRIPT with further OPTIONS of sbatch; return the number of the job."
  (call-with-values (lambda () (text-of `("sbatch" "--parsable" ,@options ,script)))
    (lambda (text status)
      (unless (eqv? status 0)
        (raise-error (format #f "sbatch does not take ~a, status ~a; expected a script that it ~
                                 takes; --sbatch=OPTION adds to it" script status)))
      ;; JOB or JOB;CLUSTER
      (first (string-split text #\;)))))

(define (wait-for-job job)
  "Wait until JOB is over; return #f if a signal came before."
  (call-with-stopping-signals
   (const #t)
   (lambda ()
     (let loop ()
       (cond ((stopping?) #f)
             ((in-queue? job) (sleep 2) (loop))
             (else #t))))))
