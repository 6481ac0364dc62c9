;; The plan of a sweep: which runs there are, each with its number and its settings.
;;
;; A run keeps its number for ever.  What is asked for later, and is not planned yet, comes after.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-plan)
  #:use-module (timewarp errors)
  #:use-module (timewarp sweep-files)
  #:use-module (timewarp sweep-process)
  #:use-module (srfi srfi-1)
  #:use-module (srfi srfi-9)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:export (make-setting setting-kind setting-name setting-text
            make-plan plan? plan-directory plan-scene plan-arguments plan-outputs plan-runs
            run? run-number run-home run-settings
            all-combinations
            extend-plan
            read-plan write-plan
            find-run
            run-command))

;; A setting: KIND is `define' for a parameter of the scene, `option' for an option of timewarp.
(define (make-setting kind name text) (list kind name text))
(define setting-kind first)
(define setting-name second)
(define setting-text third)

(define (setting->arguments setting)
  (match setting
    (('define name text) (list "-D" (string-append name "=" text)))
    (('option name text) (list (string-append "--" name "=" text)))))

;; HOME is the number of the run whose folder takes the pictures and tables: its own, or for one of
;; several parts that of the first.
(define-record-type <run>
  (make-run number home settings)
  run?
  (number run-number)
  (home run-home)
  (settings run-settings))

;; DIRECTORY is where timewarp runs, SCENE and ARGUMENTS are what it gets each time, OUTPUTS an
;; alist of options (strings) and the names of files in the folder of a run.
(define-record-type <plan>
  (make-plan directory scene arguments outputs runs)
  plan?
  (directory plan-directory)
  (scene plan-scene)
  (arguments plan-arguments)
  (outputs plan-outputs)
  (runs plan-runs))

(define (all-combinations axes)
  "Return every list that takes one setting from each of AXES; the last axis goes round first."
  (match axes
    (() '(()))
    ((axis . rest)
     (let ((others (all-combinations rest)))
       (append-map (lambda (setting) (map (lambda (other) (cons setting other)) others)) axis)))))

(define (part? setting)
  (match setting (('option "part" _) #t) (_ #f)))

(define (extend-plan plan combinations)
  "Return PLAN with runs for those of COMBINATIONS (lists of settings) that have none yet, and the
runs of all COMBINATIONS."
  (define known (make-hash-table))
  (define homes (make-hash-table))
  (define next (1+ (length (plan-runs plan))))
  (define (key settings) (sort (map object->text settings) string<?))
  (define (note! run)
    (hash-set! known (key (run-settings run)) run)
    (hash-set! homes (key (remove part? (run-settings run))) (run-home run))
    run)
  (define (add! settings)
    (let ((number next))
      (set! next (1+ next))
      (note! (make-run number
                       (or (hash-ref homes (key (remove part? settings))) number)
                       settings))))
  (for-each note! (plan-runs plan))
  (let* ((asked (map (lambda (settings) (or (hash-ref known (key settings)) (add! settings)))
                     combinations))
         (new (remove (lambda (run) (<= (run-number run) (length (plan-runs plan)))) asked)))
    (values (make-plan (plan-directory plan) (plan-scene plan) (plan-arguments plan)
                       (plan-outputs plan) (append (plan-runs plan) new))
            asked)))

(define (object->text object) (format #f "~s" object))

;; ---- the file ----

;; One datum a line, so that a task need not read on once it has its run.
(define (write-plan plan folder)
  "Write PLAN into FOLDER."
  (write-whole-file (plan-file folder)
    (lambda (port)
      (format port ";; What timewarp-sweep runs in this folder, made by it.~%")
      (format port "~s~%" (list 'sweep 1 (plan-directory plan) (plan-scene plan)
                                (plan-arguments plan) (plan-outputs plan)))
      (for-each (lambda (run)
                  (format port "~s~%" (list (run-number run) (run-home run) (run-settings run))))
                (plan-runs plan)))))

(define (refuse-plan folder)
  (raise-error (format #f "~a is no plan of this version of timewarp-sweep; expected another --out"
                       (plan-file folder))))

(define (read-head port folder)
  (match (read port)
    (('sweep 1 directory scene arguments outputs)
     (make-plan directory scene arguments outputs '()))
    (_ (refuse-plan folder))))

(define (read-run port folder)
  (match (read port)
    ((? eof-object? end) end)
    ((number home settings) (make-run number home settings))
    (_ (refuse-plan folder))))

(define (call-with-plan-port folder proc)
  (call-with-input-file (plan-file folder) proc #:encoding "UTF-8"))

(define (read-plan folder)
  "Return the plan of FOLDER, #f where there is none."
  (and (file-exists? (plan-file folder))
       (call-with-plan-port folder
         (lambda (port)
           (let ((head (read-head port folder)))
             (let loop ((runs '()))
               (match (read-run port folder)
                 ((? eof-object?)
                  (make-plan (plan-directory head) (plan-scene head) (plan-arguments head)
                             (plan-outputs head) (reverse runs)))
                 (run (loop (cons run runs))))))))))

(define (find-run folder number)
  "Return the plan of FOLDER, of its runs only the one of that NUMBER, and this run."
  (unless (file-exists? (plan-file folder))
    (raise-error (format #f "there is no plan in ~a; expected the --out of a sweep" folder)))
  (call-with-plan-port folder
    (lambda (port)
      (let ((head (read-head port folder)))
        (let loop ()
          (match (read-run port folder)
            ((? eof-object?)
             (raise-error (format #f "there is no run ~a in ~a" number (plan-file folder))))
            ((? (lambda (run) (= (run-number run) number)) run) (values head run))
            (_ (loop))))))))

;; ---- commands ----

(define* (run-command plan run folder #:key (own '()))
  "Return the words of the command that is RUN, of PLAN in FOLDER; OWN are further options."
  (append (list (timewarp-program) (plan-scene plan))
          (append-map setting->arguments (run-settings run))
          (plan-arguments plan)
          (map (match-lambda
                 ((option . name)
                  (string-append "--" option "="
                                 (in-sweep (run-folder folder (run-home run)) name))))
               (plan-outputs plan))
          own))
