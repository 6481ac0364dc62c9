;; Parameters of scenes, which the command line's -D overrides.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp parameters)
  #:use-module (timewarp errors)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-1)
  #:export (define-scene-parameter)
  ;; for the command line
  #:export (set-definitions!
            unused-definitions
            defined-parameters
            parameter-value))

;; ((NAME . TEXT) ...) from -D NAME=TEXT
(define definitions '())
;; names of all parameters that scenes have defined so far, latest first
(define names '())

(define (set-definitions! alist)
  "Override scene parameters: an alist of names (symbols) and texts."
  (set! definitions alist)
  (set! names '()))

(define (defined-parameters)
  "Return the names of the parameters that the scenes loaded so far define."
  (reverse names))

(define (unused-definitions)
  "Return the names in the definitions that no scene parameter has."
  (remove (lambda (name) (memq name names)) (delete-duplicates (map car definitions))))

(define (read-whole text name)
  (call-with-input-string text
    (lambda (port)
      (let ((value (catch 'read-error
                     (lambda () (read port))
                     (lambda _ (bad-value name text "one Scheme datum")))))
        (when (or (eof-object? value) (not (eof-object? (read port))))
          (bad-value name text "one Scheme datum"))
        value))))

;; An override must be of the default's kind.
(define (check-kind name value default)
  (define (require valid? expected)
    (unless (valid? value) (bad-value name value expected)))
  (cond ((and (number? default) (exact? default) (integer? default))
         (require real? (format #f "a number, as its default ~s" default)))
        ((number? default) (require real? (format #f "a number, as its default ~s" default)))
        ((boolean? default) (require boolean? "#t or #f"))
        ((symbol? default) (require symbol? (format #f "a symbol, as its default ~s" default)))))

(define (parameter-value name default)
  "Return the value of the scene parameter NAME: the command line's, else DEFAULT."
  (set! names (cons name names))
  (match (assq name (reverse definitions))
    (#f default)
    ((_ . text)
     (if (string? default)
         text
         (let ((value (read-whole text (format #f "the scene parameter ~a" name))))
           (check-kind (format #f "the scene parameter ~a" name) value default)
           value)))))

(define-syntax define-scene-parameter
  (lambda (x)
    "(define-scene-parameter NAME DEFAULT DOC): define the variable NAME with the value DEFAULT,
unless the command line gives another by -D NAME=VALUE.  DOC, a string, is shown by --help."
    (syntax-case x ()
      ((_ name default doc)
       #'(define name (parameter-value 'name default)))
      ((_ name default)
       #'(define name (parameter-value 'name default))))))
