;; The options of the program `timewarp': names, arguments, help, and what values must be.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp options)
  #:use-module (timewarp option-table)
  #:use-module (ice-9 match)
  #:use-module ((srfi srfi-1) #:select (any))
  #:export (parse-command-line option-help documented-options)
  ;; for timewarp-sweep, which hands them on
  #:export (timewarp-options))

;; ---- values ----

(define (size name text)
  (match (text->size text)
    (#f (usage-error "--size is ~s; expected WIDTHxHEIGHT such as 1280x720" text))
    ((and sides (width height))
     (unless (and (<= 1 width 16384) (<= 1 height 16384))
       (usage-error "--size is ~s; expected 1 to 16384 pixels a side" text))
     sides)))

(define (movie name text)
  (unless (any (lambda (ending) (string-suffix-ci? ending text))
               '(".mp4" ".m4v" ".mov" ".mkv" ".webm" ".gif"))
    (usage-error "--movie is ~s; expected a name that ends in .mp4, .mov, .mkv, .webm or .gif" text))
  text)

(define (threads name text)
  (->number name text (lambda (x) (and (exact-integer? x) (<= 1 x 256)))
            "a whole number from 1 to 256"))

(define (part name text)
  (match (map string->number (string-split text #\/))
    (((? exact-integer? k) (? exact-integer? n))
     (unless (<= 1 k n 1000000)
       (usage-error "--part is ~s; expected K/N with K from 1 to N, N up to 1000000" text))
     (list k n))
    (_ (usage-error "--part is ~s; expected K/N such as 1/8" text))))

(define (quality name text)
  (unless (member text '("draft" "normal" "best"))
    (usage-error "--quality is ~s; expected draft, normal or best" text))
  (string->symbol text))

(define (policy name text)
  (unless (or (member text '("timewarp" "conservative"))
              (and (string-prefix? "retroactive:" text)
                   (let ((step (string->number (substring text 12))))
                     (and step (real? step) (<= 1e-6 step 1e9)))))
    (usage-error
     "--policy is ~s; expected timewarp, conservative or retroactive:STEP, such as retroactive:0.01"
     text))
  text)

(define (integrator name text)
  (unless (member text '("auto" "rk45"))
    (usage-error "--integrator is ~s; expected auto or rk45" text))
  text)

(define (definition name text)
  (match (string-index text #\=)
    ((or #f 0) (usage-error "-D got ~s; expected NAME=VALUE" text))
    (i (cons (string->symbol (substring text 0 i)) (substring text (1+ i))))))

;; SEED[,HEAD-START[,every]]
(define (adversary name text)
  (match (string-split text #\,)
    ((seed) (list (natural name seed) 0.1 #f))
    ((seed head-start) (list (natural name seed) (seconds name head-start) #f))
    ((seed head-start "every") (list (natural name seed) (seconds name head-start) #t))
    (_ (usage-error "--adversary is ~s; expected SEED[,HEAD-START[,every]]" text))))

;; ---- the table ----

;; rows as (timewarp option-table) has them; without help: test modes
(define timewarp-options
  `((until (#\t "until") "SECONDS" ,seconds "simulate to this time instead of the scene's duration")
    (frames (#\f "frames") "DIR" ,text "write DIR/00000.png ...; DIR may be a pattern like out/%05d.png")
    (fps ("fps") "N" ,positive "frames per second (30)")
    (size ("size") "WxH" ,size "size of the pictures (1280x720)")
    (quality ("quality") "QUALITY" ,quality "draft, normal or best (normal)")
    (part ("part") "K/N" ,part "of every N frames draw the K-th only, so that N runs share them")
    (contacts ("contacts") #f #f "draw contacts into the pictures: a line along the normal of each")
    (movie (#\m "movie") "FILE" ,movie "a movie of the frames by ffmpeg: .mp4, .mov, .mkv, .webm or .gif")
    (at ("at") "T" ,seconds "draw one frame only, at time T, to the file that --frames names")
    (no-overlay ("no-overlay") #f #f "pictures without title, time and scale")
    (poses ("poses") "FILE.csv" ,text "write the poses of moving bodies at every frame time")
    (events ("events") "FILE.csv" ,text "write every committed collision, fusion and fission")
    (stats ("stats") ("FILE.json") ,optional-text "statistics after the run, printed or as a JSON file")
    (hash ("hash") #f #f "print the SHA-256 of the whole committed history as the last line")
    (define (#\D "define") "NAME=VALUE" ,definition "set a scene parameter (repeatable)")
    (policy ("policy") "POLICY" ,policy "timewarp; to compare: conservative, or retroactive:STEP, s (timewarp)")
    (integrator ("integrator") "NAME" ,integrator "auto, or rk45: Cash and Karp's method even for free flight (auto)")
    (accuracy ("accuracy") "EPS" ,positive "relative accuracy (1e-6)")
    (threads ("threads") "N" ,threads "threads that work is shared among (as many as there are cores)")
    (seed ("seed") "N" ,natural "seed of random numbers (0)")
    (group-check-rate ("group-check-rate") "HZ" ,positive "finest rate of contact checks (by size)")
    (check ("check") #f #f "run all validators after every event, and watch callbacks for side effects")
    (interactive (#\i "interactive") #f #f "REPL after the run (or at once with --until=0)")
    (listen ("listen") ("SOCKET") ,optional-text "REPL server that answers while the simulation runs: a file, or a port of this machine")
    (watch ("watch") #f #f "run again whenever the scene, or a file that it loads, is saved")
    (load-path (#\L) "DIR" ,text "add DIR to the front of the load path")
    (load (#\l) "FILE" ,text "load a Scheme file before anything else")
    (command (#\c) "EXPR" ,text "evaluate EXPR and exit")
    (no-init (#\q) #f #f "leave out the user's init file of Guile")
    (quiet ("quiet") #f #f "no progress")
    (help (#\h "help") #f #f "this help; with a scene, also its parameters")
    (version (#\v "version") #f #f "versions of timewarp and of its libraries")
    ;; test modes
    (gvt-interval ("gvt-interval") "N" ,positive-integer #f)
    (window ("window") "CELLS" ,positive #f)
    (adversary ("adversary") "SEED" ,adversary #f)
    (pieces ("pieces") "N" ,positive-integer #f)
    (undo-redo ("undo-redo") #f #f #f)
    (write-states ("write-states") "FILE" ,text #f)
    (compare-states ("compare-states") "FILE" ,text #f)
    ;; what --watch asks of the runs that it starts
    (files-read ("files-read") "FILE" ,text #f)))

(define (parse-command-line args)
  "Return an alist of options in the order given; operands have the key `operand'."
  (parse-options timewarp-options args))

(define (documented-options)
  "Return (NAMES ARGUMENT HELP) of each option but the test modes; ARGUMENT is a word, (WORD) or
#f."
  (documented-rows timewarp-options))

(define (option-help)
  "Return the text of --help that lists the options."
  (rows-help timewarp-options))
