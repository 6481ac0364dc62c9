;; The program `timewarp-sweep': many runs of one scene, over its parameters and timewarp's options.
;;
;; Exit status: 0 if all runs are finished; 1 if one failed, or for an error; 2 for wrong usage; 130
;; after Ctrl-C, SIGTERM or SIGHUP.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp exit-status)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp option-table)
  #:use-module (timewarp sweep-files)
  #:use-module (timewarp sweep-local)
  #:use-module (timewarp sweep-options)
  #:use-module (timewarp sweep-plan)
  #:use-module (timewarp sweep-plot)
  #:use-module (timewarp sweep-process)
  #:use-module (timewarp sweep-request)
  #:use-module (timewarp sweep-results)
  #:use-module (timewarp sweep-slurm)
  #:use-module (timewarp sweep-task)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 ftw)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:export (main))

;; ---- help and version ----

(define (show-help)
  (display "Usage: timewarp-sweep SCENE.scm --out=FOLDER [OPTION]... [OPTION OF timewarp]...\n")
  (display "Run a scene with every combination of the values that options list.\n\n")
  (display "VALUES of -D NAME=VALUES and of timewarp's options: VALUE,VALUE...; FROM..TO;\n")
  (display "FROM..TO..STEP; FROM..TO..xFACTOR; in double quotes what is none of these.\n\n")
  (display (sweep-option-help)))

;; ---- usage ----

(define (scene-operand options)
  (match (option-values options 'operand)
    (() #f)
    ((scene) scene)
    (_ (usage-error "there is more than one scene; expected one"))))

(define (out-folder options)
  (match (option-ref options 'out)
    (#f (usage-error "there is no --out; expected --out=FOLDER for the results"))
    ((? absolute-file-name? folder) folder)
    (folder (in-vicinity (getcwd) folder))))

(define (looking? options)
  (any (lambda (key) (option-ref options key)) '(merge columns plot)))

(define (check-usage options scene)
  (define (given key) (option-ref options key))
  (define (needs key other)
    (when (and (given key) (not (given other)))
      (usage-error "--~a says nothing without --~a; expected both" key other)))
  (needs 'wait 'slurm)
  (needs 'log 'plot)
  (needs 'picture 'plot)
  (needs 'parts 'frames)
  (for-each (lambda (key)
              (when (and (given 'parts) (given key))
                (usage-error "--~a is written by every part of --parts; expected one of them" key)))
            '(movie poses events write-states))
  (when (and (given 'keep) (given 'again))
    (usage-error "--keep and --again contradict each other; expected one of them"))
  (when (and (given 'slurm) (given 'jobs) (string-suffix? "%" (given 'jobs)))
    (usage-error "--jobs is ~s; expected a number of tasks with --slurm" (given 'jobs)))
  (when (and (given 'frames) (string-index (out-folder options) #\%))
    (usage-error "--out is ~s; expected a name without % where frames are drawn" (given 'out)))
  ;; values are looked at, too
  (when (and (pair? (sweep-axes options)) (not scene))
    (usage-error "there is no scene; expected timewarp-sweep SCENE.scm ...; without one the plan ~
                  in --out is gone on with as it is"))
  (unless (or scene (file-exists? (plan-file (out-folder options))))
    (usage-error "there is no scene, and no plan in ~a; expected timewarp-sweep SCENE.scm ~
                  --out=FOLDER ..." (out-folder options))))

;; ---- the plan ----

(define (same-request? plan new)
  (and (equal? (plan-directory plan) (plan-directory new))
       (equal? (plan-scene plan) (plan-scene new))
       (equal? (plan-arguments plan) (plan-arguments new))
       (equal? (plan-outputs plan) (plan-outputs new))))

(define (check-same-request plan new folder)
  (define (show plan)
    (format #f "~a, in ~a" (command->text
                            (append (list (plan-scene plan)) (plan-arguments plan)
                                    (map (match-lambda
                                           ((name . file) (string-append "--" name "=" file)))
                                         (plan-outputs plan))))
            (plan-directory plan)))
  (unless (same-request? plan new)
    (raise-error
     (format #f "~a holds a sweep of ~a; this one is of ~a; expected the same, another --out, or ~
                 --again" folder (show plan) (show new)))))

;; What was run must be what is run now, as far as the scene's own file tells; a copy of it is kept.
(define (keep-scene! folder plan keep?)
  (let ((scene (if (absolute-file-name? (plan-scene plan))
                   (plan-scene plan)
                   (in-vicinity (plan-directory plan) (plan-scene plan))))
        (copy (scene-copy-file folder)))
    (unless (file-exists? scene)
      (raise-error (format #f "there is no scene ~a; expected a Scheme file" scene)))
    (unless (or keep? (not (file-exists? copy)) (same-bytes? scene copy))
      (raise-error
       (format #f "~a has changed since the sweep in ~a began; expected --keep to keep the runs ~
                   that are finished, --again to run all anew, or another --out" scene folder)))
    (copy-file scene copy)))

(define (forget! folder)
  (for-each (lambda (name) (system* "rm" "-rf" (in-sweep folder name)))
            '("plan.scm" "scene.scm" "runs.jsonl" "runs" "batches")))

(define (options->plan options scene)
  (make-plan (getcwd) scene (handed-on options) (run-outputs options) '()))

;; The plan as it is asked for, and the runs that are: all where there is no scene.
(define (plan-runs-of options scene folder)
  (let ((old (and (not (option-ref options 'again)) (read-plan folder))))
    (if scene
        (let ((new (options->plan options scene)))
          (when old (check-same-request old new folder))
          (extend-plan (or old new) (all-combinations (sweep-axes options))))
        (let ((plan (or old (read-plan folder))))
          (values plan (plan-runs plan))))))

;; ---- running ----

(define (unfinished folder runs)
  (remove (lambda (run) (finished? (read-result folder run))) runs))

(define (task-command folder options)
  (append (list (sweep-program) (string-append "--out=" folder))
          (match (option-ref options 'timeout)
            (#f '())
            (timeout (list (format #f "--timeout=~a" (exact->inexact timeout)))))
          (list "--task")))

(define (chunk-size options runs)
  (or (option-ref options 'chunk)
      (if (option-ref options 'slurm) (ceiling-quotient (length runs) most-tasks) 1)))

(define (chunks runs size)
  (if (<= (length runs) size)
      (list runs)
      (cons (list-head runs size) (chunks (list-tail runs size) size))))

(define (batch-lines runs size)
  (map (lambda (chunk)
         (string-join (map (lambda (run) (number->string (run-number run))) chunk) ","))
       (chunks runs size)))

(define (next-batch folder)
  (1+ (apply max 0 (filter-map (lambda (name) (string->number (basename name ".runs")))
                               (or (scandir (in-sweep folder "batches")
                                            (lambda (name) (string-suffix? ".runs" name)))
                                   '())))))

(define (write-lines file lines)
  (write-whole-file file
    (lambda (port) (for-each (lambda (line) (format port "~a~%" line)) lines))))

(define (job-name plan)
  (string-append "timewarp-" (basename (plan-scene plan) ".scm")))

(define (print-script port options plan folder lines number)
  (print-array-script port folder (job-name plan) (length lines) (option-ref options 'jobs)
                      (option-values options 'sbatch) (batch-file folder number ".runs")
                      (task-command folder options)))

(define (show-dry-run options plan folder runs)
  (cond ((null? runs) (complain "nothing to run: all is finished in ~a" folder))
        ((option-ref options 'slurm)
         (print-script (current-output-port) options plan folder
                       (batch-lines runs (chunk-size options runs)) (next-batch folder)))
        (else
         (for-each (lambda (run)
                     (format #t "~a~%" (command->text (run-command plan run folder))))
                   runs))))

;; Return whether the runs were seen to.
(define (run-here options plan folder runs)
  (let* ((file (batch-file folder (next-batch folder) ".runs")))
    (write-lines file (batch-lines runs (chunk-size options runs)))
    (run-locally (task-command folder options) file (length runs)
                 #:jobs (option-ref options 'jobs)
                 #:options (option-values options 'parallel)
                 #:quiet? (option-ref options 'quiet))))

(define (submit-runs options plan folder runs)
  (let* ((number (next-batch folder))
         (lines (batch-lines runs (chunk-size options runs)))
         (script (batch-file folder number ".sh"))
         (merge-script (batch-file folder number "-merge.sh")))
    (write-lines (batch-file folder number ".runs") lines)
    (write-whole-file script
      (lambda (port) (print-script port options plan folder lines number)))
    (write-whole-file merge-script
      (lambda (port)
        (print-merge-script port folder (job-name plan) (option-values options 'sbatch)
                            (list (sweep-program) (string-append "--out=" folder) "--merge"))))
    (let ((job (submit script)))
      (write-lines (batch-file folder number ".job") (list job))
      (let ((merge-job (submit merge-script (string-append "--dependency=afterany:" job))))
        (complain "job ~a: ~a runs in ~a tasks; job ~a gathers ~a after it" job (length runs)
                  (length lines) merge-job (merged-file folder))
        merge-job))))

(define (run-by-slurm options plan folder runs)
  (let ((job (submit-runs options plan folder runs)))
    (cond ((not (option-ref options 'wait)) 'submitted)
          ((wait-for-job job) #t)
          (else (complain "the jobs go on; squeue shows them, scancel ends them") #f))))

;; ---- what is asked for ----

(define (interrupted) (throw 'timewarp-interrupted))

;; Gathers all results, tells of those of RUNS where TELL? is true, then shows what is asked for.
;; Return an exit status.
(define (look options folder plan runs tell?)
  (let* ((results (merge-results folder plan))
         (all? (or (not tell?) (report-results folder plan (results-of runs results)))))
    (match (option-ref options 'columns)
      (#f #t)
      (names (print-columns (finished-results results) names)))
    (match (option-ref options 'plot)
      (#f #t)
      (spec (complain "~a"
                      (plot-results folder (finished-results results) spec (option-ref options 'log)
                                    (option-ref options 'picture)
                                    (basename (plan-scene plan) ".scm")))))
    (if all? 0 1)))

(define (results-of runs results)
  (let ((numbers (make-hash-table)))
    (for-each (lambda (run) (hashv-set! numbers (run-number run) #t)) runs)
    (filter (match-lambda ((run . _) (hashv-ref numbers (run-number run)))) results)))

(define (save-plan! options plan folder)
  (when (option-ref options 'again) (forget! folder))
  (for-each (lambda (name) (make-folders (in-sweep folder name))) '("runs" "batches"))
  (keep-scene! folder plan (option-ref options 'keep))
  (write-plan plan folder))

(define (run-plan options plan folder asked)
  (if (option-ref options 'slurm) (check-slurm) (check-local))
  (save-plan! options plan folder)
  (check-no-job folder)
  (let ((runs (unfinished folder asked)))
    (match (cond ((null? runs) #t)
                 ((option-ref options 'slurm) (run-by-slurm options plan folder runs))
                 (else (run-here options plan folder runs)))
      ('submitted 0)
      (#t (look options folder plan asked #t))
      (#f (report-results folder plan (results-of asked (merge-results folder plan)))
          (complain "go on by: ~a"
                    (command->text (list "timewarp-sweep" (string-append "--out=" folder))))
          (interrupted)))))

(define (sweep options scene folder)
  (when (option-ref options 'plot) (check-plotting))
  (cond
   ((and (not scene) (looking? options))
    (let ((plan (read-plan folder)))
      (look options folder plan (plan-runs plan) (option-ref options 'merge))))
   ((option-ref options 'dry-run)
    (call-with-values (lambda () (plan-runs-of options scene folder))
      (lambda (plan runs)
        (show-dry-run options plan folder
                      (if (option-ref options 'again) runs (unfinished folder runs)))
        0)))
   (else
    (make-folders folder)
    (call-with-sweep-lock folder
      (lambda ()
        (call-with-values (lambda () (plan-runs-of options scene folder))
          (lambda (plan runs) (run-plan options plan folder runs))))))))

;; A line for each run, which tells those who follow; the runs' own failures are in their results.
(define (run-tasks options folder)
  (for-each (lambda (number)
              (let ((status (run-task folder number (option-ref options 'timeout))))
                (unless status (interrupted))
                (format #t "run ~a ~a~%" number status)
                (force-output)))
            (option-ref options 'task))
  0)

(define (work args)
  (let ((options (parse-sweep-options args)))
    (cond
     ((option-ref options 'version) (format #t "timewarp-sweep ~a~%" (%version)) 0)
     ((option-ref options 'help) (show-help) 0)
     ((option-ref options 'task) (run-tasks options (out-folder options)))
     (else
      (let ((scene (scene-operand options)) (folder (out-folder options)))
        (check-usage options scene)
        (sweep options scene folder))))))

(define (main args)
  "Do what the command line ARGS says; exit with a status."
  (call-with-write-errors
   (lambda ()
     (let* ((owed 1)
            (status (exit-status (lambda ()
                                   (set! owed (work args))
                                   (flush-output))
                                 "timewarp-sweep")))
       (exit-program (if (zero? status) owed status))))))
