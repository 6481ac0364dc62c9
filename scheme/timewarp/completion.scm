;; Completion at the prompt: what the word before the cursor may become.
;;
;; It depends on what the word is in: after `,' a command of the REPL; after `#:' the keywords of the
;; procedure that is being called; in a string the names of bodies, or of files where the call or the
;; keyword takes a file; else the names that are defined.  Only text is looked at, nothing is evaluated.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp completion)
  #:use-module (timewarp worlds)
  #:use-module (timewarp bodies)
  #:use-module ((timewarp help) #:select (help-groups))
  #:use-module ((timewarp multibodies) #:select (world-multibodies multibody-name joint-names))
  #:use-module ((ice-9 session) #:select (apropos-internal procedure-arguments))
  #:use-module (ice-9 ftw)
  #:use-module (ice-9 match)
  #:use-module (ice-9 regex)
  #:use-module (srfi srfi-1)
  #:export (completions complete-input?))

;; ---- what the text is in ----

(define (delimiter? char)
  (or (char-whitespace? char) (memv char '(#\( #\) #\[ #\] #\" #\;))))

;; Reads TEXT from the left.  Returns what its end is in ('string, 'comment or 'code) and the forms
;; that are open there, the innermost first: each the list of its parts in reverse order, an atom as
;; its text, a string or a list as #t.  The word that the text ends in is no part yet.
(define (scan text)
  (define end (string-length text))
  (define (after-string i)
    (cond ((>= i end) #f)
          ((char=? (string-ref text i) #\\) (after-string (+ i 2)))
          ((char=? (string-ref text i) #\") (1+ i))
          (else (after-string (1+ i)))))
  ;; the first delimiter from I on; a character after #\ is none
  (define (after-atom i)
    (let ((i (if (string-prefix? "#\\" (substring text i)) (+ i 3) i)))
      (or (and (< i end) (string-index text delimiter? i)) end)))
  ;; where a block comment that begins at I ends, or #f
  (define (after-comment i)
    (let ((found (string-contains text "|#" (+ i 2)))) (and found (+ found 2))))
  (define (add part forms)
    (match forms
      (() '())
      ((form . rest) (cons (cons part form) rest))))
  (let loop ((i 0) (forms '()))
    (if (>= i end)
        (values 'code forms)
        (match (string-ref text i)
          ((or #\( #\[) (loop (1+ i) (cons '() forms)))
          ((or #\) #\]) (loop (1+ i) (if (null? forms) '() (add #t (cdr forms)))))
          (#\" (match (after-string (1+ i))
                 (#f (values 'string forms))
                 (next (loop next (add #t forms)))))
          (#\; (match (string-index text #\newline i)
                 (#f (values 'comment forms))
                 (next (loop next forms))))
          ((or #\' #\` #\,) (loop (1+ i) forms))
          ((? char-whitespace?) (loop (1+ i) forms))
          (_ (if (string-prefix? "#|" (substring text i))
                 (match (after-comment i)
                   (#f (values 'comment forms))
                   (next (loop next forms)))
                 (let ((next (after-atom i)))
                   (if (= next end)
                       (values 'code forms)
                       (loop next (add (substring text i next) forms))))))))))

(define (complete-input? text)
  "Is nothing open at the end of TEXT: no form, no string?"
  (call-with-values (lambda () (scan (string-append text "\n")))
    (lambda (inside forms) (and (eq? inside 'code) (null? forms)))))

;; ---- candidates ----

(define (head form)
  (and (pair? form) (string? (last form)) (string->symbol (last form))))

;; What the symbol NAME stands for at the prompt, or #f.
(define (value-of name)
  (let ((variable (and name (module-variable (current-module) name))))
    (and variable (variable-bound? variable) (variable-ref variable))))

(define (keyword-texts form)
  (let* ((procedure (value-of (head form)))
         (arguments (and (procedure? procedure) (procedure-arguments procedure))))
    (map (match-lambda ((keyword . _) (format #f "~s" keyword)))
         (or (and arguments (assq-ref arguments 'keyword)) '()))))

;; Those of the call that it doesn't have yet.
(define (keywords-left form)
  (lset-difference equal? (keyword-texts form) (filter string? form)))

(define (names text)
  (map symbol->string (apropos-internal (string-append "^" (regexp-quote text)))))

;; what (timewarp) exports
(define (our-names)
  (module-map (lambda (name _) (symbol->string name)) (resolve-interface '(timewarp))))

;; of (help)
(define (subjects)
  (map (compose string-downcase car) help-groups))

(define (commands)
  (append-map (match-lambda
                ((_ . commands)
                 (map (lambda (command) (format #f ",~a" (car command))) commands)))
              (@@ (system repl command) *command-table*)))

(define (body-names)
  (append (map body-name (world-bodies)) (map multibody-name (world-multibodies))))

(define (joints)
  (append-map joint-names (world-multibodies)))

;; The files that TEXT may become, folders with a slash.
(define (files text)
  (let* ((slash (string-rindex text #\/))
         (folder (if slash (substring text 0 (1+ slash)) ""))
         (start (if slash (substring text (1+ slash)) text)))
    (define (wanted? name)
      (and (string-prefix? start name)
           (not (member name '("." "..")))
           (or (not (string-prefix? "." name)) (string-prefix? "." start))))
    (map (lambda (name)
           (let* ((file (string-append folder name)) (there (stat file #f)))
             (if (and there (eq? (stat:type there) 'directory)) (string-append file "/") file)))
         (or (scandir (if (string-null? folder) "." folder) wanted?) '()))))

(define file-takers
  '(load-scene load primitive-load include load-urdf load-shape load-visual render! open-input-file
    open-output-file call-with-input-file call-with-output-file with-output-to-file file-exists?
    chdir))
(define file-keywords '("#:frames" "#:movie" "#:poses" "#:events"))
(define name-takers '(find-body find-multibody))
;; whose strings after the first argument are names of links or joints
(define joint-takers
  '(link-body joint-limits joint-position joint-velocity joint-torque joint-servo joint-force
    joint-moment jacobian forward-kinematics inverse-kinematics))

;; What a string that is in FORM may hold: 'files, 'names, 'joints, 'either or #f for anything.
(define (string-holds form)
  (match form
    (((? string? keyword) . _)
     (=> otherwise)
     (cond ((member keyword file-keywords) 'files)
           ((string-prefix? "#:" keyword) #f)
           (else (otherwise))))
    (_ (let ((head (head form)))
         (cond ((memq head file-takers) 'files)
               ((memq head name-takers) 'names)
               ((memq head joint-takers) 'joints)
               (else 'either))))))

(define (completions before text)
  "Return two values: the list of what TEXT, the word at the end of BEFORE, may become, and whether
they are files.  BEFORE is what was typed of the expression up to the cursor."
  (define (starting list)
    (delete-duplicates (filter (lambda (candidate) (string-prefix? text candidate)) list)))
  (define (of-files) (values (files text) #t))
  (call-with-values
      (lambda () (scan (string-drop-right before (string-length text))))
    (lambda (inside forms)
      (define form (if (null? forms) '() (car forms)))
      (match inside
        ('comment (values '() #f))
        ('string
         (match (string-holds form)
           ('files (of-files))
           ('names (values (starting (body-names)) #f))
           ('joints (values (starting (append (joints) (body-names))) #f))
           ('either (match (starting (body-names))
                      (() (of-files))
                      (names (values names #f))))
           (#f (values '() #f))))
        ('code
         (values
          (cond ((and (string-prefix? "," text) (null? forms)) (starting (commands)))
                ((string-prefix? "#:" text) (starting (keywords-left form)))
                ;; a list of everything would tell nothing
                ((string-null? text) (if (null? forms) (our-names) (keywords-left form)))
                ((eq? (head form) 'help) (append (starting (subjects)) (names text)))
                (else (names text)))
          #f))))))
