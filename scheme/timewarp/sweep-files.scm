;; The files of a sweep's folder.
;;
;;   plan.scm          what was asked for, and the settings of each run, a line each
;;   scene.scm         the scene's file as it was
;;   runs.jsonl        the results of all runs that have ended, a line each
;;   runs/00001.json   the result of a run: there once it has ended, whole
;;   runs/00001.out    its standard output;  runs/00001.log  its standard error
;;   runs/00001/       its pictures and tables
;;   batches/          what was given to GNU Parallel and to Slurm
;;   lock              locked while a timewarp-sweep, or what it has started, is at work
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-files)
  #:use-module (timewarp errors)
  #:use-module (ice-9 binary-ports)
  #:use-module (ice-9 match)
  #:use-module (ice-9 textual-ports)
  #:export (in-sweep
            plan-file scene-copy-file merged-file result-file output-file log-file
            statistics-file run-folder batch-file
            make-folders
            write-whole-file
            read-text
            file-lines
            same-bytes?
            number->name
            call-with-sweep-lock))

(define (in-sweep folder . names)
  "Return the name of a file in FOLDER."
  (string-join (cons folder names) "/"))

(define (number->name number)
  (string-pad (number->string number) (max 5 (string-length (number->string number))) #\0))

(define (plan-file folder) (in-sweep folder "plan.scm"))
(define (scene-copy-file folder) (in-sweep folder "scene.scm"))
(define (merged-file folder) (in-sweep folder "runs.jsonl"))
(define (run-file folder number suffix)
  (in-sweep folder "runs" (string-append (number->name number) suffix)))
(define (result-file folder number) (run-file folder number ".json"))
(define (output-file folder number) (run-file folder number ".out"))
(define (log-file folder number) (run-file folder number ".log"))
(define (statistics-file folder number) (run-file folder number ".statistics"))
(define (run-folder folder number) (run-file folder number ""))
(define (batch-file folder number suffix)
  (in-sweep folder "batches" (string-append (number->name number) suffix)))

(define (make-folders name)
  "Make the folder NAME and those above it, where they are not there yet."
  (unless (or (string-null? name) (file-exists? name))
    (make-folders (dirname name))
    (catch 'system-error
      (lambda () (mkdir name))
      (lambda args
        ;; another task may have been faster
        (unless (= (system-error-errno args) EEXIST)
          (raise-error (format #f "cannot make the folder ~a: ~a; expected one that can be written"
                               name (strerror (system-error-errno args)))))))))

(define (write-whole-file file proc)
  "Let PROC write to a port; then FILE is what it wrote, at no time less."
  (let ((part (string-append file ".part")))
    (catch 'system-error
      (lambda ()
        (call-with-output-file part proc #:encoding "UTF-8")
        (rename-file part file))
      (lambda args
        (raise-error (format #f "cannot write ~a: ~a; expected a file that can be written" file
                             (strerror (system-error-errno args))))))))

(define (read-text file)
  "Return what FILE holds, #f where it is not there."
  (and (file-exists? file)
       (call-with-input-file file get-string-all #:encoding "UTF-8")))

(define (same-bytes? one other)
  "Do the files ONE and OTHER hold the same?"
  (define (bytes file) (call-with-input-file file get-bytevector-all #:binary #t))
  (equal? (bytes one) (bytes other)))

(define (file-lines file)
  "Return the lines of FILE, none where it is not there."
  (match (read-text file)
    ((or #f "") '())
    (text (string-split (string-trim-right text #\newline) #\newline))))

;; What is started inherits the lock, and so keeps it if this process is killed.
(define (call-with-sweep-lock folder thunk)
  "Call THUNK while no other timewarp-sweep works in FOLDER; raise an error where one does."
  (let ((port (open-file (in-sweep folder "lock") "a")))
    (dynamic-wind
      (const #t)
      (lambda ()
        (catch 'system-error
          (lambda () (flock port (logior LOCK_EX LOCK_NB)))
          (lambda args
            ;; some file systems have no locks
            (when (= (system-error-errno args) EWOULDBLOCK)
              (raise-error
               (string-append "another timewarp-sweep, or what it has started, works in " folder
                              "; expected its end")))))
        (thunk))
      (lambda () (close-port port)))))
