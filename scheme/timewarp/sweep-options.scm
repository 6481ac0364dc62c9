;; The options of the program `timewarp-sweep': its own, and those of timewarp that it takes lists
;; of or hands on.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-options)
  #:use-module (timewarp option-table)
  #:use-module (timewarp options)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:export (parse-sweep-options sweep-option-help documented-options
            timewarp-row own-option? swept-option? output-option? output-options))

;; ---- values ----

(define (jobs name text)
  (unless (jobs? text)
    (usage-error "--jobs is ~s; expected a positive integer, or a share of the processors like 50%"
                 text))
  text)

(define (jobs? text)
  (let ((digits (string-trim-right text #\%)))
    (and (<= (- (string-length text) (string-length digits)) 1)
         (match (string->number digits) ((? exact-integer? n) (> n 0)) (_ #f)))))

(define (numbers name text)
  (map (lambda (part)
         (match (string->number part)
           ((and (? exact-integer?) (? positive? number)) number)
           (_ (usage-error "--~a is ~s; expected numbers of runs such as 3,4,5" name text))))
       (string-split text #\,)))

(define (names name text)
  (let ((names (string-split text #\,)))
    (when (any string-null? names) (usage-error "--~a is ~s; expected NAME,NAME..." name text))
    names))

(define (plot-spec name text)
  "Return (STATISTIC PARAMETER CURVES), CURVES #f or the name of what tells one curve from another."
  (match (string-split text #\:)
    (((? (negate string-null?) y) (? (negate string-null?) x)) (list y x #f))
    (((? (negate string-null?) y) (? (negate string-null?) x) (? (negate string-null?) z))
     (list y x z))
    (_ (usage-error "--plot is ~s; expected STATISTIC:PARAMETER or STATISTIC:PARAMETER:PARAMETER"
                    text))))

(define (plot-log name text)
  (unless (member text '("x" "y" "xy"))
    (usage-error "--log is ~s; expected x, y or xy" text))
  text)

(define (plot-picture name text)
  (unless (or (string-suffix-ci? ".png" text) (string-suffix-ci? ".svg" text))
    (usage-error "--picture is ~s; expected a name that ends in .png or .svg" text))
  text)

;; ---- the program's own ----

(define own-options
  `((out ("out") "FOLDER" ,text "where all goes; alone: go on with what is planned there")
    (jobs (#\j "jobs") "N" ,jobs "runs at a time; N% of the processors (all processors)")
    (dry-run ("dry-run") #f #f "print what would be run, or submitted; do nothing")
    (timeout ("timeout") "SECONDS" ,positive "end a run that takes longer, as one that failed")
    (parts ("parts") "N" ,positive-integer
           "draw the frames of each run in N tasks, every N-th frame in each")
    (keep ("keep") #f #f "keep finished runs though the scene's file has changed")
    (again ("again") #f #f "forget what FOLDER holds and run all anew")
    (chunk ("chunk") "N" ,positive-integer
           "N runs a task (1; with --slurm so many that 1000 tasks are enough)")
    (merge ("merge") #f #f "run nothing: gather FOLDER/runs.jsonl, say what failed")
    (columns ("columns") "NAMES" ,names "print NAME,NAME... of finished runs, separated by tabs")
    (plot ("plot") "Y:X[:Z]" ,plot-spec "plot Y against X by gnuplot, a curve for each Z")
    (log ("log") "AXES" ,plot-log "logarithmic axes of the plot: x, y or xy")
    (picture ("picture") "FILE" ,plot-picture "the plot's file, .png or .svg (FOLDER/Y-X.png)")
    (slurm ("slurm") #f #f "by Slurm: submit a job array instead of running here")
    (wait ("wait") #f #f "with --slurm: wait for the end, then report")
    (sbatch ("sbatch") "OPTION" ,text "hand an option to sbatch, such as --mem=2G (repeatable)")
    (parallel ("parallel") "OPTION" ,text "hand an option to GNU Parallel (repeatable)")
    (task ("task") "RUNS" ,numbers "run these of FOLDER's plan, here: what the jobs do")
    (quiet ("quiet") #f #f "no progress")
    (help (#\h "help") #f #f "this help")
    (version (#\v "version") #f #f "the version")))

;; ---- those of timewarp ----

;; may list values
(define swept '(define until fps size quality policy integrator accuracy seed group-check-rate))
;; name a file in the folder of each run
(define output-options '(frames movie poses events write-states))
;; make no sense here
(define refused
  '((stats . "the statistics of every run are in FOLDER/runs.jsonl")
    (part . "--parts=N makes the parts")
    (interactive . "runs of a sweep have no prompt")
    (listen . "runs of a sweep have no prompt")
    (watch . "a sweep runs once; runs that are done are not repeated")
    (files-read . "it belongs to --watch")))

(define (timewarp-row key) (assq key timewarp-options))
(define (own-option? key) (->bool (assq key own-options)))
(define (swept-option? key) (->bool (memq key swept)))
(define (output-option? key) (->bool (memq key output-options)))

;; As text: each value of a list is looked at by itself.
(define (row->taken row)
  (match row
    ((key names argument convert help)
     (list key names argument
           (cond ((assq-ref refused key)
                  => (lambda (why)
                       (lambda (name text) (usage-error "--~a is not for sweeps: ~a" name why))))
                 ((memq key swept) #f)
                 (else (and convert (lambda (name text) (convert name text) text))))
           help))))

(define taken-options
  (map row->taken (remove (lambda (row) (assq (row-key row) own-options)) timewarp-options)))

(define (parse-sweep-options args)
  "Return an alist of the options in ARGS; those of timewarp have their texts."
  (parse-options (append own-options taken-options) args))

;; ---- help ----

(define (documented-options)
  "Return (NAMES ARGUMENT HELP) of the program's own options."
  (documented-rows own-options))

(define (names-of keys)
  (string-join (map (lambda (key)
                      (if (eq? key 'define) "-D NAME" (string-append "--" (symbol->string key))))
                    keys)
               ", "))

(define (sweep-option-help)
  "Return the text of --help that lists the options."
  (string-append
   (rows-help own-options)
   "\nOptions of timewarp.  Those that list values, of which every combination is run:\n    "
   (names-of swept)
   "\nThose that name a file in the folder of each run, FOLDER/runs/00001:\n    "
   (names-of (delq 'write-states output-options))
   "\nAll others are handed on as they are; see timewarp --help.\n"))
