;; Writes the reference part of the manual: guile -s make-reference.scm >reference.texi
;;
;; What (help) and ,describe show, as Texinfo: subjects and their order are those of (help), what
;; stands at a name is its docstring.  The options are those of the tables that the programs
;; themselves read.  So nothing of this can go stale.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp)
             (timewarp describing)
             (timewarp help)
             (timewarp options)
             ((timewarp sweep-options) #:prefix sweep:)
             (srfi srfi-1)
             (srfi srfi-11)
             (ice-9 format)
             (ice-9 match)
             (ice-9 regex))

(setlocale LC_ALL "C.UTF-8")

;; ---- text ----

(define (escape text)
  "Return TEXT so that Texinfo shows it as it is."
  (string-concatenate
   (map (lambda (c)
          (if (memv c '(#\@ #\{ #\})) (string #\@ c) (string c)))
        (string->list text))))

(define (code text) (format #f "@code{~a}" (escape text)))

;; Where the datum ends that begins with the parenthesis at I of TEXT, or #f.
(define (end-of-list text i)
  (let loop ((i i) (depth 0))
    (and (< i (string-length text))
         (match (string-ref text i)
           (#\( (loop (1+ i) (1+ depth)))
           (#\) (if (= depth 1) (1+ i) (loop (1+ i) (1- depth))))
           (_ (loop (1+ i) depth))))))

(define token-end (string->char-set " \n()',;:"))
(define (end-of-token text i) (or (string-index text token-end i) (string-length text)))

;; A list is Scheme where it begins with a name that is known, or with one in capitals.
(define (call? text i names)
  (let ((head (substring text (1+ i) (end-of-token text (1+ i)))))
    (or (member head names) (member head '("set!" "make-world"))
        (string-prefix? "#:" head))))

;; The end of the Scheme that begins at I of TEXT, or #f where it is prose.
(define (end-of-code text i names)
  (define (at prefix) (string-prefix? prefix text 0 (string-length prefix) i))
  (define (trim end)
    ;; a full stop ends the sentence
    (let ((end (min end (string-length text))))
      (if (and (> end i) (char=? #\. (string-ref text (1- end)))) (1- end) end)))
  (let ((begins? (or (zero? i)
                     (not (char-set-contains? char-set:letter+digit (string-ref text (1- i)))))))
    (cond ((not begins?) #f)
          ((or (at "#(") (at "'(")) (end-of-list text (1+ i)))
          ((at "((") #f)
          ((at "(") (and (call? text i names) (end-of-list text i)))
          ((or (at "#:") (at "--"))
           (trim (end-of-token text (+ i 2))))
          ((or (at "#t") (at "#f")) (+ i 2))
          ;; a quoted symbol, not an apostrophe
          ((and (at "'") (or (zero? i) (memv (string-ref text (1- i)) '(#\space #\newline #\()))
                (< (1+ i) (string-length text))
                (char-alphabetic? (string-ref text (1+ i))))
           (trim (end-of-token text (1+ i))))
          (else
           (let* ((end (trim (end-of-token text i))) (word (substring text i end)))
             (and (member word names)
                  ;; `position' is also a word
                  (string-any (lambda (c) (memv c '(#\- #\! #\?))) word)
                  end))))))

(define (mark-up text arguments names)
  "Return TEXT as Texinfo: Scheme and NAMES as code, ARGUMENTS in capitals as variables."
  (define (variable word)
    (let ((word (string-downcase word)))
      (and (member word arguments) word)))
  (let loop ((i 0) (parts '()))
    (if (= i (string-length text))
        (string-concatenate (reverse parts))
        (let ((c (string-ref text i)))
          (cond ((and (char=? c #\`) (string-index text #\' i))
                 => (lambda (end)
                      (loop (1+ end) (cons (code (substring text (1+ i) end)) parts))))
                ((end-of-code text i names)
                 => (lambda (end) (loop end (cons (code (substring text i end)) parts))))
                ((char-set-contains? char-set:letter c)
                 (let* ((end (or (string-index text (char-set-complement char-set:word) i)
                                 (string-length text)))
                        (word (substring text i end)))
                   (loop end
                         (cons (match (and (string=? word (string-upcase word)) (variable word))
                                 (#f (escape word))
                                 (name (format #f "@var{~a}" name)))
                               parts))))
                (else (loop (1+ i) (cons (escape (string c)) parts))))))))

(define char-set:word (char-set-adjoin char-set:letter+digit #\-))

;; ---- docstrings ----

(define keyword-line (make-regexp "^(#:[^ ]+) +(.*)$"))

(define (parse-docstring text)
  "Return the parts of a docstring in order: strings, paragraphs, and lists of (KEYWORD . TEXT)."
  (let loop ((lines (string-split text #\newline)) (parts '()))
    (match lines
      (() (reverse parts))
      ((line . rest)
       (cond
        ((regexp-exec keyword-line line)
         => (lambda (found)
              (let*-values (((more rest) (span (lambda (line) (string-prefix? " " line)) rest))
                            ((item) (cons (match:substring found 1)
                                          (string-join (cons (match:substring found 2)
                                                             (map string-trim more))
                                                       "\n"))))
                (match parts
                  (((? pair? items) . parts) (loop rest (cons (append items (list item)) parts)))
                  (_ (loop rest (cons (list item) parts)))))))
        ((string-null? line) (loop rest (cons "" parts)))
        (else
         (match parts
           (((? string? paragraph) . parts*)
            (loop rest (if (string-null? paragraph)
                           (cons line parts*)
                           (cons (string-append paragraph "\n" line) parts*))))
           (_ (loop rest (cons line parts))))))))))

(define (print-docstring text arguments names)
  (for-each
   (match-lambda
     ((? string? paragraph)
      (unless (string-null? paragraph)
        (format #t "~a~%~%" (mark-up paragraph arguments names))))
     (items
      (format #t "@table @code~%")
      (for-each (match-lambda
                  ((keyword . text)
                   (format #t "@item ~a~%~a~%" (escape keyword) (mark-up text arguments names))))
                items)
      (format #t "@end table~%~%")))
   (parse-docstring text)))

;; ---- procedures ----

;; A word of a description's first line, as @deffn shows it.
(define (argument-text word)
  (if (string-prefix? "#:" word) (format #f "@code{~a}" (escape word)) (escape word)))

(define (print-definition kind words text names)
  (format #t "@deffn ~a ~a~%" kind
          (string-join (cons (escape (car words)) (map argument-text (cdr words)))))
  (print-docstring text (map (lambda (word) (string-trim-both word (string->char-set "[] .")))
                             (cdr words))
                   names)
  (format #t "@end deffn~%~%"))

;; The docstring of syntax begins with how it is used: "(NAME ARG ...): what it does".
(define syntax-docstring (make-regexp "^\\(([^)]*)\\): "))

(define (print-entry name value names)
  (let ((text (description value)))
    (unless (and text (not (string-null? (string-trim-both text))))
      (error "no description of" name))
    (cond
     ((usage value name)
      => (lambda (words)
           (print-definition (if (procedure-with-setter? value) "Accessor" "Procedure")
                             words text names)))
     ((regexp-exec syntax-docstring text)
      => (lambda (found)
           (let ((rest (match:suffix found)))
             (print-definition "Syntax"
                               (let ((words (string-split (match:substring found 1) #\space)))
                                 (cons (car words) (map string-downcase (cdr words))))
                               (string-append (string-upcase (substring rest 0 1))
                                              (substring rest 1))
                               names))))
     (else (print-definition "Parameter" (list (symbol->string name)) text names)))))

(define (subject-node subject)
  (format #f "Reference of ~a" (string-downcase subject)))

(define (print-group module names)
  (match-lambda
    ((subject what . members)
     (format #t "@node ~a~%@section ~a~%~%" (subject-node subject) (escape subject))
     (format #t "~a.~%~%" (escape (string-append (string-upcase (substring what 0 1))
                                                 (substring what 1))))
     (for-each (lambda (name)
                 (print-entry name (module-ref (resolve-interface module) name) names))
               members))))

(define (exports module)
  (sort (module-map (lambda (name _) name) (resolve-interface module))
        (lambda (a b) (string<? (symbol->string a) (symbol->string b)))))

(define vectors
  `("Vectors" ,(string-append "from a module of their own, which (use-modules (timewarp vectors)) "
                              "imports: sums and products of vectors, and quaternions")
    ,@(exports '(timewarp vectors))))

(define (print-procedures)
  (let ((names (map symbol->string
                    (append (exports '(timewarp)) (exports '(timewarp vectors))))))
    (display "@node Procedures
@chapter Procedures

All that the modules @code{(timewarp)} and @code{(timewarp vectors)} export, by subject.
Most keywords may be left out; the text of such a one ends with what then holds.
An @dfn{accessor} can be read, and set by @code{set!}.  At the prompt, @code{(help NAME)}
shows the same texts.

@menu
")
    (for-each (match-lambda
                ((subject what . _)
                 (format #t "* ~a: ~a.  ~a.~%" subject (subject-node subject) (escape what))))
              (append help-groups (list vectors)))
    (format #t "@end menu~%~%")
    (for-each (print-group '(timewarp) names) help-groups)
    ((print-group '(timewarp vectors) names) vectors)))

;; ---- options ----

(define (option-text name argument long?)
  (let ((dashed (if (char? name) (string #\- name) (string-append "--" name))))
    (format #f "~a~a" dashed
            (match argument
              (#f "")
              ((word) (format #f "[=@i{~a}]" (escape word)))
              (word (format #f "~a@i{~a}" (if long? "=" " ") (escape word)))))))

(define (print-options options)
  (format #t "@table @code~%")
  (for-each
   (match-lambda
     ((names argument help)
      (let ((texts (map (lambda (name) (option-text name argument (string? name))) names)))
        (format #t "@item ~a~%" (car texts))
        (for-each (lambda (text) (format #t "@itemx ~a~%" text)) (cdr texts))
        (for-each (lambda (name)
                    (format #t "@findex ~a~%" (option-text name #f #f)))
                  names)
        (format #t "~a.~%~%" (mark-up help '() '())))))
   options)
  (format #t "@end table~%~%"))

(define (print-command-lines)
  (display "@node Command line
@chapter Command line

@menu
* timewarp: Options of timewarp.  One run.
* timewarp-sweep: Options of timewarp-sweep.  Many runs.
@end menu

@node Options of timewarp
@section Options of @command{timewarp}

@code{timewarp [@var{option}]@dots{} [@var{scene}.scm]}.  Without a scene: the prompt.
Defaults stand in parentheses.

")
  (print-options (documented-options))
  (display "The exit status is 0 after a complete run, 1 after an error in the scene or the
run, 2 after wrong usage, and 130 after @kbd{Ctrl-C}, which keeps what was written until then.

@node Options of timewarp-sweep
@section Options of @command{timewarp-sweep}

@code{timewarp-sweep [@var{option}]@dots{} @var{scene}.scm} runs a scene over lists of values.
Options of @command{timewarp} are handed on to each run; many take lists there.

")
  (print-options (sweep:documented-options)))

(format #t "@c Written by build-aux/make-reference.scm: not to be edited.~%~%")
(print-procedures)
(print-command-lines)
