;; The command line's options: their names, arguments, help, and what their values must be.
;;
;; The result is an association list; wrong usage throws `timewarp-usage' with a message.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp options)
  #:use-module (srfi srfi-1)
  #:use-module (srfi srfi-37)
  #:use-module (ice-9 match)
  #:export (parse-command-line option-help documented-options usage-error))

(define (usage-error message . args)
  "Say that the command line is wrong."
  (throw 'timewarp-usage (apply format #f message args)))

;; ---- values ----

(define (->number name text valid? expected)
  (let ((number (string->number text)))
    (unless (and number (real? number) (not (nan? number)) (not (inf? number)) (valid? number))
      (usage-error "--~a is ~s; expected ~a" name text expected))
    number))

(define (seconds name text)
  (->number name text (lambda (x) (>= x 0)) "a number of seconds, not negative"))
(define (positive name text)
  (->number name text positive? "a positive number"))
(define (natural name text)
  (->number name text (lambda (x) (and (exact-integer? x) (>= x 0))) "an integer, not negative"))
(define (count name text)
  (->number name text (lambda (x) (and (exact-integer? x) (> x 0))) "a positive integer"))
(define (text name text)
  (when (string-null? text) (usage-error "--~a is empty; expected a name" name))
  text)

(define (optional-text name text*)
  (if text* (text name text*) #t))

(define (size name text)
  (match (map string->number (string-split text #\x))
    (((? exact-integer? width) (? exact-integer? height))
     (unless (and (<= 1 width 16384) (<= 1 height 16384))
       (usage-error "--size is ~s; expected 1 to 16384 pixels a side" text))
     (list width height))
    (_ (usage-error "--size is ~s; expected WIDTHxHEIGHT such as 1280x720" text))))

(define (quality name text)
  (unless (member text '("draft" "normal" "best"))
    (usage-error "--quality is ~s; expected draft, normal or best" text))
  (string->symbol text))

(define (policy name text)
  (cond ((string=? text "timewarp") 'timewarp)
        ((or (string=? text "conservative") (string-prefix? "retroactive:" text))
         (usage-error "--policy=~a is not there yet; expected timewarp" text))
        (else (usage-error "--policy is ~s; expected timewarp" text))))

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

(define (later needs)
  (lambda (name text)
    (usage-error "--~a is not there yet: it needs ~a, in a later version" name needs)))

;; ---- the table ----

;; (KEY NAMES ARGUMENT CONVERT HELP): ARGUMENT is a word for --help, #f for none, (WORD) for an
;; optional one; HELP is #f for test modes, which --help leaves out.
(define table
  `((until (#\t "until") "SECONDS" ,seconds "simulate to this time instead of the scene's duration")
    (frames (#\f "frames") "DIR" ,text "write DIR/00000.png ...; DIR may be a pattern like out/%05d.png")
    (fps ("fps") "N" ,positive "frames per second (30)")
    (size ("size") "WxH" ,size "size of the pictures (1280x720)")
    (quality ("quality") "QUALITY" ,quality "draft, normal or best (normal)")
    (contacts ("contacts") #f #f "draw contacts into the pictures: a line along the normal of each")
    (movie (#\m "movie") "FILE" ,(later "the movie writer") "not there yet")
    (record (#\o "record") "FILE" ,(later "the recording format") "not there yet")
    (poses ("poses") "FILE.csv" ,text "write the poses of moving bodies at every frame time")
    (events ("events") "FILE.csv" ,text "write every committed collision")
    (stats ("stats") ("FILE.json") ,optional-text "statistics after the run, printed or as a JSON file")
    (hash ("hash") #f #f "print the SHA-256 of the whole committed history as the last line")
    (define (#\D "define") "NAME=VALUE" ,definition "set a scene parameter (repeatable)")
    (policy ("policy") "POLICY" ,policy "timewarp; others are not there yet")
    (integrator ("integrator") "NAME" ,integrator "auto, or rk45: Cash and Karp's method even for free flight (auto)")
    (accuracy ("accuracy") "EPS" ,positive "relative accuracy (1e-6)")
    (seed ("seed") "N" ,natural "seed of random numbers (0)")
    (group-check-rate ("group-check-rate") "HZ" ,positive "finest rate of contact checks (by size)")
    (check ("check") #f #f "run all validators after every event, and watch callbacks for side effects")
    (interactive (#\i "interactive") #f #f "REPL after the run (or at once with --until=0)")
    (listen ("listen") ("SOCKET") ,(later "the REPL server") "not there yet")
    (load-path (#\L) "DIR" ,text "add DIR to the front of the load path")
    (load (#\l) "FILE" ,text "load a Scheme file before anything else")
    (command (#\c) "EXPR" ,text "evaluate EXPR and exit")
    (no-init (#\q) #f #f "leave out the user's init file of Guile")
    (quiet ("quiet") #f #f "no progress")
    (help (#\h "help") #f #f "this help; with a scene, also its parameters")
    (version (#\v "version") #f #f "versions of timewarp and of its libraries")
    ;; test modes
    (gvt-interval ("gvt-interval") "N" ,count #f)
    (window ("window") "CELLS" ,positive #f)
    (adversary ("adversary") "SEED" ,adversary #f)
    (pieces ("pieces") "N" ,count #f)
    (undo-redo ("undo-redo") #f #f #f)
    (write-states ("write-states") "FILE" ,text #f)
    (compare-states ("compare-states") "FILE" ,text #f)))

(define (long-name names) (or (find string? names) (string (car names))))

;; ---- parsing ----

(define (entry->option entry)
  (match entry
    ((key names argument convert _)
     (option names (string? argument) (pair? argument)
             (lambda (option name value result)
               (acons key
                      (if (and convert (or value (not (string? argument))))
                          (convert (long-name names) value)
                          (or value #t))
                      result))))))

(define options (map entry->option table))

;; SRFI-37 wants --name=value; --name value is as usual elsewhere
(define (join-long-options args)
  (define needing
    (filter-map (match-lambda
                  ((_ names (? string?) . _) (string-append "--" (long-name names)))
                  (_ #f))
                table))
  (match args
    (() '())
    (("--" . rest) args)
    ((arg . rest)
     (cond ((and (member arg needing) (pair? rest))
            (cons (string-append arg "=" (car rest)) (join-long-options (cdr rest))))
           ((member arg needing) (usage-error "~a has no value; expected one" arg))
           ;; their argument is not an option, whatever it looks like
           ((and (member arg '("-t" "-f" "-m" "-o" "-D" "-L" "-l" "-c")) (pair? rest))
            (cons* arg (car rest) (join-long-options (cdr rest))))
           (else (cons arg (join-long-options rest)))))))

(define (parse-command-line args)
  "Return an alist of options in the order given; operands have the key `operand'."
  (catch 'misc-error
    (lambda ()
      (reverse
       (args-fold (join-long-options args) options
                  (lambda (option name value result)
                    (usage-error "unknown option ~a; see --help"
                                 (if (char? name) (string #\- name) (string-append "--" name))))
                  (lambda (operand result) (acons 'operand operand result))
                  '())))
    (lambda (key who message args . _)
      (usage-error "~?" message args))))

;; ---- help ----

(define (names-text names argument)
  (string-append
   (string-join (map (lambda (name)
                       (if (char? name) (string #\- name) (string-append "--" name)))
                     names)
                ", ")
   (match argument
     (#f "")
     ((word) (string-append "[=" word "]"))
     (word (string-append (if (any string? names) "=" " ") word)))))

(define (documented-options)
  "Return (NAMES ARGUMENT HELP) of each option but the test modes; ARGUMENT is a word, (WORD) or
#f."
  (filter-map (match-lambda
                ((_ names argument _ help) (and help (list names argument help))))
              table))

(define (option-help)
  "Return the text of --help that lists the options."
  (string-concatenate
   (map (match-lambda
          ((names argument help)
           (let ((left (names-text names argument)))
             (if (< (string-length left) 26)
                 (format #f "  ~a  ~a\n" (string-pad-right left 26) help)
                 (format #f "  ~a\n~a~a\n" left (make-string 30 #\space) help)))))
        (documented-options))))
