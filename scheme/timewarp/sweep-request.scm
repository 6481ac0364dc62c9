;; What the options of a sweep ask for: lists of settings to be combined, what every run is handed,
;; and what every run writes.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-request)
  #:use-module (timewarp option-table)
  #:use-module (timewarp sweep-options)
  #:use-module (timewarp sweep-plan)
  #:use-module (timewarp sweep-values)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:export (sweep-axes handed-on run-outputs))

(define (check-value key text)
  ((row-convert (timewarp-row key)) (row-long-name (timewarp-row key)) text))

;; The settings that one option lists.
(define (option->axis key given)
  (let ((name (row-long-name (timewarp-row key))))
    (map (lambda (value)
           (check-value key value)
           (make-setting 'option name value))
         (sweep-values (string-append "--" name) given))))

(define (definition->axis given)
  (match (string-index given #\=)
    ((or #f 0) (usage-error "-D got ~s; expected NAME=VALUE,VALUE..." given))
    (i (let ((name (substring given 0 i)))
         (map (lambda (value) (make-setting 'define name value))
              (sweep-values (string-append "-D " name) (substring given (1+ i))))))))

(define (axis-name axis) (list-head (first axis) 2))

(define (sweep-axes options)
  "Return the lists of settings whose combinations OPTIONS ask for, in the order given; of several
lists for one name the last one holds."
  (let ((axes (filter-map (match-lambda
                            (('define . given) (definition->axis given))
                            ((key . given) (and (swept-option? key) (option->axis key given))))
                          options))
        (parts (option-ref options 'parts)))
    (append (reverse (delete-duplicates (reverse axes)
                                        (lambda (a b) (equal? (axis-name a) (axis-name b)))))
            (if parts
                (list (map (lambda (k) (make-setting 'option "part" (format #f "~a/~a" k parts)))
                           (iota parts 1)))
                '()))))

;; Folders and files on the command line are where the user is: so is timewarp when it runs.
(define (row->arguments row value)
  (match row
    ((_ names argument . _)
     (match (list (find string? names) argument)
       ((#f #f) (list (string #\- (first names))))
       ((#f _) (list (string #\- (first names)) value))
       ((name #f) (list (string-append "--" name)))
       ((name _) (list (string-append "--" name "=" value)))))))

(define (handed-on options)
  "Return the arguments that every run gets from OPTIONS."
  (append
   (append-map (match-lambda
                 ((key . value)
                  (let ((row (and (not (own-option? key)) (timewarp-row key))))
                    (if (or (not row) (swept-option? key) (output-option? key))
                        '()
                        (row->arguments row value)))))
               options)
   ;; parts of one run must agree
   (if (and (option-ref options 'parts) (not (option-ref options 'hash))) '("--hash") '())))

(define (run-outputs options)
  "Return (OPTION . FILE) for what every run writes into its own folder."
  (filter-map (lambda (key)
                (let ((file (option-ref options key)))
                  (when (and file (or (absolute-file-name? file)
                                      (member ".." (string-split file #\/))))
                    (usage-error "--~a is ~s; expected a name for the folder of each run, ~
                                  FOLDER/runs/00001" key file))
                  (and file (cons (symbol->string key) file))))
              output-options))
