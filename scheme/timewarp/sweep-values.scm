;; The values that a sweep's option lists: VALUE,VALUE...; ranges FROM..TO, FROM..TO..STEP, and
;; FROM..TO..xFACTOR; in double quotes what is none of these: "a, b".
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-values)
  #:use-module (timewarp option-table)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:export (sweep-values))

;; that one option may list
(define most-values 1000000)

(define (sweep-values name text)
  "Return the texts that TEXT lists for the option or parameter NAME, each once."
  (if (string-null? text)
      (list text)
      (delete-duplicates
       (append-map (lambda (element) (expand name element)) (split-elements name text)))))

;; At commas outside double quotes.
(define (split-elements name text)
  (let loop ((chars (string->list text)) (quoted? #f) (element '()) (elements '()))
    (define (finished) (cons (list->string (reverse element)) elements))
    (match chars
      (()
       (when quoted?
         (usage-error "~a: a double quote is not closed in ~s; expected \"...\", in it \\\" for \""
                      name text))
       (reverse (finished)))
      ((#\\ c . rest) (=> no)
       (if quoted? (loop rest #t (cons* c #\\ element) elements) (no)))
      ((#\" . rest) (loop rest (not quoted?) (cons #\" element) elements))
      ((#\, . rest) (=> no)
       (if quoted? (no) (loop rest #f '() (finished))))
      ((c . rest) (loop rest quoted? (cons c element) elements)))))

(define (expand name element)
  (when (string-null? element)
    (usage-error "~a: a value is missing between commas; expected VALUE,VALUE..., \"\" for no text"
                 name))
  (or (quoted-text element)
      (match (split-at-dots element)
        ((from to) (range name element from to #f))
        ((from to step) (range name element from to step))
        (_ #f))
      (list element)))

;; (TEXT) of an element that is in double quotes as a whole, else #f.
(define (quoted-text element)
  (and (string-prefix? "\"" element)
       (let loop ((chars (cdr (string->list element))) (text '()))
         (match chars
           ((#\") (list (list->string (reverse text))))
           ((#\\ c . rest) (loop rest (cons c text)))
           ((#\" . _) #f)
           ((c . rest) (loop rest (cons c text)))
           (() #f)))))

(define (split-at-dots text)
  (match (string-contains text "..")
    (#f (list text))
    (i (cons (substring text 0 i) (split-at-dots (substring text (+ i 2)))))))

;; ---- ranges ----

;; Decimal numbers are taken exactly, so that 0..1..0.1 has the eleven values that one means.
(define (exact-number text)
  (let ((number (and (not (string-prefix? "#" text))
                     (string->number (string-append "#e" text)))))
    (and number (real? number) number)))

(define (number->text number)
  (number->string (if (integer? number) number (exact->inexact number))))

;; The values as texts, #f where this is no range: FROM is no number, as in ../file.
(define (range name text from to step)
  (let ((first (exact-number from)))
    (and first
         (let ((last (exact-number to)))
           (define (refuse expected)
             (usage-error "~a: the range is ~s; expected ~a" name text expected))
           (unless last (refuse "FROM..TO, FROM..TO..STEP or FROM..TO..xFACTOR, all numbers"))
           (map number->text
                (cond ((and step (string-prefix? "x" step))
                       (geometric first last (exact-number (substring step 1)) refuse))
                      (else
                       (arithmetic first last
                                   (if step (exact-number step) (default-step first last))
                                   refuse))))))))

(define (default-step first last)
  (and (integer? first) (integer? last) (if (< last first) -1 1)))

(define (arithmetic first last step refuse)
  (unless step (refuse "a step, as in 0..1..0.1"))
  (when (zero? step) (refuse "a step that is not 0"))
  (let ((steps (floor (/ (- last first) step))))
    (when (negative? steps) (refuse "a step that leads from the first to the last"))
    (when (>= steps most-values) (refuse (format #f "at most ~a values" most-values)))
    (iota (1+ steps) first step)))

(define (geometric first last factor refuse)
  (unless (and factor (positive? factor) (not (= factor 1)) (positive? first) (positive? last)
               (or (= first last) (eq? (> last first) (> factor 1))))
    (refuse "positive numbers and a factor that leads from one to the other, as in 1..100..x10"))
  (let loop ((value first) (values '()))
    (cond ((if (> factor 1) (> value last) (< value last)) (reverse values))
          ((>= (length values) 10000) (refuse "at most 10000 values"))
          (else (loop (* value factor) (cons value values))))))
