;; One run of a sweep, here and now: its process, its files, its result.
;;
;; The result is written last and at once: a run is finished or has left nothing that counts.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-task)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp sweep-files)
  #:use-module (timewarp sweep-plan)
  #:use-module (timewarp sweep-process)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:use-module (ice-9 regex)
  #:export (run-task))

(define (delete-if-there file)
  (when (file-exists? file) (delete-file file)))

;; ---- what the run printed ----

(define value-line
  (make-regexp (string-append "^[[:space:]]*([[:alpha:]][-_.?[:alnum:]]*)[[:space:]]*="
                              "[[:space:]]*([^[:space:]]+)[[:space:]]*$")))

(define (decimal text)
  (and (not (string-index text #\/)) (string->number text 10)))

;; Lines NAME = NUMBER that the scene prints, as an alist; of several the last one holds.
(define (printed-values lines)
  (fold (lambda (line values)
          (let* ((match (regexp-exec value-line line))
                 (number (and match (decimal (match:substring match 2)))))
            (if (and number (real? number))
                (let ((name (match:substring match 1)))
                  (append (alist-delete name values) (list (cons name number))))
                values)))
        '() lines))

(define (printed-hash lines)
  (match lines
    ((_ ... (? (lambda (line) (string-match "^[0-9a-f]{64}$" line)) hash)) hash)
    (_ #f)))

;; What went wrong, in one line: the first that is no warning and not the command itself.
(define (error-line log status)
  (or (find (lambda (line)
              (not (or (string-null? line) (string-prefix? "$ " line)
                       (string-contains line "warning:"))))
            (file-lines log))
      (cond ((= status 124) "the time that --timeout allows is over")
            ((> status 128) (format #f "ended by signal ~a" (- status 128)))
            (else (format #f "exit status ~a, without a message" status)))))

;; ---- the result ----

;; A setting's text as the JSON value that it looks like.
(define (text->value text)
  (match (decimal text)
    ((? real? number) number)
    (_ (match text ("#t" #t) ("#f" #f) (_ text)))))

(define (settings-of kind run)
  (filter-map (lambda (setting)
                (and (eq? (setting-kind setting) kind)
                     (cons (setting-name setting) (text->value (setting-text setting)))))
              (run-settings run)))

(define (statistics folder number)
  (match (read-text (statistics-file folder number))
    ((or #f "") '())
    (text (%read-json text))))

(define (optional key value) (if value (list (cons key value)) '()))

(define (result plan run folder status started wall cpu)
  (let* ((number (run-number run))
         (lines (file-lines (output-file folder number))))
    `(("run" . ,number)
      ("scene" . ,(plan-scene plan))
      ("parameters" . ,(settings-of 'define run))
      ("options" . ,(settings-of 'option run))
      ("status" . ,status)
      ,@(optional "error" (and (not (zero? status)) (error-line (log-file folder number) status)))
      ("wall_seconds" . ,wall)
      ("process_cpu_seconds" . ,cpu)
      ("started" . ,(strftime "%Y-%m-%dT%H:%M:%SZ" (gmtime started)))
      ("host" . ,(gethostname))
      ,@(optional "hash" (and (member "--hash" (plan-arguments plan)) (printed-hash lines)))
      ("values" . ,(printed-values lines))
      ("statistics" . ,(statistics folder number)))))

;; ---- the run ----

(define (wall-seconds)
  (match (gettimeofday) ((seconds . microseconds) (+ seconds (* 1e-6 microseconds)))))

;; of all processes that have ended and were waited for
(define (children-cpu-seconds)
  (let ((now (times)))
    (exact->inexact (/ (+ (tms:cutime now) (tms:cstime now)) internal-time-units-per-second))))

;; s that a run has to close its files when its time is over, before it is killed
(define patience 10)

(define (with-timeout timeout command)
  (if timeout
      (cons* "timeout" (format #f "--kill-after=~a" patience)
             (number->string (exact->inexact timeout)) command)
      command))

(define (run-process command timeout folder number)
  (let* ((output (open-output-file (output-file folder number)))
         (errors (open-output-file (log-file folder number)))
         (child #f))
    (format errors "$ ~a~%" (command->text command))
    (call-with-stopping-signals
     (lambda () (when child (false-if-exception (kill child SIGTERM))))
     (lambda ()
       (set! child (start-process (with-timeout timeout command) #:output output #:errors errors))
       (let ((status (wait-for-process child)))
         (close-port output)
         (close-port errors)
         status)))))

;; A run that somebody stops is not a run that fails: it leaves no result.
(define (stopped? status)
  (or (stopping?) (memv (- status 128) (list SIGINT SIGTERM SIGHUP))))

;; Runs beside each other leave each other the cores, unless somebody asks for more.
(define (own-threads plan)
  (if (any (lambda (word) (string-prefix? "--threads" word)) (plan-arguments plan))
      '()
      '("--threads=1")))

(define (run-task folder number timeout)
  "Run the run of that NUMBER of the plan in FOLDER, for at most TIMEOUT s (#f: as long as it
takes).  Return its exit status, #f if it was stopped."
  (call-with-values (lambda () (find-run folder number))
    (lambda (plan run)
      (delete-if-there (result-file folder number))
      (delete-if-there (statistics-file folder number))
      (unless (null? (plan-outputs plan)) (make-folders (run-folder folder (run-home run))))
      (chdir (plan-directory plan))
      (let* ((command (run-command plan run folder
                                   #:own (cons* "--quiet"
                                                (string-append "--stats="
                                                               (statistics-file folder number))
                                                (own-threads plan))))
             (started (wall-seconds))
             (cpu-before (children-cpu-seconds))
             (status (run-process command timeout folder number))
             (wall (- (wall-seconds) started)))
        (and (not (stopped? status))
             (let ((line (%write-json
                          (result plan run folder status (inexact->exact (floor started)) wall
                                  (- (children-cpu-seconds) cpu-before)))))
               (write-whole-file (result-file folder number)
                 (lambda (port) (display line port) (newline port)))
               (delete-if-there (statistics-file folder number))
               status))))))
