;; What may have been meant by a name that nothing is called: for errors and for (help).
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp near-names)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-1)
  #:export (hint home meant names-with))

;; loaded by name when a hint is asked for: they themselves need errors, and errors need this file
(define known-modules '((timewarp) (timewarp vectors)))

;; The public interface of MODULE, or #f where it is not there, as while it is being loaded.
(define (interface module)
  (false-if-exception (resolve-interface module)))

(define (names module)
  (if module (module-map (lambda (name variable) name) module) '()))

;; Names are symbols or strings.
(define (name->string name)
  (if (symbol? name) (symbol->string name) name))

;; heightField, heightfield and height_field are all meant for height-field
(define (letters name)
  (string-downcase (string-delete (lambda (c) (memv c '(#\- #\_ #\! #\?)))
                                  (name->string name))))

;; How many letters have to be put in, left out or replaced to make B of A, by rows of the usual
;; table.
(define (distance a b)
  (define (next-row row c)
    (let loop ((bs (string->list b)) (above row) (out (list (1+ (car row)))))
      (if (null? bs)
          (reverse out)
          (loop (cdr bs) (cdr above)
                (cons (min (1+ (car out))
                           (1+ (cadr above))
                           (+ (car above) (if (char=? c (car bs)) 0 1)))
                      out)))))
  (last (fold (lambda (c row) (next-row row c))
              (iota (1+ (string-length b)))
              (string->list a))))

;; The one of CANDIDATES that is nearest to NAME and near enough, or #f; of equally near ones the
;; first in the alphabet.
(define (nearest name candidates)
  (define text (letters name))
  (define size (string-length text))
  (define most (quotient (1+ size) 4))                  ; of three letters one may be wrong
  (define (near candidate)
    (let ((other (letters candidate)))
      (and (<= (abs (- (string-length other) size)) most)
           (let ((d (distance text other)))
             (and (<= d most) (cons d (name->string candidate)))))))
  (define (before? a b)
    (or (< (car a) (car b)) (and (= (car a) (car b)) (string<? (cdr a) (cdr b)))))
  (let ((found (filter-map near candidates)))
    (and (pair? found)
         (cdr (fold (lambda (a best) (if (before? a best) a best)) (car found) (cdr found))))))

(define (meant name candidates)
  "Return what to say after the NAME that is none of CANDIDATES: which of them is near, or \"\"."
  (match (nearest name candidates)
    (#f "")
    (like (format #f "; is ~a meant?" like))))

(define (home name)
  "Return the module of timewarp's that exports NAME, or #f."
  (find (lambda (module)
          (let ((found (interface module))) (and found (module-variable found name))))
        known-modules))

(define (hint name)
  "Return what to say after `Unbound variable: NAME': the module that has it, or the name that may
have been meant; else \"\"."
  (define module (home name))
  (if module
      (format #f "; (use-modules ~a) imports it" module)
      (meant name (append (names (current-module))
                          (append-map (lambda (module) (names (interface module)))
                                      known-modules)))))

(define (names-with text)
  "Return the names of timewarp's in which TEXT occurs, in the order of the alphabet."
  (sort (filter (lambda (name) (string-contains (letters name) (letters text)))
                (append-map (lambda (module) (names (interface module))) known-modules))
        (lambda (a b) (string<? (symbol->string a) (symbol->string b)))))
