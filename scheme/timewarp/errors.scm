;; Errors: how they are raised, where they are placed, how they are shown.
;;
;; A mistake raises `timewarp-error' with the arguments (WHO FORMAT (MESSAGE) (PLACE BACKTRACE)), as
;; Guile's own errors do.  PLACE is (FILE LINE COLUMN), lines and columns from 1: that of the
;; innermost frame of the user's files on the stack, else that of the form being loaded.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp errors)
  #:use-module (timewarp primitives)
  #:use-module (timewarp near-names)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:use-module (ice-9 regex)
  #:use-module ((ice-9 control) #:select (let/ec))
  #:use-module ((rnrs bytevectors) #:select (bytevector? bytevector-length))
  #:use-module (system vm frame)
  #:use-module (system vm vm)
  #:export (raise-error
            bad-value
            check-keywords
            define-keyword-procedure
            current-form-place
            current-form-load-port
            caller-place
            place->string
            describe-error
            error-places
            print-user-frames
            last-error-frames
            call-with-bounded-stack
            call-with-run-stack
            error-text
            writing-briefly?))

;; ---- places ----

;; Place of the top-level form that the loader runs now, or #f.
(define current-form-place (make-parameter #f))

;; What Guile's `load' was reading when that form began, or #f.
(define current-form-load-port (make-parameter #f))

(define-syntax-rule (own-directory)
  (dirname (or (assq-ref (current-source-location) 'filename) "timewarp/errors.scm")))

;; frames of these files are ours, not the user's
(define own-files
  (let ((folder (own-directory)))
    (cons (string-append (dirname folder) "/timewarp.scm")
          (map (lambda (name) (string-append folder "/" name ".scm"))
               '("errors" "guarded-call" "worlds" "parameters" "near-names" "arity" "shapes" "bodies" "contact"
                 "queries" "sensors" "forces" "multibodies" "purity" "callbacks" "vectors"
                 "running" "looking" "files" "drawing" "recorders" "simulate" "loader" "options"
                 "option-table" "time-left" "progress" "interrupts" "help" "repl" "command-line"
                 "parts" "describing" "exit-status" "completion" "effects" "history" "line-editing" "server"
                 "watch"
                 "sweep" "sweep-files" "sweep-local" "sweep-options" "sweep-plan"
                 "sweep-plot" "sweep-process" "sweep-request" "sweep-results" "sweep-slurm" "sweep-task"
                 "sweep-values")))))

;; a frame in this file stands for a form of a scene
(define forms-file (string-append (own-directory) "/forms.scm"))

(define system-folders
  '("ice-9/" "srfi/" "system/" "language/" "oop/" "rnrs/" "sxml/" "texinfo/"))

(define (users-file? file)
  (and (string? file)
       (not (member file own-files))
       (not (string=? file "timewarp.scm"))
       (not (any (lambda (folder) (string-prefix? folder file)) system-folders))))

;; Looking a frame's line and name up takes about a millisecond; code never moves, so answers are
;; kept by its address.
(define frames-by-address (make-hash-table))

;; (PLACE . NAME) of a frame in one of the user's files, `form' of one that stands for a form, or
;; #f.
(define (user-frame frame)
  (let* ((address (frame-instruction-pointer frame))
         (handle (hashv-get-handle frames-by-address address)))
    (if handle
        (cdr handle)
        (let ((found (look-up-frame frame)))
          (hashv-set! frames-by-address address found)
          found))))

(define (look-up-frame frame)
  (match (frame-source frame)
    ((_ file line . column)
     (cond ((equal? file forms-file) 'form)
           ((users-file? file)
            (cons (list file (1+ line) (1+ column)) (frame-procedure-name frame)))
           (else #f)))
    (_ #f)))

;; a recursion without end has millions of frames, one like the other
(define most-frames 10000)

(define (user-frames most)
  "Return up to MOST frames of the user's files on the stack, innermost first, as ((PLACE . NAME) ...)."
  (let ((stack (make-stack #t)))
    ;; only the innermost form has its place at hand
    (let loop ((frame (and stack (stack-ref stack 0))) (frames '()) (form (innermost-form-place))
               (walked 0))
      (if (or (not frame) (= (length frames) most) (= walked most-frames))
          (reverse frames)
          (match (user-frame frame)
            (#f (loop (frame-previous frame) frames form (1+ walked)))
            ('form (loop (frame-previous frame) (add-frame form #f frames) #f (1+ walked)))
            ((place . name)
             (loop (frame-previous frame) (add-frame place name frames) form (1+ walked))))))))

(define (add-frame place name frames)
  (if (and place (not (and (pair? frames) (equal? place (caar frames)))))
      (acons place name frames)
      frames))

(define (caller-place)
  "Return the place in the user's files that is being run, or #f."
  (match (user-frames 1)
    (((place . _)) place)
    (_ (innermost-form-place))))

(define (place->string place)
  "Return FILE:LINE:COLUMN."
  (match place
    ((file line column) (format #f "~a:~a:~a" file line column))))

;; Place of the form that runs now: of a file that a form of the scene takes in by `load', or of that.
(define (innermost-form-place)
  (or (and (not (eq? (current-load-port) (current-form-load-port))) (loaded-form-place))
      (current-form-place)))

;; Where the form begins that Guile's own loader (guile SCRIPT, -l FILE, load) is running, or #f.
;; The loader's port tells only where it ends; so the file is read again, once.
(define (loaded-form-place)
  (let ((port (current-load-port)))
    (and port
         (port-filename port)
         (false-if-exception
          (match (or (hashq-ref read-again port)
                     (hashq-set! read-again port (cons (open-input-file (port-filename port)) #f)))
            ((and known (again . place))
             (let loop ((place place))
               (cond ((and place (>= (port-line again) (port-line port)))
                      (set-cdr! known place)
                      place)
                     (else
                      (let ((form (read-syntax again)))
                        (and (not (eof-object? form))
                             (let ((source (syntax-source form)))
                               (loop (list (port-filename port)
                                           (1+ (assq-ref source 'line))
                                           (1+ (assq-ref source 'column))))))))))))))))

;; Of each port of the loader another one of its file, and the place of the last form read from it.
(define read-again (make-weak-key-hash-table))

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
  (let ((place (or place (caller-place))))
    (without-guiles-backtrace
     (lambda ()
       (throw 'timewarp-error #f "~A" (list message) (list place backtrace))))))

;; An error that nothing catches is printed by Guile itself, where it is thrown, below a backtrace
;; in which our frames and Guile's are all that can be seen of a script that is interpreted.  The
;; message has what there is of the user's.
(define (without-guiles-backtrace thunk)
  (if (memq 'backtrace (debug-options))
      (dynamic-wind
        (lambda () (debug-disable 'backtrace))
        thunk
        (lambda () (debug-enable 'backtrace)))
      (thunk)))

(define (bad-value name value expected)
  "Raise the error `NAME is VALUE; expected EXPECTED'."
  (raise-error (format #f "~a is ~a; expected ~a" name (short-text value) expected)))

;; what a message shows of a value
(define most-characters 200)

;; What has no parts, as it is written; of what is written at length only that it is so.
(define (atom-text value)
  (define (long? integer) (> (integer-length integer) 700))
  (cond ((string? value)
         (format #f "~s" (substring value 0 (min (1+ most-characters) (string-length value)))))
        ((and (exact-integer? value) (long? value))
         (format #f "an integer of ~a bits" (integer-length value)))
        ((and (number? value) (exact? value)
              (or (long? (numerator value)) (long? (denominator value))))
         "a fraction of long integers")
        ((and (bytevector? value) (> (bytevector-length value) most-characters))
         (format #f "an array of ~a bytes" (bytevector-length value)))
        (else (format #f "~s" value))))

;; A list of as many elements of a vector as a message could show.
(define (start-of vector)
  (map (lambda (i) (vector-ref vector i)) (iota (min most-characters (vector-length vector)))))

;; Objects are named only, not described, while this is true.
(define writing-briefly? (make-parameter #f))

;; VALUE as it is written, cut where it is long; a circular one is long.
(define (short-text value)
  (parameterize ((writing-briefly? #t)) (cut-text value)))

(define (cut-text value)
  (define left most-characters)
  (call-with-output-string
    (lambda (port)
      (let/ec stop
        (define (put text)
          (let ((size (string-length text)))
            (display (substring text 0 (min size left)) port)
            (when (> size left)
              (display "..." port)
              (stop))
            (set! left (- left size))))
        (define (put-rest rest)
          (cond ((pair? rest)
                 (put " ")
                 (put-value (car rest))
                 (put-rest (cdr rest)))
                ((null? rest) (put ")"))
                (else (put " . ") (put-value rest) (put ")"))))
        (define (put-value value)
          (cond ((pair? value)
                 (put "(")
                 (put-value (car value))
                 (put-rest (cdr value)))
                ((vector? value)
                 (put "#")
                 (if (zero? (vector-length value))
                     (put "()")
                     (put-value (start-of value))))
                (else (put (atom-text value)))))
        (put-value value)))))

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
keywords.  A keyword given #f counts as absent, but for one with a default, (KEY DEFAULT); an unknown
one is an error that names the others."
    (define (keyword-of key)
      (syntax-case key ()
        ((key default) (keyword-of #'key))
        (key (datum->syntax x (symbol->keyword (syntax->datum #'key))))))
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
                         ((keyword ...) (map keyword-of (syntax->list* keys))))
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

(define (error-places)
  "Return what describe-error needs of the stack, while it still stands."
  (user-frames 12))

(define* (describe-error key args #:optional (places (error-places)))
  "Return #(MESSAGE PLACE BACKTRACE) of an exception that was raised at PLACES."
  (let ((backtrace (match (cons key args)
                     (('timewarp-error _ _ _ (_ (and text (not "")))) text)
                     (_ (if (and (pair? places) (pair? (cdr places)))
                            (backtrace-text places)
                            "")))))
    (vector (error-text key args)
            (or (own-place key args)
                (and (pair? places) (caar places))
                (current-form-place)
                (loaded-form-place))
            backtrace)))

;; ---- stacks ----

;; Of 8 bytes.  In callbacks a list of some hundred thousand elements can be mapped, and a recursion
;; without end is found and described in less than half a second.
(define most-words-in-run 4000000)
;; for scenes and the REPL, where nobody waits for a run to go on
(define most-words 32000000)

(define* (call-with-bounded-stack thunk #:optional (words most-words))
  "Call THUNK; an error is raised where recursion makes the stack grow by more than WORDS.  (Guile
alone would go on until the memory is full.)"
  (call-with-stack-overflow-handler words thunk
    (lambda ()
      (raise-error (format #f "a procedure calls itself without end, or too often: the stack ~a"
                           (format #f "has grown by ~a MB; expected a recursion that ends"
                                   (quotient (* 8 words) 1000000)))))))

(define (call-with-run-stack thunk)
  "Call THUNK, which runs a world, with a bounded stack."
  (call-with-bounded-stack thunk most-words-in-run))

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

;; A callback's stack is unwound before its error is raised at the prompt: what was noted of it is
;; all that `,bt' can show.
(define frames-of-last-error "")
(define (last-error-frames)
  "Return the frames of the user's files in the error that was shown last, one a line, innermost first."
  frames-of-last-error)
(define (frames-of key args)
  (match (cons key args)
    (('timewarp-error _ _ _ (_ (? string? (and text (not ""))))) text)
    (('timewarp-error _ _ _ ((? pair? place) _)) (backtrace-text (list (list place))))
    (_ (backtrace-text (user-frames 12)))))

;; Guile's REPL and its printer of uncaught errors hand over the FRAME that raised an error, in
;; which they say it was before its printer is asked.  Of ours that is no news; the user's frames
;; are.
(let ((print print-exception))
  (module-set! the-root-module 'print-exception
               (lambda (port frame key args)
                 (set! frames-of-last-error (frames-of key args))
                 (match key
                   ((or 'timewarp-error 'timewarp-interrupted)
                    (print port #f key args)
                    (when (and frame (= (length (user-frames 2)) 2))
                      (print-user-frames port)))
                   (_ (print port frame key (with-remedy key args)))))))

;; The arguments of an exception of Guile's, with what can be done where that is known.
(define (with-remedy key args)
  (match (cons key args)
    (('unbound-variable who (? string? message) (and parts ((? symbol? name))) . rest)
     (cons* who (string-append message "~A") (append parts (list (hint name))) rest))
    ;; (set! (body-mass ball) 2) is ((setter body-mass) ball 2), of which Guile says only that
    (('wrong-type-arg "setter" _ (1 (? procedure? procedure)) . _)
     (list #f "~A cannot be set; expected an accessor, such as velocity"
           (list (or (procedure-name procedure) procedure)) #f))
    (_ args)))

(define (print-user-frames port)
  "Print the frames of the user's files on the stack to PORT, one a line."
  (match (user-frames 12)
    (() #t)
    (places (format port "~a~%" (backtrace-text places)))))

;; what the C++ side calls to raise its errors
(%set-raise-hook!
 (lambda (message name value place backtrace)
   (if name
       (bad-value name value message)
       (raise-error message place backtrace))))
