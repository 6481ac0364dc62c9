;; The loader: reads, compiles and runs a scene form by form, and remembers where each began.
;;
;; Compiled code keeps its lines, which interpreted code doesn't; a compiled tail call leaves no frame,
;; for which the place of the form is the fallback.  The plain compiler is used (-O1): a form compiles
;; in 2 ms rather than 30.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp loader)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp files)
  #:use-module (system base compile)
  #:use-module (ice-9 match)
  #:use-module (ice-9 textual-ports)
  #:export (load-scene read-scene-forms))

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

(define (run-form form)
  (compile form #:env (current-module) #:optimization-level 1 #:warning-level 0))

;; Errors that know no better place get that of the form; others pass as they are.
(define (call-placing-errors place thunk)
  (let ((description #f))
    (catch #t
      (lambda () (parameterize ((current-form-place place)) (thunk)))
      (lambda (key . args)
        (match description
          (#(message place backtrace) (raise-error message place backtrace))
          (_ (apply throw key args))))
      (lambda (key . args)
        (unless (memq key '(quit timewarp-interrupted))
          (parameterize ((current-form-place place))
            (set! description (describe-error key args))))))))

(define (load-scene file)
  "Load the scene FILE: run its forms in the current module, so that they fill the current world.  An
error is raised as a timewarp-error with its place in the file."
  (unless (string? file) (bad-value "the scene" file "a file name"))
  (parameterize ((current-scene-directory (dirname file)))
    (call-with-current-folder-loadable
     (lambda ()
       (save-module-excursion
        (lambda ()
          (for-each-form (lambda (form place)
                           (call-placing-errors place (lambda () (run-form form))))
                         file)))))))

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
