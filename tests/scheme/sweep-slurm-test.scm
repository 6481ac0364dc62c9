;; timewarp-sweep --slurm, with commands that stand in for Slurm's: sbatch runs the script at once,
;; an array task by task, and squeue lists what the file `queue' holds.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp sweep-process))

(test-begin "sweep by Slurm")

(mkdir (in-folder "bin"))
(define (write-program name . lines)
  (chmod (apply write-file (string-append "bin/" name) "#!/bin/sh" lines) #o755))
(write-program "sbatch"
               "echo \"$*\" >>sbatch.log"
               "for script; do :; done"
               "job=$(wc -l <sbatch.log)"
               "last=$(sed -n 's/^#SBATCH --array=0-\\([0-9]*\\).*/\\1/p' \"$script\")"
               "for task in $(seq 0 \"${last:-0}\"); do"
               "  [ -e stuck ] || SLURM_ARRAY_TASK_ID=$task sh \"$script\" >>jobs.log 2>&1"
               "done"
               "echo \"$job;cluster\"")
(write-program "squeue" "cat queue 2>/dev/null" "true")

(define (sweep . args)
  (shell (string-append "PATH=$PWD/bin:$PATH " (shell-quote (sweep-program)) " "
                        (string-join args " ") " </dev/null")))
(define (runs folder)
  (map %read-json (lines-of (read-file (string-append folder "/runs.jsonl")))))

(define-syntax-rule (test-says name pattern text)
  (let ((said text)) (test-assert (format #f "~a: ~a" name said) (string-match pattern said))))

(write-file "ball.scm" "(use-modules (timewarp))" "(scene #:duration 0.1)"
            "(define-scene-parameter height 1.0 \"height, m\")"
            "(define-scene-parameter label \"ball\" \"name\")"
            "(add-body! #:name label #:shape (sphere 0.1) #:position (vector 0 0 height))"
            "(when (> height 3) (error \"too high\"))")

;; ---- the script ----

(define (script . args)
  (run-output (apply sweep "ball.scm" "--slurm" "--dry-run" args)))

(test-says "the script of a job array"
  (string-append "^#!/bin/sh\n#SBATCH --job-name=timewarp-ball\n#SBATCH --ntasks=1\n"
                 "#SBATCH --array=0-9%4\n#SBATCH --output=.*/out/batches/%A_%a.log\n"
                 "#SBATCH --time=10\n#SBATCH --partition=long\n\n#.*\n"
                 "runs=.*SLURM_ARRAY_TASK_ID.*/out/batches/00001.runs.*\n"
                 "exec /.*/timewarp-sweep --out=/.*/out --timeout=5.0 --task=\"[$]runs\"\n$")
  (script "--out=out" "--seed=1..10" "--jobs=4" "--sbatch=--time=10" "--sbatch=--partition=long"
          "--timeout=5"))
(test-assert "--dry-run makes nothing" (not (file-exists? (in-folder "out"))))
(test-says "--chunk gives a task several runs" "--array=0-3\n"
  (script "--out=out" "--seed=1..10" "--chunk=3"))
(test-says "more runs than an array may have tasks" "--array=0-833\n"
  (script "--out=out" "--seed=1..2500"))
(test-says "a folder's name for Slurm, and for a shell"
  (string-append "--output='.*/a b%%c/batches/%A_%a.log'\n(.|\n)*"
                 "'/.*/a b%c/batches/00001.runs'[)](.|\n)*'--out=/.*/a b%c' --task")
  (script "--out='a b%c'" "--seed=1"))

;; ---- running it ----

(define values "'label=\"a, b\",it'\\''s'")
(let ((result (sweep "ball.scm" "--out='my sweep'" "-D" "height=1..3" "-D" values "--slurm"
                     "--chunk=4" "--sbatch=--mem=1G")))
  (test-equal "submitted: status 0" 0 (run-status result))
  (test-says "the jobs are told"
    "^job 1: 6 runs in 2 tasks; job 2 gathers .*/my sweep/runs.jsonl after it\n$"
    (run-errors result))
  (test-says "the job that gathers comes after the array"
    (string-append "^--parsable /.*/my sweep/batches/00001.sh\n"
                   "--parsable --dependency=afterany:1 /.*/00001-merge.sh\n$")
    (read-file "sbatch.log"))
  (test-says "further options are for both" "#SBATCH --mem=1G\n"
    (read-file "my sweep/batches/00001-merge.sh"))
  (test-equal "all runs are finished and gathered" '(0 0 0 0 0 0)
    (map (lambda (run) (assoc-ref run "status")) (runs "my sweep")))
  (test-equal "their values are as given" '("a, b" "it's")
    (delete-duplicates (map (lambda (run) (assoc-ref (assoc-ref run "parameters") "label"))
                            (runs "my sweep")))))

(let ((result (sweep "ball.scm" "--out='my sweep'" "-D" "height=1..4" "-D" values "--slurm" "--wait"
                     "--sbatch=--mem=1G")))
  (test-equal "--wait, and a run that fails: status 1" 1 (run-status result))
  (test-equal "only what is not finished is submitted" '("7" "8")
    (lines-of (read-file "my sweep/batches/00002.runs")))
  (test-says "what failed is told" "8 runs in .*: 6 finished, 2 failed\nrun 7: status 1: .*too high"
    (run-errors result)))

(write-file "queue" "1_0 main ball")
(let ((result (sweep "--out='my sweep'" "--slurm")))
  (test-equal "while a job is in the queue: status 1" 1 (run-status result))
  (test-says "it is named"
    "job 1, which works in .*, is still queued or running; expected its end, or: scancel 1"
    (run-errors result)))
(write-file "stuck")
(let ((result (shell (string-append "PATH=$PWD/bin:$PATH timeout --preserve-status -s INT 2 "
                                    (shell-quote (sweep-program))
                                    " ball.scm --out=waiting --slurm --wait </dev/null"))))
  (test-equal "Ctrl-C while waiting: status 130" 130 (run-status result))
  (test-says "the jobs go on" "the jobs go on; squeue shows them, scancel ends them\n"
    (run-errors result)))

(write-program "sbatch" "echo 'no such partition' >&2" "exit 1")
(delete-file (in-folder "queue"))
(let ((result (sweep "ball.scm" "--out=refused" "--slurm")))
  (test-equal "sbatch refuses: status 1" 1 (run-status result))
  (test-says "what to do" "no such partition\n.*sbatch does not take .*00001.sh, status 1; expected"
    (run-errors result)))
(let ((result (sweep "ball.scm" "--out=none" "--slurm" "--jobs=50%")))
  (test-equal "shares of processors are not for Slurm" 2 (run-status result)))

(clean-up)
(test-end "sweep by Slurm")
