;; The command line: what the program `timewarp' does with its arguments.
;;
;; Exit status: 0; 1 for an error in the scene or the run; 2 for wrong usage; 130 after Ctrl-C.
;; SIGTERM and SIGHUP close what Ctrl-C closes, then end the program by the signal.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp command-line)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp exit-status)
  #:use-module (timewarp worlds)
  #:use-module (timewarp parameters)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp running)
  #:use-module (timewarp recorders)
  #:use-module (timewarp drawing)
  #:use-module (timewarp loader)
  #:use-module (timewarp option-table)
  #:use-module (timewarp options)
  #:use-module (timewarp progress)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:export (main))

;; ---- help and version ----

(define (show-help scene)
  (display "Usage: timewarp [OPTION]... [SCENE.scm]\n")
  (display "Without a scene: a REPL with (timewarp) loaded.\n")
  (display "Simulate a scene of rigid bodies, written in Scheme.\n\n")
  (display (option-help))
  (when scene (show-parameters scene)))

;; The scene is read, not run: --help must have no effects.
(define (show-parameters scene)
  (let ((parameters
         (filter-map (match-lambda
                       (('define-scene-parameter (? symbol? name) default . doc)
                        (list name default (match doc (((? string? doc)) doc) (_ ""))))
                       (_ #f))
                     (read-scene-forms scene))))
    (format #t "\nParameters of ~a, set by -D NAME=VALUE:\n" scene)
    (when (null? parameters) (display "  none\n"))
    (for-each (match-lambda
                ((name default doc)
                 (format #t "  ~a  ~a (~s)\n" (string-pad-right (symbol->string name) 20) doc
                         default)))
              parameters)))

(define (show-version)
  (format #t "timewarp ~a\n" (%version))
  (format #t "Guile ~a~a\n" (version)
          (string-concatenate
           (map (match-lambda ((name . version) (string-append ", " name " " version)))
                (%libraries))))
  (format #t "drawing: ~a\n"
          (if (%drawing?) "OSMesa or EGL, loaded when the first picture is drawn" "left out"))
  (display "License LGPL-3.0-or-later; the REPL loads GNU readline (GPL) where it is installed.\n"))

;; ---- the run ----

(define override-keys
  '(accuracy seed threads fps size quality part contacts no-overlay hash check undo-redo gvt-interval window
    group-check-rate integrator policy adversary write-states compare-states))

(define (take-overrides! options)
  (set-overrides! (filter (lambda (pair) (memq (car pair) override-keys)) options))
  (set-definitions! (option-values options 'define)))

(define (check-definitions)
  (match (unused-definitions)
    (() #t)
    ((name . _)
     (usage-error "-D sets ~a, which is no parameter of the scene; expected one of: ~a" name
                  (match (defined-parameters)
                    (() "(it has none)")
                    (names (string-join (map symbol->string names) ", ")))))))

;; Runs to the end in pieces, by default one; a scene may have run farther by itself.
(define (run-to-end! world options)
  (let* ((end (or (option-ref options 'until) (option-ref options 'at) (world-duration world)))
         (start (%world-time world))
         (pieces (or (option-ref options 'pieces) 1)))
    (when (> end start)
      (for-each (lambda (k)
                  (run-world! world (if (= k pieces)
                                        end
                                        (+ start (* k (/ (- end start) pieces))))))
                (iota pieces 1)))
    ;; also where nothing is left to run: frame 0 is due
    (when (and (= end start) (zero? start)) (run-world! world end))))

;; The scene fills the world that -l and -c may have filled before; where it starts afresh by
;; itself, the new world is what runs.
(define (simulate-scene! scene options)
  (call-with-recorders
    (lambda ()
      (run-scene-file scene)
      (check-definitions)
      (run-to-end! (current-world) options))
    #:frames (option-ref options 'frames)
    #:movie (option-ref options 'movie)
    #:at (option-ref options 'at)
    #:poses (option-ref options 'poses)
    #:events (option-ref options 'events)))

(define (report-statistics world options)
  (match (option-ref options 'stats)
    (#f #t)
    (#t (show-statistics))
    (file (%write-statistics world file))))

(define (report-results world options)
  (report-statistics world options)
  (when (option-ref options 'hash)
    (format #t "~a\n" (%history-hash world))))

(define (run-scene scene options)
  (call-with-values (if (option-ref options 'quiet)
                        (lambda () (values (const #f) (const #f)))
                        make-progress)
    (lambda (progress end-progress)
      (parameterize ((current-slice-hooks (cons progress (current-slice-hooks))))
        (dynamic-wind
          (const #t)
          (lambda ()
            ;; who stops a run may want to know what takes its time
            (catch 'timewarp-interrupted
              (lambda () (simulate-scene! scene options))
              (lambda interrupt
                (report-statistics (current-world) options)
                (apply throw interrupt))))
          end-progress))))
  (report-results (current-world) options))

;; With -i an error of the scene, or Ctrl-C, leads to the prompt, too.
(define (run-scene-then-repl scene options)
  (exit-status (lambda () (run-scene scene options)))
  (unless (ending?) (start-repl* options)))

;; ---- REPL and -c ----

(define (enter-user-module)
  (set-current-module (resolve-module '(guile-user)))
  (module-use! (current-module) (resolve-interface '(timewarp))))

(define (start-repl* options)
  ((module-ref (resolve-interface '(timewarp repl)) 'start-timewarp-repl)
   #:init? (not (option-ref options 'no-init))
   #:poll (and (option-ref options 'listen) (from-server 'poll-server!))))

;; Loaded where it is asked for only: ports behave otherwise then.
(define (from-server name) (module-ref (resolve-interface '(timewarp server)) name))

(define (call-with-listening options thunk)
  (match (option-ref options 'listen)
    (#f (thunk))
    (where
     (let ((poll! (from-server 'poll-server!)))
       ((from-server 'call-with-server) ((from-server 'parse-address) where)
        (lambda (text)
          (unless (option-ref options 'quiet) (complain "listening on ~a" text)))
        (lambda ()
          (parameterize ((current-slice-hooks
                          (cons (lambda (world until) (poll!)) (current-slice-hooks))))
            (thunk))))))))

(define (evaluate-command text)
  (call-with-input-string text
    (lambda (port)
      (let loop ()
        (let ((form (read port)))
          (unless (eof-object? form)
            (eval form (current-module))
            (loop)))))))

;; ---- main ----

(define (scene-operand options)
  (match (option-values options 'operand)
    (() #f)
    ((scene) scene)
    (_ (usage-error "there is more than one scene; expected one"))))

(define (check-usage options scene)
  (when (and (not scene)
             (any (lambda (key) (option-ref options key))
                  '(until frames movie at poses events stats hash watch)))
    (usage-error "there is no scene; expected timewarp [OPTION]... SCENE.scm"))
  (when (and (option-ref options 'watch) (option-ref options 'interactive))
    (usage-error "--watch starts afresh with each save, and has no prompt; expected no -i (~a)"
                 "--listen has prompts"))
  (for-each (lambda (key)
              (when (and (option-ref options key) (not (%drawing?)))
                (usage-error "--~a needs drawing, which was left out when timewarp was built ~a"
                             key "(--disable-render)")))
            '(frames movie))
  (when (and (option-ref options 'movie) (option-ref options 'part))
    (usage-error "--movie has all frames, --part draws some of them; expected one of the two"))
  (check-at (option-ref options 'at) options))

(define (check-at time options)
  (when time
    (let ((file (option-ref options 'frames)))
      (unless (and file (string-suffix-ci? ".png" file))
        (usage-error "--at draws one picture~a; expected --frames=FILE.png"
                     (if file (format #f ", --frames is ~s" file) ""))))
    (when (< (or (option-ref options 'until) time) time)
      (usage-error "--at is ~a, after --until, ~a; expected a time of the run" time
                   (option-ref options 'until)))))

(define (work options args)
  (let ((scene (scene-operand options)))
    (cond
     ((option-ref options 'version) (show-version))
     ((option-ref options 'help) (show-help scene))
     ((option-ref options 'watch)
      (check-usage options scene)
      ((module-ref (resolve-interface '(timewarp watch)) 'watch-scene)
       scene (delete "--watch" args)
       (lambda (text) (unless (option-ref options 'quiet) (complain "timewarp: ~a" text)))))
     (else
      (check-usage options scene)
      (take-overrides! options)
      (match (option-ref options 'files-read)
        (#f #t)
        (report ((module-ref (resolve-interface '(timewarp watch)) 'report-files-read) report)))
      (parameterize ((current-world (make-world)))
        (enter-user-module)
        (call-with-listening options (lambda () (do-operands scene options))))))))

(define (do-operands scene options)
  (for-each (lambda (file) (primitive-load file)) (option-values options 'load))
  (for-each evaluate-command (option-values options 'command))
  (cond ((and scene (option-ref options 'interactive)) (run-scene-then-repl scene options))
        (scene (run-scene scene options))
        ((or (option-ref options 'interactive) (not (option-ref options 'command)))
         (start-repl* options))))

(define (main args)
  "Do what the command line ARGS says; exit with a status."
  (call-with-write-errors (lambda () (run-command-line args))))

(define (run-command-line args)
  ;; -L before any module is looked for
  (let* ((options #f)
         (status
          (exit-status
           (lambda ()
             (set! options (parse-command-line args))
             (for-each (lambda (folder) (set! %load-path (cons folder %load-path)))
                       (reverse (option-values options 'load-path)))
             (call-with-interrupts
              (lambda () (call-with-bounded-stack (lambda () (work options args)))))
             (flush-output)))))
    (exit-program status)))
