;; Plots of a statistic against a parameter, by gnuplot.
;;
;; Runs that agree in the parameter, such as those of several seeds, are one point: their mean,
;; with a bar from the least to the greatest.  The file for gnuplot stays beside the picture.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp sweep-plot)
  #:use-module (timewarp errors)
  #:use-module (timewarp sweep-files)
  #:use-module (timewarp sweep-process)
  #:use-module (timewarp sweep-results)
  #:use-module (srfi srfi-1)
  #:use-module (ice-9 match)
  #:export (check-plotting plot-results))

(define (check-plotting)
  "Raise an error unless gnuplot is there."
  (require-program "gnuplot" "gnuplot-nox" "--plot (--columns prints numbers for other programs)"))

;; ---- points ----

(define (numeric? value) (number? value))

;; Values in the order in which an axis shows them: numbers by size, texts as they come.
(define (in-order values)
  (let ((values (delete-duplicates values)))
    (if (every numeric? values) (sort values <) values)))

(define (mean values) (/ (apply + values) (length values)))

;; (X MEAN LEAST GREATEST) for each value of X.
(define (points pairs)
  (map (lambda (x)
         (let ((values (filter-map (match-lambda ((a . y) (and (equal? a x) y))) pairs)))
           (list x (mean values) (apply min values) (apply max values))))
       (in-order (map car pairs))))

;; (TITLE POINT ...) of each curve.
(define (curves results y x z)
  (check-names results (filter identity (list y x z)))
  (let* ((triples (filter-map
                   (lambda (result)
                     (let ((a (result-value result x)) (b (result-value result y))
                           (c (if z (result-value result z) "")))
                       (and a (number? b) c (list c a b))))
                   results)))
    (when (null? triples)
      (raise-error (format #f "no finished run has both a number ~a and a value ~a~a" y x
                           (if z (string-append " and a value " z) ""))))
    (map (lambda (title)
           (cons (format #f "~a" title)
                 (points (filter-map (match-lambda ((c a b) (and (equal? c title) (cons a b))))
                                     triples))))
         (in-order (map first triples)))))

;; ---- gnuplot ----

;; A string in gnuplot's double quotes, in which only these mean something.
(define (gnuplot-string text)
  (string-append
   "\""
   (string-concatenate
    (map (match-lambda (#\" "\\\"") (#\\ "\\\\") (#\newline " ") (c (string c)))
         (string->list text)))
   "\""))

(define (number-text number) (number->string (exact->inexact number)))

;; What is no number is put at 0, 1, 2, ... and named there.
(define (print-labels labels port)
  (format port "set xtics (~a)~%set xrange [-0.5:~a.5]~%"
          (string-join (map (lambda (label place) (format #f "~a ~a" (gnuplot-string label) place))
                            labels (iota (length labels)))
                       ", ")
          (1- (length labels))))

(define (place-of x labels)
  (if labels (list-index (lambda (label) (equal? label x)) labels) x))

(define (print-curve k curve labels port)
  (format port "$curve~a << END_OF_DATA~%" k)
  (for-each (match-lambda
              ((x . numbers)
               (format port "~a~%"
                       (string-join (map number-text
                                         (cons (place-of x labels) numbers))
                                    "\t"))))
            (cdr curve))
  (format port "END_OF_DATA~%"))

(define (print-plot spec log title picture curves port)
  (match spec
    ((y x _)
     (let* ((values (in-order (append-map (lambda (curve) (map first (cdr curve))) curves)))
            (labels (and (not (every numeric? values))
                         (map (lambda (value) (if (number? value) (number->string value) value))
                              values)))
            (curves (if labels
                        (map (match-lambda
                               ((title . points)
                                (cons title
                                      (map (match-lambda
                                             ((x . rest) (cons (if (number? x) (number->string x) x)
                                                               rest)))
                                           points))))
                             curves)
                        curves)))
       (format port "# by timewarp-sweep: columns are ~a, mean, least and greatest ~a~%" x y)
       (format port "set terminal ~a noenhanced~%"
               (if (string-suffix-ci? ".svg" picture) "svg size 800,600 background rgb 'white'"
                   "pngcairo size 800,600"))
       (format port "set output ~a~%" (gnuplot-string picture))
       (format port "set title ~a~%set xlabel ~a~%set ylabel ~a~%set grid~%" (gnuplot-string title)
               (gnuplot-string x) (gnuplot-string y))
       (when log (format port "set logscale ~a~%set format ~a \"%g\"~%" log log))
       (cond (labels (print-labels labels port))
             ;; no curve ends in a corner of the frame
             (else (format port "set offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05~%")))
       (if (string-null? (car (first curves)))
           (format port "unset key~%")
           (format port "set key outside right top title ~a~%" (gnuplot-string (third spec))))
       (for-each (lambda (k curve) (print-curve k curve labels port)) (iota (length curves)) curves)
       (format port "plot ~a~%"
               (string-join
                (map (lambda (k curve)
                       (format #f "$curve~a using 1:2:3:4 with yerrorlines pointtype 7 title ~a" k
                               (gnuplot-string (car curve))))
                     (iota (length curves)) curves)
                ", "))))))

(define (safe-name text)
  (string-map (lambda (c) (if (char-set-contains? char-set:letter+digit c) c #\-)) text))

(define (default-picture folder spec)
  (in-sweep folder (string-append (string-join (map safe-name (filter identity spec)) "-") ".png")))

(define (plot-results folder results spec log picture title)
  "Draw what SPEC says of RESULTS into the file PICTURE, by default one in FOLDER; return its name."
  (let* ((picture (or picture (default-picture folder spec)))
         (script (string-append (substring picture 0 (- (string-length picture) 4)) ".gnuplot"))
         (curves (apply curves results spec)))
    (write-whole-file script
      (lambda (port) (print-plot spec log title picture curves port)))
    (unless (zero? (wait-for-process (start-process (list "gnuplot" script))))
      (raise-error (format #f "gnuplot could not draw ~a; its input is ~a" picture script)))
    picture))
