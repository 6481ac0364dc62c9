;; --watch: a scene that is saved runs again, from the start, in a process of its own.
;;
;; A new process knows nothing of the run before: what was deleted from the scene is gone, modules are
;; read again, and whatever a run does to itself, the next save is waited for.  Files are looked at
;; ten times a second rather than by inotify: editors that write a new file and rename it, folders
;; on the network and files that are missing for a moment are then one and the same.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp watch)
  #:use-module (timewarp errors)
  #:use-module (timewarp interrupts)
  #:use-module (timewarp exit-status)
  #:use-module (timewarp files)
  #:use-module ((timewarp sweep-process) #:select (timewarp-program start-process))
  #:use-module (ice-9 match)
  #:use-module (ice-9 rdelim)
  #:use-module (srfi srfi-1)
  #:export (watch-scene
            report-files-read))

;; us between looks at the files
(define look-interval 100000)

;; ---- in the process that runs: which files it reads ----

(define (report-files-read report)
  "Append the name of each file that is loaded from now on to the file REPORT, a line each."
  (define (note file)
    (let ((port (open-file report "a")))
      (display (if (absolute-file-name? file) file (in-vicinity (getcwd) file)) port)
      (newline port)
      (close-port port)))
  (let ((announce %load-hook))
    (set! %load-hook (lambda (file)
                       (note file)
                       (when announce (announce file)))))
  (current-file-reader note))

;; ---- in the process that watches ----

;; What tells one content of FILE from another; #f while there is none.
(define (stamp file)
  (match (stat file #f)
    (#f #f)
    (there (list (stat:mtime there) (stat:mtimensec there) (stat:size there) (stat:ino there)))))

(define (stamps files) (map (lambda (file) (cons file (stamp file))) files))

(define (add-new known files)
  (append known (stamps (lset-difference string=? (delete-duplicates files) (map car known)))))

(define (changed known)
  (find (match-lambda ((file . old) (not (equal? old (stamp file))))) known))

(define (lines file)
  (call-with-input-file file
    (lambda (port)
      (let loop ((lines '()))
        (match (read-line port)
          ((? eof-object?) (reverse lines))
          (line (loop (cons line lines))))))))

;; Waits until the files have been as they are, and there, for one look.
(define (wait-until-still known)
  (let loop ((before (stamps (map car known))))
    (usleep look-interval)
    (let ((now (stamps (map car known))))
      (unless (and (equal? now before) (cdar now)) (loop now)))))

;; The status of the process PID, or #f while it runs.
(define (ended pid)
  (match (waitpid pid WNOHANG)
    ((0 . _) #f)
    ((_ . status) (or (status:exit-val status) (+ 128 (status:term-sig status))))))

;; s that a run has to close what it writes
(define patience 10)

(define (stop! pid)
  (false-if-exception (kill pid SIGTERM))
  (let wait ((left (quotient (* patience 1000000) 20000)))
    (cond ((ended pid))
          ((zero? left)
           (kill pid SIGKILL)
           (waitpid pid))
          (else
           (usleep 20000)
           (wait (1- left))))))

(define (run-once arguments scene report say)
  (let ((pid #f) (running? #t) (known (stamps (list scene))))
    (truncate-file report 0)
    (dynamic-wind
      (const #t)
      (lambda ()
        (set! pid (start-process (cons* (timewarp-program)
                                        (string-append "--files-read=" report) arguments)))
        (let loop ()
          (set! known (add-new known (lines report)))
          (match (ended pid)
            (#f (unless (changed known)
                  (usleep look-interval)
                  (loop)))
            (status
             (set! running? #f)
             (say (format #f "~a ~a; it runs again when it is saved" scene
                          (if (zero? status) "has run" "has failed")))))))
      ;; also when Ctrl-C, which reaches both, or a signal ends the watch
      (lambda () (when (and pid running?) (stop! pid))))
    known))

(define (watch-scene scene arguments say)
  "Run the program with ARGUMENTS, which name SCENE, again and again: whenever SCENE or a file that it
has read is saved, at once if it still runs.  SAY tells the user.  Returns by Ctrl-C and other
signals only."
  (unless (stamp scene)
    (raise-error (format #f "cannot watch ~a: ~a; expected a scene" scene (strerror ENOENT))))
  (let ((report (port-filename* (mkstemp "/tmp/timewarp-watch-XXXXXX"))))
    (call-with-ending-signals
     (lambda ()
       (dynamic-wind
         (const #t)
         (lambda ()
           (let again ()
             (let ((known (run-once arguments scene report say)))
               (let wait ()
                 (match (changed known)
                   (#f
                    (usleep look-interval)
                    (wait))
                   ((file . _)
                    (wait-until-still known)
                    (say (format #f "~a was saved" file))
                    (again)))))))
         (lambda () (delete-file report)))))))

(define (port-filename* port)
  (let ((name (port-filename port)))
    (close-port port)
    name))
