;; Random calls of every exported procedure: none may kill or hang the program, whatever it is
;; given.
;;
;;   guile fuzz-calls.scm --seed=S --calls=N [--setting=NAME] [--verbose]
;;   guile fuzz-calls.scm --seed=S --episode=E [--without=I,J,...]    one episode, call by call
;;
;; In the end the procedures are named of which no call returned, those that callbacks made included.
;;
;; Calls come in episodes of 40, each with a fresh world; an episode is a function of the seed and
;; its number.  They are made in a child process, which says what it does before it does it.  Where
;; the child dies, or says nothing for long, the parent repeats the episode without one call after
;; the other and prints those that are needed.  A call may return or raise an error that has a
;; message; an error leaves the poses and the hash of the history as they were, unless the call runs the
;; world.  Files that calls write go with a folder of their own.
;; Settings: plain, check (validators after every event), adversary (events out of order),
;; undo (every discontinuity taken back and done again).
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "fuzz-values.scm")
(use-modules (timewarp worlds)
             (ice-9 getopt-long)
             (ice-9 popen)
             (ice-9 rdelim)
             (ice-9 format))

(define calls-in-episode 40)
(define beginning 13)  ; calls
;; s: after the first a call is interrupted as by Ctrl-C, which only a run may need; after the
;; second it is taken for hanging
(define patience 3)
(define last-patience 15)

(define options
  (let ((given (getopt-long (command-line)
                            '((seed (value #t)) (calls (value #t)) (setting (value #t))
                              (episode (value #t)) (without (value #t)) (child) (verbose)))))
    (lambda (name default) (option-ref given name default))))
(define seed (string->number (options 'seed "0")))
(define setting (string->symbol (options 'setting "plain")))
(define episodes
  (match (options 'episode #f)
    (#f (iota (ceiling-quotient (string->number (options 'calls "1000")) calls-in-episode)))
    (number (list (string->number number)))))
(define without
  (match (options 'without "") ("" '()) (text (map string->number (string-split text #\,)))))

;; ---- the child ----

(define out (current-output-port))

(define (say . parts)
  (for-each (lambda (part) (display part out)) parts)
  (newline out)
  (force-output out))

;; What calls may take long without being at fault: they run worlds, or draw on a busy machine.
(define (runs? call)
  (or (memq (car call) '(run! run-for! simulate! step! render!))
      (any (lambda (part) (and (pair? part) (list? part) (runs? part))) (cdr call))))

;; what the calls of a child came to
(define returned 0)
(define simulated 0)  ; s
(define collisions 0)
(define (account!)
  (set! simulated (+ simulated (world-time)))
  (set! collisions (+ collisions (assq-ref (statistics) 'collisions))))

(define (message-of key args)
  (match (cons key args)
    (('timewarp-error _ _ (message) _) message)
    (_ (call-with-output-string (lambda (port) (print-exception port #f key args))))))

;; Whether an argument of the call changes a world by itself, before the call may be refused.
(define (changes-before? call)
  (any (match-lambda
         (((or 'lambda 'doing 'quote) . _) #f)
         ((? list? (head . rest))
          (or (and (symbol? head) (string-suffix? "!" (symbol->string head)))
              (changes-before? (cons head rest))))
         (_ #f))
       (if (list? call) (cdr call) '())))

;; What a refused call must leave alone; #f where it cannot be told.
(define (poses-and-hash)
  (false-if-exception (cons (all-poses) (%history-hash (current-world)))))

;; #f, or what is wrong with how the call ended.
(define (trial call)
  (let ((interrupted? #f) (fault #f) (before (poses-and-hash)) (start (get-internal-real-time)))
    (setitimer ITIMER_REAL 0 0 patience 0)
    (catch #t
      (lambda ()
        (keep! (eval `(made ,call) (current-module)))
        (set! returned (1+ returned)))
      (lambda (key . args)
        (let ((message (if (eq? key 'timewarp-interrupted) "interrupted" (message-of key args))))
          (cond ((eq? key 'timewarp-interrupted) (set! interrupted? #t))
                ((not (string? message)) (set! fault (format #f "~s has no message" key)))
                ((string-null? (string-trim message))
                 (set! fault (format #f "~s has an empty message" key)))
                ((string-contains message "internal error") (set! fault message))
                ((not (or (runs? call) (changes-before? call) (equal? before (poses-and-hash))))
                 (set! fault (format #f "is refused (~a), and has changed poses or hash"
                                     message)))))))
    (setitimer ITIMER_REAL 0 0 0 0)
    (keep-observed!)
    (let ((taken (/ (- (get-internal-real-time) start) 1.0 internal-time-units-per-second)))
      (when (> taken 0.3) (say "slow " (format #f "~,2f s" taken))))
    (or fault
        (and interrupted? (not (runs? call)) (format #f "takes longer than ~a s" patience)))))

(define (overrides)
  (case setting
    ((plain) '((hash . #t)))
    ((check) '((hash . #t) (check . #t)))
    ((undo) '((hash . #t) (undo-redo . #t)))
    ((adversary) '((hash . #t) (adversary 1 0.05 #t)))))

;; Seeds begin at other places.
(define (place-of episode number)
  (+ (* 97 seed) (* episode (- calls-in-episode beginning)) (- number beginning)))

(define (run-episode episode)
  (set! state (seed->random-state (format #f "~a/~a" seed episode)))
  (hash-clear! kept)
  (write-files!)
  (set-overrides! (overrides))
  (parameterize ((current-world (make-world)))
    (scene #:duration 0.05)
    (for-each
     (lambda (number)
       (let ((call (if (< number beginning)
                       (a-beginning number)
                       (a-call-in-turn (place-of episode number) 2))))
         (unless (memv number without)
           (say "call " number " " (object->string call))
           (match (trial call)
             (#f #t)
             (fault (say "fault " fault) (exit 3))))))
     (iota calls-in-episode))
    (account!)))

(define (child)
  (sigaction SIGALRM (lambda (signal) (%interrupt!)))
  (sigaction SIGINT (lambda (signal) (%interrupt!)))
  ;; what scenes print is nobody's business here
  (set-current-output-port (%make-void-port "w"))
  (set-current-error-port (%make-void-port "w"))
  (for-each (lambda (episode)
              (say "episode " episode)
              (run-episode episode))
            episodes)
  (say "never " (object->string (remove (lambda (name) (hash-ref returns name))
                                        (map car procedures))))
  (say (format #f "end ~a calls returned, ~,1f s simulated, ~a collisions"
               returned simulated collisions)))

;; ---- the parent ----

(define program (canonicalize-path (car (command-line))))
;; where the child works
(define folder (delay (mkdtemp (string-append (or (getenv "TMPDIR") "/tmp") "/timewarp-fuzz-XXXXXX"))))

;; The procedures of which no call returned, as the child says in the end.
(define never-returned '())

;; Reads a line, or #f if nothing comes in time.
(define (read-line-in-time port)
  (if (or (char-ready? port)
          (pair? (car (select (list port) '() '() last-patience))))
      (read-line port)
      #f))

;; Runs a child; returns how it ended - #f for well -, the episode and its calls, latest first.
(define (run-child . arguments)
  (force folder)
  (match (pipe)
    ((in . out)
     (let ((pid (primitive-fork)))
       (when (zero? pid)
         (close-port in)
         (dup2 (fileno out) 1)
         (chdir (force folder))
         (apply execlp "guile" "guile" "--no-auto-compile" program "--child"
                (format #f "--seed=~a" seed) (format #f "--setting=~a" setting) arguments))
       (close-port out)
       (let loop ((episode #f) (calls '()) (fault #f))
         (match (read-line-in-time in)
           (#f
            (kill pid SIGKILL)
            (waitpid pid)
            (list (format #f "hangs: nothing for ~a s" last-patience) episode calls))
           ((? eof-object?)
            (let ((status (cdr (waitpid pid))))
              (list (cond (fault fault)
                          ((status:term-sig status)
                           => (lambda (signal) (format #f "dies of signal ~a" signal)))
                          ((zero? (status:exit-val status)) #f)
                          (else (format #f "exits with status ~a" (status:exit-val status))))
                    episode calls)))
           (line
            (when (and (options 'verbose #f)
                       (or (options 'episode #f) (string-prefix? "slow" line)))
              (when (string-prefix? "slow" line) (format #t "episode ~a: ~a~%" episode (car calls)))
              (display line)
              (newline)
              (force-output))
            (cond ((string-prefix? "episode " line)
                   (loop (string->number (substring line 8)) '() fault))
                  ((string-prefix? "call " line) (loop episode (cons line calls) fault))
                  ((string-prefix? "never " line)
                   (set! never-returned (call-with-input-string (substring line 6) read))
                   (loop episode calls fault))
                  ((string-prefix? "end " line) (loop episode (list line) fault))
                  ((string-prefix? "fault " line) (loop episode calls (substring line 6)))
                  (else (loop episode calls fault))))))))))

(define (call-number line) (string->number (cadr (string-split line #\space))))

(define (episode-without episode left-out)
  (run-child (format #f "--episode=~a" episode)
             (format #f "--without=~a" (string-join (map number->string left-out) ","))))

;; The calls without which the episode ends well.
(define (shrunk episode calls)
  (let loop ((candidates (map call-number calls)) (left-out '()) (needed calls))
    (match candidates
      (() needed)
      ((number . rest)
       (match (episode-without episode (cons number left-out))
         ((#f . _) (loop rest left-out needed))
         ((_ _ calls) (loop rest (cons number left-out) calls)))))))

(define (parent)
  (match (if (options 'episode #f)
             (episode-without (car episodes) without)
             (run-child (format #f "--calls=~a" (options 'calls "1000"))))
    ((#f _ (end . _))
     (format #t "seed ~a, setting ~a: ~a episodes end well: ~a~%" seed setting (length episodes)
             (substring end 4))
     (format #t "never returned: ~s~%" never-returned)
     0)
    ((fault #f calls) (format #t "the child ~a before it began~%" fault) 2)
    ((fault episode calls)
     (format #t "seed ~a, setting ~a, episode ~a: ~a~%" seed setting episode fault)
     (format #t "again: fuzz-calls.scm --seed=~a --setting=~a --episode=~a --verbose~%"
             seed setting episode)
     (for-each (lambda (line) (format #t "  ~a~%" line))
               (reverse (if (null? without) (shrunk episode calls) calls)))
     1)))

(if (options 'child #f)
    (child)
    (let ((status (parent)))
      (system* "rm" "-rf" (force folder))
      (exit status)))
