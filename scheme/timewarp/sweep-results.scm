;; The results of a sweep: gathering them, telling what failed, and looking values up in them.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-results)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp sweep-files)
  #:use-module (timewarp sweep-plan)
  #:use-module (timewarp sweep-process)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:export (finished?
            read-result
            merge-results
            report-results
            result-value
            finished-results
            check-names
            print-columns))

;; ---- single results ----

(define (read-result folder run)
  "Return the result of RUN as an alist, #f where it has none."
  (match (read-text (result-file folder (run-number run)))
    ((or #f "") #f)
    (text (catch 'timewarp-error
            (lambda () (%read-json text))
            (lambda _
              (raise-error (string-append (result-file folder (run-number run))
                                          " holds no result; expected JSON; without it the run "
                                          "is run again")))))))

(define (finished? result) (and result (eqv? (assoc-ref result "status") 0)))

;; ---- all of them ----

(define (merge-results folder plan)
  "Write the results of all runs of PLAN that have ended into one file, a line each, in the order of
their numbers.  Return (RUN . RESULT) of each run, RESULT #f where there is none."
  (let ((results (map (lambda (run) (cons run (read-result folder run))) (plan-runs plan))))
    (write-whole-file (merged-file folder)
      (lambda (port)
        (for-each (match-lambda
                    ((run . #f) #t)
                    ((run . result)
                     (display (string-trim-right (read-text (result-file folder (run-number run))))
                              port)
                     (newline port)))
                  results)))
    results))

;; failures that are told one by one
(define most-told 10)

(define (tell-failure plan folder run result)
  (format (current-error-port) "run ~a: ~a~%  command: ~a~%  log:     ~a~%"
          (run-number run)
          (if result
              (format #f "status ~a: ~a" (assoc-ref result "status") (assoc-ref result "error"))
              "not finished")
          (command->text (run-command plan run folder))
          (log-file folder (run-number run))))

(define (plural count what) (format #f "~a ~a~a" count what (if (= count 1) "" "s")))

(define (report-results folder plan results)
  "Tell on standard error how the RESULTS, (RUN . RESULT) each, came out.  Return whether all runs
are finished and agree where they should."
  (let* ((failed (remove (lambda (pair) (finished? (cdr pair))) results))
         (ended (filter cdr failed))
         (differing (differing-parts results)))
    (format (current-error-port) "~a~a in ~a: ~a finished~a~a~%" (plural (length results) "run")
            (if (= (length results) (length (plan-runs plan)))
                ""
                (format #f " of the ~a" (length (plan-runs plan))))
            folder
            (- (length results) (length failed))
            (if (null? ended) "" (format #f ", ~a failed" (length ended)))
            (if (= (length ended) (length failed))
                ""
                (format #f ", ~a not finished" (- (length failed) (length ended)))))
    (for-each (match-lambda ((run . result) (tell-failure plan folder run result)))
              (list-head ended (min most-told (length ended))))
    (when (> (length ended) most-told)
      (format (current-error-port) "and ~a more, in ~a: those whose \"status\" is not 0~%"
              (- (length ended) most-told) (merged-file folder)))
    (for-each (match-lambda
                ((one . other)
                 (format (current-error-port)
                         "runs ~a and ~a are parts of one run, but their histories differ; ~
                          expected machines with the same timewarp~%"
                         (run-number one) (run-number other))))
              differing)
    (and (null? failed) (null? differing))))

;; (RUN . RUN) of parts of one run whose hashes are not the same: pictures of two different films.
(define (differing-parts results)
  (define seen (make-hash-table))
  (filter-map
   (match-lambda
     ((run . result)
      (let ((hash (and result (assoc-ref result "hash"))))
        (and hash
             (match (hash-ref seen (run-home run))
               (#f (hash-set! seen (run-home run) (cons run hash)) #f)
               ((other . other-hash) (and (not (equal? hash other-hash)) (cons other run))))))))
   results))

;; ---- values ----

(define (result-value result name)
  "Return what RESULT has of that NAME: a parameter of the scene, an option of timewarp, a value
that the scene printed, something of the run itself, or a statistic, in this order.  A value that is
not there is #f."
  (define (in key) (assoc name (or (assoc-ref result key) '())))
  (match (or (in "parameters") (in "options") (in "values")
             (and (not (member name '("parameters" "options" "values" "statistics")))
                  (assoc name result))
             (in "statistics"))
    (#f #f)
    ((_ . 'null) #f)
    ((_ . #t) "true")
    ((_ . #f) "false")
    ((_ . value) value)))

(define (finished-results results)
  "Return the results of those RESULTS, (RUN . RESULT) each, that are finished; none is an error."
  (match (filter finished? (map cdr results))
    (() (raise-error "no run is finished; expected one at least"))
    (finished finished)))

(define (check-names results names)
  "Raise an error if there is a name in NAMES of which none of RESULTS has a value."
  (for-each
   (lambda (name)
     (unless (any (lambda (result) (result-value result name)) results)
       (raise-error (format #f "no run has a value ~a; expected one of: ~a" name
                            (string-join (value-names (first results)) ", ")))))
   names))

(define (value-names result)
  (append-map (match-lambda
                (((or "parameters" "options" "values" "statistics") . values) (map car values))
                ((name . _) (list name)))
              result))

;; A field of a table whose columns are separated by tabs.
(define (field value)
  (match value
    (#f "")
    ((? number? number) (number->string number))
    (text (string-map (lambda (c) (if (char-set-contains? char-set:iso-control c) #\space c))
                      text))))

(define (print-columns results names)
  "Print a table of the values of NAMES, a line for each of RESULTS, columns separated by tabs."
  (check-names results names)
  (format #t "~a~%" (string-join names "\t"))
  (for-each (lambda (result)
              (format #t "~a~%" (string-join (map (lambda (name) (field (result-value result name)))
                                                  names)
                                             "\t")))
            results))
