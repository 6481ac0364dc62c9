;; The loader: reads and runs a scene form by form, and remembers where each began: the place of an
;; error that knows no better one.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp loader)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp files)
  #:use-module (timewarp forms)
  #:use-module (timewarp worlds)
  #:use-module (ice-9 match)
  #:use-module (ice-9 textual-ports)
  #:export (load-scene)
  ;; for the command line
  #:export (run-scene-file read-scene-forms))

;; Skips blanks and line comments, so that the port stands where the next form begins.
(define (skip-blanks port)
  (let ((char (peek-char port)))
    (cond ((eof-object? char) #t)
          ((char-whitespace? char) (read-char port) (skip-blanks port))
          ((char=? char #\;) (get-line port) (skip-blanks port)))))

(define (port-place port)
  (list (port-filename port) (1+ (port-line port)) (1+ (port-column port))))

;; The next form; an error names where it begins, since a missing parenthesis shows at the end only.
(define (read-form port place)
  (catch 'read-error
    (lambda () (read-syntax port))
    (lambda (key . args)
      (let ((text (error-text key args)))
        (if (string-contains text "end of input")
            (raise-error (string-append "the form that begins here is not closed: " text) place)
            ;; the character at fault has just been read
            (raise-error (string-append "syntax error: " text)
                         (list (port-filename port) (1+ (port-line port)) (port-column port))))))))

(define (call-with-scene-port file proc)
  (note-file-read file)
  (let ((port (fdopen (%open-scene file) "r")))
    (set-port-filename! port file)
    (dynamic-wind
      (const #t)
      (lambda ()
        (catch 'system-error
          (lambda ()
            (set-port-encoding! port (or (file-encoding port) "UTF-8"))
            (peek-char port))
          (lambda args
            (raise-error (format #f "cannot read the scene ~a: ~a; expected a Scheme file" file
                                 (strerror (system-error-errno args))))))
        (proc port))
      (lambda () (close-port port)))))

;; Calls PROC with each form (syntax) and its place.
(define (for-each-form proc file)
  (call-with-scene-port file
    (lambda (port)
      (let loop ()
        (skip-blanks port)
        (let* ((place (port-place port))
               (form (read-form port place)))
          (unless (eof-object? form)
            (proc form place)
            (loop)))))))

(define (read-scene-forms file)
  "Return the forms of the scene FILE as data, without running them."
  (let ((forms '()))
    (for-each-form (lambda (form place) (set! forms (cons (syntax->datum form) forms))) file)
    (reverse forms)))

;; Errors that know no better place get that of the form; others pass as they are.
(define (call-placing-errors place thunk)
  (let ((description #f))
    (catch #t
      (lambda ()
        (parameterize ((current-form-place place) (current-form-load-port (current-load-port)))
          (thunk)))
      (lambda (key . args)
        (match description
          (#(message place backtrace) (raise-error message place backtrace))
          (_ (apply throw key args))))
      (lambda (key . args)
        (unless (memq key '(quit timewarp-interrupted))
          ;; where it was thrown the form's place still stands, or a more exact one
          (set! description (describe-error key args)))))))

;; The expander reads what a form includes, relative to the file that the form is in.
(define (note-include form file)
  (syntax-case form ()
    ((head name)
     (and (eq? (syntax->datum #'head) 'include) (string? (syntax->datum #'name)))
     (note-file-read (in-vicinity (dirname file) (syntax->datum #'name))))
    (_ #t)))

(define (run-scene-file file)
  "Run the forms of the scene FILE in the current module, so that they fill the current world.  An
error is raised as a timewarp-error with its place in the file."
  (parameterize ((current-scene-directory (dirname file)))
    (call-with-current-folder-loadable
     (lambda ()
       (save-module-excursion
        (lambda ()
          (for-each-form (lambda (form place)
                           (note-include form file)
                           (call-placing-errors place
                             (lambda () (call-with-bounded-stack (lambda () (run-form form))))))
                         file)))))))

(define (load-scene file)
  "Start afresh, as reset! does, and fill the new world by running the scene FILE.  On an error, or
when it is interrupted, the world that was current before is current again, just as it was; names
that the scene has defined by then stay defined.  FILE is relative to the scene that is being loaded,
else to the current folder.  A scene that shares a part with others takes it in by Guile's `load' or
`include': load-scene in a scene leaves behind what was in the world before."
  (unless (string? file) (bad-value "the scene" file "a file name"))
  (let ((file (scene-file file))
        (old (start-afresh! "load-scene"))
        (loaded? #f))
    (dynamic-wind
      (const #t)
      (lambda ()
        (run-scene-file file)
        (set! loaded? #t))
      (lambda ()
        (unless loaded? (current-world old))))
    (if #f #f)))

;; Guile's `load' makes a name relative to the file it is in, and looks what is still relative up in
;; the load path.
(define (call-with-current-folder-loadable thunk)
  (let ((outer #f))
    (dynamic-wind
      (lambda ()
        (set! outer %load-path)
        (set! %load-path (append %load-path (list (getcwd)))))
      thunk
      (lambda () (set! %load-path outer)))))
