;; What there is to say of a procedure, taken from itself: for (help) and for the manual.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp describing)
  #:use-module (ice-9 documentation)
  #:use-module ((ice-9 session) #:select (procedure-arguments))
  #:export (description usage))

(define (description value)
  "Return the description of VALUE, an object that has one, or #f."
  (let ((text (object-documentation value)))
    (and (string? text) text)))

(define (usage value name)
  "Return how the procedure VALUE is called as a list of words: NAME and its arguments, those that may
be left out as [ARG], ARG ... where any number may follow, and its keywords; #f if that is not known."
  (let ((arguments (and name (procedure? value)
                        (false-if-exception
                         (procedure-arguments (if (procedure-with-setter? value)
                                                  (procedure value)
                                                  value))))))
    (and arguments
         (let ((part (lambda (key) (or (assq-ref arguments key) '()))))
           (map (lambda (word) (if (string? word) word (format #f "~s" word)))
                (append (list name)
                        (part 'required)
                        (map (lambda (argument) (format #f "[~a]" argument)) (part 'optional))
                        (map car (part 'keyword))
                        ;; what procedures with keywords gather of them is no news
                        (if (or (pair? (part 'keyword)) (null? (part 'rest)))
                            '()
                            (list (format #f "~a ..." (part 'rest))))))))))
