;; The program timewarp-sweep on this machine: what it runs, goes on with, tells and writes.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp sweep-process) (ice-9 ftw))

(test-begin "sweep")

(define (installed? program) (search-path (parse-path (getenv "PATH")) program))
(unless (installed? "parallel")
  (format #t "skipped: GNU Parallel is not installed (Debian: apt-get install parallel)~%")
  (exit 77))

(define (sweep . args)
  (shell (string-append (shell-quote (sweep-program)) " " (string-join args " ") " </dev/null")))

(write-file "ball.scm"
            "(use-modules (timewarp))"
            "(scene #:duration 0.1)"
            "(define-scene-parameter height 1.0 \"height of the drop, m\")"
            "(define-scene-parameter label \"ball\" \"name of the ball\")"
            "(define-scene-parameter most 10.0 \"height that is too much, m\")"
            "(define ball (add-body! #:name label #:shape (sphere 0.1)"
            "                        #:position (vector 0 0 height)))"
            "(when (> height most) (error \"too high:\" height))"
            "(run!)"
            "(format #t \"z = ~a~%\" (vector-ref (position ball) 2))"
            "(format #t \"  named ~a = 3 m~%\" (body-name ball))")

(define (runs folder)
  (map %read-json (lines-of (read-file (string-append folder "/runs.jsonl")))))
(define (run-of folder number)
  (find (lambda (run) (= number (assoc-ref run "run"))) (runs folder)))
(define (statuses folder) (map (lambda (run) (assoc-ref run "status")) (runs folder)))
(define (modified file) (stat:mtime (stat (in-folder file))))

(define-syntax-rule (test-says name pattern text)
  (let ((said text)) (test-assert (format #f "~a: ~a" name said) (string-match pattern said))))

;; ---- what is run ----

(let ((result (sweep "ball.scm" "--out=first" "-D" "height=0.5..1.5..0.5" "--seed=1,2" "--hash"
                     "--accuracy=1e-5")))
  (test-equal "a sweep: status 0" 0 (run-status result))
  (test-says "it says how it came out" "(^|\n)6 runs in .*/first: 6 finished\n$" (run-errors result))
  (test-equal "nothing on standard output" "" (run-output result)))

(let ((fourth (run-of "first" 4)))
  (test-equal "a line for each run, in their order" (iota 6 1)
    (map (lambda (run) (assoc-ref run "run")) (runs "first")))
  (test-equal "its parameters" '(("height" . 1)) (assoc-ref fourth "parameters"))
  (test-equal "its options" '(("seed" . 2) ("accuracy" . 1e-5)) (assoc-ref fourth "options"))
  (test-equal "its status" 0 (assoc-ref fourth "status"))
  (test-assert "its times"
    (and (> (assoc-ref fourth "wall_seconds") 0) (>= (assoc-ref fourth "process_cpu_seconds") 0)
         (string-match "^20[0-9-]*T[0-9:]*Z$" (assoc-ref fourth "started"))))
  (test-assert "its statistics"
    (= 0.1 (assoc-ref (assoc-ref fourth "statistics") "duration")))
  (test-assert "and the values that the scene prints"
    (match (assoc-ref fourth "values") ((("z" . z)) (close? z (- 1 (* 0.5 9.81 0.01)) 1e-6))))
  (test-equal "its hash is that of the command"
    (last (lines-of (run-output (run "ball.scm" "--quiet" "--hash" "-D" "height=1" "--seed=2"
                                     "--accuracy=1e-5"))))
    (assoc-ref fourth "hash")))

(let ((result (sweep "ball.scm" "--out=dry" "-D" "height=1,2" "-D" "'label=it'\\''s $x'"
                     "--dry-run")))
  (test-says "--dry-run prints commands for a shell"
    "^[^\n]*timewarp ball.scm -D height=1 -D 'label=it'[\\]''s [$]x'\n[^\n]*height=2[^\n]*\n$"
    (run-output result))
  (test-assert "and makes nothing" (not (file-exists? (in-folder "dry")))))

(let ((result (sweep "ball.scm" "--out='a \"b\" it'\\''s'"
                     "-D" "'label=\"a, b\",it'\\''s \"$(x)\" \\ %'" "--events=e.csv")))
  (test-equal "names and values with spaces and quotes: status 0" 0 (run-status result))
  (test-equal "and they arrive as they are" '("a, b" "it's \"$(x)\" \\ %")
    (map (lambda (run) (assoc-ref (assoc-ref run "parameters") "label")) (runs "a \"b\" it's")))
  (test-assert "what a run writes is in its folder"
    (file-exists? (in-folder "a \"b\" it's/runs/00002/e.csv"))))

;; ---- going on ----

(let ((before (modified "first/runs/00001.json"))
      (result (begin (sleep 1) (sweep "--out=first"))))
  (test-equal "what is finished is not run again" before (modified "first/runs/00001.json"))
  (test-equal "and that is success" 0 (run-status result)))

(let* ((before (read-file "first/runs/00003.json"))
       (result (sweep "ball.scm" "--out=first" "-D" "height=1..3" "--seed=1,2" "--hash"
                      "--accuracy=1e-5" "--chunk=3")))
  (test-says "further values add runs" "(^|\n)6 runs of the 10 in .*: 6 finished" (run-errors result))
  (test-equal "those that are there stay" before (read-file "first/runs/00003.json"))
  (test-equal "all are in the file" (iota 10 1)
    (map (lambda (run) (assoc-ref run "run")) (runs "first"))))

(test-says "another sweep into the same folder"
  "holds a sweep of ball.scm --hash, in .*; this one is of ball.scm, in .*--again"
  (run-errors (sweep "ball.scm" "--out=first" "-D" "height=1")))

(let ((result (sweep "ball.scm" "--out=failing" "-D" "height=9..12" "--quiet")))
  (test-equal "a run that fails: status 1" 1 (run-status result))
  (test-says "it is told, with its command and its log"
    (string-append "^4 runs in .*/failing: 2 finished, 2 failed\n"
                   "run 3: status 1: ball.scm:8:[0-9]+: too high: 11\n"
                   "  command: .*timewarp ball.scm -D height=11\n"
                   "  log:     .*/failing/runs/00003.log\nrun 4: ")
    (run-errors result))
  (test-equal "the others are run" '(0 0 1 1) (statuses "failing"))
  (test-says "its line says why" "too high: 11" (assoc-ref (run-of "failing" 3) "error")))
(test-says "a scene that has changed" "ball.scm has changed since .*; expected --keep .*--again"
  (begin
    (system* "sed" "-i" "s/most 10/most 11/" (in-folder "ball.scm"))
    (run-errors (sweep "--out=failing"))))
(let ((before (modified "failing/runs/00001.json")))
  (test-equal "--keep runs what failed again" '(1 (0 0 0 1))
    (list (run-status (sweep "--out=failing" "--keep")) (statuses "failing")))
  (test-equal "and keeps what is finished" before (modified "failing/runs/00001.json"))
  (test-equal "--again begins anew" '(0 (0))
    (list (run-status (sweep "ball.scm" "--out=failing" "-D" "height=1" "--again"))
          (statuses "failing"))))

(write-file "killed.scm" "(use-modules (timewarp))" "(kill (getpid) SIGKILL)")
(test-says "a run that is killed" "run 1: status 137: ended by signal 9"
  (run-errors (sweep "killed.scm" "--out=killed")))

;; ---- stopping ----

(write-file "slow.scm" "(use-modules (timewarp))" "(scene #:duration 1)"
            "(define-scene-parameter n 0 \"number\")" "(define-scene-parameter wait 0.4 \"s\")"
            "(define ball (add-body! #:shape (sphere 1)))"
            "(define nap (inexact->exact (round (* wait 1e4))))"
            "(add-callback! ball (lambda (time view) (usleep nap) #t) #:period 0.01)")

(define (processes text)
  (lines-of (run-output (shell (format #f "ps -eo args | grep '[-]-poses=.*~a' || true" text)))))

(for-each
 (lambda (signal)
   (let* ((out (string-append "stopped-" signal))
          ;; once something is finished and the rest is not
          (result (shell (format #f "{ ~a slow.scm --out=~a -D n=1..20 --jobs=2 --poses=p.csv \
</dev/null & p=$!; until [ -e ~a/runs/00002.json ]; do sleep 0.1; done; kill -~a $p; wait $p; }"
                                 (shell-quote (sweep-program)) out out signal))))
     (define (claim text) (format #f "SIG~a: ~a" signal text))
     (test-equal (claim "status 130") 130 (run-status result))
     (test-says (claim "it says how to go on")
       (string-append "20 runs in .*, [0-9]+ not finished\ngo on by: timewarp-sweep --out=.*" out
                      "\n.*interrupted\n$")
       (run-errors result))
     (test-equal (claim "nothing goes on") '() (processes out))
     (let* ((then (runs out)) (finished (length then)))
       (test-assert (claim (format #f "~a are finished" finished)) (< 0 finished 20))
       (test-equal (claim "there are whole results only") (make-list finished 0) (statuses out))
       (test-equal (claim "the rest is run when it goes on") 0
         (run-status (sweep (string-append "--out=" out) "--jobs=4")))
       (test-equal (claim "and no other") then
         (filter (lambda (run) (member run then)) (runs out)))
       (test-equal (claim "now all are") 20 (length (runs out))))))
 '("INT" "TERM"))

(let* ((alone (string-append (shell-quote (sweep-program)) " --out=alone "))
       (result (shell (string-append
                       "{ " alone "slow.scm -D n=1..4 </dev/null 2>/dev/null & p=$!; "
                       "sleep 0.7; kill -KILL $p; " alone "; s=$?; while " alone
                       "2>&1 | grep -q another; do sleep 0.2; done; (exit $s); }"))))
  (test-equal "two at work in one folder: status 1" 1 (run-status result))
  (test-says "the second says so, even if the first is dead and what it started is not"
    "another timewarp-sweep, or what it has started, works in .*/alone" (run-errors result))
  (test-equal "in the end all runs are there" '(0 0 0 0) (statuses "alone")))

(test-says "--timeout ends a run" "run 2: status 124: the time that --timeout allows is over"
  (run-errors (sweep "slow.scm" "--out=timeout" "-D" "wait=0.01,30" "--timeout=0.5")))

;; ---- looking ----

(let ((result (sweep "--out=first" "--columns=run,height,seed,hash,none")))
  (test-says "a name that no run has"
    "no run has a value none; expected one of: run, .*height.*z.*duration"
    (run-errors result)))
(test-equal "--columns prints a table"
  '("height\tseed\tscene" "0.5\t1\tball.scm" "0.5\t2\tball.scm")
  (list-head (lines-of (run-output (sweep "--out=first" "--columns=height,seed,scene"))) 3))

(delete-file (in-folder "first/runs.jsonl"))
(test-equal "--merge gathers" '(0 10)
  (list (run-status (sweep "--out=first" "--merge")) (length (runs "first"))))

;; gnuplot's input, whether gnuplot is there or not
(mkdir (in-folder "bin"))
(write-file "bin/gnuplot" "#!/bin/sh" "cat \"$1\"")
(chmod (in-folder "bin/gnuplot") #o755)
(define (plot . args)
  (shell (string-append "PATH=$PWD/bin:$PATH " (shell-quote (sweep-program)) " --out=first "
                        (string-join args " "))))
(let ((result (plot "--plot=z:height:seed" "--log=x")))
  (test-says "the plot's file is told" "/first/z-height-seed.png\n" (run-errors result))
  (test-says "a curve for each value, a point for each, with its least and greatest"
    (string-append "\n[$]curve1 << END_OF_DATA\n0.5\t(0.4[0-9]*)\t\\1\t\\1\n1.0\t(.|\n)*"
                   "plot [$]curve0 .* title \"1\", [$]curve1 .* title \"2\"\n")
    (run-output result))
  (test-says "logarithmic axes" "\nset logscale x\n" (run-output result)))
(test-says "what is no number has its names on the axis"
  "\nset xtics [(]\"ball.scm\" 0[)]\n" (run-output (plot "--plot=z:scene")))
(test-says "runs that agree in the parameter are one point"
  "END_OF_DATA\n0.0\t[0-9.]+\t0.4[0-9.]+\t2.9[0-9.]+\nEND_OF_DATA"
  (run-output (plot "--plot=z:status" "--picture=x.svg" "2>/dev/null | sed 's/^0 /0.0/'")))
(when (installed? "gnuplot")
  (test-equal "gnuplot draws PNG" 0 (run-status (sweep "--out=first" "--plot=z:height")))
  (test-assert "it is one"
    (string-prefix? "\x89PNG" (call-with-input-file (in-folder "first/z-height.png") get-string-all
                                                    #:encoding "ISO-8859-1")))
  (test-equal "and SVG" 0
    (run-status (sweep "--out=first" "--plot=z:height:seed" "--picture=plot.svg")))
  (test-says "it is one" "<svg" (read-file "plot.svg")))

;; ---- programs that are missing ----

(define (with-nothing . args)
  (shell (string-append "PATH=$PWD/sub " (shell-quote (sweep-program)) " " (string-join args " "))))
(mkdir (in-folder "sub"))
(test-says "GNU Parallel"
  "needs parallel, which is not in PATH; on Debian: apt-get install parallel"
  (run-errors (with-nothing "ball.scm" "--out=none")))
(test-says "gnuplot" "needs gnuplot, which is not in PATH; on Debian: apt-get install gnuplot-nox"
  (run-errors (with-nothing "--out=first" "--plot=z:height")))
(test-says "Slurm" "needs sbatch, which is not in PATH; on Debian: apt-get install slurm-client"
  (run-errors (with-nothing "ball.scm" "--out=none" "--slurm")))

;; ---- wrong usage ----

(define (refused pattern . args)
  (let ((result (apply sweep args)))
    (test-equal (format #f "~a: status 2" args) 2 (run-status result))
    (test-says args pattern (run-errors result))))

(refused "there is no --out; expected --out=FOLDER" "ball.scm")
(refused "there is no scene, and no plan in .*none" "--out=none")
(refused "there is no scene; expected" "--out=first" "--seed=1")
(refused "more than one scene" "ball.scm" "slow.scm" "--out=none")
(refused "unknown option --sede" "ball.scm" "--out=none" "--sede=1")
(refused "--seed is \"x\"; expected an integer" "ball.scm" "--out=first" "--seed=1,x")
(refused "--fps is \"0\"; expected a positive" "ball.scm" "--out=none" "--fps=0..2")
(refused "-D got \"height\"; expected NAME=VALUE" "ball.scm" "--out=none" "-D" "height")
(refused "--jobs is \"0\"; expected a positive integer, or a" "ball.scm" "--out=none" "-j" "0")
(refused "--stats is not for sweeps: the statistics of every run are" "ball.scm" "--out=none"
         "--stats")
(refused "--part is not for sweeps: --parts=N" "ball.scm" "--out=none" "--part=1/2")
(refused "--poses is \"../p.csv\"; expected a name for the folder of each run" "ball.scm"
         "--out=none" "--poses=../p.csv")
(refused "--plot is \"z\"; expected STATISTIC:PARAMETER" "--out=first" "--plot=z")
(refused "--picture is \"x.pdf\"; expected a name that ends in .png or .svg" "--out=first"
         "--plot=z:height" "--picture=x.pdf")
(refused "--wait says nothing without --slurm" "ball.scm" "--out=none" "--wait")
(refused "--parts says nothing without --frames" "ball.scm" "--out=none" "--parts=2")
(refused "--keep and --again contradict" "ball.scm" "--out=none" "--keep" "--again")
(refused "--task is \"1,x\"; expected numbers" "--out=first" "--task=1,x")
(test-says "a run that is not planned" "there is no run 99 in .*plan.scm"
  (run-errors (sweep "--out=first" "--task=99")))
(test-says "a scene that is not there" "there is no scene .*/none.scm"
  (run-errors (sweep "none.scm" "--out=none")))

(let ((help (run-output (sweep "--help"))))
  (for-each (lambda (option) (test-assert (string-append "--help shows " option)
                               (string-contains help option)))
            '("--out" "--jobs" "--dry-run" "--slurm" "--plot" "--columns" "--accuracy" "FROM..TO")))
(test-says "--version" "^timewarp-sweep 0[.]" (run-output (sweep "--version")))

;; ---- frames ----

(when (%drawing?)
  (let ((options '("--size=64x36" "--quality=draft" "--fps=50")))
    (define (pictures folder)
      (map (lambda (name)
             (cons name (call-with-input-file (in-folder (string-append folder "/" name))
                          get-string-all #:encoding "ISO-8859-1")))
           (scandir (in-folder folder) (lambda (name) (string-suffix? ".png" name)))))
    (let ((result (apply sweep "ball.scm" "--out=film" "--frames=frames" "--parts=4" options)))
      (test-equal "frames in parts: status 0" 0 (run-status result)))
    (apply run "ball.scm" "--quiet" "--frames=whole" options)
    (test-equal "there are six" 6 (length (pictures "whole")))
    (test-equal "the parts together are the pictures of one run" (pictures "whole")
      (pictures "film/runs/00001/frames"))
    (test-equal "each is one part of it" 1
      (length (delete-duplicates (map (lambda (run) (assoc-ref run "hash")) (runs "film")))))
    ;; as if it came from a machine that computes otherwise
    (system* "sed" "-i" "s/\"hash\":\"./\"hash\":\"x/" (in-folder "film/runs/00003.json"))
    (let ((result (sweep "--out=film" "--merge")))
      (test-equal "parts of different histories: status 1" 1 (run-status result))
      (test-says "and are told" "runs 1 and 3 are parts of one run, but their histories differ"
        (run-errors result)))
    (refused "--poses is written by every part" "ball.scm" "--out=none" "--frames=f" "--parts=2"
             "--poses=p.csv")))

(clean-up)
(test-end "sweep")
