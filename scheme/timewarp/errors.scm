;; Errors: how they are raised, where they are placed, how they are shown.
;;
;; A mistake raises `timewarp-error' with the arguments (WHO FORMAT (MESSAGE) (PLACE BACKTRACE)), as
;; Guile's own errors do.  PLACE is (FILE LINE COLUMN), lines and columns from 1: that of the
;; innermost frame of the user's files on the stack, else that of the form being loaded.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp errors)
  #:use-module (timewarp primitives)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:use-module (ice-9 regex)
  #:use-module (system vm frame)
  #:export (raise-error
            bad-value
            check-keywords
            define-keyword-procedure
            current-form-place
            caller-place
            place->string
            describe-error
            error-text
            not-there-yet))

;; ---- places ----

;; Place of the top-level form that the loader runs now, or #f.
(define current-form-place (make-parameter #f))

(define-syntax-rule (own-directory)
  (dirname (or (assq-ref (current-source-location) 'filename) "timewarp/errors.scm")))

;; frames of these files are ours, not the user's
(define own-files
  (let ((folder (own-directory)))
    (cons (string-append (dirname folder) "/timewarp.scm")
          (map (lambda (name) (string-append folder "/" name ".scm"))
               '("errors" "worlds" "parameters" "shapes" "bodies" "contact" "purity" "callbacks" "vectors"
                 "running" "looking" "files" "drawing" "recorders" "simulate" "loader" "options"
                 "progress" "interrupts" "repl" "command-line")))))

(define system-folders
  '("ice-9/" "srfi/" "system/" "language/" "oop/" "rnrs/" "sxml/" "texinfo/"))

(define (users-file? file)
  (and (string? file)
       (not (member file own-files))
       (not (string=? file "timewarp.scm"))
       (not (any (lambda (folder) (string-prefix? folder file)) system-folders))))

;; Looking a frame's line up takes about a millisecond; code never moves, so answers are kept by its
;; address.
(define places-by-address (make-hash-table))

;; (FILE LINE COLUMN) of a frame in one of the user's files, or #f.
(define (frame-place frame)
  (let* ((address (frame-instruction-pointer frame))
         (handle (hashv-get-handle places-by-address address)))
    (if handle
        (cdr handle)
        (let ((place (look-up-place frame)))
          (hashv-set! places-by-address address place)
          place))))

(define (look-up-place frame)
  (match (frame-source frame)
    ((_ file line . column)
     (and (users-file? file) (list file (1+ line) (1+ column))))
    (_ #f)))

(define (user-frames most)
  "Return up to MOST frames of the user's files on the stack, innermost first, as ((PLACE . NAME) ...)."
  (let ((stack (make-stack #t)))
    (let loop ((frame (and stack (stack-ref stack 0))) (frames '()))
      (if (or (not frame) (= (length frames) most))
          (reverse frames)
          (let ((place (frame-place frame)))
            (loop (frame-previous frame)
                  (if (and place (not (and (pair? frames) (equal? place (caar frames)))))
                      (acons place (frame-procedure-name frame) frames)
                      frames)))))))

(define (caller-place)
  "Return the place in the user's files that is being run, or #f."
  (match (user-frames 1)
    (((place . _)) place)
    (_ (current-form-place))))

(define (place->string place)
  "Return FILE:LINE:COLUMN."
  (match place
    ((file line column) (format #f "~a:~a:~a" file line column))))

;; "  scene.scm:12:4 (swing)" for each frame but the first, which the message itself names
(define (backtrace-text places)
  (string-join
   (map (match-lambda
          ((place . name)
           (string-append "  " (place->string place) (if name (format #f " (~a)" name) ""))))
        places)
   "\n"))

;; ---- raising ----

(define* (raise-error message #:optional place (backtrace ""))
  "Raise a timewarp-error with MESSAGE at PLACE, by default where the user's files call."
  (throw 'timewarp-error #f "~A" (list message)
         (list (or place (caller-place)) backtrace)))

(define (bad-value name value expected)
  "Raise the error `NAME is VALUE; expected EXPECTED'."
  (raise-error (format #f "~a is ~a; expected ~a" name (short-text value) expected)))

(define (not-there-yet what needs)
  "Raise the error that WHAT comes later, since it NEEDS something."
  (raise-error (format #f "~a is not there yet: it needs ~a, in a later version" what needs)))

;; A value as it is written, cut where it is long.
(define (short-text value)
  (let ((text (format #f "~s" value)))
    (if (> (string-length text) 200)
        (string-append (substring text 0 200) "...")
        text)))

;; ---- keywords ----

(define (check-keywords name given known)
  "Raise an error unless the arguments GIVEN to NAME are KNOWN keywords and their values."
  (match given
    (() #t)
    (((? keyword? keyword) _ . rest)
     (unless (memq keyword known)
       (raise-error (format #f "~a got the unknown keyword ~s; expected one of ~a" name keyword
                            (string-join (map (lambda (k) (format #f "~s" k)) known) " "))))
     (check-keywords name rest known))
    (((? keyword? keyword))
     (raise-error (format #f "~a got ~s without a value; expected one" name keyword)))
    ((value . _)
     (raise-error (format #f "~a got ~a; expected a keyword such as ~s" name (short-text value)
                          (car known))))))

(eval-when (expand load eval)
  (define (syntax->list* list)
    (syntax-case list ()
      (() '())
      ((first . rest) (cons #'first (syntax->list* #'rest))))))

(define-syntax define-keyword-procedure
  (lambda (x)
    "(define-keyword-procedure (NAME ARG ... #:key KEY ...) DOC BODY ...): a procedure with optional
keywords.  A keyword given #f counts as absent; an unknown one is an error that names the others."
    (define (split formals)
      (let loop ((formals formals) (positional '()))
        (syntax-case formals ()
          ((key . keys) (eq? (syntax->datum #'key) #:key) (values (reverse positional) #'keys))
          ((formal . rest) (loop #'rest (cons #'formal positional))))))
    (syntax-case x ()
      ((_ (name . formals) doc body ...)
       (call-with-values (lambda () (split #'formals))
         (lambda (positional keys)
           (with-syntax (((arg ...) positional)
                         ((key ...) keys)
                         ((keyword ...)
                          (map (lambda (key)
                                 (datum->syntax x (symbol->keyword (syntax->datum key))))
                               (syntax->list* keys))))
             #'(define* (name arg ... #:key key ... #:allow-other-keys #:rest given)
                 doc
                 (check-keywords 'name given '(keyword ...))
                 body ...))))))))

;; ---- describing ----

;; What Guile would print for an exception, without a place.
(define (plain-text key args)
  (string-trim-right
   (call-with-output-string
     (lambda (port) (print-exception port #f key args)))))

;; The reader puts the place into the text of its errors: "FILE:LINE:COLUMN: message".
(define placed-text (make-regexp "^(.*: )?([^ ].*):([0-9]+):([0-9]+): (.*)$"))

(define (text-place text)
  (let ((m (regexp-exec placed-text text)))
    (and m
         (list (match:substring m 2)
               (string->number (match:substring m 3))
               (string->number (match:substring m 4))))))

(define (without-place text)
  (let ((m (regexp-exec placed-text text)))
    (if m (match:substring m 5) text)))

(define (error-text key args)
  "Return the message of an exception, without its place."
  (match (cons key args)
    (('timewarp-error _ _ (message) _) message)
    (('syntax-error who message _ form subform . _)
     (format #f "syntax error~a: ~a in ~a" (if who (format #f " in ~a" who) "") message
             (short-text (or subform form))))
    (('keyword-argument-error who message _ (value . _) . _)
     (format #f "~a: ~s" message value))
    (('read-error . _) (without-place (plain-text key args)))
    (('quit . _) "exit was called; expected the procedure to return")
    (('%exception value) (format #f "~a was raised" (short-text value)))
    (('timewarp-escape . _)
     "the procedure was left by an escape; expected it to return")
    (_ (plain-text key args))))

;; Place that an exception itself knows, or #f.
(define (own-place key args)
  (match (cons key args)
    (('timewarp-error _ _ _ (place _)) place)
    (('syntax-error _ _ properties . _)
     (let ((file (and (list? properties) (assq-ref properties 'filename)))
           (line (and (list? properties) (assq-ref properties 'line))))
       (and (users-file? file) line
            (list file (1+ line) (1+ (or (assq-ref properties 'column) 0))))))
    (('read-error . _) (text-place (plain-text key args)))
    (_ #f)))

(define (describe-error key args)
  "Return #(MESSAGE PLACE BACKTRACE) of an exception.  Called while the stack still stands."
  (let* ((places (user-frames 12))
         (backtrace (match (cons key args)
                      (('timewarp-error _ _ _ (_ (and text (not "")))) text)
                      (_ (if (and (pair? places) (pair? (cdr places)))
                             (backtrace-text places)
                             "")))))
    (vector (error-text key args)
            (or (own-place key args)
                (and (pair? places) (caar places))
                (current-form-place))
            backtrace)))

;; ---- showing ----

(define (print-timewarp-error port key args default-printer)
  (match args
    ((_ _ (message) (place backtrace))
     (format port "~a~a~a"
             (if place (string-append (place->string place) ": ") "")
             message
             (if (and (string? backtrace) (not (string-null? backtrace)))
                 (string-append "\n" backtrace)
                 "")))
    (_ (default-printer))))

(set-exception-printer! 'timewarp-error print-timewarp-error)

(set-exception-printer! 'timewarp-interrupted
                        (lambda (port key args default-printer)
                          (display "interrupted; the world is usable at its last committed time"
                                   port)))

;; what the C++ side calls to raise its errors, and to describe those of callbacks
(%set-error-hooks!
 (lambda (message name value place backtrace)
   (if name
       (bad-value name value message)
       (raise-error message place backtrace)))
 describe-error)
