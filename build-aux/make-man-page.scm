;; Makes a manual page: guile -s make-man-page.scm TEMPLATE VERSION EXAMPLES MODULE >timewarp.1
;;
;; The options come from the table that the program itself reads, that of (timewarp MODULE), so
;; that the page cannot go stale.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (srfi srfi-1) (ice-9 match) (ice-9 rdelim))

;; a hyphen is a minus, which can be copied; a backslash or a dot at the beginning is text
(define (escape text)
  (let ((text (string-concatenate
               (map (lambda (c)
                      (match c (#\\ "\\e") (#\- "\\-") (_ (string c))))
                    (string->list text)))))
    (if (string-prefix? "." text) (string-append "\\&" text) text)))

(define (name-text name)
  (format #f "\\fB~a\\fR" (escape (if (char? name) (string #\- name) (string-append "--" name)))))

(define (argument-text argument long?)
  (match argument
    (#f "")
    ((word) (format #f "[=\\fI~a\\fR]" (escape word)))
    (word (format #f "~a\\fI~a\\fR" (if long? "=" " ") (escape word)))))

(define (print-options options)
  (for-each (match-lambda
              ((names argument help)
               (format #t ".TP~%~a~a~%~a~%" (string-join (map name-text names) ", ")
                       (argument-text argument (any string? names)) (escape help))))
            options))

(define (replace-words line words)
  (match words
    (() line)
    (((word . text) . rest)
     (replace-words (string-join (split-at line word) text) rest))))

(define (split-at line word)
  (match (string-contains line word)
    (#f (list line))
    (i (cons (substring line 0 i) (split-at (substring line (+ i (string-length word))) word)))))

(setlocale LC_ALL "C.UTF-8")
(match (command-line)
  ((_ template version examples module)
   (with-input-from-file template
     (lambda ()
       (let loop ()
         (let ((line (read-line)))
           (unless (eof-object? line)
             (if (string=? line "@OPTIONS@")
                 (print-options
                  ((module-ref (resolve-interface (list 'timewarp (string->symbol module)))
                               'documented-options)))
                 (format #t "~a~%" (replace-words line `(("@VERSION@" . ,version)
                                                         ("@EXAMPLES@" . ,(escape examples))))))
             (loop))))))))
