;; The command line of the program.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "command line")

(write-file "ball.scm"
            "(use-modules (timewarp))"
            "(scene #:title \"Ball\" #:duration 3 #:seed 5)"
            "(define-scene-parameter height 1.0 \"height of the drop, m\")"
            "(define-scene-parameter label \"ball\" \"name of the ball\")"
            "(define-scene-parameter elastic? #f \"bounces for ever\")"
            "(define ground (add-body! #:name \"ground\" #:shape (half-space #(0 0 1) 0) #:fixed? #t))"
            "(define ball (add-body! #:name label #:shape (sphere 0.1)"
            "                        #:position (vector 0 0 (+ 0.1 height)) #:slots '((bounces . 0))))"
            "(set-contact-parameters! ball ground #:restitution (if elastic? 1 0.8))"
            "(on-collision! ball ground"
            "  (lambda (collision ball ground) (set! (slot ball 'bounces) (1+ (slot ball 'bounces)))))"
            "(observe! 'collision (lambda (c) (format #t \"bounce ~,3f~%\" (collision-time c))))")

;; ---- help and version ----

(let ((result (run "--version")))
  (test-equal "--version: status 0" 0 (run-status result))
  (for-each (lambda (name)
              (test-assert (string-append "--version names " name)
                (string-contains (run-output result) name)))
            '("timewarp 0." "Guile 3" "Eigen" "Qhull" "nlohmann-json" "LGPL")))

(let ((result (run "--help")))
  (test-equal "--help: status 0" 0 (run-status result))
  (for-each (lambda (option)
              (test-assert (string-append "--help shows " option)
                (string-contains (run-output result) option)))
            '("--until" "--frames" "--fps" "--size" "--quality" "--part" "--poses" "--events" "--stats" "--hash"
              "-D" "--accuracy" "--seed" "--check" "--quiet" "--version" "-i" "-L" "-l" "-c" "-q"))
  (test-assert "test modes are not in --help"
    (not (string-match "adversary|gvt-interval|undo-redo|pieces" (run-output result)))))

(let ((result (run "--help" "ball.scm")))
  (test-assert "--help with a scene lists its parameters"
    (string-match "height +height of the drop, m \\(1.0\\)(.|\n)*label .*\"ball\"" (run-output result)))
  (test-assert "and doesn't run it" (not (string-contains (run-output result) "bounce 0"))))

;; ---- running ----

(let ((result (run "ball.scm")))
  (test-equal "a run: status 0" 0 (run-status result))
  (test-equal "observers print once, in order" '("bounce 0.452" "bounce 1.174" "bounce 1.752")
              (list-head (lines-of (run-output result)) 3)))

(let ((result (run "ball.scm" "-t" "0.5" "--hash")))
  (test-equal "-t ends the run" 2 (length (lines-of (run-output result))))
  (test-assert "--hash is the last line"
    (string-match "^[0-9a-f]{64}$" (last (lines-of (run-output result))))))

(define (hash-of . args)
  (last (lines-of (run-output (apply run "ball.scm" "--hash" "--quiet" args)))))

(let ((hash (hash-of)))
  (for-each (lambda (args)
              (test-equal (format #f "the hash doesn't depend on ~a" args) hash (apply hash-of args)))
            '(("--poses=p.csv") ("--poses=p.csv" "--fps=1000") ("--check") ("--pieces=7")
              ("--gvt-interval=1") ("--gvt-interval=10000") ("--adversary=1,0.5,every")
              ("--adversary=2,0.5") ("--window=3") ("--undo-redo") ("--stats=s.json")))
  (test-assert "but on the scene" (not (equal? hash (hash-of "-D" "height=1.01")))))

;; ---- the states of two schedules ----

(run "ball.scm" "--quiet" "--write-states=states.txt")
(test-equal "the states don't depend on the schedule" 0
            (run-status (run "ball.scm" "--quiet" "--compare-states=states.txt" "--adversary=2,0.5"
                             "--pieces=3")))
(let ((result (run "ball.scm" "--quiet" "--compare-states=states.txt" "-D" "height=1.01")))
  (test-assert "another scene: status 1" (not (zero? (run-status result))))
  (test-assert "time, body, key and field are named"
    (string-match "differs from that of states.txt first at t = 0 s: ball with birth.*: position is .*,1.11 instead of .*,1.1"
                  (run-errors result))))
(test-assert "no file to compare with"
  (string-match "cannot read the states of none.txt: No such file"
                (run-errors (run "ball.scm" "--compare-states=none.txt"))))

;; ---- parameters ----

(let ((result (run "ball.scm" "--until" "1" "-D" "height=0.5" "--define=label=a,\\\"b\\\"" "-D" "elastic?=#t"
                   "--events" "e.csv" "--poses=p.csv" "--fps=4")))
  (test-equal "-D: status 0" 0 (run-status result))
  (test-equal "events: columns" "time,kind,body1,body2,x,y,z,nx,ny,nz,impulse"
              (first (lines-of (read-file "e.csv"))))
  (test-assert "events: rows, with names quoted"
    (string-match "^0.3192[0-9]*,collision,ground,\"a,\"\"b\"\"\",0,0,[-0-9.e]+,0,0,1,[0-9.]+$"
                  (second (lines-of (read-file "e.csv")))))
  (test-equal "poses: columns" "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz"
              (first (lines-of (read-file "p.csv"))))
  (test-equal "poses: frame k is at k/fps, from 0 to the end"
    '("0" "0.25" "0.5" "0.75" "1")
    (map (lambda (row) (first (string-split row #\,))) (cdr (lines-of (read-file "p.csv")))))
  (test-assert "poses: rows of moving bodies, read back to the same doubles"
    (match (string-match "^0.25,\"a,\"\"b\"\"\",0,0,([0-9.]+),1,0,0,0,0,0,([-0-9.]+),0,0,0$"
                         (third (lines-of (read-file "p.csv"))))
      ((? identity m)
       (and (close? (string->number (match:substring m 1)) 0.2934375 1e-15)
            (= (string->number (match:substring m 2)) (* -9.81 0.25))))
      (_ #f))))

;; ---- contact groups ----

(write-file "kick.scm"
            "(use-modules (timewarp))"
            "(scene #:duration 0.5 #:group-check-rate 240)"
            "(add-body! #:name \"floor\" #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 0.1) #:position #(0 0 0.1001)))"
            "(set-contact-parameters! #t #t #:restitution 0)"
            "(add-callback! ball (lambda (time view) (set! (velocity view) #(0 0 3)) #f) #:start 0.25)")

(let ((result (run "kick.scm" "--events=kick.csv" "--stats=rate-240.json")))
  (test-equal "fusion and fission: status 0" 0 (run-status result))
  (test-equal "--events lists fusions and fissions"
    '(("fusion" "floor" "ball") ("fission" "floor" "ball"))
    (map (lambda (row) (list-head (cdr (string-split row #\,)) 3))
         (cdr (lines-of (read-file "kick.csv"))))))

(define (group-checks file)
  (string->number (match:substring (string-match "\"group_checks\": *([0-9]+)" (read-file file)) 1)))
(run "kick.scm" "--group-check-rate=4000" "--stats=rate-4000.json")
(test-assert "--group-check-rate overrides the scene's #:group-check-rate"
  (> (group-checks "rate-4000.json") (* 2 (group-checks "rate-240.json"))))

(define (refused pattern . args)
  (let ((result (apply run args)))
    (test-equal (format #f "~a: status 2" args) 2 (run-status result))
    (test-assert (format #f "~a: ~s" args (run-errors result))
      (string-match pattern (run-errors result)))))

(refused "-D sets heigth, which is no parameter.*expected one of: height, label" "ball.scm" "-D" "heigth=3")
(refused "expected NAME=VALUE" "ball.scm" "-D" "height")
(let ((result (run "ball.scm" "-D" "height=tall")))
  (test-equal "a parameter of the wrong kind: status 1" 1 (run-status result))
  (test-assert (run-errors result)
    (string-match "ball.scm:3:1: the scene parameter height is tall; expected a number" (run-errors result))))

;; ---- wrong usage ----

(refused "unknown option --untill" "ball.scm" "--untill=3")
(refused "unknown option -x" "-x")
(refused "--until has no value" "ball.scm" "--until")
(refused "--until is \"soon\"; expected a number of seconds" "ball.scm" "--until=soon")
(refused "--fps is \"0\"; expected a positive" "ball.scm" "--fps=0")
(refused "--size is \"12\"; expected WIDTHxHEIGHT" "ball.scm" "--size=12")
(refused "--part is \"3/2\"; expected K/N with K from 1 to N" "ball.scm" "--part=3/2")
(refused "--part is \"2\"; expected K/N such as 1/8" "ball.scm" "--part=2")
(refused "--quality is \"great\"; expected draft" "ball.scm" "--quality=great")
(refused "--movie is \"film.avi\"; expected a name that ends in .mp4" "ball.scm" "--movie=film.avi")
(refused "--seed is \"-1\"" "ball.scm" "--seed=-1")
(refused "more than one scene" "ball.scm" "ball.scm")
(refused "there is no scene" "--until=3")

;; in its build folder, without what ./pre-inst-env sets; other modules on the path are not mixed in
(define bare (format #f "env -i PATH=~a HOME=~a " (getenv "PATH") (force folder)))
(mkdir (in-folder "strange"))
(mkdir (in-folder "strange/timewarp"))
(write-file "strange/timewarp/command-line.scm" "(error \"a strange module\")")
(let ((result (shell (string-append "echo '(+ 40 2)' | " bare
                                    "GUILE_LOAD_PATH=strange " timewarp " -q"))))
  (test-equal "without arguments: a prompt" 0 (run-status result))
  (test-assert "that answers" (string-match "= 42" (run-output result))))
(test-equal "the sweep is there, too" "timewarp-sweep"
  (string-take (run-output (shell (string-append bare timewarp "-sweep --version"))) 14))

;; no option is named that does nothing yet
(refused "unknown option --record" "ball.scm" "--record=x")
(test-assert "all that --help names is there"
  (not (string-match "not there|later version" (run-output (run "--help")))))
(refused "--integrator is \"euler\"; expected auto or rk45" "ball.scm" "--integrator=euler")
(test-equal "--integrator=rk45 is" 0 (run-status (run "ball.scm" "--integrator=rk45")))
(for-each
 (lambda (policy)
   (test-equal (string-append policy " is") 0 (run-status (run "ball.scm" policy))))
 '("--policy=timewarp" "--policy=conservative" "--policy=retroactive:0.01"))
(refused "--policy is \"eager\"; expected timewarp, conservative or retroactive:STEP" "ball.scm" "--policy=eager")
(refused "--policy is \"retroactive:0\"" "ball.scm" "--policy=retroactive:0")

;; ---- --check ----

(write-file "impure.scm" "(use-modules (timewarp) (srfi srfi-9))"
            "(define-record-type <tally> (make-tally n) tally? (n tally-n set-tally-n!))"
            "(define tally (make-tally 0))"
            "(define next! (let ((n 0)) (lambda () (set! n (1+ n)) n)))"
            "(define own 0)"
            "(define count 0)" "(define seen (list 1 (vector 2)))" "(define table (make-hash-table))"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 1) #:slots '((n . 0))))"
            "(define-scene-parameter what 0 \"what to do\")"
            "(add-callback! ball"
            "  (lambda (time view)"
            "    (set! (slot view 'n) time)"
            "    (case what"
            "      ((1) (set! count (1+ count)))"
            "      ((2) (vector-set! (cadr seen) 0 time))"
            "      ((3) (hash-set! table time #t))"
            "      ((4) (set-tally-n! tally time))"
            "      ((5) (next!))"
            "      ((6) (random 1.0)))"
            "    #f)"
            "  #:start 0.1)"
            "(add-callback! ball (let ((n 0)) (lambda (time view) (when (= what 7) (set! n (1+ n))) #f)) #:start 0.2)")
(define (impure what . options)
  (apply run "impure.scm" "-D" (format #f "what=~a" what) "--until=1" options))
(test-equal "--check passes a callback that touches what it is handed" 0 (run-status (impure 0 "--check")))
(for-each (lambda (what name)
            (test-equal "without --check nobody looks" 0 (run-status (impure what)))
            (test-assert (string-append "--check finds a change of " name)
              (string-match (string-append "^impure.scm:.*changed the variable " name ",")
                            (run-errors (impure what "--check")))))
          '(1 2 3 4 5) '("count" "seen" "table" "tally" "next!"))
(test-assert "--check finds draws from Guile's random state"
  (string-match "^impure.scm:.*drew from Guile's random state" (run-errors (impure 6 "--check"))))
(test-assert "--check finds what a callback keeps to itself"
  (string-match "(^|\n)impure.scm:.*a variable of its own" (run-errors (impure 7 "--check"))))

;; ---- warnings at load ----

(write-file "effects.scm"
            "(use-modules (timewarp))"
            "(define count 0)"
            "(define table (make-hash-table))"
            "(define ball (add-body! #:shape (sphere 0.1) #:slots '((n . 0))))"
            "(define (bump!) (set! count 1))"
            "(define (tick time view) (hash-set! table time 1) (bump!) #f)"
            "(define (fine time view)"
            "  (let loop ((i 0)) (set! i (1+ i)) (if (< i 3) (loop i)))"
            "  (set! (slot view 'n) 1) #f)"
            "(add-callback! ball tick)"
            "(add-callback! ball fine)"
            "(add-callback! ball (let ((n 0)) (lambda (time view) (set! n 1) #f)))"
            "(on-collision! ball #t (lambda (c a b) (set! count 2)))"
            "(observe! 'collision (lambda (c) (set! count 3)))")
(let ((result (run "effects.scm" "--until=0.1" "--quiet")))
  (test-equal "what a rollback does not undo is warned of, with its place"
    '("effects.scm:6:26: what is in table" "effects.scm:5:17: the variable count"
      "effects.scm:12:54: the variable n" "effects.scm:13:40: the variable count")
    (map (lambda (line)
           (let ((m (string-match "^([^ ]*): warning: .* (what is in|the variable) ([a-z]+), which" line)))
             (if m
                 (format #f "~a: ~a ~a" (match:substring m 1) (match:substring m 2)
                         (match:substring m 3))
                 line)))
         (lines-of (run-errors result))))
  (test-equal "and runs" 0 (run-status result)))

(write-file "draws.scm"
            "(use-modules (timewarp))"
            "(define state (scene-random-state))"
            "(define ball (add-body! #:shape (sphere 0.1)))"
            "(add-callback! ball (lambda (t v) (random:uniform state) #f))"
            "(add-callback! ball (lambda (t v) (random 10) #f))"
            "(add-callback! ball (lambda (t v) (random 10 (seed->random-state 5)) #f))"
            "(add-callback! ball (lambda (t v) (display \"\") (format #f \"x\") #f))"
            "(define calls 0)"
            "(add-force! ball (lambda (t v) (set! calls (1+ calls)) #(0 0 0)))")
(let ((result (run "draws.scm" "--until=0.1" "--quiet")))
  (test-equal "draws and prints are warned of, and what forces change"
    '("draws.scm:4:35" "draws.scm:5:35" "draws.scm:7:35" "draws.scm:9:32")
    (map (lambda (line) (car (string-split line #\space)))
         (map (lambda (line) (substring line 0 (string-contains line ": warning")))
              (lines-of (run-errors result))))))
(define (check-of . form)
  (apply write-file "checked.scm" "(use-modules (timewarp) (oop goops))"
         "(define ball (add-body! #:shape (sphere 0.1)))" form)
  (run-errors (run "checked.scm" "--until=0.1" "--quiet" "--check")))
(for-each
 (lambda (what definition use)
   (test-assert (string-append "--check finds a change of " what)
     (string-match "a callback changed the variable kept"
                   (check-of (string-append "(define kept " definition ")")
                             (string-append "(add-callback! ball (lambda (t v) " use " #f))")))))
 '("a random state" "a parameter" "a fluid" "an object")
 '("(scene-random-state)" "(make-parameter 0)" "(make-fluid 0)"
   "(let ((c (make-class '() '((x #:init-value 0))))) (make c))")
 '("(random:normal kept)" "(kept t)" "(fluid-set! kept 1)" "(slot-set! kept 'x 1)"))
(test-assert "--check finds what a force changes"
  (string-match "a callback changed the variable kept"
                (check-of "(define kept 0)"
                          "(add-force! ball (lambda (t v) (set! kept (1+ kept)) #(0 0 0)))")))
(test-assert "a callback that returns no time is told with its place"
  (string-match "^checked.scm:3:1: a callback without #:period returned no time.*\n.*at 0 s, bodies: body-0"
                (check-of "(add-callback! ball (lambda (t v) (if #f #f)))")))
(write-file "wrong.scm" "(use-modules (timewarp))" "(add-body! #:shape 5)")
(write-file "night.csv" "what was computed last night")
(for-each (lambda (scene)
            (run scene "--poses=night.csv" "--until=0.1")
            (test-equal (string-append "a table outlives a scene that cannot be run: " scene)
              "what was computed last night\n" (read-file "night.csv")))
          '("missing.scm" "wrong.scm"))

;; ---- statistics ----

(let ((result (run "ball.scm" "--stats=s.json" "--seed=7" "--accuracy=1e-7")))
  (for-each
   (lambda (key)
     (test-assert (string-append "--stats has " key)
       (string-contains (read-file "s.json") (string-append "\"" key "\": "))))
   (string-tokenize
    "duration frames bodies_moving bodies_total discontinuities collisions fusions fissions
     callback_changes contact_changes avg_time_between_discontinuities avg_integration_step
     integrations integration_per_moving_body rollback_per_moving_body rollbacks cpu_seconds
     cpu_seconds_per_frame draw_cpu_seconds callback_cpu_seconds checks active_pairs_avg
     distance_queries groups largest_group_bodies largest_group_contacts implicit_steps
     factorizations peak_states peak_rss_bytes max_penetration energy_start energy_end policy
     accuracy seed guile_calls"))
  (test-assert "the command line's seed and accuracy hold"
    (and (string-contains (read-file "s.json") "\"seed\": 7")
         (string-contains (read-file "s.json") "\"accuracy\": 1e-07"))))

(run "ball.scm" "--stats=s.json" "--poses=p.csv" "--fps=10")
(test-assert "frames are counted" (string-contains (read-file "s.json") "\"frames\": 31,"))

(test-assert "--stats without a file prints them"
  (string-match "collisions +[0-9]+" (run-output (run "ball.scm" "--stats"))))

;; ---- scenes that run themselves, file names, seeds ----

(mkdir (in-folder "sub"))
(write-file "sub/own.scm"
            "(use-modules (timewarp))"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 0.1)))"
            "(load \"part.scm\")"
            "(simulate! #:until 0.5 #:poses \"own.csv\" #:events \"own-events.csv\")"
            "(format #t \"at ~a, random ~a~%\" (world-time) (random 1000 (scene-random-state)))")
(write-file "sub/part.scm" "(define part #t)")

(let ((result (run "sub/own.scm" "--until=0.25" "--poses=all.csv")))
  (test-equal "a scene may run itself" 0 (run-status result))
  (test-assert "the command line goes on only if its end is later"
    (string-match "at 0.5, " (run-output result)))
  (test-assert "file names in a scene are relative to the scene's file"
    (file-exists? (in-folder "sub/own.csv")))
  (test-equal "recorders of the command line see what the scene runs" 16
              (length (cdr (lines-of (read-file "all.csv"))))))

(define (random-of . args) (run-output (apply run "sub/own.scm" args)))
(test-equal "the same seed draws the same" (random-of "--seed=3") (random-of "--seed=3"))
(test-assert "another seed draws otherwise" (not (equal? (random-of "--seed=3") (random-of "--seed=4"))))

(test-equal "a scene's exit is the program's" 7
            (begin (write-file "exit.scm" "(exit 7)") (run-status (run "exit.scm"))))

;; ---- progress ----

(test-equal "short runs report no progress" "" (run-errors (run "ball.scm")))
(write-file "slow.scm" "(use-modules (timewarp))" "(scene #:duration 8)"
            "(define ball (add-body! #:shape (sphere 1)))"
            "(add-callback! ball (lambda (time view) (usleep 4000)) #:period 0.01)")
(test-assert "long ones do, in plain lines"
  (string-match "^[0-9.]+ of 8.0000 s simulated(, [0-9.]+ s left)?, 0 rollbacks\n" (run-errors (run "slow.scm"))))
(test-assert "runs of many small pieces do, too"
  (string-match "^[0-9.]+ of [0-9.]+ s simulated, 0 rollbacks\n"
                (run-errors (run "slow.scm" "--pieces=40"))))
(test-equal "--quiet" "" (run-errors (run "slow.scm" "--quiet")))

;; a rod that slides and turns for ever, one group that takes steps, dear by what else is computed
(write-file "dear.scm" "(use-modules (timewarp))" "(scene #:duration 8)"
            "(set-contact-parameters! #t #t #:friction 0)"
            "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
            "(define rod (add-body! #:name \"rod 0\" #:shape (box 1 0.1 0.1)"
            "                       #:position #(0 0 0.05) #:velocity #(0.1 0 0)"
            "                       #:angular-velocity #(0 0 3)))"
            "(define (work)"
            "  (let ((end (+ (get-internal-run-time) (* 0.06 internal-time-units-per-second))))"
            "    (let loop () (when (< (get-internal-run-time) end) (loop)))))"
            "(add-callback! rod (lambda (time view) (work)) #:period 0.01)")
(test-assert "slow ones say what takes the time"
  (string-match
   (string-append "rollbacks; slow: the group rod [0-9](, rod [0-9])* [(][0-9]+ bodies, [0-9]+ "
                  "contacts[)] since [0-9.]+ s took [0-9]+ steps\n")
   (run-errors (shell (format #f "timeout --preserve-status -s INT 8 ~a dear.scm" timewarp)))))
(test-assert "and the statistics which groups were dearest"
  (string-match
   (string-append "dearest_group_1 +rod [0-9].*: [0-9]+ steps, [0-9]+ rejected, [0-9]+ arcs, "
                  "[0-9]+ contacts, [0-9.]+ to [0-9.]+ s, most ended by [a-z]+\n")
   (run-output (run "dear.scm" "--until=0.1" "--quiet" "--stats"))))

;; ---- Ctrl-C ----

(write-file "endless.scm" "(use-modules (timewarp))" "(scene #:duration 1e9)"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 1)))"
            "(add-callback! ball (lambda (time view) #t) #:period 0.1)")
(let ((result (shell (format #f "timeout --preserve-status -s INT 1 ~a endless.scm --quiet --poses=p.csv"
                             timewarp))))
  (test-equal "Ctrl-C: status 130" 130 (run-status result))
  (test-assert "what was written is kept, in whole lines"
    (and (> (length (lines-of (read-file "p.csv"))) 10)
         (string-suffix? "\n" (read-file "p.csv")))))

(write-file "stuck.scm" "(use-modules (timewarp))"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 1)))"
            "(add-callback! ball (lambda (time view) (let loop () (loop))) #:start 0.5)")
(test-equal "Ctrl-C ends an endless callback, too" 130
            (run-status (shell (format #f "timeout --preserve-status -s INT 1 ~a stuck.scm --quiet" timewarp))))

;; ---- as Guile ----

(test-equal "-c evaluates and exits" "3\n" (run-output (run "-c" "'(display (+ 1 2)) (newline)'")))
(write-file "lib.scm" "(define thing 5)")
(test-equal "-l loads first" "5" (run-output (run "-q" "-l" "lib.scm" "-c" "'(display thing)'")))
(mkdir (in-folder "modules"))
(write-file "modules/mine.scm" "(define-module (mine) #:export (x))" "(define x 42)")
(test-equal "-L adds a load path" "42"
            (run-output (run "-L" "modules" "-c" "'(use-modules (mine)) (display x)'")))
(test-assert "a REPL has (timewarp) at hand"
  (string-contains
   (run-output (shell (string-append "echo '(body-name (add-body! #:shape (sphere 1)))' | " timewarp " -q")))
   "\"body-0\""))
(test-assert "thousands of expressions can be typed"
  (string-contains
   (run-output (shell (string-append "{ echo \"(define x 2)\"; yes \"(list 'a x \\\"s\\\")\" | head -2500; "
                                     "echo \"(gc)\"; echo \"(* x 321)\"; } | "
                                     timewarp " -q")))
   "= 642"))
(test-assert "-i has the scene's world and names after the run"
  (string-match "bounce 0.452(.|\n)*\"ball\" 1"
                (run-output
                 (shell (string-append
                         "echo '(format #t \"~s ~a~%\" (body-name ball) (slot ball (quote bounces)))' | "
                         timewarp " -q -i --until=1 ball.scm")))))

;; an error of the scene leads to the prompt, too
(write-file "broken.scm" "(use-modules (timewarp))" "(define before 42)" "(add-body! #:shape 5)")
(let ((result (shell (string-append "echo '(+ before 1)' | " timewarp " -q -i broken.scm"))))
  (test-assert "-i after an error: it is shown"
    (string-match "^broken.scm:3:1: shape is 5" (run-errors result)))
  (test-assert "and the prompt is there" (string-match "= 43" (run-output result))))

(clean-up)
(test-end "command line")
