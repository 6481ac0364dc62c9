;; The examples of the manual, as read from its Texinfo.
;;
;; Before each @example and @lisp stands a line "@c example: KIND ...":
;;
;;   file NAME        a scene of that name, written and run for half a second
;;   written NAME     a file of that name, written only: others use it
;;   add NAME         lines for the end of the file NAME, which is then run again
;;   replace NAME START   lines in place of the one line of NAME that begins with START; run again
;;   after NAME       what could stand at the end of NAME: run once, NAME stays as it is
;;   scene            a scene without a name, run for half a second
;;   shell OPTION...  commands after "$ ", and what they print; commands that draw get the options, too
;;   repl NAME        a session: its first block begins with the command, further ones go on with it
;;   text, WHY        not tried
;;
;; In what is printed "..." stands for anything.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (srfi srfi-1)
             (srfi srfi-9)
             (ice-9 match)
             (ice-9 regex)
             (ice-9 textual-ports))

(define-record-type <example>
  (make-example place kind arguments text)
  example?
  (place example-place)                 ; FILE:LINE
  (kind example-kind)                   ; a symbol, or #f where the mark is missing
  (arguments example-arguments)         ; the rest of the mark, a string
  (text example-text))

;; ---- Texinfo ----

(define (replace-all text from to)
  (match (string-contains text from)
    (#f text)
    (i (string-append (substring text 0 i) to
                      (replace-all (substring text (+ i (string-length from))) from to)))))

;; What a reader sees of a line of an example.
(define (shown line)
  (fold (lambda (pair line) (replace-all line (car pair) (cdr pair))) line
        '(("@dots{}" . "...") ("@{" . "{") ("@}" . "}") ("@@" . "@"))))

(define (file-lines file)
  (string-split (call-with-input-file file get-string-all #:encoding "UTF-8") #\newline))

(define mark-line (make-regexp "^@c example: ([a-z]+)[ ,]*(.*)$"))
(define begin-line (make-regexp "^@(example|lisp|smallexample|smalllisp|verbatim|display)$"))
(define include-line (make-regexp "^@include (.*)$"))

(define (read-examples file)
  "Return the examples of the Texinfo FILE and of those beside it that it includes, in order."
  (let loop ((lines (file-lines file)) (number 1) (mark #f) (examples '()))
    (define (next examples) (loop (cdr lines) (1+ number) #f examples))
    (define (place) (format #f "~a:~a" (basename file) number))
    (match lines
      (() (reverse examples))
      ((line . rest)
       (cond
        ((regexp-exec mark-line line)
         => (lambda (found)
              (loop rest (1+ number)
                    (cons (string->symbol (match:substring found 1)) (match:substring found 2))
                    examples)))
        ((regexp-exec include-line line)
         => (lambda (found)
              (let ((part (in-vicinity (dirname file) (match:substring found 1))))
                (next (if (file-exists? part)
                          (append (reverse (read-examples part)) examples)
                          examples)))))
        ((regexp-exec begin-line line)
         => (lambda (found)
              (let ((end (string-append "@end " (match:substring found 1))))
                (call-with-values (lambda () (break (lambda (line) (string=? line end)) rest))
                  (lambda (body rest)
                    (loop (cdr rest) (+ number 2 (length body)) #f
                          (cons (make-example (place) (and mark (car mark)) (if mark (cdr mark) "")
                                              (string-join (map shown body) "\n" 'suffix))
                                examples)))))))
        ;; a mark that no example follows
        (mark (next (cons (make-example (place) #f "" "") examples)))
        (else (next examples)))))))

;; ---- transcripts ----

(define (split-transcript text prompt)
  "Return ((INPUT . OUTPUT) ...) of a transcript, in which inputs follow PROMPT at the beginning of a
line; lines before the first are left out."
  (define (finish input output) (cons input (string-join (reverse output) "\n")))
  (let loop ((lines (string-split (string-trim-right text) #\newline)) (input #f) (output '())
             (parts '()))
    (match lines
      (() (reverse (if input (cons (finish input output) parts) parts)))
      ((line . rest)
       (cond ((string-prefix? prompt line)
              (loop rest (substring line (string-length prompt)) '()
                    (if input (cons (finish input output) parts) parts)))
             (input (loop rest input (cons line output) parts))
             (else (loop rest #f '() parts)))))))

(define (looks-like? shown text)
  "Return whether TEXT is what is SHOWN, in which \"...\" stands for anything."
  (define (pieces shown)
    (match (string-contains shown "...")
      (#f (list shown))
      (i (cons (substring shown 0 i) (pieces (substring shown (+ i 3)))))))
  (match (pieces (string-trim-both shown))
    ((whole) (string=? whole (string-trim-both text)))
    ((first . rest)
     (let ((text (string-trim-both text)))
       (and (string-prefix? first text)
            (let loop ((rest rest) (i (string-length first)))
              (match rest
                ((last) (and (<= (+ i (string-length last)) (string-length text))
                             (string-suffix? last text)))
                ((piece . rest)
                 (match (string-contains text piece i)
                   (#f #f)
                   (j (loop rest (+ j (string-length piece)))))))))))))
