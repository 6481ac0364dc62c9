;; GNU readline at the prompt, where Guile has it: editing, history kept across sessions, completion.
;;
;; The port that readline makes of lines is ours rather than (ice-9 readline)'s, which keeps no
;; history but at a clean exit and completes names only.  Of readline's own variables those that
;; Guile doesn't wrap are reached where its extension has loaded them.  Readline is under the GPL: it
;; is loaded here, at run time, and nowhere else.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp line-editing)
  #:use-module (timewarp completion)
  #:use-module (timewarp history)
  #:use-module (ice-9 buffered-input)
  #:use-module (ice-9 iconv)
  #:use-module (ice-9 match)
  #:use-module (rnrs bytevectors)
  #:use-module (system foreign)
  #:export (activate-line-editing))

;; ---- readline's variables ----

(define (readline-variables)
  "Return a procedure that gives the pointer to a variable or function of readline by its name."
  (let ((library (dynamic-link "guile-readline")))
    (lambda (name) (dynamic-pointer name library))))

(define (set-integer! pointer value)
  (bytevector-sint-set! (pointer->bytevector pointer (sizeof int)) 0 value (native-endianness)
                        (sizeof int)))

(define (integer pointer)
  (bytevector-sint-ref (pointer->bytevector pointer (sizeof int)) 0 (native-endianness)
                       (sizeof int)))

(define (set-pointer! pointer value)
  (bytevector-uint-set! (pointer->bytevector pointer (sizeof '*)) 0 (pointer-address value)
                        (native-endianness) (sizeof '*)))

;; ---- waiting ----

;; s between calls of what goes on while nothing is typed
(define idle-interval 0.02)

;; Lets readline wait as Guile does: signals are looked at, where a read that waits would go on over
;; Ctrl-C, and IDLE is called.  It reads by itself, a byte a time, not through a port of Guile's that
;; takes more than is asked for: what waits in the terminal tells it that someone types on while it
;; shows a parenthesis.
(define (wait-by-select! terminal idle variable)
  (let ((getc (pointer->procedure int (variable "rl_getc") '(*))))
    (define (read-byte stream)
      (let wait ()
        (when (null? (car (select (list terminal) '() '() (and idle idle-interval))))
          (when idle (idle))
          (wait)))
      (getc stream))
    (set-pointer! (variable "rl_getc_function")
                  (kept (procedure->pointer int read-byte '(*))))))

;; What C points to must not be collected.  (In a closure's variable that nothing reads the compiler
;; would not keep it.)
(define (kept object)
  (set! pinned (cons object pinned))
  object)
(define pinned '())

;; ms that the cursor shows where a parenthesis was opened.  Guile's 500 are waited for even when one
;; has typed on, since readline takes the next key at once: an expression that is sent here by a
;; program would take seconds.
(define bounce 120)

;; ---- completion ----

;; What is called again and again by readline for one word, first with CONTINUE? false.  TYPED gives
;; the lines of the expression before this one.
(define (make-completer typed variable)
  (let ((line (variable "rl_line_buffer"))
        (point (variable "rl_point"))
        (files-wanted (variable "rl_filename_completion_desired"))
        (left '()))
    (define (before)
      (let ((bytes (integer point)))
        (string-append
         (typed)
         (if (zero? bytes)
             ""
             (bytevector->string (pointer->bytevector (dereference-pointer line) bytes)
                                 "UTF-8" 'substitute)))))
    (lambda (text continue?)
      (unless continue?
        (set! left '())
        ;; whatever goes wrong must not leave through readline
        (false-if-exception
         (call-with-values (lambda () (completions (before) text))
           (lambda (candidates files?)
             ;; then it shows names without their folders, and no blank follows a folder
             (when files? (set-integer! files-wanted 1))
             (set! left (map (if files? without-slash identity) candidates))))))
      (match left
        (() #f)
        ((first . rest)
         (set! left rest)
         first)))))

;; readline adds the slash of a folder itself
(define (without-slash name)
  (if (string-suffix? "/" name) (string-drop-right name 1) name))

;; ---- the port ----

;; Returns a port of the lines that READ-LINE returns, which gets a prompt; a thunk that gives what was
;; read of the present expression, with its newlines; and one that forgets it.
(define (make-line-port read-line prompt)
  (let ((typed ""))
    (values
     (make-line-buffered-input-port
      (lambda (continuation?)
        (let ((line (read-line (if continuation? "... " (prompt)))))
          (unless (eof-object? line) (set! typed (string-append typed line "\n")))
          line)))
     (lambda () typed)
     (lambda () (set! typed "")))))

;; Takes what is left of a line out of PORT.
(define (drop-pending port)
  (when (and (char-ready? port) (not (eof-object? (peek-char port))))
    (read-char port)
    (drop-pending port)))

;; A reader for the REPL, as `repl-reader' is.  DONE is called with the text of each expression.
(define (make-reader port set-prompt! typed forget! done)
  (lambda* (prompt #:optional (reader (fluid-ref current-reader)))
    (set-buffered-input-continuation?! port #f)
    (set-prompt! prompt)
    (run-hook before-read-hook)
    (catch 'timewarp-interrupted
      (lambda ()
        (let ((expression ((or reader read) port))
              (text (string-trim-right (typed))))
          ;; of a command of the REPL all that is on its line has been typed, too
          (forget!)
          (unless (or (string-null? text) (eof-object? expression)) (done text))
          expression))
      ;; Ctrl-C drops what was typed
      (lambda _
        (forget!)
        (drop-pending port)
        *unspecified*))))

(define (activate-line-editing idle)
  "Let the current input port, a terminal, be edited by readline; IDLE, unless it is #f, is called
again and again while that waits.  Return #f, and change nothing, where Guile has no readline."
  (let ((readline (and (isatty? (current-input-port))
                       (false-if-exception (resolve-interface '(ice-9 readline))))))
    (and readline (begin (activate readline idle) #t))))

(define (activate readline idle)
  (define (of-readline name) (module-ref readline name))
  (define file (history-file))
  (define prompt "")
  (define last-entry #f)
  (define (prompt-text) (if (procedure? prompt) (prompt) prompt))
  (define (remember! entry)
    (unless (equal? entry last-entry)
      (set! last-entry entry)
      ((of-readline 'add-history) entry)
      (append-history-entry! file entry)))
  (eval `(begin (readline-set! bounce-parens ,bounce) (readline-set! history-length ,most-entries))
        readline)
  (let* ((terminal-in (current-input-port))
         (terminal-out (current-output-port))
         (variable (false-if-exception (readline-variables)))
         (completer #f)
         (read-line (lambda (prompt)
                      (let ((read (lambda ()
                                    ((of-readline 'readline) prompt terminal-in terminal-out))))
                        (if completer
                            ((of-readline 'with-readline-completion-function) completer read)
                            (read))))))
    (call-with-values (lambda () (make-line-port read-line prompt-text))
      (lambda (port typed forget!)
        (for-each (of-readline 'add-history) (read-history-entries file))
        (when variable
          (set! completer (make-completer typed variable))
          ;; a name of a body or a file may have blanks: in quotes everything is one word
          (set-pointer! (variable "rl_completer_quote_characters") (kept (string->pointer "\"")))
          (wait-by-select! terminal-in idle variable))
        (set-current-input-port port)
        (let ((set-prompt! (lambda (new) (set! prompt new)))
              (plain-reader (module-ref the-root-module 'repl-reader)))
          (define edited (make-reader port set-prompt! typed forget! remember!))
          (module-set! the-root-module 'repl-reader
                       ;; a client of the server has a port of its own
                       (lambda args
                         (apply (if (eq? (current-input-port) port) edited plain-reader) args))))
        (set! (using-readline?) #t)))))
